//! Fresnel, Beer and Lambert, and plates.

use super::super::change::changed;
use super::super::check::{Check, PATH, TECHNIQUES, THREE};
use super::super::hung;
use super::super::shapes::{Mesh, mesh_light, model};
use super::super::text::{background, basic, grey, medium, specular, sphere, uniform};
use super::{AROUND, AROUND_NITS, distant_ball, in_even_light, looking};

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
    checks.extend([[20, 10], [10, 20]].map(overlapping));
    checks
}

/// Indices and absorption coefficients of two bodies, and the depths from and to which each reaches.
const BODIES: [(f64, f64, [f64; 2]); 2] = [(1.5, 4.0, [0.0, 0.10]), (1.33, 9.0, [0.06, 0.20])];

/// Two wide slabs that overlap, before a lamp: where both are, the one of the higher precedence is, and the other begins behind it.
fn overlapping(precedences: [u32; 2]) -> Check {
    let slab = |i: usize| {
        let (ior, absorption, [from, to]) = BODIES[i];
        let name = format!("body{i}");
        let wide = [300.0, 0.0, 0.0, 0.0, 0.5 * (to - from), 0.0, 0.0, 0.0, 300.0];
        let mesh = Mesh::cube(1.0).placed(wide, 1.0, [0.0, 0.5 * (from + to), 0.0]);
        medium(&name, precedences[i], &basic(ior, &uniform(absorption), ""))
            + &specular(&name, &name)
            + &mesh.text(&name, &name)
            + &model(&name)
    };
    // The border of the two is that of the first one's back or of the second one's front.
    let border = if precedences[0] > precedences[1] { BODIES[0].2[1] } else { BODIES[1].2[0] };
    let value = through_two(border);
    let lamp = Mesh::polygon(hung::corners([0.0, 30.0, 0.0], [0.0, -1.0, 0.0], 300.0).to_vec());
    let lamp = lamp.text("lamp", "black") + &mesh_light("lamp", &uniform(AROUND), [0.0; 3], 1.0, "");
    let parts = [slab(0), slab(1), grey("black", 0.0), lamp];
    let scene = looking([0.0, -5.0, 0.0], [0.0, 1.0, 0.0], 1e-4, "", &parts);
    let about = format!(
        "Slabs of n = 1.5 and 1.33 that overlap by 4 cm of 20, of precedences {} and {}: their border is {border} m deep, and light passes \
         both with all reflections between three surfaces, added one surface after another (Stokes 1862).",
        precedences[0], precedences[1]
    );
    let name = format!("overlapping bodies of precedences {} and {}", precedences[0], precedences[1]);
    Check::new(GROUP, name, about, scene).unit(AROUND_NITS).is(value, 0.0).by(PATH).effort(32, 1e-2)
}

/// The share of light along the normal that passes both bodies, whose border is at a depth.
fn through_two(border: f64) -> f64 {
    let [(n, first, _), (m, second, [_, end])] = BODIES;
    let layers = [
        (fresnel(1.0, n), first * border),
        (fresnel(1.0, n / m), second * (end - border)),
        (fresnel(1.0, m), 0.0),
    ];
    // Transmittance, and reflectance from behind, of what lies before; each surface adds itself and the way behind it.
    let (through, _) = layers.iter().fold((1.0, 0.0), |(through, behind), (r, depth)| {
        let between = 1.0 / (1.0 - behind * r);
        let way = (-depth).exp();
        let back = r + (1.0 - r).powi(2) * behind * between;
        (through * (1.0 - r) * between * way, back * way * way)
    });
    through
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
    let (scene, value) = distant_ball(opaque, |c| fresnel(c, 1.5));
    let about = "Mean over the disc 2 ∫ F(c) c dc = 0.09178, and the surroundings beside it.";
    let check = Check::new(GROUP, "ball of opaque glass", about, scene).unit(AROUND_NITS);
    checks.push(check.is(value, 2e-6).by(THREE).effort(256, 1e-2));
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

    /// Two bodies of one index and coefficient are one, whose plate's formula is known; and the border matters.
    #[test]
    fn two_surfaces_make_a_plate() {
        let [whole, part] = [0.10, 0.06].map(through_two);
        assert!((whole / part - 1.0).abs() > 0.1, "{whole} {part}");
        let two = |r: f64, way: f64| (1.0 - r).powi(2) * way / (1.0 - r * r * way * way);
        let [r, border, last] = [fresnel(1.0, 1.5), fresnel(1.0, 1.5 / 1.33), fresnel(1.0, 1.33)];
        // Without the light that comes back from the far end, which has passed the bodies twice more.
        let least = (1.0 - r) * (1.0 - border) * (1.0 - last) * f64::exp(-0.4 - 0.9);
        assert!(whole > least && whole < 1.02 * least, "{whole} {least}");
        assert!((two(r, 1.0) - through_plate(1.0, 1.5, 0.0)).abs() < 1e-12);
    }

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
