//! Coats and clay over grey ground: their albedos by quadrature.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use super::super::check::{Check, TECHNIQUES};
use super::super::text::uniform;
use super::frosted::facets;
use super::furnaces::sheet_in_even_light;
use super::glass::fresnel;
use super::{integral, material};

const GROUP: &str = "Gloss and clay";
/// What directional albedos of facets are tabulated to (`docs/theory/gloss.md`): a ten-thousandth.
const TABULATED: f64 = 1e-4;

/// All of them.
pub fn checks() -> Vec<Check> {
    let coats = [(40.0, 0.5, 0.0), (40.0, 0.5, 60.0), (1e12, 0.2, 70.0)].map(|(n, grey, d)| coat(n, grey, d));
    let clays =
        [(0.5, 0.5, 0.0), (0.5, 0.5, 70.0), (0.9, 0.3, 50.0)].map(|(sigma, grey, d)| clay(sigma, grey, d));
    let tinted = [(0.5, 0.2, 0.0), (0.8, 0.5, 60.0)].map(|(grey, depth, d)| absorbing_coat(grey, depth, d));
    [coats.as_slice(), &clays, &tinted].concat()
}

/// A smooth coat of index 1.5 and an optical depth along the normal, over grey ground.
fn absorbing_coat(grey: f64, depth: f64, degrees: f64) -> Check {
    const INDEX: f64 = 1.5;
    const THICKNESS: f64 = 1e-3;
    let inside = |cos: f64| (1.0 - (1.0 - cos * cos) / (INDEX * INDEX)).sqrt();
    let through = |cos: f64| (1.0 - fresnel(cos, INDEX)) * (-depth / inside(cos)).exp();
    // By the root of the cosine, of which Fresnel's reflectance at grazing angles is smooth.
    let enters = integral(0.0, 1.0, 200, |s| 4.0 * s.powi(3) * through(s * s));
    let critical = inside(0.0);
    let way = |cos: f64| 2.0 * cos * (-2.0 * depth / cos).exp();
    let partly = |s: f64| 4.0 * s.powi(3) * fresnel(s * s, INDEX) * (-2.0 * depth / inside(s * s)).exp();
    let back = integral(0.0, critical, 200, way) + integral(0.0, 1.0, 200, partly) / (INDEX * INDEX);
    let cos = degrees.to_radians().cos();
    let ground = enters * grey / (1.0 - grey * back) * through(cos) / (INDEX * INDEX);
    let kind = format!(
        "<coating><substrate_material_name>ground</substrate_material_name><ior>{INDEX}</ior><thickness>{THICKNESS}</thickness>\
         <absorption><constant>{}</constant></absorption></coating>",
        uniform(depth / THICKNESS)
    );
    let about = format!(
        "F + A ρ T / ((1 − ρ r) n²), n = {INDEX}, ρ = {grey}, optical depth {depth}: Fresnel's F; T = (1 − F) exp(−τ / cos′) towards \
         the eye; A = {enters:.5}, the same of even light; and r = {back:.5} of the ground's light that the coat throws back, by \
         quadrature (Saunderson 1942, with absorption)."
    );
    let name = format!("coat of optical depth {depth} over grey at {degrees}°");
    let parts = [
        material(
            "ground",
            &format!("<diffuse><albedo_spectrum>{}</albedo_spectrum></diffuse>", uniform(grey)),
        ),
        material("m", &kind),
    ];
    Check::new(GROUP, name, about, sheet_in_even_light(degrees, &parts))
        .unit(super::AROUND_NITS)
        .is(fresnel(cos, INDEX) + ground, TABULATED)
        .by(TECHNIQUES)
}

