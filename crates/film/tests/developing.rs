//! From sums to radiance: each layer's own normalisation, and pixels that have no sample yet.

use indigo_film::{FilmFilter, FilmSize, FilmState, Filter, LayerKind};
use indigo_math::Vec2;

#[test]
fn camera_pixels_are_means_of_their_own_samples() {
    let mut film = FilmState::new(FilmSize::new(3, 1, 1).unwrap(), &[(LayerKind::PerPixel, "camera")]);
    let mut delta = film.delta();
    delta.add_sample(0, 0, 0, [1.0, 2.0, 3.0], 1.0);
    for v in [2.0, 4.0, 9.0] {
        delta.add_sample(0, 1, 0, [v, 0.0, -v], 0.5);
    }
    film.merge(&delta).unwrap();
    let image = film.develop();
    assert_eq!(image.pixels, [[1.0, 2.0, 3.0, 1.0], [5.0, 0.0, -5.0, 0.5], [0.0; 4]]);
    assert_eq!(image.missing, [false, false, true]);
    assert_eq!(film.samples_per_pixel(), 4.0 / 3.0);
}

#[test]
fn splats_are_divided_by_draws_per_pixel() {
    // Eight draws over four pixels: a pixel that gathered 6 shows 6 · 4 / 8 = 3; with a brightness
    // of mean 0.5 it shows 1.5.
    let size = FilmSize::new(2, 2, 1).unwrap();
    let filter = FilmFilter::new(Filter::Box, size).unwrap();
    let mut film = FilmState::new(size, &[(LayerKind::PerScreen, "splats")]);
    let mut delta = film.delta();
    delta.splat(0, Vec2::new(1.2, 0.7), [6.0, 3.0, 0.0], &filter);
    delta.add_samples(0, 8);
    film.merge(&delta).unwrap();
    let image = film.develop();
    assert_eq!(image.pixels, [[0.0; 4], [3.0, 1.5, 0.0, 0.0], [0.0; 4], [0.0; 4]]);
    assert_eq!(image.missing, [false; 4]);

    delta.clear();
    delta.add_brightness(0, 5.0, 10);
    film.merge(&delta).unwrap();
    assert_eq!(film.develop().pixels[1], [1.5, 0.75, 0.0, 0.0]);
    assert_eq!(film.samples_per_pixel(), 2.0);
}

#[test]
fn layers_add_up() {
    let size = FilmSize::new(1, 1, 1).unwrap();
    let filter = FilmFilter::new(Filter::Box, size).unwrap();
    let mut film = FilmState::new(size, &[(LayerKind::PerPixel, "camera"), (LayerKind::PerScreen, "splats")]);
    assert_eq!(film.develop().pixels, [[0.0; 4]]);
    let mut delta = film.delta();
    delta.add_sample(0, 0, 0, [1.0; 3], 1.0);
    delta.add_sample(0, 0, 0, [3.0; 3], 1.0);
    delta.splat(1, Vec2::new(0.5, 0.5), [5.0; 3], &filter);
    delta.add_samples(1, 2);
    film.merge(&delta).unwrap();
    assert_eq!(film.develop().pixels, [[4.5, 4.5, 4.5, 1.0]]);
    // Both layers counted the same two samples.
    assert_eq!(film.samples_per_pixel(), 2.0);
}

/// A hybrid render: camera paths with their light paths in two layers, and a chain's mutations in a third.
#[test]
fn mutations_are_draws_of_their_own_and_add() {
    let size = FilmSize::new(2, 2, 3).unwrap();
    let kinds = [LayerKind::PerPixel, LayerKind::PerScreen, LayerKind::PerScreen];
    let mut film =
        FilmState::new(size, &[(kinds[0], "camera"), (kinds[1], "light"), (kinds[2], "metropolis")]);
    let mut delta = film.delta();
    (0..8).for_each(|x| delta.add_sample(0, x % 6, 0, [1.0; 3], 1.0));
    delta.add_samples(1, 8);
    delta.add_samples(2, 20);
    delta.add_brightness(2, 1.0, 5);
    film.merge(&delta).unwrap();
    // 8 paths and 20 mutations over 4 output pixels.
    assert_eq!(film.samples_per_pixel(), 7.0);
}

#[test]
fn gaps_show_the_mean_of_their_output_pixel() {
    // 3 × 3 internal pixels for each of 1 × 2 output pixels; the second has no sample at all.
    let mut film = FilmState::new(FilmSize::new(1, 2, 3).unwrap(), &[(LayerKind::PerPixel, "camera")]);
    let mut delta = film.delta();
    delta.add_sample(0, 0, 0, [2.0; 3], 1.0);
    delta.add_sample(0, 2, 1, [4.0; 3], 0.0);
    film.merge(&delta).unwrap();
    let image = film.develop();
    let mut expected = vec![[3.0, 3.0, 3.0, 0.5]; 9];
    expected[0] = [2.0, 2.0, 2.0, 1.0];
    expected[5] = [4.0, 4.0, 4.0, 0.0];
    expected.resize(18, [0.0; 4]);
    assert_eq!(image.pixels, expected);
    assert_eq!(image.missing.iter().filter(|&&m| m).count(), 16);
}
