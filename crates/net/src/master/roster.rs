//! Who takes part.

use super::slave::{Presence, Slave, SlaveId};
use crate::limits::{RETURN, SILENCE, SLAVES};
use crate::plain::name_of;
use std::collections::HashMap;
use std::net::SocketAddr;
use std::time::Instant;

/// What slaves have not sent, by their own account.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Unsent {
    /// Slaves that are there and have something to send, or may.
    pub here: usize,
    /// Slaves that are gone and had something to send.
    pub gone: usize,
    /// Samples, as far as they have told.
    pub samples: u64,
}

/// All slaves.
#[derive(Debug, Default)]
pub struct Roster {
    slaves: HashMap<SlaveId, Slave>,
}

/// A slave that introduces itself.
#[derive(Clone, Copy, Debug)]
pub struct Introduction<'a> {
    /// Its name.
    pub name: &'a str,
    /// Where from.
    pub peer: SocketAddr,
    /// The seed it has chosen.
    pub seed: u64,
    /// Its threads.
    pub threads: u32,
}

/// Why a slave cannot join.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Unwelcome {
    /// What it renders is another's.
    Taken(String),
    /// There are as many as there may be.
    Full(String),
}

impl Roster {
    /// A slave is there, for the first time or again.
    ///
    /// # Errors
    /// Why it cannot be.
    pub fn join(&mut self, id: SlaveId, new: Introduction, now: Instant) -> Result<&Slave, Unwelcome> {
        let Introduction { name, peer, seed, threads } = new;
        let has_seed = |(other, slave): (&SlaveId, &Slave)| {
            *other != id && slave.seed == seed && slave.presence.is_there()
        };
        if let Some((_, other)) = self.slaves.iter().find(|slave| has_seed((slave.0, slave.1))) {
            return Err(Unwelcome::Taken(format!(
                "{} ({}) renders with seed {seed} already, and the same samples would come twice; give each slave \
                 another -seed, or none",
                other.name, other.peer
            )));
        }
        if self.slaves.get(&id).is_some_and(|slave| slave.seed != seed) {
            return Err(Unwelcome::Taken("a slave has one seed".to_owned()));
        }
        // Or one connection could take all places.
        let shares = |(other, slave): (&SlaveId, &Slave)| {
            *other != id && slave.peer == peer && slave.presence.is_there()
        };
        if self.slaves.iter().any(shares) {
            return Err(Unwelcome::Full("a connection is one slave's, and this is another's".to_owned()));
        }
        if self.slaves.len() >= SLAVES && !self.slaves.contains_key(&id) {
            self.forget_one()?;
        }
        let slave = self.slaves.entry(id).or_insert_with(|| Slave {
            name: String::new(),
            peer,
            seed,
            threads,
            presence: Presence::Loading,
            since: now,
            heard: now,
            samples: 0,
            samples_per_second: 0.0,
            waiting: 0,
            is_believed: true,
            uploads: 0,
            last_upload: None,
            errors: 0,
            last_error: None,
        });
        slave.name = name_of(name);
        (slave.peer, slave.threads, slave.presence, slave.heard) = (peer, threads, Presence::Loading, now);
        // Some of what it told of last may have come since.
        slave.waiting = 0;
        Ok(slave)
    }

    /// Forgets whoever has been gone for longest.
    fn forget_one(&mut self) -> Result<(), Unwelcome> {
        let gone = self.slaves.iter().filter(|(_, slave)| !slave.presence.is_there());
        let oldest = gone.min_by_key(|(_, slave)| slave.heard).map(|(id, _)| *id);
        let oldest = oldest.ok_or_else(|| Unwelcome::Full(format!("there are {SLAVES} slaves already")))?;
        self.slaves.remove(&oldest);
        Ok(())
    }

    /// A slave that is there, of which something is heard just now.
    pub fn heard(&mut self, id: &SlaveId, now: Instant) -> Option<&mut Slave> {
        let slave = self.slaves.get_mut(id).filter(|slave| slave.presence.is_there())?;
        slave.heard = now;
        Some(slave)
    }

    /// A slave that has been there, and may be gone: what it has sent may be looked at later than that.
    pub fn known(&mut self, id: &SlaveId) -> Option<&mut Slave> {
        self.slaves.get_mut(id)
    }

    /// A slave says good-bye.
    pub fn leave(&mut self, id: &SlaveId) -> Option<&Slave> {
        let slave = self.slaves.get_mut(id).filter(|slave| slave.presence.is_there())?;
        (slave.presence, slave.samples_per_second, slave.waiting) = (Presence::Left, 0.0, 0);
        Some(slave)
    }

    /// Whether a slave has been there and may have something left to send.
    pub fn expects(&self, id: &SlaveId) -> bool {
        self.slaves.get(id).is_some_and(|slave| slave.presence != Presence::Left)
    }

