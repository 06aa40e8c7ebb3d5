//! How the picture is developed, as changes of a scene: of what its files do not say already.

use crate::controls::{Controls, Mapper};
use indigo_decl::Element;
use indigo_igs::edit::{EditError, Edits};
use indigo_imaging::PictureSettings;
use indigo_spectrum::illuminant;

/// The changes that make a scene say what the controls do. What it does not say is as it `was` when it was loaded.
pub fn edits(root: &Element, controls: &Controls, was: &PictureSettings) -> Result<Edits, EditError> {
    let mut edits = Edits::default();
    let before = Controls::of(was);
    tone_mapping(root, controls, &before, &mut edits)?;
    white_balance(root, controls, &before, &mut edits)?;
    bloom(root, controls, &before, &mut edits)?;
    // Without the filter there is nothing to switch: none is wanted, or rays are diffracted already.
    if was.diffraction.is_some() {
        let diffracts = |controls: &Controls| controls.diffraction.to_string();
        let path = "renderer_settings/aperture_diffraction";
        set(root, path, &diffracts(controls), Some(&diffracts(&before)), &mut edits)?;
    }
    Ok(edits)
}

fn tone_mapping(
    root: &Element,
    controls: &Controls,
    before: &Controls,
    edits: &mut Edits,
) -> Result<(), EditError> {
    let (kind, values) = mapping(controls);
    let (kind_before, values_before) = mapping(before);
    let in_file = at(root, "tonemapping").and_then(|element| element.children.first());
    match in_file {
        Some(element) if &*element.name == kind => {
            for (name, value) in &values {
                let old = values_before.iter().find(|old| kind_before == kind && old.0 == *name);
                let path = format!("tonemapping/{kind}/{name}");
                set(root, &path, value, old.map(|old| &*old.1), edits)?;
            }
        }
        // Only one way of tone mapping can stand there.
        Some(other) => edits.replace(other, &written(kind, &values))?,
        None if (kind, &values) == (kind_before, &values_before) => {}
        None => {
            for (name, value) in &values {
                edits.set_child(root, &format!("tonemapping/{kind}/{name}"), value)?;
            }
        }
    }
    Ok(())
}

fn white_balance(
    root: &Element,
    controls: &Controls,
    before: &Controls,
    edits: &mut Edits,
) -> Result<(), EditError> {
    let in_file = at(root, "camera/white_balance").map(|element| &*element.text.value);
    let said = in_file.map_or(Some(before.white), illuminant::white_point);
    if said != Some(controls.white) {
        edits.set_child(root, "camera/white_balance", &white(controls))?;
        // Which has no effect beside it.
        if let Some(point) = at(root, "camera/white_point") {
            edits.remove(point);
        }
    }
    Ok(())
}

fn bloom(root: &Element, controls: &Controls, before: &Controls, edits: &mut Edits) -> Result<(), EditError> {
    let in_file = at(root, "camera/bloom");
    match (controls.bloom, in_file) {
        (true, _) => {
            let parts = |controls: &Controls| [controls.bloom_weight, controls.bloom_radius];
            let names = ["weight", "radius"];
            for (name, (value, old)) in names.iter().zip(parts(controls).into_iter().zip(parts(before))) {
                // Of an element that is made nothing is known yet.
                let old = in_file.map(|_| old.to_string());
                set(root, &format!("camera/bloom/{name}"), &value.to_string(), old.as_deref(), edits)?;
            }
        }
        (false, Some(bloom)) => edits.remove(bloom),
        (false, None) => {}
    }
    Ok(())
}

/// The element at the end of a path of names.
fn at<'e>(root: &'e Element, path: &str) -> Option<&'e Element> {
    path.split('/').try_fold(root, |element, name| element.child(name))
}

/// Gives an element a text unless it says the same already; what it says where it is not there is `old`, if that is known.
fn set(
    root: &Element,
    path: &str,
    value: &str,
    old: Option<&str>,
    edits: &mut Edits,
) -> Result<(), EditError> {
    let said = at(root, path).map(|element| &*element.text.value).or(old);
    if said.is_some_and(|said| is_same(said, value)) { Ok(()) } else { edits.set_child(root, path, value) }
}

