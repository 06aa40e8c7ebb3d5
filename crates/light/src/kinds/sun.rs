//! The sun of a `skylight`: a disc of its true size.

use super::Distant;
use crate::sky::{SunDisc, hosek, space};
use indigo_math::warp::{INV_PI, concentric_disk};
use indigo_math::{Float, Frame, Real, Vec3, Vec3d};
use indigo_spectrum::{SampledSpectrum, SampledWavelengths, Spectrum};
use std::f64::consts::PI;

/// Half the sun's diameter in radians: 0.5358° across, that of the data's authors. Over the year it runs from
/// 0.524° to 0.542°.
pub const RADIUS: f64 = 0.5 * 0.5358 * PI / 180.0;

/// A disc in the sky.
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
    /// A disc round a direction, of some angular radius, from [`RADIUS`] to that of a hemisphere.
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
            total_luminance: mean * 2.0 * PI * versine,
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
        vec![Self::new(towards, 0.3, hosek::sun(0.5, 2.5)), Self::new(-towards, 0.6, space::sun(1.0))]
    }

    /// Squared sine of the angle from the middle, inside the disc.
    #[inline]
    fn inside(&self, towards: Vec3) -> Option<Real> {
        let sin2 = self.frame.n.cross(towards).length2();
        (sin2 <= self.sin2 && towards.dot(self.frame.n) > 0.0).then_some(sin2)
    }
}

impl Distant for Sun {
    #[inline]
    fn radiance(&self, towards: Vec3, lambda: &SampledWavelengths) -> SampledSpectrum {
        let Some(sin2) = self.inside(towards) else { return SampledSpectrum::ZERO };
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
        Some(self.frame.to_world(Vec3::new(disk.x * scale, disk.y * scale, 1.0 - versine)))
    }

    #[inline]
    fn pdf(&self, _n: Vec3, towards: Vec3) -> Real {
        if self.inside(towards).is_some() { 0.5 * INV_PI / self.versine } else { 0.0 }
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