    /// The connection from an address has ended: the name of the slave that is gone by that, if one is.
    pub fn disconnected(&mut self, peer: SocketAddr, now: Instant) -> Option<String> {
        let slave = self.slaves.values_mut().find(|slave| slave.peer == peer && slave.presence.is_there())?;
        (slave.presence, slave.samples_per_second, slave.heard) = (Presence::Lost, 0.0, now);
        Some(slave.name.clone())
    }

    /// Takes those for gone that have been silent for too long, and tells who they are.
    pub fn expire(&mut self, now: Instant) -> Vec<Slave> {
        let mut lost = vec![];
        for slave in self.slaves.values_mut() {
            if slave.presence.is_there() && now.saturating_duration_since(slave.heard) > SILENCE {
                (slave.presence, slave.samples_per_second) = (Presence::Lost, 0.0);
                lost.push(slave.clone());
            }
        }
        lost
    }

    /// All that are known, in the order in which they came.
    pub fn all(&self) -> Vec<Slave> {
        let mut all: Vec<Slave> = self.slaves.values().cloned().collect();
        all.sort_by(|a, b| (a.since, &a.name, a.peer).cmp(&(b.since, &b.name, b.peer)));
        all
    }

    /// How many are there.
    pub fn present(&self) -> usize {
        self.slaves.values().filter(|slave| slave.presence.is_there()).count()
    }

    /// Whether somebody may have something left to send, who is there or just went and may be back in a moment.
    pub fn is_at_work(&self, now: Instant) -> bool {
        self.slaves.values().any(|slave| match slave.presence {
            Presence::Loading | Presence::Rendering => true,
            Presence::Lost => now.saturating_duration_since(slave.heard) < RETURN,
            Presence::Done | Presence::Left => false,
        })
    }

    /// Who holds samples that have not come, or may do so, and about how many.
    pub fn unsent(&self) -> Unsent {
        self.slaves.values().fold(Unsent::default(), |sum, slave| {
            let (here, gone) = match slave.presence {
                Presence::Rendering => (1, 0),
                // It was at work before its connection broke.
                Presence::Loading if slave.waiting > 0 => (1, 0),
                Presence::Lost if slave.waiting > 0 => (0, 1),
                _ => return sum,
            };
            Unsent {
                here: sum.here + here,
                gone: sum.gone + gone,
                samples: sum.samples.saturating_add(slave.waiting),
            }
        })
    }

    /// What those that are there render, by their own account.
    pub fn samples_per_second(&self) -> f64 {
        self.slaves.values().map(|slave| slave.samples_per_second).sum()
    }

    /// Not all that slaves hold has come in the time that there was: what those tell of that hold it is counted on again when
    /// something of it has come.
    pub fn disbelieve(&mut self) {
        for slave in self.slaves.values_mut().filter(|slave| slave.waiting > 0) {
            slave.is_believed = false;
        }
    }

    /// Samples of a slave's were added to the film.
    pub fn credit(&mut self, id: &SlaveId, samples: u64, now: Instant) {
        if let Some(slave) = self.slaves.get_mut(id) {
            slave.waiting = slave.waiting.saturating_sub(samples);
            slave.samples += samples;
            slave.uploads += 1;
            (slave.last_upload, slave.is_believed) = (Some(now), true);
        }
    }

    /// Samples that those that are there have still to send, by their own account, if it can be counted on.
    pub fn waiting(&self) -> u64 {
        let there = self.slaves.values().filter(|slave| slave.presence.is_there() && slave.is_believed);
        there.fold(0, |sum, slave| sum.saturating_add(slave.waiting))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    fn peer(n: u8) -> SocketAddr {
        ([10, 0, 0, n], 1234).into()
    }

    fn introduction(n: u8, seed: u64) -> Introduction<'static> {
        Introduction { name: "box", peer: peer(n), seed, threads: 2 }
    }

    #[test]
    fn a_seed_is_one_slaves_as_long_as_it_is_there() {
        let (mut roster, now) = (Roster::default(), Instant::now());
        assert!(roster.join([1; 16], introduction(1, 7), now).is_ok());
        let Err(Unwelcome::Taken(error)) = roster.join([2; 16], introduction(2, 7), now) else {
            panic!("the same seed")
        };
        assert!(error.contains("box (10.0.0.1:1234) renders with seed 7"), "{error}");
        assert!(roster.join([1; 16], introduction(3, 7), now).is_ok(), "it may come again, from elsewhere");
        assert!(roster.join([1; 16], introduction(1, 8), now).is_err());
        roster.leave(&[1; 16]);
        assert!(roster.join([2; 16], introduction(2, 7), now).is_ok());
        assert_eq!(roster.present(), 1);
        assert!(roster.heard(&[1; 16], now).is_none(), "who has left must join again");
    }

