//! The sun of a `skylight`: a disc of its true size, of which only what stands above the horizon shines.
//!
//! Directions are drawn evenly over the whole disc; those below the horizon are then mirrored in it. As the middle of
//! the disc stands above the horizon, the mirror image lies in the disc, too: where it does the density is twice that
//! of the disc, and no draw is lost.

use super::Distant;
use crate::sky::{SunDisc, hosek, space};
use indigo_math::warp::{INV_PI, concentric_disk};
use indigo_math::{Float, Frame, Real, Vec3, Vec3d};
use indigo_spectrum::{SampledSpectrum, SampledWavelengths, Spectrum};
use std::f64::consts::PI;

/// Half the sun's diameter in radians: 0.5358° across, that of the data's authors. Over the year it runs from
/// 0.524° to 0.542°.
pub const RADIUS: f64 = 0.5 * 0.5358 * PI / 180.0;

/// A disc in the sky, cut by the horizon.
#[derive(Clone, Debug)]
pub struct Sun {
    /// Round its middle.
    frame: Frame,
    /// 1 − cos of its angular radius, and the squared sine: the differences of cosines near 1 are lost in
    /// single precision.
    versine: Real,
    sin2: Real,
    disc: SunDisc,
    total_luminance: f64,
}

impl Sun {
    /// A disc round a direction above the horizon, of some angular radius, from [`RADIUS`] to that of a hemisphere.
    pub fn new(towards: Vec3d, radius: f64, disc: SunDisc) -> Self {
        // tidy: load-time mathematics
        let versine = 2.0 * (0.5 * radius).sin().powi(2);
        let mean = match disc.limb {
            None => disc.radiance.luminance(),
            Some(limb) => {
                let mean = limb.mean();
                let values: Vec<f64> =
                    (360..=830).map(|nm| disc.radiance.at(f64::from(nm)) * mean.at(f64::from(nm))).collect();
                Spectrum::regular_tabulated(360e-9, 830e-9, &values).map_or(0.0, |s| s.luminance())
            }
        };
        Self {
            frame: Frame::from_normal(towards.normalized().cast()),
            versine: versine as Real,
            sin2: (versine * (2.0 - versine)) as Real,
            total_luminance: mean * 2.0 * PI * versine * share_above(towards, radius, &disc),
            disc,
        }
    }

    /// Solid angle (sr) of a disc of some angular radius.
    pub fn solid_angle(radius: f64) -> f64 {
        // tidy: load-time mathematics
        4.0 * PI * (0.5 * radius).sin().powi(2)
    }

    /// For the laws: the sun itself cannot be met by even directions, so suns that are larger.
    pub(super) fn examples() -> Vec<Self> {
        let towards = Vec3d::new(0.3, -0.5, 0.6);
        let low = Vec3d::new(0.5, 0.2, 0.05);
        vec![
            Self::new(towards, 0.6, space::sun(1.0)),
            Self::new(towards, 0.3, hosek::sun(0.5, 2.5)),
            Self::new(low, 0.4, hosek::sun(0.1, 2.5)),
        ]
    }

    /// Squared sine of the angle from the middle, inside the disc, be it above the horizon or not.
    #[inline]
    fn inside(&self, towards: Vec3) -> Option<Real> {
        let sin2 = self.frame.n.cross(towards).length2();
        (sin2 <= self.sin2 && towards.dot(self.frame.n) > 0.0).then_some(sin2)
    }
}

/// Rings of equal solid angle round the middle of the disc; this many give a share of it to a part in 1000.
const RINGS: usize = 256;

/// The part of the disc's light that comes from above the horizon.
fn share_above(towards: Vec3d, radius: f64, disc: &SunDisc) -> f64 {
    // tidy: load-time mathematics
    let elevation = towards.normalized().z.asin();
    if elevation >= radius {
        return 1.0;
    }
    let [mut above, mut all] = [0.0; 2];
    for i in 0..RINGS {
        let part = (i as f64 + 0.5) / RINGS as f64;
        let angle = 2.0 * (part.sqrt() * (0.5 * radius).sin()).asin();
        let mu = (1.0 - (angle.sin() / radius.sin()).powi(2)).max(0.0).sqrt();
        let luminance = disc.limb.map_or(1.0, |limb| limb.spectrum(mu).luminance());
        // Of a ring, what has cos θ sin e + sin θ cos e cos φ > 0.
        let cos_phi = -elevation.tan() / angle.tan();
        all += luminance;
        above += luminance * cos_phi.clamp(-1.0, 1.0).acos() / PI;
    }
    above / all
}

impl Distant for Sun {
    #[inline]
    fn radiance(&self, towards: Vec3, lambda: &SampledWavelengths) -> SampledSpectrum {
        let Some(sin2) = self.inside(towards).filter(|_| towards.z >= 0.0) else {
            return SampledSpectrum::ZERO;
        };
        let radiance = self.disc.radiance.eval(lambda);
        let Some(limb) = self.disc.limb else { return radiance };
        let mu = (1.0 - sin2 / self.sin2).max(0.0).sqrt();
        radiance * limb.factor(mu, lambda)
    }

    #[inline]
    fn sample(&self, _n: Vec3, u: [Real; 2]) -> Option<Vec3> {
        let disk = concentric_disk(u.into());
        let r2 = disk.x * disk.x + disk.y * disk.y;
        // The versine is uniform; sin² = v (2 − v), shared out along the disk's axes.
        let versine = r2 * self.versine;
        let scale = (self.versine * (2.0 - versine)).sqrt();
        let towards = self.frame.to_world(Vec3::new(disk.x * scale, disk.y * scale, 1.0 - versine));
        Some(Vec3::new(towards.x, towards.y, towards.z.abs()))
    }

    #[inline]
    fn pdf(&self, _n: Vec3, towards: Vec3) -> Real {
        if towards.z < 0.0 {
            return 0.0;
        }
        let mirrored = Vec3::new(towards.x, towards.y, -towards.z);
        let count = [towards, mirrored].into_iter().filter(|&d| self.inside(d).is_some()).count();
        count as Real * 0.5 * INV_PI / self.versine
    }

    fn total_luminance(&self) -> f64 {
        self.total_luminance.to_f64()
    }

    fn is_drawn(&self) -> bool {
        true
    }

    #[inline]
    fn portal_share(&self) -> Real {
        0.0
    }
}
