//! Materials: blends and metals.

use super::common::*;

/// A sphere of a material.
fn sphere_of(material: &str) -> String {
    format!(
        "<sphere><center>0 0 0</center><radius>1</radius><material_name>{material}</material_name></sphere>"
    )
}

fn material(name: &str, kind: &str) -> String {
    format!("<material><name>{name}</name>{kind}</material>")
}

fn blend(a: &str, b: &str) -> String {
    format!("<blend><blend_factor>0.5</blend_factor><a_name>{a}</a_name><b_name>{b}</b_name></blend>")
}

const MATT: &str =
    "<diffuse><albedo_spectrum><uniform><value>0.5</value></uniform></albedo_spectrum></diffuse>";

#[test]
fn blends_of_what_cannot_be_blended() {
    let null = material("none", "<null_material/>");
    let glass = |name: &str, medium: &str| {
        material(name, &format!("<specular><internal_medium_name>{medium}</internal_medium_name></specular>"))
    };
    let frosted = |name: &str, medium: &str| {
        let kind = format!(
            "<glossy_transparent><internal_medium_name>{medium}</internal_medium_name><exponent>9</exponent></glossy_transparent>"
        );
        material(name, &kind)
    };
    let media = ["ice", "oil"]
        .map(|m| format!("<medium><name>{m}</name><basic><ior>1.3</ior></basic></medium>"))
        .concat();
    let line = |parts: &[String]| parts.concat();
    // Of itself, at once and by another.
    let own = line(&[material("m", &blend("white", "m")), sphere_of("m")]);
    expect_one(&own, "m</b_name>", "E0312");
    let round =
        line(&[material("m", &blend("n", "white")), material("n", &blend("white", "m")), sphere_of("m")]);
    expect_one(&round, "m</b_name>", "E0312");
    // Also where nothing uses them.
    let unused = line(&[material("m", &blend("n", "white")), material("n", &blend("white", "m"))]);
    expect_one(&unused, "m</b_name>", "E0312");
    // Two of delta kind, at any depth.
    let two = line(&[
        null.clone(),
        glass("g", "ice"),
        media.clone(),
        material("m", &blend("g", "none")),
        sphere_of("m"),
    ]);
    let deep = line(&[
        null.clone(),
        material("h", &blend("none", "white")),
        material("m", &blend("h", "none")),
        sphere_of("m"),
    ]);
    expect_one(
        &two.replace("<medium><name>oil</name><basic><ior>1.3</ior></basic></medium>", ""),
        "none</b_name>",
        "E0207",
    );
    expect_one(&deep, "none</b_name></blend></material><sphere>", "E0207");
    // Different media inside.
    let media_of = line(&[
        frosted("f", "ice"),
        frosted("h", "oil"),
        media,
        material("m", &blend("f", "h")),
        sphere_of("m"),
    ]);
    expect_one(&media_of, "h</b_name>", "E0207");
    // A name that is not there.
    let unknown = line(&[material("m", &blend("white", "nobody")), sphere_of("m")]);
    expect_one(&unknown, "nobody", "E0301");
    // One of delta kind is fine, and so is what many of them share.
    let fine = line(&[
        null,
        material("h", &blend("none", "white")),
        material("m", &blend("h", "white")),
        sphere_of("m"),
    ]);
    assert_eq!(found(&format!("{fine}\n{CAMERA}{MESH}")), Vec::<String>::new());
}

