//! Light: materials that emit, what scales them, and surroundings in the form of a material.

use super::common::*;
use indigo_scene::Scene;
use std::f64::consts::PI;

/// A square of the material `m` alone, of 1 m².
pub const SQUARE: &str = "<mesh><name>square</name><embedded><expose_uv_set><index>0</index><name>default</name></expose_uv_set><vertex pos=\"0 0 0\" uv0=\"0 0\"/><vertex pos=\"1 0 0\" uv0=\"1 0\"/><vertex pos=\"1 1 0\" uv0=\"1 1\"/><vertex pos=\"0 1 0\" uv0=\"0 1\"/><triangle_set><material_name>m</material_name><tri>0 1 2</tri><tri>0 2 3</tri></triangle_set></embedded></mesh>";
pub const PLACE: &str = "<pos>1 2 3</pos><scale>0.5</scale><rotation><matrix>1 0 0 0 -1 0 0 0 -1</matrix></rotation><mesh_name>square</mesh_name>";
const BODY: &str = "<blackbody><temperature>3000</temperature><gain>1e-3</gain></blackbody>";

/// A scene whose material `m` has this emission, with a placed square.
fn of(emission: &str, placed: &str) -> String {
    let kind = GREY.replace("</diffuse>", &format!("{emission}</diffuse>"));
    format!("{CAMERA}{SQUARE}{}{placed}", material("m", &kind))
}

/// A scene whose surroundings are a material of a kind.
pub fn background(kind: &str, scale: &str) -> String {
    let named = "<material><name>sky</name><sunsky><sundir>0 0.6 1</sundir><turbidity>3</turbidity></sunsky></material><material><name>even</name><diffuse><base_emission><uniform><value>5</value></uniform></base_emission></diffuse></material>";
    format!(
        "{CAMERA}{SQUARE}{}<model>{PLACE}</model>{named}<background_settings><background_material><material><name>background</name>{kind}</material></background_material>{scale}</background_settings>",
        material("m", GREY)
    )
}

/// With the square as a mesh light.
fn meshlight(more: &str) -> String {
    of("", &format!("<meshlight>{PLACE}<spectrum>{BODY}</spectrum>{more}</meshlight>"))
}

/// With the square as a model whose material emits that spectrum.
fn model(emission: &str, more: &str) -> String {
    let base = format!("<base_emission><constant>{BODY}</constant></base_emission>");
    of(&(base + emission), &format!("<model>{PLACE}{more}</model>"))
}

#[test]
fn a_model_of_an_emitting_material_is_a_mesh_light() {
    let dimmer = "<emission><constant><rgb><rgb>0.5 0.5 0.5</rgb></rgb></constant></emission>";
    assert_same([&meshlight(""), &model("", ""), &model(dimmer, "")]);
    let white = "<emission><constant><rgb><rgb>1 1 1</rgb></rgb></constant></emission><layer>0</layer>";
    assert_same([&meshlight(""), &model(white, ""), &model(dimmer, "")]);
    // Without a base the emission is the radiance.
    let alone =
        of(&format!("<emission><constant>{BODY}</constant></emission>"), &format!("<model>{PLACE}</model>"));
    assert_same([&meshlight(""), &alone, &model(dimmer, "")]);
    // Over an even base a colour is light as it is alone.
    let rgb = |gain: &str, base: &str| {
        let emission = format!(
            "{base}<emission><constant><rgb><rgb>8 4 2</rgb><gain>{gain}</gain></rgb></constant></emission>"
        );
        of(&emission, &format!("<model>{PLACE}</model>"))
    };
    let base = "<base_emission><constant><uniform><value>8</value></uniform></constant></base_emission>";
    assert_same([&rgb("8", ""), &rgb("1", base), &rgb("1", "")]);
    let map = "<path>a.bmp</path><exponent>1</exponent><b>2</b>";
    let textured = format!(
        "<texture>{map}</texture><emission><texture><texture_index>0</texture_index></texture></emission>"
    );
    assert_same([&meshlight(&format!("<texture>{map}</texture>")), &model(&textured, ""), &model("", "")]);
}

