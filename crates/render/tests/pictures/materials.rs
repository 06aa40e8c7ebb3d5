//! Do materials look as they are said to? Their elements, against quadrature of their models and closed forms.

use super::common::judge::{NITS_PER_UNIFORM, assert_near};
use super::common::shapes::{Mesh, model};
use super::common::text::{
    ONE_PIXEL, background, basic, flat_camera, grey, medium, null, scene_file, settings, uniform,
};
use super::common::{Measured, measure, scene_with};
use indigo_geom::Ray;
use indigo_imaging::{LinearImage, Metadata, exr};
use indigo_math::{Real, Vec3};
use indigo_scatter::media::Cauchy;
use indigo_scatter::{Interface, Mode, ShadingPoint};
use indigo_scene::Scene;
use indigo_spectrum::{SampledSpectrum, SampledWavelengths};
use indigo_testkit::quadrature::sphere;
use std::f64::consts::PI;

pub const RADIANCE: f64 = 1.0e5;
const WHITE: &str = "<uniform><value>1</value></uniform>";

/// A picture of one row of greys.
pub fn row(values: &[f32]) -> Vec<u8> {
    let pixels = values.iter().map(|&v| [v, v, v, 1.0]).collect();
    let image = LinearImage { width: values.len() as u32, height: 1, pixels };
    exr::encode(&image, &Metadata::default()).expect("a picture")
}

/// A square of side 2 of a kind of material, seen from an angle to its normal, in even light. `others` are further
/// elements of the scene; the maps are `half.exr`, all 0.5, `quarter.exr`, all
/// 0.25, and `ramp.exr`, from 0 up to 1 along u.
pub fn sheet_with(kind: &str, degrees: f64, more_settings: &str, others: &str) -> Scene {
    let (sin, cos) = degrees.to_radians().sin_cos();
    let ramp: Vec<f32> = (0..64).map(|i| i as f32 / 64.0).collect();
    let text = scene_file(&[
        settings(4, &format!("{ONE_PIXEL}{more_settings}")),
        flat_camera([5.0 * sin, 0.0, 5.0 * cos], [-sin, 0.0, -cos], 1e-3),
        format!("<material><name>m</name>{kind}</material>"),
        "<mesh><name>sheet</name><embedded><expose_uv_set><index>0</index><name>default</name></expose_uv_set>\
         <vertex pos=\"-1 -1 0\" uv0=\"0 0\"/><vertex pos=\"1 -1 0\" uv0=\"1 0\"/><vertex pos=\"1 1 0\" uv0=\"1 1\"/>\
         <vertex pos=\"-1 1 0\" uv0=\"0 1\"/><triangle_set><material_name>m</material_name><tri>0 1 2</tri>\
         <tri>0 2 3</tri></triangle_set></embedded></mesh>"
            .to_owned(),
        model("sheet"),
        background(&uniform(RADIANCE)),
        others.to_owned(),
    ]);
    let [half, quarter] = [0.5, 0.25].map(|v| row(&[v]));
    let files = [
        ("half.exr", half),
        ("quarter.exr", quarter),
        ("ramp.exr", row(&ramp)),
        ("au.nk", GOLD.to_vec()),
        ("flat.nk", FLAT.to_vec()),
    ];
    scene_with(&text, files)
}

/// n and k of that gold at 550 nm.
const GOLD_550: [f64; 2] = [0.424149, 2.472051];
/// A metal of n = 2.7 and k = 3.8 at all wavelengths, like titanium.
const FLAT: &[u8] = b"4 360 830 1\n2.7 3.8\n2.7 3.8\n";
const GOLD: &[u8] = include_bytes!("../../../../nkdata/au.nk");

fn sheet(kind: &str, degrees: f64) -> Scene {
    sheet_with(kind, degrees, "", "")
}

