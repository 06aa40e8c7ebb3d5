//! Independent samples: every pixel its own low-discrepancy sequence, the whole picture pass by pass.
//!
//! A pass gives each output pixel one sample; a unit of work is a tile of a pass. What a sample is
//! depends on the seed, its pixel and its number alone, never on the unit or the thread.

use crate::sampler::{Block, PrimarySample, SobolSample};
use crate::technique::path;
use indigo_film::{FilmDelta, FilmFilter, FilmSize, Sensor};
use indigo_math::{Float, Real, Vec2, rng};
use indigo_scene::Scene;
use indigo_spectrum::SampledWavelengths;

/// Side of a tile in output pixels: a unit of about a millisecond, whose rays stay together.
const TILE: u32 = 32;
/// The film layer of camera samples.
const CAMERA_LAYER: usize = 0;

/// Path tracing of camera samples in low-discrepancy order.
#[derive(Clone, Debug)]
pub struct Independent {
    size: FilmSize,
    filter: FilmFilter,
    seed: u64,
    /// First and last (excluded) output column and row that are rendered.
    region: [[u32; 2]; 2],
    tiles: [u32; 2],
}

impl Independent {
    /// For a scene and the seed of all its randomness.
    pub fn new(scene: &Scene, seed: u64) -> Self {
        let size = scene.film.size;
        let region = scene.film.region.unwrap_or([[0, size.width()], [0, size.height()]]);
        let tiles = region.map(|[lo, hi]| (hi - lo).div_ceil(TILE));
        Self { size, filter: scene.film.filter.clone(), seed, region, tiles }
    }

    /// Units of a pass, which gives every rendered output pixel one sample.
    pub fn units_per_pass(&self) -> u64 {
        u64::from(self.tiles[0]) * u64::from(self.tiles[1])
    }

    /// Output pixels that are rendered.
    pub fn pixels(&self) -> u64 {
        let [x, y] = self.region.map(|[lo, hi]| u64::from(hi - lo));
        x * y
    }

    /// Does a unit: adds its samples to `delta`, and says how many they were.
    pub fn render_unit(&self, scene: &Scene, unit: u64, delta: &mut FilmDelta) -> u64 {
        let (pass, tile) = (unit / self.units_per_pass(), (unit % self.units_per_pass()) as u32);
        let corner = [tile % self.tiles[0], tile / self.tiles[0]];
        let range = |axis: usize| {
            let lo = self.region[axis][0] + corner[axis] * TILE;
            lo..(lo + TILE).min(self.region[axis][1])
        };
        let mut samples = 0;
        for y in range(1) {
            for x in range(0) {
                self.render_sample(scene, [x, y], pass, delta);
                samples += 1;
            }
        }
        samples
    }

    /// Sample number `pass` of an output pixel.
    fn render_sample(&self, scene: &Scene, pixel: [u32; 2], pass: u64, delta: &mut FilmDelta) {
        let [x, y] = self.internal_pixel(pixel, pass);
        let stream = u64::from(y) << 32 | u64::from(x);
        let cells = u64::from(self.size.super_sample()).pow(2);
        let mut sample = SobolSample::new(self.seed, stream, (pass / cells) as u32);
        let [u0, u1, u2, _] = sample.block(Block::FILM);
        let lambda = SampledWavelengths::sample(u2);
        let on_film = self.filter.sample(x, y, [u0, u1]);
        let [l0, l1, _, _] = sample.block(Block::LENS);
        let position = Vec2::new(
            on_film.position.x / self.size.internal_width() as Real,
            on_film.position.y / self.size.internal_height() as Real,
        );
        let ray = scene.camera.ray(position, Vec2::new(l0, l1));
        let found = path::trace(scene, &mut sample, &lambda, &ray, scene.transport.max_depth);
        let xyz = Sensor::new(&lambda).xyz(&(found.radiance * on_film.weight));
        delta.add_sample(CAMERA_LAYER, x, y, xyz, (found.alpha * on_film.weight).to_f64() as f32);
    }

    /// The internal pixel that sample number `pass` of an output pixel goes to: each in turn, the
    /// first one at random, so that every number of passes is fair to all.
    fn internal_pixel(&self, [x, y]: [u32; 2], pass: u64) -> [u32; 2] {
        let n = u64::from(self.size.super_sample());
        if n == 1 {
            return [x, y];
        }
        let first = rng::key(&[self.seed, u64::from(y) << 32 | u64::from(x), n]);
        let cell = (pass.wrapping_add(first % (n * n)) % (n * n)) as u32;
        let n = n as u32;
        [x * n + cell % n, y * n + cell / n]
    }
}
