//! What each strategy of bidirectional path tracing adds to a picture, for the eye of who looks for an error in one.
//!
//! In a pyramid (Veach 1997, figure 10.3) each row holds the paths of so many edges, from 1 at the top, and column s
//! those made with s vertices of the light's path. Whatever the strategy, the paths of a row carry the same light:
//! as if there were no other strategy, all pictures of a row that can show something show the same, as noisy as
//! they may be. Weighted, those of a row add up to it.

use crate::sampler::{Block, PrimarySample, SobolSample};
use crate::technique::{Events, Record, Tracer};
use indigo_film::{FilmSize, Sensor, XyzImage};
use indigo_light::Sender;
use indigo_math::{Real, Vec2};
use indigo_scene::Scene;
use indigo_spectrum::SampledSpectrum;

/// Edges of the longest paths that are shown. Light gets rare beyond, and the pyramid hard to see at a glance.
const MOST_EDGES: u32 = 7;
/// Strategies of these: the light's vertices are from none to all but the lens.
const COLUMNS: u32 = MOST_EDGES + 1;
/// The longer side of a picture: two pyramids of them fit a screen.
const TILE: u32 = 120;
/// Dark pixels between pictures.
const GAP: u32 = 2;

/// The contributions of all strategies.
pub struct Strategies {
    /// Pixels of a picture.
    size: [u32; 2],
    passes: u32,
    /// For each strategy X, Y and Z of all pixels, as if there were no other, and weighted.
    sums: Vec<[Vec<[f64; 3]>; 2]>,
}

/// The contributions of a sample.
struct Contributions {
    /// Where its camera ray comes from.
    position: Vec2,
    found: Vec<((u32, u32), Vec2, SampledSpectrum, Real)>,
}

impl Record for Contributions {
    fn contribution(
        &mut self,
        strategy: (u32, u32),
        at: Option<Vec2>,
        unweighted: SampledSpectrum,
        weight: Real,
        _: Sender,
    ) {
        self.found.push((strategy, at.unwrap_or(self.position), unweighted, weight));
    }
}

/// Where a strategy stands among all: row by row.
fn index(s: u32, edges: u32) -> usize {
    ((edges - 1) * COLUMNS + s) as usize
}

impl Strategies {
    /// Traces `passes` samples for each pixel of small pictures, on this thread.
    pub fn gather(scene: &Scene, seed: u64, passes: u32) -> Self {
        let (w, h) = (scene.film.size.width(), scene.film.size.height());
        let side = |own: u32| (u64::from(own) * u64::from(TILE)).div_ceil(u64::from(w.max(h))) as u32;
        let size = [side(w), side(h)];
        let none = || vec![[0.0; 3]; (size[0] * size[1]) as usize];
        let sums = (0..MOST_EDGES * COLUMNS).map(|_| [none(), none()]).collect();
        let mut strategies = Self { size, passes, sums };
        let events = Events::up_to(scene.transport.max_depth.min(MOST_EDGES - 1));
        let mut tracer = Tracer::new(true, 1.0);
        let mut record = Contributions { position: Vec2::new(0.0, 0.0), found: vec![] };
        for y in 0..size[1] {
            for x in 0..size[0] {
                for pass in 0..passes {
                    let mut numbers = SobolSample::new(seed, u64::from(y) << 32 | u64::from(x), pass);
                    let [u, v, ..] = numbers.block(Block::FILM);
                    let on = |i: u32, u: Real, n: u32| (i as Real + u) / n as Real;
                    record.position = Vec2::new(on(x, u, size[0]), on(y, v, size[1]));
                    record.found.clear();
                    let found = tracer.trace(scene, &mut numbers, record.position, events, &mut record);
                    strategies.add(&record, &found.sensor);
                }
            }
        }
        strategies
    }

    fn add(&mut self, record: &Contributions, sensor: &Sensor) {
        let [w, h] = self.size;
        for &((s, t), at, value, weight) in &record.found {
            let pixel = |at: Real, n: u32| ((at * n as Real) as u32).min(n - 1);
            let pixel = (pixel(at.y, h) * w + pixel(at.x, w)) as usize;
            for (sum, value) in self.sums[index(s, s + t - 1)].iter_mut().zip([value, value * weight]) {
                for (sum, v) in sum[pixel].iter_mut().zip(sensor.xyz(&value)) {
                    *sum += f64::from(v) / f64::from(self.passes);
                }
            }
        }
    }

    /// Mean X, Y and Z of a strategy with s vertices of the light's path and so many edges, 1 to 7, in cd/m²: as if
    /// there were no other, and weighted.
    pub fn mean(&self, s: u32, edges: u32) -> [[f64; 3]; 2] {
        self.sums[index(s, edges)].each_ref().map(|picture| mean(picture))
    }

    /// Both pyramids in one picture, the unweighted to the left. Every row has an exposure of its own: what its
    /// weighted pictures add up to has a mean luminance of 1.
    ///
    /// # Errors
    /// None in practice: the picture is small.
    pub fn pyramids(&self) -> Result<XyzImage, indigo_film::FilmError> {
        let step = self.size.map(|n| n + GAP);
        let size = FilmSize::new(2 * COLUMNS * step[0] + GAP, MOST_EDGES * step[1], 1)?;
        let mut pixels = vec![[0.0, 0.0, 0.0, 1.0]; size.pixels()];
        for edges in 1..=MOST_EDGES {
            let light: f64 = (0..=edges).map(|s| self.mean(s, edges)[1][1]).sum();
            let exposure = if light > 0.0 { 1.0 / light } else { 0.0 };
            for s in 0..=edges {
                for (half, picture) in self.sums[index(s, edges)].iter().enumerate() {
                    let left = half as u32 * (COLUMNS * step[0] + GAP) + s * step[0];
                    let top = (edges - 1) * step[1];
                    for (i, xyz) in picture.iter().enumerate() {
                        let (x, y) = (i as u32 % self.size[0], i as u32 / self.size[0]);
                        let at = ((top + y) * size.width() + left + x) as usize;
                        let [x, y, z] = xyz.map(|v| (v * exposure) as f32);
                        pixels[at] = [x, y, z, 1.0];
                    }
                }
            }
        }
        let missing = vec![false; pixels.len()];
        Ok(XyzImage { size, pixels, missing })
    }
}

fn mean(picture: &[[f64; 3]]) -> [f64; 3] {
    let n = picture.len() as f64;
    picture.iter().fold([0.0; 3], |sum, p| std::array::from_fn(|c| sum[c] + p[c] / n))
}
