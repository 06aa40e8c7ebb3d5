//! Fresnel, Beer and Lambert, and plates.

use super::super::change::changed;
use super::super::check::{Check, PATH, TECHNIQUES, THREE};
use super::super::shapes::{Mesh, model};
use super::super::text::{background, basic, medium, specular, sphere, uniform};
use super::{AROUND, AROUND_NITS, in_even_light, integral, looking};

const GROUP: &str = "Glass";

fn absorbing(ior: f64, absorption: f64) -> String {
    medium("g", 10, &basic(ior, &uniform(absorption), "")) + &specular("m", "g")
}

/// Reflectance of unpolarised light at an interface, by the cosine outside.
pub fn fresnel(cos: f64, n: f64) -> f64 {
    let inside = (1.0 - (1.0 - cos * cos) / (n * n)).sqrt();
    let s = (cos - n * inside) / (cos + n * inside);
    let p = (n * cos - inside) / (n * cos + inside);
    0.5 * (s * s + p * p)
}

/// All of them.
pub fn checks() -> Vec<Check> {
    let mut checks = mirrors();
    checks.extend(plates());
    checks.extend(absorbing_bodies());
    checks
}

/// Glass that lets nothing through shows Fresnel's reflectance.
fn mirrors() -> Vec<Check> {
    let opaque = changed(&absorbing(1.5, 0.0), "<transparent>true", "<transparent>false");
    let mut checks = vec![];
    for degrees in [0.0f64, 45.0, 60.0, 75.0, 85.0] {
        let (s, c) = degrees.to_radians().sin_cos();
        let eye = [-20.0 * s, 0.0, 20.0 * c];
        let sheet = Mesh::square(100.0, 0.0).text("sheet", "m") + &model("sheet");
        let parts = [opaque.clone(), sheet, background(&uniform(AROUND))];
        let scene = looking(eye, eye.map(|x| -x), 1e-4, "", &parts);
        let about = "Fresnel's reflectance of unpolarised light, n = 1.5.";
        let check =
            Check::new(GROUP, format!("mirror of glass at {degrees}°"), about, scene).unit(AROUND_NITS);
        checks.push(check.is(fresnel(c, 1.5), 0.0).by(PATH).effort(64, 5e-3));
    }
    // Seen from so far away that rays are parallel, the disc's mean is 2 ∫ F(c) c dc.
    let mean = integral(0.0, 1.0, 100_000, |c| 2.0 * fresnel(c, 1.5) * c);
    let ball = sphere([0.0; 3], 1.0, "m");
    let scene = in_even_light([0.0, -1000.0, 0.0], 2e-3, &[opaque, ball]);
    // The ball covers π/16 of the picture; even light shows beside it.
    let share = std::f64::consts::PI / 16.0;
    let about = "Mean over the disc 2 ∫ F(c) c dc = 0.09178, and the surroundings beside it.";
    let check = Check::new(GROUP, "ball of opaque glass", about, scene).unit(AROUND_NITS);
    checks.push(check.is(1.0 - share + share * mean, 2e-6).by(THREE).effort(256, 1e-2));
    checks
}

