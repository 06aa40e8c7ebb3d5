//! Materials: `constant`, `texture`, lists of textures, new names, uids.

use super::common::*;
use indigo_scene::Scene;

/// A scene with a material `m` of a kind.
fn of(kind: &str) -> String {
    of_material(&material("m", kind))
}

fn of_material(materials: &str) -> String {
    format!("{CAMERA}{LIGHT}{MESH}{MODEL}{}{materials}", material("n", GREY))
}

#[track_caller]
fn assert_same_kinds(kinds: [&str; 3]) {
    let [old, new, other] = kinds.map(of);
    assert_same([&old, &new, &other]);
}

/// What is told of the triangle where it is the surface of a medium.
const NOT_CLOSED: [&str; 1] = ["W0329"];

const TX: &str = "<uv_set>albedo</uv_set><path>a.bmp</path><exponent>2.2</exponent><b>0.9</b>";
const BUMP_TX: &str = "<uv_set>other</uv_set><path>b.bmp</path><exponent>1</exponent><b>0.001</b>";

#[test]
fn a_constant_may_stand_in_a_wrapper_under_the_new_name() {
    let spectrum = "<rgb><rgb>0.2 0.4 0.6</rgb><gamma>2.2</gamma></rgb>";
    for (kind, old, new) in [
        ("diffuse", "albedo_spectrum", "albedo"),
        ("diffuse_transmitter", "albedo_spectrum", "albedo"),
        ("oren_nayar", "albedo_spectrum", "albedo"),
        ("phong", "diffuse_albedo_spectrum", "diffuse_albedo"),
        ("phong", "specular_reflectivity_spectrum", "specular_reflectivity"),
    ] {
        let rest = match (kind, new) {
            ("oren_nayar", _) => "<sigma><constant>0.3</constant></sigma>",
            (_, "diffuse_albedo") => "<ior>1.5</ior><exponent><constant>90</constant></exponent>",
            ("phong", _) => "<exponent>90</exponent>",
            _ => "",
        };
        let plain = rest.replace("<constant>", "").replace("</constant>", "");
        assert_same_kinds([
            &format!("<{kind}><{old}>{spectrum}</{old}>{plain}</{kind}>"),
            &format!("<{kind}><{new}><constant>{spectrum}</constant></{new}>{rest}</{kind}>"),
            &format!(
                "<{kind}><{new}><constant><uniform><value>0.3</value></uniform></constant></{new}>{rest}</{kind}>"
            ),
        ]);
    }
}

#[test]
fn textures_are_named_by_their_number_in_the_list_or_stand_in_their_place() {
    let old = format!(
        "<phong><ior>1.5</ior><albedo_texture>{TX}</albedo_texture><exponent_map>{BUMP_TX}</exponent_map><bump_map>{BUMP_TX}</bump_map></phong>"
    );
    let list = |first: &str, second: &str| {
        // One of the list comes after its user, as exporters write.
        format!(
            "<phong><texture>{first}</texture><ior>1.5</ior><diffuse_albedo><texture><texture_index>0</texture_index></texture></diffuse_albedo><exponent><texture><texture_index>1</texture_index></texture></exponent><bump><texture><texture_index>1</texture_index></texture></bump><texture>{second}</texture></phong>"
        )
    };
    let inline = format!(
        "<phong><ior>1.5</ior><diffuse_albedo><texture>{TX}</texture></diffuse_albedo><exponent><texture>{BUMP_TX}</texture></exponent><bump><texture>{BUMP_TX}</texture></bump></phong>"
    );
    let swapped = list(BUMP_TX, TX);
    assert_same_kinds([&old, &list(TX, BUMP_TX), &swapped]);
    assert_same_kinds([&old, &inline, &swapped]);
    // A number that the list does not reach.
    let beyond = "<diffuse><texture><path>a.bmp</path></texture><albedo><texture><texture_index>1</texture_index></texture></albedo></diffuse>";
    let found = findings(&loaded(&of(beyond)));
    assert!(found.iter().any(|(_, text)| text.starts_with("E0203 <texture_index>")), "{found:?}");
}

