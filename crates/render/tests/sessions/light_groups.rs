//! The light of groups of lights, kept apart by every mode.

use super::common::judge::assert_same;
use super::common::text::{
    basic, flat_camera, grey, medium, scattering, scene_file, settings, specular, sphere, uniform,
};
use super::common::{film, scene};
use indigo_film::{LightGroup, XyzImage, mix};
use indigo_scene::Scene;
use indigo_testkit::stats::Moments;
use indigo_transport::driver::{is_background, is_indirect};

const SIDE: u32 = 16;
const GROUPS: [&str; 3] = ["lamps", "even light", "sky"];

/// A ball of milky glass on a floor under a lamp, even light and the sun's and the sky's; those of `lights` alone.
fn yard_under(lights: &[usize], more: &str) -> Scene {
    let sources = [
        format!(
            "<rectanglelight><pos>-1 0 3</pos><width>1</width><height>1</height><spectrum>{}</spectrum></rectanglelight>",
            uniform(3e7)
        ),
        "<background_settings><background_material><material><name>b</name><diffuse><base_emission><blackbody>\
         <temperature>3000</temperature><gain>1e-9</gain></blackbody></base_emission><layer>1</layer></diffuse></material>\
         </background_material><emission_scale><measure>luminance</measure><value>3000</value></emission_scale></background_settings>"
            .to_owned(),
        "<skylight><sundir>1 -0.5 1.5</sundir><turbidity>3</turbidity><sun_layer>2</sun_layer><sky_layer>2</sky_layer></skylight>"
            .to_owned(),
    ];
    let mut parts = vec![
        settings(SIDE, more),
        flat_camera([0.0, -6.0, 2.0], [0.0, 1.0, -0.25], 0.3),
        grey("grey", 0.6),
        medium("milk", 10, &basic(1.3, &uniform(0.1), &scattering(&uniform(3.0), "<uniform/>"))),
        specular("milk", "milk"),
        sphere([0.0, 0.0, 0.7], 0.7, "milk"),
        sphere([0.0, 0.0, -30.0], 29.9, "grey"),
    ];
    parts.extend(lights.iter().map(|&light| sources[light].clone()));
    scene(&scene_file(&parts))
}

/// Under all of them.
fn yard(more: &str, layers: &str) -> Scene {
    yard_under(&[0, 1, 2], &format!("{more}{layers}"))
}

/// Settings of the layers with their gains; one of 0 is switched off.
fn layers(gains: [f64; 3]) -> String {
    let one = |(name, gain): (&str, f64)| {
        format!(
            "<layer_setting><name>{name}</name><enabled>{}</enabled><layer_scale>{}</layer_scale></layer_setting>",
            gain > 0.0,
            uniform(gain.max(0.25))
        )
    };
    GROUPS.into_iter().zip(gains).map(one).collect()
}

fn mean(image: &XyzImage) -> [f64; 3] {
    let sum = |c: usize| image.pixels.iter().map(|p| f64::from(p[c])).sum::<f64>();
    [0, 1, 2].map(|c| sum(c) / image.pixels.len() as f64)
}

const MODES: [&str; 5] = [
    "<bidirectional>false</bidirectional><metropolis>false</metropolis>",
    "<bidirectional>true</bidirectional><metropolis>false</metropolis>",
    "<bidirectional>false</bidirectional><metropolis>true</metropolis>",
    "<bidirectional>true</bidirectional><metropolis>true</metropolis>",
    "<bidirectional>true</bidirectional><hybrid>true</hybrid>",
];

/// What is traced does not depend on how it is summed: the groups together are the picture without groups, but for rounding.
#[test]
fn groups_add_up_to_the_picture() {
    for modes in MODES {
        for more in ["", "<save_layers_exr>true</save_layers_exr>"] {
            let plain = film(&yard(&format!("{modes}{more}"), ""), 5, 4);
            let scene = yard(&format!("{modes}{more}"), &layers([1.0; 3]));
            let film = film(&scene, 5, 4);
            assert_eq!(film.layers.len(), 3 * plain.layers.len(), "{modes}{more}");
            assert!((film.samples_per_pixel() - plain.samples_per_pixel()).abs() < 1e-9);
            let same = |a: XyzImage, b: XyzImage, what: &str| {
                let most = a.pixels.iter().map(|p| p[1]).fold(0.0, f32::max);
                for (a, b) in a.pixels.iter().zip(&b.pixels) {
                    for (a, b) in a.iter().zip(b) {
                        let bound = 1e-4 * (b.abs() + 1e-3 * most.max(1.0));
                        assert!((a - b).abs() < bound, "{what}, {modes}{more}: {a} and {b}");
                    }
                }
            };
            same(plain.develop(), film.develop(), "whole");
            for part in [is_indirect, is_background] {
                same(plain.develop_layers(part), film.develop_layers(part), "part");
            }
        }
    }
}

