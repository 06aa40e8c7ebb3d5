//! White balance and tone mapping against numbers worked out by hand, or taken from published
//! tables.

use indigo_film::{FilmSize, FilmState, LayerKind};
use indigo_imaging::{Exposure, PictureSettings, Response, ToneMapping, WhiteBalance, develop};

/// π · (r/d)² · t = 2 with these.
const EXPOSURE: Exposure = Exposure {
    aperture_area: 1e-4 * std::f64::consts::PI,
    lens_sensor_dist: 0.02,
    duration: 8.0 / std::f64::consts::PI,
};

fn settings(tone_mapping: ToneMapping) -> PictureSettings {
    PictureSettings::plain(tone_mapping, EXPOSURE)
}

/// A film one pixel high that holds these colours.
fn film(chart: &[[f64; 3]]) -> FilmState {
    let size = FilmSize::new(chart.len() as u32, 1, 1).unwrap();
    let mut film = FilmState::new(size, &[(LayerKind::PerPixel, "camera")]);
    for (i, &[x, y, z]) in chart.iter().enumerate() {
        film.layers[0].sums[i] = [2.0 * x, 2.0 * y, 2.0 * z, 2.0];
        film.layers[0].counts[i] = 2.0;
    }
    film
}

/// XYZ of luminance 1 and that chromaticity.
fn xyz([x, y]: [f64; 2]) -> [f64; 3] {
    [x / y, 1.0, (1.0 - x - y) / y]
}

fn shown(chart: &[[f64; 3]], settings: &PictureSettings) -> Vec<[f32; 3]> {
    develop(&film(chart), settings).pixels.iter().map(|p| [p[0], p[1], p[2]]).collect()
}

fn assert_near(got: [f32; 3], want: [f64; 3], tolerance: f64) {
    for (g, w) in got.into_iter().zip(want) {
        assert!((f64::from(g) - w).abs() <= tolerance, "{got:?} instead of {want:?}");
    }
}

/// However much light is let in, grey ends as white, and never as what infinities leave of each other.
#[test]
fn more_light_than_numbers_hold_is_white() {
    let chart = [[0.9504559271, 1.0, 1.0890577508], [0.0; 3]];
    for ev_adjust in [130.0, 200.0, 1e38] {
        let response = std::sync::Arc::new(Response::display());
        let camera = ToneMapping::Camera { response, ev_adjust, film_iso: 100.0 };
        assert_eq!(shown(&chart, &settings(camera))[0], [1.0; 3], "{ev_adjust}");
    }
    assert_eq!(shown(&chart, &settings(ToneMapping::Linear { scale: 1e39 }))[0], [1.0; 3]);
}

#[test]
fn linear_is_scale_times_exposure() {
    assert!((EXPOSURE.lux_seconds_per_nit() - 2.0).abs() < 1e-12);
    // The primaries' XYZ are the columns of the published matrix from Rec. 709 to XYZ.
    let chart = [
        [0.4123907993, 0.2126390059, 0.0193308187],
        [0.3575843394, 0.7151686788, 0.1191947798],
        [0.1804807884, 0.0721923154, 0.9505321522],
        [0.9504559271, 1.0, 1.0890577508],
        [0.0, 0.0, 0.0],
        [9.504559271, 10.0, 10.890577508],
    ];
    let got = shown(&chart, &settings(ToneMapping::Linear { scale: 0.25 }));
    let want = [[0.5, 0.0, 0.0], [0.0, 0.5, 0.0], [0.0, 0.0, 0.5], [0.5; 3], [0.0; 3], [1.0; 3]];
    for (got, want) in got.into_iter().zip(want) {
        assert_near(got, want, 1e-6);
    }
}

/// The brightest pixel has its own luminance as white: L_m (1 + L_m/w²)/(1 + L_m).
#[test]
fn reinhard_compresses_luminance() {
    // Greys of luminance 1, 4 and 16, and black, which has no part in the log average: it is 4.
    // With pre_scale 2: L_m = 0.5, 2, 8; w = min(burn, 8).
    let white = xyz([0.3127, 0.3290]);
    let chart = [1.0, 4.0, 16.0, 0.0].map(|l| white.map(|v| v * l));
    let reinhard = |burn| settings(ToneMapping::Reinhard { pre_scale: 2.0, post_scale: 0.5, burn });
    // w = 8: 0.5 · 0.5 (1 + 0.5/64)/1.5 = 0.16796875, 0.5 · 2 (1 + 2/64)/3 = 0.34375, 0.5, 0.
    for (got, want) in shown(&chart, &reinhard(10.0)).into_iter().zip([0.16796875, 0.34375, 0.5, 0.0]) {
        assert_near(got, [want; 3], 1e-6);
    }
    // w = 4: 0.171875, 0.375, 0.5 · 8 (1 + 8/16)/9 = 2/3.
    for (got, want) in shown(&chart, &reinhard(4.0)).into_iter().zip([0.171875, 0.375, 2.0 / 3.0, 0.0]) {
        assert_near(got, [want; 3], 1e-6);
    }
}

