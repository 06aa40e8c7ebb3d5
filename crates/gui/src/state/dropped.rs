//! Files that are dropped on the window.

use super::{State, Tab};
use crate::action::{Action, SCENES, has_ending};
use crate::log::Weight;
use crate::words;
use std::path::PathBuf;

impl State {
    /// Opens what was dropped. Of several scenes only one could be open: they are rendered one after another.
    pub fn take_dropped(&mut self, paths: Vec<PathBuf>) {
        let (scenes, others): (Vec<_>, Vec<_>) = paths.into_iter().partition(|path| has_ending(path, SCENES));
        for path in others {
            self.act(Action::Open(path));
        }
        if let [_] = &*scenes {
            self.actions.extend(scenes.into_iter().map(Action::Open));
        } else if !scenes.is_empty() {
            self.tell(Weight::Info, words::queued(scenes.len()));
            for path in scenes {
                self.queue.add(path);
            }
            self.tab = Tab::Queue;
            // What is rendered is not ended by it, nor what was just asked for.
            if self.can_run_queue() {
                self.act(Action::RunQueue);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::Phase;
    use crate::recent::Recent;
    use indigo_front::flags::Arguments;

    fn dropped(phase: Phase, names: &[&str]) -> State {
        let mut state = State::new(Arguments::default(), Recent::default());
        state.phase = phase;
        state.take_dropped(names.iter().map(PathBuf::from).collect());
        state
    }

    #[test]
    fn one_scene_is_opened_and_several_are_put_into_the_queue() {
        let state = dropped(Phase::Empty, &["a.igs", "b.png"]);
        assert!(state.queue.scenes.is_empty());
        assert!(matches!(&*state.actions, [Action::Open(_), Action::Open(path)] if path.ends_with("a.igs")));
        let state = dropped(Phase::Ready, &["a.igs", "b.PIGS", "c.igi"]);
        let queued: Vec<&PathBuf> = state.queue.scenes.iter().map(|(path, _)| path).collect();
        assert_eq!(queued, ["a.igs", "b.PIGS"].map(PathBuf::from).iter().collect::<Vec<_>>());
        assert!(matches!(&*state.actions, [Action::Open(_), Action::RunQueue]));
        assert_eq!(state.tab, Tab::Queue);
        let state = dropped(Phase::Rendering, &["a.igs", "b.igs"]);
        assert!(state.actions.is_empty() && state.queue.scenes.len() == 2, "what is rendered goes on");
    }
}
