//! Things that share a name, a material or a parameter: each is what is meant, or it is told.

use super::common::*;
use indigo_diag::Severity;

const EMISSION: &str =
    "<base_emission><blackbody><temperature>3000</temperature><gain>1e-3</gain></blackbody></base_emission>";

fn lit() -> String {
    GREY.replace("</diffuse>", &format!("{EMISSION}</diffuse>"))
}

/// The triangles in the scene, with more in their model.
fn model(more: &str) -> String {
    MODEL.replace("</model>", &format!("{more}</model>"))
}

fn listed(materials: &[&str]) -> String {
    let names = materials.iter().map(|name| format!("<material_name>{name}</material_name>"));
    format!("<materials>{}</materials>", names.collect::<String>())
}

fn scale_of(material: &str) -> String {
    format!(
        "<emission_scale><material_name>{material}</material_name><measure>luminous_flux</measure><value>800</value></emission_scale>"
    )
}

fn profile_of(material: &str) -> String {
    format!("<ies_profile><material_name>{material}</material_name><path>lamp.ies</path></ies_profile>")
}

#[test]
fn several_slots_of_one_material_are_one_lamp() {
    let third = "<triangle_set><material_name>k</material_name><tri>0 1 3</tri></triangle_set></embedded>";
    let three = MESH.replace("</embedded>", third);
    let materials = material("m", &lit()) + &material("n", GREY) + &material("k", GREY);
    let lights = |mesh: &str, list: &[&str], more: &str| {
        let model = model(&(listed(list) + more));
        format!("{:?}", scene_with(&format!("{CAMERA}{mesh}{model}{materials}"), &[]).lights)
    };
    for more in [scale_of("m"), profile_of("m"), String::new()] {
        for (mesh, list) in [(MESH, &["m", "m"][..]), (&three, &["m", "m", "k"])] {
            // The same with both triangles in one slot.
            let merged = mesh.replace("<material_name>n<", "<material_name>m<");
            let one = lights(&merged, &list[1..], &more);
            assert_eq!(lights(mesh, list, &more), one, "{list:?} {more}");
        }
    }
}

#[test]
fn what_a_scale_or_profile_is_of_may_be_on_no_triangle() {
    let all = material("m", &lit()) + &material("n", GREY) + &material("k", &lit());
    let of = |more: &str| format!("{CAMERA}{LIGHT}{MESH}{}{all}", model(more));
    for (field, more) in [("emission_scale", scale_of("k")), ("ies_profile", profile_of("k"))] {
        let warning = format!("W0321 <{field}> has no effect: k is on no triangle of this model");
        assert_eq!(dump(&scene_with(&of(&more), &[&warning])), dump(&scene_with(&of(""), &[])));
    }
    for more in [scale_of("kk"), profile_of("kk")] {
        let found = findings(&loaded(&of(&more)));
        let [(Severity::Error, only)] = &found[..] else { panic!("{found:?}") };
        assert!(only.starts_with("E0301 there is no material named kk"), "{only}");
    }
}

#[test]
fn a_uid_means_its_own_element_though_another_has_its_name() {
    let of = |name: &str, uid: u32, albedo: &str| {
        let kind = GREY.replace("0.25", albedo);
        format!("<material><uid>{uid}</uid><name>{name}</name>{kind}</material>")
    };
    let scene = |second: &str, uids: [u32; 2]| {
        let uids = uids.map(|uid| format!("<material_uid>{uid}</material_uid>")).concat();
        let model = model(&format!("<materials>{uids}</materials>"));
        format!("{CAMERA}{LIGHT}{MESH}{model}{}{}", of("m", 1, "0.1"), of(second, 2, "0.6"))
            + &material("n", GREY).replace(">n<", if second == "n" { ">x<" } else { ">n<" })
    };
    let told = ["W0302 material m is defined more than once"];
    let apart = format!("{:?}", scene_with(&scene("n", [1, 2]), &[]).materials());
    let alike = scene("m", [1, 2]);
    assert_eq!(format!("{:?}", scene_with(&alike, &told).materials()), apart);
    assert_same_told(&told, [&alike, &alike, &scene("m", [2, 1])]);
}

