//! The scene as a file of a person's own: its elements, and changes that keep its comments and layout.

use crate::controls::{Controls, Mapper};
use crate::words;
use indigo_decl::Element;
use indigo_diag::{Sink, SourceMap, Style, to_text};
use indigo_front::load::with_resolver;
use indigo_front::packs::is_pack;
use indigo_igs::edit::{EditError, Edits};
use indigo_igs::{Limits, read_scene};
use indigo_render::atomic::write_atomically;
use indigo_render::disk::read_limited;
use std::collections::BTreeMap;
use std::io::Write as _;
use std::path::{Path, PathBuf};

/// A scene's elements as they stand in its files, and what is to become of them.
pub struct SceneFile {
    /// Its path.
    path: String,
    /// All elements.
    pub root: Element,
    sources: SourceMap,
    /// New texts of elements, by the numbers of children on the way to them.
    pub changes: BTreeMap<Vec<usize>, String>,
}

impl SceneFile {
    /// Reads a scene's elements.
    ///
    /// # Errors
    /// Why it cannot be read, or not be changed.
    pub fn read(path: &str) -> Result<Self, String> {
        if is_pack(path) {
            return Err(words::packed(path));
        }
        let (mut sources, mut sink) = (SourceMap::default(), Sink::new());
        let (root, _) = with_resolver(path, |resolver, _| {
            read_scene(path, resolver, &mut sources, &mut sink, &Limits::default())
        })?;
        let first = || sink.diagnostics().first().map(|d| to_text(d, &sources, Style::Plain));
        let root = root.ok_or_else(|| first().unwrap_or_else(|| words::unreadable(path)))?;
        Ok(Self { path: path.to_owned(), root, sources, changes: BTreeMap::new() })
    }

    /// The element at the end of a way.
    pub fn at(&self, way: &[usize]) -> Option<&Element> {
        way.iter().try_fold(&self.root, |element, &child| element.children.get(child))
    }

    /// Whether elements of any of these names are changed.
    pub fn changes_any(&self, names: &[&str]) -> bool {
        self.changes.keys().filter_map(|way| self.at(way)).any(|element| names.contains(&&*element.name))
    }

    /// Writes the changes to the files that they are in; these.
    ///
    /// # Errors
    /// Where a file cannot be changed or written, or has changed since it was read.
    pub fn save(&self) -> Result<Vec<PathBuf>, String> {
        let mut edits = Edits::default();
        for (way, text) in &self.changes {
            if let Some(element) = self.at(way) {
                edits.set_text(element, text);
            }
        }
        self.write(&edits)
    }

    /// Writes how the picture is developed into the scene; the files that were written. Diffraction is a filter of the picture only
    /// where `has_filter`.
    ///
    /// # Errors
    /// As [`save`](Self::save).
    pub fn save_controls(&self, controls: &Controls, has_filter: bool) -> Result<Vec<PathBuf>, String> {
        let edits = self.edits_of(controls, has_filter).map_err(|error| error.to_string())?;
        self.write(&edits)
    }

    fn edits_of(&self, controls: &Controls, has_filter: bool) -> Result<Edits, EditError> {
        let mut edits = Edits::default();
        let (kind, values) = mapping(controls);
        let other = self.root.child("tonemapping").and_then(|t| t.children.iter().find(|c| &*c.name != kind));
        match other {
            // Only one way of tone mapping can stand there.
            Some(other) => edits.replace(other, &written(kind, &values))?,
            None => {
                for (name, value) in &values {
                    edits.set_child(&self.root, &format!("tonemapping/{kind}/{name}"), value)?;
                }
            }
        }
        edits.set_child(&self.root, "camera/white_balance", &white(controls))?;
        let bloom = self.root.child("camera").and_then(|camera| camera.child("bloom"));
        match (controls.bloom, bloom) {
            (true, _) => {
                edits.set_child(&self.root, "camera/bloom/weight", &controls.bloom_weight.to_string())?;
                edits.set_child(&self.root, "camera/bloom/radius", &controls.bloom_radius.to_string())?;
            }
            (false, Some(bloom)) => edits.remove(bloom),
            (false, None) => {}
        }
        // Without the filter there is nothing to switch: none is wanted, or rays are diffracted already.
        if has_filter {
            let diffracts = controls.diffraction.to_string();
            edits.set_child(&self.root, "renderer_settings/aperture_diffraction", &diffracts)?;
        }
        Ok(edits)
    }

