//! How noisy pictures are.

use super::film;
use indigo_scene::Scene;

/// Luminance of each pixel.
pub fn luminances(scene: &Scene, seed: u64, passes: u64) -> Vec<f64> {
    film(scene, seed, passes).develop().pixels.iter().map(|p| f64::from(p[1])).collect()
}

/// Mean of the pixels' squared errors over their squared values, of some pictures.
pub fn rel_mse(scene: &Scene, truth: &[f64], seeds: std::ops::Range<u64>, passes: u64) -> f64 {
    let pictures = seeds.end - seeds.start;
    let error = |seed| {
        let picture = luminances(scene, seed, passes);
        let pixels = picture.iter().zip(truth).map(|(v, t)| (v / t - 1.0).powi(2));
        pixels.sum::<f64>() / truth.len() as f64
    };
    seeds.map(error).sum::<f64>() / pictures as f64
}
