//! Files: what of them is left out, and what is missing.

use super::common::*;
use indigo_scene::{LoadOptions, Override, load, load_canonical, load_contents};

const SPHERE: &str =
    "<sphere><center>0 0 0</center><radius>1</radius><material_name>m</material_name></sphere>";

fn metal(file: &str) -> String {
    format!(
        "<material><name>m</name><phong><nk_data>{file}</nk_data><exponent>100</exponent></phong></material>{SPHERE}"
    )
}

/// Of a picture that is not opaque, wherever it is named: that all of it is taken as if it were.
#[test]
fn alpha_that_is_dropped_is_told() {
    let texture = "<diffuse><albedo_texture><path>glass.tga</path></albedo_texture></diffuse>";
    let rest = format!(
        "<material><name>a</name>{texture}</material><sphere><center>0 0 0</center><radius>1</radius><material_name>a</material_name></sphere>"
    );
    expect_one(&rest, "glass.tga", "W0303");
    let opaque = rest.replace("glass.tga", "grey.png");
    assert!(found(&format!("{opaque}\n{CAMERA}{MESH}")).is_empty());
    let aperture = "<aperture_shape><image><path>glass.tga</path></image></aperture_shape></camera>";
    let camera = CAMERA.replace("</camera>", aperture);
    let found = found(&format!("{camera}{MESH}"));
    assert!(found[0].ends_with("W0303"), "{found:?}");
}

#[test]
fn text_behind_refractive_indices_is_told() {
    expect_one(&metal("noted.nk"), "noted.nk", "W0303");
    let said = said(&format!("{}{CAMERA}", metal("noted.nk")));
    assert!(said[0].0.starts_with("noted.nk:5:1: text behind"), "{said:?}");
    assert!(found(&format!("{}{CAMERA}", metal("whole.nk"))).is_empty());
}

/// One of the name comes with the program.
#[test]
fn a_missing_file_is_told_with_what_was_expected() {
    expect_one(&metal("au.nk"), "au.nk", "E0302");
    let loaded = loaded(&format!("{HEAD}{}{CAMERA}</scene>", metal("metals/au.nk")));
    let [missing] = loaded.sink.diagnostics() else { panic!("one error") };
    assert_eq!(missing.label.as_deref(), Some("expected the path of a file that is there"));
    assert_eq!(missing.hint.as_deref(), Some("did you mean nkdata/au.nk?"));
}

/// It is one fault, however many materials and meshes use the file; of another path it is another.
#[test]
fn a_missing_file_is_told_once() {
    let phong = |name: &str, file: &str| {
        let kind = format!("<phong><nk_data>{file}</nk_data><exponent>100</exponent></phong>");
        format!(
            "<material><name>{name}</name>{kind}</material>{}",
            SPHERE.replace(">m<", &format!(">{name}<"))
        )
    };
    let textured = |name: &str, file: &str| {
        let kind = format!("<diffuse><albedo_texture><path>{file}</path></albedo_texture></diffuse>");
        format!(
            "<material><name>{name}</name>{kind}</material>{}",
            SPHERE.replace(">m<", &format!(">{name}<"))
        )
    };
    for (of, file) in [(&phong as &dyn Fn(&str, &str) -> String, "none.nk"), (&textured, "none.png")] {
        let messages = |other: &str| {
            let scene = format!("{HEAD}{}{}{CAMERA}</scene>", of("a", file), of("b", other));
            let told: Vec<String> = loaded(&scene)
                .sink
                .diagnostics()
                .iter()
                .map(|d| format!("{} {}", d.code, d.message))
                .collect();
            told
        };
        let told = messages(file);
        assert!(told.len() == 1 && told[0].starts_with("E0302"), "{told:?}");
        let told = messages(&format!("other_{file}"));
        assert!(told.len() == 2 && told.iter().all(|told| told.starts_with("E0302")), "{told:?}");
    }
}

