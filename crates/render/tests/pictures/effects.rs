//! Every element of materials, textures and media changes the picture in the direction that it is said to.
//!
//! Means are compared with margins that are many of their standard errors.

use super::common::judge::{NITS_PER_UNIFORM, assert_near};
use super::common::shapes::{Mesh, model};
use super::common::text::{
    background, basic, flat_camera, grey, henyey_greenstein, medium, scattering, scene_file, settings,
    specular, uniform,
};
use super::common::{Measured, measure, scene, scene_with};
use super::materials::{RADIANCE, point, row, sheet_with};
use indigo_imaging::{LinearImage, Metadata, exr};
use indigo_math::{Real, Vec3};
use indigo_scatter::{Interface, Mode};
use indigo_scene::Scene;
use std::f64::consts::PI;

/// A sheet in even light shows just its albedo.
#[test]
fn albedos_are_what_their_elements_say() {
    let spectrum = |v: f64| format!("<albedo_spectrum>{}</albedo_spectrum>", uniform(v));
    let texture = |more: &str| format!("<albedo_texture><path>half.exr</path>{more}</albedo_texture>");
    let linear = |more: &str| texture(&format!("<exponent>1</exponent>{more}"));
    let colour = "<colour>0.5 0.5 0.5</colour>".to_owned();
    let kinds: [(&str, &str); 3] =
        [("diffuse", ""), ("diffuse_transmitter", ""), ("oren_nayar", "<sigma>0</sigma>")];
    for (kind, more) in kinds {
        let mut rows = vec![
            ("albedo_spectrum", spectrum(0.3), 0.3),
            ("a higher one", spectrum(0.6), 0.6),
            ("more than all", spectrum(3.0), 1.0),
            ("a map", linear(""), 0.5),
            ("a map before a spectrum", spectrum(0.9) + &linear(""), 0.5),
            ("the exponent", texture("<exponent>2</exponent>"), 0.25),
            ("the exponent by default", texture(""), 0.5f64.powf(2.2)),
            ("a", linear("<a>1</a><b>0</b>"), 0.25),
            ("b", linear("<b>0.4</b>"), 0.2),
            ("c", linear("<c>0.1</c>"), 0.6),
            ("all three", linear("<a>0.4</a><b>0.2</b><c>0.1</c>"), 0.3),
        ];
        if kind != "oren_nayar" {
            rows.push(("colour", colour.clone(), 0.5f64.powf(2.2)));
            rows.push(("a bright colour", "<colour>1 1 1</colour>".to_owned(), 0.9));
            rows.push(("a spectrum before a colour", spectrum(0.3) + &colour, 0.3));
        }
        for (what, content, expected) in rows {
            let scene = sheet_with(&format!("<{kind}>{more}{content}</{kind}>"), 30.0, "", "");
            let measured = measure(&scene, 16, 96);
            let expected = expected * RADIANCE * NITS_PER_UNIFORM;
            assert_near(&format!("{kind}, {what}"), measured.luminance(), expected, 4e-3);
        }
    }
}

/// A sheet of a kind of material whose mesh exposes two sets of coordinates: `default` lies in the left half of the
/// map `two.exr`, which is 0.2 there, and `other` in the right half, 0.7. Along x, `default` spans 0.2 of the map and
/// `other` 0.3. `slope.exr` is flat in its left half and rises from 0 to 1 in the right one.
fn sheet_of_two_sets(kind: &str, others: &str) -> Scene {
    let vertex = |x: f64, y: f64| {
        let (a, b) = (0.2 + 0.1 * x, 0.75 + 0.15 * x);
        format!("<vertex pos=\"{x} {y} 0\" uv0=\"{a} {y}\" uv1=\"{b} {y}\"/>")
    };
    let vertices: String =
        [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(x, y)| vertex(x, y)).concat();
    let expose =
        |i: u32, name: &str| format!("<expose_uv_set><index>{i}</index><name>{name}</name></expose_uv_set>");
    let text = scene_file(&[
        settings(4, ""),
        flat_camera([0.0, 0.0, 5.0], [0.0, 0.0, -1.0], 1e-3),
        format!("<material><name>m</name>{kind}</material>"),
        format!(
            "<mesh><name>sheet</name><embedded>{}{}{vertices}<triangle_set><material_name>m</material_name>\
             <tri>0 1 2</tri><tri>0 2 3</tri></triangle_set></embedded></mesh>",
            expose(0, "default"),
            expose(1, "other")
        ),
        model("sheet"),
        others.to_owned(),
    ]);
    let two: Vec<f32> = (0..16).map(|i| if i < 8 { 0.2 } else { 0.7 }).collect();
    let slope: Vec<f32> = (0..64).map(|i| (i as f32 - 31.5).max(0.0) / 32.0).collect();
    scene_with(&text, [("two.exr", row(&two)), ("slope.exr", row(&slope))])
}

