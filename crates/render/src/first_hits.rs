//! What the pixels of a scene show besides light, found when it is first asked for.

use indigo_film::FirstHit;
use indigo_scene::{Names, Scene};
use indigo_transport::first_hit::{FilmRay, FirstHits};
use rayon::prelude::*;
use std::ops::Range;
use std::sync::{Arc, OnceLock};

/// Rows of output pixels that are traced together.
const BAND: usize = 16;
/// The most pixels, internal or output, that a ray's splat reaches beyond its own.
const REACH: u32 = 2;

/// The first hits of a scene's pixels.
pub struct SceneFirstHits {
    scene: Arc<Scene>,
    found: OnceLock<Found>,
}

struct Found {
    hits: Vec<FirstHit>,
    weights: Vec<[f32; 2]>,
}

impl SceneFirstHits {
    /// Of a scene; nothing is done yet.
    pub fn of(scene: Arc<Scene>) -> Self {
        Self { scene, found: OnceLock::new() }
    }

    /// The names of the objects and materials whose numbers are in them.
    pub fn names(&self) -> &Names {
        &self.scene.names
    }

    /// One for each output pixel, rows from top to bottom; nothing beyond the region that is rendered. The first call
    /// traces camera rays on the caller's rayon pool.
    pub fn get(&self) -> &[FirstHit] {
        &self.found().hits
    }

    /// For each internal pixel the weights that the splat filter gives to the rays round it: the sum of those that meet
    /// something, and that of all. [`indigo_imaging::coverage`] makes coverage of them, which goes with the film's light.
    pub fn weights(&self) -> &[[f32; 2]] {
        &self.found().weights
    }

    fn found(&self) -> &Found {
        self.found.get_or_init(|| find(&self.scene))
    }
}

fn find(scene: &Scene) -> Found {
    let size = scene.film.size;
    let height = size.height() as usize;
    let bands = (0..height.div_ceil(BAND)).into_par_iter();
    let bands: Vec<Band> =
        bands.map(|i| Band::trace(scene, i * BAND..((i + 1) * BAND).min(height))).collect();
    let mut found =
        Found { hits: Vec::with_capacity(size.pixels()), weights: vec![[0.0; 2]; size.internal_pixels()] };
    // In their order, so that sums are always rounded alike.
    for band in bands {
        found.hits.extend(band.hits);
        let rows = &mut found.weights[band.first * size.internal_width() as usize..];
        rows.as_flattened_mut().iter_mut().zip(band.weights.as_flattened()).for_each(|(sum, w)| *sum += w);
    }
    found
}

/// What a run of rows shows.
struct Band {
    hits: Vec<FirstHit>,
    /// The first row of internal pixels that its rays touch.
    first: usize,
    /// Weights of its rays in the rows from that on.
    weights: Vec<[f32; 2]>,
}

impl Band {
    fn trace(scene: &Scene, rows: Range<usize>) -> Self {
        let size = scene.film.size;
        let [factor, width, reach] = [size.super_sample(), size.internal_width(), REACH].map(|n| n as usize);
        let first = (rows.start * factor).saturating_sub(reach);
        let end = (rows.end * factor + reach).min(size.internal_height() as usize);
        let blank = vec![FirstHit::NOTHING; rows.len() * size.width() as usize];
        let mut band = Self { hits: blank, first, weights: vec![[0.0; 2]; (end - first) * width] };
        let [columns, lines] = scene.film.region.unwrap_or([[0, size.width()], [0, size.height()]]);
        let is_rendered =
            |x: u32, y: u32| (columns[0]..columns[1]).contains(&x) && (lines[0]..lines[1]).contains(&y);
        let mut tracer = FirstHits::default();
        for (y, row) in rows.map(|y| y as u32).zip(band.hits.chunks_exact_mut(size.width() as usize)) {
            if !(lines[0].saturating_sub(REACH)..lines[1] + REACH).contains(&y) {
                continue;
            }
            for x in columns[0].saturating_sub(REACH)..(columns[1] + REACH).min(size.width()) {
                let (hit, rays) = tracer.of_pixel(scene, [x, y]);
                for ray in &rays {
                    splat(scene, ray, first, &mut band.weights);
                }
                // Those round a region only splat into it.
                if is_rendered(x, y) {
                    row[x as usize] = hit;
                }
            }
        }
        band
    }
}

/// Adds a ray's weights to rows of internal pixels from `first` on.
fn splat(scene: &Scene, ray: &FilmRay, first: usize, weights: &mut [[f32; 2]]) {
    let width = scene.film.size.internal_width() as usize;
    let footprint = scene.film.filter.footprint(ray.position);
    let [left, top] = footprint.origin.map(|n| n as usize);
    for (j, row) in footprint.rows[..footprint.extent[1]].iter().enumerate() {
        let line = &mut weights[(top + j - first) * width + left..][..footprint.extent[0]];
        for (pixel, column) in line.iter_mut().zip(footprint.columns) {
            let weight = row * column;
            pixel[0] += if ray.hits { weight } else { 0.0 };
            pixel[1] += weight;
        }
    }
}
