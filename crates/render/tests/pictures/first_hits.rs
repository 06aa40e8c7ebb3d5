//! What pixels show, in a scene where it can be told without rendering.

use super::common::text::{
    background, basic, diffuse, flat_camera, grey, medium, null, scene_file, settings, specular, sphere,
    uniform,
};
use super::common::{film, scene};
use indigo_film::{Filter, FirstHit};
use indigo_imaging::{Region, coverage, untonemapped};
use indigo_render::first_hits::SceneFirstHits;
use indigo_scene::Scene;
use indigo_spectrum::adaptation::rgb_of_xyz;
use std::sync::Arc;

const SIDE: usize = 32;

/// A grey ball of radius 1 whose front is 3 m before the camera, on a coloured floor 1 m below it; nothing above. An
/// unseen ball is round the camera.
fn ball_on_floor(more_settings: &str) -> Scene {
    let floor = "<rgb><rgb>0.8 0.4 0.2</rgb></rgb>";
    scene(&scene_file(&[
        settings(SIDE as u32, more_settings),
        flat_camera([0.0, -4.0, 0.0], [0.0, 1.0, 0.0], 0.5),
        null("nothing"),
        sphere([0.0, -4.0, 0.0], 0.5, "nothing"),
        grey("ball", 0.5),
        sphere([0.0, 0.0, 0.0], 1.0, "ball"),
        diffuse("floor", floor),
        "<plane><normal>0 0 1</normal><dist>-1</dist><material_name>floor</material_name></plane>".to_owned(),
        background(&uniform(1e4)),
    ]))
}

fn hits(scene: Scene) -> Vec<FirstHit> {
    SceneFirstHits::of(Arc::new(scene)).get().to_vec()
}

#[track_caller]
fn assert_near(what: &str, got: [f32; 3], expected: [f64; 3], tolerance: f64) {
    let off = got.iter().zip(expected).map(|(a, b)| (f64::from(*a) - b).abs()).fold(0.0, f64::max);
    assert!(off <= tolerance, "{what}: {got:?} instead of {expected:?}");
}

#[test]
fn pixels_show_what_the_camera_first_meets() {
    let hits = hits(ball_on_floor(""));
    let at = |x: usize, y: usize| hits[y * SIDE + x];
    let rgb = |hit: FirstHit| rgb_of_xyz(hit.albedo.map(f64::from)).map(|v| v as f32);

    let ball = at(16, 16);
    assert_near("the ball's albedo", rgb(ball), [0.5; 3], 1e-5);
    // The pixel's middle is 0.5/16 of the way from the middle of the picture to its edge, at a distance of 3 m.
    let slope = 0.5 * 0.5 / 16.0 * 3.0;
    assert_near("the ball's normal", ball.normal, [slope, -1.0, -slope], 5e-3);
    assert!((ball.depth_m - 3.0).abs() < 5e-3, "{}", ball.depth_m);

    // The lowest row sees the floor at a slope of (15.5/16)/2: 1 m below after 2/0.96875 m.
    let floor = at(16, 31);
    // An upsampled colour has its RGB back under D65; 64 wavelengths see it to some thousandths.
    assert_near("the floor's albedo", rgb(floor), [0.8, 0.4, 0.2], 1e-2);
    assert_near("the floor's normal", floor.normal, [0.0, 0.0, 1.0], 1e-6);
    assert!((floor.depth_m - 2.0 / 0.96875).abs() < 0.01, "{}", floor.depth_m);

    assert_eq!(at(16, 0), FirstHit::NOTHING);
    assert_eq!((ball.coverage, floor.coverage), (1.0, 1.0));
    assert!(ball.object != 0 && floor.object != 0 && ball.object != floor.object);
    assert!(ball.material != 0 && floor.material != 0 && ball.material != floor.material);
    // A line across the ball's edge: coverage takes part in the means, and numbers change from one to the other.
    let row: Vec<FirstHit> = (0..SIDE).map(|x| at(x, 12)).collect();
    assert!(row.iter().all(|hit| [0, ball.object].contains(&hit.object)));
    assert!(row.iter().any(|hit| (0.01..0.49).contains(&hit.albedo[1])), "no edge is smooth");
    // The ball has an albedo of a half: coverage goes with it, whichever wavelengths hit.
    for hit in row {
        assert!((0.5 * hit.coverage - hit.albedo[1]).abs() < 1e-4, "{hit:?}");
    }
}