/// What a mesh would use that is missing itself is not said to have no effect.
#[test]
fn what_a_fault_keeps_from_use_is_not_called_idle() {
    let mesh = "<mesh><name>body</name><external><path>none.obj</path></external></mesh>";
    let model = "<model><pos>0 0 0</pos><scale>1</scale><mesh_name>body</mesh_name></model>";
    let texture = "<material><name>m</name><diffuse><albedo_texture><path>none.png</path></albedo_texture></diffuse></material>";
    let memory = Memory(format!("{HEAD}{texture}{mesh}{model}{CAMERA}</scene>"));
    for check_only in [false, true] {
        let loaded = load("scene.igs", &LoadOptions { check_only, ..options(&memory) });
        let told = loaded.sink.diagnostics().iter().map(|d| (d.code, d.message.as_str())).collect::<Vec<_>>();
        assert!(told[0].0 == "E0302" && told[0].1.contains("none.obj"), "{told:?}");
        assert_eq!(told.len(), if check_only { 2 } else { 1 }, "{told:?}");
        for (code, message) in &told[1..] {
            let is_right = message.starts_with("cannot read none.png, which nothing uses that could be read");
            assert!(*code == "W0327" && is_right, "{message}");
        }
    }
}

/// Nothing of it is rendered, so only a check tells of it.
#[test]
fn files_without_an_effect_are_looked_for_where_a_scene_is_checked() {
    let texture = |path: &str| format!("<albedo_texture><path>{path}</path></albedo_texture>");
    let unused = format!("<material><name>u</name><diffuse>{}</diffuse></material>", texture("nowhere.png"));
    let overridden = "<material><name>m</name><phong><ior>1.5</ior><exponent>9</exponent><exponent_map><path>gone.png</path></exponent_map><roughness>0.1</roughness></phong></material>";
    let sound = format!("<material><name>v</name><diffuse>{}</diffuse></material>", texture("grey.png"));
    let text = format!("{HEAD}{unused}{overridden}{SPHERE}{sound}{CAMERA}</scene>");
    let memory = Memory(text);
    for check_only in [false, true] {
        let loaded = load("scene.igs", &LoadOptions { check_only, ..options(&memory) });
        let missing = loaded.sink.diagnostics().iter().filter(|d| d.code == "W0327");
        let missing: Vec<&str> = missing.map(|d| d.message.as_str()).collect();
        assert!(!loaded.sink.has_errors(), "{:?}", loaded.sink.diagnostics());
        assert_eq!(missing.len(), if check_only { 2 } else { 0 }, "{missing:?}");
        assert!(
            missing
                .iter()
                .zip(["nowhere", "gone"])
                .all(|(said, name)| said.contains(name) && said.contains("has no effect here")),
            "{missing:?}"
        );
    }
}

/// A scene that may have placeholders is written anew and packed without what is missing, which it names as before; another is
/// not written.
#[test]
fn what_has_a_placeholder_keeps_its_path() {
    let texture = "<material><name>m</name><diffuse><albedo_texture><path>none.png</path></albedo_texture></diffuse></material>";
    let mesh = "<mesh><name>body</name><external><path>none.obj</path></external></mesh>";
    let model = "<model><pos>0 0 0</pos><scale>1</scale><mesh_name>body</mesh_name></model>";
    let memory = Memory(format!("{HEAD}{texture}{SPHERE}{mesh}{model}{CAMERA}</scene>"));
    let overrides = [Override { option: "-placeholders", setting: "placeholders", value: "true".to_owned() }];
    let (plain, lenient) = (options(&memory), LoadOptions { overrides: &overrides, ..options(&memory) });
    let anew = |options| load_canonical("scene.igs", options, "Anew", &|file| file.written.to_owned());
    let (refused, written) = (anew(&plain), anew(&lenient));
    assert!(refused.text.is_none() && refused.sink.has_errors());
    let text = written.text.expect("a scene");
    for name in ["none.png", "none.obj"] {
        assert!(text.contains(&format!("<path>{name}</path>")), "{text}");
        let told = written.sink.diagnostics().iter().filter(|d| d.message.contains(name));
        assert_eq!(told.map(|d| d.code).collect::<Vec<_>>(), ["W0326"], "{name}");
    }
    assert_eq!(written.missing, 2);
    // It is the scene that lacks them and not what stands in for them.
    assert!(!text.contains("placeholders"), "{text}");
    assert!(load_contents("scene.igs", &plain).contents.is_none());
    let packed = load_contents("scene.igs", &lenient);
    let told: Vec<&str> = packed.sink.diagnostics().iter().map(|d| d.code).collect();
    assert_eq!(told, ["W0316", "W0316"]);
    let mut pack = std::io::Cursor::new(vec![]);
    let files = packed.contents.expect("the files").pack(&mut pack, &packed.sources, &memory);
    assert_eq!(files.expect("a pack"), 0);
}