/// The model where the camera's axis meets the sheet, between media of some indices.
pub fn point(scene: &Scene, degrees: f64, nm: Real, interface: Interface) -> ShadingPoint {
    let (sin, cos) = degrees.to_radians().sin_cos();
    let wo = Vec3::new(sin as Real, 0.0, cos as Real);
    let ray = Ray::new(Vec3::ZERO, -wo);
    let hit = scene.accel.intersect(&ray).expect("the sheet is before the camera");
    let at = scene.accel.surface(&ray, &hit);
    let mut lambda = SampledWavelengths::sample(0.5);
    lambda.lambda[0] = nm;
    let context = scene.material_context(&lambda, interface, 0.5);
    let uv = |set| scene.accel.uv(&at, set);
    let leaf = scene.material_at(&at).chosen(&context, &uv).leaf(&context, uv).expect("something");
    ShadingPoint::new(leaf, at.n_g, at.n_s, wo)
}

/// The share of even light that is scattered towards a view, by quadrature.
fn albedo(kind: &str, degrees: f64, nm: Real) -> f64 {
    albedo_of(&point(&sheet(kind, degrees), degrees, nm, Interface::NONE))
}

/// The same of a model that is set up.
pub fn albedo_of(point: &ShadingPoint) -> f64 {
    let vec = |d: [f64; 3]| Vec3::new(d[0] as Real, d[1] as Real, d[2] as Real);
    sphere(1e-4, |wi| point.eval(vec(wi), Mode::Radiance).f_cos.hero() as f64).value
}

/// What is reflected towards a view from the mirror direction, turned by so much.
fn gloss(kind: &str, degrees: f64, off: f64) -> f64 {
    let point = point(&sheet(kind, degrees), degrees, 550.0, Interface::NONE);
    let (sin, cos) = (degrees + off).to_radians().sin_cos();
    point.eval(Vec3::new(-sin as Real, 0.0, cos as Real), Mode::Radiance).f_cos.hero() as f64
}

pub fn phong(content: &str) -> String {
    format!("<phong>{content}</phong>")
}

fn assert_shows(what: &str, measured: &Measured, albedo: f64, tolerance: f64) {
    assert_near(what, measured.luminance(), albedo * RADIANCE * NITS_PER_UNIFORM, tolerance);
}

fn with_technique(mut scene: Scene, bidirectional: bool) -> Scene {
    scene.transport.bidirectional = bidirectional;
    scene
}

/// Light of one lamp far away, on a sheet raised by a ramp, is that on a sheet that leans as much, under any scale of
/// the coordinates and of the mesh: n · l with n = (-slope, 0, 1), and besides what such a sheet scatters below the flat one, spread
/// over what is above it.
#[test]
fn a_bump_map_leans_the_surface_by_its_slope() {
    let lit = |bump: &str, scale: f64, tiles: f64| {
        let text = scene_file(&[
            settings(4, ""),
            flat_camera([0.0, 0.0, 5.0], [0.0, 0.0, -1.0], 1e-4),
            format!(
                "<material><name>m</name><diffuse><albedo_spectrum>{}</albedo_spectrum>{bump}</diffuse></material>",
                uniform(0.5)
            ),
            format!(
                "<mesh><name>sheet</name><embedded><expose_uv_set><index>0</index><name>default</name></expose_uv_set>\
                 <vertex pos=\"-1 -1 0\" uv0=\"0 0\"/><vertex pos=\"1 -1 0\" uv0=\"{tiles} 0\"/>\
                 <vertex pos=\"1 1 0\" uv0=\"{tiles} 1\"/><vertex pos=\"-1 1 0\" uv0=\"0 1\"/>\
                 <triangle_set><material_name>m</material_name><tri>0 1 2</tri><tri>0 2 3</tri></triangle_set>\
                 </embedded></mesh>\
                 <model><pos>0 0 0</pos><scale>{scale}</scale><mesh_name>sheet</mesh_name></model>"
            ),
            // From x = -16, z = 12: along (-0.8, 0, 0.6).
            "<rectanglelight><pos>-16 0 12</pos><width>0.2</width><height>0.2</height><spectrum><uniform><value>1e7\
             </value></uniform></spectrum></rectanglelight>"
                .to_owned(),
        ]);
        let ramp: Vec<f32> = (0..64).map(|i| i as f32 / 64.0).collect();
        measure(&scene_with(&text, [("ramp.exr", row(&ramp))]), 16, 64)
    };
    let flat = lit("", 1.0, 1.0).luminance().mean();
    for (slope, scale, tiles) in
        [(0.2, 1.0, 1.0), (-0.2, 1.0, 1.0), (0.2, 3.0, 1.0), (0.2, 1.0, 0.25), (0.7, 0.5, 3.0)]
    {
        // The ramp rises by 1 over one tile, which is 2 · scale / tiles wide.
        let height = slope * 2.0 * scale / tiles;
        let bump = format!("<bump_map><path>ramp.exr</path><exponent>1</exponent><b>{height}</b></bump_map>");
        // Angles from the flat sheet, on the side to which the other leans: of that, and of the light.
        let lean = f64::atan(f64::abs(slope));
        let light = if slope > 0.0 { f64::asin(0.6) } else { PI - f64::asin(0.6) };
        let spread = lean / PI * f64::sin(lean - light * lean / PI);
        let expected = (f64::max(0.0, f64::sin(light + lean)) + spread) / 0.6;
        let measured = lit(&bump, scale, tiles);
        assert_near(
            &format!("slope {slope} at {scale}, {tiles}"),
            measured.luminance(),
            flat * expected,
            2e-3,
        );
    }
}