/// Those of the mesh by a matrix and a translation: a map that is turned, on a material and on a lamp.
#[test]
fn texture_coordinates_may_be_transformed() {
    let textured = |uv: &str| {
        let generation = format!("<tex_coord_generation>{uv}</tex_coord_generation>");
        format!(
            "<diffuse><albedo_texture><uv_set>albedo</uv_set><path>a.bmp</path>{generation}</albedo_texture></diffuse>"
        )
    };
    let mapped = |matrix: &str, translation: &str| {
        textured(&format!("<uv><matrix>{matrix}</matrix><translation>{translation}</translation></uv>"))
    };
    let turned = mapped("0 -0.5 0.25 0.125", "0.5 0.25");
    for same in ["", "<uv/>", "<uv><matrix>1 0 0 1</matrix></uv>", "<uv><translation>0 0</translation></uv>"]
    {
        assert_same_kinds([&textured(""), &textured(same), &turned]);
    }
    let [plain, turned] = [textured(""), turned].map(|kind| scene_with(&of(&kind), &[]));
    let at =
        |scene: &Scene, u: f32, v: f32| scene.textures[0].rgb([u, v].map(indigo_math::Real::from).into());
    assert_eq!(at(&turned, 0.5, 0.25), at(&plain, 0.375, 0.40625));
    assert_ne!(at(&turned, 0.5, 0.25), at(&plain, 0.5, 0.25));
    // A lamp whose map is moved by half is one whose mesh has its coordinates there.
    let lamp = |mesh: &str, uv: &str| {
        let map = format!(
            "<texture><uv_set>albedo</uv_set><path>a.bmp</path><tex_coord_generation>{uv}</tex_coord_generation></texture>"
        );
        let spectrum = "<spectrum><uniform><value>5</value></uniform></spectrum>";
        let light = format!(
            "<meshlight><pos>1 2 3</pos><scale>1</scale><mesh_name>tri</mesh_name>{spectrum}{map}</meshlight>"
        );
        scene_with(&format!("{CAMERA}{mesh}{light}{}{}", material("m", GREY), material("n", GREY)), &[])
    };
    let moved = MESH.replace("uv0=\"0 ", "uv0=\"0.5 ").replace("uv0=\"1 ", "uv0=\"1.5 ");
    let move_by_half = "<uv><translation>0.5 0</translation></uv>";
    let lights = |scene: Scene| format!("{:?}", scene.lights);
    assert_eq!(lights(lamp(MESH, move_by_half)), lights(lamp(&moved, "")));
    assert_ne!(lights(lamp(MESH, move_by_half)), lights(lamp(MESH, "")));
}

#[test]
fn texture_coordinates_that_are_not_rendered_or_not_sound_are_told() {
    let textured = |generation: &str| {
        let map = format!("<path>a.bmp</path><tex_coord_generation>{generation}</tex_coord_generation>");
        of(&format!("<diffuse><albedo_texture>{map}</albedo_texture></diffuse>"))
    };
    scene_with(&textured("<spherical/>"), &["W0320 <spherical> coordinates"]);
    for (uv, message) in [
        ("<matrix>1 0 0</matrix>", "E0202 a matrix of 3 numbers"),
        ("<translation>1 0 0</translation>", "E0202 a translation of 3 numbers"),
    ] {
        let found = findings(&loaded(&textured(&format!("<uv>{uv}</uv>"))));
        assert!(found.len() == 1 && found[0].1.starts_with(message), "{found:?}");
    }
}

#[test]
fn uv_sets_go_by_number_or_are_the_first() {
    let textured =
        |set: &str| format!("<diffuse><albedo_texture>{set}<path>a.bmp</path></albedo_texture></diffuse>");
    let [first, second] = ["albedo", "other"].map(|name| textured(&format!("<uv_set>{name}</uv_set>")));
    assert_same_kinds([&second, &textured("<uv_set_index>1</uv_set_index>"), &first]);
    assert_same_kinds([&first, &textured(""), &second]);
    let found = findings(&loaded(&of(&textured("<uv_set_index>2</uv_set_index>"))));
    assert!(found[0].1.starts_with("E0307"), "{found:?}");
}

