//! Films that are in memory alone, since they could not be saved, and what waits for them.

use super::State;
use crate::action::{Action, Ask};
use crate::engine::{Command, Phase};
use crate::question::Question;
use indigo_render::output::OneFile;
use std::time::Duration;

/// What was rendered in less is soon rendered again.
const A_MINUTE: Duration = Duration::from_mins(1);

impl State {
    /// Whether there is a film to be saved now: one that grows, or one that could not be saved.
    pub fn can_save_now(&self) -> bool {
        self.has_growing_film() || self.unsaved_films > 0
    }

    /// Whether another film in its place would lose samples that are in no file, and in none that the render will write.
    /// Less than a tenth of them is soon rendered again.
    pub fn would_lose_samples(&self) -> bool {
        // Under a name that was given, the next film would take this one's place.
        let is_named = self.arguments.output.is_some();
        let writes_film = !is_named && self.facts.as_ref().is_some_and(|facts| facts.output.igi);
        let has_film = self.has_growing_film() || matches!(self.phase, Phase::Halted(_));
        has_film && !writes_film && self.samples() / 10 * 9 > self.kept_samples
    }

    /// Whether that would cost more than a minute of rendering.
    pub fn would_lose_work(&self) -> bool {
        let rendered = self.progress.map_or(Duration::ZERO, |progress| progress.elapsed);
        self.would_lose_samples() && rendered.mul_f64(self.part_in_no_file()) >= A_MINUTE
    }

    /// Samples per pixel that are in no file.
    pub fn samples_in_no_file(&self) -> f64 {
        self.progress.map_or(0.0, |progress| progress.samples_per_pixel) * self.part_in_no_file()
    }

    /// The part of the film that is in no file, from 0 to 1.
    fn part_in_no_file(&self) -> f64 {
        let samples = self.samples().max(1);
        samples.saturating_sub(self.kept_samples) as f64 / samples as f64
    }

    /// Asks where the film is to be saved, and goes on with what is to be done once it is.
    pub fn save_film_before(&mut self, action: Box<Action>) {
        self.after_film = Some(action);
        self.act(Action::Ask(Ask::Save(OneFile::Film)));
    }

    /// Nobody has said where: nothing waits for it any more.
    pub fn path_is_not_given(&mut self, ask: Ask) {
        if ask == Ask::Save(OneFile::Film) {
            self.after_film = None;
        }
    }

    /// A film of so many samples is in a file.
    pub(super) fn take_kept(&mut self, samples: u64) {
        self.kept_samples = samples;
        if let Some(action) = self.after_film.take() {
            self.act(*action);
        }
    }

    /// Gives up what is in no file.
    pub fn give_up_samples(&mut self) {
        self.kept_samples = self.samples();
    }

    fn samples(&self) -> u64 {
        self.progress.map_or(0, |progress| progress.samples)
    }

    /// Closes the window once everything is saved.
    pub fn save_and_close(&mut self) {
        self.after_saving = Some(Action::TryToClose.into());
        self.command(Command::Quit { saves: true });
    }

    /// Tries to save all films once more, and goes on with what is to be done then.
    pub fn save_films_before(&mut self, action: Box<Action>) {
        self.after_saving = Some(action);
        self.command(Command::SaveAll);
    }

    /// Gives all of them up.
    pub fn discard_films(&mut self) {
        self.unsaved_films = 0;
        // Once is enough to be asked.
        self.give_up_samples();
        self.command(Command::DiscardUnsaved);
    }

