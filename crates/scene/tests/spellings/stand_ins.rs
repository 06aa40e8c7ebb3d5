//! What stands in for kinds of later versions, in the scene and where it is written anew.

use super::common::*;
use indigo_decl::{Alternatives, Block, Kind};
use indigo_scene::schema::SCENE;

/// The names of all blocks with kinds of later versions, and those kinds.
#[derive(Default)]
struct Choices {
    seen: Vec<&'static str>,
    found: Vec<(&'static str, &'static Alternatives)>,
}

impl Choices {
    fn add_all(&mut self, block: &'static Block) {
        if self.seen.contains(&block.doc) {
            return;
        }
        self.seen.push(block.doc);
        for field in block.fields {
            match field.kind {
                Kind::OneOf(alternatives) => self.add(field.name, alternatives),
                Kind::Block(inner) => self.add_all(inner),
                _ => {}
            }
        }
        if let Some(alternatives) = &block.alternatives {
            self.add(block.name, alternatives);
        }
    }

    fn add(&mut self, name: &'static str, alternatives: &'static Alternatives) {
        if !alternatives.later.is_empty() {
            self.found.push((name, alternatives));
        }
        alternatives.blocks.iter().for_each(|block| self.add_all(block));
    }
}

/// A scene with a later kind of something.
fn with(what: &str, kind: &str) -> String {
    let rest = format!("{CAMERA}{LIGHT}{MESH}{MODEL}{}", material("n", GREY));
    let grey = material("m", GREY);
    match what {
        "material" => rest + &material("m", kind),
        "medium" => {
            let glass = "<specular><internal_medium_name>glass</internal_medium_name></specular>";
            format!("{rest}{}<medium><name>glass</name>{kind}</medium>", material("m", glass))
        }
        "tonemapping" => format!("{rest}{grey}<tonemapping>{kind}</tonemapping>"),
        "splat_filter" | "downsize_filter" => {
            format!("{rest}{grey}<renderer_settings><{what}>{kind}</{what}></renderer_settings>")
        }
        _ => panic!("no scene for <{what}>"),
    }
}

#[test]
fn what_stands_in_is_written_where_a_scene_is_written_anew() {
    let mut choices = Choices::default();
    choices.add_all(&SCENE);
    let names: Vec<&str> = choices.found.iter().map(|(name, _)| *name).collect();
    assert!(
        ["material", "medium", "tonemapping", "splat_filter"].iter().all(|n| names.contains(n)),
        "{names:?}"
    );
    let told = ["W0102", "W0103 <tonemapping>", "W0103 <renderer_settings>", "W0329"];
    for (what, alternatives) in choices.found {
        for later in alternatives.later {
            let elements = with(what, &format!("<{}/>", later.name));
            let said = findings(&loaded(&elements));
            let named = format!("W0102 <{}> is of a later format version ({})", later.name, later.since);
            assert!(said.iter().any(|(_, said)| said.starts_with(&named)), "{said:?}");
            let [scene, anew] = [loaded(&elements), canonical(&elements, &told)]
                .map(|loaded| loaded.scene.expect("a scene without errors"));
            assert_eq!(dump(&scene), dump(&anew), "<{}> in <{what}>", later.name);
            assert_eq!(format!("{:?}", scene.picture), format!("{:?}", anew.picture), "<{}>", later.name);
        }
    }
}

