//! `oren_nayar`: a rough surface without gloss.
//!
//! Light that meets one facet is scattered as in the functional approximation of Oren & Nayar 1994,
//! "Generalization of Lambert's Reflectance Model", equation 27 (terms C1, C2 and C3; of its variables
//! α is the larger and β the smaller angle to the normal, φ the azimuth between them). Their equation 29 for
//! light between facets is a fit to two bounces that makes white surfaces absorb up to 22.5 % of light from up to 85°,
//! and scatter up to 103 %. Here what is missing after one bounce is scattered on instead by `AlbedoRow::complement`,
//! each further bounce losing the albedo's share, as in Kulla & Conty 2017, so that white stays white. Root
//! mean square of the relative difference to V-shaped cavities of the paper's slope distribution with all
//! bounces, traced by Monte Carlo from 3 into 25 directions of up to 80°:
//!
//! | σ, albedo | this | eq. 27 + 29 | qualitative (eq. 30) | Lambert |
//! |---|---|---|---|---|
//! | 0.2, 0.8 | 0.048 | 0.058 | 0.098 | 0.126 |
//! | 0.5, 0.3 | 0.048 | 0.064 | 0.235 | 0.395 |
//! | 0.5, 0.8 | 0.039 | 0.077 | 0.189 | 0.265 |
//! | 1, 0.2 | 0.169 | 0.179 | 0.299 | 0.668 |
//! | 1, 0.8 | 0.095 | 0.182 | 0.259 | 0.325 |
//! | 1, 1 | 0.085 | 0.220 | 0.312 | 0.240 |
//!
//! These figures are computed anew by `cargo test -p indigo-scatter --test cavities`.

use super::fields::{
    ALBEDO, ALBEDO_SPECTRUM, ALBEDO_TEXTURE, BASE_EMISSION, BASE_EMISSION_PARAMETER, BUMP, BUMP_MAP,
    EMISSION, EMISSION_PARAMETER, EMISSION_TEXTURE, LATER, LAYER,
};
use super::{MaterialContext, MaterialResources, SurfaceKind};
use crate::directional_albedo::{AlbedoRow, integral};
use crate::reflectance::Reflectance;
use crate::scatter::{Crossing, LocalSample, Scatter};
use indigo_decl::{Block, Field, Group, Kind, Node, Parameter, Presence, Range, StandIn};
use indigo_math::elementary::{acos, sin_cos_turns};
use indigo_math::warp::{INV_PI, cosine_hemisphere, cosine_hemisphere_pdf, uniform_hemisphere};
use indigo_math::{Float, Real, Vec2, Vec3};
use indigo_spectrum::{LanePdf, SampledSpectrum};

/// The declaration of `oren_nayar`.
pub static BLOCK: Block = Block::new(
    "oren_nayar",
    "A very rough surface without gloss, such as clay, sprayed concrete, porous rock or the Moon: \
     M. Oren and S. K. Nayar, Generalization of the Lambertian Model and Implications for Machine \
     Vision (1995).",
    &[
        Field::new(
            "sigma",
            Kind::Real,
            Presence::Required,
            "Standard deviation of the slope angles of the microfacets. The higher, the rougher, and the \
             more light is scattered back; 0 is a Lambertian surface.",
        )
        .unit("rad")
        .range(Range::Within(0.0, 1.0)),
        ALBEDO_SPECTRUM,
        ALBEDO_TEXTURE,
        BUMP_MAP,
        BASE_EMISSION,
        EMISSION,
        EMISSION_TEXTURE,
        LAYER,
    ],
)
.with_needs(&[Group::any(&[
    "albedo_spectrum",
    "albedo_texture",
    "base_emission",
    "emission",
    "emission_texture",
])])
.with_parameters(&[
    BASE_EMISSION_PARAMETER,
    EMISSION_PARAMETER,
    ALBEDO,
    BUMP,
    Parameter { name: "sigma", since: "2.0", constant: "sigma", texture: "", stand_in: StandIn::Text("0.3") },
])
.with_later(LATER)
.with_example(
    "<oren_nayar>
    <sigma>0.3</sigma>
    <albedo_spectrum>
        <uniform><value>0.5</value></uniform>
    </albedo_spectrum>
</oren_nayar>",
);

/// A rough surface of Lambertian facets.
#[derive(Clone, Debug)]
pub struct OrenNayar {
    albedo: Reflectance,
    facets: Facets,
    row: AlbedoRow,
}

impl OrenNayar {
    /// From its element.
    pub fn build(node: &Node, resources: &mut dyn MaterialResources) -> Self {
        let albedo = Reflectance::build(node, ["albedo_texture", "albedo_spectrum"], None, resources);
        let (facets, row) = Facets::of_deviation(node.real("sigma"));
        Self { albedo, facets, row }
    }

