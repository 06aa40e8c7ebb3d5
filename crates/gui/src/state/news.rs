//! What the window learns from its engine.

use super::{Foot, State};
use crate::action::Action;
use crate::comparison::Comparison;
use crate::controls::Controls;
use crate::engine::{LoadedFacts, Phase, Update};
use crate::log::Weight;
use crate::queue::Turn;
use crate::work::{Mode, Work};
use std::path::Path;

impl State {
    /// Takes news of the engine.
    pub fn take(&mut self, update: Update) {
        match update {
            Update::Phase(phase) => self.take_phase(phase),
            Update::Scene(facts, work) => self.take_scene(*facts, work),
            Update::Findings(findings, sources) => {
                if findings.iter().any(|finding| finding.weight != Weight::Info) {
                    self.foot = Foot::Findings;
                }
                (self.findings, self.sources, self.source_view) = (findings, sources, None);
                self.findings_of.clone_from(&self.wanted);
                self.reading = None;
            }
            Update::Opened(path) => self.recent.add(&path),
            Update::Film(settings, path) => {
                self.set_file_aside();
                if self.path.as_deref().is_some_and(|open| Path::new(open) != path) {
                    self.comparison = Comparison::default();
                }
                self.facts = None;
                self.path = Some(path.display().to_string());
                self.wanted.clone_from(&self.path);
                (self.controls, self.before_reset) = (Some(Controls::of(&settings)), None);
                self.base = Some(*settings);
                (self.work, self.mode, self.progress) = (None, None, None);
            }
            Update::Progress(progress, memory) => (self.progress, self.memory) = (Some(progress), memory),
            Update::Slaves(status) => {
                if self.slaves.is_none() {
                    self.foot = Foot::Slaves;
                }
                self.slaves = Some(status);
            }
            Update::Line(line) => self.tell(line.weight, line.text),
            Update::Done(how) => self.turn_has_ended(how),
            Update::Unsaved(n) => self.take_unsaved_films(n),
            Update::Kept(samples) => self.take_kept(samples),
            Update::NotKept => self.after_film = None,
            Update::Cleared => self.picture = None,
            Update::Gone => self.act(Action::Close),
        }
    }

    fn take_phase(&mut self, phase: Phase) {
        // What is rendered next may have no slaves; those of a render that has ended are still worth a look.
        if phase == Phase::Rendering && self.phase != Phase::Paused || phase == Phase::Slave {
            self.forget_slaves();
            if phase == Phase::Slave {
                self.progress = None;
            }
        }
        if matches!(phase, Phase::Ready | Phase::Empty) {
            self.forget_slaves();
        }
        self.phase = phase;
    }

    /// The table of slaves is of no render any more.
    pub fn forget_slaves(&mut self) {
        self.slaves = None;
        if self.foot == Foot::Slaves {
            self.foot = Foot::Log;
        }
    }

    /// A scene is there, to be rendered in a way that is told where it was loaded.
    fn take_scene(&mut self, facts: LoadedFacts, work: Option<Work>) {
        let is_same = self.facts.as_ref().is_some_and(|old| old.path == facts.path && old.size == facts.size);
        if !is_same {
            self.view.fit();
            self.picture = None;
            self.mode_is_chosen = false;
            self.comparison = Comparison::default();
        }
        // What is known of a film that goes with it follows.
        (self.progress, self.kept_samples) = (None, 0);
        // Another part of the picture is no reason to read the files anew.
        if work.is_some() {
            self.set_file_aside();
            if self.shows_elements {
                self.act(Action::ReadElements);
            }
        }
        (self.cross, self.corner) = (None, None);
        // What was tried out on the same scene stays, unless its files say something else now.
        let of_files = Controls::of(&facts.picture);
        let is_as_before = self.base.as_ref().is_some_and(|base| Controls::of(base) == of_files);
        if !(is_same && is_as_before) || self.controls.is_none() {
            (self.controls, self.before_reset) = (Some(of_files), None);
        }
        self.base = Some(facts.picture.clone());
        self.work = work.or(self.work);
        self.mode = Some(Mode::of(&facts.transport));
        self.recent.add(Path::new(&facts.path));
        self.path = Some(facts.path.clone());
        self.wanted.clone_from(&self.path);
        self.facts = Some(facts);
        self.controls_changed();
    }

