//! Direct light on a matt floor against closed forms.

use std::f64::consts::PI;

use super::super::check::{Check, TECHNIQUES, THREE};
use super::super::shapes::{Mesh, Point, mesh_light, model, sub};
use super::super::text::{grey, uniform};
use super::{NITS_PER_UNIFORM, looking};

const GROUP: &str = "Direct light";
/// Albedo of the floor.
const ALBEDO: f64 = 0.5;
/// Spectral radiance of the lamps, W m^-3 sr^-1.
const RADIANCE: f64 = 5.0e7;
/// Over the patch that is seen the irradiance bends by this share.
const BEND: f64 = 3e-4;

/// The lamp of the manual: 0.2 m by 0.2 m, 100 W at 17.5 lm/W.
fn manual_lamp() -> String {
    "<rectanglelight><pos>0 0 1.9</pos><width>0.2</width><height>0.2</height><spectrum><peak><peak_min>300</peak_min>\
     <peak_width>550</peak_width><base_value>0</base_value><peak_value>200</peak_value></peak></spectrum>\
     <efficacy_scale><power_drawn>100</power_drawn><overall_luminous_efficacy>17.5</overall_luminous_efficacy>\
     </efficacy_scale></rectanglelight>"
        .to_owned()
}

fn rectangle([x, y, above]: Point) -> String {
    let spectrum = uniform(RADIANCE);
    format!(
        "<rectanglelight><pos>0 0 {above}</pos><width>{x}</width><height>{y}</height><spectrum>{spectrum}</spectrum></rectanglelight>"
    )
}

/// Looks at a point of the floor under lamps; expects the luminance of an illuminance (lx).
fn floor(name: &str, about: &str, lamps: &str, target: Point, lux: f64, relative: f64) -> Check {
    let eye = [target[0] + 3.0, target[1] + 1.0, target[2] + 1.2];
    let ground = Mesh::square(20.0, 0.0).text("ground", "floor") + &model("ground");
    let scene = looking(eye, sub(target, eye), 2e-3, "", &[grey("floor", ALBEDO), ground, lamps.to_owned()]);
    let value = ALBEDO * lux / PI;
    Check::new(GROUP, name, about, scene).is(value, relative * value)
}

/// All of them.
pub fn checks() -> Vec<Check> {
    let manual = "The manual's lamp: luminance P η / (π A) = 13 926.06 cd/m²; ";
    let seen = looking([0.0; 3], [0.0, 0.0, 1.0], 0.02, "", &[manual_lamp()]);
    let mut checks = vec![
        Check::new(GROUP, "the manual's lamp itself", manual, seen).is(13_926.057_5, 1e-3),
        floor(
            "the manual's lamp, below",
            &format!("{manual}153.7376 lx below it."),
            &manual_lamp(),
            [0.0; 3],
            153.737_6,
            BEND,
        ),
        floor(
            "the manual's lamp, aside",
            &format!("{manual}63.9058 lx at (1, 1)."),
            &manual_lamp(),
            [1.0, 1.0, 0.0],
            63.905_8,
            BEND,
        ),
    ];
    let unit = RADIANCE * NITS_PER_UNIFORM;
    for (size, [x, y], ratio) in [
        ([1.0, 1.0, 1.0], [0.0, 0.0], 0.752_274_688),
        ([2.0, 1.0, 0.5], [0.3, 0.2], 1.930_985_953),
        ([2.0, 1.0, 0.5], [2.0, 0.0], 0.056_117_802),
    ] {
        let name = format!("rectangle {} × {} m, {} m above ({x}, {y})", size[0], size[1], size[2]);
        let about = "Configuration factor of a parallel rectangle, corner by corner.";
        checks.push(floor(&name, about, &rectangle(size), [x, y, 0.0], ratio * unit, BEND));
    }
    for (radius, above, aside, ratio) in
        [(0.5, 1.0, 0.0, 0.628_318_531), (0.5, 1.0, 0.5, 0.460_075_592), (1.0, 1.0, 2.0, 0.165_833_381)]
    {
        let disc = Mesh::disc(radius, 400).text("disc", "lamp");
        let lamp =
            grey("lamp", 0.0) + &disc + &mesh_light("disc", &uniform(RADIANCE), [0.0, 0.0, above], 1.0, "");
        let about = "Configuration factor of a disc: π/2 (1 − (h² + d² − r²) / √((h² + d² + r²)² − 4 r² d²)), \
                     of which a polygon of 400 corners leaves out 4·10⁻⁵.";
        checks.push(floor(
            &format!("disc, radius {radius} m, {aside} m aside"),
            about,
            &lamp,
            [0.0, aside, 0.0],
            ratio * unit,
            BEND,
        ));
    }
    let ball = Mesh::ball(3);
    let placed = ball.placed([1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0], 0.3, [0.3, -0.2, 1.5]);
    let irradiance = placed.irradiance([0.0; 3], [0.0, 0.0, 1.0]);
    let lamp = grey("lamp", 0.0)
        + &ball.text("ball", "lamp")
        + &mesh_light("ball", &uniform(RADIANCE), [0.3, -0.2, 1.5], 0.3, "");
    let about = "Lambert's ½ Σ θ (n · Γ) over the edges of each triangle that shows its front.";
    checks.push(
        floor("ball of 512 triangles", about, &lamp, [0.0; 3], irradiance * unit, BEND).effort(1024, 1e-2),
    );
    let both = manual_lamp() + &manual_lamp().replace("0 0 1.9", "1 1 1.9");
    let about = "Light adds up: 153.7376 lx + 63.9058 lx.";
    checks.push(floor("two lamps", about, &both, [1.0, 1.0, 0.0], 153.737_6 + 63.905_8, BEND).by(TECHNIQUES));
    // Metropolis sampling gains nothing from more shapes of the same lamp.
    for (i, check) in checks.iter_mut().enumerate() {
        let renderers = if i < 4 { THREE } else { TECHNIQUES };
        check.renderers = renderers.to_vec();
    }
    checks
}