#[test]
fn bumps_neither_darken_nor_leak() {
    // A slope of 4, far steeper than any light can reach every facet of: the albedo stays.
    let bump = "<bump_map><path>ramp.exr</path><exponent>1</exponent><b>8</b></bump_map>";
    let kinds = [
        format!("<diffuse><albedo_spectrum>{WHITE}</albedo_spectrum>{bump}</diffuse>"),
        phong(&format!(
            "<exponent>3000</exponent><specular_reflectivity_spectrum>{WHITE}</specular_reflectivity_spectrum>{bump}"
        )),
        phong(&format!(
            "<ior>1.5</ior><exponent>30</exponent><diffuse_albedo_spectrum>{WHITE}</diffuse_albedo_spectrum>{bump}"
        )),
        format!("<oren_nayar><sigma>1</sigma><albedo_spectrum>{WHITE}</albedo_spectrum>{bump}</oren_nayar>"),
    ];
    for kind in kinds {
        for degrees in [0.0, 60.0, -80.0] {
            let measured = measure(&sheet(&kind, degrees), 16, 512);
            assert_shows(&format!("{kind} at {degrees}°"), &measured, 1.0, 2e-3);
        }
    }
}

/// Gold head on, lit by white: the colour that its complex index has in Rec. 709 under D65.
#[test]
fn gold_has_the_colour_of_its_index() {
    let kind = phong("<nk_data>au.nk</nk_data><exponent>1000000</exponent>");
    let white = "<rgb><rgb>1 1 1</rgb><gamma>1</gamma></rgb>";
    let text = scene_file(&[
        settings(4, ""),
        flat_camera([0.0, 0.0, 5.0], [0.0, 0.0, -1.0], 1e-3),
        format!("<material><name>m</name>{kind}</material>"),
        Mesh::square(1.0, 0.0).text("sheet", "m"),
        model("sheet"),
        background(white),
    ]);
    let gold = measure(&scene_with(&text, [("au.nk", GOLD.to_vec()), ("flat.nk", FLAT.to_vec())]), 16, 512);
    let [x, y, z] = [0, 1, 2].map(|c| gold.xyza[c].mean());
    let linear = [
        3.2406 * x - 1.5372 * y - 0.4986 * z,
        -0.9689 * x + 1.8758 * y + 0.0415 * z,
        0.0557 * x - 0.2040 * y + 1.0570 * z,
    ];
    for (channel, expected) in linear.iter().zip([1.0375, 0.7284, 0.3645]) {
        let value = channel / NITS_PER_UNIFORM;
        assert!(
            (value - expected).abs() < 5e-3,
            "{linear:?} over {NITS_PER_UNIFORM}: {value} for {expected}"
        );
    }
}

