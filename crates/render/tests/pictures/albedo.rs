//! In light that is the same from everywhere, every material shows its albedo by every technique under every driver:
//! the quadrature of its own model, or where that is of delta kind, Fresnel's formula.
//!
//! Verdicts are those of `common::judge`: within 2e-3, or 1e-3 where nothing is lost, by a mean whose standard error is
//! at most a quarter of that. So a right program fails where a mean lies 4 standard errors off, with the probability
//! that is stated there for 16 batches: at most 1e-3 for each, for those at the limit of scatter.

use super::common::judge::{NITS_PER_UNIFORM, assert_near};
use super::common::text::{basic, grey, medium, null, uniform};
use super::common::{MODES, luminance_in_mode};
use super::materials::{RADIANCE, albedo_of, phong, point, sheet_with};
use indigo_math::Real;
use indigo_scatter::Interface;
use indigo_scatter::materials::KINDS;
use indigo_spectrum::{SampledSpectrum, Spectrum};

const INDEX: f64 = 1.5;

/// A sheet of a material, and what is expected of it.
struct Row {
    kind: String,
    /// What else its scene holds.
    others: String,
    /// Luminance over that of the surroundings, by the angle of the view.
    shows: Box<dyn Fn(f64) -> f64>,
}

impl Row {
    fn new(kind: impl Into<String>, others: impl Into<String>, shows: impl Fn(f64) -> f64 + 'static) -> Self {
        Self { kind: kind.into(), others: others.into(), shows: Box::new(shows) }
    }

    /// Of a material that is its own model, with the same albedo at all wavelengths.
    fn grey(kind: String) -> Self {
        let model = kind.clone();
        Self::new(kind, "", move |degrees| quadrature(&model, "", degrees, 550.0, Interface::NONE))
    }
}

fn quadrature(kind: &str, others: &str, degrees: f64, nm: f64, interface: Interface) -> f64 {
    let scene = sheet_with(kind, degrees, "", others);
    albedo_of(&point(&scene, degrees, nm as Real, interface))
}

/// The luminance that an albedo by wavelength, tabulated every 5 nm, has in even light of all wavelengths, over
/// that of the light.
fn luminous(albedo: impl Fn(f64) -> f64) -> f64 {
    let values: Vec<f64> = (0..=94).map(|i| albedo(360.0 + 5.0 * f64::from(i))).collect();
    let spectrum = Spectrum::regular_tabulated(360e-9, 830e-9, &values).expect("a table");
    spectrum.xyz()[1] / NITS_PER_UNIFORM
}

/// Of a smooth interface between air and glass, unpolarised.
fn fresnel(degrees: f64) -> f64 {
    let (sin, cos) = degrees.to_radians().sin_cos();
    let cos_t = (1.0 - (sin / INDEX).powi(2)).sqrt();
    let (s, p) =
        ((cos - INDEX * cos_t) / (cos + INDEX * cos_t), (INDEX * cos - cos_t) / (INDEX * cos + cos_t));
    0.5 * (s * s + p * p)
}

fn albedo_spectrum(value: f64) -> String {
    format!("<albedo_spectrum>{}</albedo_spectrum>", uniform(value))
}

/// A medium of which nothing comes back: what enters it is lost.
fn dark() -> String {
    medium("dark", 10, &basic(INDEX, &uniform(1e9), ""))
}

fn clear() -> String {
    medium("clear", 10, &basic(INDEX, &uniform(0.0), ""))
}

fn rough(medium: &str, exponent: f64) -> String {
    format!(
        "<glossy_transparent><internal_medium_name>{medium}</internal_medium_name><exponent>{exponent}</exponent>\
         </glossy_transparent>"
    )
}

fn smooth(medium: &str, is_transparent: bool) -> String {
    format!(
        "<specular><transparent>{is_transparent}</transparent><internal_medium_name>{medium}</internal_medium_name></specular>"
    )
}

fn blend(factor: f64, a: &str, b: &str) -> String {
    format!("<blend><blend_factor>{factor}</blend_factor><a_name>{a}</a_name><b_name>{b}</b_name></blend>")
}

/// A coat over a ground, as dull as `exponent` says.
fn coat(exponent: f64, ground: f64) -> String {
    phong(&format!(
        "<ior>1.6</ior><exponent>{exponent}</exponent><diffuse_albedo_spectrum>{}</diffuse_albedo_spectrum>",
        uniform(ground)
    ))
}

/// A metal of a reflectivity.
fn metal(exponent: f64, reflectivity: f64) -> String {
    phong(&format!(
        "<exponent>{exponent}</exponent><specular_reflectivity_spectrum>{}</specular_reflectivity_spectrum>",
        uniform(reflectivity)
    ))
}