    /// So many are in memory alone now. What was to be done when all are saved is done, or asked about.
    pub(super) fn take_unsaved_films(&mut self, n: usize) {
        self.unsaved_films = n;
        match self.after_saving.take() {
            Some(action) if n == 0 => self.act(*action),
            Some(action) => self.ask(Question::UnsavedFilm(action)),
            None => {}
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::Update;
    use crate::recent::Recent;
    use crate::work::Work;
    use indigo_front::flags::Arguments;
    use indigo_render::{HaltReason, Progress};

    fn state() -> State {
        State::new(Arguments::default(), Recent::default())
    }

    /// What the user is asked, which is as good as answered then.
    fn asked(state: &mut State) -> Option<Question> {
        state.questions.take().map(|(question, _)| question)
    }

    #[test]
    fn nothing_takes_the_place_of_a_film_that_is_in_no_file() {
        let losing = || {
            [
                Action::Open("b.igs".into()),
                Action::Restart,
                Action::RunQueue,
                Action::TryToClose,
                Action::Command(Command::SetRegion(None, Work::endless())),
            ]
        };
        let mut state = state();
        assert!(losing().into_iter().all(|action| state.allowed(action).is_some()), "all is saved");
        state.take(Update::Unsaved(1));
        assert!(state.can_save_now());
        for action in losing() {
            assert!(state.allowed(action).is_none());
            assert!(matches!(asked(&mut state), Some(Question::UnsavedFilm(_))));
        }
        assert!(matches!(state.question_before_closing(), Some(Question::UnsavedFilm(_))));
        for action in [Action::Open("picture.png".into()), Action::NextInQueue] {
            assert!(state.allowed(action).is_some(), "nothing is lost by that");
        }
    }

    #[test]
    fn what_took_long_is_not_given_up_without_a_question() {
        let leaving = || {
            // Elements are not written before that is known.
            let saved = Action::SaveElements(Action::Restart.into());
            [Action::Open("b.igs".into()), Action::Restart, Action::RunQueue, Action::TryToClose, saved]
        };
        for (seconds, is_asked) in [(59, false), (61, true)] {
            let mut state = state();
            state.take(Update::Phase(Phase::Halted(HaltReason::Stopped)));
            let Update::Progress(progress, _) = rendered(1000) else { panic!("it is that") };
            let elapsed = Duration::from_secs(seconds);
            state.take(Update::Progress(Progress { elapsed, ..progress }, None));
            for action in leaving() {
                assert_eq!(state.allowed(action).is_none(), is_asked);
                assert_eq!(matches!(asked(&mut state), Some(Question::LostSamples(_))), is_asked);
            }
            assert_eq!(state.question_before_closing().is_some(), is_asked);
            assert!(state.allowed(Action::SaveElements(Action::ReadElements.into())).is_some());
            // Of that what is in a file takes no time again.
            state.take(Update::Kept(500));
            assert!((state.samples_in_no_file() - 0.5).abs() < 1e-9);
            assert!(leaving().into_iter().all(|action| state.allowed(action).is_some()));
        }
    }

    #[test]
    fn what_waits_for_a_path_is_done_when_the_film_is_there_or_given_up() {
        let mut state = state();
        let save = |state: &mut State| {
            state.save_film_before(Action::Restart.into());
            assert!(matches!(state.actions.pop(), Some(Action::Ask(Ask::Save(OneFile::Film)))));
        };
        for (update, is_done) in [(Update::Kept(5), true), (Update::NotKept, false)] {
            save(&mut state);
            state.take(update);
            assert_eq!(matches!(state.actions.pop(), Some(Action::Restart)), is_done);
        }
        save(&mut state);
        state.path_is_not_given(Ask::Save(OneFile::Film));
        state.take(Update::Kept(6));
        assert!(state.actions.is_empty());
    }

    fn rendered(samples: u64) -> Update {
        let progress = Progress {
            samples,
            samples_per_pixel: 1.0,
            samples_per_second: 0.0,
            rays: 0,
            elapsed: Duration::ZERO,
            left: None,
            fraction: None,
            relative_error: None,
        };
        Update::Progress(progress, None)
    }

    #[test]
    fn another_region_gives_up_no_samples_without_a_question() {
        let region = || Action::Command(Command::SetRegion(None, Work::endless()));
        let mut state = state();
        state.take(rendered(1000));
        assert!(state.allowed(region()).is_some(), "nothing was rendered here");
        for phase in [Phase::Rendering, Phase::Paused, Phase::Halted(HaltReason::Stopped)] {
            state.take(Update::Phase(phase));
            assert!(state.allowed(region()).is_none());
            assert!(matches!(asked(&mut state), Some(Question::LostSamples(_))));
            assert!(state.allowed(Action::Restart).is_some(), "a restart is no slip of the mouse");
        }
        state.take(Update::Kept(950));
        assert!(state.allowed(region()).is_some(), "nearly all is in a file");
        state.take(rendered(2000));
        assert!(state.allowed(region()).is_none());
        state.give_up_samples();
        assert!(state.allowed(region()).is_some());
        let facts = crate::panels::tests::full().facts.expect("a scene");
        state.take(Update::Scene(Box::new(facts), None));
        state.take(rendered(1000));
        assert!(state.allowed(region()).is_none(), "it is another film");
    }

    #[test]
    fn what_waits_for_a_film_is_done_when_it_is_saved() {
        let mut state = state();
        for (left, is_done) in [(1, false), (0, true)] {
            state.save_films_before(Action::Restart.into());
            assert!(matches!(state.actions.pop(), Some(Action::Command(Command::SaveAll))));
            state.take(Update::Unsaved(left));
            assert_eq!(matches!(state.actions.pop(), Some(Action::Restart)), is_done);
            assert_eq!(asked(&mut state).is_some(), !is_done, "it is asked again");
        }
        state.take(Update::Unsaved(0));
        assert!(state.actions.is_empty(), "it is done once");
    }

    #[test]
    fn a_window_whose_film_cannot_be_saved_asks_before_it_closes() {
        let mut state = state();
        state.save_and_close();
        assert!(matches!(state.actions.pop(), Some(Action::Command(Command::Quit { saves: true }))));
        state.take(Update::Unsaved(1));
        let Some(Question::UnsavedFilm(action)) = asked(&mut state) else { panic!("nothing is asked") };
        assert!(matches!(*action, Action::TryToClose));
    }
}