    fn write(&self, edits: &Edits) -> Result<Vec<PathBuf>, String> {
        let files = edits.apply(&self.sources).map_err(|error| match error.span() {
            Some(span) => {
                let at = self.sources.position(span);
                format!("{}:{}:{}: {error}", self.sources.name(span.source), at.line, at.column)
            }
            None => format!("{}: {error}", self.path),
        })?;
        let mut written = vec![];
        for file in files {
            let path = Path::new(&file.path);
            let now = read_limited(path).map_err(|error| format!("{}: {error}", file.path))?;
            if now != self.sources.text(file.source) {
                return Err(words::changed_elsewhere(&file.path));
            }
            write_atomically(path, |to| to.write_all(&file.bytes))
                .map_err(|error| format!("{}: {error}", file.path))?;
            written.push(path.to_path_buf());
        }
        Ok(written)
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
    match indigo_spectrum::illuminant::ALL.iter().find(|i| i.white_xy == controls.white) {
        Some(illuminant) => illuminant.name.to_owned(),
        None => format!("{x} {y}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use indigo_imaging::{Exposure, PictureSettings, ToneMapping};

    const SCENE: &str = "<scene>\n  <!-- mine -->\n  <tonemapping>\n    <linear><scale>2</scale></linear>\n  \
                         </tonemapping>\n  <camera>\n    <pos>0 0 0</pos> <!-- here -->\n  </camera>\n</scene>\n";

    fn controls() -> Controls {
        let exposure = Exposure { aperture_area: 1.0, lens_sensor_dist: 1.0, duration: 1.0 };
        let white = indigo_spectrum::illuminant::white_point("D50").unwrap();
        Controls {
            white,
            ..Controls::of(&PictureSettings::plain(ToneMapping::Linear { scale: 0.5 }, exposure))
        }
    }

    fn scene(name: &str) -> PathBuf {
        let path = std::env::temp_dir().join(format!("indigo-scene-file-{}-{name}.igs", std::process::id()));
        std::fs::write(&path, SCENE).unwrap();
        path
    }

    #[test]
    fn settings_are_written_and_comments_stay() {
        let path = scene("settings");
        let read = || SceneFile::read(path.to_str().unwrap()).unwrap();
        let text = || std::fs::read_to_string(&path).unwrap();
        assert_eq!(read().save_controls(&controls(), false).unwrap(), std::slice::from_ref(&path));
        assert_eq!(
            text(),
            SCENE
                .replace("<scale>2<", "<scale>0.5<")
                .replace("<!-- here -->\n", "<!-- here -->\n    <white_balance>D50</white_balance>\n")
        );
        let mut other = Controls { mapper: Mapper::Camera, ev: 1.5, bloom: true, ..controls() };
        read().save_controls(&other, false).unwrap();
        assert!(!text().contains("diffraction"), "{}", text());
        for part in ["<ev_adjust>1.5</ev_adjust>", "<!-- mine -->", "<!-- here -->", "<bloom>"] {
            assert!(text().contains(part), "{part}: {}", text());
        }
        assert!(!text().contains("<linear>"), "{}", text());
        other.bloom = false;
        read().save_controls(&other, true).unwrap();
        assert!(!text().contains("<bloom>"), "{}", text());
        assert!(text().contains("<aperture_diffraction>false</aperture_diffraction>"), "{}", text());
        std::fs::remove_file(&path).unwrap();
    }

    #[test]
    fn an_element_is_changed_unless_its_file_has_changed() {
        let path = scene("element");
        let mut file = SceneFile::read(path.to_str().unwrap()).unwrap();
        let way = [1, 0];
        assert_eq!(file.at(&way).map(|e| &*e.name), Some("pos"));
        file.changes.insert(way.to_vec(), "1 2 3".to_owned());
        file.save().unwrap();
        let text = std::fs::read_to_string(&path).unwrap();
        assert_eq!(text, SCENE.replace("<pos>0 0 0<", "<pos>1 2 3<"));
        assert!(file.save().unwrap_err().contains("changed"), "the file is another now");
        std::fs::remove_file(&path).unwrap();
    }
}
