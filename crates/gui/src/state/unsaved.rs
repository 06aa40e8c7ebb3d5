//! Changed elements that are in no file yet, of the open scene and of those before it.

use super::State;
use crate::log::Weight;
use crate::scene_file::SceneFile;
use crate::words;

impl State {
    /// Whether elements were changed that are not in the files yet.
    pub fn has_unsaved(&self) -> bool {
        self.n_unsaved() > 0
    }

    /// How many were.
    pub fn n_unsaved(&self) -> usize {
        self.file.iter().chain(self.set_aside.values()).map(|file| file.changes.len()).sum()
    }

    /// Another scene is open, or the same anew: changes of its elements wait until it is looked at again, or saved. Nobody may be
    /// there to be asked.
    pub(super) fn set_file_aside(&mut self) {
        let Some(file) = self.file.take().filter(|file| !file.changes.is_empty()) else { return };
        let text = words::set_aside(file.changes.len(), file.path());
        self.tell(Weight::Info, text);
        self.set_aside.insert(file.path().to_owned(), file);
    }

    /// The elements of a scene were read; what was changed in them is again.
    pub fn take_file(&mut self, mut file: SceneFile) {
        // Another scene may be open by now.
        if self.path.as_deref() != Some(file.path()) {
            return;
        }
        let waiting = self.set_aside.remove(file.path());
        let lost: usize = waiting.iter().chain(&self.file).map(|earlier| file.take_changes(earlier)).sum();
        self.file = Some(file);
        if lost > 0 {
            self.tell(Weight::Warning, words::lost_changes(lost));
        }
    }

    /// All that is to be saved, to be put back where that fails.
    pub fn take_unsaved(&mut self) -> Vec<SceneFile> {
        let open = self.file.take_if(|file| !file.changes.is_empty());
        open.into_iter().chain(std::mem::take(&mut self.set_aside).into_values()).collect()
    }

    /// A file that could not be saved is as it was, of the open scene or not.
    pub fn put_back(&mut self, file: SceneFile) {
        if self.path.as_deref() == Some(file.path()) && self.file.is_none() {
            self.file = Some(file);
        } else {
            self.set_aside.insert(file.path().to_owned(), file);
        }
    }

    /// A file was saved: what it says of the mode now was said last.
    pub fn was_saved(&mut self, file: &SceneFile) {
        if self.path.as_deref() == Some(file.path()) {
            self.mode_is_chosen &= !file.changes_any(&["bidirectional", "metropolis", "hybrid"]);
        }
    }

    /// Gives up all changes.
    pub fn discard_unsaved(&mut self) {
        self.set_aside.clear();
        if let Some(file) = &mut self.file {
            file.changes.clear();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::Update;
    use crate::recent::Recent;
    use indigo_front::flags::Arguments;
    use indigo_imaging::{Exposure, PictureSettings, ToneMapping};
    use std::path::PathBuf;

    /// A scene of its own, read anew at each call.
    fn scene(name: &str) -> (PathBuf, impl Fn() -> SceneFile + use<>) {
        let name = format!("indigo-unsaved-{}-{name}.igs", std::process::id());
        let path = std::env::temp_dir().join(name);
        std::fs::write(&path, "<scene><camera><pos>0 0 0</pos></camera></scene>").unwrap();
        let text = path.to_str().unwrap().to_owned();
        (path, move || SceneFile::read(&text).unwrap())
    }

    /// The window's state with a scene whose only element is changed.
    fn changed(file: SceneFile) -> State {
        let mut state = State::new(Arguments::default(), Recent::default());
        state.path = Some(file.path().to_owned());
        state.file = Some(file);
        state.file.as_mut().unwrap().changes.insert(vec![0, 0], "1 2 3".to_owned());
        state
    }

    /// What is looked at next is a film.
    fn look_at_another(state: &mut State) {
        let exposure = Exposure { aperture_area: 1.0, lens_sensor_dist: 1.0, duration: 1.0 };
        let settings = PictureSettings::plain(ToneMapping::Linear { scale: 1.0 }, exposure);
        state.take(Update::Film(Box::new(settings), "other.igi".into()));
    }

    #[test]
    fn changes_wait_while_something_else_is_looked_at() {
        let (path, read) = scene("waits");
        let mut state = changed(read());
        look_at_another(&mut state);
        assert!(state.file.is_none() && state.has_unsaved(), "they are somewhere else");
        assert_eq!(state.log.lines().len(), 1, "which is told");
        // What was read of a scene that is not open any more takes nothing away.
        state.take_file(read());
        assert!(state.file.is_none() && state.n_unsaved() == 1);
        state.path = path.to_str().map(str::to_owned);
        state.take_file(read());
        assert_eq!(state.file.as_ref().map(|file| file.changes.len()), Some(1), "they are back");
        assert!(state.set_aside.is_empty());
        std::fs::remove_file(&path).unwrap();
    }

    #[test]
    fn what_could_not_be_saved_is_still_there() {
        let (path, read) = scene("kept");
        let mut state = changed(read());
        look_at_another(&mut state);
        state.path = Some("b.igs".to_owned());
        let files = state.take_unsaved();
        assert!(files.len() == 1 && !state.has_unsaved());
        for file in files {
            state.put_back(file);
        }
        assert_eq!((state.n_unsaved(), state.set_aside.len()), (1, 1));
        state.discard_unsaved();
        assert!(!state.has_unsaved());
        std::fs::remove_file(&path).unwrap();
    }
}
