//! What slaves tell of themselves: believed as far as it can be so.

use super::Shared;
use super::slave::{Presence, SlaveId};
use crate::limits::FASTEST;
use crate::proto::ReportRequest;
use crate::proto::report_request::State;
use indigo_film::is_count;
use std::time::Instant;

/// What a report says, if it can be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Report {
    presence: Presence,
    samples_per_second: f64,
    waiting: u64,
    merged_end: u64,
}

impl Report {
    /// Looks at what a slave says.
    ///
    /// # Errors
    /// What of it cannot be.
    pub fn of(said: &ReportRequest) -> Result<Self, String> {
        let ReportRequest { samples_per_second: rate, waiting_samples: waiting, merged_end, .. } = *said;
        let presence = match State::try_from(said.state) {
            Ok(State::Loading) => Presence::Loading,
            Ok(State::Rendering) => Presence::Rendering,
            Ok(State::Done) => Presence::Done,
            Err(_) => return Err(format!("a report is of the state {}, which is none", said.state)),
        };
        if !(0.0..=FASTEST).contains(&rate) {
            return Err(format!("a report tells of {rate} samples a second; 0 to {FASTEST} are believed"));
        }
        if !is_count(waiting as f64) {
            return Err(format!(
                "a report tells of {waiting} samples to be sent, more than a film can count"
            ));
        }
        Ok(Self { presence, samples_per_second: rate, waiting, merged_end })
    }
}

/// Notes a slave's report; where its units end in the file. `None` if it has not joined.
pub fn note(shared: &Shared, id: &SlaveId, report: Report) -> Option<u64> {
    let ledger = shared.ledger();
    let mut roster = shared.roster();
    let slave = roster.heard(id, Instant::now())?;
    (slave.presence, slave.samples_per_second) = (report.presence, report.samples_per_second);
    let (merged_end, durable_end) = ledger.ends(slave.seed);
    // What has come since it last heard of that would else count as waiting, too.
    if report.merged_end == merged_end {
        slave.waiting = report.waiting;
    }
    Some(durable_end)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_cannot_be_is_not_believed() {
        let sound = ReportRequest {
            state: State::Rendering.into(),
            samples_per_second: 1e6,
            waiting_samples: 1 << 53,
            ..ReportRequest::default()
        };
        let is_believed = |change: &dyn Fn(&mut ReportRequest)| {
            let mut said = sound.clone();
            change(&mut said);
            Report::of(&said).is_ok()
        };
        assert!(is_believed(&|_| {}) && is_believed(&|said| said.samples_per_second = 0.0));
        for rate in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, -1.0, 1e308] {
            assert!(!is_believed(&|said| said.samples_per_second = rate), "{rate}");
        }
        for waiting in [u64::MAX, 1 << 54] {
            assert!(!is_believed(&|said| said.waiting_samples = waiting), "{waiting}");
        }
        for state in [-1, 3, 99] {
            assert!(!is_believed(&|said| said.state = state), "{state}");
        }
    }
}
