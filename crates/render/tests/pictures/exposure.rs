//! The camera and the files: what a pixel measures, and where things appear.

use super::common::judge::{NITS_PER_UNIFORM, assert_is};
use super::common::shapes::{Mesh, mesh_light};
use super::common::text::{background, camera, flat_camera, grey, scene_file, settings, uniform};
use super::common::{Region, film, measure_regions, scene};
use indigo_film::SavedFilm;
use indigo_formats::image::{Image, Pixels, decode};
use indigo_render::output::{OneFile, OutputPaths, SaveJob, save_film_as};
use indigo_render::saved::blank_record;
use indigo_scene::Scene;
use indigo_testkit::stats::Moments;
use std::path::PathBuf;

/// Spectral radiance of the surroundings, W m^-3 sr^-1.
const RADIANCE: f64 = 4.0e4;
/// Side of the pictures.
const SIDE: usize = 16;

/// Uniform surroundings, seen under ±45 degrees.
fn surroundings(camera_more: &str, settings_more: &str) -> Scene {
    scene(&scene_file(&[
        settings(SIDE as u32, &format!("<splat_filter><box/></splat_filter>{settings_more}")),
        camera([0.0; 3], [0.0, 1.0, 0.0], 1.0, camera_more),
        background(&uniform(RADIANCE)),
    ]))
}

/// A directory of this test program's own, emptied.
fn scratch(name: &str) -> PathBuf {
    let directory = std::env::temp_dir().join(format!("indigo-pictures-{}-{name}", std::process::id()));
    drop(std::fs::remove_dir_all(&directory));
    std::fs::create_dir_all(&directory).expect("a directory for the test's files");
    directory
}

/// How a scene's film is saved.
fn job(scene: &Scene, png: PathBuf) -> SaveJob {
    SaveJob {
        development: scene.development(),
        paths: OutputPaths::new(png),
        version: "test".to_owned(),
        threads: 1,
        first_hits: None,
        denoiser: None,
    }
}

/// The untonemapped EXR that saving a scene's film writes to the disk.
fn saved_exr(scene: &Scene, passes: u64, name: &str) -> Image {
    let film = film(scene, 5, passes);
    let directory = scratch(name);
    let job = job(scene, directory.join("x.png"));
    let exr = job.paths.pictures().untonemapped_exr;
    let saved = job.save(&SavedFilm { film, record: None });
    assert!(saved.written.contains(&exr) && saved.failures.is_empty(), "{saved:?}");
    let image = decode("x.exr", &std::fs::read(&exr).expect("the file is there")).expect("it is an EXR");
    std::fs::remove_dir_all(directory).expect("the test's own files");
    image
}

#[test]
fn one_file_that_is_asked_for_is_the_same_as_among_all() {
    let scene =
        surroundings("", "<save_untonemapped_exr>true</save_untonemapped_exr><save_igi>true</save_igi>");
    let directory = scratch("one");
    let job = job(&scene, directory.join("x.png"));
    let saved = SavedFilm { film: film(&scene, 5, 4), record: Some(blank_record(&scene, "test")) };
    assert!(job.save(&saved).failures.is_empty());
    let pictures = job.paths.pictures();
    let files = [
        (OneFile::Picture, pictures.png),
        (OneFile::Luminances, pictures.untonemapped_exr),
        (OneFile::Film, job.paths.igi()),
    ];
    for (what, among_all) in files {
        let alone = directory.join("folder").join("alone");
        assert_eq!(job.save_as(&saved, what, &alone).expect("it is written"), alone);
        let bytes = |path: &PathBuf| std::fs::read(path).expect("the file is there");
        let (alone, among_all) = (bytes(&alone), bytes(&among_all));
        if what == OneFile::Luminances {
            // What an EXR says of itself is in no fixed order.
            let pixels = |bytes: &[u8]| decode("x.exr", bytes).expect("a picture").pixels;
            assert!(pixels(&alone) == pixels(&among_all), "{what:?}");
        } else {
            assert!(alone == among_all, "{what:?}");
        }
    }
    std::fs::remove_dir_all(directory).expect("the test's own files");
}