#[test]
fn every_element_of_phong_has_its_effect() {
    let coat = |ior: f64, exponent: f64, ground: &str| {
        phong(&format!("<ior>{ior}</ior><exponent>{exponent}</exponent>{ground}"))
    };
    let ground = format!("<diffuse_albedo_spectrum>{}</diffuse_albedo_spectrum>", uniform(0.5));
    let at = |kind: &str| albedo(kind, 30.0, 550.0);
    // A denser coat reflects more, and all the more the flatter it is seen.
    assert!(at(&coat(2.0, 100.0, "")) > 1.5 * at(&coat(1.5, 100.0, "")));
    assert!(albedo(&coat(1.5, 100.0, ""), 80.0, 550.0) > 5.0 * at(&coat(1.5, 100.0, "")));
    // A smooth coat reflects what Fresnel says: 0.0415 at 30° for 1.5.
    assert!((at(&coat(1.5, 3000.0, "")) - 0.0415).abs() < 1e-3, "{}", at(&coat(1.5, 3000.0, "")));
    // The ground is seen through what is not reflected.
    let black = at(&coat(1.5, 100.0, ""));
    assert!((at(&coat(1.5, 100.0, &ground)) - (black + 0.5 * (1.0 - black))).abs() < 5e-4);
    assert!(
        (at(&coat(1.5, 100.0, "<diffuse>0.73 0.73 0.73</diffuse>")) - at(&coat(1.5, 100.0, &ground))).abs()
            < 2e-3
    );
    // The spectrum counts before the colour.
    let both = format!("<diffuse>0.9 0.9 0.9</diffuse>{ground}");
    assert!((at(&coat(1.5, 100.0, &both)) - at(&coat(1.5, 100.0, &ground))).abs() < 1e-6);
    let map = "<albedo_texture><path>half.exr</path><exponent>1</exponent></albedo_texture>";
    assert!((at(&coat(1.5, 100.0, map)) - at(&coat(1.5, 100.0, &ground))).abs() < 2e-3);
    // A higher exponent has a brighter and narrower highlight.
    assert!(gloss(&coat(1.5, 1000.0, ""), 30.0, 0.0) > 5.0 * gloss(&coat(1.5, 100.0, ""), 30.0, 0.0));
    assert!(gloss(&coat(1.5, 1000.0, ""), 30.0, 15.0) < gloss(&coat(1.5, 100.0, ""), 30.0, 15.0));
    // A map of exponents, 200 · 0.5, is the exponent 100; a number beside it has no say.
    let mapped = phong(
        "<ior>1.5</ior><exponent>7</exponent><exponent_map><path>half.exr</path><exponent>1</exponent><b>200</b></exponent_map>",
    );
    for off in [0.0, 10.0] {
        let (map, number) = (gloss(&mapped, 30.0, off), gloss(&coat(1.5, 100.0, ""), 30.0, off));
        assert!((map / number - 1.0).abs() < 1e-4, "{map} {number}");
    }
}

/// Under water the quotient of the indices counts: ((1.5 - 1.333) / (1.5 + 1.333))² instead of 0.04.
#[test]
fn coats_and_metals_reflect_by_the_index_of_what_lies_outside() {
    // Somewhere in the scene is water, of which light of each wavelength has an index of its own.
    let water = Cauchy { a: 1.324, b: 0.003 };
    let content = basic(water.a, &uniform(0.0), "")
        .replace("</ior>", &format!("</ior><cauchy_b_coeff>{}</cauchy_b_coeff>", water.b));
    let others = medium("water", 10, &content)
        + &super::common::text::specular("wet", "water")
        + &super::common::text::sphere([50.0, 0.0, 0.0], 1.0, "wet");
    let seen = |kind: &str, degrees: f64, index: f64| {
        let outside = SampledSpectrum::splat(index as Real);
        let interface = Interface { above: outside, below: outside };
        point(&sheet_with(kind, degrees, "", &others), degrees, 550.0, interface)
    };
    let along = |kind: &str, index: f64| {
        seen(kind, 0.0, index).eval(Vec3::new(0.0, 0.0, 1.0), Mode::Radiance).f_cos.hero() as f64
    };
    let reflectance = |n: f64, k: f64| ((n - 1.0).powi(2) + k * k) / ((n + 1.0).powi(2) + k * k);
    let inside = f64::from(water.at(550.0));
    let coat = phong("<ior>1.5</ior><exponent>1000</exponent>");
    let gold = phong("<nk_data>au.nk</nk_data><exponent>1000000</exponent>");
    for (kind, n, k) in [(coat, 1.5, 0.0), (gold, GOLD_550[0], GOLD_550[1])] {
        let quotient = along(&kind, inside) / along(&kind, 1.0);
        let expected = reflectance(n / inside, k / inside) / reflectance(n, k);
        assert!((quotient / expected - 1.0).abs() < 2e-3, "{kind}: {quotient} and not {expected}");
    }
    // Neither loses nor makes light: what the coat reflects is taken from the ground.
    let white = phong(&format!(
        "<ior>1.5</ior><exponent>20</exponent><diffuse_albedo_spectrum>{WHITE}</diffuse_albedo_spectrum>"
    ));
    for index in [1.0, inside] {
        for degrees in [0.0, 60.0] {
            let albedo = albedo_of(&seen(&white, degrees, index));
            assert!((albedo - 1.0).abs() < 4e-4, "{index}, {degrees}°: {albedo}");
        }
    }
}

