//! What a pixel shows besides light: reflectance, normal, depth, and the numbers of object and material, as
//! denoisers and compositing want them.
//!
//! Means are over the area of the output pixel and over the lens, without a filter: one with negative lobes would make
//! reflectances and depths that do not exist. What is not a quantity, a number of an object, is that of most rays.
//! Coverage alone has to go with the light, by the film's filters: for that it is told where the rays were.

use crate::sampler::{Block, PrimarySample, SobolSample};
use crate::technique::first_event::{FirstEvent, first_event};
use crate::technique::media::WorldMemory;
use indigo_film::{FirstHit, Sensor};
use indigo_math::{Float, Real, Vec2};
use indigo_scene::Scene;
use indigo_spectrum::{SampledWavelengths, adaptation, illuminant};

/// Camera rays of a pixel: a power of two, so that Sobol' points cover pixel, lens and wavelengths evenly; with four
/// wavelengths each the reflectance is that of 64 evenly spread wavelengths.
pub const RAYS: usize = 16;
/// All pictures of a scene show the same.
const SEED: u64 = 0;

/// A camera ray, evenly drawn from its output pixel.
#[derive(Clone, Copy, Debug)]
pub struct FilmRay {
    /// Where it is on the film, in internal pixels.
    pub position: Vec2,
    /// Whether it meets anything.
    pub hits: bool,
}

/// Finds what pixels show; with the memory that it needs.
#[derive(Clone, Debug, Default)]
pub struct FirstHits {
    memory: WorldMemory,
}

impl FirstHits {
    /// What an output pixel shows, and the rays that tell. Diffraction is left out.
    pub fn of_pixel(&mut self, scene: &Scene, [x, y]: [u32; 2]) -> (FirstHit, [FilmRay; RAYS]) {
        let size = scene.film.size;
        let factor = size.super_sample() as Real;
        let mut sum = Sum::default();
        let rays = std::array::from_fn(|ray| {
            let mut numbers = SobolSample::new(SEED, u64::from(y) << 32 | u64::from(x), ray as u32);
            let [u, v, wavelength, time] = numbers.block(Block::FILM);
            let [lens_x, lens_y, ..] = numbers.block(Block::LENS);
            let (x, y) = (x as Real + u, y as Real + v);
            let position = Vec2::new(x / size.width() as Real, y / size.height() as Real);
            // Albedos are of daylight, whatever light the scene has.
            let lambda = SampledWavelengths::sample(wavelength);
            let camera = scene.camera.ray_at(position, Vec2::new(lens_x, lens_y), time);
            let (sensor, light) = (Sensor::new(&lambda), illuminant::d65(&lambda));
            let event = first_event(&mut self.memory, scene, &mut numbers, &lambda, &camera);
            if let Some(event) = event {
                add(&mut sum.white, sensor.xyz(&light));
                add(&mut sum.albedo, sensor.xyz(&(event.albedo * light)));
                sum.add(ray, &event);
            }
            FilmRay { position: Vec2::new(x * factor, y * factor), hits: event.is_some() }
        });
        (sum.mean(), rays)
    }
}

#[derive(Default)]
struct Sum {
    /// Light of the albedos that are met, and of white in their place.
    albedo: [f64; 3],
    white: [f64; 3],
    normal: [f64; 3],
    depth_m: f64,
    events: f64,
    /// Numbers from 1 of objects and materials, by rays.
    objects: [u32; RAYS],
    materials: [u32; RAYS],
}

impl Sum {
    fn add(&mut self, ray: usize, event: &FirstEvent) {
        self.events += 1.0;
        self.depth_m += event.depth_m.to_f64();
        if let Some(n) = event.normal {
            add(&mut self.normal, n.to_array().map(|v| v.to_f64() as f32));
        }
        if let Some([object, material]) = event.surface {
            (self.objects[ray], self.materials[ray]) = (object + 1, material + 1);
        }
    }

    fn mean(&self) -> FirstHit {
        let white = adaptation::xyz_of_white(adaptation::D65_XY).to_array();
        if self.events == 0.0 {
            return FirstHit::NOTHING;
        }
        let coverage = self.events / RAYS as f64;
        FirstHit {
            // Over white at the same wavelengths, so that what is grey comes out grey, without noise.
            albedo: [0, 1, 2].map(|c| (self.albedo[c] / self.white[c] * white[c] * coverage) as f32),
            normal: self.normal.map(|v| (v / RAYS as f64) as f32),
            coverage: coverage as f32,
            depth_m: (self.depth_m / self.events) as f32,
            object: most_frequent(&self.objects),
            material: most_frequent(&self.materials),
        }
    }
}

fn add(sum: &mut [f64; 3], value: [f32; 3]) {
    for (s, v) in sum.iter_mut().zip(value) {
        *s += f64::from(v);
    }
}

/// The value that is there most often; the first of several.
fn most_frequent(values: &[u32; RAYS]) -> u32 {
    let count = |value: u32| values.iter().filter(|v| **v == value).count();
    let (mut best, mut most) = (0, 0);
    for &value in values {
        let n = count(value);
        if n > most {
            (best, most) = (value, n);
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_number_that_is_there_most_often_is_chosen() {
        let mut values = [7; RAYS];
        assert_eq!(most_frequent(&values), 7);
        values[..9].fill(3);
        assert_eq!(most_frequent(&values), 3);
        values[8] = 7;
        assert_eq!(most_frequent(&values), 3, "the first of equals");
    }
}