    /// The next scene of the queue, if it runs.
    fn turn_has_ended(&mut self, how: Turn) {
        if self.queue.end(how) {
            self.act(Action::NextInQueue);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::Command;
    use crate::log::{Finding, Line};
    use crate::recent::Recent;
    use indigo_front::flags::Arguments;
    use indigo_imaging::{Exposure, PictureSettings, ToneMapping};
    use std::sync::Arc;

    fn state() -> State {
        State::new(Arguments::default(), Recent::default())
    }

    #[test]
    fn a_film_alone_has_controls_but_no_work() {
        let mut state = state();
        let exposure = Exposure { aperture_area: 1.0, lens_sensor_dist: 1.0, duration: 1.0 };
        let settings = PictureSettings::plain(ToneMapping::Linear { scale: 2.0 }, exposure);
        state.take(Update::Film(Box::new(settings), "a.igi".into()));
        assert_eq!(state.controls.as_ref().map(|c| c.scale), Some(2.0));
        assert!(!state.can_start() && state.work.is_none());
        state.brighten(1.0);
        assert_eq!(state.controls.as_ref().map(|c| c.scale), Some(4.0));
        assert!(matches!(state.actions.last(), Some(Action::Command(Command::SetPicture(_)))));
        state.reset_controls();
        assert_eq!(state.controls.as_ref().map(|c| c.scale), Some(2.0));
    }

    /// By night nobody answers questions.
    #[test]
    fn the_queue_asks_nobody() {
        let mut state = state();
        state.queue.add("a.igs".into());
        state.queue.add("b.igs".into());
        state.queue.next();
        state.take(Update::Done(Turn::Failed));
        let action = state.actions.pop().expect("the next scene");
        assert!(matches!(action, Action::NextInQueue) && !action.leaves_scene());
        assert!(Action::RunQueue.leaves_scene(), "whoever presses the button can be asked");
    }

    #[test]
    fn findings_are_those_of_the_scene_that_was_asked_for() {
        let mut state = state();
        (state.path, state.wanted) = (Some("a.igs".to_owned()), Some("b.igs".to_owned()));
        state.take(Update::Findings(vec![], Arc::default()));
        assert_eq!(state.findings_of.as_deref(), Some("b.igs"));
    }

    #[test]
    fn a_comparison_is_with_the_film_that_is_open() {
        let exposure = Exposure { aperture_area: 1.0, lens_sensor_dist: 1.0, duration: 1.0 };
        let settings = || Box::new(PictureSettings::plain(ToneMapping::Linear { scale: 1.0 }, exposure));
        let mut state = state();
        state.take(Update::Film(settings(), "a.igi".into()));
        let image = Arc::new(eframe::egui::ColorImage::example());
        state.comparison.picture = Some(("other/shot.png".into(), image));
        assert_eq!(state.comparison.name().as_deref(), Some("shot.png"));
        for (film, stays) in [("a.igi", true), ("b.igi", false)] {
            state.take(Update::Film(settings(), film.into()));
            assert_eq!(state.comparison.picture.is_some(), stays, "{film}");
        }
    }

    #[test]
    fn the_table_of_slaves_goes_with_its_render() {
        let mut state = state();
        let status = || Update::Slaves(Box::default());
        for (phase, stays) in [
            (Phase::Paused, true),
            (Phase::Halted(indigo_render::HaltReason::Stopped), true),
            (Phase::Ready, false),
            (Phase::Empty, false),
        ] {
            state.take(status());
            assert_eq!(state.foot, Foot::Slaves);
            state.take(Update::Phase(phase.clone()));
            assert_eq!((state.slaves.is_some(), state.foot == Foot::Slaves), (stays, stays), "{phase:?}");
        }
    }

    #[test]
    fn what_is_wrong_in_a_scene_is_shown() {
        let mut state = state();
        let finding =
            Finding { weight: Weight::Warning, head: String::new(), full: String::new(), span: None };
        state.take(Update::Findings(vec![finding], Arc::default()));
        assert_eq!(state.foot, Foot::Findings);
        let line = |weight| Update::Line(Line { weight, text: String::new() });
        state.take(line(Weight::Warning));
        assert_eq!(state.foot, Foot::Findings, "nobody is disturbed by less");
        state.take(line(Weight::Error));
        assert_eq!(state.foot, Foot::Log);
    }
}
