//! Direct and indirect light, kept apart by every mode.

use super::common::judge::{NITS_PER_UNIFORM, assert_agrees, assert_same};
use super::common::shapes::{Mesh, mesh_light};
use super::common::text::{
    ONE_PIXEL, camera, flat_camera, grey, null, scene_file, settings, sphere, uniform,
};
use super::common::{film, scene};
use indigo_film::XyzImage;
use indigo_scene::Scene;
use indigo_testkit::stats::Moments;
use indigo_transport::driver::{is_background, is_indirect};

const SIDE: u32 = 24;

/// Inside of a grey ball with a lamp: most light is scattered more than once.
fn cave(more: &str) -> Scene {
    scene(&scene_file(&[
        settings(SIDE, more),
        flat_camera([0.0, -2.0, 0.0], [0.0, 1.0, 0.0], 0.5),
        grey("grey", 0.6),
        sphere([0.0, 0.0, 0.0], 4.0, "grey"),
        format!(
            "<rectanglelight><pos>0 0 2</pos><width>1</width><height>1</height><spectrum>{}</spectrum></rectanglelight>",
            uniform(1e5)
        ),
    ]))
}

fn luminance(image: &XyzImage) -> f64 {
    image.pixels.iter().map(|p| f64::from(p[1])).sum::<f64>() / image.pixels.len() as f64
}

/// Mean luminances of the whole, of direct, and of indirect light, and that of coverage.
fn measured(scene: &Scene) -> [Moments; 4] {
    let runs: Vec<[f64; 4]> = (0..8)
        .map(|seed| {
            let film = film(scene, seed, 64);
            let whole = film.develop();
            assert!((film.samples_per_pixel() - 64.0).abs() < 5.0, "{}", film.samples_per_pixel());
            [
                luminance(&whole),
                luminance(&film.develop_layers(|layer| !is_indirect(layer))),
                luminance(&film.develop_layers(is_indirect)),
                whole.pixels.iter().map(|p| f64::from(p[3])).sum::<f64>() / f64::from(SIDE * SIDE),
            ]
        })
        .collect();
    [0, 1, 2, 3].map(|i| Moments::of(runs.iter().map(|run| run[i])))
}

#[test]
fn direct_and_indirect_light_are_told_apart_in_every_mode() {
    let depth = |n: u32| format!("<max_depth>{n}</max_depth>");
    let [whole, ..] = measured(&cave(&depth(3)));
    let [once, _, nothing, _] = measured(&cave(&depth(1)));
    assert_eq!(nothing.mean(), 0.0, "without layers nothing is kept apart");
    assert!(whole.mean() > 1.5 * once.mean(), "the scene is to have indirect light");
    for (bidirectional, metropolis, hybrid) in [
        (false, false, false),
        (true, false, false),
        (false, true, false),
        (true, true, false),
        (true, true, true),
    ] {
        let modes = format!(
            "<bidirectional>{bidirectional}</bidirectional><metropolis>{metropolis}</metropolis><hybrid>{hybrid}</hybrid>"
        );
        let scene = cave(&format!("{}{modes}<save_layers_exr>true</save_layers_exr>", depth(3)));
        let [all, direct, indirect, coverage] = measured(&scene);
        assert_same(&format!("all, {modes}"), &all, &whole);
        assert_same(&format!("direct, {modes}"), &direct, &once);
        let sum = direct.mean() + indirect.mean();
        // Single precision of each pixel.
        assert!((sum / all.mean() - 1.0).abs() < 1e-6, "{modes}: {sum} instead of {}", all.mean());
        if !metropolis {
            assert_eq!(coverage.mean(), 1.0, "{modes}");
        }
    }
}

/// The sun, out of focus, so that light paths find it as well as camera rays do: all of it is background.
#[test]
fn surroundings_that_light_paths_find_are_background() {
    let sun = |modes: &str| {
        let camera = camera(
            [0.0; 3],
            [0.0, 4.0, 3.0],
            0.1,
            "<aperture_radius>0.02</aperture_radius><focus_distance>1</focus_distance>",
        );
        let sky = "<skylight><sundir>0 4 3</sundir><turbidity>2</turbidity></skylight>".to_owned();
        let ball = sphere([0.3, 3.0, 2.25], 0.05, "grey");
        let modes =
            format!("<bidirectional>true</bidirectional><save_layers_exr>true</save_layers_exr>{modes}");
        scene(&scene_file(&[settings(SIDE, &modes), camera, grey("grey", 0.5), sky, ball]))
    };
    for modes in ["", "<metropolis>true</metropolis>"] {
        let film = film(&sun(modes), 1, 16);
        let background = luminance(&film.develop_layers(is_background));
        // What the ball sends back of it, beside light from a sun in the picture.
        let rest = luminance(&film.develop_layers(|layer| !is_background(layer)));
        assert!(background > 1e3 * rest, "{modes}: {background} {rest}");
        let splats = film.develop_layers(|layer| is_background(layer) && layer != "camera background");
        assert!(luminance(&splats) > 0.1 * background, "{modes}: light paths find the sun");
    }
}

/// A lamp that is not to be seen, over a third of an even sky: what it sends is its own light and no background, whatever comes
/// through from behind; groups of lights make no difference.
#[test]
fn what_unseen_surfaces_send_is_not_background() {
    let [sky, lamp] = [1e4, 3e4];
    let square = Mesh::square(0.3, 0.0).text("square", "air");
    let shining = mesh_light("square", &uniform(lamp), [0.0; 3], 1.0, "");
    let even = format!(
        "<background_settings><background_material><material><name>sky</name><diffuse><base_emission>{}</base_emission>\
         <layer>1</layer></diffuse></material></background_material></background_settings>",
        uniform(sky)
    );
    for modes in [
        "",
        "<bidirectional>true</bidirectional>",
        "<metropolis>true</metropolis>",
        "<bidirectional>true</bidirectional><metropolis>true</metropolis>",
        "<bidirectional>true</bidirectional><hybrid>true</hybrid>",
    ] {
        for layers in ["", "<layer_setting/><layer_setting/>"] {
            let more = format!("{ONE_PIXEL}<save_layers_exr>true</save_layers_exr>{modes}{layers}");
            let scene = scene(&scene_file(&[
                settings(SIDE, &more),
                // Half a metre is seen on each side.
                flat_camera([0.0, 0.0, 5.0], [0.0, 0.0, -1.0], 0.1),
                null("air"),
                square.clone(),
                shining.clone(),
                even.clone(),
            ]));
            let films: Vec<_> = (0..8).map(|seed| film(&scene, seed, 64)).collect();
            let mean = |part: fn(&str) -> bool| {
                Moments::of(films.iter().map(|film| luminance(&film.develop_layers(part))))
            };
            let what = format!("{modes}{layers}");
            assert_agrees(&format!("background, {what}"), &mean(is_background), sky * NITS_PER_UNIFORM);
            let share = (0.3_f64 / 0.5).powi(2);
            let rest = mean(|layer| !is_background(layer));
            assert_agrees(&format!("the rest, {what}"), &rest, share * lamp * NITS_PER_UNIFORM);
        }
    }
}
