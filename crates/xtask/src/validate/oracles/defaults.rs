//! Nothing set: samples spread over pixels by a filter, super-sampling, diffraction, Metropolis sampling of bidirectional path tracing, and
//! several threads.

use std::f64::consts::PI;

use super::super::change::with_lens;
use super::super::check::{Check, Quantity, Renderer, Target};
use super::super::console::TECHNIQUE;
use super::super::hung;
use super::super::shapes::model;
use super::super::text::{background, camera, grey, uniform};
use super::lens::mean_fall_off;
use super::{AROUND, AROUND_NITS, SIDE};

/// Half the width of what is seen at the distance 1, so narrow that the light falls off by a thousandth to the corners.
const TANGENT: f64 = 0.05;
/// Radius of the aperture and distance of the sensor, in metres, and how long the shutter is open, seconds.
const APERTURE: f64 = 0.01;
const SENSOR: f64 = 0.05;
const SHUTTER: f64 = 0.01;
/// Albedo of the sheet.
const ALBEDO: f64 = 0.35;
/// What the sheet has on the screen: so little that no noise makes a pixel white, of which the picture would be made smaller.
const SHOWN: f64 = 0.03;

/// All of them.
pub fn checks() -> Vec<Check> {
    vec![furnace()]
}

/// A wide grey sheet in even light.
fn furnace() -> Check {
    const FAR: f64 = 5.0;
    let square = hung::corners([0.0, FAR, 0.0], [0.0, -1.0, 0.0], 10.0 * FAR);
    let seen = with_lens(&camera([0.0; 3], [0.0, 1.0, 0.0], TANGENT, ""), APERTURE, FAR);
    // Lux seconds of a luminance L through a thin lens: L π r² / s² t.
    let exposure = PI * (APERTURE / SENSOR).powi(2) * SHUTTER;
    let scale = SHOWN / (exposure * ALBEDO * AROUND_NITS);
    let parts = [
        format!(
            "<renderer_settings><width>{SIDE}</width><height>{SIDE}</height>{TECHNIQUE}</renderer_settings>"
        ),
        seen,
        grey("m", ALBEDO),
        hung::mesh("square", "m", square, 1.0) + &model("square"),
        background(&uniform(AROUND)),
        format!("<tonemapping><linear><scale>{scale}</scale></linear></tonemapping>"),
    ];
    let about = "A grey sheet in even light by a scene that sets nothing but its size: whatever filters, super-sampling, diffraction, \
                 Metropolis sampling and two threads do to pixels, areas have the albedo times the mean of cos⁴. Each code of the PNG is the \
                 nearest to the transfer function of sRGB of luminance times π r² / s² t and the scale of the tone mapping.";
    let scene = format!("<scene>{}</scene>", parts.concat());
    let mut check = Check::new("Default settings", "grey in even light", about, scene);
    check.screen = Some(scale * exposure);
    let (side, half) = (SIDE as usize, SIDE as usize / 2);
    for (what, area) in [
        ("picture", [0, side, 0, side]),
        ("upper left", [0, half, 0, half]),
        ("upper right", [half, side, 0, half]),
        ("lower left", [0, half, half, side]),
        ("lower right", [half, side, half, side]),
    ] {
        let value = ALBEDO * mean_fall_off(area, TANGENT);
        check = check.row(what, Quantity::Y, Some(area), Target::Value(value, 0.0));
        if what == "picture" {
            check = check.finely(1e-2);
        }
    }
    // Metropolis sampling gives parts of a picture as many samples as chance will have it.
    check.unit(AROUND_NITS).by(&[Renderer::AsItComes]).effort(128, 6e-2)
}
