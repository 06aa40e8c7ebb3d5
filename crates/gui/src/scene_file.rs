//! The scene as a file of a person's own: its elements, and changes that keep its comments and layout.

mod lights;
mod settings;
mod write;

use crate::controls::Controls;
use crate::words;
use indigo_decl::{Element, Meaning};
use indigo_diag::{Sink, SourceMap, Style, to_text};
use indigo_front::load::with_resolver;
use indigo_front::packs::is_pack;
use indigo_igs::edit::Edits;
use indigo_igs::{Limits, read_scene};
use indigo_imaging::PictureSettings;
use indigo_scene::schema::SCENE;
use std::collections::BTreeMap;
use std::path::PathBuf;

/// A scene's elements as they stand in its files, and what is to become of them.
pub struct SceneFile {
    /// Its path.
    path: String,
    /// All elements.
    pub root: Element,
    sources: SourceMap,
    /// What is to become of them.
    pub changes: Changes,
}

/// The number of the child at each step from the root to an element.
pub type Way = Vec<usize>;

/// What is to become of elements.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Changes {
    /// New texts of elements.
    pub texts: BTreeMap<Way, String>,
    /// Texts of elements that are added, by those that they are added to, and by their names.
    pub added: BTreeMap<Way, BTreeMap<&'static str, String>>,
}

impl Changes {
    /// Gives an element another text.
    pub fn insert(&mut self, way: Way, text: String) {
        self.texts.insert(way, text);
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.texts.len() + self.added.values().map(BTreeMap::len).sum::<usize>()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Leaves all elements as they are.
    pub fn clear(&mut self) {
        *self = Self::default();
    }

    /// Does not add an element any more.
    pub fn take_back(&mut self, way: &[usize], name: &str) {
        let Some(added) = self.added.get_mut(way) else { return };
        added.remove(name);
        if added.is_empty() {
            self.added.remove(way);
        }
    }
}

/// Why changes were not written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum NotSaved {
    /// This file is another than the one that was read.
    ChangedElsewhere(String),
    /// Anything else, in words.
    Because(String),
}

impl From<String> for NotSaved {
    fn from(words: String) -> Self {
        Self::Because(words)
    }
}

