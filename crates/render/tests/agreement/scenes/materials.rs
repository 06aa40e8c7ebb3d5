//! Scenes of glossy, rough, bumpy and blended surfaces.

use super::super::text::{basic, medium, uniform};
use super::{Written, add, block, build, common, cross, encode, lamp, model, room, view, written};

fn material(name: &str, kind: &str) -> String {
    format!("<material><name>{name}</name>{kind}</material>")
}

fn coat(name: &str, exponent: u32, ground: f64) -> String {
    let ground = uniform(ground);
    material(
        name,
        &format!(
            "<phong><ior>1.6</ior><exponent>{exponent}</exponent><diffuse_albedo_spectrum>{ground}</diffuse_albedo_spectrum></phong>"
        ),
    )
}

fn metal(name: &str, exponent: u32, rgb: &str) -> String {
    let reflectivity = format!("<rgb><rgb>{rgb}</rgb><gamma>1</gamma></rgb>");
    material(
        name,
        &format!(
            "<phong><exponent>{exponent}</exponent><specular_reflectivity_spectrum>{reflectivity}</specular_reflectivity_spectrum></phong>"
        ),
    )
}

/// Light that goes to and fro between metals and coats, so that caustics and glossy chains are most of it.
pub fn glossy_exchange() -> Written {
    let parts = vec![
        coat("floor", 300, 0.3),
        metal("copper", 60, "0.9 0.6 0.4"),
        metal("steel", 2000, "0.7 0.7 0.75"),
        material(
            "clay",
            &format!(
                "<oren_nayar><sigma>0.5</sigma><albedo_spectrum>{}</albedo_spectrum></oren_nayar>",
                uniform(0.7)
            ),
        ),
    ];
    build(&[
        common(view()),
        parts,
        room(["floor", "copper", "steel", "clay"]),
        block("copper"),
        lamp(0.3, 1e5),
    ])
}

/// A square as [`wall`] whose map is shown `times` times along each side.
fn mapped_wall(towards: [f64; 3], name: &str, material: &str, times: f64) -> Vec<String> {
    let u = if towards[0].abs() > 0.5 { [0.0, 1.0, 0.0] } else { [1.0, 0.0, 0.0] };
    let v = cross(towards, u);
    let corner = |[a, b]: [f64; 2]| {
        let [x, y, z] = add(towards.map(|x| -x), add(u.map(|x| x * a), v.map(|x| x * b)));
        let [s, t] = [a, b].map(|c| 0.5 * times * (c + 1.0));
        format!("<vertex pos=\"{x} {y} {z}\" uv0=\"{s} {t}\"/>")
    };
    let vertices = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(corner).concat();
    let set = "<expose_uv_set><index>0</index><name>default</name></expose_uv_set>";
    let mesh = format!(
        "<mesh><name>{name}</name><normal_smoothing>false</normal_smoothing><embedded>{set}{vertices}<triangle_set>\
         <material_name>{material}</material_name><tri>0 1 2</tri><tri>0 2 3</tri></triangle_set></embedded></mesh>"
    );
    vec![mesh, model(name)]
}

/// Hills of up to 45 degrees, on matt, coated and metal walls: shading normals lean far from the walls' own, so that
/// light arriving and light leaving are weighed differently.
pub fn bump_mapped_walls() -> Written {
    let height = |i: usize| {
        let [x, y] = [i % 16, i / 16].map(|c| (std::f64::consts::TAU * c as f64 / 16.0).sin());
        (0.5 + 0.25 * (x + y)) as f32
    };
    let hills = encode::rgb([16, 16], |i| [height(i); 3]);
    let bump = "<bump_map><path>hills.exr</path><exponent>1</exponent><b>0.3</b></bump_map>";
    let bumpy = |text: String, end: &str| text.replace(end, &format!("{bump}{end}"));
    let matt = material(
        "matt",
        &format!("<diffuse><albedo_spectrum>{}</albedo_spectrum>{bump}</diffuse>", uniform(0.7)),
    );
    let parts = [
        common(view()),
        vec![
            matt,
            bumpy(coat("coated", 50, 0.5), "</phong>"),
            bumpy(metal("metal", 80, "0.8 0.8 0.8"), "</phong>"),
        ],
        mapped_wall([0.0, 0.0, 1.0], "floor", "matt", 2.0),
        mapped_wall([0.0, -1.0, 0.0], "back", "coated", 3.0),
        mapped_wall([1.0, 0.0, 0.0], "left", "metal", 1.0),
        mapped_wall([-1.0, 0.0, 0.0], "right", "matt", 1.0),
        mapped_wall([0.0, 0.0, -1.0], "ceiling", "white", 1.0),
        block("grey"),
        lamp(0.3, 1e5),
    ];
    written(&parts.concat(), [("hills.exr", hills)])
}

/// All light goes through a rough pane of coloured glass below the lamp.
pub fn light_behind_frosted_glass() -> Written {
    let frosted = "<glossy_transparent><internal_medium_name>glass</internal_medium_name><exponent>100</exponent></glossy_transparent>";
    let glass = "<rgb><rgb>1 4 9</rgb><gamma>1</gamma></rgb>";
    let mut pane =
        super::Mesh::cube(1.0).placed([0.98, 0.0, 0.0, 0.0, 0.98, 0.0, 0.0, 0.0, 0.04], 1.0, [0.0, 0.0, 0.7]);
    pane.points.iter_mut().for_each(|p| p[1] -= 0.01);
    let parts = vec![
        medium("glass", 10, &basic(1.5, glass, "")),
        material("frosted", frosted),
        pane.text("pane", "frosted"),
        model("pane"),
    ];
    build(&[common(view()), room(["white"; 4]), parts, block("grey"), lamp(0.3, 1e5)])
}

/// Surfaces of two kinds at each point: by a factor, and by a map with soft borders.
pub fn blended_surfaces() -> Written {
    let share = |i: usize| if (i % 4 + i / 4).is_multiple_of(2) { 1.0 } else { 0.0 };
    let chequers = encode::rgb([4, 4], |i| [share(i); 3]);
    let blend =
        |how: &str, a: &str, b: &str| format!("<blend>{how}<a_name>{a}</a_name><b_name>{b}</b_name></blend>");
    let half = "<blend_factor>0.5</blend_factor>";
    let map = "<blend_map><path>chequers.exr</path><exponent>1</exponent></blend_map>";
    let parts = [
        common(view()),
        vec![
            metal("steel", 500, "0.7 0.7 0.75"),
            coat("coated", 50, 0.5),
            material("nothing", "<null_material/>"),
            material("mixed", &blend(half, "steel", "coated")),
            material("chequered", &blend(map, "white", "steel")),
            material("grating", &blend(map, "mixed", "nothing")),
        ],
        mapped_wall([0.0, 0.0, 1.0], "floor", "chequered", 2.0),
        mapped_wall([0.0, -1.0, 0.0], "back", "mixed", 1.0),
        mapped_wall([1.0, 0.0, 0.0], "left", "white", 1.0),
        mapped_wall([-1.0, 0.0, 0.0], "right", "grating", 1.0),
        mapped_wall([0.0, 0.0, -1.0], "ceiling", "white", 1.0),
        block("mixed"),
        lamp(0.3, 1e5),
    ];
    written(&parts.concat(), [("chequers.exr", chequers)])
}
