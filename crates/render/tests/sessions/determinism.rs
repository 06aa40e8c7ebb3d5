//! The same seed and the same number of samples give the same film.

use super::common::judge::assert_same;
use super::common::{measure, whole};
use super::{options, run, small_scene};
use indigo_film::FilmState;
use indigo_render::Options;

/// Sums of a film in the order of its pixels.
fn sums(film: &FilmState) -> impl Iterator<Item = f64> + '_ {
    film.layers[0].sums.iter().flatten().copied()
}

#[test]
fn in_deterministic_mode_any_number_of_threads_gives_the_same_bits() {
    let scene = small_scene(2, "");
    let (one, ..) = run(&scene, &options(1, 8));
    assert!(sums(&one).sum::<f64>() > 0.0);
    for threads in [2, 7] {
        let (film, ..) = run(&scene, &options(threads, 8));
        assert!(film == one, "{threads} threads differ from one");
    }
    let (again, ..) = run(&scene, &options(1, 8));
    assert!(again == one, "the second run differs");
    let (other, ..) = run(&scene, &Options { seed: 12, ..options(1, 8) });
    assert!(other != one, "another seed gives the same film");
}

#[test]
fn otherwise_films_differ_by_the_rounding_of_sums_alone() {
    let scene = small_scene(1, "");
    let (ordered, ..) = run(&scene, &options(1, 16));
    for threads in [1, 3] {
        let (film, ..) = run(&scene, &Options { deterministic: false, ..options(threads, 16) });
        assert_eq!(film.layers[0].counts, ordered.layers[0].counts);
        for (a, b) in sums(&film).zip(sums(&ordered)) {
            // 16 single-precision additions, each with an error of half an ulp of the sum.
            assert!((a - b).abs() <= 16.0 * 6e-8 * a.abs().max(b.abs()), "{a} and {b}");
        }
    }
}

#[test]
fn a_region_is_rendered_as_the_crop_of_the_whole() {
    let region = "<render_region><x1>5</x1><y1>17</y1><x2>44</x2><y2>31</y2></render_region>";
    // 4 samples per pixel of the whole are 16.9 passes over the region: 17, since passes are whole.
    let (all, ..) = run(&small_scene(2, ""), &options(2, 17));
    let (part, _, progress) = run(&small_scene(2, region), &options(2, 4));
    assert_eq!(progress.samples, 39 * 14 * 17);
    assert_eq!(progress.samples_per_pixel, f64::from(39 * 14 * 17) / f64::from(48 * 48));
    assert_eq!(part.samples_per_pixel(), progress.samples_per_pixel);
    let width = all.size.internal_width() as usize;
    for i in 0..all.layers[0].sums.len() {
        let inside = (10..88).contains(&(i % width)) && (34..62).contains(&(i / width));
        let expected = if inside { all.layers[0].sums[i] } else { [0.0; 4] };
        assert_eq!(part.layers[0].sums[i], expected, "internal pixel {i}");
    }
}

/// Four sizes of the same picture have one mean, to what chance explains.
#[test]
fn super_sampling_keeps_the_mean() {
    let plain = measure(&small_scene(1, ""), 12, 16);
    for factor in 2..=4 {
        let scene = small_scene(factor, "");
        assert_eq!(whole(&scene)[0][1], 48 * factor as usize);
        let fine = measure(&scene, 12, 16);
        for (what, (a, b)) in ["X", "Y", "Z", "alpha"].iter().zip(plain.xyza.iter().zip(&fine.xyza)) {
            assert_same(&format!("factor {factor}, {what}"), a, b);
        }
    }
}