#[test]
fn versions_are_named_of_what_is_not_rendered() {
    let specular = |more: &str| {
        with(
            "material",
            &format!("<specular><internal_medium_name>air</internal_medium_name>{more}</specular>"),
        )
    };
    let absorbs = "<absorption_layer_transmittance><constant><uniform><value>0.5</value></uniform></constant></absorption_layer_transmittance>";
    let warning = "W0102 <absorption_layer_transmittance> in <specular> is of a later format version (3.0)";
    assert_eq!(dump(&scene_with(&specular(absorbs), &[warning])), dump(&scene_with(&specular(""), &[])));
    let sum = with("material", "<sum><mat><mat_name>n</mat_name><weight>1</weight></mat></sum>");
    scene_with(&sum, &["W0320 <sum> is of a later format version (4.0) and not rendered: n stands in"]);
    for (more, told) in [
        (
            "<texture><path>a.bmp</path><exponent>1</exponent></texture>",
            "W0103 <texture> is given more than once in <albedo>",
        ),
        ("<constant>0.5</constant>", "W0103 <constant> in <albedo> has no effect beside <texture>"),
        ("<shader>x</shader>", "W0103 <shader> in <albedo> has no effect beside <texture>"),
        ("<foo/>", "W0103 <foo> in <albedo> has no effect beside <texture>"),
        ("words", "W0106 text inside <albedo> is ignored"),
    ] {
        let albedo = |more: &str| {
            let map = "<texture><path>a.bmp</path><exponent>1</exponent><b>0.5</b></texture>";
            with("material", &format!("<diffuse><albedo>{more}{map}</albedo></diffuse>"))
        };
        assert_eq!(dump(&scene_with(&albedo(more), &[told])), dump(&scene_with(&albedo(""), &[])));
    }
    for (more, told) in [
        ("<b>0.001</b>", "W0103 <b> in <texture> has no effect beside <texture_index>"),
        ("<texture_index>7</texture_index>", "W0103 <texture_index> is given more than once in <texture>"),
    ] {
        let albedo = |more: &str| {
            let map = "<texture><path>a.bmp</path><exponent>1</exponent><b>0.5</b></texture>";
            let named = format!("<texture>{more}<texture_index>0</texture_index></texture>");
            with("material", &format!("<diffuse>{map}<albedo>{named}</albedo></diffuse>"))
        };
        assert_eq!(dump(&scene_with(&albedo(more), &[told])), dump(&scene_with(&albedo(""), &[])));
    }
    let empty = findings(&loaded(&with("material", "<sum></sum>")));
    assert!(empty[0].1.starts_with("E0201 <sum> has none of <mat>"), "{empty:?}");
    let sunsky = with("material", "<sunsky><sundir>0 0.6 1</sundir></sunsky>");
    scene_with(&sunsky, &["W0320 <sunsky> (of version 3.0) is rendered as a background alone"]);
}

#[test]
fn a_picture_of_the_surroundings_has_a_stand_in() {
    let background = |path: &str| {
        format!(
            "{CAMERA}<background_settings><background_material><material><name>b</name><diffuse><emission><texture><path>{path}</path><exponent>1</exponent></texture></emission></diffuse></material></background_material></background_settings>"
        )
    };
    let settings = "<renderer_settings><placeholders>true</placeholders></renderer_settings>";
    let double = "W0103 <renderer_settings> is given more than once";
    let missing = "W0326 cannot read none.hdr";
    let scene = scene_with(&(background("none.hdr") + settings), &[double, missing]);
    assert!(surroundings(&scene) > 0.0);
    let map = "<env_map><latlong><path>none.hdr</path><gain>1</gain></latlong></env_map>";
    let scene = scene_with(&format!("{CAMERA}{map}{settings}"), &[double, missing]);
    assert!(surroundings(&scene) > 0.0);
    let found = findings(&loaded(&background("none.hdr")));
    assert!(found[0].1.starts_with("E0302"), "{found:?}");
}

#[test]
fn a_background_of_other_materials_is_told_to_be_dark() {
    let shines = "<diffuse><base_emission><uniform><value>5</value></uniform></base_emission></diffuse>";
    let blend = "<blend><blend_factor>0.5</blend_factor><a_name>m</a_name><b_name>n</b_name></blend>";
    let scene = format!(
        "{CAMERA}{}{}<background_settings><background_material><material><name>b</name>{blend}</material></background_material></background_settings>",
        material("m", shines),
        material("n", GREY)
    );
    scene_with(&scene, &["W0319 as a background a <blend> gives no light but its own", "W0306"]);
}