/// Coverage has the filters of the light that it goes with, also where they are negative, and up to the borders of a region:
/// it is what many samples of the film tell. A mean by area would be off by 0.1 beside edges.
#[test]
fn coverage_goes_with_the_light() {
    const CUBIC: &str = "<mn_cubic><blur>0.2</blur><ring>0.6</ring></mn_cubic>";
    let filters = format!("<splat_filter>{CUBIC}</splat_filter><downsize_filter>{CUBIC}</downsize_filter>");
    let region = "<render_region><x1>5</x1><y1>3</y1><x2>20</x2><y2>13</y2></render_region>";
    for (factor, region) in [(1, ""), (2, region), (3, region)] {
        let factor = format!("<super_sample_factor>{factor}</super_sample_factor>");
        let scene = ball_on_floor(&format!("<max_depth>0</max_depth>{factor}{filters}{region}"));
        let filter = Filter::MitchellNetravali { blur: 0.2, ring: 0.6 };
        let region = scene.film.region.map(|[x, y]| {
            Region::new([x[0], y[0]], [x[1], y[1]], scene.film.size).expect("a region of the picture")
        });
        let samples = untonemapped(&film(&scene, 3, 1024).develop(), filter, region);
        let size = scene.film.size;
        let found = SceneFirstHits::of(Arc::new(scene));
        let covered = coverage(size, found.weights(), filter, region);
        let (mut squares, mut edges, mut by_area) = (0.0, 0, 0.0);
        for ((pixel, covered), hit) in samples.pixels.iter().zip(covered).zip(found.get()) {
            // Weights of either sign leave some noise in samples, and none in what has no edge near.
            if (pixel[3] - pixel[3].round()).abs() > 0.03 {
                edges += 1;
                squares += (pixel[3] - covered).powi(2);
                by_area += (pixel[3] - hit.coverage).powi(2);
            } else {
                assert!((pixel[3] - covered).abs() < 0.05, "{pixel:?} {covered}");
            }
        }
        let [off, by_area] = [squares, by_area].map(|s| (s / edges as f32).sqrt());
        assert!(edges >= 10 && off < 0.03 && by_area > 2.0 * off, "{factor}: {edges} {off} {by_area}");
    }
}

/// What refraction does to radiance is no reflectance: glass is white, whichever way the light goes on.
#[test]
fn glass_has_the_albedo_of_white() {
    let scene = scene(&scene_file(&[
        settings(8, ""),
        flat_camera([0.0, -4.0, 0.0], [0.0, 1.0, 0.0], 0.1),
        medium("glass", 10, &basic(1.5, &uniform(0.0), &uniform(0.0))),
        specular("pane", "glass"),
        sphere([0.0, 0.0, 0.0], 1.0, "pane"),
        background(&uniform(1e4)),
    ]));
    for hit in hits(scene) {
        let rgb = rgb_of_xyz(hit.albedo.map(f64::from)).map(|v| v as f32);
        assert_near("glass", rgb, [1.0; 3], 1e-4);
    }
}

#[test]
fn beyond_the_region_there_is_nothing() {
    let whole = hits(ball_on_floor(""));
    let region = "<render_region><x1>10</x1><y1>12</y1><x2>20</x2><y2>32</y2></render_region>";
    for (i, (part, all)) in hits(ball_on_floor(region)).iter().zip(&whole).enumerate() {
        let inside = (10..20).contains(&(i % SIDE)) && i / SIDE >= 12;
        assert_eq!(*part, if inside { *all } else { FirstHit::NOTHING });
    }
}