/// A plane-parallel plate with all reflections inside.
fn plates() -> Vec<Check> {
    let mut checks = vec![];
    let lamp = |up: f64| {
        let spectrum = uniform(AROUND);
        let size = 600;
        format!(
            "<rectanglelight><pos>0 0 {up}</pos><width>{size}</width><height>{size}</height><spectrum>{spectrum}</spectrum></rectanglelight>"
        )
    };
    let plate = |d: f64| {
        let mesh =
            Mesh::cube(1.0).placed([300.0, 0.0, 0.0, 0.0, 300.0, 0.0, 0.0, 0.0, d / 2.0], 1.0, [0.0; 3]);
        mesh.text("plate", "m") + &model("plate")
    };
    for (ior, absorption, d, degrees) in [
        (1.5, 0.0, 1.0, 0.0f64),
        (1.5, 10.0, 0.1, 0.0),
        (1.33, 5.0, 0.05, 0.0),
        (1.5, 0.0, 1.0, 45.0),
        (1.5, 0.0, 1.0, 60.0),
        (1.5, 3.0, 0.1, 60.0),
    ] {
        let value = through_plate(degrees.to_radians().cos(), ior, absorption * d);
        let (s, c) = degrees.to_radians().sin_cos();
        let parts = [absorbing(ior, absorption), plate(d), lamp(30.0)];
        let scene = looking([-5.0 * s, 0.0, -5.0 * c], [s, 0.0, c], 1e-4, "", &parts);
        let name = format!("plate, n {ior}, σd {:.2}, at {degrees}°", absorption * d);
        let about = "T = (1 − R)² e / (1 − R² e²) with R of unpolarised light and e = exp(−σd / cos t).";
        // The lamp looks down; rays meet it below the plate's own light alone.
        checks.push(
            Check::new(GROUP, name, about, scene)
                .unit(AROUND_NITS)
                .is(value, 0.0)
                .by(PATH)
                .effort(128, 1e-2)
                .in_full(512, 1e-2),
        );
    }
    checks
}

/// Share of light that passes a plate whose absorption times its thickness is known, with all reflections inside.
fn through_plate(cos: f64, n: f64, depth: f64) -> f64 {
    let r = fresnel(cos, n);
    let inside = (1.0 - (1.0 - cos * cos) / (n * n)).sqrt();
    let e = (-depth / inside).exp();
    (1.0 - r).powi(2) * e / (1.0 - r * r * e * e)
}

fn absorbing_bodies() -> Vec<Check> {
    let cube = Mesh::cube(0.05).text("cube", "m") + &model("cube");
    let through = in_even_light([0.0, -5.0, 0.0], 0.001, &[absorbing(1.0, 10.0), cube]);
    let value = (-1.0f64).exp();
    let about = "Beer and Lambert: exp(−σd), behind surfaces that are not there since the indices are equal.";
    let check = Check::new(GROUP, "absorbing cube, σd = 1", about, through).unit(AROUND_NITS);
    // Ways aslant are longer by at most 1e-6.
    let mut checks = vec![check.is(value, 2e-6).by(THREE).effort(64, 5e-3)];
    let middle = in_even_light(
        [0.0, -5.0, 0.0],
        10f64.to_radians().tan() / 8.0,
        &[absorbing(1.5, 1.0), sphere([0.0; 3], 1.0, "m")],
    );
    let about = "For each ray R + (1 − R)² e / (1 − R e), e = exp(−2 σ r cos t), by quadrature over the middle: 0.165860.";
    let check = Check::new(GROUP, "absorbing glass ball, middle", about, middle).unit(AROUND_NITS);
    checks.push(check.is(0.165_860, 5e-7).by(TECHNIQUES).effort(256, 1e-2));
    checks
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Against tables of nine digits, made independently.
    #[test]
    fn formulae_are_those_of_the_tables() {
        for (degrees, reflectance) in [
            (0.0f64, 0.04),
            (45.0, 0.050_239_911),
            (60.0, 0.089_186_713),
            (75.0, 0.253_060_563),
            (85.0, 0.612_799_645),
        ] {
            assert!((fresnel(degrees.to_radians().cos(), 1.5) - reflectance).abs() < 1e-9, "{degrees}");
        }
        for (n, depth, degrees, through) in [
            (1.5, 0.0, 0.0f64, 0.923_076_923),
            (1.5, 1.0, 0.0, 0.339_111_123),
            (1.33, 0.25, 0.0, 0.748_052_302),
            (1.5, 0.0, 45.0, 0.904_326_791),
            (1.5, 0.0, 60.0, 0.836_232_463),
        ] {
            assert!(
                (through_plate(degrees.to_radians().cos(), n, depth) - through).abs() < 1e-9,
                "{n} {degrees}"
            );
        }
    }
}