#[test]
fn a_film_without_its_scene_gives_the_same_picture() {
    let scene = surroundings("", "");
    let directory = scratch("film-alone");
    let job = job(&scene, directory.join("x.png"));
    let saved = SavedFilm { film: film(&scene, 5, 4), record: Some(blank_record(&scene, "test")) };
    for (what, ending) in [(OneFile::Picture, "png"), (OneFile::Luminances, "exr")] {
        let (with, without) = (directory.join("with").join(ending), directory.join("without").join(ending));
        job.save_as(&saved, what, &with).expect("it is written");
        save_film_as(&saved, what, &without, &job.development.picture, "test", 1).expect("it is written");
        let bytes = |path: &PathBuf| std::fs::read(path).expect("the file is there");
        let pixels = |path: &PathBuf| decode(&format!("x.{ending}"), &bytes(path)).expect("a picture").pixels;
        assert!(pixels(&with) == pixels(&without), "{what:?}");
        assert!(bytes(&with) != bytes(&without), "only the scene knows how light was transported");
    }
    std::fs::remove_dir_all(directory).expect("the test's own files");
}

/// Luminances of a linear Rec. 709 picture; the weights are those of ITU-R BT.709 in full precision.
fn luminances(image: &Image) -> Vec<f64> {
    let Pixels::F32(values) = &image.pixels else { panic!("an EXR of 32-bit floats is expected") };
    let luminance = |p: &[f32]| {
        0.212_639_0 * f64::from(p[0]) + 0.715_168_7 * f64::from(p[1]) + 0.072_192_3 * f64::from(p[2])
    };
    values.chunks(3).map(luminance).collect()
}

/// Mean of cos⁴ over the pixels of a region of a picture that spans ±45 degrees.
fn mean_cos4(region: Region) -> f64 {
    let per_pixel = 16;
    let points = |[lo, hi]: [usize; 2]| {
        (lo * per_pixel..hi * per_pixel)
            .map(move |i| (i as f64 + 0.5) / (SIDE * per_pixel) as f64 * 2.0 - 1.0)
    };
    let values =
        points(region[1]).flat_map(|y| points(region[0]).map(move |x| (1.0 + x * x + y * y).powi(-2)));
    Moments::of(values).mean()
}

#[test]
fn without_vignetting_the_exr_holds_the_luminance_in_every_pixel() {
    for (name, in_camera, in_settings) in
        [("camera", "<vignetting>false</vignetting>", ""), ("settings", "", "<vignetting>false</vignetting>")]
    {
        let save = format!("<save_untonemapped_exr>true</save_untonemapped_exr>{in_settings}");
        let image = saved_exr(&surroundings(in_camera, &save), 1024, name);
        assert_eq!((image.width, image.height, image.channels), (SIDE as u32, SIDE as u32, 3));
        // 1024 samples of the wavelength in low-discrepancy order leave far less than 0.1%.
        for y in luminances(&image) {
            assert!((y / (RADIANCE * NITS_PER_UNIFORM) - 1.0).abs() < 1e-3, "{y}");
        }
    }
}

#[test]
fn with_vignetting_the_exr_holds_the_luminance_on_the_axis() {
    let scene = surroundings("", "<save_untonemapped_exr>true</save_untonemapped_exr>");
    let image = saved_exr(&scene, 1024, "axis");
    let centre = luminances(&image)[SIDE / 2 * SIDE + SIDE / 2];
    let expected = RADIANCE * NITS_PER_UNIFORM * mean_cos4([[8, 9], [8, 9]]);
    assert!((centre / expected - 1.0).abs() < 1e-3, "{centre} instead of {expected}");
}

#[test]
fn a_super_sampled_exr_holds_the_same_luminance() {
    let save = "<save_untonemapped_exr>true</save_untonemapped_exr>";
    for factor in [3, 5, 6, 7, 8] {
        // As many samples for an internal pixel, whatever their number, with fewer pixels of more of them.
        let side = if factor == 3 { SIDE as u32 } else { 4 };
        let text = settings(side, save)
            .replace("<super_sample_factor>1", &format!("<super_sample_factor>{factor}"))
            .replace("<metropolis>", "<downsize_filter><mn_cubic/></downsize_filter><metropolis>");
        let scene = scene(&scene_file(&[
            text,
            flat_camera([0.0; 3], [0.0, 1.0, 0.0], 1.0),
            background(&uniform(RADIANCE)),
        ]));
        let spp = 64 * factor * factor;
        let all = Moments::of(luminances(&saved_exr(&scene, spp, &format!("super{factor}"))));
        assert!((all.mean() / (RADIANCE * NITS_PER_UNIFORM) - 1.0).abs() < 1e-3, "{factor}: {}", all.mean());
    }
}