/// `nk_data` counts before `specular_reflectivity_spectrum`, and that before `ior` and the ground.
#[test]
fn the_kinds_of_phong_have_their_order() {
    let rest = format!(
        "<exponent>50</exponent><ior>1.5</ior><diffuse_albedo_spectrum>{WHITE}</diffuse_albedo_spectrum>\
         <albedo_texture><path>half.exr</path></albedo_texture>"
    );
    let reflectivity =
        format!("<specular_reflectivity_spectrum>{}</specular_reflectivity_spectrum>", uniform(0.3));
    let gold = "<nk_data>au.nk</nk_data>";
    let at = |content: &str| albedo(&phong(content), 20.0, 550.0);
    let alone = |what: &str| at(&format!("<exponent>50</exponent>{what}"));
    assert!((at(&format!("{rest}{reflectivity}{gold}")) - alone(gold)).abs() < 1e-6);
    assert!((at(&format!("{rest}{reflectivity}")) - alone(&reflectivity)).abs() < 1e-6);
    assert!((at(&format!("{rest}<nk_data></nk_data>")) - at(&rest)).abs() < 1e-6);
    // The texture counts before the spectrum of the ground: 0.5^2.2 of what the coat lets through, and not all of it.
    let ground_alone = at(&rest.replace("<albedo_texture><path>half.exr</path></albedo_texture>", ""));
    assert!((ground_alone - 1.0).abs() < 1e-3, "{ground_alone}");
    // And the spectrum before the colour.
    let coloured = rest
        .replace("<albedo_texture><path>half.exr</path></albedo_texture>", "<diffuse>0.1 0.1 0.1</diffuse>");
    assert!((at(&coloured) - ground_alone).abs() < 1e-6);
    assert!(at(&rest) < 0.28 && alone(gold) > 0.7 && (alone(&reflectivity) - 0.3).abs() < 0.02);
}

#[test]
fn blends_mix_by_number_by_map_and_to_any_depth() {
    let parts = grey("dark", 0.2) + &grey("light", 0.8);
    let blend = |factor: f64, a: &str, b: &str| {
        format!(
            "<blend><blend_factor>{factor}</blend_factor><a_name>{a}</a_name><b_name>{b}</b_name></blend>"
        )
    };
    let named = |name: &str, kind: &str| format!("<material><name>{name}</name>{kind}</material>");
    let map = |path: &str| {
        format!(
            "<blend><blend_factor>0.9</blend_factor><blend_map><path>{path}</path><exponent>1</exponent></blend_map>\
             <a_name>dark</a_name><b_name>light</b_name></blend>"
        )
    };
    let nested = parts.clone()
        + &named("half", &blend(0.5, "dark", "light"))
        + &named("more", &blend(0.5, "half", "light"));
    for (what, kind, others, expected) in [
        ("a alone", blend(0.0, "dark", "light"), &parts, 0.2),
        ("b alone", blend(1.0, "dark", "light"), &parts, 0.8),
        ("a quarter", blend(0.25, "dark", "light"), &parts, 0.35),
        ("a map of 0.5", map("half.exr"), &parts, 0.5),
        ("a map of 0.25", map("quarter.exr"), &parts, 0.35),
        // The middle of the ramp, where the camera looks.
        ("a ramp", map("ramp.exr"), &parts, 0.5),
        ("nested", blend(0.5, "dark", "more"), &nested, 0.5 * (0.2 + 0.65)),
    ] {
        for bidirectional in [false, true] {
            let scene = with_technique(sheet_with(&kind, 40.0, "", others), bidirectional);
            assert_shows(what, &measure(&scene, 16, 512), expected, 3e-3);
        }
    }
}

