//! The scene as a file of a person's own: its elements, and changes that keep its comments and layout.

mod lights;
mod settings;

use crate::controls::Controls;
use crate::words;
use indigo_decl::Element;
use indigo_diag::{Sink, SourceMap, Style, to_text};
use indigo_front::load::with_resolver;
use indigo_front::packs::is_pack;
use indigo_igs::edit::Edits;
use indigo_igs::{Limits, read_scene};
use indigo_imaging::PictureSettings;
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

    /// The path of the scene.
    pub fn path(&self) -> &str {
        &self.path
    }

    /// The element at the end of a way.
    pub fn at(&self, way: &[usize]) -> Option<&Element> {
        way.iter().try_fold(&self.root, |element, &child| element.children.get(child))
    }

    /// Takes over the changes of an earlier reading, of elements that stand as they did.
    pub fn take_changes(&mut self, earlier: &Self) {
        for (way, text) in &earlier.changes {
            let (Some(old), Some(new)) = (earlier.at(way), self.at(way)) else { continue };
            if (&old.name, &old.text.value) == (&new.name, &new.text.value) {
                self.changes.insert(way.clone(), text.clone());
            }
        }
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

    /// Writes how the picture is developed into the scene, as far as its files say something else; the files that were written.
    /// What they do not say is as it `was` when the scene was loaded.
    ///
    /// # Errors
    /// As [`save`](Self::save).
    pub fn save_controls(&self, controls: &Controls, was: &PictureSettings) -> Result<Vec<PathBuf>, String> {
        let mut edits = settings::edits(&self.root, controls, was).map_err(|error| error.to_string())?;
        lights::edit(&self.root, &controls.lights, &was.lights, &mut edits)?;
        self.write(&edits)
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

#[cfg(test)]
mod tests {
    use super::*;

    const SCENE: &str =
        "<scene>\n  <!-- mine -->\n  <camera>\n    <pos>0 0 0</pos> <!-- here -->\n  </camera>\n</scene>\n";

    fn scene(name: &str) -> PathBuf {
        let path = std::env::temp_dir().join(format!("indigo-scene-file-{}-{name}.igs", std::process::id()));
        std::fs::write(&path, SCENE).unwrap();
        path
    }

    #[test]
    fn an_element_is_changed_unless_its_file_has_changed() {
        let path = scene("element");
        let mut file = SceneFile::read(path.to_str().unwrap()).unwrap();
        let way = [0, 0];
        assert_eq!(file.at(&way).map(|e| &*e.name), Some("pos"));
        file.changes.insert(way.to_vec(), "1 2 3".to_owned());
        file.save().unwrap();
        let text = std::fs::read_to_string(&path).unwrap();
        assert_eq!(text, SCENE.replace("<pos>0 0 0<", "<pos>1 2 3<"));
        assert!(file.save().unwrap_err().contains("changed"), "the file is another now");
        std::fs::remove_file(&path).unwrap();
    }

    #[test]
    fn changes_are_taken_over_where_elements_are_as_they_were() {
        let path = scene("taken");
        let read = || SceneFile::read(path.to_str().unwrap()).unwrap();
        let mut file = read();
        file.changes.insert(vec![0, 0], "1 2 3".to_owned());
        std::fs::write(&path, SCENE.replace("</camera>", "<iso>100</iso></camera>")).unwrap();
        let mut again = read();
        again.take_changes(&file);
        assert_eq!(again.changes, file.changes);
        std::fs::write(&path, SCENE.replace("0 0 0", "0 0 7")).unwrap();
        let mut again = read();
        again.take_changes(&file);
        assert!(again.changes.is_empty(), "somebody else has moved it");
        std::fs::remove_file(&path).unwrap();
    }
}