#[test]
fn emission_scales_are_fluxes() {
    let area = 0.25;
    let by_flux = |flux: f64| {
        meshlight(&format!(
            "<efficacy_scale><power_drawn>{flux}</power_drawn><overall_luminous_efficacy>1</overall_luminous_efficacy></efficacy_scale>"
        ))
    };
    let scaled = |measure: &str| {
        model(
            "",
            &format!(
                "<emission_scale><material_name>m</material_name><measure>{measure}</measure><value>40</value></emission_scale>"
            ),
        )
    };
    for (measure, flux) in [
        ("luminous_flux", 40.0),
        ("luminous_intensity", PI * 40.0),
        ("luminance", PI * area * 40.0),
        ("luminous_emittance", area * 40.0),
    ] {
        assert_same([&by_flux(flux), &scaled(measure), &by_flux(1.01 * flux)]);
    }
    // Of a material that does not shine.
    let scale = "<emission_scale><material_name>m</material_name><measure>luminance</measure><value>1</value></emission_scale>";
    let dark = of("", &format!("{LIGHT}<model>{PLACE}{scale}</model>"));
    scene_with(&dark, &["W0321 <emission_scale> has no effect: m emits nothing"]);
    // Of one that is black there is nothing to scale, and it is no lamp.
    let black = of(
        "<base_emission><uniform><value>0</value></uniform></base_emission>",
        &format!("{LIGHT}<model>{PLACE}</model>"),
    );
    assert_eq!(
        dump(&scene_with(&black, &[])),
        dump(&scene_with(&of("", &format!("{LIGHT}<model>{PLACE}</model>")), &[]))
    );
}

#[test]
fn profiles_are_of_a_material_and_may_be_scaled() {
    let profile = "<path>lamp.ies</path>";
    let old = meshlight(&format!("<ies_profile>{profile}</ies_profile>"));
    let of_m = format!("<ies_profile><material_name>m</material_name>{profile}</ies_profile>");
    let dim = "<emission_scale><material_name>m</material_name><measure>luminous_flux</measure><value>10</value></emission_scale>";
    assert_same([&old, &model("", &of_m), &model("", &format!("{of_m}{dim}"))]);
}

/// A scene with settings of its layers, beside those that each test has.
fn with_layers(elements: &str, layers: &str, warnings: &[&str]) -> Scene {
    let settings = format!("<renderer_settings>{layers}</renderer_settings>");
    let double = "W0103 <renderer_settings> is given more than once";
    scene_with(&(elements.to_owned() + &settings), &[&[double], warnings].concat())
}

/// Names and gains of a scene's groups of lights.
fn groups(scene: &Scene) -> Vec<(&str, f64)> {
    let gain = |group: &indigo_film::LightGroup| if group.is_on { group.gain } else { 0.0 };
    scene.picture.lights.0.iter().map(|group| (&*group.name, gain(group))).collect()
}

#[test]
fn layers_are_dimmed_and_switched_off_after_the_render() {
    let scene = |layers: &str| with_layers(&(model("<layer>1</layer>", "") + LIGHT), layers, &[]);
    let lamps = |is_on: bool, scale: &str| {
        let lamps = format!("<name>lamps</name><enabled>{is_on}</enabled><layer_scale>{scale}</layer_scale>");
        scene(&format!("<layer_setting/><layer_setting>{lamps}</layer_setting>"))
    };
    let rgb = |rgb: &str, gain: f64| format!("<rgb><rgb>{rgb}</rgb><gain>{gain}</gain></rgb>");
    let white = lamps(true, &rgb("1 1 1", 1.0));
    assert_eq!(groups(&white), [("layer 0", 1.0), ("lamps", 1.0)]);
    for (other, gain) in [
        (lamps(true, &rgb("1 1 1", 0.5)), 0.5),
        (lamps(true, &rgb("0.5 0.5 0.5", 1.0)), 0.5),
        (lamps(true, &rgb("0 0 0", 1.0)), 0.0),
        (lamps(false, &rgb("1 1 1", 0.5)), 0.0),
    ] {
        let found = groups(&other)[1].1;
        assert!((found - gain).abs() < 1e-6, "{found} instead of {gain}");
        // What is rendered is the same, and so is the film.
        assert_eq!(other.identity, white.identity);
    }
    // A colour is rendered, with the luminance of white.
    let red = lamps(true, &rgb("1 0.2 0.2", 1.0));
    assert_ne!(dump(&red), dump(&white));
    assert_ne!(red.identity, white.identity);
    assert_eq!(red.identity, lamps(true, &rgb("1 0.2 0.2", 3.0)).identity);
    // Of two narrow bands, too, that are the same at most wavelengths.
    let band = |start: u32| {
        let peak = format!(
            "<peak><peak_min>{start}</peak_min><peak_width>20</peak_width><base_value>0</base_value><peak_value>1</peak_value></peak>"
        );
        lamps(true, &peak)
    };
    assert_ne!(band(462).identity, band(512).identity);
    assert_eq!(band(462).identity, band(462).identity);
    // Of a black body only the gain is brightness.
    let warm = lamps(true, "<blackbody><temperature>2700</temperature><gain>0.25</gain></blackbody>");
    assert_eq!(groups(&warm)[1].1, 0.25);
    assert_ne!(dump(&warm), dump(&white));
}