/// A mesh's text without its texture coordinates.
fn without_attributes(text: &str) -> String {
    let mut parts = text.split(" no");
    let first = parts.next().unwrap_or_default().to_owned();
    // Of `0="0 1"...` what follows the second quotation mark.
    parts.fold(first, |all, part| all + part.splitn(3, '"').nth(2).unwrap_or_default())
}

/// Exporters give objects that were never unwrapped no set at all.
#[test]
fn a_map_without_coordinates_is_told_and_shows_one_texel() {
    let textured =
        |set: &str| format!("<diffuse><albedo_texture>{set}<path>a.bmp</path></albedo_texture></diffuse>");
    let bare = |set: &str| {
        let (head, rest) = MESH.split_once("<expose_uv_set>").expect("sets");
        let (_, vertices) = rest.rsplit_once("</expose_uv_set>").expect("sets");
        let vertices = vertices.replace(" uv0", " no0").replace(" uv1", " no1");
        let [mesh, bare] = [MESH.to_owned(), format!("{head}{}", without_attributes(&vertices))];
        of(&textured(set)).replace(&mesh, &bare)
    };
    let told = ["W0331 a mesh of this material has no texture coordinates"];
    scene_with(&bare(""), &told);
    scene_with(&bare("<uv_set_index>0</uv_set_index>"), &told);
    for named in ["<uv_set>other</uv_set>", "<uv_set_index>1</uv_set_index>"] {
        let found = findings(&loaded(&bare(named)));
        assert!(found[0].1.starts_with("E0307"), "{found:?}");
    }
}

#[test]
fn roughness_is_the_width_that_an_exponent_stands_for() {
    // √(2 / (n + 2)) of 6 is a half.
    let phong = |gloss: &str| format!("<phong><ior>1.5</ior>{gloss}</phong>");
    let [old, other] = [6, 7].map(|n| phong(&format!("<exponent>{n}</exponent>")));
    assert_same_kinds([&old, &phong("<roughness><constant>0.5</constant></roughness>"), &other]);
    // It counts before an exponent, which is told.
    let both = phong("<exponent>100</exponent><roughness>0.5</roughness>");
    let told = ["W0103 <exponent> has no effect beside <roughness>"];
    let [old, both, other] = [old, both, other].map(|kind| of(&kind));
    assert_same_told(&told, [&old, &both, &other]);
    let media = "<medium><name>glass</name><uid>3</uid><basic><ior>1.5</ior></basic></medium>";
    let frosted = |gloss: &str| {
        let kind = format!(
            "<glossy_transparent><internal_medium_name>glass</internal_medium_name>{gloss}</glossy_transparent>"
        );
        of(&kind) + media
    };
    let [old, new, other] = [
        "<exponent>6</exponent>",
        "<roughness><constant>0.5</constant></roughness>",
        "<exponent>7</exponent>",
    ]
    .map(frosted);
    assert_same_told(&NOT_CLOSED, [&old, &new, &other]);
}

#[test]
fn quick_scattering_below_the_surface_is_done_by_its_medium() {
    let media = "<medium><name>glass</name><uid>3</uid><basic><ior>1.5</ior></basic></medium>";
    let rough = "<roughness><constant>0.5</constant></roughness>";
    let frosted = format!(
        "<glossy_transparent><internal_medium_name>glass</internal_medium_name>{rough}</glossy_transparent>"
    );
    let fast =
        |more: &str| format!("<fast_sss><internal_medium_uid>3</internal_medium_uid>{more}</fast_sss>");
    let [old, new, other] = [frosted, fast(rough), fast("<roughness><constant>0.4</constant></roughness>")]
        .map(|kind| of(&kind) + media);
    assert_same_told(&NOT_CLOSED, [&old, &new, &other]);
    let albedo = "<albedo><constant><uniform><value>0.5</value></uniform></constant></albedo>";
    let coloured = of(&fast(&format!("{rough}{albedo}"))) + media;
    let told = ["W0103 <diffuse_albedo_spectrum> has no effect beside <internal_medium_name>", NOT_CLOSED[0]];
    assert_same_told(&told, [&old, &coloured, &other]);
}