/// Whether two texts are one value: `1.0` is `1`.
fn is_same(a: &str, b: &str) -> bool {
    let number = |text: &str| text.trim().parse::<f64>().ok();
    let truth = |text: &str| match text.trim() {
        "1" => Some(true),
        "0" => Some(false),
        text => text.to_ascii_lowercase().parse::<bool>().ok(),
    };
    match (number(a), number(b), truth(a), truth(b)) {
        (Some(a), Some(b), ..) => a == b,
        (_, _, Some(a), Some(b)) => a == b,
        _ => a.trim() == b.trim(),
    }
}

/// The element of a tone mapping, and what is in it.
fn mapping(controls: &Controls) -> (&'static str, Vec<(&'static str, String)>) {
    let number = |name, value: f64| (name, value.to_string());
    match controls.mapper {
        Mapper::Linear => ("linear", vec![number("scale", controls.scale)]),
        Mapper::Reinhard => (
            "reinhard",
            vec![
                number("pre_scale", controls.pre_scale),
                number("post_scale", controls.post_scale),
                number("burn", controls.burn),
            ],
        ),
        Mapper::Camera => (
            "camera",
            vec![
                ("response_function_path", controls.response.name().to_owned()),
                number("ev_adjust", controls.ev),
                number("film_iso", controls.iso),
            ],
        ),
    }
}

/// An element of numbers and names of files, as text.
fn written(name: &str, values: &[(&str, String)]) -> String {
    let escaped = |text: &str| text.replace('&', "&amp;").replace('<', "&lt;");
    let lines = values.iter().map(|(name, value)| format!("    <{name}>{}</{name}>\n", escaped(value)));
    format!("<{name}>\n{}</{name}>", lines.collect::<String>())
}

