//! What is asked of the engine to have a scene loaded.

use super::State;
use crate::action::{Action, PICTURES, has_ending};
use crate::engine::{Kept, Phase, Request};
use crate::log::Weight;
use crate::part::Part;
use crate::queue::Turn;
use crate::words;
use crate::work::Work;
use indigo_front::flags::Role;
use std::path::{Path, PathBuf};

impl State {
    /// The request for a scene, with what the command line says.
    pub fn request(&self, path: &str, starts: bool) -> Request {
        let mut arguments = self.arguments.clone();
        if arguments.files.first().is_none_or(|first| first != path) {
            // The command line's film and name of the picture are of the command line's scene.
            (arguments.resume, arguments.output) = (None, None);
        }
        let film = arguments.resume.as_ref().map(PathBuf::from);
        // A scene is opened to be rendered here, whatever else this machine may be.
        let part = if self.part.role == Some(Role::Slave) { None } else { self.part.role };
        let part = Part { role: part, ..self.part.clone() };
        Request { path: path.to_owned(), arguments, part, film, starts, halts_at: None, kept: None }
    }

    /// The request for the open scene once more, as it is rendered now; `None` where another was asked for since.
    pub fn request_again(&self) -> Option<Request> {
        let (path, mode, facts) = (self.path.as_ref()?, self.mode?, self.facts.as_ref()?);
        if self.wanted.as_ref() != Some(path) {
            return None;
        }
        let of_files = Work::of(&facts.output, self.arguments.halt_error);
        let mut request = Request {
            film: None,
            halts_at: self.queue.runs.then_some(self.queue.halts_at),
            kept: self.work.map(|work| Kept { work, of_files }),
            // What rests goes on resting.
            ..self.request(path, self.phase == Phase::Rendering)
        };
        if self.mode_is_chosen {
            request.arguments.settings.extend(mode.overrides());
        }
        Some(request)
    }

    /// Loads the open scene anew, whatever was asked for since.
    pub fn restart_open(&mut self) {
        self.wanted.clone_from(&self.path);
        self.act(Action::Restart);
    }

    /// The request for the next scene of the queue, if any waits that can be asked for.
    pub fn request_next(&mut self) -> Option<Request> {
        while let Some(path) = self.queue.next() {
            if let Some(text) = path.to_str() {
                let halts_at = Some(self.queue.halts_at);
                return Some(Request { halts_at, ..self.request(text, true) });
            }
            self.tell(Weight::Error, words::not_text(&path));
            self.queue.end(Turn::Failed);
        }
        None
    }

    /// Something is opened by hand: whoever opens a scene or a film wants that one next. A picture is only looked at beside.
    pub fn leave_queue_for(&mut self, path: &Path) {
        if !has_ending(path, PICTURES) {
            self.queue.leave();
        }
    }

    /// Whether the queue can begin: nothing else is rendered, nor about to be.
    pub fn can_run_queue(&self) -> bool {
        !self.is_under_way() && self.phase != Phase::Loading
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recent::Recent;
    use indigo_front::flags::Arguments;

    fn state() -> State {
        State::new(Arguments::default(), Recent::default())
    }

    #[test]
    fn a_slave_opens_scenes_to_render_them_here() {
        let mut state = state();
        state.part.role = Some(Role::Slave);
        assert_eq!(state.request("a.igs", true).part.role, None);
    }

    #[cfg(unix)]
    #[test]
    fn a_path_that_is_no_text_does_not_end_the_queue() {
        use std::os::unix::ffi::OsStringExt as _;
        let mut state = state();
        state.queue.add(std::ffi::OsString::from_vec(vec![b'a', 0xff]).into());
        state.queue.add("b.igs".into());
        let request = state.request_next().expect("the next one");
        assert_eq!((request.path.as_str(), request.halts_at, request.starts), ("b.igs", Some(256), true));
        let turns: Vec<_> = state.queue.scenes.iter().map(|scene| scene.1).collect();
        assert_eq!(turns, [Turn::Failed, Turn::Now]);
        assert_eq!(state.log.lines().len(), 1, "that is told");
    }

    #[test]
    fn the_queue_is_left_for_scenes_and_films_only() {
        let mut state = state();
        state.queue.add("a.igs".into());
        state.queue.next();
        state.leave_queue_for(Path::new("other.PNG"));
        assert!(state.queue.runs, "a picture to compare with is no other work");
        state.leave_queue_for(Path::new("b.igi"));
        assert!(!state.queue.runs);
    }

    #[test]
    fn the_queue_waits_for_a_scene_that_is_loaded() {
        let mut state = state();
        for (phase, can_run) in [(Phase::Empty, true), (Phase::Loading, false), (Phase::Paused, false)] {
            state.phase = phase;
            assert_eq!(state.can_run_queue(), can_run, "{:?}", state.phase);
        }
    }
}
