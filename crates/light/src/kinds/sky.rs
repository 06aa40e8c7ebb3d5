//! The sky of a `skylight`, without the sun.

use super::Distant;
use crate::sky::hosek::HosekSky;
use crate::sky::preetham::PreethamSky;
use indigo_math::angle::atan2_turns;
use indigo_math::elementary::sin_cos_turns;
use indigo_math::grid_distribution::{GridDistribution, cell_means};
use indigo_math::warp::INV_PI;
use indigo_math::{Real, Vec2, Vec3, Vec3d};
use indigo_spectrum::{SampledSpectrum, SampledWavelengths};
use std::f64::consts::TAU;

/// The models.
#[derive(Clone, Debug)]
pub enum SkyModel {
    /// Hosek and Wilkie's.
    Hosek(Box<HosekSky>),
    /// Preetham's.
    Preetham(Box<PreethamSky>),
}

impl SkyModel {
    #[inline]
    fn radiance(&self, cos_theta: Real, cos_gamma: Real, lambda: &SampledWavelengths) -> SampledSpectrum {
        match self {
            Self::Hosek(sky) => sky.radiance(cos_theta, cos_gamma, lambda),
            Self::Preetham(sky) => sky.radiance(cos_theta, cos_gamma, lambda),
        }
    }

    /// Luminance, cd/m².
    pub fn luminance(&self, cos_theta: f64, cos_gamma: f64) -> f64 {
        match self {
            Self::Hosek(sky) => sky.luminance(cos_theta, cos_gamma),
            Self::Preetham(sky) => sky.luminance(cos_theta, cos_gamma),
        }
    }
}

/// The upper half of all directions: z is up, and below the horizon it is black.
///
/// Directions are drawn by a grid over azimuth and height (equal areas), in proportion to luminance.
#[derive(Clone, Debug)]
pub struct Sky {
    model: SkyModel,
    /// Towards the sun.
    sun: Vec3,
    directions: GridDistribution,
    total_luminance: f64,
}

/// Cells of the grid: 3° of azimuth; the brightest part round the sun is some 20° wide.
const COLUMNS: usize = 120;
/// Cells from the horizon to the zenith, equal in its sine: the lowest is 0.9° high.
const ROWS: usize = 64;
/// Points in a cell along each side.
const POINTS: usize = 2;

impl Sky {
    /// A sky with the sun in a unit direction above the horizon.
    pub fn new(sun: Vec3d, model: SkyModel) -> Self {
        // tidy: load-time mathematics
        let cells = cell_means([COLUMNS, ROWS], POINTS, |[turns, z]| {
            let (s, c) = (turns * TAU).sin_cos();
            let r = (1.0 - z * z).sqrt();
            model.luminance(z, Vec3d::new(r * c, r * s, z).dot(sun))
        });
        Self {
            total_luminance: cells.iter().sum::<f64>() * TAU / (COLUMNS * ROWS) as f64,
            directions: GridDistribution::new(COLUMNS, ROWS, &cells),
            sun: sun.cast(),
            model,
        }
    }

    /// For the laws.
    pub(super) fn examples() -> Vec<Self> {
        let sky = |elevation: f64, model: &dyn Fn(f64) -> SkyModel| {
            // tidy: load-time mathematics
            let (s, c) = elevation.sin_cos();
            Self::new(Vec3d::new(0.6 * c, -0.8 * c, s), model(elevation))
        };
        vec![
            sky(0.1, &|e| SkyModel::Hosek(Box::new(HosekSky::new(e, 2.0)))),
            sky(1.1, &|e| SkyModel::Hosek(Box::new(HosekSky::new(e, 6.0)))),
            sky(0.6, &|e| SkyModel::Preetham(Box::new(PreethamSky::new(e, 3.0)))),
        ]
    }
}

impl Distant for Sky {
    #[inline]
    fn radiance(&self, towards: Vec3, lambda: &SampledWavelengths) -> SampledSpectrum {
        if towards.z <= 0.0 {
            return SampledSpectrum::ZERO;
        }
        self.model.radiance(towards.z, towards.dot(self.sun), lambda)
    }

    #[inline]
    fn sample(&self, _n: Vec3, u: [Real; 2]) -> Option<Vec3> {
        let (at, _) = self.directions.sample(u);
        let (s, c) = sin_cos_turns(at.x);
        let r = (1.0 - at.y * at.y).max(0.0).sqrt();
        Some(Vec3::new(r * c, r * s, at.y))
    }

    #[inline]
    fn pdf(&self, _n: Vec3, towards: Vec3) -> Real {
        if towards.z <= 0.0 {
            return 0.0;
        }
        let at = Vec2::new(atan2_turns(towards.y, towards.x), towards.z);
        self.directions.pdf(at) * (0.5 * INV_PI)
    }

    fn total_luminance(&self) -> f64 {
        self.total_luminance
    }

    fn is_drawn(&self) -> bool {
        true
    }

    #[inline]
    fn portal_share(&self) -> Real {
        1.0
    }
}