#[test]
fn lights_are_of_the_layers_that_they_name() {
    let layer = |name: &str, gain: f64| {
        format!(
            "<layer_setting><name>{name}</name><layer_scale><uniform><value>{gain}</value></uniform></layer_scale></layer_setting>"
        )
    };
    let sky = |layers: &str| {
        format!("{CAMERA}<skylight><sundir>0 0.6 1</sundir><turbidity>2</turbidity>{layers}</skylight>")
    };
    let three = layer("a", 2.0) + &layer("b", 3.0) + &layer("c", 4.0);
    // Those that have no light are not in the film.
    let of = |elements: &str| {
        let scene = with_layers(elements, &three, &[]);
        groups(&scene).iter().map(|(name, _)| (*name).to_owned()).collect::<Vec<_>>()
    };
    assert_eq!(of(&sky("")), ["a"]);
    assert_eq!(of(&sky("<sun_layer>1</sun_layer><sky_layer>2</sky_layer>")), ["b", "c"]);
    assert_eq!(of(&sky("<sun_layer>1</sun_layer><sky_layer>7</sky_layer>")), ["b", "other lights"]);
    assert_eq!(of(&meshlight("")), ["a"]);
    assert_eq!(of(&meshlight("<layer>2</layer>")), ["c"]);
    let lamp = |layer: &str| {
        let size = "<pos>0 0 3</pos><width>1</width><height>1</height>";
        format!("{CAMERA}<rectanglelight>{size}{layer}<spectrum>{BODY}</spectrum></rectanglelight>")
    };
    assert_eq!(of(&lamp("<layer>1</layer>")), ["b"]);
    assert_eq!(of(&lamp("")), ["a"]);
    assert_eq!(
        of(&(lamp("<layer>2</layer>") + &meshlight("<layer>1</layer>").replace(CAMERA, ""))),
        ["b", "c"]
    );
    let sunsky = "<sunsky><sundir>0 0.6 1</sundir><sun_layer>2</sun_layer><sky_layer>1</sky_layer></sunsky>";
    assert_eq!(of(&background(sunsky, "")), ["b", "c"]);
    // Without layers nothing is kept apart.
    assert_eq!(groups(&scene_with(&sky("<sun_layer>1</sun_layer>"), &[])), []);
    // Names are told apart.
    let twice = with_layers(
        &sky("<sky_layer>1</sky_layer><sun_layer>0</sun_layer>"),
        &(layer("a", 2.0) + &layer("a", 3.0)),
        &[],
    );
    let names = groups(&twice);
    assert_eq!(names.iter().map(|(name, _)| *name).collect::<Vec<_>>(), ["a", "a (1)"]);
    assert!((names[1].1 - 3.0).abs() < 1e-9, "{names:?}");
    // The sun's colour is its own.
    let red = "<layer_setting><layer_scale><rgb><rgb>1 0 0</rgb></rgb></layer_scale></layer_setting>";
    let keeps = "W0321 this light keeps its colour";
    with_layers(&sky(""), red, &[keeps, keeps]);
}

