//! The directional albedo of microfacets: how much of the light from a direction one bounce sends up again.
//!
//! For a view o that is E(o) = ∫ F(o·h) G2(o, i) D(h) (o·h) / cos o dh over the normals h that send light up (Heitz
//! 2014, "Understanding the Masking-Shadowing Function", equations 16 and 99, with G2 = 1 / (1 + Λo + Λi)). Written in
//! the slopes of the facets, ρ (cos φ, sin φ) for h ∝ (ρ cos φ, ρ sin φ, 1):
//!
//! - o·h > 0 and i.z > 0 is the inside of a circle, ρ² - 2 ρ tan θo cos φ < 1, that holds the origin: at each azimuth the
//!   slopes go from 0 to one bound, ρ = tan θo cos φ + √(tan² θo cos² φ + 1), where the light leaves along the surface;
//! - D is the density 1 / (π α² (1 + ρ²/α²)²) of slopes, which with ρ = α tan x becomes sin 2x dx dφ / 2π.
//!
//! What is left is smooth within exact bounds, and Gauss's rule takes care of it. It bends most at the outer bound, within
//! α of it, and at grazing views beside φ = 90°: nodes are dense at both.

// tidy: load-time mathematics

use crate::directional_albedo::{AlbedoRow, integral};
use crate::microfacet::Microfacets;
use indigo_math::{Float, Real};
use std::f64::consts::{FRAC_1_PI, FRAC_PI_2};

/// Pieces of azimuth on either side, and of slopes: right to 5e-5 at all widths and views of a smooth reflectance.
const PIECES: [usize; 2] = [2, 3];
/// The same for a reflectance that has a kink, as from inside of the denser of two dielectrics at the angle of total
/// reflection.
const PIECES_BESIDE_KINK: [usize; 2] = [8, 12];
/// How much they give too little at most, for indices from 0.7 on.
const LACK_BESIDE_KINK: f64 = 1e-3;

impl AlbedoRow {
    /// Of facets of a reflectance by the cosine to the facet.
    pub fn of_facets(facets: Microfacets, reflectance: impl Fn(Real) -> Real) -> Self {
        let alpha = facets.width().to_f64();
        // By trial: rows are right to 1e-4 at exponents up to 10,000.
        Self::new(alpha.sqrt() + 0.4, |mu| facet_albedo(alpha, mu, PIECES, &reflectance))
    }

    /// Not below that of facets of a reflectance with a kink at a cosine to the facet.
    pub fn above_facets(facets: Microfacets, kink: Real, reflectance: impl Fn(Real) -> Real) -> Self {
        let alpha = facets.width().to_f64();
        Self::above(kink.to_f64(), |mu| {
            facet_albedo(alpha, mu, PIECES_BESIDE_KINK, &reflectance) + LACK_BESIDE_KINK
        })
    }
}

/// The share of light that is seen under cosine `mu` after one bounce from facets of width `alpha` in (0, 1], of a
/// reflectance by the cosine to the facet.
fn facet_albedo(alpha: f64, mu: f64, pieces: [usize; 2], reflectance: impl Fn(Real) -> Real) -> f64 {
    let o = View { alpha, mu, sin: (1.0 - mu * mu).max(0.0).sqrt(), pieces };
    // Both halves of the azimuths are alike. t = 0 is φ = 90°.
    let ahead = |sign: f64| {
        integral([0.0, 1.0], pieces[0], |t| {
            2.0 * t * FRAC_PI_2 * o.at_azimuth(sign * (FRAC_PI_2 * t * t).sin(), &reflectance)
        })
    };
    FRAC_1_PI * (ahead(1.0) + ahead(-1.0))
}

/// Facets and the direction that they are seen from.
struct View {
    alpha: f64,
    mu: f64,
    sin: f64,
    pieces: [usize; 2],
}

impl View {
    /// The integral over the slopes at an azimuth of some cosine to the view's.
    fn at_azimuth(&self, cos_phi: f64, reflectance: &impl Fn(Real) -> Real) -> f64 {
        let ahead = self.sin * cos_phi;
        let root = ahead.hypot(self.mu);
        // (ahead + root) / μ, or the same without cancellation, μ / (root - ahead).
        let end = if ahead >= 0.0 {
            (ahead + root).atan2(self.alpha * self.mu)
        } else {
            self.mu.atan2(self.alpha * (root - ahead))
        };
        integral([0.0, 1.0], self.pieces[1], |v| {
            let rest = 1.0 - v;
            2.0 * rest * end * self.at_slope(end * (1.0 - rest * rest), ahead, reflectance)
        })
    }