/// Longer than any thread's stack, by whichever constituent it goes on; and a tree that is as deep on both sides.
#[test]
fn blends_may_be_nested_to_any_depth() {
    let n = 20_000;
    let link = |i: usize| {
        let below = format!("m{}", i + 1);
        let [a, b] = if i.is_multiple_of(3) { ["white", &below] } else { [&*below, "white"] };
        material(&format!("m{i}"), &blend(a, b))
    };
    let chain: String = (0..n).map(link).collect();
    for leaf in [MATT, "<null_material/>"] {
        let scene = format!("{chain}{}{}\n{CAMERA}", material(&format!("m{n}"), leaf), sphere_of("m0"));
        assert_eq!(found(&scene), Vec::<String>::new());
    }
    let doubled =
        |i: usize| material(&format!("d{i}"), &blend(&format!("d{}", i + 1), &format!("d{}", i + 1)));
    let tree = (0..n).map(doubled).collect::<String>() + &material(&format!("d{n}"), MATT) + &sphere_of("d0");
    assert_eq!(found(&format!("{tree}\n{CAMERA}")), Vec::<String>::new());
}

/// However many blends lead to a round, and however many surfaces ask for it.
#[test]
fn a_round_within_many_blends_is_told_once() {
    let round = material("x", &blend("y", "white")) + &material("y", &blend("white", "x"));
    let users: String = (0..50)
        .map(|i| material(&format!("m{i}"), &blend("x", "y")) + &sphere_of(&format!("m{i}")))
        .collect();
    let said = said(&format!("{users}{round}{CAMERA}"));
    assert_eq!(said.len(), 1, "{said:?}");
}

/// However long the way round is.
#[test]
fn a_long_round_of_blends_is_told_as_one() {
    for n in [3, 199, 200, 201, 1000, 20_000] {
        let link = |i: usize| material(&format!("m{i}"), &blend(&format!("m{}", (i + 1) % n), "white"));
        let round = (0..n).map(link).collect::<String>() + &sphere_of("m0");
        let said = said(&format!("{round}{CAMERA}"));
        let [(message, Some(expected))] = &said[..] else { panic!("{n}: {said:?}") };
        assert!(message.contains("is made of itself") && message.len() < 120, "{message}");
        assert_eq!(expected, "expected a material that is made of others");
        assert_eq!(message.contains(" others, then "), n > 6, "{message}");
    }
}

/// A blend of a blend with itself doubles what it is made of, and any ray that looks through it asks all of that.
#[test]
fn doubled_blends_are_limited_where_they_may_be_unseen() {
    let medium = "<medium><name>ice</name><basic><ior>1.3</ior></basic></medium>";
    let doubled = |n: usize, of: &str| {
        let link = |i: usize| material(&format!("m{}", i + 1), &blend(&format!("m{i}"), &format!("m{i}")));
        of.to_owned() + &(0..n).map(link).collect::<String>() + &sphere_of(&format!("m{n}"))
    };
    let frosted = medium.to_owned()
        + &material(
            "m0",
            "<glossy_transparent><internal_medium_name>ice</internal_medium_name><exponent>9</exponent></glossy_transparent>",
        );
    assert_eq!(found(&format!("{}\n{CAMERA}", doubled(10, &frosted))), Vec::<String>::new());
    expect_one(&doubled(11, &frosted), "m10</b_name>", "E0207");
    // In time, too.
    expect_one(&doubled(150, &frosted), "m10</b_name>", "E0207");
    // What is opaque is asked nothing.
    let matt = material(
        "m0",
        "<diffuse><albedo_spectrum><uniform><value>0.5</value></uniform></albedo_spectrum></diffuse>",
    );
    assert_eq!(found(&format!("{}\n{CAMERA}", doubled(150, &matt))), Vec::<String>::new());
}

#[test]
fn metals_need_their_file() {
    let metal = |path: &str, more: &str| {
        let kind = format!("<phong><nk_data>{path}</nk_data><exponent>9</exponent>{more}</phong>");
        material("p", &kind) + &sphere_of("p")
    };
    expect_one(&metal("nowhere.nk", ""), "nowhere.nk", "E0302");
    expect_one(&metal("broken.obj", ""), "broken.obj", "E0303");
    // An empty path is none, so the coat needs its index.
    expect_one(&metal("", ""), "<phong>", "E0201");
    assert_eq!(found(&format!("{}\n{CAMERA}", metal("", "<ior>1.5</ior>"))), Vec::<String>::new());
}