impl NotSaved {
    /// In words.
    pub fn in_words(self) -> String {
        match self {
            Self::ChangedElsewhere(path) => words::changed_elsewhere(&path),
            Self::Because(words) => words::nothing_saved(&words),
        }
    }
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
        Ok(Self { path: path.to_owned(), root, sources, changes: Changes::default() })
    }

    /// The path of the scene.
    pub fn path(&self) -> &str {
        &self.path
    }

    /// The element at the end of a way.
    pub fn at(&self, way: &[usize]) -> Option<&Element> {
        way.iter().try_fold(&self.root, |element, &child| element.children.get(child))
    }

    /// What the declarations say of the element at the end of a way.
    fn meaning(&self, way: &[usize]) -> Meaning {
        let (mut element, mut meaning) = (&self.root, Meaning::Block(&SCENE, None));
        for &child in way {
            let Some(next) = element.children.get(child) else { return Meaning::Unknown };
            (element, meaning) = (next, meaning.child(&next.name));
        }
        meaning
    }

    /// How many of the new texts are not what they should be.
    pub fn faults(&self) -> usize {
        let is_wrong = |meaning: Meaning, text: &str| {
            meaning.value().is_some_and(|field| indigo_decl::meaning::fault(field, text).is_some())
        };
        let texts = self.changes.texts.iter().filter(|(way, text)| is_wrong(self.meaning(way), text));
        let added = self.changes.added.iter().flat_map(|(way, texts)| {
            let parent = self.meaning(way);
            texts.iter().filter(move |(name, text)| is_wrong(parent.child(name), text))
        });
        texts.count() + added.count()
    }

    /// Takes over the changes of an earlier reading, of elements that stand as they did; how many others there are.
    pub fn take_changes(&mut self, earlier: &Self) -> usize {
        let mut lost = 0;
        for (way, text) in &earlier.changes.texts {
            let (old, new) = (earlier.at(way), self.at(way));
            let is_same =
                old.zip(new).is_some_and(|(a, b)| (&a.name, &a.text.value) == (&b.name, &b.text.value));
            if is_same {
                self.changes.insert(way.clone(), text.clone());
            } else {
                lost += 1;
            }
        }
        for (way, texts) in &earlier.changes.added {
            for (name, text) in texts {
                let (old, new) = (earlier.at(way), self.at(way));
                let lacks = old.zip(new).is_some_and(|(a, b)| a.name == b.name && b.child(name).is_none());
                if lacks {
                    self.changes.added.entry(way.clone()).or_default().insert(name, text.clone());
                } else {
                    lost += 1;
                }
            }
        }
        lost
    }

    /// Whether elements of any of these names are changed.
    pub fn changes_any(&self, names: &[&str]) -> bool {
        let changed = self.changes.texts.keys().filter_map(|way| self.at(way)).map(|element| &*element.name);
        let added = self.changes.added.values().flat_map(|texts| texts.keys().copied());
        changed.chain(added).any(|name| names.contains(&name))
    }

    /// Writes the changes to the files that they are in; these.
    ///
    /// # Errors
    /// Where a text is not what it should be, or a file cannot be changed or written, or has changed since it was read.
    pub fn save(&self) -> Result<Vec<PathBuf>, NotSaved> {
        match self.faults() {
            0 => {}
            n => return Err(words::faulty(n).into()),
        }
        let mut edits = Edits::default();
        for (way, text) in &self.changes.texts {
            if let Some(element) = self.at(way) {
                edits.set_text(element, text);
            }
        }
        for (way, texts) in &self.changes.added {
            let Some(element) = self.at(way) else { continue };
            for (name, text) in texts {
                edits.set_child(element, name, text).map_err(|error| error.to_string())?;
            }
        }
        self.write(&edits)
    }

    /// Writes how the picture is developed into the scene, as far as its files say something else; the files that were written.
    /// What they do not say is as it `was` when the scene was loaded.
    ///
    /// # Errors
    /// As [`save`](Self::save).
    pub fn save_controls(
        &self,
        controls: &Controls,
        was: &PictureSettings,
    ) -> Result<Vec<PathBuf>, NotSaved> {
        let mut edits = settings::edits(&self.root, controls, was).map_err(|error| error.to_string())?;
        lights::edit(&self.root, &controls.lights, &was.lights, &mut edits)?;
        self.write(&edits)
    }

    fn write(&self, edits: &Edits) -> Result<Vec<PathBuf>, NotSaved> {
        write::write(edits, &self.sources, &self.path)
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
        let path_text = path.display().to_string();
        assert_eq!(file.save(), Err(NotSaved::ChangedElsewhere(path_text)), "the file is another now");
        std::fs::remove_file(&path).unwrap();
    }

    #[test]
    fn changes_are_taken_over_where_elements_are_as_they_were() {
        let path = scene("taken");
        let read = || SceneFile::read(path.to_str().unwrap()).unwrap();
        let mut file = read();
        file.changes.insert(vec![0, 0], "1 2 3".to_owned());
        file.changes.added.insert(vec![0], [("exposure_duration", "0.5".to_owned())].into());
        std::fs::write(&path, SCENE.replace("</camera>", "<iso>100</iso></camera>")).unwrap();
        let mut again = read();
        assert_eq!(again.take_changes(&file), 0);
        assert_eq!(again.changes, file.changes);
        std::fs::write(&path, SCENE.replace("0 0 0", "0 0 7")).unwrap();
        let mut again = read();
        assert_eq!(again.take_changes(&file), 1, "somebody else has moved it");
        assert_eq!(again.changes.texts.len() + 1, file.changes.texts.len());
        assert_eq!(again.changes.added, file.changes.added);
        std::fs::remove_file(&path).unwrap();
    }

    #[test]
    fn what_is_added_stands_behind_the_rest_and_what_is_wrong_is_not_written() {
        let path = scene("added");
        let mut file = SceneFile::read(path.to_str().unwrap()).unwrap();
        file.changes.added.insert(vec![0], [("exposure_duration", "-1".to_owned())].into());
        file.changes.insert(vec![0, 0], "here".to_owned());
        assert_eq!(file.faults(), 2);
        assert!(matches!(file.save(), Err(NotSaved::Because(_))));
        assert_eq!(std::fs::read_to_string(&path).unwrap(), SCENE);
        file.changes.added.insert(vec![0], [("exposure_duration", "0.5".to_owned())].into());
        file.changes.insert(vec![0, 0], "0 0 1".to_owned());
        file.save().unwrap();
        let text = std::fs::read_to_string(&path).unwrap();
        let added = "<!-- here -->\n    <exposure_duration>0.5</exposure_duration>\n  </camera>";
        assert!(text.contains(added) && text.contains("<pos>0 0 1</pos>"), "{text}");
        std::fs::remove_file(&path).unwrap();
    }
}
