//! Downsizing: constants, energy, borders, regions, coverage.

use indigo_film::{FilmFilter, FilmSize, FilmState, Filter, LayerKind, XyzImage};
use indigo_imaging::{
    Exposure, PictureSettings, Region, ToneMapping, develop, develop_image, linear_picture, preview_light,
    untonemapped,
};
use indigo_math::{Real, Vec2};

const FILTERS: [Filter; 4] =
    [Filter::Box, Filter::Gaussian, Filter::MN_DEFAULT, Filter::MitchellNetravali { blur: 0.0, ring: 0.5 }];

/// XYZ of D65 light of luminance 1, which is linear RGB (1, 1, 1).
const WHITE: [f32; 3] = [0.950_455_9, 1.0, 1.089_057_8];

/// With an exposure of 1 lux·s per cd/m² and scale 1: what is in the film is what is shown.
fn settings(downsize: Filter) -> PictureSettings {
    let exposure = Exposure { aperture_area: 1.0, lens_sensor_dist: 1.0, duration: 1.0 };
    let linear = ToneMapping::Linear { scale: 1.0 };
    PictureSettings { downsize, ..PictureSettings::plain(linear, exposure) }
}

fn size(width: u32, height: u32, super_sample: u32) -> FilmSize {
    FilmSize::new(width, height, super_sample).unwrap()
}

/// An image of D65 light whose luminance and coverage are functions of the internal pixel.
fn image(size: FilmSize, value: impl Fn(u32, u32) -> (f32, f32)) -> XyzImage {
    let (w, h) = (size.internal_width(), size.internal_height());
    let pixel = |x, y| {
        let (l, alpha) = value(x, y);
        [WHITE[0] * l, WHITE[1] * l, WHITE[2] * l, alpha]
    };
    let pixels: Vec<_> = (0..h).flat_map(|y| (0..w).map(move |x| (x, y))).map(|(x, y)| pixel(x, y)).collect();
    XyzImage { size, missing: vec![false; pixels.len()], pixels }
}

/// Means over output pixels, which the box filter takes, too: where nothing is brighter than white both pictures are the same.
#[test]
fn a_preview_is_the_picture_without_super_sampling() {
    let full = image(size(5, 4, 3), |x, y| ((x * 7 + y * 3) as f32 / 200.0, (x % 2) as f32));
    let small = preview_light(&full).expect("the picture is not empty");
    assert_eq!(small.size, size(5, 4, 1));
    let settings = settings(Filter::Box);
    let (a, b) = (develop_image(&full, &settings), develop_image(&small, &settings));
    assert_eq!((a.width, a.height), (b.width, b.height));
    for (a, b) in a.pixels.as_flattened().iter().zip(b.pixels.as_flattened()) {
        // Sums of nine single-precision numbers in another order.
        assert!((a - b).abs() < 1e-5, "{a} {b}");
    }
}

#[test]
fn constants_stay_constant_through_splatting_and_downsizing() {
    for super_sample in 1..=8 {
        for filter in FILTERS {
            // One output pixel is enough where it has many internal ones.
            let size = if super_sample > 4 { size(1, 1, super_sample) } else { size(3, 2, super_sample) };
            let splat = FilmFilter::new(filter, size).unwrap();
            let mut film = FilmState::new(size, &[(LayerKind::PerScreen, "splats")]);
            let mut delta = film.delta();
            let per_pixel = 200;
            for y in 0..size.internal_height() * per_pixel {
                for x in 0..size.internal_width() * per_pixel {
                    let p = [x, y].map(|v| (v as Real + 0.5) / per_pixel as Real);
                    delta.splat(0, Vec2::from(p), WHITE.map(|v| 0.7 * v), &splat);
                }
                delta.add_samples(0, u64::from(size.internal_width() * per_pixel));
                film.merge(&delta).unwrap();
                delta.clear();
            }
            for pixel in develop(&film, &settings(filter)).pixels {
                for v in &pixel[..3] {
                    assert!((v / 0.7 - 1.0).abs() < 1e-5, "{filter:?}, factor {super_sample}: {v}");
                }
            }
        }
    }
}