/// A glossy coat of index 1.5: what the facets do not reflect reaches the ground.
fn coat(exponent: f64, grey: f64, degrees: f64) -> Check {
    let facets = coat_albedo(1.5, exponent, degrees.to_radians().cos());
    let kind = format!(
        "<phong><ior>1.5</ior><exponent>{exponent}</exponent><diffuse_albedo_spectrum>{}</diffuse_albedo_spectrum></phong>",
        uniform(grey)
    );
    let about = format!(
        "E + ρ (1 − E) with ρ = {grey} and E = {facets:.5} of Trowbridge and Reitz's facets of the exponent {exponent} with \
         Fresnel's reflectance at n = 1.5 and Smith's masking, by quadrature (Kelemen and Szirmay-Kalos 2001); E is tabulated \
         to {TABULATED}."
    );
    let name = format!("coat of exponent {exponent} over grey at {degrees}°");
    let parts = [material("m", &kind)];
    Check::new(GROUP, name, about, sheet_in_even_light(degrees, &parts))
        .unit(super::AROUND_NITS)
        .is(facets + grey * (1.0 - facets), TABULATED * (1.0 - grey))
        .by(TECHNIQUES)
        .quickly(48)
}

/// Oren and Nayar's facets of grey albedo.
fn clay(sigma: f64, grey: f64, degrees: f64) -> Check {
    let once = clay_albedo(sigma, degrees.to_radians().cos());
    let average = integral(0.0, 1.0, 60, |s| 4.0 * s.powi(3) * clay_albedo(sigma, s * s));
    // Of what one bounce does not scatter the same share gets out after each further one.
    let further = grey * grey * average / (1.0 - grey * (1.0 - average));
    let kind = format!(
        "<oren_nayar><sigma>{sigma}</sigma><albedo_spectrum>{}</albedo_spectrum></oren_nayar>",
        uniform(grey)
    );
    let about = format!(
        "One bounce by equation 27 of Oren and Nayar 1994 scatters ρ E, E = {once:.5} by quadrature, ρ = {grey}; further ones \
         ρ² Ē (1 − E) / (1 − ρ (1 − Ē)), Ē = {average:.5} (Kulla and Conty 2017); E is tabulated to {TABULATED}."
    );
    let name = format!("grey clay, σ {sigma}, at {degrees}°");
    let parts = [material("m", &kind)];
    Check::new(GROUP, name, about, sheet_in_even_light(degrees, &parts))
        .unit(super::AROUND_NITS)
        .is(grey * once + further * (1.0 - once), TABULATED * further)
        .by(TECHNIQUES)
        .quickly(48)
}

/// Share of light that facets reflect at once, seen under a cosine; of nearly smooth ones Fresnel's reflectance.
fn coat_albedo(index: f64, exponent: f64, cos: f64) -> f64 {
    if exponent > 1e7 { fresnel(cos, index) } else { facets(index, exponent, cos, [1000, 300])[0] }
}

/// The share of light that one bounce among white facets scatters: equation 27 of Oren and Nayar 1994, with α the larger
/// and β the smaller angle to the normal.
fn clay_albedo(sigma: f64, cos: f64) -> f64 {
    let s2 = sigma * sigma;
    let [c1, rough] = [1.0 - 0.5 * s2 / (s2 + 0.33), s2 / (s2 + 0.09)];
    let seen = cos.acos();
    integral(0.0, FRAC_PI_2, 400, |lit| {
        let (alpha, beta) = (seen.max(lit), seen.min(lit));
        let back = 2.0 * beta / PI;
        let c3 = 0.125 * rough * (4.0 * alpha * beta / (PI * PI)).powi(2);
        let round = 2.0
            * integral(0.0, 0.5, 200, |turn| {
                let across = (TAU * turn).cos();
                let ahead = if across >= 0.0 { 0.0 } else { back.powi(3) };
                let c2 = 0.45 * rough * (alpha.sin() - ahead);
                let even = c1 + across * c2 * beta.tan();
                (even + (1.0 - across.abs()) * c3 * (0.5 * (alpha + beta)).tan()).max(0.0)
            });
        2.0 * round * lit.cos() * lit.sin()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A mirror's is Fresnel's; without slopes clay is Lambert's; and nothing scatters more than arrives.
    #[test]
    fn albedos_have_their_limits() {
        for cos in [1.0, 0.5, 0.2] {
            let smooth = coat_albedo(1.5, 1e6, cos);
            assert!((smooth / fresnel(cos, 1.5) - 1.0).abs() < 2e-3, "{smooth}");
            assert!((clay_albedo(0.0, cos) - 1.0).abs() < 1e-4);
            assert!((0.5..1.0).contains(&clay_albedo(0.5, cos)));
            assert!((0.5..1.0).contains(&clay_albedo(0.9, cos)));
        }
    }
}
