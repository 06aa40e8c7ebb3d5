//! What surfaces do to light: visibility, sides, and where their colour comes from.

use super::common::judge::{NITS_PER_UNIFORM, assert_is, assert_near, assert_same};
use super::common::shapes::{Mesh, mesh_light, model};
use super::common::text::{background, diffuse, flat_camera, grey, null, scene_file, settings, uniform};
use super::common::{Measured, measure, scene, scene_with};
use indigo_imaging::{LinearImage, Metadata, exr};
use indigo_spectrum::Spectrum;
use std::f64::consts::PI;

const RADIANCE: f64 = 1.0e5;

fn sphere(center: &str, radius: f64, material: &str) -> String {
    format!(
        "<sphere><center>{center}</center><radius>{radius}</radius><material_name>{material}</material_name></sphere>"
    )
}

/// A floor under a rectangle and a dim sky; `more` stands in the way.
fn floor_and_lamp(more: &str) -> Measured {
    let lamp = format!(
        "<rectanglelight><pos>0 0 2</pos><width>0.5</width><height>0.5</height><spectrum>{}</spectrum></rectanglelight>",
        uniform(RADIANCE)
    );
    let text = scene_file(&[
        settings(8, ""),
        flat_camera([2.0, 1.0, 1.5], [-2.0, -1.0, -1.5], 0.1),
        grey("floor", 0.6),
        Mesh::square(3.0, 0.0).text("ground", "floor"),
        model("ground"),
        lamp,
        background(&uniform(0.01 * RADIANCE)),
        more.to_owned(),
    ]);
    measure(&scene(&text), 16, 64)
}

#[test]
fn what_is_made_of_nothing_changes_nothing() {
    let free = floor_and_lamp("");
    // One sphere between floor and lamp, one round the camera, one round everything, and a mesh.
    let invisible = [
        null("nothing"),
        sphere("0 0 1", 0.4, "nothing"),
        sphere("2 1 1.5", 0.2, "nothing"),
        sphere("0 0 0", 30.0, "nothing"),
        Mesh::square(1.0, 1.3).text("pane", "nothing"),
        model("pane"),
    ];
    let behind = floor_and_lamp(&invisible.concat());
    for (what, a, b) in [("X", 0, 0), ("Y", 1, 1), ("Z", 2, 2), ("alpha", 3, 3)] {
        assert_same(what, &free.xyza[a], &behind.xyza[b]);
    }
    // A sphere that is something in the same place is seen to make a difference.
    let shadow = floor_and_lamp(&(grey("thing", 0.0) + &sphere("0 0 1", 0.4, "thing")));
    assert!(shadow.luminance().mean() < 0.8 * free.luminance().mean());
}

#[test]
fn light_goes_through_many_invisible_layers() {
    let layers: String = (1..40).map(|i| sphere("0 0 0", 0.05 * f64::from(i), "nothing")).collect();
    let free = floor_and_lamp("");
    assert_same("Y", free.luminance(), floor_and_lamp(&(null("nothing") + &layers)).luminance());
}

#[test]
fn the_surroundings_shine_through_an_invisible_sphere() {
    let text = scene_file(&[
        settings(8, ""),
        flat_camera([0.0; 3], [0.0, 1.0, 0.0], 0.1),
        null("nothing"),
        sphere("0 4 0", 1.0, "nothing"),
        background(&uniform(RADIANCE)),
    ]);
    let measured = measure(&scene(&text), 8, 64);
    assert_is("Y", measured.luminance(), RADIANCE * NITS_PER_UNIFORM, 1e-3);
    assert_eq!(measured.xyza[3].mean(), 0.0, "nothing is in the foreground");
}

/// A lamp of no material shines, and lets the light of what stands behind it through.
#[test]
fn an_invisible_lamp_adds_its_light_to_what_is_behind() {
    let pane = Mesh::square(1.0, 0.0).placed([1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, -1.0, 0.0], 1.0, [0.0; 3]);
    for (direction, lamp) in [(1.0, 0.0), (-1.0, 1.0)] {
        let text = scene_file(&[
            settings(8, ""),
            flat_camera([0.0, -3.0 * direction, 0.0], [0.0, direction, 0.0], 0.1),
            null("nothing"),
            pane.text("pane", "nothing"),
            mesh_light("pane", &uniform(2.0 * RADIANCE), [0.0; 3], 1.0, ""),
            background(&uniform(RADIANCE)),
        ]);
        let expected = RADIANCE * NITS_PER_UNIFORM * (1.0 + 2.0 * lamp);
        assert_is(
            &format!("seen along {direction}"),
            measure(&scene(&text), 8, 64).luminance(),
            expected,
            1e-3,
        );
    }
}

/// Its front shines and does not show the other side; its back scatters and does not shine.
#[test]
fn a_lamp_shines_from_its_front_alone() {
    let pane = Mesh::square(1.0, 0.0);
    for (height, expected) in [(2.0, 2.0 + 0.3), (-2.0, 0.3)] {
        let text = scene_file(&[
            settings(8, ""),
            flat_camera([0.0, 0.0, height], [0.0, 0.0, -height], 0.1),
            grey("paper", 0.3),
            pane.text("pane", "paper"),
            mesh_light("pane", &uniform(2.0 * RADIANCE), [0.0; 3], 1.0, ""),
            background(&uniform(RADIANCE)),
        ]);
        let measured = measure(&scene(&text), 16, 64);
        assert_is(
            &format!("from {height}"),
            measured.luminance(),
            RADIANCE * NITS_PER_UNIFORM * expected,
            1e-3,
        );
    }
}

