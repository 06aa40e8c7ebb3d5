//! Scenes for the grid: small, each with something that one mode could get wrong. `cargo xtask validate` renders them by the console,
//! too, and has its own `shapes`, `text`, `encode` and `SIDE` beside them.

mod lens;
mod lights;
mod materials;
mod media;
mod motion;

pub use lens::*;
pub use lights::*;
pub use materials::*;
pub use media::*;
pub use motion::*;

use super::shapes::{Mesh, add, cross, mesh_light, model};
use super::text::{background, diffuse, flat_camera, grey, null, scene_file, settings, uniform};
use super::{SIDE, encode};

const SPECTRUM_D65: &str = "<blackbody><temperature>6500</temperature><gain>1e-9</gain></blackbody>";

/// A square of a given half side whose front looks along an axis, `d` away from the origin.
fn wall(towards: [f64; 3], d: f64, half: f64) -> Mesh {
    let n = towards;
    let u = if n[0].abs() > 0.5 { [0.0, 1.0, 0.0] } else { [1.0, 0.0, 0.0] };
    let v = cross(n, u);
    let at = n.map(|x| -x * d);
    let corner = |a: f64, b: f64| add(at, add(u.map(|x| x * a * half), v.map(|x| x * b * half)));
    Mesh::polygon(vec![corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)])
}

/// A room of side 2 round the origin, open towards the camera at -y, with a block in it.
fn room(walls: [&str; 4]) -> Vec<String> {
    let [floor, left, right, rest] = walls;
    let sides = [
        ("floor", [0.0, 0.0, 1.0], floor),
        ("ceiling", [0.0, 0.0, -1.0], rest),
        ("left", [1.0, 0.0, 0.0], left),
        ("right", [-1.0, 0.0, 0.0], right),
        ("back", [0.0, -1.0, 0.0], rest),
    ];
    let mut parts = vec![];
    for (name, towards, material) in sides {
        parts.extend([wall(towards, 1.0, 1.0).text(name, material), model(name)]);
    }
    parts
}

fn block(material: &str) -> Vec<String> {
    let mut block = Mesh::cube(0.3);
    for p in &mut block.points {
        let (c, s) = (0.9, 0.43);
        *p = [c * p[0] - s * p[1] + 0.3, s * p[0] + c * p[1] + 0.2, p[2] - 0.69];
    }
    vec![block.text("block", material), model("block")]
}

fn lamp(half: f64, radiance: f64) -> Vec<String> {
    vec![
        wall([0.0, 0.0, -1.0], 0.98, half).text("lamp", "black"),
        mesh_light("lamp", &uniform(radiance), [0.0; 3], 1.0, ""),
    ]
}

fn view() -> String {
    flat_camera([0.0, -3.6, 0.0], [0.0, 1.0, 0.0], 0.42)
}