/// A sheet that is there in part: what lies behind shows through, and light passes, as the share says.
#[test]
fn a_blend_with_nothing_is_partly_see_through() {
    let kind =
        "<blend><blend_factor>0.3</blend_factor><a_name>black</a_name><b_name>nothing</b_name></blend>";
    let others = grey("black", 0.0) + &null("nothing");
    for bidirectional in [false, true] {
        let scene = with_technique(sheet_with(kind, 20.0, "", &others), bidirectional);
        assert_shows("the sky behind", &measure(&scene, 16, 512), 0.3, 3e-3);
    }
    // A lamp above the sheet, and a floor below it that is seen from below the sheet.
    let floor = |sheet: &str, bidirectional: bool| {
        let text = scene_file(&[
            settings(4, ""),
            flat_camera([0.0, -2.0, 0.5], [0.0, 2.0, -0.5], 0.01),
            grey("floor", 0.6),
            others.clone(),
            format!("<material><name>m</name>{kind}</material>"),
            Mesh::square(3.0, 0.0).text("ground", "floor"),
            model("ground"),
            sheet.to_owned(),
            "<rectanglelight><pos>0 0 3</pos><width>0.5</width><height>0.5</height><spectrum><uniform><value>1e6\
             </value></uniform></spectrum></rectanglelight>"
                .to_owned(),
        ]);
        measure(&with_technique(scene_with(&text, []), bidirectional), 16, 256)
    };
    let sheet = Mesh::square(3.0, 1.0).text("sheet", "m") + &model("sheet");
    let free = floor("", false);
    for bidirectional in [false, true] {
        let shaded = floor(&sheet, bidirectional);
        assert_near("light through the sheet", shaded.luminance(), 0.3 * free.luminance().mean(), 5e-3);
    }
}

/// In even light a sheet shows what its own side's material scatters of its part, and what comes through of the rest.
#[test]
fn a_thin_sheet_has_a_material_on_each_side() {
    let sides = grey("front", 0.8) + &grey("back", 0.2);
    let thin = |r_f: f64, through: &str, back: &str| {
        format!(
            "<double_sided_thin><front_material_name>front</front_material_name>{back}<r_f>{r_f}</r_f>{through}</double_sided_thin>"
        )
    };
    let back = "<back_material_name>back</back_material_name>";
    let half = "<transmittance><constant><uniform><value>0.5</value></uniform></constant></transmittance>";
    let map =
        "<transmittance><texture><path>quarter.exr</path><exponent>1</exponent></texture></transmittance>";
    for (what, kind, degrees, expected) in [
        ("front", thin(0.6, half, back), 20.0, 0.6 * 0.8 + 0.4 * 0.5),
        ("back", thin(0.6, half, back), 160.0, 0.6 * 0.2 + 0.4 * 0.5),
        ("one material", thin(0.6, half, ""), 160.0, 0.6 * 0.8 + 0.4 * 0.5),
        ("through alone", thin(0.0, half, back), 20.0, 0.5),
        ("back alone", thin(1.0, half, back), 20.0, 0.8),
        ("a picture", thin(0.5, map, back), 20.0, 0.5 * 0.8 + 0.5 * 0.25),
        ("nothing through", thin(0.5, "", back), 20.0, 0.5 * 0.8),
    ] {
        for bidirectional in [false, true] {
            let scene = with_technique(sheet_with(&kind, degrees, "", &sides), bidirectional);
            let measured = measure(&scene, 8, 400);
            let what = format!("{what}, bidirectional: {bidirectional}");
            assert_near(&what, measured.luminance(), RADIANCE * NITS_PER_UNIFORM * expected, 1e-2);
        }
    }
}