#[test]
fn what_is_repeated_word_for_word_is_not_told() {
    let scene = |second: &str| {
        format!("{CAMERA}{LIGHT}{MESH}{MODEL}{}{second}{}", material("m", GREY), material("n", GREY))
    };
    let again = material("m", &GREY.replace("0.25", "0.250"));
    assert_same([&scene(""), &scene(&again), &scene("").replace("0.25", "0.3")]);
    scene_with(&scene(&again.replace("0.250", "0.3")), &["W0302 material m is defined more than once"]);
}

#[test]
fn meshes_and_media_of_one_name_are_told_apart_by_uid() {
    let both = material("m", GREY) + &material("n", GREY);
    let moved = MESH.replace("<uid>7<", "<uid>8<").replace("pos=\"0 0 0\"", "pos=\"0 0 5\"");
    let scene = |uid: u32| {
        let model =
            MODEL.replace("<mesh_name>tri</mesh_name>", &format!("<geometry_uid>{uid}</geometry_uid>"));
        let model = model.replace("model>", "model2>");
        dump(&scene_with(
            &format!("{CAMERA}{LIGHT}{both}{MESH}{moved}{model}"),
            &["W0302 mesh tri is defined more than once"],
        ))
    };
    assert_ne!(scene(7), scene(8));
    let medium = |name: &str, uid: u32, ior: f64| {
        format!("<medium><name>{name}</name><uid>{uid}</uid><basic><ior>{ior}</ior></basic></medium>")
    };
    let glass = |media: &str| {
        let kind = "<specular><internal_medium_uid>6</internal_medium_uid></specular>";
        let glass = material("m", kind) + &material("n", GREY);
        loaded(&format!("{CAMERA}{LIGHT}{MESH}{MODEL}{glass}{media}"))
    };
    let [apart, alike] =
        ["b", "a"].map(|name| glass(&(medium("a", 6, 1.7) + &medium(name, 7, 1.3))).scene.expect("a scene"));
    assert_eq!(format!("{:?}", alike.media), format!("{:?}", apart.media));
    let twice = findings(&glass(&(medium("a", 6, 1.7) + &medium("b", 6, 1.3))));
    assert!(
        twice.iter().any(|(_, said)| said.starts_with("W0302 uid 6 is of more than one medium")),
        "{twice:?}"
    );
}

#[test]
fn two_forms_of_one_parameter_are_told() {
    let constant = "<constant><uniform><value>0.5</value></uniform></constant>";
    let texture = "<texture><path>a.bmp</path></texture>";
    let of = |albedo: &str, warnings: &[&str]| {
        let both = material("m", &format!("<diffuse>{albedo}</diffuse>")) + &material("n", GREY);
        dump(&scene_with(&format!("{CAMERA}{LIGHT}{MESH}{MODEL}{both}"), warnings))
    };
    let form = |inside: &str| format!("<albedo>{inside}</albedo>");
    let twice = "W0103 <albedo> is given more than once in <diffuse>; the last one counts";
    for (first, last) in [(constant, texture), (texture, constant)] {
        assert_eq!(of(&(form(first) + &form(last)), &[twice]), of(&form(last), &[]));
    }
    let beside = "W0103 <constant> in <albedo> has no effect beside <texture>";
    for inside in [format!("{constant}{texture}"), format!("{texture}{constant}")] {
        assert_eq!(of(&form(&inside), &[beside]), of(&form(texture), &[]));
    }
}

#[test]
fn a_place_beside_keyframes_is_told() {
    let both = material("m", GREY) + &material("n", GREY);
    let keyed = |pos: &str, warnings: &[&str]| {
        let model = format!(
            "<model>{pos}<keyframe><time>0</time><pos>1 2 3</pos></keyframe><scale>0.5</scale><mesh_name>tri</mesh_name></model>"
        );
        dump(&scene_with(&format!("{CAMERA}{LIGHT}{MESH}{model}{both}"), warnings))
    };
    let told = keyed("<pos>9 9 9</pos>", &["W0103 <pos> of the model has no effect beside <keyframe>"]);
    assert_eq!(told, keyed("", &[]));
}
