//! All lights of a scene: choosing one, drawing light from it, and the density of having done so.

use crate::area::AreaLight;
use indigo_math::distribution::AliasTable;
use indigo_math::warp::{cosine_hemisphere, cosine_hemisphere_pdf};
use indigo_math::{Frame, Real, Vec2, Vec3};
use indigo_spectrum::{SampledSpectrum, SampledWavelengths, Spectrum};

/// A light.
#[derive(Clone, Debug)]
pub enum Light {
    /// Emitting triangles.
    Area(AreaLight),
    /// The same radiance from every direction of the environment, W m^-3 sr^-1.
    Background(Spectrum),
}

/// Lights, with a distribution to choose among them by power.
#[derive(Clone, Debug)]
pub struct LightTable {
    lights: Vec<Light>,
    by_power: AliasTable,
    /// For each object of the scene the light that it is, or [`NO_LIGHT`].
    of_object: Vec<u32>,
    background: Option<u32>,
}

const NO_LIGHT: u32 = u32::MAX;

/// Light that could arrive at a point, visibility not yet known.
#[derive(Clone, Copy, Debug)]
pub struct LightSample {
    /// Unit direction towards the light.
    pub wi: Vec3,
    /// The point on an area light and its surroundings; `None` for the environment.
    pub point: Option<crate::area::EmitterPoint>,
    /// Radiance, W m^-3 sr^-1.
    pub radiance: SampledSpectrum,
    /// Density in solid angle (1/sr), the choice of the light included.
    pub pdf: Real,
}

impl LightTable {
    /// From the lights, the light that each object is, and the radius in metres of a sphere round the scene.
    pub fn new(
        lights: Vec<Light>,
        object_lights: impl Iterator<Item = Option<u32>>,
        scene_radius_m: f64,
    ) -> Self {
        let pi = std::f64::consts::PI;
        let power: Vec<f64> = lights
            .iter()
            .map(|l| match l {
                Light::Area(a) => a.flux(),
                Light::Background(s) => s.luminance() * pi * pi * scene_radius_m * scene_radius_m,
            })
            .collect();
        let background = lights.iter().position(|l| matches!(l, Light::Background(_))).map(|i| i as u32);
        let of_object = object_lights.map(|l| l.unwrap_or(NO_LIGHT)).collect();
        Self { by_power: AliasTable::new(&power), lights, of_object, background }
    }

    /// The lights.
    pub fn lights(&self) -> &[Light] {
        &self.lights
    }

    /// Draws light towards a point `p` of a surface with unit normal `n` (on the side that is lit).
    #[inline]
    pub fn sample(&self, p: Vec3, n: Vec3, u: [Real; 3], lambda: &SampledWavelengths) -> Option<LightSample> {
        if self.lights.is_empty() {
            return None;
        }
        let (i, chance, u0) = self.by_power.sample(u[0]);
        match &self.lights[i] {
            Light::Area(light) => {
                let point = light.sample([u0, u[1], u[2]])?;
                let d = point.p - p;
                let distance2 = d.length2();
                let wi = d / distance2.sqrt();
                let cos = -wi.dot(point.n);
                if cos <= 0.0 || distance2 == 0.0 {
                    return None;
                }
                let pdf = chance * light.pdf_area() * distance2 / cos;
                Some(LightSample { wi, point: Some(point), radiance: light.radiance.eval(lambda), pdf })
            }
            Light::Background(radiance) => {
                let local = cosine_hemisphere(Vec2::new(u[1], u[2]));
                let pdf = chance * cosine_hemisphere_pdf(local.z);
                let wi = Frame::from_normal(n).to_world(local);
                (pdf > 0.0).then(|| LightSample { wi, point: None, radiance: radiance.eval(lambda), pdf })
            }
        }
    }

    /// Radiance that an object emits to its front, if it is a light.
    #[inline]
    pub fn emitted(&self, object: u32, lambda: &SampledWavelengths) -> Option<SampledSpectrum> {
        match self.area(object)? {
            (_, Light::Area(light)) => Some(light.radiance.eval(lambda)),
            (_, Light::Background(_)) => None,
        }
    }

    /// Density (1/sr) with which [`sample`](Self::sample) draws a point of an object's front that is
    /// seen at `distance2` (m²) under `cos` to its normal.
    #[inline]
    pub fn pdf_object(&self, object: u32, distance2: Real, cos: Real) -> Real {
        match self.area(object) {
            Some((i, Light::Area(light))) => {
                self.by_power.probability(i) * light.pdf_area() * distance2 / cos
            }
            _ => 0.0,
        }
    }

    /// Whether an object is a light.
    #[inline]
    pub fn is_emitter(&self, object: u32) -> bool {
        self.area(object).is_some()
    }

    #[inline]
    fn area(&self, object: u32) -> Option<(usize, &Light)> {
        let i = *self.of_object.get(object as usize)?;
        (i != NO_LIGHT).then(|| (i as usize, &self.lights[i as usize]))
    }

    /// Radiance of the environment.
    #[inline]
    pub fn environment(&self, lambda: &SampledWavelengths) -> Option<SampledSpectrum> {
        match &self.lights[self.background? as usize] {
            Light::Background(radiance) => Some(radiance.eval(lambda)),
            Light::Area(_) => None,
        }
    }

    /// Density (1/sr) with which [`sample`](Self::sample) draws a direction of the environment.
    #[inline]
    pub fn pdf_environment(&self, n: Vec3, wi: Vec3) -> Real {
        self.background
            .map_or(0.0, |i| self.by_power.probability(i as usize) * cosine_hemisphere_pdf(n.dot(wi)))
    }
}