#[test]
fn thin_sheets_and_coats_take_their_numbers_in_wrappers() {
    let parts = "<material><name>a</name><uid>7</uid><diffuse><albedo_spectrum><uniform><value>0.3</value></uniform></albedo_spectrum></diffuse></material>";
    let thin = |sides: &str, through: &str| {
        let kind = format!("<double_sided_thin>{sides}<r_f>0.25</r_f>{through}</double_sided_thin>");
        of(&kind) + parts
    };
    let half = "<transmittance_spectrum><uniform><value>0.5</value></uniform></transmittance_spectrum>";
    let wrapped = "<transmittance><constant><uniform><value>0.5</value></uniform></constant></transmittance>";
    let by_name = "<front_material_name>a</front_material_name>";
    let by_uid = "<front_material_uid>7</front_material_uid><back_material_uid>7</back_material_uid>";
    assert_same([&thin(by_name, half), &thin(by_uid, wrapped), &thin(by_name, "")]);
    let mirror = "<medium><name>glass</name><basic><ior>1.5</ior></basic></medium><material><name>mirror</name><specular><internal_medium_name>glass</internal_medium_name><transparent>false</transparent></specular></material>";
    let faulty = thin("<front_material_name>mirror</front_material_name>", "") + mirror;
    assert!(
        findings(&loaded(&faulty)).iter().any(|f| f.1.contains("a thin sheet can neither let light through"))
    );
    let glossy = thin("<front_material_name>a</front_material_name>", "<ior><constant>1.5</constant></ior>");
    assert!(findings(&loaded(&glossy)).iter().any(|f| f.1.starts_with("W0102 <ior> in <double_sided_thin>")));
    let coat = |below: &str, more: &str| of(&format!("<coating>{below}{more}</coating>")) + parts;
    let by_name = "<substrate_material_name>a</substrate_material_name>";
    assert_same([
        &coat(by_name, "<ior>1.6</ior><roughness>0.2</roughness>"),
        &coat(
            "<substrate_material_uid>7</substrate_material_uid>",
            "<ior><constant>1.6</constant></ior><roughness><constant>0.2</constant></roughness>",
        ),
        &coat(by_name, "<ior>1.6</ior>"),
    ]);
    let bare = "<absorption_spectrum><uniform><value>200</value></uniform></absorption_spectrum>";
    let wrapped = "<absorption><constant><uniform><value>200</value></uniform></constant></absorption>";
    assert_same([
        &coat(by_name, &format!("{bare}<thickness>0.001</thickness>")),
        &coat(by_name, &format!("{wrapped}<thickness><constant>0.001</constant></thickness>")),
        &coat(by_name, &format!("{wrapped}<thickness><constant>0.002</constant></thickness>")),
    ]);
    let on_gold = |more: &str| {
        let gold = material("a", "<phong><nk_data>au.nk</nk_data><exponent>100</exponent></phong>");
        of(&format!("<coating>{by_name}<interference>true</interference>{more}</coating>")) + &gold
    };
    assert_same([
        &on_gold("<thickness>2e-7</thickness><ior>1.7</ior>"),
        &on_gold("<thickness><constant>2e-7</constant></thickness><ior><constant>1.7</constant></ior>"),
        &on_gold("<thickness>2e-7</thickness>"),
    ]);
}

