//! The thin lens.

use std::f64::consts::PI;

use super::super::check::{Check, Quantity, TECHNIQUES, Target};
use super::super::text::{background, uniform};
use super::{AROUND, AROUND_NITS, looking};

const GROUP: &str = "Lens";

fn lens(radius: f64, focus: f64, tangent: f64, parts: &[String]) -> String {
    looking([0.0; 3], [0.0, 0.0, 1.0], tangent, "", parts)
        .replace(
            "<aperture_radius>1e-5</aperture_radius>",
            &format!("<aperture_radius>{radius}</aperture_radius>"),
        )
        .replace("<focus_distance>1</focus_distance>", &format!("<focus_distance>{focus}</focus_distance>"))
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
        let scene = lens(radius, focus, 1e-4, &[lamp]);
        let about = format!(
            "Focused at {focus} m, a pixel on the axis gathers from a disc of radius {:.4} m at {distance} m, of which a lamp of {} m fills {inside:.5}.",
            cone,
            2.0 * half
        );
        let name = format!("lamp out of focus, at {distance} m");
        let check = Check::new(GROUP, name, about, scene).unit(AROUND_NITS).by(TECHNIQUES).effort(1024, 2e-2);
        // Rays through the rim are aslant by 0.01: cos⁴ of it, and the patch that is seen.
        checks.push(check.row("", Quantity::Y, None, Target::Value(inside, 3e-4 * inside)));
    }
    checks
}

/// Share of a disc that a square round its middle covers, where the square's corners reach out of it.
fn square_in_disc(half: f64, radius: f64) -> f64 {
    let across = |x: f64| half.min((radius * radius - x * x).max(0.0).sqrt());
    4.0 * super::integral(0.0, half.min(radius), 200_000, across) / (PI * radius * radius)
}
