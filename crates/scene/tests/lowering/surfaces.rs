//! Surfaces: what of a material or a mesh has no effect, or another one than it seems.

use super::common::*;

const SPHERE: &str =
    "<sphere><center>0 0 0</center><radius>1</radius><material_name>m</material_name></sphere>";

fn of(kind: &str) -> String {
    format!("<material><name>m</name>{kind}</material>{SPHERE}")
}

#[test]
fn a_roughness_counts_before_an_exponent() {
    let medium = "<medium><name>g</name><basic><ior>1.5</ior></basic></medium>";
    for kind in [
        "<phong><ior>1.5</ior><exponent>50</exponent><roughness>0.1</roughness></phong>",
        "<glossy_transparent><internal_medium_name>g</internal_medium_name><exponent>50</exponent><roughness>0.1</roughness></glossy_transparent>",
    ] {
        expect_one(&format!("{}{medium}", of(kind)), "50", "W0103");
        for single in ["<exponent>50</exponent>", "<roughness>0.1</roughness>"] {
            assert!(found(&format!("{}{medium}{CAMERA}", of(&kind.replace(single, "")))).is_empty());
        }
    }
}

#[test]
fn the_colour_of_a_ground_is_not_negative() {
    let phong = |colour: &str| {
        of(&format!("<phong><ior>1.5</ior><exponent>9</exponent><diffuse>{colour}</diffuse></phong>"))
    };
    let [bad, sound] = ["0.5 -1 0.5", "0.5 0 0.5"].map(|colour| found(&format!("{}{CAMERA}", phong(colour))));
    assert_eq!(bad.iter().filter(|f| f.ends_with("E0203")).count(), 1, "{bad:?}");
    assert!(sound.iter().all(|f| f.ends_with("W0104")), "{sound:?}");
}

#[test]
fn maps_of_fractions_are_told_where_they_are_none() {
    let curve = |b: &str, c: &str| format!("<path>grey.png</path><exponent>1</exponent><b>{b}</b><c>{c}</c>");
    let albedo = |b: &str, c: &str| {
        of(&format!("<diffuse><albedo_texture>{}</albedo_texture></diffuse>", curve(b, c)))
    };
    let blend = |b: &str, c: &str| {
        of(&format!(
            "<blend><a_name>white</a_name><b_name>white</b_name><blend_map>{}</blend_map></blend>",
            curve(b, c)
        ))
    };
    // The texels are 188 of 255.
    for (b, c) in [("3", "0"), ("1", "-0.8")] {
        expect_one(&albedo(b, c), "<albedo_texture>", "W0328");
        expect_one(&blend(b, c), "<blend_map>", "W0328");
    }
    for (b, c) in [("1", "0"), ("1.3", "0"), ("-1", "1")] {
        assert!(found(&format!("{}{CAMERA}", albedo(b, c))).is_empty());
        assert!(found(&format!("{}{CAMERA}", blend(b, c))).is_empty());
    }
}

#[test]
fn a_uv_set_has_a_name() {
    let texture =
        "<diffuse><albedo_texture><uv_set></uv_set><path>grey.png</path></albedo_texture></diffuse>";
    expect_one(&of(texture), "<uv_set>", "E0202");
}

/// Light crosses the boundary of a medium once in and once out.
#[test]
fn the_surface_of_a_medium_is_closed() {
    let medium = "<medium><name>g</name><basic><ior>1.5</ior></basic></medium>";
    let glass = "<material><name>m</name><specular><internal_medium_name>g</internal_medium_name></specular></material>";
    let mesh = |material: &str, sides: &[&str]| {
        let sides = sides.join("</tri><tri>");
        format!(
            "{glass}{medium}<model><pos>0 0 0</pos><scale>1</scale><mesh_name>body</mesh_name></model><mesh><name>body</name><embedded><vertex pos=\"0 0 0\"/><vertex pos=\"1 0 0\"/><vertex pos=\"0 1 0\"/><vertex pos=\"0 0 1\"/><triangle_set><material_name>{material}</material_name><tri>{sides}</tri></triangle_set></embedded></mesh>"
        )
    };
    let sides = ["0 2 1", "0 1 3", "1 2 3", "2 0 3"];
    assert!(found(&format!("{}{CAMERA}", mesh("m", &sides))).is_empty());
    expect_one(&mesh("m", &sides[..3]), "body</mesh_name>", "W0329");
    assert!(found(&format!("{}{CAMERA}", mesh("white", &sides[..3]))).is_empty());
    // What has no area is left out and told, and hides no hole.
    let codes = |sides: &[&str]| {
        let loaded = loaded(&format!("{HEAD}{}{CAMERA}</scene>", mesh("m", sides)));
        let codes: Vec<&str> = loaded.sink.diagnostics().iter().map(|d| d.code).collect();
        codes
    };
    let edge = "0 1 1";
    assert_eq!(codes(&[&sides[..], &[edge]].concat()), ["W0303"]);
    assert_eq!(codes(&[&sides[..3], &[edge]].concat()), ["W0303", "W0329"]);
}

/// It is not the one that fills the scene.
#[test]
fn a_medium_named_air_is_told() {
    let glass = of("<specular><internal_medium_name>air</internal_medium_name></specular>");
    assert!(found(&format!("{glass}{CAMERA}")).is_empty());
    let air = "<medium><name>air</name><basic><ior>1.2</ior></basic></medium>";
    expect_one(&format!("{glass}{air}"), "air</name>", "W0302");
}