#[test]
fn a_sheet_scatters_on_both_sides() {
    for height in [2.0, -2.0] {
        let text = scene_file(&[
            settings(8, ""),
            flat_camera([0.3, 0.2, height], [-0.3, -0.2, -height], 0.05),
            grey("paper", 0.7),
            Mesh::square(1.0, 0.0).text("sheet", "paper"),
            model("sheet"),
            background(&uniform(RADIANCE)),
        ]);
        let measured = measure(&scene(&text), 16, 64);
        assert_is(&format!("from {height}"), measured.luminance(), 0.7 * RADIANCE * NITS_PER_UNIFORM, 1e-3);
    }
}

/// A band of reflected wavelengths in light of all: X, Y and Z are those of the band.
#[test]
fn a_reflectance_acts_on_each_wavelength() {
    let band = "<peak><peak_min>560</peak_min><peak_width>40</peak_width><base_value>0.1</base_value><peak_value>0.9</peak_value></peak>";
    let text = scene_file(&[
        settings(8, ""),
        flat_camera([0.0; 3], [0.0, 1.0, 0.0], 0.1),
        diffuse("yellow", band),
        sphere("0 4 0", 1.0, "yellow"),
        background(&uniform(RADIANCE)),
    ]);
    let measured = measure(&scene(&text), 16, 512);
    let expected = Spectrum::peak(560.0, 40.0, 0.1 * RADIANCE, 0.9 * RADIANCE).xyz();
    for (what, (m, e)) in ["X", "Y", "Z"].iter().zip(measured.xyza.iter().zip(expected)) {
        assert_is(what, m, e, 2e-3);
    }
}

/// Four texels on a square: each shows its own albedo, v = 0 is the bottom, and u runs to the right.
/// A texel stands at u = column / width, and values between texels are mixed: so a spot is looked at.
#[test]
fn a_texture_gives_each_place_its_albedo() {
    let albedo = [[0.1, 0.3], [0.5, 0.8]];
    let pixels = albedo.iter().flatten().map(|&v| [v as f32, v as f32, v as f32, 1.0]).collect();
    let image =
        exr::encode(&LinearImage { width: 2, height: 2, pixels }, &Metadata::default()).expect("a picture");
    for (row, column) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
        let at = [f64::from(column) - 0.5, 0.5 - f64::from(row)];
        let text = scene_file(&[
            settings(4, ""),
            flat_camera([at[0], at[1], 2.0], [0.0, 0.0, -1.0], 5e-5),
            "<material><name>painted</name><diffuse><albedo_texture><uv_set>albedo</uv_set><path>four.exr</path>\
             <exponent>1</exponent></albedo_texture></diffuse></material>"
                .to_owned(),
            "<mesh><name>sheet</name><embedded><expose_uv_set><index>0</index><name>albedo</name></expose_uv_set>\
             <vertex pos=\"-1 -1 0\" uv0=\"-0.25 -0.25\"/><vertex pos=\"1 -1 0\" uv0=\"0.75 -0.25\"/><vertex pos=\"1 1 0\" uv0=\"0.75 0.75\"/>\
             <vertex pos=\"-1 1 0\" uv0=\"-0.25 0.75\"/><triangle_set><material_name>painted</material_name><tri>0 1 2</tri>\
             <tri>0 2 3</tri></triangle_set></embedded></mesh>"
                .to_owned(),
            model("sheet"),
            background(&uniform(RADIANCE)),
        ]);
        let measured = measure(&scene_with(&text, [("four.exr", image.clone())]), 16, 128);
        let expected = albedo[row as usize][column as usize] * RADIANCE * NITS_PER_UNIFORM;
        // The table of reflectances for textures returns a grey to a few parts in 10,000.
        assert_near(&format!("texel {row}, {column}"), measured.luminance(), expected, 2e-3);
    }
}

/// A small sphere in the middle of a floor's light is a shadow of exactly its solid angle.
#[test]
fn a_black_sphere_hides_the_sky_behind_it() {
    let text = scene_file(&[
        settings(8, ""),
        flat_camera([3.0, 0.0, 0.5], [-3.0, 0.0, -0.5], 2e-3),
        grey("floor", 0.5),
        grey("black", 0.0),
        "<plane><normal>0 0 1</normal><dist>0</dist><material_name>floor</material_name></plane>".to_owned(),
        sphere("0 0 2", 0.8, "black"),
        background(&uniform(RADIANCE)),
    ]);
    // Irradiance from a sphere fully above the horizon: π (R/d)² cos.
    let irradiance = PI * (1.0 - 0.8 * 0.8 / 4.0);
    let expected = 0.5 * irradiance / PI * RADIANCE * NITS_PER_UNIFORM;
    assert_is("floor", measure(&scene(&text), 24, 128).luminance(), expected, 2e-3);
}
