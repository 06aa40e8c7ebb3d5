//! What a slave has rendered and the master may still need.
//!
//! A film waits here until the master has it, and stays until it is in a file of the master's: then a master that is
//! killed and started again gets anew what it had not saved. Films that the master will save together are kept as one.

use crate::ledger::run_of;
use indigo_film::SavedFilm;
use std::collections::VecDeque;

/// The most films that are kept. Only a master that cannot save its film for a while lets them become more; then two
/// become one, the oldest that can, which in the end costs at most what the master loses as well. Where the master refused
/// what was between, two cannot: of such gaps there are few, as only what is damaged is refused.
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
        if self.kept.len() > MOST_KEPT {
            self.join_two();
        }
    }

    /// Joins the oldest two films that can be. Of a save that is under way no two may become one of which it has the first
    /// alone; but before a film of a later generation that save has ended, or another would not have begun.
    fn join_two(&mut self) {
        let newest = self.kept.back().and_then(|newest| newest.generation);
        for i in 1..self.kept.len().saturating_sub(1) {
            let generation = self.kept.get(i).and_then(|kept| kept.generation);
            if let (Some(generation), Some(newest)) = (generation, newest)
                && generation >= newest
            {
                continue;
            }
            let Some(Kept { film, generation }) = self.kept.remove(i) else { return };
            let apart = match self.kept.get_mut(i - 1) {
                Some(older) => joined(&mut older.film, film).or_else(|| {
                    older.generation = generation;
                    None
                }),
                None => Some(film),
            };
            match apart {
                Some(film) => self.kept.insert(i, Kept { film, generation }),
                None => return,
            }
        }
    }

    /// The master's file holds the slave's units before this one.
    pub fn saved(&mut self, durable_end: u64) {
        while self.kept.front().is_some_and(|kept| end(&kept.film) <= durable_end) {
            self.kept.pop_front();
        }
    }

    /// The connection is there again, to the same master or another that goes on with its film: sorts out what it has.
    /// What ends at `merged_end` is of that generation, if it is known. Returns the samples that are lost, since the master has
    /// a part of the film that they are in.
    pub fn rejoined(&mut self, merged_end: u64, durable_end: u64, generation: Option<u64>) -> u64 {
        self.saved(durable_end);
        let mut lost = 0;
        let mut waiting = VecDeque::new();
        let mut kept = VecDeque::new();
        let held = std::mem::take(&mut self.kept);
        let sent = std::mem::take(&mut self.waiting).into_iter().map(|film| Kept { film, generation: None });
        for held in held.into_iter().chain(sent) {
            if end(&held.film) <= merged_end {
                let known = held.generation.or(generation.filter(|_| end(&held.film) == merged_end));
                kept.push_back(Kept { generation: known, ..held });
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