/// Every kind of material at least once.
fn rows() -> Vec<Row> {
    let glass = Interface { below: SampledSpectrum::splat(INDEX as Real), ..Interface::NONE };
    // A sheet with glass behind it, and the same light in the glass as in the air before it.
    let frosted = |inside: fn() -> String, name: &'static str, exponent: f64| {
        Row::new(rough(name, exponent), inside(), move |degrees| {
            quadrature(&rough(name, exponent), &inside(), degrees, 550.0, glass)
        })
    };
    let gold = phong("<nk_data>au.nk</nk_data><exponent>40</exponent>");
    let mixed = blend(0.3, "matt", "coated");
    let parts = grey("matt", 0.8) + &format!("<material><name>coated</name>{}</material>", coat(40.0, 0.2));
    vec![
        Row::grey(format!("<diffuse>{}</diffuse>", albedo_spectrum(0.6))),
        Row::grey(format!("<oren_nayar><sigma>0.6</sigma>{}</oren_nayar>", albedo_spectrum(0.6))),
        Row::grey(format!("<diffuse_transmitter>{}</diffuse_transmitter>", albedo_spectrum(0.6))),
        Row::grey(coat(40.0, 0.6)),
        Row::grey(metal(5.0, 0.6)),
        Row::new(gold.clone(), "", move |degrees| {
            luminous(|nm| quadrature(&gold, "", degrees, nm, Interface::NONE))
        }),
        frosted(clear, "clear", 5.0),
        frosted(clear, "clear", 100.0),
        frosted(clear, "clear", 1000.0),
        // Radiance that comes out of the glass is divided by its index squared.
        Row::new(smooth("clear", true), clear(), |degrees| {
            fresnel(degrees) + (1.0 - fresnel(degrees)) / (INDEX * INDEX)
        }),
        Row::new(smooth("dark", false), dark(), fresnel),
        Row::new("<null_material/>", "", |_| 1.0),
        Row::new(mixed, parts, |degrees| {
            0.7 * 0.8 + 0.3 * quadrature(&coat(40.0, 0.2), "", degrees, 550.0, Interface::NONE)
        }),
        Row::new(blend(0.3, "matt", "nothing"), grey("matt", 0.8) + &null("nothing"), |_| 0.7 * 0.8 + 0.3),
    ]
}

#[test]
fn every_kind_of_material_has_a_row() {
    let rows = rows();
    for kind in KINDS {
        let tag = format!("<{}", kind.name);
        assert!(rows.iter().any(|row| row.kind.starts_with(&tag)), "{} has no furnace", kind.name);
    }
}

#[test]
fn every_material_shows_its_albedo_in_even_light() {
    for Row { kind, others, shows } in rows() {
        let views = [(0.0, MODES[0]), (75.0, MODES[0]), (60.0, MODES[1]), (60.0, MODES[3])];
        for (degrees, mode) in views {
            let mut scene = sheet_with(&kind, degrees, "", &others);
            // A chain's neighbours are alike, so it takes more of them.
            let passes = if mode.metropolis { 12_288 } else { 768 };
            let measured = luminance_in_mode(&mut scene, mode, 16, passes);
            let expected = shows(degrees) * RADIANCE * NITS_PER_UNIFORM;
            assert_near(&format!("{kind} at {degrees}°, {mode}"), &measured, expected, 2e-3);
        }
    }
}

/// Within 1e-3. Smooth glass is in `media`, as bodies of it.
#[test]
fn what_absorbs_nothing_is_not_to_be_told_from_its_surroundings() {
    let white = format!("<diffuse>{}</diffuse>", albedo_spectrum(1.0));
    let mirror = metal(1e12, 1.0);
    let others = [
        format!("<oren_nayar><sigma>0.9</sigma>{}</oren_nayar>", albedo_spectrum(1.0)),
        format!("<diffuse_transmitter>{}</diffuse_transmitter>", albedo_spectrum(1.0)),
        coat(10.0, 1.0),
        coat(20_000.0, 1.0),
        metal(2.0, 1.0),
    ];
    let independent = &MODES[..2];
    let in_all_modes = [white, mirror].into_iter().map(|kind| (kind, &MODES[..]));
    for (kind, modes) in in_all_modes.chain(others.into_iter().map(|kind| (kind, independent))) {
        for mode in modes {
            let passes = if mode.metropolis { 1536 } else { 640 };
            let mut scene = sheet_with(&kind, 70.0, "", "");
            let measured = luminance_in_mode(&mut scene, *mode, 16, passes);
            assert_near(&format!("{kind}, {mode}"), &measured, RADIANCE * NITS_PER_UNIFORM, 1e-3);
        }
    }
}

/// What facets lose among one another is given back, whatever their width, also where a map gives it.
#[test]
fn metals_of_any_exponent_are_white() {
    let mapped = phong(&format!(
        "<exponent_map><path>half.exr</path><exponent>1</exponent><b>90</b></exponent_map>\
         <specular_reflectivity_spectrum>{}</specular_reflectivity_spectrum>",
        uniform(1.0)
    ));
    for (kind, degrees) in [
        (metal(45.0, 1.0), 0.0),
        (metal(45.0, 1.0), 45.0),
        (metal(300.0, 1.0), 0.0),
        (metal(900.0, 1.0), 0.0),
        (metal(900.0, 1.0), 45.0),
        (mapped, 45.0),
    ] {
        for mode in &MODES[..2] {
            let mut scene = sheet_with(&kind, degrees, "", "");
            let measured = luminance_in_mode(&mut scene, *mode, 16, 640);
            let what = format!("{kind} at {degrees}°, {mode}");
            assert_near(&what, &measured, RADIANCE * NITS_PER_UNIFORM, 1e-3);
        }
    }
}