#[test]
fn a_fresnel_scale_of_one_changes_nothing_and_another_does() {
    let phong = |more: &str| format!("<phong><ior>1.5</ior><exponent>6</exponent>{more}</phong>");
    let scale = |v: &str| phong(&format!("<fresnel_scale><constant>{v}</constant></fresnel_scale>"));
    assert_same_kinds([&phong(""), &scale("1"), &scale("0.5")]);
    let metal = |more: &str| {
        format!(
            "<phong><exponent>6</exponent><specular_reflectivity><constant><uniform><value>0.8</value></uniform></constant></specular_reflectivity>{more}</phong>"
        )
    };
    let half = "<fresnel_scale>0.5</fresnel_scale>";
    assert_same_kinds([&metal(""), &metal("<fresnel_scale>1</fresnel_scale>"), &metal(half)]);
}

#[test]
fn blends_and_their_steps() {
    let blend = |kind: &str| {
        of_material(
            &(material("m", kind)
                + "<material><uid>12</uid><name>o</name><phong><ior>1.5</ior><exponent>9</exponent></phong></material>"),
        )
    };
    let names = "<a_name>n</a_name><b_name>o</b_name>";
    let old = blend(&format!("<blend><blend_factor>0.3</blend_factor>{names}</blend>"));
    let new = blend(
        "<blend><blend><constant>0.3</constant></blend><step_blend>false</step_blend><a_name>n</a_name><b_uid>12</b_uid></blend>",
    );
    let stepped = blend(&format!(
        "<blend><blend><constant>0.3</constant></blend><step_blend>true</step_blend>{names}</blend>"
    ));
    assert_same([&old, &new, &stepped]);
    let none = blend(&format!("<blend><blend_factor>0</blend_factor>{names}</blend>"));
    assert_same([&none, &stepped, &old]);
    let map = |form: &str, step: &str| {
        blend(&format!("<blend><texture>{BUMP_TX}</texture>{form}{step}{names}</blend>"))
    };
    let listed = "<blend><texture><texture_index>0</texture_index></texture></blend>";
    let old = blend(&format!("<blend><blend_map>{BUMP_TX}</blend_map>{names}</blend>"));
    assert_same([&old, &map(listed, ""), &map(listed, "<step_blend>true</step_blend>")]);
}

#[test]
fn media_go_by_uid_and_have_coefficients_under_new_names() {
    let scene = |interface: &str, medium: &str| {
        let medium =
            format!("<medium><name>milk</name><uid>44</uid><precedence>9</precedence>{medium}</medium>");
        let other = "<medium><name>ice</name><uid>45</uid><precedence>8</precedence><basic><ior>1.3</ior></basic></medium>";
        of(&format!("<specular>{interface}<transparent>true</transparent></specular>")) + &medium + other
    };
    let by_name = "<internal_medium_name>milk</internal_medium_name>";
    let old = scene(
        by_name,
        "<basic><ior>1.4</ior><absorption_coefficient_spectrum><rgb><rgb>1 2 3</rgb></rgb></absorption_coefficient_spectrum><subsurface_scattering><scattering_coefficient_spectrum><uniform><value>5</value></uniform></scattering_coefficient_spectrum><phase_function><uniform/></phase_function></subsurface_scattering></basic>",
    );
    let new = "<basic><ior>1.4</ior><absorption_coefficient><constant><rgb><rgb>1 2 3</rgb></rgb></constant></absorption_coefficient><subsurface_scattering><scattering_coefficient><constant><uniform><value>5</value></uniform></constant></scattering_coefficient><phase_function><uniform/></phase_function></subsurface_scattering></basic>";
    let by_uid = "<internal_medium_uid>44</internal_medium_uid>";
    let other = "<internal_medium_uid>45</internal_medium_uid>";
    assert_same_told(&NOT_CLOSED, [&old, &scene(by_uid, new), &scene(other, new)]);
    // Both together, as some exporters write, and without `basic`.
    let inside = new.replace("<basic>", "").replace("</basic>", "");
    let forwards =
        |g: &str| new.replace("<uniform/>", &format!("<henyey_greenstein>{g}</henyey_greenstein>"));
    let [old_g, new_g, other_g] = [
        "<g_spectrum><uniform><value>0.5</value></uniform></g_spectrum>",
        "<g><constant><uniform><value>0.5</value></uniform></constant></g>",
        "<g><constant><uniform><value>0.4</value></uniform></constant></g>",
    ]
    .map(|g| scene(by_name, &forwards(g)));
    assert_same_told(&NOT_CLOSED, [&old_g, &new_g, &other_g]);
    let both = scene(&format!("{by_name}{by_uid}"), &inside);
    assert_same_told(&NOT_CLOSED, [&old, &both, &scene(other, &inside)]);
    let found = findings(&loaded(&scene("<internal_medium_uid>46</internal_medium_uid>", new)));
    assert!(found[0].1.starts_with("E0301 there is no medium named uid 46"), "{found:?}");
}