    #[test]
    fn silence_is_taken_for_absence_once() {
        let (mut roster, now) = (Roster::default(), Instant::now());
        roster.join([1; 16], introduction(1, 1), now).unwrap();
        roster.join([2; 16], introduction(2, 2), now).unwrap();
        let later = now + SILENCE;
        roster.heard(&[2; 16], later).unwrap();
        assert!(roster.expire(later).is_empty());
        let lost = roster.expire(later + Duration::from_secs(1));
        assert_eq!(lost.iter().map(|slave| slave.peer).collect::<Vec<_>>(), [peer(1)]);
        assert!(roster.expire(later + Duration::from_secs(2)).is_empty());
    }

    #[test]
    fn a_slave_goes_with_its_connection_unless_it_has_another() {
        let (mut roster, now) = (Roster::default(), Instant::now());
        roster.join([1; 16], introduction(1, 1), now).unwrap();
        roster.join([1; 16], introduction(2, 1), now).unwrap();
        assert_eq!(roster.disconnected(peer(1), now), None);
        assert_eq!(roster.disconnected(peer(2), now).as_deref(), Some("box"));
        assert_eq!((roster.disconnected(peer(2), now), roster.present()), (None, 0));
    }

    /// Its connection is broken, and it may try again in a second: the end of a render waits for that.
    #[test]
    fn who_has_just_gone_may_be_back() {
        let (mut roster, now) = (Roster::default(), Instant::now());
        roster.join([1; 16], introduction(1, 1), now).unwrap();
        roster.join([2; 16], introduction(2, 2), now).unwrap();
        let slave = roster.heard(&[1; 16], now).unwrap();
        (slave.presence, slave.waiting) = (Presence::Rendering, 7);
        assert_eq!(roster.unsent(), Unsent { here: 1, gone: 0, samples: 7 });
        roster.disconnected(peer(1), now).unwrap();
        roster.leave(&[2; 16]).unwrap();
        assert!(roster.is_at_work(now) && !roster.is_at_work(now + RETURN));
        assert_eq!((roster.waiting(), roster.unsent()), (0, Unsent { here: 0, gone: 1, samples: 7 }));
        roster.join([1; 16], introduction(3, 1), now).unwrap();
        assert_eq!(roster.unsent().samples, 0, "it may have come meanwhile");
    }

    #[test]
    fn a_connection_is_one_slaves() {
        let (mut roster, now) = (Roster::default(), Instant::now());
        roster.join([1; 16], introduction(1, 1), now).unwrap();
        assert!(matches!(roster.join([2; 16], introduction(1, 2), now), Err(Unwelcome::Full(_))));
        roster.leave(&[1; 16]).unwrap();
        assert!(roster.join([2; 16], introduction(1, 2), now).is_ok(), "one after the other");
    }

    #[test]
    fn who_did_not_keep_its_word_is_not_counted_on() {
        let (mut roster, now) = (Roster::default(), Instant::now());
        for (n, waiting) in [(1, 7), (2, 0)] {
            roster.join([n; 16], introduction(n, n.into()), now).unwrap();
            roster.heard(&[n; 16], now).unwrap().waiting = waiting;
        }
        assert_eq!(roster.waiting(), 7);
        roster.disbelieve();
        roster.heard(&[2; 16], now).unwrap().waiting = 5;
        assert_eq!(roster.waiting(), 5, "the other had nothing to send, and is believed");
        roster.join([1; 16], introduction(1, 1), now).unwrap();
        roster.heard(&[1; 16], now).unwrap().waiting = 7;
        assert_eq!(roster.waiting(), 5, "a new connection makes it no other");
        roster.credit(&[1; 16], 2, now);
        assert_eq!(roster.waiting(), 10, "who sends something is");
    }

    #[test]
    fn those_that_are_gone_make_room() {
        let (mut roster, now) = (Roster::default(), Instant::now());
        let id = |n: usize| {
            let mut id = [0; 16];
            id[..8].copy_from_slice(&n.to_le_bytes());
            id
        };
        for n in 0..SLAVES {
            let peer = ([10, 0, 0, 1], n as u16 + 1).into();
            let new = Introduction { peer, ..introduction(1, n as u64) };
            roster.join(id(n), new, now + Duration::from_millis(n as u64)).unwrap();
        }
        let one_more = roster.join(id(SLAVES), introduction(2, SLAVES as u64), now);
        assert!(matches!(one_more, Err(Unwelcome::Full(_))));
        roster.leave(&id(17));
        assert!(roster.join(id(SLAVES), introduction(2, SLAVES as u64), now).is_ok());
        assert_eq!(roster.all().len(), SLAVES);
    }
}