/// `uv_set` chooses among the coordinates that a mesh exposes, wherever a map is used.
#[test]
fn every_map_is_looked_up_by_its_uv_set() {
    let light = background(&uniform(RADIANCE));
    for (set, value) in [("", 0.2), ("<uv_set>default</uv_set>", 0.2), ("<uv_set>other</uv_set>", 0.7)] {
        let map = |name: &str, more: &str| {
            format!("<{name}>{set}<path>two.exr</path><exponent>1</exponent>{more}</{name}>")
        };
        let albedo = format!("<diffuse>{}</diffuse>", map("albedo_texture", ""));
        let blend =
            format!("<blend>{}<a_name>dark</a_name><b_name>light</b_name></blend>", map("blend_map", ""));
        let parts = light.clone() + &grey("dark", 0.1) + &grey("light", 0.9);
        for (what, kind, others, expected) in
            [("albedo", albedo, &light, value), ("blend", blend, &parts, 0.1 + 0.8 * value)]
        {
            let measured = measure(&sheet_of_two_sets(&kind, others), 16, 384);
            let expected = expected * RADIANCE * NITS_PER_UNIFORM;
            assert_near(&format!("{what} {set}"), measured.luminance(), expected, 4e-3);
        }
        // The peak of the lobe along the normal is (n + 2) / 2π high, and shows by the coat's 0.04 over 4.
        let gloss = format!("<phong><ior>1.5</ior>{}</phong>", map("exponent_map", "<b>100</b>"));
        let along = point(&sheet_of_two_sets(&gloss, &light), 0.0, 550.0, Interface::NONE)
            .eval(Vec3::new(0.0, 0.0, 1.0), Mode::Radiance);
        let expected = 0.01 * (100.0 * value + 2.0) / std::f64::consts::TAU;
        assert!((along.f_cos.hero() as f64 / expected - 1.0).abs() < 1e-3, "exponent {set}: {along:?}");
    }
}

/// Both the map's gradient and the way that the coordinates lie on the surface are those of the map's set.
#[test]
fn a_bump_map_is_looked_up_by_its_uv_set() {
    let lit = |set: &str| {
        let bump = format!("<bump_map>{set}<path>slope.exr</path><exponent>1</exponent></bump_map>");
        let kind = format!("<diffuse><albedo_spectrum>{}</albedo_spectrum>{bump}</diffuse>", uniform(0.5));
        // From x = -16, z = 12: along (-0.8, 0, 0.6).
        let lamp = format!(
            "<rectanglelight><pos>-16 0 12</pos><width>0.2</width><height>0.2</height><spectrum>{}</spectrum></rectanglelight>",
            uniform(1e7)
        );
        measure(&sheet_of_two_sets(&kind, &lamp), 16, 64)
    };
    let flat = lit("");
    // Up by 2 over the map, of which 0.3 lie on two metres.
    let slope = 0.3;
    // The light's angle from the flat sheet, and by how much the slope leans towards it: n · l, and what such a sheet
    // scatters below the flat one, spread over what is above it.
    let (light, lean) = (f64::asin(0.6), f64::atan(slope));
    let spread = lean / PI * f64::sin(lean - light * lean / PI);
    let expected = flat.luminance().mean() * (f64::sin(light + lean) + spread) / 0.6;
    assert_near("a slope of 0.3", lit("<uv_set>other</uv_set>").luminance(), expected, 2e-3);
}