/// A single bright pixel keeps its light: Σ output · factor² = input. Box and Mitchell-Netravali
/// do so wherever the pixel lies; the Gaussian on average over the places within an output pixel.
#[test]
fn downsizing_keeps_energy() {
    for super_sample in 1..=8u32 {
        for filter in FILTERS {
            let size = size(9, 9, super_sample);
            let energy = |px: u32, py: u32| -> f32 {
                let image = image(size, |x, y| (f32::from(u8::from((x, y) == (px, py))) * 5e4, 0.0));
                let sum: f32 = untonemapped(&image, filter, None).pixels.iter().map(|p| p[1]).sum();
                sum * (super_sample * super_sample) as f32 / 5e4
            };
            let places = (0..super_sample).flat_map(|y| (0..super_sample).map(move |x| (x, y)));
            let energies: Vec<f32> =
                places.map(|(x, y)| energy(4 * super_sample + x, 4 * super_sample + y)).collect();
            let mean = energies.iter().sum::<f32>() / energies.len() as f32;
            assert!((mean - 1.0).abs() < 1e-5, "{filter:?}, factor {super_sample}: {mean}");
            if filter != Filter::Gaussian {
                assert!(energies.iter().all(|e| (e - 1.0).abs() < 1e-5), "{filter:?}: {energies:?}");
            }
        }
    }
}

#[test]
fn without_super_sampling_pixels_are_left_alone() {
    for filter in FILTERS {
        let image = image(size(5, 4, 1), |x, y| ((x + 5 * y) as f32 / 20.0, 1.0));
        let picture = develop_image(&image, &settings(filter));
        for (i, pixel) in picture.pixels.iter().enumerate() {
            assert!((pixel[1] - i as f32 / 20.0).abs() < 1e-6);
        }
    }
}

/// An edge between black and something far too bright is as smooth as one between black and white.
#[test]
fn bright_edges_are_smooth() {
    let edge = |bright: f32| {
        let image = image(size(4, 1, 2), |x, _| (if x >= 3 { bright } else { 0.0 }, 1.0));
        develop_image(&image, &settings(Filter::Box)).pixels.iter().map(|p| p[1]).collect::<Vec<_>>()
    };
    for (got, want) in edge(1e6).into_iter().zip([0.0, 0.5, 1.0, 1.0]) {
        assert!((got - want).abs() < 1e-6);
    }
    // The linear picture keeps the light instead.
    let image = image(size(4, 1, 2), |x, _| (if x >= 3 { 1e6 } else { 0.0 }, 1.0));
    assert!((untonemapped(&image, Filter::Box, None).pixels[1][1] / 5e5 - 1.0).abs() < 1e-6);
}

#[test]
fn small_pictures() {
    for (width, height) in [(1, 1), (1, 7), (7, 1)] {
        for super_sample in 1..=3 {
            for filter in FILTERS {
                let image = image(size(width, height, super_sample), |_, _| (0.25, 1.0));
                let picture = develop_image(&image, &settings(filter));
                assert_eq!(picture.pixels.len(), (width * height) as usize);
                for pixel in &picture.pixels {
                    assert!((pixel[0] - 0.25).abs() < 1e-6 && (pixel[3] - 1.0).abs() < 1e-6);
                }
            }
        }
    }
}

