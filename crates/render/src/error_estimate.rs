//! How far a picture still is from what it converges to.
//!
//! The samples of a session are gathered in two halves, a and b, that are independent of each other. A pixel whose
//! samples have the variance σ² differs between the halves by σ² (1/n_a + 1/n_b) in the mean square, while the mean of
//! all n samples is off by σ²/n. So (a − b)² n_a n_b / ((n_a + n_b) n) estimates the square of its error without bias.
//! It does so very badly for one pixel, but well for the mean over a picture of thousands, which is what the
//! estimate is: E = √(mean of the squared errors) / mean, of the luminance of output pixels.
//!
//! With p pixels of independent noise the relative standard error of E is about 1 / √(2 p); splat filters that
//! spread over k pixels leave p / k of them. Half of the light in a few pixels (fireflies, caustics just begun)
//! leaves as few that count, and noise that no sample has met yet is in no estimate.
//!
//! That Markov chains are correlated makes no difference: chains belong to one half as a whole.
//!
//! Where all samples were black there is no estimate. Either the picture is black, or the whole of its light is missing,
//! and the error is 1 at least, as the root of a mean square is no less than the mean. Samples cannot tell: where a part q
//! of them finds light, N find none with the probability (1 − q)^N, about exp(−q N), which bounds q (below 3 / N, with
//! 95 % confidence), but not how bright the light is that so few would bring. So the error of a black picture is known, and 0,
//! only where the scene has no light that could come into it.

use indigo_film::XyzImage;

/// Samples of the halves and of the film as a whole, in one unit.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Counts {
    pub halves: [f64; 2],
    pub all: f64,
}

/// What is looked at.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Picture {
    /// First and last (excluded) output columns and rows.
    pub region: [[u32; 2]; 2],
    /// Whether it shows coverage, and not luminance.
    pub is_mask: bool,
    /// Whether it is known to be black.
    pub is_dark: bool,
}

/// The estimate; `None` while a half has no sample in some pixel, or where no light has been found that there may be.
pub(crate) fn relative_error(halves: [&XyzImage; 2], picture: Picture, counts: Counts) -> Option<f64> {
    let [n_a, n_b] = counts.halves;
    if n_a <= 0.0 || n_b <= 0.0 {
        return None;
    }
    let [columns, rows] = picture.region;
    let channel = if picture.is_mask { 3 } else { 1 };
    let (mut squares, mut sum, mut pixels) = (0.0, 0.0, 0.0);
    for y in rows[0]..rows[1] {
        for x in columns[0]..columns[1] {
            let [a, b] = halves.map(|image| mean(image, channel, x, y));
            let (a, b) = (a?, b?);
            squares += (a - b).powi(2);
            sum += (n_a * a + n_b * b) / (n_a + n_b);
            pixels += 1.0;
        }
    }
    if picture.is_dark {
        return Some(0.0);
    }
    let scale = n_a * n_b / ((n_a + n_b) * counts.all);
    (sum > 0.0).then(|| (squares / pixels * scale).sqrt() / (sum / pixels))
}

/// The mean of a channel over an output pixel's internal pixels; `None` where one has no sample.
fn mean(image: &XyzImage, channel: usize, x: u32, y: u32) -> Option<f64> {
    let (size, factor) = (image.size, image.size.super_sample() as usize);
    let width = size.internal_width() as usize;
    let first = y as usize * factor * width + x as usize * factor;
    let mut sum = 0.0;
    for row in 0..factor {
        for i in first + row * width..first + row * width + factor {
            if image.missing[i] {
                return None;
            }
            sum += f64::from(image.pixels[i][channel]);
        }
    }
    Some(sum / (factor * factor) as f64)
}

#[cfg(test)]
mod tests {
    use super::*;
    use indigo_film::FilmSize;
    use indigo_math::rng::Rng;

    fn image(size: FilmSize, mut value: impl FnMut() -> f64) -> XyzImage {
        let n = size.internal_pixels();
        let pixels = (0..n).map(|_| [0.0, value() as f32, 0.0, 1.0]).collect();
        XyzImage { size, pixels, missing: vec![false; n] }
    }

    /// Halves of unlike size, with noise of a known variance per sample: twelve uniform numbers make it nearly normal.
    #[test]
    fn known_noise_is_told() {
        let size = FilmSize::new(60, 50, 2).unwrap();
        let mut rng = Rng::new(3);
        let mut normal = || (0..12).map(|_| rng.next_f64()).sum::<f64>() - 6.0;
        let (n_a, n_b, all) = (300.0f64, 100.0f64, 1000.0);
        let mut noisy = |n: f64| image(size, || 5.0 + normal() / (n / 4.0).sqrt());
        let (a, b) = (noisy(n_a), noisy(n_b));
        let counts = Counts { halves: [n_a, n_b], all };
        let whole = Picture { region: [[0, 60], [0, 50]], is_mask: false, is_dark: false };
        // Four internal pixels of n/4 samples with deviation 1 make an output pixel's deviation 1/√n.
        let expected = 1.0 / all.sqrt() / 5.0;
        let estimate = relative_error([&a, &b], whole, counts).unwrap();
        // 3000 pixels: the estimate's own deviation is 1.3 %, five of which are allowed.
        assert!((estimate / expected - 1.0).abs() < 0.065, "{estimate} instead of {expected}");
        let mut gap = b.clone();
        gap.missing[7] = true;
        assert_eq!(relative_error([&a, &gap], whole, counts), None);
        assert!(
            relative_error([&a, &gap], Picture { region: [[0, 60], [1, 50]], ..whole }, counts).is_some()
        );
        let black = image(size, || 0.0);
        assert_eq!(relative_error([&black, &black], whole, counts), None);
        assert_eq!(relative_error([&black, &black], Picture { is_dark: true, ..whole }, counts), Some(0.0));
        assert_eq!(relative_error([&black, &gap], Picture { is_dark: true, ..whole }, counts), None);
        // All is covered, whatever the luminance.
        assert_eq!(relative_error([&a, &b], Picture { is_mask: true, ..whole }, counts), Some(0.0));
    }
}
