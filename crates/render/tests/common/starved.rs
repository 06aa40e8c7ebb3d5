//! Places that a lamp lights, and surroundings or another lamp hardly or not at all.

use super::scene;
use super::shapes::{Mesh, model};
use super::text::{background, camera, grey, scene_file, settings, uniform};
use indigo_scene::Scene;

/// Side of the pictures.
const SIDE: u32 = 12;

/// A lamp that draws some watts, of 17.5 lm each, and shines downwards.
fn lamp(pos: &str, watts: f64) -> String {
    format!(
        "<rectanglelight><pos>{pos}</pos><width>0.4</width><height>0.4</height><spectrum>{}</spectrum>\
         <efficacy_scale><power_drawn>{watts}</power_drawn><overall_luminous_efficacy>17.5</overall_luminous_efficacy>\
         </efficacy_scale></rectanglelight>",
        uniform(1.0)
    )
}

/// A sky that nothing in a closed room sees.
pub const SKY: &str = "<skylight><sundir>0 1 1</sundir><turbidity>3</turbidity></skylight>";

/// A lamp of a thousand times the power in another closed room, 50 m off.
pub fn floodlight() -> String {
    model("walls").replace("<pos>0 0 0<", "<pos>50 0 0<") + &lamp("50 0 1.9", 1e5)
}

/// A closed room of 4 m with a lamp, and something that gives it no light.
pub fn closed_room(beside: &str) -> Scene {
    scene(&scene_file(&[
        settings(SIDE, ""),
        camera([0.0, -1.8, 0.0], [0.0, 1.0, 0.0], 0.8, ""),
        grey("wall", 0.5),
        Mesh::cube(2.0).inside_out().text("walls", "wall"),
        model("walls"),
        lamp("0 0 1.9", 100.0),
        beside.to_owned(),
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
        lamp("0 0 1.9", 100.0),
        background(&uniform(10.0)),
    ]))
}
