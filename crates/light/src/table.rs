//! All lights of a scene: choosing one, drawing light from it, and the density of having done so.

use crate::area::{AreaLight, EmitterPoint};
use indigo_math::distribution::AliasTable;
use indigo_math::warp::{INV_PI, concentric_disk, cosine_hemisphere, cosine_hemisphere_pdf, uniform_sphere};
use indigo_math::{Frame, Real, Vec2, Vec3, Vec3d};
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
    /// A sphere round everything that the environment can light.
    center: Vec3,
    radius: Real,
}

const NO_LIGHT: u32 = u32::MAX;

/// Light that could arrive at a point, visibility not yet known.
#[derive(Clone, Copy, Debug)]
pub struct LightSample {
    /// Unit direction towards the light.
    pub wi: Vec3,
    /// The point on an area light and its surroundings; `None` for the environment.
    pub point: Option<EmitterPoint>,
    /// Radiance, W m^-3 sr^-1.
    pub radiance: SampledSpectrum,
    /// Density in solid angle (1/sr), the choice of the light included.
    pub pdf: Real,
    /// Densities with which [`LightTable::sample_emission`] would send the same light here.
    pub pdf_emission: EmissionPdf,
}

/// Light that leaves a lamp or enters the scene from its environment.
///
/// The two densities are of the first two vertices of a light path. Of a lamp they are those of the
/// point, over area (1/m²), and of the direction (1/sr). The environment lies in directions: there the
/// first density is that of the direction (1/sr), and the second that of where its light enters, over
/// area across the direction (1/m²).
#[derive(Clone, Copy, Debug)]
pub struct Emission {
    /// Where the light begins, render space; for the environment a point beyond the scene.
    pub origin: Vec3,
    /// The point on a lamp; `None` for the environment.
    pub point: Option<EmitterPoint>,
    /// Unit direction of the light's travel.
    pub direction: Vec3,
    /// Radiance, W m^-3 sr^-1.
    pub radiance: SampledSpectrum,
    /// Both densities.
    pub pdf: EmissionPdf,
    /// Number of the light.
    light: u32,
}

/// Densities of [`Emission`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EmissionPdf {
    /// Of the point of a lamp (1/m²), or of the direction towards the environment (1/sr); the choice
    /// of the light included.
    pub first: Real,
    /// Of the direction from a lamp (1/sr), or of the place across it (1/m²).
    pub second: Real,
}

impl Emission {
    /// What a light path carries at first: radiance times cosine over both densities.
    #[inline]
    pub fn throughput(&self) -> SampledSpectrum {
        let cos = self.point.map_or(1.0, |p| self.direction.dot(p.n));
        self.radiance * (cos / (self.pdf.first * self.pdf.second))
    }
}

impl LightTable {
    /// From the lights, the light that each object is, and the centre and radius in metres of a sphere
    /// round the scene.
    pub fn new(
        lights: Vec<Light>,
        object_lights: impl Iterator<Item = Option<u32>>,
        (center, scene_radius_m): (Vec3d, f64),
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
        Self {
            by_power: AliasTable::new(&power),
            lights,
            of_object,
            background,
            center: center.cast(),
            radius: scene_radius_m as Real,
        }
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
                let pdf_emission =
                    EmissionPdf { first: chance * light.pdf_area(), second: cosine_hemisphere_pdf(cos) };
                let radiance = light.radiance.eval(lambda);
                Some(LightSample { wi, point: Some(point), radiance, pdf, pdf_emission })
            }
            Light::Background(radiance) => {
                let local = cosine_hemisphere(Vec2::new(u[1], u[2]));
                let pdf = chance * cosine_hemisphere_pdf(local.z);
                let wi = Frame::from_normal(n).to_world(local);
                let pdf_emission = self.pdf_emission_environment(wi);
                let radiance = radiance.eval(lambda);
                (pdf > 0.0).then_some(LightSample { wi, point: None, radiance, pdf, pdf_emission })
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

    /// Draws light that leaves a lamp or enters the scene: `u` chooses the light and a point on it,
    /// `v` a direction. `None` where there is none to be had.
    #[inline]
    pub fn sample_emission(
        &self,
        u: [Real; 3],
        v: [Real; 2],
        lambda: &SampledWavelengths,
    ) -> Option<Emission> {
        if self.lights.is_empty() {
            return None;
        }
        let (i, chance, u0) = self.by_power.sample(u[0]);
        match &self.lights[i] {
            Light::Area(light) => {
                let point = light.sample([u0, u[1], u[2]])?;
                let local = cosine_hemisphere(v.into());
                let pdf =
                    EmissionPdf { first: chance * light.pdf_area(), second: cosine_hemisphere_pdf(local.z) };
                let direction = Frame::from_normal(point.n).to_world(local);
                let radiance = light.radiance.eval(lambda);
                let light = i as u32;
                (pdf.second > 0.0).then_some(Emission {
                    origin: point.p,
                    point: Some(point),
                    direction,
                    radiance,
                    pdf,
                    light,
                })
            }
            Light::Background(radiance) => {
                let towards = uniform_sphere(Vec2::new(u[1], u[2]));
                let disk = concentric_disk(v.into()) * self.radius;
                let frame = Frame::from_normal(towards);
                let origin = self.center + frame.to_world(Vec3::new(disk.x, disk.y, self.radius));
                let pdf = self.pdf_emission_environment(towards);
                let radiance = radiance.eval(lambda);
                (pdf.second.is_finite()).then_some(Emission {
                    origin,
                    point: None,
                    direction: -towards,
                    radiance,
                    pdf,
                    light: i as u32,
                })
            }
        }
    }

    /// Density, in the measure of `pdf.first`, with which [`sample`](Self::sample) draws the point or
    /// direction of an emission towards a point `p` of a surface with unit normal `n`.
    #[inline]
    pub fn pdf_sample_of(&self, emission: &Emission, p: Vec3, n: Vec3) -> Real {
        let _ = p;
        let chance = self.by_power.probability(emission.light as usize);
        match &self.lights[emission.light as usize] {
            Light::Area(light) => chance * light.pdf_area(),
            Light::Background(_) => chance * cosine_hemisphere_pdf(-n.dot(emission.direction)),
        }
    }

    /// Densities with which [`sample_emission`](Self::sample_emission) draws light that leaves an
    /// object under `cos` to its normal; 0 where it is no light.
    #[inline]
    pub fn pdf_emission_object(&self, object: u32, cos: Real) -> EmissionPdf {
        match self.area(object) {
            Some((i, Light::Area(light))) => EmissionPdf {
                first: self.by_power.probability(i) * light.pdf_area(),
                second: cosine_hemisphere_pdf(cos),
            },
            _ => EmissionPdf { first: 0.0, second: 0.0 },
        }
    }

    /// The same for light from the environment, seen in direction `towards`.
    #[inline]
    pub fn pdf_emission_environment(&self, _towards: Vec3) -> EmissionPdf {
        let Some(i) = self.background else { return EmissionPdf { first: 0.0, second: 0.0 } };
        EmissionPdf {
            first: self.by_power.probability(i as usize) * (0.25 * INV_PI),
            second: INV_PI / (self.radius * self.radius),
        }
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