#[test]
fn the_linear_picture_has_candelas_and_colours_outside_the_gamut() {
    let size = size(1, 1, 2);
    // The spectral green of 520 nm, x̄ 0.0633, ȳ 0.7100, z̄ 0.0782, at 1000 times that.
    let image = XyzImage { size, pixels: vec![[63.3, 710.0, 78.2, 1.0]; 4], missing: vec![false; 4] };
    let [r, g, b, alpha] = untonemapped(&image, Filter::MN_DEFAULT, None).pixels[0];
    // By the published matrix from XYZ to Rec. 709.
    let want = [
        3.2409699419 * 63.3 - 1.5373831776 * 710.0 - 0.4986107603 * 78.2,
        -0.9692436363 * 63.3 + 1.8759675015 * 710.0 + 0.0415550574 * 78.2,
        0.0556300797 * 63.3 - 0.2039769589 * 710.0 + 1.0569715142 * 78.2,
    ];
    for (got, want) in [r, g, b].into_iter().zip(want) {
        assert!((f64::from(got) - want).abs() < 1e-3, "{got} instead of {want}");
    }
    assert!(r < 0.0 && (alpha - 1.0).abs() < 1e-6);
}

#[test]
fn outside_the_region_the_picture_is_black() {
    for filter in FILTERS {
        let size = size(6, 5, 2);
        let mut settings = settings(filter);
        settings.region = Some(Region::new([1, 2], [4, 5], size).unwrap());
        // Were anything outside looked at, the region's border would be brighter than 0.5.
        let inside = |x: u32, y: u32| (2..8).contains(&x) && (4..10).contains(&y);
        let image = image(size, |x, y| (if inside(x, y) { 0.5 } else { 9.0 }, 1.0));
        let linear = untonemapped(&image, filter, settings.region);
        for pixels in [&develop_image(&image, &settings).pixels, &linear.pixels] {
            assert_eq!(pixels.len(), 30);
            for (i, pixel) in pixels.iter().enumerate() {
                let want = if (1..4).contains(&(i % 6)) && (2..5).contains(&(i / 6)) { 0.5 } else { 0.0 };
                assert!((pixel[1] - want).abs() < 1e-6, "{filter:?}, pixel {i}: {}", pixel[1]);
            }
        }
    }
}

#[test]
fn regions_are_checked() {
    let size = size(6, 5, 2);
    for (from, to) in [([0, 0], [7, 5]), ([0, 0], [6, 6]), ([3, 0], [3, 5]), ([0, 4], [6, 3])] {
        assert!(Region::new(from, to, size).is_err());
    }
    assert_eq!(Region::new([0, 0], [6, 5], size), Ok(Region::whole(size)));
}

#[test]
fn foreground_alpha_is_grey_coverage() {
    let image = image(size(3, 1, 2), |x, _| (7.0, if x < 3 { 1.0 } else { 0.0 }));
    let mut settings = settings(Filter::Box);
    settings.foreground_alpha = true;
    let mask = [[1.0; 4], [0.5; 4], [0.0; 4]];
    assert_eq!(develop_image(&image, &settings).pixels, mask);
    assert_eq!(linear_picture(&image, &settings).pixels, mask);
    // A filter with negative lobes leaves no coverage below 0 or above 1.
    settings.downsize = Filter::MitchellNetravali { blur: 0.0, ring: 0.5 };
    let pixels = linear_picture(&image, &settings).pixels;
    assert!(pixels.iter().flatten().all(|v| (0.0..=1.0).contains(v)) && pixels[0] == [1.0; 4], "{pixels:?}");
}

/// The light of one output pixel, away from the borders, is all in the picture, and an even picture stays even, for
/// every factor that a scene may ask for.
#[test]
fn downsizing_keeps_flux_and_flatness_for_every_factor() {
    for factor in 1..=8 {
        let block = |v: u32| v / factor == 4;
        let image = image(size(9, 9, factor), |x, y| (if block(x) && block(y) { 1.0 } else { 0.0 }, 1.0));
        let even = self::image(size(9, 9, factor), |_, _| (1.0, 1.0));
        for filter in FILTERS {
            let flat = untonemapped(&even, filter, None);
            assert!(flat.pixels.iter().all(|p| (p[1] - 1.0).abs() < 1e-5), "{filter:?}, {factor}");
            let flux: f32 = untonemapped(&image, filter, None).pixels.iter().map(|p| p[1]).sum();
            assert!((flux - 1.0).abs() < 1e-5, "{filter:?}, super-sampled {factor} times: {flux}");
        }
    }
}