#[test]
fn reinhard_keeps_hue_and_ignores_exposure() {
    let red = [0.4123907993, 0.2126390059, 0.0193308187];
    let chart = [xyz([0.3127, 0.3290]), [0, 1, 2].map(|i| 0.5 * xyz([0.3127, 0.3290])[i] + red[i])];
    let mut settings = settings(ToneMapping::Reinhard { pre_scale: 1.0, post_scale: 0.3, burn: 10.0 });
    let got = shown(&chart, &settings);
    // Linear RGB of the second is (1.5, 0.5, 0.5).
    assert!((got[1][0] / got[1][1] - 3.0).abs() < 1e-4 && (got[1][1] / got[1][2] - 1.0).abs() < 1e-5);
    settings.exposure.duration *= 100.0;
    assert_eq!(shown(&chart, &settings), got);
}

#[test]
fn a_black_film_is_a_black_picture() {
    for tone_mapping in [
        ToneMapping::Linear { scale: 1.0 },
        ToneMapping::Reinhard { pre_scale: 1.0, post_scale: 1.0, burn: 10.0 },
        ToneMapping::Reinhard { pre_scale: 0.0, post_scale: 1.0, burn: 10.0 },
    ] {
        assert_eq!(shown(&[[0.0; 3]; 3], &settings(tone_mapping)), [[0.0; 3]; 3]);
    }
    // Nothing is left of a lit film scaled by 0, either.
    let nothing = settings(ToneMapping::Reinhard { pre_scale: 0.0, post_scale: 1.0, burn: 10.0 });
    assert_eq!(shown(&[[1.0; 3]; 2], &nothing), [[0.0; 3]; 2]);
}

/// Published 2-degree white points.
const WHITES: [[f64; 2]; 7] = [
    [0.44757, 0.40745],
    [0.34567, 0.35850],
    [0.33242, 0.34743],
    [0.31271, 0.32902],
    [0.29902, 0.31485],
    [0.3333333, 0.3333333],
    [0.43695, 0.40441],
];

#[test]
fn a_white_under_its_own_balance_is_grey() {
    for white in WHITES {
        for tone_mapping in [
            ToneMapping::Linear { scale: 0.2 },
            ToneMapping::Reinhard { pre_scale: 1.0, post_scale: 0.7, burn: 4.0 },
        ] {
            let mut settings = settings(tone_mapping);
            settings.white_balance = WhiteBalance::from_white(white).unwrap();
            let chart = [0.1, 1.0, 2.0].map(|l| xyz(white).map(|v| v * l));
            for [r, g, b] in shown(&chart, &settings) {
                assert!((r / g - 1.0).abs() < 5e-6 && (b / g - 1.0).abs() < 5e-6, "{white:?}: {r} {g} {b}");
            }
        }
    }
}

/// The manual's statement: a 5000 K blackbody looks near neutral under D50 and orange under D65.
#[test]
fn a_5000_kelvin_blackbody() {
    let chart = [xyz([0.34510, 0.35161])];
    let mut settings = settings(ToneMapping::Linear { scale: 0.25 });
    assert_near(shown(&chart, &settings)[0], [1.213 / 2.0, 0.960 / 2.0, 0.762 / 2.0], 5e-4);
    settings.white_balance = WhiteBalance::from_white([0.34567, 0.35850]).unwrap();
    assert_near(shown(&chart, &settings)[0], [1.036 / 2.0, 0.984 / 2.0, 1.054 / 2.0], 5e-4);
}

#[test]
fn impossible_whites_are_refused() {
    for white in [[0.3, 0.0], [0.0, 0.3], [-0.1, 0.4], [0.8, 0.4], [f64::NAN, 0.3]] {
        assert!(WhiteBalance::from_white(white).is_err(), "{white:?}");
    }
}
