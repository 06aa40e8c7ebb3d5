//! What a slave has rendered and the master may still need.
//!
//! A film waits here until the master has it, and stays until it is in a file of the master's: then a master that is
//! killed and started again gets anew what it had not saved. Films that the master will save together are kept as one.

use crate::ledger::run_of;
use indigo_film::SavedFilm;
use std::collections::VecDeque;

/// The most films that are kept. Only a master that cannot save its film for a while lets them become more; then the
/// oldest two become one, which in the end costs at most what the master loses as well.
const MOST_KEPT: usize = 4;

/// Films on their way.
#[derive(Debug, Default)]
pub struct Outbox {
    /// Not sent yet, or without an answer, in the order of their units.
    waiting: VecDeque<SavedFilm>,
    /// Added to the master's film, but not saved.
    kept: VecDeque<Kept>,
}

#[derive(Debug)]
struct Kept {
    film: SavedFilm,
    /// The generation of the master's film that it went to, if it is known.
    generation: Option<u64>,
}

impl Outbox {
    /// Adds what has been rendered since.
    pub fn push(&mut self, film: SavedFilm) {
        self.waiting.push_back(film);
    }

    /// The film to send next.
    pub fn next(&self) -> Option<&SavedFilm> {
        self.waiting.front()
    }

    /// Films held in memory.
    pub fn len(&self) -> usize {
        self.waiting.len() + self.kept.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The unit behind the last one that is held.
    pub fn end(&self) -> u64 {
        let kept = self.kept.iter().map(|kept| &kept.film);
        self.waiting.iter().chain(kept).map(end).max().unwrap_or(0)
    }

    /// Samples of the films that the master has not got, or that are in no file of its.
    pub fn samples(&self) -> u64 {
        self.waiting_samples() + self.kept.iter().map(|kept| samples(&kept.film)).sum::<u64>()
    }

    /// Samples of the films that the master has not got.
    pub fn waiting_samples(&self) -> u64 {
        self.waiting.iter().map(samples).sum()
    }

    /// The master has added the next film to its own.
    pub fn received(&mut self, generation: Option<u64>) {
        if let Some(film) = self.waiting.pop_front() {
            self.keep(Kept { film, generation });
        }
    }

    /// The master will never take the next film.
    pub fn discard(&mut self) {
        self.waiting.pop_front();
    }

    fn keep(&mut self, new: Kept) {
        match self.kept.back_mut() {
            // Those of an unknown generation stay by themselves.
            Some(last) if last.generation.is_some() && last.generation == new.generation => {
                if let Some(apart) = joined(&mut last.film, new.film) {
                    self.kept.push_back(Kept { film: apart, ..new });
                }
            }
            _ => self.kept.push_back(new),
        }
        if self.kept.len() > MOST_KEPT
            && let Some(mut oldest) = self.kept.pop_front()
            && let Some(next) = self.kept.pop_front()
        {
            let apart = joined(&mut oldest.film, next.film);
            if let Some(film) = apart {
                self.kept.push_front(Kept { film, generation: next.generation });
            }
            self.kept.push_front(Kept { generation: next.generation, ..oldest });
        }
    }

    /// The master's file holds the slave's units before this one.
    pub fn saved(&mut self, durable_end: u64) {
        while self.kept.front().is_some_and(|kept| end(&kept.film) <= durable_end) {
            self.kept.pop_front();
        }
    }

    /// The connection is there again, to the same master or another that goes on with its film: sorts out what it has.
    /// Returns the samples that are lost, since the master has a part of the film that they are in.
    pub fn rejoined(&mut self, merged_end: u64, durable_end: u64) -> u64 {
        self.saved(durable_end);
        let mut lost = 0;
        let mut waiting = VecDeque::new();
        let mut kept = VecDeque::new();
        let held = std::mem::take(&mut self.kept);
        let sent = std::mem::take(&mut self.waiting).into_iter().map(|film| Kept { film, generation: None });
        for held in held.into_iter().chain(sent) {
            if end(&held.film) <= merged_end {
                kept.push_back(held);
            } else if first(&held.film) >= merged_end {
                waiting.push_back(held.film);
            } else {
                lost += samples(&held.film);
            }
        }
        (self.waiting, self.kept) = (waiting, kept);
        self.saved(durable_end);
        lost
    }
}

/// Adds a film whose units follow; gives it back where they do not.
fn joined(film: &mut SavedFilm, next: SavedFilm) -> Option<SavedFilm> {
    if end(film) == first(&next) && film.merge(&next).is_ok() { None } else { Some(next) }
}

fn first(film: &SavedFilm) -> u64 {
    run_of(film).map_or(0, |run| run.first)
}

fn end(film: &SavedFilm) -> u64 {
    run_of(film).map_or(0, |run| run.end)
}

fn samples(film: &SavedFilm) -> u64 {
    film.record.as_ref().map_or(0, |record| record.samples)
}