/// What counts as white, as scenes name it.
fn white(controls: &Controls) -> String {
    let [x, y] = controls.white;
    match illuminant::ALL.iter().find(|i| i.white_xy == controls.white) {
        Some(illuminant) => illuminant.name.to_owned(),
        // Finer than any eye tells, and short enough to be read.
        None => format!("{x:.6} {y:.6}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene_file::SceneFile;
    use indigo_imaging::{Bloom, Exposure, ToneMapping, WhiteBalance};
    use std::path::PathBuf;

    const SCENE: &str = "<scene>\n  <!-- mine -->\n  <tonemapping>\n    <linear><scale>2.0</scale> <!-- two -->\n</linear>\n  \
                         </tonemapping>\n  <camera>\n    <pos>0 0 0</pos> <!-- here -->\n  </camera>\n</scene>\n";

    /// A scene as it was loaded: what SCENE says, white as E.
    fn loaded() -> PictureSettings {
        let exposure = Exposure { aperture_area: 1.0, lens_sensor_dist: 1.0, duration: 1.0 };
        let mut settings = PictureSettings::plain(ToneMapping::Linear { scale: 2.0 }, exposure);
        settings.white_balance = WhiteBalance::from_white(illuminant::white_point("E").unwrap()).unwrap();
        settings
    }

    fn scene(name: &str, text: &str) -> PathBuf {
        let path = std::env::temp_dir().join(format!("indigo-settings-{}-{name}.igs", std::process::id()));
        std::fs::write(&path, text).unwrap();
        path
    }

    #[test]
    fn settings_are_written_and_comments_stay() {
        let path = scene("written", SCENE);
        let save = |controls: &Controls| {
            SceneFile::read(path.to_str().unwrap()).unwrap().save_controls(controls, &loaded()).unwrap()
        };
        let text = || std::fs::read_to_string(&path).unwrap();
        let white = illuminant::white_point("D50").unwrap();
        let mut other = Controls { white, scale: 0.5, ..Controls::of(&loaded()) };
        assert_eq!(save(&other), std::slice::from_ref(&path));
        assert_eq!(
            text(),
            SCENE
                .replace("<scale>2.0<", "<scale>0.5<")
                .replace("<!-- here -->\n", "<!-- here -->\n    <white_balance>D50</white_balance>\n")
        );
        (other.mapper, other.ev, other.bloom) = (Mapper::Camera, 1.5, true);
        save(&other);
        for part in
            ["<ev_adjust>1.5</ev_adjust>", "<!-- mine -->", "<!-- two -->", "<!-- here -->", "<bloom>"]
        {
            assert!(text().contains(part), "{part}: {}", text());
        }
        assert!(!text().contains("<linear>") && !text().contains("diffraction"), "{}", text());
        other.bloom = false;
        save(&other);
        assert!(!text().contains("<bloom>"), "{}", text());
        std::fs::remove_file(&path).unwrap();
    }

    #[test]
    fn what_the_file_says_already_stands_as_it_is_written() {
        let text = "<scene><renderer_settings><aperture_diffraction>TRUE</aperture_diffraction></renderer_settings>\
                    <tonemapping><reinhard><pre_scale>4.00</pre_scale><post_scale>12e-1</post_scale></reinhard>\
                    </tonemapping><camera><white_balance> D65</white_balance><bloom><weight>0.10</weight></bloom>\
                    </camera></scene>";
        let path = scene("same", text);
        let mut was = loaded();
        // The last is not in the file, and as it is by default.
        was.tone_mapping = ToneMapping::Reinhard { pre_scale: 4.0, post_scale: 1.2, burn: 6.0 };
        was.white_balance = WhiteBalance::from_white(illuminant::white_point("D65").unwrap()).unwrap();
        was.bloom = Some(Bloom { weight: 0.1, radius: 0.01 });
        let save = |controls: &Controls| {
            SceneFile::read(path.to_str().unwrap()).unwrap().save_controls(controls, &was).unwrap()
        };
        let mut controls = Controls::of(&was);
        // Not a filter of the picture here.
        assert!(!controls.diffraction);
        assert!(save(&controls).is_empty());
        assert_eq!(std::fs::read_to_string(&path).unwrap(), text);
        (controls.post_scale, controls.bloom_radius) = (1.25, 0.02);
        assert_eq!(save(&controls).len(), 1);
        let changed = std::fs::read_to_string(&path).unwrap();
        for part in ["<pre_scale>4.00<", "<post_scale>1.25<", "> D65<", "<weight>0.10<", "<radius>0.02<"] {
            assert!(changed.contains(part), "{part}: {changed}");
        }
        assert!(!changed.contains("burn"), "{changed}");
        std::fs::remove_file(&path).unwrap();
    }

    #[test]
    fn values_are_compared_and_not_their_texts() {
        for (a, b) in
            [("1.0", "1"), ("1e1", " 10 "), ("TRUE", "true"), ("0", "false"), ("a/b.txt", "a/b.txt")]
        {
            assert!(is_same(a, b), "{a} {b}");
        }
        for (a, b) in [("1", "1.01"), ("true", "false"), ("a.txt", "b.txt"), ("", "0")] {
            assert!(!is_same(a, b), "{a} {b}");
        }
    }

    #[test]
    fn a_white_by_numbers_gives_way_to_one_by_name() {
        let text = "<scene><camera><white_point><chromaticity_coordinates><x>0.3</x><y>0.3</y>\
                    </chromaticity_coordinates></white_point></camera><tonemapping><linear><scale>2</scale></linear>\
                    </tonemapping></scene>";
        let path = scene("white", text);
        let white = illuminant::white_point("D50").unwrap();
        let controls = Controls { white, ..Controls::of(&loaded()) };
        SceneFile::read(path.to_str().unwrap()).unwrap().save_controls(&controls, &loaded()).unwrap();
        let changed = std::fs::read_to_string(&path).unwrap();
        assert!(changed.contains("D50") && !changed.contains("white_point"), "{changed}");
        std::fs::remove_file(&path).unwrap();
    }
}