/// A scene's text, and the files that it names.
pub struct Written {
    pub text: String,
    pub files: Vec<(&'static str, Vec<u8>)>,
}

fn written<const N: usize>(parts: &[String], files: [(&'static str, Vec<u8>); N]) -> Written {
    Written { text: scene_file(parts), files: files.into() }
}

fn build(parts: &[Vec<String>]) -> Written {
    written(&parts.concat(), [])
}

fn common(camera: String) -> Vec<String> {
    vec![settings(SIDE, ""), camera, grey("white", 0.7), grey("grey", 0.4), grey("black", 0.0)]
}

pub fn diffuse_box() -> Written {
    build(&[common(view()), room(["white"; 4]), block("grey"), lamp(0.3, 1e5)])
}

/// Behind the camera: seen directly, it would be all that Metropolis sampling knows of.
pub fn small_light() -> Written {
    let lamp = vec![
        wall([0.0, 1.0, 0.0], 4.5, 0.01).text("lamp", "black"),
        mesh_light("lamp", &uniform(1e9), [0.0; 3], 1.0, ""),
    ];
    build(&[common(view()), room(["white"; 4]), block("white"), lamp])
}

/// Lamps of very different size and power, some hidden, one with its back to the room.
pub fn many_lights() -> Written {
    let mut lamps = vec![];
    for i in 0..6u32 {
        let size = 0.02 + 0.03 * f64::from(i);
        let towards = if i == 3 { [0.0, 0.0, 1.0] } else { [0.0, 0.0, -1.0] };
        let pos = [-0.8 + 0.3 * f64::from(i), 0.3 - 0.15 * f64::from(i), if i == 5 { -1.5 } else { 0.0 }];
        let name = format!("lamp{i}");
        lamps.push(wall(towards, 0.9, size).text(&name, "white"));
        lamps.push(mesh_light(&name, &uniform(2e5 / f64::from(i + 1)), pos, 1.0, ""));
    }
    build(&[common(view()), room(["white"; 4]), block("grey"), lamps])
}

pub fn environment_only() -> Written {
    build(&[common(view()), room(["white"; 4]), block("white"), vec![background(&uniform(1e4))]])
}

pub fn environment_and_lamp() -> Written {
    build(&[
        common(view()),
        room(["white"; 4]),
        block("white"),
        lamp(0.2, 1e5),
        vec![background(&uniform(1e3))],
    ])
}

/// Vertex normals of a coarse ball lean far from its triangles' own.
pub fn smoothed_normals() -> Written {
    let ball = |center: [f64; 3], radius: f64, name: &str| {
        let mut mesh = Mesh::ball(1);
        for p in &mut mesh.points {
            *p = add(p.map(|x| x * radius), center);
        }
        let text = mesh.text(name, "white");
        let smooth = text.replace(
            "<normal_smoothing>false</normal_smoothing>",
            "<normal_smoothing>true</normal_smoothing>",
        );
        assert_ne!(text, smooth);
        vec![smooth, model(name)]
    };
    build(&[
        common(view()),
        room(["white"; 4]),
        ball([-0.4, 0.2, -0.5], 0.45, "ball"),
        ball([0.5, -0.1, 0.3], 0.35, "other"),
        lamp(0.3, 1e5),
    ])
}

pub fn coloured_walls_and_lamps() -> Written {
    let rgb = |c: &str| format!("<rgb><rgb>{c}</rgb><gamma>1</gamma></rgb>");
    let narrow = "<peak><peak_min>580</peak_min><peak_width>20</peak_width><base_value>1e3</base_value><peak_value>2e6</peak_value></peak>";
    build(&[
        common(view()),
        vec![diffuse("red", &rgb("0.8 0.05 0.05")), diffuse("green", &rgb("0.05 0.6 0.1"))],
        vec![diffuse("blue", &rgb("0.05 0.1 0.7"))],
        room(["white", "red", "green", "blue"]),
        block("white"),
        vec![
            wall([0.0, 0.0, -1.0], 0.98, 0.2).text("lamp", "black"),
            mesh_light("lamp", SPECTRUM_D65, [0.5, 0.0, 0.0], 1.0, ""),
            wall([0.0, 0.0, -1.0], 0.97, 0.05).text("sodium", "black"),
            mesh_light("sodium", narrow, [-0.5, 0.0, 0.0], 1.0, ""),
        ],
    ])
}

/// Surfaces that do nothing, before the lamp, the camera and the walls.
pub fn invisible_surfaces() -> Written {
    build(&[
        common(view()),
        vec![null("nothing")],
        room(["white"; 4]),
        block("white"),
        vec![wall([0.0, 0.0, 1.0], -0.7, 0.9).text("below", "nothing"), model("below")],
        vec![wall([0.0, 1.0, 0.0], 0.4, 0.9).text("across", "nothing"), model("across")],
        vec![wall([0.0, 1.0, 0.0], 2.4, 2.0).text("before", "nothing"), model("before")],
        lamp(0.2, 1e5),
    ])
}

/// A sheet that lets scattered light through, under an even sky: what is drawn from the sky depends on the side.
pub fn light_through_a_sheet() -> Written {
    let sheet = format!(
        "<material><name>sheet</name><diffuse_transmitter><albedo_spectrum>{}</albedo_spectrum></diffuse_transmitter></material>",
        uniform(0.8)
    );
    build(&[
        common(view()),
        vec![sheet],
        vec![wall([0.0, 0.0, 1.0], 1.0, 1.0).text("floor", "white"), model("floor")],
        vec![wall([0.0, 0.0, -1.0], 0.4, 0.8).text("awning", "sheet"), model("awning")],
        block("grey"),
        vec![background(&uniform(1e4))],
    ])
}

/// Only one scattering event: nothing may be counted twice where few strategies remain.
pub fn single_scattering_only() -> Written {
    let mut parts = common(view());
    parts[0] = settings(SIDE, "<max_depth>1</max_depth>");
    build(&[parts, room(["white"; 4]), block("grey"), lamp(0.3, 1e5)])
}

/// Hands all scenes to a macro: `always` ones are tested in every run, `with_grid` ones by `cargo xtask test --grid` alone.
macro_rules! for_all {
    ($with:ident) => {
        $with! {
            always: [
                small_light,
                environment_and_lamp,
                all_lights_together,
                portal_lit_room,
                thin_lens_out_of_focus,
                orthographic_camera,
                spherical_camera,
                motion,
                moving_media,
                lamps_out_of_focus,
                lamp_deflected_straight,
                coloured_walls_and_lamps,
                invisible_surfaces,
                light_through_a_sheet,
                glass_ball_with_caustic,
                scattering_glass,
                dispersive_prism,
                bump_mapped_walls,
                light_behind_frosted_glass,
            ]
            with_grid: [
                diffuse_box,
                many_lights,
                environment_only,
                environment_map,
                map_through_portals,
                rectangle_lamp_beside_a_hazy_sky,
                photometric_lamp,
                sun_and_sky,
                sun_in_space,
                two_sided_photometric_lamp,
                textured_lamp,
                blades_out_of_focus,
                image_out_of_focus,
                deflected_rays,
                deflected_by_dust,
                spot_out_of_focus_through_a_portal,
                lamp_out_of_focus_in_fog,
                smoothed_normals,
                single_scattering_only,
                mirror_seen_through_glass,
                coloured_absorbing_medium,
                scattering_medium,
                camera_inside_a_medium,
                lamp_inside_a_medium,
                nested_glass_and_liquid,
                glossy_exchange,
                blended_surfaces,
            ]
        }
    };
}
pub(crate) use for_all;
