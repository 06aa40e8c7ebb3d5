//! The end of a render of many machines.

use super::{MasterRender, PULSE, say_added};
use crate::messages::{Messages, count, say_saved};
use indigo_film::SavedFilm;
use indigo_net::master::{Status, Unsent};
use indigo_render::{HaltReason, Progress};
use std::time::{Duration, Instant};

/// How long slaves have, at the end, to begin sending what they have.
const GRACE: Duration = Duration::from_secs(20);
/// How long they have in all, if they do.
const LONGEST_GRACE: Duration = Duration::from_mins(5);
/// How long they have to hear that everything is saved: some reports.
const FAREWELL: Duration = Duration::from_secs(5);

/// A render that has all it will get, and is not saved yet.
pub struct Gathered {
    render: MasterRender,
    /// How far it came, with the last of the slaves' samples, and the time that they took to come.
    pub progress: Progress,
    /// Whether fewer samples came than were asked for and told of: then the render may [go on](Gathered::go_on).
    pub lacks_samples: bool,
}

impl Gathered {
    /// How things stand with slaves.
    pub fn status(&self) -> Status {
        self.render.status()
    }
}

impl MasterRender {
    /// Ends what is rendered here and by slaves; how many of these are waited for, for what they have left.
    pub fn begin_end(&mut self, messages: &mut dyn Messages) -> Option<String> {
        self.master.begin_end();
        let program = &self.saver.job().version;
        let added = self.own.as_mut().map_or(Ok(None), |own| own.end(&self.master, program));
        say_added(&added, messages);
        (!self.master.has_all()).then(|| count(self.master.status().present, "slave"))
    }

    /// Gathers the last of what there is, after [`begin_end`](Self::begin_end).
    pub fn gather(mut self, reason: &HaltReason, messages: &mut dyn Messages) -> Gathered {
        self.wait_for_rest(messages);
        if let Some(record) = self.saver.wait_for_last(messages) {
            self.master.saved(record);
        }
        self.tell_events(messages);
        let lacks_samples = *reason == HaltReason::Samples && !self.has_enough(false);
        Gathered { progress: self.progress(), lacks_samples, render: self }
    }

    /// Ends the connections without waiting or saving, but for what somebody wished to have saved; the film. Slaves keep what is in no file, should there be a master again.
    pub fn discard(mut self, messages: &mut dyn Messages) -> SavedFilm {
        self.master.close();
        let film = self.film(messages);
        self.saver.keep_word(|| film.clone(), messages);
        film
    }

    /// Waits for what slaves have left. Those that send may need longer than those that are silent, which a slave that was
    /// killed is.
    fn wait_for_rest(&self, messages: &mut dyn Messages) {
        let start = Instant::now();
        let (mut seen, mut last_news) = (0, start);
        while !self.master.has_all() && last_news.elapsed() < GRACE && start.elapsed() < LONGEST_GRACE {
            if let Ok(event) = self.events.recv_timeout(PULSE) {
                messages.event(&event);
            }
            let status = self.master.status();
            let news = status.samples.wrapping_add(status.bytes_received);
            if news != seen {
                (seen, last_news) = (news, Instant::now());
            }
        }
    }

    /// Waits until slaves have heard that all they sent is in a file, and have left. Who does not hear of it would only send
    /// it once more, to a master that goes on with that file.
    fn see_off(&self, messages: &mut dyn Messages) {
        let start = Instant::now();
        while !self.master.is_deserted() && start.elapsed() < FAREWELL {
            if let Ok(event) = self.events.recv_timeout(PULSE) {
                messages.event(&event);
            }
        }
        self.tell_events(messages);
    }
}

impl Gathered {
    /// Renders on, since samples that slaves had told of did not come. Slaves hear of it by their next reports; those that had
    /// sent all they had come back for more.
    ///
    /// # Errors
    /// What was gathered where nothing can be rendered here any more; the reason was told.
    pub fn go_on(self, messages: &mut dyn Messages) -> Result<MasterRender, Box<Self>> {
        let Self { mut render, .. } = self;
        if render.start_own_anew(messages).is_err() {
            return Err(Self { render, ..self }.into());
        }
        let what = what_is_missing(render.master.unsent());
        let what = what.unwrap_or_else(|| "fewer samples came than slaves had told of".to_owned());
        messages.warn(&format!("{what}: rendering goes on"));
        render.master.take_back_end();
        Ok(render)
    }

    /// Saves it, and ends the connections; the film, and whether all its files were written. Tells of samples that did not
    /// come.
    pub fn save(self, messages: &mut dyn Messages) -> (SavedFilm, bool) {
        let Self { mut render, lacks_samples, .. } = self;
        if let Some(what) = what_is_missing(render.master.unsent()) {
            messages.warn(&format!("{what}: go on with the film (-r) while they run, and they send them"));
        } else if lacks_samples {
            messages.warn(
                "fewer samples came than slaves had told of: go on with the film to have them all (-r)",
            );
        }
        let mut film = render.copy(messages);
        let mut saved = render.job().save(&film);
        let is_written = saved.written.contains(&render.job().paths.igi());
        if let Some(record) = film.record.clone()
            // Where there are none, none can be lost.
            && (is_written || record.samples == 0)
        {
            let runs = record.runs.clone();
            render.master.saved(record);
            render.see_off(messages);
            render.master.close();
            // Somebody who was given up has come after all.
            let last = render.copy(messages);
            if last.record.as_ref().is_some_and(|record| record.runs != runs) {
                saved = render.job().save(&last);
                film = last;
            }
        }
        let is_saved = say_saved(&saved, messages);
        (film, is_saved)
    }
}

/// What slaves had to send and have not sent, if anything.
fn what_is_missing(unsent: Unsent) -> Option<String> {
    let of = |n: usize, how: &str| {
        let verb = if n == 1 { "is" } else { "are" };
        (n > 0).then(|| format!("{} that {verb} {how}", count(n, "slave")))
    };
    let who: Vec<String> =
        [of(unsent.here, "still there"), of(unsent.gone, "gone")].into_iter().flatten().collect();
    let what =
        if unsent.samples > 0 { format!("about {} samples", unsent.samples) } else { "samples".to_owned() };
    (!who.is_empty()).then(|| format!("{} had {what} to send that did not come", who.join(" and ")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn who_has_not_sent_all_is_named() {
        let said = |here, gone, samples| what_is_missing(Unsent { here, gone, samples }).unwrap_or_default();
        assert_eq!(said(0, 0, 0), "");
        assert!(said(1, 0, 70).starts_with("1 slave that is still there had about 70 samples to send"));
        assert!(
            said(2, 1, 9).starts_with("2 slaves that are still there and 1 slave that is gone had about 9")
        );
        assert!(said(1, 0, 0).starts_with("1 slave that is still there had samples to send"));
    }
}
