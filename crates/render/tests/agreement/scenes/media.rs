//! Scenes with media: glass, liquids and fog.

use super::super::shapes::{Mesh, model};
use super::super::text::{basic, henyey_greenstein, medium, scattering, specular, sphere, uniform};
use super::{Written, background, build, common, lamp, room, view, wall};

fn rgb(triple: &str) -> String {
    format!("<rgb><rgb>{triple}</rgb><gamma>1</gamma></rgb>")
}

fn clear(name: &str, precedence: u32, ior: f64) -> String {
    medium(name, precedence, &basic(ior, &uniform(0.0), ""))
}

/// A medium that scatters, with the index of air.
pub(super) fn fog(name: &str, absorption: &str, coefficient: &str, phase: &str) -> String {
    medium(name, 10, &basic(1.0, absorption, &scattering(coefficient, phase)))
}

/// A box from -`half` to `half` along each axis, moved.
pub(super) fn cuboid(name: &str, material: &str, half: [f64; 3], at: [f64; 3]) -> Vec<String> {
    let [x, y, z] = half;
    let mesh = Mesh::cube(1.0).placed([x, 0.0, 0.0, 0.0, y, 0.0, 0.0, 0.0, z], 1.0, at);
    vec![mesh.text(name, material), model(name)]
}

fn in_room(parts: Vec<String>) -> Written {
    build(&[common(view()), room(["white"; 4]), parts, lamp(0.4, 1e5)])
}

/// Light is focused on the floor, by paths that draw no light.
pub fn glass_ball_with_caustic() -> Written {
    in_room(vec![clear("g", 10, 1.5), specular("glass", "g"), sphere([0.1, 0.0, -0.4], 0.45, "glass")])
}

/// A mirror, not a perfect one, on the right wall behind a plate of glass.
pub fn mirror_seen_through_glass() -> Written {
    let mirror = specular("mirror", "metal").replace("<transparent>true", "<transparent>false");
    let mut parts = vec![clear("metal", 10, 12.0), mirror, clear("g", 11, 1.5), specular("glass", "g")];
    parts.extend([wall([-1.0, 0.0, 0.0], 0.9, 0.7).text("mirror", "mirror"), model("mirror")]);
    parts.extend(cuboid("pane", "glass", [0.05, 0.8, 0.8], [0.6, 0.0, 0.0]));
    in_room(parts)
}

/// Colours that deepen with the way through them; no surface is seen.
pub fn coloured_absorbing_medium() -> Written {
    let mut parts = vec![
        medium("red", 10, &basic(1.0, &rgb("0.2 3 6"), "")),
        medium("blue", 11, &basic(1.0, &rgb("8 2 0.1"), "")),
        specular("in red", "red"),
        specular("in blue", "blue"),
        sphere([-0.3, 0.0, 0.1], 0.5, "in red"),
    ];
    parts.extend(cuboid("block", "in blue", [0.4, 0.4, 0.4], [0.3, 0.1, -0.3]));
    in_room(parts)
}

/// A ball of coloured fog.
pub fn scattering_medium() -> Written {
    in_room(vec![
        fog("f", &rgb("0.1 0.5 1"), &rgb("1 3 8"), &henyey_greenstein(0.6)),
        specular("fog", "f"),
        sphere([0.0, 0.0, -0.2], 0.6, "fog"),
    ])
}

/// Behind glass, light reaches the scattering inside only by refraction.
pub fn scattering_glass() -> Written {
    let milky = basic(1.4, &rgb("0.1 0.2 1"), &scattering(&rgb("6 4 3"), "<uniform/>"));
    let ball = sphere([0.1, 0.0, -0.3], 0.5, "glass");
    in_room(vec![medium("m", 10, &milky), specular("glass", "m"), ball, background(&uniform(2e3))])
}

/// A box of coloured fog round the camera and the room.
pub(super) fn thin_fog_everywhere() -> Vec<String> {
    let thin = fog("f", &uniform(0.02), &rgb("0.1 0.2 0.3"), &henyey_greenstein(-0.3));
    let all = cuboid("all", "fog", [3.0, 5.0, 3.0], [0.0; 3]);
    [vec![thin, specular("fog", "f")], all].concat()
}

/// The camera, the room and its lamp are in fog.
pub fn camera_inside_a_medium() -> Written {
    let ball = [clear("g", 20, 1.5), specular("glass", "g"), sphere([0.2, 0.2, -0.5], 0.3, "glass")];
    in_room([thin_fog_everywhere(), ball.to_vec()].concat())
}

/// A lamp that fills a room through a ball of scattering glass round it.
pub fn lamp_inside_a_medium() -> Written {
    let milky = basic(1.3, &rgb("0.3 0.2 0.1"), &scattering(&uniform(2.0), &henyey_greenstein(0.5)));
    let parts = vec![medium("m", 10, &milky), specular("glass", "m"), sphere([0.0, 0.0, 0.9], 0.7, "glass")];
    build(&[common(view()), room(["white"; 4]), parts, lamp(0.2, 3e5)])
}

/// Each wavelength goes a way of its own, far more so than in any glass.
pub fn dispersive_prism() -> Written {
    let flint = "<basic><ior>1.4</ior><cauchy_b_coeff>0.05</cauchy_b_coeff></basic>";
    let ends = |y: f64| [[-0.5, y, -0.8], [0.5, y, -0.8], [0.0, y, 0.1]];
    let prism = Mesh {
        points: [ends(-0.5), ends(0.5)].concat(),
        triangles: vec![
            [0, 1, 2],
            [3, 5, 4],
            [0, 3, 4],
            [0, 4, 1],
            [1, 4, 5],
            [1, 5, 2],
            [2, 5, 3],
            [2, 3, 0],
        ],
    };
    in_room(vec![medium("f", 10, flint), specular("flint", "f"), prism.text("p", "flint"), model("p")])
}

/// Liquid in glass, modelled so that it reaches into the glass; and a bubble of air in the liquid.
pub fn nested_glass_and_liquid() -> Written {
    let mut parts = vec![
        medium("glass", 20, &basic(1.5, &rgb("0.4 0.1 0.3"), "")),
        medium("wine", 10, &basic(1.33, &rgb("0.5 4 6"), "")),
        clear("air", 30, 1.0),
        specular("outside", "glass"),
        specular("inside", "wine"),
        specular("bubble", "air"),
    ];
    parts.extend(cuboid("outer", "outside", [0.5, 0.5, 0.5], [0.0, 0.0, -0.4]));
    let hollow =
        Mesh::cube(1.0).placed([0.4, 0.0, 0.0, 0.0, 0.4, 0.0, 0.0, 0.0, 0.35], 1.0, [0.0, 0.0, -0.35]);
    parts.extend([hollow.inside_out().text("inner", "outside"), model("inner")]);
    parts.extend(cuboid("wine", "inside", [0.43, 0.43, 0.25], [0.0, 0.0, -0.5]));
    parts.push(sphere([0.05, 0.0, -0.5], 0.12, "bubble"));
    in_room(parts)
}