    /// The model at a point.
    #[inline]
    pub fn leaf(&self, context: &MaterialContext, uv: impl Fn(u32) -> Vec2) -> OrenNayarLeaf {
        let albedo = self.albedo.eval(context, uv);
        let average = self.row.average();
        // One bounce scatters Ē, and of the rest, after each bounce, the same share comes out.
        let between = albedo.map(|a| a * a * average / (1.0 - a * (1.0 - average)));
        OrenNayarLeaf { albedo, between, facets: self.facets, row: self.row }
    }
}

impl SurfaceKind for OrenNayar {}

/// The scale of the rows: nodes dense enough at grazing angles, and still so at normal ones, for 1e-4.
const ROW_SCALE: f64 = 4.0;

/// One bounce between white facets.
#[derive(Clone, Copy, Debug)]
struct Facets {
    /// C1.
    even: Real,
    /// σ² / (σ² + 0.09), the factor of C2 / 0.45 and of C3 / 0.125.
    rough: Real,
    /// Equation 27 gives up to 0.35 % more than arrives, at grazing angles and σ about 0.13; that is taken off.
    scale: Real,
}

impl Facets {
    /// Of a standard deviation of slope angles, with the albedo of one bounce.
    fn of_deviation(sigma: f64) -> (Self, AlbedoRow) {
        let s2 = sigma * sigma;
        let facets = |scale: f64| Self {
            even: Real::from_f64(1.0 - 0.5 * s2 / (s2 + 0.33)),
            rough: Real::from_f64(s2 / (s2 + 0.09)),
            scale: Real::from_f64(scale),
        };
        let raw = AlbedoRow::new(ROW_SCALE, |mu| 0.5 * facets(1.0).albedo(mu));
        let most = 2.0 * raw.at(0.0).max(raw.at(1.0)).to_f64();
        let facets = facets(1.0 / most.max(1.0));
        (facets, AlbedoRow::new(ROW_SCALE, |mu| facets.albedo(mu)))
    }

    /// Radiance over even light from direction `wi`, and π over.
    #[inline]
    fn f(&self, wo: Vec3, wi: Vec3) -> Real {
        let (cos_alpha, cos_beta) = (wo.z.min(wi.z), wo.z.max(wi.z));
        // Both along the surface: no cosine is left by which the value would count.
        if cos_beta <= 0.0 {
            return 0.0;
        }
        let sin = |cos: Real| (1.0 - cos * cos).max(0.0).sqrt();
        let (sin_alpha, sin_beta) = (sin(cos_alpha), sin(cos_beta));
        let sines2 = (wo.x * wo.x + wo.y * wo.y) * (wi.x * wi.x + wi.y * wi.y);
        let cos_phi =
            if sines2 > 0.0 { ((wo.x * wi.x + wo.y * wi.y) / sines2.sqrt()).clamp(-1.0, 1.0) } else { 0.0 };
        let (alpha, beta) = (acos(cos_alpha), acos(cos_beta));
        let back = 2.0 * INV_PI * beta;
        let c2 = 0.45 * (if cos_phi >= 0.0 { sin_alpha } else { sin_alpha - back * back * back });
        let flat = 2.0 * INV_PI * alpha * back;
        let c3 = 0.125 * flat * flat;
        // tan((α + β) / 2) = (sin α + sin β) / (cos α + cos β).
        let tan_mean = (sin_alpha + sin_beta) / (cos_alpha + cos_beta);
        let rough = cos_phi * c2 * sin_beta / cos_beta + (1.0 - cos_phi.abs()) * c3 * tan_mean;
        // The fit falls below 0 where both directions lie along the surface and away from one another, from σ = 0.66 on.
        self.scale * INV_PI * (self.even + self.rough * rough).max(0.0)
    }

    /// The share of light that one bounce scatters, seen under cosine `mu`.
    fn albedo(&self, mu: f64) -> f64 {
        let view = Vec3::new(Real::from_f64((1.0 - mu * mu).sqrt()), 0.0, Real::from_f64(mu));
        // Over half the azimuths, in quarters where cos φ has one sign; cosine = s², dense at grazing angles.
        let quarter = |turns: [f64; 2]| {
            integral(turns, 2, |turns| {
                let (sin_phi, cos_phi) = sin_cos_turns(Real::from_f64(turns));
                integral([0.0, 1.0], 6, |s| {
                    let z = Real::from_f64(s * s);
                    let r = (1.0 - z * z).sqrt();
                    self.f(view, Vec3::new(r * cos_phi, r * sin_phi, z)).to_f64() * 2.0 * s * s * s
                })
            })
        };
        2.0 * std::f64::consts::TAU * (quarter([0.0, 0.25]) + quarter([0.25, 0.5]))
    }
}