/// Each group has the light of the scene in which its lights are the only ones.
#[test]
fn a_group_is_the_light_of_its_own() {
    let alone = |group: usize| {
        let mut gains = [0.0; 3];
        gains[group] = 1.0;
        gains
    };
    let colours = |runs: Vec<[f64; 3]>| [0, 1, 2].map(|c| Moments::of(runs.iter().map(|run| run[c])));
    for modes in MODES {
        let scene = yard(modes, &layers([1.0; 3]));
        let films: Vec<_> = (0..8).map(|seed| film(&scene, 20 + seed, 64)).collect();
        for (number, name) in GROUPS.into_iter().enumerate() {
            let own = |layer: &str| mix::split(layer).1 == Some(name);
            let group = colours(films.iter().map(|film| mean(&film.develop_layers(own))).collect());
            // Without the others' lights in the scene.
            let others = yard_under(&[number], modes);
            let alone_runs = (0..8).map(|seed| mean(&film(&others, 40 + seed, 64).develop())).collect();
            for (c, (a, b)) in group.iter().zip(&colours(alone_runs)).enumerate() {
                assert_same(&format!("{name}, channel {c}, {modes}"), a, b);
            }
            // Switching the others off comes to the same.
            let switched = yard(modes, &layers(alone(number)));
            assert_eq!(switched.picture.lights.0.len(), 3);
            let switched_off = mean(&films[0].develop_mixed(&switched.picture.lights, |_| true));
            let own_light = mean(&films[0].develop_layers(own));
            for (a, b) in switched_off.iter().zip(own_light) {
                assert!((a - b).abs() < 1e-5 * b, "{name}, {modes}: {a} and {b}");
            }
        }
    }
}

/// Brightness is left to development, and colour is not.
#[test]
fn brightness_is_no_part_of_the_film() {
    let settings = |scene: &Scene| scene.identity.settings.clone();
    let scene = yard("", &layers([1.0; 3]));
    let gained = yard("", &layers([4.0, 0.5, 0.0]));
    assert_eq!(settings(&scene), settings(&gained));
    let groups = &gained.picture.lights.0;
    assert!((groups[0].gain - 4.0).abs() < 1e-6 && (groups[1].gain - 0.5).abs() < 1e-6, "{groups:?}");
    assert_eq!(groups.iter().map(|group| group.is_on).collect::<Vec<_>>(), [true, true, false]);
    let film = film(&scene, 3, 4);
    let [lamps, even] = [0, 1].map(|number: usize| {
        let own = |layer: &str| mix::split(layer).1 == Some(GROUPS[number]);
        mean(&film.develop_layers(own))
    });
    let mixed = mean(&film.develop_mixed(&gained.picture.lights, |_| true));
    for c in 0..3 {
        let expected = 4.0 * lamps[c] + 0.5 * even[c];
        assert!((mixed[c] / expected - 1.0).abs() < 1e-5, "{} instead of {expected}", mixed[c]);
    }
    // What covers the background does so whatever lights it.
    let dark = indigo_film::LightMix(
        scene.picture.lights.0.iter().map(|group| LightGroup { is_on: false, ..group.clone() }).collect(),
    );
    let covered = |image: &XyzImage| image.pixels.iter().map(|p| p[3]).collect::<Vec<_>>();
    assert_eq!(covered(&film.develop_mixed(&dark, |_| true)), covered(&film.develop()));
    let red = "<layer_setting><name>lamps</name><layer_scale><rgb><rgb>1 0.2 0.2</rgb></rgb></layer_scale></layer_setting>";
    assert_ne!(settings(&yard("", red)), settings(&yard("", &red.replace("0.2 0.2", "0.3 0.2"))));
}
