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