/// Red, green and blue of a texel and of a `colour` are those of the `rgb` spectrum of the same values.
#[test]
fn colours_keep_the_order_of_their_channels() {
    let shown = |content: &str| {
        let text = scene_file(&[
            settings(4, ""),
            flat_camera([0.0, 0.0, 5.0], [0.0, 0.0, -1.0], 1e-3),
            format!("<material><name>m</name><diffuse>{content}</diffuse></material>"),
            super::common::text::sphere([0.0; 3], 1.0, "m"),
            background(&uniform(RADIANCE)),
        ]);
        let image = LinearImage { width: 1, height: 1, pixels: vec![[0.8, 0.4, 0.1, 1.0]] };
        let texel = exr::encode(&image, &Metadata::default()).expect("a picture");
        measure(&scene_with(&text, [("texel.exr", texel)]), 8, 96)
    };
    let spectrum = |rgb: [f64; 3]| {
        let [r, g, b] = rgb;
        shown(&format!(
            "<albedo_spectrum><rgb><rgb>{r} {g} {b}</rgb><gamma>1</gamma></rgb></albedo_spectrum>"
        ))
    };
    let texel = shown("<albedo_texture><path>texel.exr</path><exponent>1</exponent></albedo_texture>");
    let colour = shown("<colour>0.9 0.6 0.3</colour>");
    for (what, is, expected) in [
        ("texel", texel, spectrum([0.8, 0.4, 0.1])),
        ("colour", colour, spectrum([0.9, 0.6, 0.3].map(|v: f64| v.powf(2.2)))),
    ] {
        for c in 0..3 {
            // The same seeds draw the same wavelengths; texels find their spectra in a table.
            let [is, expected] = [&is, &expected].map(|m| m.xyza[c].mean());
            assert!((is / expected - 1.0).abs() < 5e-3, "{what}, channel {c}: {is} and not {expected}");
        }
    }
}

/// Rough clay sends light back to where it came from.
#[test]
fn sigma_roughens() {
    let back = |sigma: f64| {
        let kind = format!(
            "<oren_nayar><sigma>{sigma}</sigma><albedo_spectrum>{}</albedo_spectrum></oren_nayar>",
            uniform(0.6)
        );
        let (sin, cos) = 60f64.to_radians().sin_cos();
        let scene = sheet_with(&kind, 60.0, "", "");
        let wi = Vec3::new(sin as Real, 0.0, cos as Real);
        point(&scene, 60.0, 550.0, Interface::NONE).eval(wi, Mode::Radiance).f_cos.hero() as f64
    };
    assert!(back(0.3) > 1.1 * back(0.0) && back(0.8) > 1.1 * back(0.3));
}

/// A lamp in the direction in which a surface that leans by its bump map would mirror the view: seen from straight
/// above, all kinds are brighter with the map than without it.
#[test]
fn every_kind_of_surface_is_bent_by_its_bump_map() {
    let dark = medium("dark", 10, &basic(1.5, &uniform(1e9), ""));
    let albedo = format!("<albedo_spectrum>{}</albedo_spectrum>", uniform(0.5));
    let ground = format!("<diffuse_albedo_spectrum>{}</diffuse_albedo_spectrum>", uniform(0.0));
    let inside = "<internal_medium_name>dark</internal_medium_name>";
    for (name, content, gain) in [
        ("diffuse", albedo.clone(), 1.04),
        ("oren_nayar", format!("<sigma>0.3</sigma>{albedo}"), 1.03),
        ("phong", format!("<ior>1.5</ior><exponent>300</exponent>{ground}"), 10.0),
        ("specular", format!("<transparent>true</transparent>{inside}"), 10.0),
        ("glossy_transparent", format!("<exponent>300</exponent>{inside}"), 10.0),
    ] {
        let lit = |bump: &str| {
            // The ramp rises by 0.4 over its two metres along x, a slope of 0.2: 11.3 degrees, twice that for light.
            let angle = 2.0 * 0.2f64.atan();
            let lamp = format!(
                "<rectanglelight><pos>{} 0 {}</pos><width>2</width><height>2</height><spectrum>{}</spectrum></rectanglelight>",
                -20.0 * angle.sin(),
                20.0 * angle.cos(),
                uniform(1e9)
            );
            let others = format!("{dark}{lamp}");
            let scene = sheet_with(&format!("<{name}>{content}{bump}</{name}>"), 0.0, "", &others);
            measure(&scene, 8, 64).luminance().mean()
        };
        let bump = "<bump_map><path>ramp.exr</path><exponent>1</exponent><b>0.4</b></bump_map>";
        let (plain, bent) = (lit(""), lit(bump));
        assert!(bent > gain * plain, "{name}: {plain} and {bent}");
    }
}

/// A thick slab of a medium seen along its normal in even light.
fn slab(medium: &str) -> Measured {
    let slab = Mesh::cube(1.0).placed([2.0, 0.0, 0.0, 0.0, 0.05, 0.0, 0.0, 0.0, 2.0], 1.0, [0.0, 0.05, 0.0]);
    let scene = scene(&scene_file(&[
        settings(8, ""),
        flat_camera([0.0, -1.0, 0.0], [0.0, 1.0, 0.0], 1e-3),
        background(&uniform(RADIANCE)),
        medium.to_owned(),
        specular("surface", "m"),
        slab.text("slab", "surface"),
        model("slab"),
    ]));
    measure(&scene, 8, 64)
}