    /// F G2 (1 + ρ tan θo cos φ) sin 2x.
    fn at_slope(&self, x: f64, ahead: f64, reflectance: &impl Fn(Real) -> Real) -> f64 {
        let rho = self.alpha * x.tan();
        // (o·h) / h.z, and 1 / h.z².
        let (seen, steep) = (self.mu + ahead * rho, 1.0 + rho * rho);
        let down = 2.0 * seen / steep - self.mu;
        if down <= 0.0 {
            return 0.0;
        }
        let stretch = |z: f64| (z * z + self.alpha * self.alpha * (1.0 - z * z)).sqrt();
        let shared = 2.0 / (stretch(self.mu) + self.mu * stretch(down) / down);
        reflectance(Real::from_f64(seen / steep.sqrt())).to_f64() * shared * seen * (2.0 * x).sin()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fresnel::dielectric;
    use indigo_math::Vec3;
    use indigo_testkit::quadrature::hemisphere;

    const EXPONENTS: [f64; 9] = [0.0, 1.0, 5.0, 20.0, 45.0, 100.0, 300.0, 900.0, 3000.0];
    const COSINES: [f64; 6] = [1.0, 0.9, 0.6, 0.25, 0.06, 0.01];

    /// By another way: over the directions of the light, of the functions that paths use.
    fn over_directions(exponent: f64, mu: f64, reflectance: impl Fn(Real) -> Real) -> f64 {
        let facets = Microfacets::of_exponent(exponent as Real);
        let o = Vec3::new((1.0 - mu * mu).sqrt() as Real, 0.0, mu as Real);
        let light = |i: [f64; 3]| {
            let i = Vec3::new(i[0] as Real, i[1] as Real, i[2] as Real);
            let Some(h) = (o + i).try_normalized() else { return 0.0 };
            let gloss = facets.density(h) * facets.shared_over_cosines(o, i);
            f64::from(reflectance(o.dot(h)) * gloss * i.z)
        };
        hemisphere(1e-5, light).value
    }

    #[test]
    fn rows_have_the_albedo_of_the_facets() {
        for eta in [None, Some(1.5), Some(2.5)] {
            let reflectance = |cos: Real| eta.map_or(1.0, |eta| dielectric(cos, eta).reflectance);
            for exponent in EXPONENTS {
                let row = AlbedoRow::of_facets(Microfacets::of_exponent(exponent as Real), reflectance);
                for mu in COSINES {
                    let (row, exact) =
                        (f64::from(row.at(mu as Real)), over_directions(exponent, mu, reflectance));
                    assert!((row - exact).abs() < 1e-4, "{eta:?}, {exponent}, {mu}: {row} for {exact}");
                }
            }
        }
    }

    /// From inside of the denser of two dielectrics, where no row can follow the reflectance.
    #[test]
    fn rows_above_facets_are_nowhere_below_them() {
        for (eta, exponent) in [(0.868, 1e6), (0.933, 1e6), (0.933, 1000.0), (0.882, 100.0), (0.7, 3.0)] {
            let facets = Microfacets::of_exponent(exponent as Real);
            let alpha = facets.width().to_f64();
            let reflectance = |cos: Real| dielectric(cos, eta).reflectance;
            let row = AlbedoRow::above_facets(facets, ((1.0 - eta * eta) as Real).sqrt(), reflectance);
            let above = |mu: f64| {
                let exact = facet_albedo(alpha, mu, [24, 36], reflectance);
                let above = f64::from(row.at(mu as Real)) - exact;
                assert!(above > 0.0 || exact > 1.0 - 1e-4, "{eta}, {exponent}, {mu}: {above}");
                above
            };
            let mean = (0..99).map(|i| (f64::from(i) + 0.5) / 99.0).map(|mu| 2.0 * mu * above(mu) / 99.0);
            let mean: f64 = mean.sum();
            assert!(mean < 1.5e-3, "{eta}, {exponent}: a white ground loses {mean}");
        }
    }

    /// The table of the page on gloss, by the other way.
    #[test]
    fn stated_gloss_is_right() {
        const PAGE: &str = include_str!("../../../docs/theory/gloss.md");
        let table = PAGE.split("<!-- table -->").nth(1).expect("a table");
        let cells = |line: &str| line.split('|').filter_map(|cell| cell.trim().parse().ok()).collect();
        let rows: Vec<Vec<f64>> = table.lines().map(cells).filter(|row: &Vec<f64>| row.len() == 10).collect();
        assert_eq!(rows.len(), 6);
        for row in rows {
            let views =
                [None, Some(1.5), Some(2.5)].into_iter().flat_map(|eta| [0.0, 60.0, 80.0].map(|d| (eta, d)));
            for ((eta, degrees), stated) in views.zip(&row[1..]) {
                let reflectance = |cos: Real| eta.map_or(1.0, |eta| dielectric(cos, eta).reflectance);
                let exact = over_directions(row[0], f64::to_radians(degrees).cos(), reflectance);
                let what = format!("exponent {}, {eta:?}, {degrees}°: {exact}, and not {stated}", row[0]);
                assert!((exact - stated).abs() < 6e-4, "{what}");
            }
        }
    }

    /// Seen along the surface, white facets send everything up; and so does a mirror from anywhere.
    #[test]
    fn limits_are_exact() {
        for alpha in [1.0, 0.1, 1e-4] {
            assert!((facet_albedo(alpha, 0.0, PIECES, |_| 1.0) - 1.0).abs() < 1e-5, "{alpha}");
        }
        assert!((facet_albedo(1e-4, 0.5, PIECES, |_| 1.0) - 1.0).abs() < 1e-5);
        // Facets as rough as can be, along the normal: E = 1 - ln 2.
        assert!((facet_albedo(1.0, 1.0, PIECES, |_| 1.0) - (1.0 - std::f64::consts::LN_2)).abs() < 1e-5);
    }
}
