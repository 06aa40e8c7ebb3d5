//! One rough interface of glass: what it reflects and what it lets through, each by quadrature.

use std::f64::consts::TAU;

use super::super::check::{Check, TECHNIQUES};
use super::super::shapes::{Mesh, mesh_light, model};
use super::super::text::{background, basic, grey, medium, uniform};
use super::glass::fresnel;
use super::{AROUND, AROUND_NITS, integral, looking, material};

const GROUP: &str = "Frosted glass";
/// Index of refraction, and the exponent of the normals of facets.
const INDEX: f64 = 1.5;
const EXPONENT: f64 = 100.0;

/// All of them.
pub fn checks() -> Vec<Check> {
    let at = |degrees: f64| {
        let [reflected, passed] = shares(degrees.to_radians().cos());
        let about = format!(
            "What Trowbridge and Reitz's facets of the exponent {EXPONENT} reflect at once, n = {INDEX}: ∫ F D G (o·h) / cos o dh = \
             {reflected:.5}, Smith's masking of both directions by one height (Heitz 2014, equation 99). Within the glass all is black."
        );
        let seen = interface(degrees, 0.0, &background(&uniform(AROUND)));
        // Most light is lost here.
        let reflects = check(format!("reflected at {degrees}°"), &about, seen, reflected).effort(256, 2e-2);
        let about = format!(
            "A wide lamp of radiance n² in the glass: radiance over n² is kept by what refracts, of which facets let through \
             ∫ (1 − F) D G₁ G₁ (o·h) / cos o dh = {passed:.5} (Walter et al. 2007, equations 21 and 23)."
        );
        let seen = interface(degrees, INDEX * INDEX, "");
        [reflects, check(format!("let through at {degrees}°"), &about, seen, passed)]
    };
    [0.0, 60.0].map(at).concat()
}

fn check(name: String, about: &str, scene: String, value: f64) -> Check {
    Check::new(GROUP, name, about, scene).unit(AROUND_NITS).is(value, 1e-6).by(TECHNIQUES).effort(32, 5e-3)
}

/// A wide block of glass with a rough surface, in which a black sheet shines up with a radiance, seen at an angle.
fn interface(degrees: f64, radiance: f64, light: &str) -> String {
    // Light that goes so far aside that it misses the sheet, a metre below, has less than a millionth of it.
    let wide = [100.0, 0.0, 0.0, 0.0, 100.0, 0.0, 0.0, 0.0, 1.0];
    let block = Mesh::cube(1.0).placed(wide, 1.0, [0.0, 0.0, -1.0]).text("block", "m") + &model("block");
    let sheet = Mesh::square(99.0, -1.0).text("sheet", "black");
    let lit = match radiance {
        0.0 => model("sheet"),
        _ => mesh_light("sheet", &uniform(radiance * AROUND), [0.0; 3], 1.0, ""),
    };
    let kind = format!(
        "<glossy_transparent><internal_medium_name>g</internal_medium_name><exponent>{EXPONENT}</exponent></glossy_transparent>"
    );
    let glass = medium("g", 10, &basic(INDEX, &uniform(0.0), "")) + &material("m", &kind);
    let (s, c) = degrees.to_radians().sin_cos();
    let eye = [-20.0 * s, 0.0, 20.0 * c];
    let parts = [glass, grey("black", 0.0), block, sheet + &lit, light.to_owned()];
    looking(eye, eye.map(|x| -x), 1e-4, "", &parts)
}

/// The shares of light that facets reflect and let through at once, seen from outside under a cosine.
fn shares(cos: f64) -> [f64; 2] {
    facets(INDEX, EXPONENT, cos, [1000, 300])
}

/// The same of an index and an exponent, by quadrature in so many steps of slope and turn: ∫ F D G₂ (o·h) / cos o dh over normals, with
/// Smith's masking (Walter et al. 2007); of both directions by one height where light is reflected (Heitz 2014, equation 99).
pub fn facets(index: f64, exponent: f64, cos: f64, [steps, turns]: [u32; 2]) -> [f64; 2] {
    let a2 = 2.0 / (exponent + 2.0);
    let sin = (1.0 - cos * cos).sqrt();
    // Smith's G₁ is 1 / (1 + Λ).
    let lambda = |c: f64| 0.5 * ((1.0 + a2 * (1.0 / (c * c) - 1.0)).sqrt() - 1.0);
    // Normals by their slope: with tan² = a² p / (1 − p), D cos dh is evenly spread over p and the azimuth.
    let over_normals = |of: &dyn Fn(f64, f64) -> f64| {
        // The steepest, of which 1 / z has no bound, by 1 − p = s².
        integral(0.0, 1.0, steps, |s| {
            let z = (1.0 / (1.0 + a2 * (1.0 - s * s) / (s * s))).sqrt();
            let r = (1.0 - z * z).sqrt();
            4.0 * s
                * integral(0.0, 0.5, turns, |turn| {
                    let dot = sin * r * (TAU * turn).cos() + cos * z;
                    if dot > 0.0 { of(dot, z) * dot / (cos * z) } else { 0.0 }
                })
        })
    };
    let reflected = |dot: f64, z: f64| {
        let out = 2.0 * dot * z - cos;
        if out > 0.0 { fresnel(dot, index) / (1.0 + lambda(cos) + lambda(out)) } else { 0.0 }
    };
    // Snell's law gives the cosine to the facet on the other side, and with it how far down the light goes.
    let passed = |dot: f64, z: f64| {
        let inside = (1.0 - (1.0 - dot * dot) / (index * index)).sqrt();
        let down = cos / index + z * (inside - dot / index);
        if down > 0.0 {
            (1.0 - fresnel(dot, index)) / ((1.0 + lambda(cos)) * (1.0 + lambda(down)))
        } else {
            0.0
        }
    };
    [over_normals(&reflected), over_normals(&passed)]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A smooth one's are Fresnel's, a rough one loses what meets a second facet, and finer steps change nothing.
    #[test]
    fn shares_have_their_limits() {
        for cos in [1.0, 0.5] {
            let [reflected, passed] = facets(INDEX, 1e7, cos, [1000, 300]);
            let mirror = fresnel(cos, INDEX);
            assert!(
                (reflected - mirror).abs() < 1e-4 && (passed - 1.0 + mirror).abs() < 1e-4,
                "{reflected} {passed}"
            );
            let [reflected, passed] = shares(cos);
            assert!((0.9..1.0).contains(&(reflected + passed)), "{reflected} {passed}");
            let finer = facets(INDEX, EXPONENT, cos, [3000, 500]);
            assert!(
                (finer[0] - reflected).abs() < 1e-6 && (finer[1] - passed).abs() < 1e-6,
                "{finer:?} {reflected} {passed}"
            );
        }
    }
}