/// That each is brighter than the one before by a margin that no scatter makes up.
#[track_caller]
fn assert_rising(what: &str, values: &[&Measured]) {
    for pair in values.windows(2) {
        let [a, b] = [pair[0].luminance(), pair[1].luminance()];
        let scatter = (a.variance_of_mean() + b.variance_of_mean()).sqrt();
        assert!(b.mean() - a.mean() > 6.0 * scatter, "{what}: {} then {}, ±{scatter}", a.mean(), b.mean());
    }
}

#[test]
fn every_element_of_a_basic_medium_has_its_effect() {
    let of = |ior: f64, absorption: f64, more: &str| {
        slab(&medium("m", 10, &basic(ior, &uniform(absorption), more)))
    };
    let scatters = |coefficient: f64, phase: &str| scattering(&uniform(coefficient), phase);
    let forward = henyey_greenstein(0.9);
    let backward = henyey_greenstein(-0.5);
    // What absorbs more is darker, what scatters more is brighter, and so is a surface that reflects more.
    assert_rising("absorption", &[&of(1.0, 30.0, ""), &of(1.0, 10.0, ""), &of(1.0, 3.0, "")]);
    let phase = "<uniform></uniform>";
    assert_rising(
        "scattering",
        &[
            &of(1.0, 30.0, ""),
            &of(1.0, 30.0, &scatters(30.0, phase)),
            &of(1.0, 30.0, &scatters(300.0, phase)),
        ],
    );
    assert_rising("ior", &[&of(1.0, 1e3, ""), &of(1.5, 1e3, ""), &of(2.0, 1e3, "")]);
    let [forward, even, backward] =
        [&*forward, phase, &*backward].map(|phase| of(1.0, 30.0, &scatters(100.0, phase)));
    assert_rising("g", &[&forward, &even, &backward]);
}

#[test]
fn every_element_of_skin_has_its_effect() {
    let epidermis = |melanin: f64, eumelanin: f64| {
        slab(&medium(
            "m",
            10,
            &format!(
                "<epidermis><melanin_fraction>{melanin}</melanin_fraction><melanin_type_blend>{eumelanin}</melanin_type_blend></epidermis>"
            ),
        ))
    };
    let dermis = |blood: f64| {
        slab(&medium(
            "m",
            10,
            &format!("<dermis><hemoglobin_fraction>{blood}</hemoglobin_fraction></dermis>"),
        ))
    };
    // Red over blue: X over Z.
    let redness = |m: &Measured| m.xyza[0].mean() / m.xyza[2].mean();
    let [dark, medium, fair] = [0.5, 0.1, 0.01].map(|melanin| epidermis(melanin, 0.5));
    assert_rising("melanin", &[&dark, &medium, &fair]);
    let [brown, reddish] = [1.0, 0.0].map(|eumelanin| epidermis(0.05, eumelanin));
    assert_rising("eumelanin", &[&brown, &reddish]);
    assert!(redness(&reddish) > 1.05 * redness(&brown));
    let [full, little] = [0.1, 0.002].map(dermis);
    assert_rising("haemoglobin", &[&full, &little]);
    assert!(redness(&full) > 1.2 * redness(&little), "blood is red");
}

/// The index inside counts for rough glass, too, at each wavelength.
#[test]
fn rough_glass_reflects_by_the_index_of_its_medium() {
    let shown = |ior: f64, cauchy_b: f64| {
        let kind = "<glossy_transparent><internal_medium_name>dark</internal_medium_name><exponent>50</exponent>\
                    </glossy_transparent>";
        let basic = basic(ior, &uniform(1e9), "")
            .replace("</ior>", &format!("</ior><cauchy_b_coeff>{cauchy_b}</cauchy_b_coeff>"));
        measure(&sheet_with(kind, 20.0, "", &medium("dark", 10, &basic)), 8, 64)
    };
    assert_rising("index", &[&shown(1.1, 0.0), &shown(1.5, 0.0), &shown(2.4, 0.0)]);
    // Z over X: an index of 1.65 in the blue and 1.52 in the red reflects 0.060 and 0.043 of them.
    let blueness = |m: &Measured| m.xyza[2].mean() / m.xyza[0].mean();
    assert!(blueness(&shown(1.4, 0.05)) > 1.15 * blueness(&shown(1.5, 0.0)));
}