#[test]
fn luminance_falls_with_the_fourth_power_of_the_cosine() {
    let scene = surroundings("", "");
    let regions = [[[0, 1], [0, 1]], [[0, 1], [7, 9]], [[6, 10], [6, 10]], [[12, 14], [2, 5]]];
    for (region, measured) in regions.into_iter().zip(measure_regions(&scene, &regions, 12, 2048)) {
        let expected = RADIANCE * NITS_PER_UNIFORM * mean_cos4(region);
        assert_is(&format!("{region:?}"), measured.luminance(), expected, 1e-3);
    }
}

/// First and second moments of where light falls on the film, in pixels from its middle.
fn centroid_and_variance(scene: &Scene, seed: u64, passes: u64) -> [f64; 4] {
    let film = film(scene, seed, passes);
    let (mut sum, mut first, mut second) = (0.0, [0.0; 2], [0.0; 2]);
    for (i, pixel) in film.layers[0].sums.iter().enumerate() {
        let side = film.size.internal_width() as usize;
        let at = [i % side, i / side].map(|v| v as f64 + 0.5 - 0.5 * side as f64);
        sum += pixel[1];
        for axis in 0..2 {
            first[axis] += pixel[1] * at[axis];
            second[axis] += pixel[1] * at[axis] * at[axis];
        }
    }
    let [x, y] = first.map(|v| v / sum);
    [x, y, second[0] / sum - x * x, second[1] / sum - y * y]
}

/// A disc out of focus is seen as its sharp image convolved with the aperture's: a disc whose radius
/// on the sensor is that of the aperture times |1/distance - 1/focus| times the lens-sensor distance.
/// Variances add; that of a disc of radius r is r²/4 along each axis, that of a pixel 1/12.
#[test]
fn blur_out_of_focus_has_the_size_of_the_aperture() {
    let (side, tangent, radius, aperture) = (64u32, 0.25, 0.15, 0.2);
    for (distance, focus) in [(3.0, 1.2), (3.0, 30.0), (3.0, 3.0)] {
        let lens = flat_camera([0.0; 3], [0.0, 1.0, 0.0], tangent)
            .replace("<aperture_radius>1e-5", &format!("<aperture_radius>{aperture}"))
            .replace("<focus_distance>1<", &format!("<focus_distance>{focus}<"));
        // Shown to the camera's left and above: a mirrored picture would not do.
        let place = [-0.25, distance, 0.2];
        let lamp =
            Mesh::disc(radius, 64).placed([1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, -1.0, 0.0], 1.0, [0.0; 3]);
        let text = scene_file(&[
            settings(side, "<splat_filter><box/></splat_filter>"),
            lens,
            grey("black", 0.0),
            lamp.text("disc", "black"),
            mesh_light("disc", &uniform(RADIANCE), place, 1.0, ""),
        ]);
        let scene = scene(&text);
        let mut moments = [Moments::default(); 4];
        for seed in 0..10 {
            for (m, v) in moments.iter_mut().zip(centroid_and_variance(&scene, seed, 96)) {
                m.add(v);
            }
        }
        let pixels_per_tangent = f64::from(side) / (2.0 * tangent);
        let sharp = radius / distance * pixels_per_tangent;
        let blur = aperture * (1.0 / distance - 1.0 / focus).abs() * pixels_per_tangent;
        let variance = 0.25 * (sharp * sharp + blur * blur) + 1.0 / 12.0;
        // An inscribed 64-gon has 0.16% less area and spread than its circle.
        let what = |axis| format!("distance {distance}, focus {focus}, {axis}");
        assert_is(&what("x"), &moments[0], place[0] / distance * pixels_per_tangent, 1e-2);
        assert_is(&what("y"), &moments[1], -place[2] / distance * pixels_per_tangent, 1e-2);
        for (axis, m) in [("width", moments[2]), ("height", moments[3])] {
            let deviation = m.mean() / variance - 1.0;
            assert!(
                deviation.abs() < 1e-2 && m.std_error() < 2.5e-3 * variance,
                "{}: {deviation:+.4}",
                what(axis)
            );
        }
    }
}
