//! All that is infinitely far away: several lights whose radiances add.

use crate::kinds::{Distant, DistantLight};
use crate::query::EmissionPdf;
use indigo_math::distribution::AliasTable;
use indigo_math::warp::{INV_PI, concentric_disk};
use indigo_math::{Float, Frame, Real, Vec3, Vec3d};
use indigo_spectrum::{SampledSpectrum, SampledWavelengths};

/// The surroundings of a scene.
///
/// A direction is drawn by one of the lights; its density is the mixture of all of theirs. Light enters the scene through a disc as wide as the scene, across its
/// direction.
#[derive(Clone, Debug)]
pub(crate) struct Environment {
    lights: Vec<DistantLight>,
    choice: AliasTable,
    /// A sphere round everything that the environment can light.
    center: Vec3,
    radius: Real,
}

impl Environment {
    /// Lights round a scene that lies within a sphere of some centre and radius in metres.
    pub fn new(lights: Vec<DistantLight>, (center, radius_m): (Vec3d, f64)) -> Self {
        let totals: Vec<f64> = lights.iter().map(Distant::total_luminance).collect();
        let sum: f64 = totals.iter().sum();
        // Half by how much light each gives, half evenly: where the strongest, the sun above all, is
        // hidden, the others are all there is.
        let weight = |total: &f64| if sum > 0.0 { total / sum } else { 0.0 } + 1.0 / totals.len() as f64;
        let weights: Vec<f64> = totals.iter().map(weight).collect();
        Self { choice: AliasTable::new(&weights), lights, center: center.cast(), radius: radius_m as Real }
    }

    /// The lights.
    pub fn lights(&self) -> &[DistantLight] {
        &self.lights
    }

    /// Luminous flux in lm that enters the scene's sphere.
    pub fn flux(&self) -> f64 {
        let radius = self.radius.to_f64();
        let across = std::f64::consts::PI * radius * radius;
        self.lights.iter().map(Distant::total_luminance).sum::<f64>() * across
    }

    /// Radiance from a direction.
    #[inline]
    pub fn radiance(&self, towards: Vec3, lambda: &SampledWavelengths) -> SampledSpectrum {
        self.lights.iter().fold(SampledSpectrum::ZERO, |sum, light| sum + light.radiance(towards, lambda))
    }

    /// A direction of light for a receiver with unit normal `n`, or zero for all sides.
    #[inline]
    pub fn sample(&self, n: Vec3, u: [Real; 3]) -> Option<Vec3> {
        let (i, _, _) = self.choice.sample(u[0]);
        self.lights[i].sample(n, [u[1], u[2]])
    }

    /// Density (1/sr) of [`sample`](Self::sample).
    #[inline]
    pub fn pdf(&self, n: Vec3, towards: Vec3) -> Real {
        let part = |(i, light): (usize, &DistantLight)| self.choice.probability(i) * light.pdf(n, towards);
        self.lights.iter().enumerate().map(part).sum()
    }

    /// A direction towards the light, and a point beyond the scene where the light enters.
    #[inline]
    pub fn sample_emission(&self, u: [Real; 3], v: [Real; 2]) -> Option<(Vec3, Vec3)> {
        let towards = self.sample(Vec3::ZERO, u)?;
        let disk = concentric_disk(v.into()) * self.radius;
        let place = Frame::from_normal(towards).to_world(Vec3::new(disk.x, disk.y, self.radius));
        Some((towards, self.center + place))
    }

    /// Densities of [`sample_emission`](Self::sample_emission) for light from a direction through a point.
    #[inline]
    pub fn pdf_emission(&self, towards: Vec3, _through: Vec3) -> EmissionPdf {
        EmissionPdf { first: self.pdf(Vec3::ZERO, towards), second: INV_PI / (self.radius * self.radius) }
    }
}