#[test]
fn colours_may_have_a_gain_and_tristimulus_values() {
    let of =
        |spectrum: &str| of(&format!("<diffuse><albedo_spectrum>{spectrum}</albedo_spectrum></diffuse>"));
    let old = of("<rgb><rgb>0.1 0.2 0.4</rgb></rgb>");
    let gained = of("<rgb><rgb>0.2 0.4 0.8</rgb><gain>0.5</gain></rgb>");
    assert_same([&old, &gained, &of("<rgb><rgb>0.2 0.4 0.8</rgb></rgb>")]);
    // White of Rec. 709 is (1, 1, 1).
    let xyz = |gain: &str| {
        format!(
            "<background><spectrum><xyz><xyz>0.950470 1 1.088830</xyz><gain>{gain}</gain></xyz></spectrum></background>"
        )
    };
    let luminance = |light: &str| {
        surroundings(&scene_with(&of_material(&material("m", GREY)).replace(LIGHT, light), &[]))
    };
    let white = luminance("<background><spectrum><rgb><rgb>5 5 5</rgb></rgb></spectrum></background>");
    assert!((luminance(&xyz("5")) / white - 1.0).abs() < 1e-3);
    assert!((luminance(&xyz("4")) / white - 0.8).abs() < 1e-3);
}

#[test]
fn what_is_not_rendered_is_named_once_with_what_stands_in() {
    let shader = "<diffuse><albedo><shader><shader><![CDATA[def eval(vec3 pos) vec3 : pos]]></shader></shader></albedo></diffuse>";
    let with_shader = of(shader);
    let grey =
        of("<diffuse><albedo_spectrum><uniform><value>0.5</value></uniform></albedo_spectrum></diffuse>");
    let warning =
        "W0102 <shader> in <albedo> is of a later format version (1.1) and not rendered: 0.5 stands in";
    assert_eq!(dump(&scene_with(&with_shader, &[warning])), dump(&scene_with(&grey, &[])));
    // A hundred materials of a kind that is not there are one warning.
    let many: String = (0..100).map(|i| material(&format!("x{i}"), "<fabric/>")).collect();
    let loaded = loaded(&(of("<fabric></fabric>") + &many));
    let [one] = loaded.sink.diagnostics() else { panic!("{:?}", findings(&loaded)) };
    assert!(one.message.ends_with("a grey diffuse surface stands in") && one.repeats == 100, "{one:?}");
    assert!(loaded.scene.is_some());
    // What does nothing is passed over.
    let silent = of(
        "<specular><internal_medium_name>air</internal_medium_name><arch_glass>false</arch_glass></specular>",
    );
    scene_with(&silent, &[]);
    let loud = of(
        "<specular><internal_medium_name>air</internal_medium_name><arch_glass>true</arch_glass></specular>",
    );
    scene_with(&loud, &["W0102 <arch_glass> in <specular>"]);
    // The new name counts before the old one.
    let both = of(
        "<diffuse><albedo_spectrum><uniform><value>0.1</value></uniform></albedo_spectrum><albedo><constant><uniform><value>0.5</value></uniform></constant></albedo></diffuse>",
    );
    let warning = "W0103 <albedo_spectrum> has no effect beside <albedo>";
    assert_eq!(dump(&scene_with(&both, &[warning])), dump(&scene_with(&grey, &[])));
}
