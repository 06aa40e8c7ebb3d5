//! A render on the calling thread that can be paused, and how far its picture is off.

use super::reference::Reference;
use cpu_time::ThreadTime;
use indigo_film::{FilmDelta, FilmState};
use indigo_scene::Scene;
use indigo_transport::driver::Driver;
use indigo_transport::technique::Tracer;

/// Added to the squared reference, over its mean square: what counts as dark.
const DARK: f64 = 0.01;
/// Terms beyond this quantile are cut to it, so that a single firefly does not decide.
const QUANTILE: f64 = 0.999;

/// A render in one mode.
pub struct Run<'a> {
    scene: &'a Scene,
    driver: Driver,
    tracer: Tracer,
    film: FilmState,
    delta: FilmDelta,
    unit: u64,
    pub samples: u64,
    /// Of this thread.
    pub seconds: f64,
    /// Seconds and error after each turn.
    pub history: Vec<(f64, f64)>,
}

impl<'a> Run<'a> {
    pub fn new(scene: &'a Scene, seed: u64) -> Self {
        let driver = Driver::new(scene, seed);
        let film = FilmState::new(scene.film.size, driver.layers());
        let (tracer, delta) = (driver.tracer(), film.delta());
        Self { scene, driver, tracer, film, delta, unit: 0, samples: 0, seconds: 0.0, history: vec![] }
    }

    /// Renders for so many seconds more.
    pub fn go_on(&mut self, seconds: f64) {
        let start = ThreadTime::now();
        loop {
            self.samples += self.driver.render_unit(self.scene, self.unit, &mut self.tracer, &mut self.delta);
            self.unit += 1;
            if start.elapsed().as_secs_f64() >= seconds {
                break;
            }
        }
        self.film.merge(&self.delta).expect("made by this film");
        self.delta.clear();
        self.seconds += start.elapsed().as_secs_f64();
    }

    pub fn samples_per_pixel(&self) -> f64 {
        self.samples as f64 / self.driver.pixels() as f64
    }

    pub fn rays(&self) -> u64 {
        self.tracer.rays()
    }

    /// X, Y and Z of each pixel.
    pub fn picture(&self) -> Vec<[f32; 3]> {
        self.film.develop().pixels.iter().map(|p| [p[0], p[1], p[2]]).collect()
    }
}

/// relMSE of luminance, and the mean of that of X, Y and Z: the mean of (I − R)² / (R² + 0.01 · mean(R²)), cut at
/// the 99.9th percentile, less what the reference's own noise adds.
pub fn errors(picture: &[[f32; 3]], reference: &Reference) -> [f64; 2] {
    let of: [f64; 3] = std::array::from_fn(|c| {
        rel_mse(reference, c, |i| f64::from(picture[i][c] - reference.mean[i][c])) - reference.noise[c]
    });
    [of[1], (of[0] + of[1] + of[2]) / 3.0]
}

/// The relMSE of a difference of pictures in one channel.
pub fn rel_mse(reference: &Reference, channel: usize, difference: impl Fn(usize) -> f64) -> f64 {
    let squares = |i: usize| f64::from(reference.mean[i][channel]).powi(2);
    let n = reference.mean.len();
    let dark = DARK * (0..n).map(squares).sum::<f64>() / n as f64;
    let mut terms: Vec<f64> = (0..n).map(|i| difference(i).powi(2) / (squares(i) + dark)).collect();
    terms.sort_by(f64::total_cmp);
    let most = terms[((n as f64 * QUANTILE) as usize).min(n - 1)];
    terms.iter().map(|t| t.min(most)).sum::<f64>() / n as f64
}
