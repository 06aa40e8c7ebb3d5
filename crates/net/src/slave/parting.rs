//! The end of a slave, or of its render: what is left is sent if a master is there, or else its loss is told.

use super::calls::Outcome;
use super::visit::{Life, PARTLY_THERE, wanted_record};
use crate::event::Event;
use std::time::Duration;
use tokio::time::{Instant, timeout};

/// So long a slave that is told to stop looks once more for a master that takes what it has.
const LAST_TRY: Duration = Duration::from_secs(5);

impl Life {
    /// Sends what is left over a connection made for that, if a master is there at once.
    ///
    /// # Errors
    /// Why it is not sent, or not all of it.
    pub async fn deliver(&mut self) -> Result<(), Outcome> {
        if self.work.as_ref().is_none_or(|work| work.waiting_samples() == 0 && work.outbox.is_empty()) {
            return Ok(());
        }
        let late = || Outcome::Lost("no master answers".to_owned());
        let (mut client, reply, _) = timeout(LAST_TRY, self.join()).await.map_err(|_| late())??;
        (self.merged_end, self.next_report) = (reply.merged_end, Instant::now());
        let wanted = wanted_record(&reply);
        let Some(work) = self.work.as_mut().filter(|work| work.record.differences(&wanted).is_empty()) else {
            self.leave(&mut client).await;
            return Err(Outcome::Refused("the master has another scene".to_owned()));
        };
        let lost = work.outbox.rejoined(reply.merged_end, reply.durable_end, reply.generation);
        self.tell_lost(lost, PARTLY_THERE);
        self.send(&mut client, true).await?;
        self.leave(&mut client).await;
        Ok(())
    }

    /// Ends what it renders, and tells what is lost by that. Without a good-bye nobody knows what of it the master has saved.
    pub async fn lose(&mut self, has_left: bool, reason: &'static str) {
        let Some(mut work) = self.work.take() else { return };
        if !work.engine.has_ended()
            && let Some(film) = work.engine.end().await
        {
            work.outbox.push(film);
        }
        let samples = if has_left { work.outbox.waiting_samples() } else { work.outbox.samples() };
        self.tell_lost(samples, reason);
    }

    pub(super) fn tell_lost(&self, samples: u64, reason: &'static str) {
        if samples > 0 {
            self.tell(Event::LostSamples { samples, reason });
        }
    }
}
