//! What the pixels of a scene show besides light, found when it is first asked for.

use indigo_film::FirstHit;
use indigo_scene::{Names, Scene};
use indigo_transport::first_hit::FirstHits;
use rayon::prelude::*;
use std::sync::{Arc, OnceLock};

/// The first hits of a scene's pixels.
pub struct SceneFirstHits {
    scene: Arc<Scene>,
    found: OnceLock<Vec<FirstHit>>,
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
        self.found.get_or_init(|| find(&self.scene))
    }
}

fn find(scene: &Scene) -> Vec<FirstHit> {
    let size = scene.film.size;
    let [columns, rows] = scene.film.region.unwrap_or([[0, size.width()], [0, size.height()]]);
    let mut hits = vec![FirstHit::NOTHING; size.pixels()];
    hits.par_chunks_mut(size.width() as usize).enumerate().for_each_init(
        FirstHits::default,
        |tracer, (y, row)| {
            let y = y as u32;
            if (rows[0]..rows[1]).contains(&y) {
                for x in columns[0]..columns[1] {
                    row[x as usize] = tracer.of_pixel(scene, [x, y]);
                }
            }
        },
    );
    hits
}
