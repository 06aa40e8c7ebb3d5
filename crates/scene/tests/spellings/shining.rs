//! Materials that are made of others and emit by themselves.

use super::common::*;
use indigo_scene::Scene;

const BODY: &str = "<blackbody><temperature>3000</temperature><gain>1e-3</gain></blackbody>";

/// A scene whose triangle is of a kind of material on one half, and grey on the other.
fn of(kind: &str) -> String {
    format!("{CAMERA}{LIGHT}{MESH}{MODEL}{}{}", material("m", kind), material("n", GREY))
}

fn lights(elements: &str) -> String {
    format!("{:?}", scene_with(elements, &[]).lights)
}

/// Names of the groups of lights of a scene with two layers.
fn groups(elements: &str) -> Vec<String> {
    let layers =
        ["first", "second"].map(|name| format!("<layer_setting><name>{name}</name></layer_setting>"));
    let settings = format!("<renderer_settings>{}</renderer_settings>", layers.concat());
    let double = "W0103 <renderer_settings> is given more than once";
    let scene: Scene = scene_with(&(elements.to_owned() + &settings), &[double]);
    scene.picture.lights.0.iter().map(|group| group.name.clone()).collect()
}

/// Says that a kind of material with emission is the lamp that a diffuse surface is; `kind` makes it of that emission.
fn assert_shines(kind: &dyn Fn(&str) -> String) {
    let diffuse = |emission: &str| of(&GREY.replace("</diffuse>", &format!("{emission}</diffuse>")));
    let kind = |emission: &str| of(&kind(emission));
    let base = format!("<base_emission><constant>{BODY}</constant></base_emission>");
    let dimmer = "<emission><constant><rgb><rgb>0.5 0.5 0.5</rgb></rgb></constant></emission>";
    let map = "<emission><texture><path>a.bmp</path><exponent>1</exponent><b>2</b></texture></emission>";
    for emission in [base.clone(), format!("{base}{dimmer}"), format!("{base}{map}")] {
        assert_eq!(lights(&kind(&emission)), lights(&diffuse(&emission)), "{emission}");
        assert_ne!(lights(&kind(&emission)), lights(&kind("")), "{emission}");
    }
    let plain = format!("<base_emission>{BODY}</base_emission>");
    assert_same([&kind(&plain), &kind(&base), &kind(&format!("{base}{dimmer}"))]);
    // The triangle's light is of the layer that is named, beside the surroundings'.
    let layered = format!("{base}<layer>1</layer>");
    assert_eq!(groups(&kind(&layered)), ["first", "second"]);
    assert_eq!(groups(&kind(&base)), ["first"]);
}

#[test]
fn thin_sheets_shine_as_other_materials_do() {
    assert_shines(&|emission| {
        format!(
            "<double_sided_thin><front_material_name>n</front_material_name>{emission}</double_sided_thin>"
        )
    });
}

#[test]
fn coats_shine_by_themselves_or_by_what_is_below() {
    let coat = |below: &str, emission: &str| {
        format!("<coating><substrate_material_name>{below}</substrate_material_name>{emission}</coating>")
    };
    assert_shines(&|emission| coat("n", emission));
    let base =
        |value: u32| format!("<base_emission><uniform><value>{value}</value></uniform></base_emission>");
    let lit = material("lit", &GREY.replace("</diffuse>", &format!("{}</diffuse>", base(5))));
    let over = |emission: &str| of(&coat("lit", emission)) + &lit;
    let of_coat = |value| lights(&of(&coat("n", &base(value))));
    assert_eq!(lights(&over("")), of_coat(5));
    assert_eq!(lights(&over(&base(0))), of_coat(5));
    let both = scene_with(&over(&base(7)), &["W0319 lit gives no light: the coat over it shines by itself"]);
    assert_eq!(format!("{:?}", both.lights), of_coat(7));
}
