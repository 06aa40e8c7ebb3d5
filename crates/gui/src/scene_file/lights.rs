//! How bright the groups of lights are, as changes of a scene's `layer_setting`s.

use crate::words;
use indigo_decl::Element;
use indigo_film::{LightGroup, LightMix};
use indigo_igs::edit::{EditError, Edits};

/// Adds the changes that make a scene say how bright its lights are, which `was` so when it was loaded.
///
/// # Errors
/// In words, where a layer is scaled by a spectrum that has no gain.
pub fn edit(root: &Element, lights: &LightMix, was: &LightMix, edits: &mut Edits) -> Result<(), String> {
    let settings = root.child("renderer_settings");
    let layers: Vec<&Element> = settings
        .into_iter()
        .flat_map(|settings| settings.children.iter().filter(|child| &*child.name == "layer_setting"))
        .collect();
    for (group, old) in lights.0.iter().zip(&was.0) {
        let Some(layer) = group.layer.and_then(|number| layers.get(usize::from(number))) else { continue };
        // Of no brightness at all there is no gain that all spectra take.
        let shines = |group: &LightGroup| group.is_on && group.gain > 0.0;
        if shines(group) != shines(old) {
            edits.set_child(layer, "enabled", &shines(group).to_string()).map_err(|e| e.to_string())?;
        }
        if group.gain != old.gain && group.gain > 0.0 {
            set_gain(layer, group, old, edits)?;
        }
    }
    Ok(())
}

/// Makes the scale of a layer as bright as a group is.
fn set_gain(layer: &Element, group: &LightGroup, old: &LightGroup, edits: &mut Edits) -> Result<(), String> {
    let in_words = |error: EditError| error.to_string();
    let gain = group.gain.to_string();
    let Some(scale) = layer.child("layer_scale") else {
        return edits.set_child(layer, "layer_scale/uniform/value", &gain).map_err(in_words);
    };
    let mut kind = scale.children.first();
    while let Some(wrapper) = kind.filter(|kind| &*kind.name == "constant") {
        kind = wrapper.children.first();
    }
    match kind {
        Some(kind) if &*kind.name == "uniform" => edits.set_child(kind, "value", &gain).map_err(in_words),
        Some(kind) if ["rgb", "xyz", "blackbody"].contains(&&*kind.name) && old.gain > 0.0 => {
            // What it is multiplied by beside the gain stays as it is.
            let before = kind.child("gain").map_or(Some(1.0), |gain| gain.text.value.trim().parse().ok());
            let before: f64 = before.unwrap_or(1.0);
            let factor = (before * group.gain / old.gain).to_string();
            edits.set_child(kind, "gain", &factor).map_err(in_words)
        }
        _ => Err(words::no_gain(&group.name)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene_file::{NotSaved, SceneFile};

    fn written(layers: &str, change: impl Fn(&mut LightMix)) -> Result<String, String> {
        let path = std::env::temp_dir().join(format!(
            "indigo-lights-{}-{:?}.igs",
            std::process::id(),
            std::thread::current().id()
        ));
        let text = format!("<scene>\n<renderer_settings>\n{layers}\n</renderer_settings>\n</scene>\n");
        std::fs::write(&path, &text).expect("a place for files");
        let file = SceneFile::read(path.to_str().expect("a plain name"))?;
        let was = LightMix(
            (0..2)
                .map(|number| LightGroup {
                    name: format!("layer {number}"),
                    gain: 2.0,
                    is_on: true,
                    layer: Some(number),
                })
                .collect(),
        );
        let mut now = was.clone();
        change(&mut now);
        let mut edits = Edits::default();
        edit(&file.root, &now, &was, &mut edits)?;
        file.write(&edits).map_err(NotSaved::in_words)?;
        let text = std::fs::read_to_string(&path).expect("it is there");
        std::fs::remove_file(&path).expect("it is there");
        Ok(text)
    }

    #[test]
    fn gains_and_switches_are_written_where_they_stand() {
        let rgb = "<layer_setting/>\n<layer_setting><!-- mine --><layer_scale><rgb><rgb>1 0.5 0.5</rgb><gain>3</gain></rgb></layer_scale></layer_setting>";
        let half = |mix: &mut LightMix| mix.0[1].gain = 1.0;
        assert!(
            written(rgb, half)
                .unwrap()
                .contains("<!-- mine --><layer_scale><rgb><rgb>1 0.5 0.5</rgb><gain>1.5</gain></rgb>")
        );
        assert!(written(rgb, |_| {}).unwrap().contains("<gain>3</gain>"));
        let uniform = rgb
            .replace("<rgb><rgb>1 0.5 0.5</rgb><gain>3</gain></rgb>", "<uniform><value>2</value></uniform>");
        assert!(written(&uniform, half).unwrap().contains("<uniform><value>1</value></uniform>"));
        let none = "<layer_setting/>\n<layer_setting><name>a</name></layer_setting>";
        let text = written(none, half).unwrap();
        assert!(text.contains("<uniform>") && text.contains("<value>1</value>"), "{text}");
        let off = written(none, |mix| mix.0[1].is_on = false).unwrap();
        assert!(off.contains("<enabled>false</enabled>") && !off.contains("layer_scale"), "{off}");
        let none = written(rgb, |mix| mix.0[1].gain = 0.0).unwrap();
        assert!(none.contains("<enabled>false</enabled>") && none.contains("<gain>3</gain>"), "{none}");
        let peak = "<layer_setting/>\n<layer_setting><layer_scale><peak><peak_min>500</peak_min></peak></layer_scale></layer_setting>";
        assert!(written(peak, half).unwrap_err().contains("layer 1"));
    }
}
