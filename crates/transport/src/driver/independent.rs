//! Independent samples: every pixel its own low-discrepancy sequence, the whole picture pass by pass.
//!
//! A pass gives each output pixel one sample; a unit of work is a tile of a pass. What a sample is
//! depends on the seed, its pixel and its number alone, never on the unit or the thread.

use super::Layers;
use super::region::Region;
use super::shares::Shares;
use crate::sampler::{Block, PrimarySample, SobolSample};
use crate::technique::{Events, Found, Part, Record, Tracer};
use indigo_film::{FilmDelta, FilmFilter, FilmSample};
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

/// A sample that was traced.
struct Sample {
    /// Its internal pixel.
    pixel: [u32; 2],
    on_film: FilmSample,
    found: Found,
    /// What it covers, as it counts on the film.
    alpha: f32,
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
        let pixels = rows.flat_map(|y| columns.clone().map(move |x| [x, y]));
        if self.layers.are_grouped() {
            let mut room = vec![];
            let mut shares = Shares::new(&scene.lights, record, &mut room);
            for pixel in pixels {
                let sample = self.trace(scene, pixel, pass, tracer, &mut shares);
                self.add_shares(&sample, &shares, delta);
            }
        } else {
            for pixel in pixels {
                let sample = self.trace(scene, pixel, pass, tracer, record);
                self.add(&sample, tracer, delta);
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

    /// Traces sample number `pass` of an output pixel.
    #[inline]
    fn trace(
        &self,
        scene: &Scene,
        pixel: [u32; 2],
        pass: u64,
        tracer: &mut Tracer,
        record: &mut impl Record,
    ) -> Sample {
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
        Sample { pixel: [x, y], on_film, found, alpha }
    }

    /// Puts a sample on the film.
    #[inline]
    fn add(&self, sample: &Sample, tracer: &Tracer, delta: &mut FilmDelta) {
        let Sample { pixel: [x, y], on_film, found, alpha } = sample;
        let layers = self.layers;
        for (layer, light) in layers.shares(&found.path) {
            // What all layers together cover is told in one.
            let alpha = if layer == layers.direct { *alpha } else { 0.0 };
            delta.add_sample(layer, *x, *y, found.sensor.xyz(&(light * on_film.weight)), alpha);
        }
        self.count_light_path(delta);
        for splat in tracer.splats() {
            let xyz = found.sensor.xyz(&splat.radiance);
            let layer = layers.of(splat.part);
            delta.splat(layer + 1, self.region.in_pixels(splat.position), xyz, &self.filter);
        }
    }

    /// Puts a sample on the film by the groups of lights that sent it.
    fn add_shares<R: Record>(&self, sample: &Sample, shares: &Shares<R>, delta: &mut FilmDelta) {
        let Sample { pixel: [x, y], on_film, found, alpha } = sample;
        // What all layers together cover is told in the first.
        let first = self.layers.of(Part::Direct);
        for layer in self.layers.each() {
            let own = |part, group| self.layers.of_group(part, group) == layer;
            let light = shares.found().iter().filter(|s| s.at.is_none() && own(s.part, s.group));
            let light = light.fold(SampledSpectrum::ZERO, |sum, share| sum + share.radiance);
            let alpha = if layer == first { *alpha } else { 0.0 };
            delta.add_sample(layer, *x, *y, found.sensor.xyz(&(light * on_film.weight)), alpha);
        }
        self.count_light_path(delta);
        for share in shares.found() {
            let Some(position) = share.at else { continue };
            let xyz = found.sensor.xyz(&share.radiance);
            let layer = self.layers.of_group(share.part, share.group);
            delta.splat(layer + 1, self.region.in_pixels(position), xyz, &self.filter);
        }
    }

    /// Counted one by one, so that what a unit that fails leaves behind is counted rightly.
    #[inline]
    fn count_light_path(&self, delta: &mut FilmDelta) {
        if self.is_bidirectional {
            self.layers.each().for_each(|layer| delta.add_samples(layer + 1, 1));
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
