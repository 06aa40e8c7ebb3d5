//! Estimates the error now and then, at little cost beside the rendering itself.

use crate::error_estimate::{Counts, Picture, relative_error};
use crate::pool::with_jobs;
use crate::worker::Shared;
use indigo_film::{MasterFilm, XyzImage};

/// Growth of the number of samples after which the error, which falls with its root, is worth another look.
const GROWTH: f64 = 1.05;

/// The last estimate, and when the next is due.
pub(crate) struct ErrorMeter {
    threads: usize,
    /// Samples per pixel.
    due_at: f64,
    last: Option<f64>,
}

impl ErrorMeter {
    /// With the number of threads that may develop.
    pub fn new(threads: usize) -> Self {
        Self { threads, due_at: 0.0, last: None }
    }

    /// The last estimate.
    pub fn last(&self) -> Option<f64> {
        self.last
    }

    /// Estimates the error anew, if enough has been added since the last time; `None` otherwise, and where no
    /// estimate can be made yet.
    pub fn update(&mut self, shared: &Shared) -> Option<f64> {
        let all = shared.films.iter().map(MasterFilm::samples_per_pixel).sum::<f64>();
        if all < self.due_at {
            return None;
        }
        self.due_at = all * GROWTH;
        self.estimate(shared)
    }

    /// Estimates the error of the films as they stand.
    pub fn estimate(&mut self, shared: &Shared) -> Option<f64> {
        let [before, a, b] = &shared.films[..] else { return None };
        let taken = [before, a, b].map(MasterFilm::samples_per_pixel);
        // As the scene has them: who turns lights up and down meanwhile does not ask for other samples.
        let mix = &shared.scene.picture.lights;
        let images: [XyzImage; 2] = with_jobs(self.threads, || [a.develop(mix), b.develop(mix)]);
        let size = shared.scene.film.size;
        let is_mask = shared.scene.picture.foreground_alpha;
        let picture = Picture {
            region: shared.scene.film.region.unwrap_or([[0, size.width()], [0, size.height()]]),
            is_mask,
            is_dark: !(is_mask || shared.scene.lights.shine() && mix.shows_any()),
        };
        let counts = Counts { halves: [taken[1], taken[2]], all: taken.iter().sum() };
        self.last = relative_error([&images[0], &images[1]], picture, counts);
        self.last
    }
}
