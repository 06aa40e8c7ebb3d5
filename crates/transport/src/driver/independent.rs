//! Independent samples: every pixel its own low-discrepancy sequence, the whole picture pass by pass.
//!
//! A pass gives each output pixel one sample; a unit of work is a tile of a pass. What a sample is
//! depends on the seed, its pixel and its number alone, never on the unit or the thread.

use super::Layers;
use super::region::Region;
use crate::sampler::{Block, PrimarySample, SobolSample};
use crate::technique::{Events, Record, Tracer};
use indigo_film::{FilmDelta, FilmFilter};
use indigo_math::{Float, Real, Vec2, rng};
use indigo_scene::Scene;
use indigo_spectrum::SampledSpectrum;
use std::ops::Range;

/// Side of a tile in output pixels: a unit of about a millisecond, whose rays stay together.
const TILE: u32 = 32;

/// Samples in low-discrepancy order.
#[derive(Clone, Debug)]
pub struct Independent {
    region: Region,
    filter: FilmFilter,
    seed: u64,
    tiles: [u32; 2],
    events: Events,
    is_bidirectional: bool,
    /// The film's layers, the first ones of it.
    layers: Layers,
    /// Whether every other round through the internal pixels is independent of the one before.
    pub(super) is_halved: bool,
}

impl Independent {
    /// For a scene, the seed of all its randomness, the paths to render, and the film's layers for them.
    pub(super) fn new(scene: &Scene, seed: u64, events: Events, layers: Layers) -> Self {
        let region = Region::of(scene);
        let tiles = region.ends.map(|[lo, hi]| (hi - lo).div_ceil(TILE));
        Self {
            region,
            filter: scene.film.filter.clone(),
            seed,
            tiles,
            events,
            is_bidirectional: scene.transport.bidirectional,
            layers,
            is_halved: false,
        }
    }

    /// Which half a unit belongs to: whole rounds through the internal pixels, so that both cover all of them.
    pub(super) fn half_of(&self, unit: u64) -> usize {
        (unit / self.units_per_pass() / self.cells() % 2) as usize
    }

    /// Internal pixels of an output pixel.
    fn cells(&self) -> u64 {
        u64::from(self.region.size.super_sample()).pow(2)
    }

    /// Seed and number of the point of an internal pixel's sequence that a pass takes. Halves have seeds of their own,
    /// other than that of a render as a whole: a film may be gone on with either way.
    fn point(&self, pass: u64) -> (u64, u32) {
        let round = pass / self.cells();
        if self.is_halved {
            (rng::key(&[self.seed, round % 2]), (round / 2) as u32)
        } else {
            (self.seed, round as u32)
        }
    }

    /// Output pixels that are rendered.
    pub(super) fn pixels(&self) -> u64 {
        self.region.pixels()
    }

    /// Units of a pass, which gives every rendered output pixel one sample.
    pub(super) fn units_per_pass(&self) -> u64 {
        u64::from(self.tiles[0]) * u64::from(self.tiles[1])
    }

    /// Does a unit: adds its samples to `delta`, and says how many they were.
    pub(super) fn render_unit(
        &self,
        scene: &Scene,
        unit: u64,
        tracer: &mut Tracer,
        delta: &mut FilmDelta,
        record: &mut impl Record,
    ) -> u64 {
        let pass = unit / self.units_per_pass();
        let [columns, rows] = self.tile(unit);
        for y in rows {
            for x in columns.clone() {
                self.render_sample(scene, [x, y], pass, tracer, delta, record);
            }
        }
        self.samples_of(unit)
    }

    /// Columns and rows of the tile that a unit is.
    fn tile(&self, unit: u64) -> [Range<u32>; 2] {
        let tile = (unit % self.units_per_pass()) as u32;
        let corner = [tile % self.tiles[0], tile / self.tiles[0]];
        [0, 1].map(|axis| {
            let [first, end] = self.region.ends[axis];
            let lo = first + corner[axis] * TILE;
            lo..(lo + TILE).min(end)
        })
    }

    /// Samples of a unit.
    pub(super) fn samples_of(&self, unit: u64) -> u64 {
        self.tile(unit).iter().map(|range| u64::from(range.end - range.start)).product()
    }

    /// Sample number `pass` of an output pixel.
    fn render_sample(
        &self,
        scene: &Scene,
        pixel: [u32; 2],
        pass: u64,
        tracer: &mut Tracer,
        delta: &mut FilmDelta,
        record: &mut impl Record,
    ) {
        let size = self.region.size;
        let [x, y] = self.internal_pixel(pixel, pass);
        let stream = u64::from(y) << 32 | u64::from(x);
        let (seed, index) = self.point(pass);
        let mut numbers = SobolSample::new(seed, stream, index);
        let [u0, u1, ..] = numbers.block(Block::FILM);
        let on_film = self.filter.sample(x, y, [u0, u1]);
        let position = Vec2::new(
            on_film.position.x / size.internal_width() as Real,
            on_film.position.y / size.internal_height() as Real,
        );
        let found = tracer.trace(scene, &mut numbers, position, self.events, record);
        let alpha = if scene.camera.deflects() {
            Real::from(u8::from(tracer.covers(scene, &mut numbers, position)))
        } else {
            // The same without another ray.
            found.path.alpha
        };
        let alpha = (alpha * on_film.weight).to_f64() as f32;
        let layers = self.layers;
        let path = &found.path;
        // What leaves the scene has met nothing.
        let (direct, background) = if path.alpha == 0.0 && layers.background != layers.direct {
            (SampledSpectrum::ZERO, path.direct)
        } else {
            (path.direct, SampledSpectrum::ZERO)
        };
        let mut add = |layer, light, alpha| {
            delta.add_sample(layer, x, y, found.sensor.xyz(&(light * on_film.weight)), alpha);
        };
        if layers.indirect == layers.direct {
            add(layers.direct, direct + path.indirect, alpha);
        } else {
            add(layers.direct, direct, alpha);
            add(layers.indirect, path.indirect, 0.0);
        }
        if layers.background != layers.direct {
            add(layers.background, background, 0.0);
        }
        if self.is_bidirectional {
            // Counted one by one, so that what a unit that fails leaves behind is counted rightly.
            layers.each().for_each(|layer| delta.add_samples(layer + 1, 1));
        }
        for splat in tracer.splats() {
            let xyz = found.sensor.xyz(&splat.radiance);
            let layer = layers.of(splat.part);
            delta.splat(layer + 1, self.region.in_pixels(splat.position), xyz, &self.filter);
        }
    }

    /// The internal pixel that sample number `pass` of an output pixel goes to: each in turn, the
    /// first one at random, so that every number of passes is fair to all.
    fn internal_pixel(&self, [x, y]: [u32; 2], pass: u64) -> [u32; 2] {
        let n = u64::from(self.region.size.super_sample());
        if n == 1 {
            return [x, y];
        }
        let first = rng::key(&[self.seed, u64::from(y) << 32 | u64::from(x), n]);
        let cell = (pass.wrapping_add(first % (n * n)) % (n * n)) as u32;
        let n = n as u32;
        [x * n + cell % n, y * n + cell / n]
    }
}
