//! Surroundings in the form of a material.

use super::common::*;
use super::lights::{PLACE, SQUARE, background};

fn old_background(light: &str) -> String {
    format!("{CAMERA}{SQUARE}{}<model>{PLACE}</model>{light}", material("m", GREY))
}

#[test]
fn a_background_may_be_an_emitting_material() {
    let even = "<diffuse><albedo_spectrum><uniform><value>0</value></uniform></albedo_spectrum><base_emission><constant><uniform><value>5</value></uniform></constant></base_emission></diffuse>";
    let old =
        old_background("<background><spectrum><uniform><value>5</value></uniform></spectrum></background>");
    let other = background(&even.replace(">5<", ">6<"), "");
    assert_same([&old, &background(even, ""), &other]);
    let skylight = |sun: &str| {
        old_background(&format!(
            "<skylight><sundir>{sun}</sundir><turbidity>3</turbidity><model>preetham</model></skylight>"
        ))
    };
    let sunsky = "<sunsky><sundir>0 0.6 1</sundir><turbidity>3</turbidity><model>original</model></sunsky>";
    assert_same([&skylight("0 0.6 1"), &background(sunsky, ""), &skylight("0.1 0.6 1")]);
    let coloured = |gain: &str, base: &str| {
        let emission = format!("<emission><rgb><rgb>8 4 2</rgb><gain>{gain}</gain></rgb></emission>");
        background(&format!("<diffuse>{base}{emission}</diffuse>"), "")
    };
    let base = "<base_emission><uniform><value>8</value></uniform></base_emission>";
    assert_same([&coloured("8", ""), &coloured("1", base), &coloured("1", "")]);
    // A skylight may name them, too.
    let named = |model: &str| skylight("0 0.6 1").replace("preetham", model);
    assert_same([&skylight("0 0.6 1"), &named("original"), &named("hosek")]);
    scene_with(&named("captured-simulation"), &["W0320 the sky of <captured-simulation>"]);
    let captured = sunsky.replace("original", "captured-simulation");
    scene_with(
        &background(&captured, ""),
        &["W0320 the sky of <captured-simulation> (of version 3.0) is not rendered"],
    );
    let sum = |names: [&str; 2]| {
        let mats = names.map(|name| format!("<mat><mat_name>{name}</mat_name><weight>1</weight></mat>"));
        background(&format!("<sum>{}</sum>", mats.concat()), "")
    };
    let both = "<skylight><sundir>0 0.6 1</sundir><turbidity>3</turbidity><model>preetham</model></skylight>";
    let old = dump(&scene_with(
        &old_background(&format!(
            "{both}<background><spectrum><uniform><value>5</value></uniform></spectrum></background>"
        )),
        &[],
    ));
    // In the other order, since their order is that of the lights.
    assert_eq!(old, dump(&scene_with(&sum(["even", "sky"]), &[])));
    // Weights are factors of the sun and of the sky, of which 0 leaves nothing.
    let outside = sunsky.replace("<model>", "<extra_atmospheric>true</extra_atmospheric><model>");
    let of_hosek = &["W0320 the sky of <captured-simulation>"][..];
    for (sky, told) in [(sunsky, &[][..]), (&captured, of_hosek), (&outside, &[])] {
        let radiance = |weight: &str, told: &[&str]| {
            let mat = format!("<sum><mat><mat_name>the sky</mat_name><weight>{weight}</weight></mat></sum>");
            let named = format!("<material><name>the sky</name>{sky}</material>");
            let scene = scene_with(&(named + &background(&mat, "")), told);
            let lambda = indigo_spectrum::SampledWavelengths::sample(0.4);
            [[0.0, 0.6, 1.0], [0.0, -0.6, 1.0]].map(|[x, y, z]| {
                let towards = indigo_math::Vec3::new(x, y, z).normalized();
                scene.lights.environment(towards, &lambda).map_or(0.0, |radiance| radiance.0[0])
            })
        };
        let [full, quarter] = ["1", "0.25"].map(|weight| radiance(weight, told));
        assert!(full[0] > 0.0 && full.iter().zip(quarter).all(|(a, b)| (b - 0.25 * a).abs() <= 1e-5 * a));
        let dark = [told, &["W0306 the scene has no light"]].concat();
        assert_eq!(radiance("0", &dark), [0.0; 2]);
    }
}

#[test]
fn surroundings_may_be_a_texture_that_is_turned_and_scaled() {
    let map = |more: &str, texture: &str| {
        background(
            &format!(
                "<diffuse><texture><path>sky.hdr</path><exponent>1</exponent>{texture}</texture><base_emission><constant><uniform><value>3</value></uniform></constant></base_emission><emission><texture><texture_index>0</texture_index></texture></emission></diffuse>"
            ),
            more,
        )
    };
    let old = |gain: &str| {
        old_background(&format!(
            "<env_map><latlong><path>sky.hdr</path><gain>{gain}</gain></latlong></env_map>"
        ))
    };
    assert_same([&old("3"), &map("", ""), &old("2")]);
    assert_same([&old("6"), &map("", "<b>2</b>"), &old("2")]);
    let turned = |axis: &str, angle: f64| {
        map(
            "",
            &format!(
                "<tex_coord_generation><spherical><rotation><axis_rotation><axis>{axis}</axis><angle>{angle}</angle></axis_rotation></rotation></spherical></tex_coord_generation>"
            ),
        )
    };
    assert_same([&turned("0 0 2", 0.5), &turned("0 0 -1", -0.5), &old("3")]);
    scene_with(&turned("1 0 0", 0.5), &["W0320 surroundings are turned about the z axis alone"]);
    // To a luminance: that of the mean of all directions.
    let scale = "<emission_scale><material_name>background</material_name><measure>luminance</measure><value>100</value></emission_scale>";
    let even = "<diffuse><base_emission><uniform><value>5</value></uniform></base_emission></diffuse>";
    let radiance = surroundings(&scene_with(&background(even, scale), &[]));
    let of_another = scale.replace(">background<", ">even<");
    let told = ["W0321 <emission_scale> has no effect: the background's material is not even"];
    assert_eq!(surroundings(&scene_with(&background(even, &of_another), &told)), 5.0);
    let unit = indigo_spectrum::Spectrum::uniform(1.0).luminance();
    assert!((radiance * unit / 100.0 - 1.0).abs() < 1e-6, "{radiance}");
    let lit = scene_with(&map(scale, ""), &[]);
    let lit_twice = scene_with(&map(&scale.replace("100", "200"), ""), &[]);
    assert!((surroundings(&lit_twice) / surroundings(&lit) - 2.0).abs() < 1e-5);
}
