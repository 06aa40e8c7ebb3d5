//! The thin lens.

use std::f64::consts::PI;

use super::super::change::with_lens;
use super::super::check::{Area, Check, Quantity, TECHNIQUES, Target};
use super::super::text::{ONE_PIXEL, background, camera, scene_file, settings, uniform};
use super::{AROUND, AROUND_NITS, SIDE, integral, looking, strip};

const GROUP: &str = "Lens";

fn lens(radius: f64, focus: f64, tangent: f64, parts: &[String]) -> String {
    with_lens(&looking([0.0; 3], [0.0, 0.0, 1.0], tangent, "", parts), radius, focus)
}

/// All of them.
pub fn checks() -> Vec<Check> {
    let even = lens(0.02, 1.0, 0.5, &[background(&uniform(AROUND))]);
    let about = "Without vignetting a picture of even light has its luminance, whatever the aperture.";
    let mut checks = vec![
        Check::new(GROUP, "even light through a wide lens", about, even)
            .unit(AROUND_NITS)
            .is(1.0, 0.0)
            .by(TECHNIQUES),
    ];
    checks.extend([("pinhole", 1e-5), ("wide lens", 0.02)].map(|(name, radius)| vignetted(name, radius)));
    // On the axis a pixel sees the part of the lens's cone that a lamp behind or before the focus fills.
    let (radius, focus, half) = (0.01f64, 1.0f64, 0.003f64);
    for distance in [2.0f64, 0.6] {
        let spectrum = uniform(AROUND);
        let lamp = format!(
            "<rectanglelight><pos>0 0 {distance}</pos><width>{w}</width><height>{w}</height><spectrum>{spectrum}</spectrum></rectanglelight>",
            w = 2.0 * half
        );
        let cone: f64 = radius * (distance - focus).abs() / focus;
        let inside = if half * 2f64.sqrt() < cone {
            4.0 * half * half / (PI * cone * cone)
        } else {
            square_in_disc(half, cone)
        };
        let scene = lens(radius, focus, 1e-5, &[lamp]);
        let about = format!(
            "Focused at {focus} m, a pixel on the axis gathers from a disc of radius {:.4} m at {distance} m, of which a lamp of {} m fills {inside:.5}.",
            cone,
            2.0 * half
        );
        let name = format!("lamp out of focus, at {distance} m");
        let check = Check::new(GROUP, name, about, scene)
            .unit(AROUND_NITS)
            .by(TECHNIQUES)
            .effort(512, 2e-2)
            .quickly(128)
            .in_full(1024, 2e-2);
        // A point of the lens and the focus fix the ray, so that the disc is evenly filled; the picture is a hundredth of a
        // millimetre of it.
        checks.push(check.row("", Quantity::Y, None, Target::Value(inside, 0.0)));
    }
    checks
}

/// Natural vignetting: even light falls off towards the corners like cos⁴ of the angle to the axis.
fn vignetted(name: &str, radius: f64) -> Check {
    const TANGENT: f64 = 0.6;
    let camera = with_lens(&camera([0.0; 3], [0.0, 0.0, 1.0], TANGENT, ""), radius, 1.0);
    let scene = scene_file(&[settings(SIDE, ONE_PIXEL), camera, background(&uniform(AROUND))]);
    let about = "With natural vignetting, which is the default, a picture of even light is darker off the axis by cos⁴ of the angle to \
                 it: mean over areas.";
    let mut check =
        Check::new(GROUP, format!("cos⁴ of a {name}"), about, scene).unit(AROUND_NITS).by(TECHNIQUES);
    let side = SIDE as usize;
    for (what, [x0, x1, y0, y1]) in [
        ("picture", [0, side, 0, side]),
        ("middle", [6, 10, 6, 10]),
        ("edge", [0, 2, 6, 10]),
        ("corner", [14, 16, 14, 16]),
    ] {
        let value = mean_fall_off([x0, x1, y0, y1], TANGENT);
        check = check.row(what, Quantity::Y, Some([x0, x1, y0, y1]), Target::Value(value, 0.0));
    }
    check.effort(64, 5e-3)
}

/// Mean of cos⁴ of the angle to the axis over an area of a picture that sees a width of ±`tangent`.
pub fn mean_fall_off(area: Area, tangent: f64) -> f64 {
    let [x0, x1, y0, y1] = area.map(|i| tangent * (2.0 * i as f64 / f64::from(SIDE) - 1.0));
    // Of 1 / (1 + x² + y²)²: along x in closed form, over y by quadrature.
    let across = |y: f64| strip(1.0 + y * y, x1) - strip(1.0 + y * y, x0);
    integral(y0, y1, 2000, across) / ((x1 - x0) * (y1 - y0))
}

/// Share of a disc that a square round its middle covers, where the square's corners reach out of it.
fn square_in_disc(half: f64, radius: f64) -> f64 {
    let across = |x: f64| half.min((radius * radius - x * x).max(0.0).sqrt());
    4.0 * integral(0.0, half.min(radius), 200_000, across) / (PI * radius * radius)
}
