//! Do coats and films look as they are said to? Against closed forms.

use super::common::judge::{NITS_PER_UNIFORM, assert_near};
use super::common::measure;
use super::common::text::{grey, uniform};
use super::materials::{RADIANCE, sheet_with};
use indigo_spectrum::observer::cmf;
use num_complex::Complex;
use std::f64::consts::TAU;

fn coat(more: &str) -> String {
    format!("<coating><substrate_material_name>below</substrate_material_name>{more}</coating>")
}

/// A smooth coat shows F + R (1 − F) of even light at an angle, where it throws a part r of the ground's light back: R = ρ (1 − r) / (1 − ρ r)
/// and r = 1 − (1 − s 0.091778) / 1.5² with s the `fresnel_scale`; F is 0.04 along the normal and 0.089195 at 60°.
#[test]
fn a_coat_deepens_the_colour_below() {
    let ground = |albedo: f64, scale: f64| {
        let r = 1.0 - (1.0 - scale * 0.091_778) / 2.25;
        albedo * (1.0 - r) / (1.0 - albedo * r)
    };
    for (albedo, more, degrees, fresnel, scale) in [
        (0.5, "", 0.0, 0.04, 1.0),
        (
            0.5,
            "<ior><constant>1.5</constant></ior><interference>false</interference><thickness><constant>1</constant></thickness>",
            60.0,
            0.089_195,
            1.0,
        ),
        (1.0, "", 0.0, 0.04, 1.0),
        (0.5, "<fresnel_scale><constant>0.4</constant></fresnel_scale>", 0.0, 0.04, 0.4),
        (0.5, "<fresnel_scale><constant>0</constant></fresnel_scale>", 0.0, 0.04, 0.0),
    ] {
        let scene = sheet_with(&coat(more), degrees, "", &grey("below", albedo));
        let reflected = scale * fresnel;
        let expected = reflected + ground(albedo, scale) * (1.0 - reflected);
        assert_near(
            &format!("{albedo}, {more}, {degrees}°"),
            measure(&scene, 8, 400).luminance(),
            RADIANCE * NITS_PER_UNIFORM * expected,
            5e-3,
        );
    }
}

/// Fresnel's reflectance from outside a coat of index 1.5, and the cosine inside.
fn enter(cos: f64) -> (f64, f64) {
    let inside = (1.0 - (1.0 - cos * cos) / 2.25).sqrt();
    let parallel = (1.5 * cos - inside) / (1.5 * cos + inside);
    let perpendicular = (cos - 1.5 * inside) / (cos + 1.5 * inside);
    (0.5 * (parallel * parallel + perpendicular * perpendicular), inside)
}

/// ∫ over [0, 1] by the midpoint rule.
fn integral(f: impl Fn(f64) -> f64) -> f64 {
    let n = 20_000;
    (0..n).map(|i| f((f64::from(i) + 0.5) / f64::from(n))).sum::<f64>() / f64::from(n)
}

/// Of even light a smooth coat of optical depth τ reflects F at an angle; A = 2 ∫ (1 − F) exp(−τ / cos′) cos dcos reaches a ground of
/// albedo ρ, which throws ρ up; ρ r of that comes down again, r = 2 ∫ R exp(−2 τ / μ) μ dμ with the reflectance R from inside; and of
/// what goes towards the eye (1 − F) exp(−τ / cos′) / η² comes out.
#[test]
fn a_coat_absorbs_on_each_way() {
    for (albedo, depth, degrees) in
        [(0.5f64, 0.2, 0.0f64), (0.5, 0.2, 60.0), (1.0, 1.0, 30.0), (1.0, 0.02, 75.0)]
    {
        let through = |cos: f64| {
            let (reflected, inside) = enter(cos);
            (1.0 - reflected) * (-depth / inside).exp()
        };
        let arrives = integral(|cos| 2.0 * cos * through(cos));
        let thrown_back = integral(|cos| {
            // From inside: total reflection below the critical cosine, and the same reflectance beyond, by its cosine outside.
            let sin2_outside = 2.25 * (1.0 - cos * cos);
            let reflected = if sin2_outside >= 1.0 { 1.0 } else { enter((1.0 - sin2_outside).sqrt()).0 };
            2.0 * cos * reflected * (-2.0 * depth / cos).exp()
        });
        let cos = degrees.to_radians().cos();
        let ground = arrives * albedo / (1.0 - albedo * thrown_back) * through(cos) / 2.25;
        let expected = enter(cos).0 + ground;
        let absorption = uniform(depth / 0.002);
        let more =
            format!("<absorption><constant>{absorption}</constant></absorption><thickness>0.002</thickness>");
        let scene = sheet_with(&coat(&more), degrees, "", &grey("below", albedo));
        assert_near(
            &format!("albedo {albedo}, depth {depth}, {degrees}°"),
            measure(&scene, 8, 1000).luminance(),
            RADIANCE * NITS_PER_UNIFORM * expected,
            3e-3,
        );
    }
}

/// Reflectance of a clear film on a metal by the characteristic matrix of the film (Born & Wolf, section 1.6.2).
fn filmed(cos: f64, film: f64, metal: Complex<f64>, thickness_over_lambda: f64) -> f64 {
    let sin2 = 1.0 - cos * cos;
    let squares = [Complex::from(1.0), Complex::from(film * film), metal * metal];
    let normal = squares.map(|square| (square - sin2).sqrt());
    let phase = normal[1] * (TAU * thickness_over_lambda);
    let of = |[outside, within, below]: [Complex<f64>; 3]| {
        let (cos, sin) = (phase.cos(), Complex::<f64>::i() * phase.sin());
        let (electric, magnetic) = (cos - sin * below / within, cos * below - sin * within);
        ((outside * electric - magnetic) / (outside * electric + magnetic)).norm_sqr()
    };
    0.5 * (of(normal) + of([0, 1, 2].map(|i| squares[i] / normal[i])))
}

/// A film on a mirror of metal: even light comes back by the film's reflectance at each wavelength, in X, Y and Z.
#[test]
fn a_film_on_a_metal_interferes() {
    let metal = "<material><name>below</name><phong><nk_data>flat.nk</nk_data><exponent>1e12</exponent></phong></material>";
    for (film, nm, degrees) in [(2.4, 60.0, 0.0f64), (2.4, 140.0, 60.0), (1.4, 900.0, 30.0)] {
        let more =
            format!("<ior>{film}</ior><interference>true</interference><thickness>{nm}e-9</thickness>");
        let measured = measure(&sheet_with(&coat(&more), degrees, "", metal), 8, 2000);
        let cos = degrees.to_radians().cos();
        let (mut reflected, mut all) = ([0.0f64; 3], 0.0f64);
        for i in 0..4700 {
            let lambda = 360.05 + 0.1 * f64::from(i);
            let seen = cmf(lambda);
            all += seen[1];
            let share = filmed(cos, film, Complex::new(2.7, 3.8), nm / lambda);
            reflected.iter_mut().zip(seen).for_each(|(sum, weight)| *sum += share * weight);
        }
        for (axis, sum) in reflected.into_iter().enumerate() {
            let expected = RADIANCE * NITS_PER_UNIFORM * sum / all;
            let what = format!("film of {film}, {nm} nm, {degrees}°, axis {axis}");
            assert_near(&what, &measured.xyza[axis], expected, 5e-3);
        }
    }
}