#[test]
fn more_layers_than_a_film_has_are_rendered_in() {
    let layers =
        "<layer_setting><layer_scale><uniform><value>2</value></uniform></layer_scale></layer_setting>";
    let even = |layer: u32| {
        let kind = format!(
            "<diffuse><base_emission><uniform><value>5</value></uniform></base_emission><layer>{layer}</layer></diffuse>"
        );
        background(&kind, "")
    };
    let warnings = ["W0320 only the first 15 layers are kept apart"];
    let layers = layers.replace("<layer_scale>", "<name>n</name><layer_scale>").repeat(18);
    let [apart, baked] = [14, 17].map(|layer| with_layers(&even(layer), &layers, &warnings));
    assert_eq!(groups(&apart).iter().map(|group| group.1).collect::<Vec<_>>(), [2.0]);
    assert_eq!(groups(&baked), [("other lights", 1.0)]);
    assert!((surroundings(&baked) / surroundings(&apart) - 2.0).abs() < 1e-6);
}

#[test]
fn layers_are_of_surroundings_too() {
    let even = "<diffuse><base_emission><uniform><value>5</value></uniform></base_emission><layer>0</layer></diffuse>";
    let map = "<diffuse><emission><texture><path>sky.hdr</path><exponent>1</exponent></texture></emission></diffuse>";
    let half =
        "<layer_setting><layer_scale><uniform><value>0.5</value></uniform></layer_scale></layer_setting>";
    for kind in [even, map] {
        let (whole, halved) =
            (scene_with(&background(kind, ""), &[]), with_layers(&background(kind, ""), half, &[]));
        assert_eq!(surroundings(&whole), surroundings(&halved), "{kind}");
        assert_eq!(groups(&halved), [("layer 0", 0.5)], "{kind}");
    }
}

#[test]
fn surroundings_are_scaled_before_they_have_the_colour_of_their_layer() {
    let kind = format!("<diffuse><base_emission>{BODY}</base_emission></diffuse>");
    let scale = "<emission_scale><material_name>background</material_name><measure>luminance</measure><value>100</value></emission_scale>";
    let red = "<layer_setting><layer_scale><rgb><rgb>1 0 0</rgb></rgb></layer_scale></layer_setting>";
    let coloured = |scale: &str| {
        let plain = surroundings(&scene_with(&background(&kind, scale), &[]));
        surroundings(&with_layers(&background(&kind, scale), red, &[])) / plain
    };
    let (own, scaled) = (coloured(""), coloured(scale));
    assert!((scaled / own - 1.0).abs() < 1e-6, "{scaled} instead of {own}");
}

#[test]
fn of_a_mesh_with_several_materials_the_emitting_parts_are_lamps() {
    let lit = GREY.replace("</diffuse>", &format!("<base_emission>{BODY}</base_emission></diffuse>"));
    let scene = |n: &str| format!("{CAMERA}{LIGHT}{MESH}{MODEL}{}{}", material("m", GREY), material("n", n));
    let (whole, parts) = (scene_with(&scene(GREY), &[]), scene_with(&scene(&lit), &[]));
    assert_eq!((whole.accel.objects().len(), parts.accel.objects().len()), (1, 2));
    let triangles = |scene: &indigo_scene::Scene| {
        let of = |o: &indigo_geom::Object| match o {
            indigo_geom::Object::Mesh { mesh, .. } => scene.accel.meshes()[*mesh as usize].triangles().len(),
            _ => 0,
        };
        scene.accel.objects().iter().map(of).collect::<Vec<_>>()
    };
    assert_eq!((triangles(&whole), triangles(&parts)), (vec![2], vec![1, 1]));
    assert_eq!((whole.lights.len(), parts.lights.len()), (1, 2));
    // Each part has the corners that it had.
    let bounds = |scene: &indigo_scene::Scene| scene.accel.bounds();
    assert_eq!(format!("{:?}", bounds(&whole)), format!("{:?}", bounds(&parts)));
}

