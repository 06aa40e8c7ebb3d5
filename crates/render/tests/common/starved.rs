//! Places that a lamp lights and the surroundings hardly or not at all.

use super::scene;
use super::shapes::{Mesh, model};
use super::text::{background, camera, grey, scene_file, settings, uniform};
use indigo_scene::Scene;

/// Side of the pictures.
const SIDE: u32 = 12;

/// A lamp of 1750 lm that shines downwards.
fn lamp(pos: &str) -> String {
    format!(
        "<rectanglelight><pos>{pos}</pos><width>0.4</width><height>0.4</height><spectrum>{}</spectrum>\
         <efficacy_scale><power_drawn>100</power_drawn><overall_luminous_efficacy>17.5</overall_luminous_efficacy>\
         </efficacy_scale></rectanglelight>",
        uniform(1.0)
    )
}

/// A closed room of 4 m with a lamp, and perhaps a sky that none of it sees.
pub fn closed_room(has_sky: bool) -> Scene {
    let sky = "<skylight><sundir>0 1 1</sundir><turbidity>3</turbidity></skylight>".to_owned();
    scene(&scene_file(&[
        settings(SIDE, ""),
        camera([0.0, -1.8, 0.0], [0.0, 1.0, 0.0], 0.8, ""),
        grey("wall", 0.5),
        Mesh::cube(2.0).inside_out().text("walls", "wall"),
        model("walls"),
        lamp("0 0 1.9"),
        if has_sky { sky } else { String::new() },
    ]))
}

/// A lamp over a ground of some half side, under faint starlight.
pub fn lamp_over_ground(half: f64) -> Scene {
    scene(&scene_file(&[
        settings(SIDE, ""),
        camera([0.0, -3.0, 3.0], [0.0, 1.0, -1.0], 0.4, ""),
        grey("ground", 0.5),
        Mesh::square(half, 0.0).text("ground", "ground"),
        model("ground"),
        lamp("0 0 1.9"),
        background(&uniform(10.0)),
    ]))
}