/// Facets of one albedo.
///
/// Drawn by cosine and, in part, evenly over the hemisphere, since towards grazing views light is scattered
/// back beyond what the cosine foresees: with a share of a quarter of the roughness the standard deviation
/// of weights is within 15 % of its least at all views from 30° to 89°, and weights stay below 3 where the
/// cosine alone has weights up to 19.
#[derive(Clone, Copy, Debug)]
pub struct OrenNayarLeaf {
    albedo: SampledSpectrum,
    /// Of the light that the first bounce does not scatter, the share that gets out after more.
    between: SampledSpectrum,
    facets: Facets,
    row: AlbedoRow,
}

impl OrenNayarLeaf {
    /// The share of directions that are drawn evenly.
    #[inline]
    fn even_share(&self) -> Real {
        0.25 * self.facets.rough
    }
}

impl Scatter for OrenNayarLeaf {
    #[inline]
    fn is_matt(&self) -> bool {
        true
    }

    #[inline]
    fn f(&self, wo: Vec3, wi: Vec3, crossing: Crossing) -> SampledSpectrum {
        if crossing != Crossing::Reflect {
            return SampledSpectrum::ZERO;
        }
        self.albedo * self.facets.f(wo, wi) + self.between * self.row.complement(wo.z, wi.z)
    }

    #[inline]
    fn pdf(&self, _wo: Vec3, wi: Vec3, crossing: Crossing) -> LanePdf {
        if crossing != Crossing::Reflect {
            return LanePdf::ZERO;
        }
        let even = self.even_share();
        LanePdf::splat((1.0 - even) * cosine_hemisphere_pdf(wi.z) + even * 0.5 * INV_PI)
    }

    #[inline]
    fn sample(&self, _wo: Vec3, u: [Real; 3]) -> Option<LocalSample> {
        let square = Vec2::new(u[0], u[1]);
        let wi =
            if u[2] < self.even_share() { uniform_hemisphere(square) } else { cosine_hemisphere(square) };
        Some(LocalSample::smooth(wi, Crossing::Reflect))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn white(sigma: f64) -> OrenNayarLeaf {
        let (facets, row) = Facets::of_deviation(sigma);
        OrenNayarLeaf { albedo: SampledSpectrum::ONE, between: SampledSpectrum::ONE, facets, row }
    }

    /// A direction in the plane of azimuth 0 (front) or 180 degrees.
    fn at(degrees: f64) -> Vec3 {
        let (sin, cos) = degrees.to_radians().sin_cos();
        Vec3::new(sin as Real, 0.0, cos as Real)
    }

    #[test]
    fn without_deviation_it_is_lambertian() {
        for (a, b) in [(0.0, 0.0), (30.0, -60.0), (80.0, 80.0)] {
            let f = white(0.0).f(at(a), at(b), Crossing::Reflect).hero();
            assert!((f - INV_PI).abs() < 1e-6, "{a} {b}: {f}");
        }
    }

    /// Equation 27 of the paper, worked out by hand for σ = 0.5 with the light at 60° and the view at 30°, behind
    /// and opposite: C1 = 0.784483, 0.45 σ²/(σ² + 0.09) = 0.330882, (2β/π)³ = 1/27, tan β = 0.577350.
    #[test]
    fn one_bounce_is_that_of_the_paper() {
        let facets = white(0.5).facets;
        let pi = std::f64::consts::PI;
        let sin_alpha = 60f64.to_radians().sin();
        let back = 0.784_483 + 0.330_882 * sin_alpha * 0.577_350;
        let ahead = 0.784_483 - 0.330_882 * (sin_alpha - 1.0 / 27.0) * 0.577_350;
        assert!((facets.f(at(30.0), at(60.0)) as f64 * pi - back).abs() < 2e-6);
        assert!((facets.f(at(30.0), at(-60.0)) as f64 * pi - ahead).abs() < 2e-6);
        // At right angles in azimuth C3 remains: 0.125 · 0.735294 · (4 αβ/π²)² tan 45°.
        let across = Vec3::new(0.0, at(60.0).x, at(60.0).z);
        let expected = 0.784_483 + 0.125 * 0.735_294 * (2.0f64 / 9.0).powi(2);
        assert!((facets.f(at(30.0), across) as f64 * pi - expected).abs() < 2e-6);
    }

    #[test]
    fn one_bounce_never_scatters_more_than_arrives_and_the_row_knows_how_much() {
        for sigma in [0.05, 0.13, 0.5, 1.0] {
            let leaf = white(sigma);
            for mu in [0.0, 0.05, 0.33, 0.77, 0.95, 1.0] {
                let exact = leaf.facets.albedo(mu);
                assert!(exact <= 1.0 + 1e-5, "{sigma} {mu}: {exact}");
                let row = leaf.row.at(mu as Real) as f64;
                assert!((row - exact).abs() < 1e-4, "{sigma} {mu}: {row} for {exact}");
            }
        }
    }
}