#[test]
fn what_cannot_shine_is_told() {
    let lit = GREY.replace("</diffuse>", &format!("<base_emission>{BODY}</base_emission></diffuse>"));
    let sphere = "<sphere><center>0 0 0</center><radius>1</radius><material_name>m</material_name></sphere>";
    scene_with(
        &format!("{CAMERA}{LIGHT}{}{sphere}", material("m", &lit)),
        &["W0319 a sphere of a material with <emission> (format version 1.1) gives no light"],
    );
    let blend = "<blend><blend_factor>0.5</blend_factor><a_name>m</a_name><b_name>n</b_name></blend>";
    let blended = format!(
        "{CAMERA}{LIGHT}{}{}{}{}",
        material("m", &lit),
        material("n", GREY),
        material("b", blend),
        sphere.replace(">m<", ">b<")
    );
    scene_with(
        &blended,
        &["W0319 a sphere of a material with <emission> (format version 1.1) gives no light"],
    );
    let map = "<blend_map><path>a.bmp</path><exponent>1</exponent></blend_map>";
    let mapped = blended.replace("<blend_factor>0.5</blend_factor>", map);
    scene_with(&mapped, &["W0319 a blend of a material with <emission> (format version 1.1) gives no light"]);
    let other = "<coating><absorption><constant><uniform><value>0</value></uniform></constant></absorption><substrate_material_name>m</substrate_material_name></coating>";
    let coated = |kind: &str| {
        format!(
            "{CAMERA}{LIGHT}{}{}{}",
            material("m", GREY),
            material("c", kind),
            sphere.replace(">m<", ">c<")
        )
    };
    // A coat over what is diffuse is rendered.
    scene_with(&coated(other), &[]);
    let absorbs = other.replace("<value>0<", "<value>9<");
    scene_with(&coated(&absorbs), &["W0102 <absorption> of a <coating> without a <thickness> has no effect"]);
    let thick = "<thickness><constant>0.01</constant></thickness></coating>";
    scene_with(&coated(&absorbs.replace("</coating>", thick)), &[]);
    let film = other.replace("</coating>", "<interference>true</interference></coating>");
    scene_with(&coated(&film), &["W0102 <interference> of a <coating> over <diffuse> has no effect"]);
    let on_metal = |more: &str| {
        let metal = material("gold", "<phong><nk_data>au.nk</nk_data><exponent>100</exponent></phong>");
        coated(&film.replace(">m<", ">gold<").replace("</coating>", &format!("{more}</coating>"))) + &metal
    };
    scene_with(&on_metal("<thickness>2e-7</thickness>"), &[]);
    scene_with(
        &on_metal("<roughness>0.2</roughness>").replace("<value>0<", "<value>9<"),
        &[
            "W0102 <absorption> of a <coating> with <interference> has no effect",
            "W0102 <roughness> of a <coating> with <interference> has no effect",
            "W0102 <interference> of a <coating> without a <thickness> has no effect",
        ],
    );
    let double =
        coated(other) + &material("cc", &other.replace(">m<", ">c<")) + &sphere.replace(">m<", ">cc<");
    scene_with(
        &double,
        &["W0320 a <coating> (of version 3.0) is rendered over <diffuse>, and with <interference>"],
    );
    scene_with(
        &coated(
            "<fast_sss><albedo><constant><uniform><value>0.5</value></uniform></constant></albedo></fast_sss>",
        ),
        &["W0320 <fast_sss>"],
    );
}

/// Each material of a blend emits as much as its share.
#[test]
fn a_blend_shines_by_what_is_in_it() {
    let lit = |gain: &str| {
        let body = BODY.replace("1e-3", gain);
        GREY.replace("</diffuse>", &format!("<base_emission>{body}</base_emission></diffuse>"))
    };
    let blend = |share: &str, a: &str, b: &str| {
        format!("<blend><blend_factor>{share}</blend_factor><a_name>{a}</a_name><b_name>{b}</b_name></blend>")
    };
    let lights = |of_m: &str| {
        let parts = [("lit", lit("1e-3")), ("dark", GREY.to_owned()), ("deep", blend("0.5", "dark", "lit"))];
        let parts: String = parts.iter().map(|(name, kind)| material(name, kind)).collect();
        let scene = format!("{CAMERA}{SQUARE}{}{parts}<model>{PLACE}</model>", material("m", of_m));
        format!("{:?}", scene_with(&scene, &[]).lights)
    };
    assert_eq!(lights(&blend("0.5", "lit", "dark")), lights(&lit("0.5e-3")));
    assert_eq!(lights(&blend("0.5", "dark", "deep")), lights(&lit("0.25e-3")));
    assert_ne!(lights(&blend("0.5", "dark", "deep")), lights(&lit("0.5e-3")));
    let stepped = blend("0.5", "dark", "lit").replace("</blend>", "<step_blend>true</step_blend></blend>");
    assert_eq!(lights(&stepped), lights(&lit("1e-3")));
}
