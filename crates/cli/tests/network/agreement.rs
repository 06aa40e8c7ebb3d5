//! Whether the picture of many machines is that of one.

use super::workbench::Workbench;
use indigo_film::{FilmState, SavedFilm, igi};

/// Blocks along the sides of the picture.
const BLOCKS: [usize; 2] = [4, 3];
/// Renders of one machine, of other seeds, and samples per pixel of each.
const BATCHES: usize = 24;
const PASSES: u64 = 16;
/// Student's t of 23 degrees of freedom beyond which a block is wrong: two-sided p = 4e-7, and so 5e-6 for any of the 12
/// blocks. How many samples a network render has is up to chance, so that no seed fixes what is judged.
const LIMIT: f64 = 7.0;

/// Mean luminance of each block.
fn means(film: &FilmState) -> Vec<f64> {
    let (width, height) = (film.size.internal_width() as usize, film.size.internal_height() as usize);
    let image = film.develop();
    let mut sums = vec![0.0; BLOCKS[0] * BLOCKS[1]];
    for (i, pixel) in image.pixels.iter().enumerate() {
        let (x, y) = (i % width * BLOCKS[0] / width, i / width * BLOCKS[1] / height);
        sums[y * BLOCKS[0] + x] += f64::from(pixel[1]);
    }
    let pixels = (width * height / sums.len()) as f64;
    sums.iter().map(|sum| sum / pixels).collect()
}

/// Says that a film of the bench's scene agrees with renders of a single process.
pub fn assert_agrees(bench: &Workbench, film: &SavedFilm) {
    let batches: Vec<Vec<f64>> = (0..BATCHES)
        .map(|batch| {
            let (seed, passes) = ((1000 + batch).to_string(), PASSES.to_string());
            let ran = bench.run(&["scene.igs", "-seed", &seed, "-haltspp", &passes, "-o", "one.png"]);
            assert_eq!(ran.status, Some(0), "{ran:?}");
            let bytes = std::fs::read(bench.path("one.igi")).expect("the film");
            means(&igi::read(&bytes).expect("a sound film").film)
        })
        .collect();
    let many = means(&film.film);
    // The noise of independent samples goes down with their number, or faster where they are well spread: then this
    // allows the network render more noise than it has.
    let share = PASSES as f64 / film.film.samples_per_pixel();
    for (block, found) in many.iter().enumerate() {
        let mean = batches.iter().map(|batch| batch[block]).sum::<f64>() / BATCHES as f64;
        let square = |batch: &Vec<f64>| (batch[block] - mean).powi(2);
        let variance = batches.iter().map(square).sum::<f64>() / (BATCHES - 1) as f64;
        let t = (found - mean) / (variance * (share + 1.0 / BATCHES as f64)).sqrt();
        assert!(t.abs() < LIMIT, "block {block}: {found} instead of {mean}, t = {t:.1}");
        let error = (variance / BATCHES as f64).sqrt() / mean;
        assert!(error < 0.02, "the noise of block {block} hides errors: {error}");
    }
}
