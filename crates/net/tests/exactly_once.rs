//! Whatever breaks, and whenever: no sample counts twice, and none is lost of which a slave is left that has it.
//!
//! Masters, slaves and networks are played here by the parts that all of it rests on, [`Ledger`] and [`Outbox`], with
//! faults in any order. Each slave has a pixel of its own, so that the film tells whose samples are in it.

use indigo_film::{FilmRecord, FilmSize, FilmState, LayerKind, Run, SavedFilm};
use indigo_net::ledger::Ledger;
use indigo_net::outbox::Outbox;
use proptest::prelude::*;
use std::ops::Range;

/// The most slaves that one story has, those that are killed too.
const MOST: usize = 64;
/// Slaves at a time.
const SLAVES: usize = 3;

fn film(seed: usize, first: u64, end: u64) -> SavedFilm {
    let size = FilmSize::new(MOST as u32, 1, 1).expect("a size");
    let mut film = FilmState::new(size, &[(LayerKind::PerPixel, "camera")]);
    let samples = end - first;
    film.layers[0].counts[seed] = samples as f64;
    film.layers[0].totals.n_samples = samples as f64;
    let runs = if samples > 0 { vec![Run { seed: seed as u64, first, end }] } else { vec![] };
    SavedFilm { film, record: Some(FilmRecord { runs, samples, ..FilmRecord::default() }) }
}

struct Slave {
    seed: usize,
    /// Where it began: those before are another's of the same seed.
    first: u64,
    /// Units that were rendered, and those of them that were drained.
    rendered: u64,
    drained: u64,
    /// Units of uploads that were refused.
    refused: Vec<Range<u64>>,
    outbox: Outbox,
    is_connected: bool,
}

impl Slave {
    /// Of a seed, of which the master has the units before `first`.
    fn new(seed: usize, first: u64) -> Self {
        let (outbox, refused) = (Outbox::default(), vec![]);
        Self { seed, first, rendered: first, drained: first, refused, outbox, is_connected: false }
    }

    /// Units that the master may miss: they were refused, or another had them and is gone.
    fn excused(&self) -> u64 {
        self.first + self.refused.iter().map(|run| run.end - run.start).sum::<u64>()
    }

    fn drain(&mut self) {
        if self.outbox.next().is_none() && self.rendered > self.drained {
            self.outbox.push(film(self.seed, self.drained, self.rendered));
            self.drained = self.rendered;
        }
    }
}

struct World {
    master: Ledger,
    disk: SavedFilm,
    /// A save that has begun.
    copy: Option<SavedFilm>,
    slaves: Vec<Slave>,
    born: usize,
}

/// What happens next.
#[derive(Clone, Copy, Debug)]
enum Happening {
    Render,
    Upload,
    UploadIsLost,
    AnswerIsLost,
    UploadIsRepeated,
    UploadIsRefused,
    Report,
    Reconnect,
    SaveBegins,
    SaveEnds,
    SaveFails,
    MasterDies,
    SlaveDies,
    /// Another begins with the same seed where the master says.
    SlaveIsReplaced,
}

use Happening::{
    AnswerIsLost, MasterDies, Reconnect, Render, Report, SaveBegins, SaveEnds, SaveFails, SlaveDies,
    SlaveIsReplaced, Upload, UploadIsLost, UploadIsRefused, UploadIsRepeated,
};

impl World {
    fn new() -> Self {
        let disk = film(0, 0, 0);
        Self {
            master: Ledger::new(disk.clone()).expect("ours"),
            disk,
            copy: None,
            slaves: (0..SLAVES).map(|seed| Slave::new(seed, 0)).collect(),
            born: SLAVES,
        }
    }

    fn happens(&mut self, what: Happening, who: usize) {
        let slave = &mut self.slaves[who];
        match what {
            Render => slave.rendered += 1 + who as u64,
            Upload | AnswerIsLost if slave.is_connected => {
                slave.drain();
                let Some(film) = slave.outbox.next() else { return };
                let receipt = self.master.take(slave.seed as u64, film).expect("a sound upload");
                assert!(receipt.missing <= slave.excused(), "nothing is left out");
                if let Upload = what {
                    slave.outbox.saved(receipt.durable_end);
                    slave.outbox.received(receipt.generation);
                } else {
                    slave.is_connected = false;
                }
            }
            // An upload that was still being added when its slave came back, and that comes once more.
            UploadIsRepeated if slave.is_connected => {
                slave.drain();
                let Some(film) = slave.outbox.next() else { return };
                self.master.take(slave.seed as u64, film).expect("a sound upload");
                if self.copy.is_none() {
                    self.copy = Some(self.master.copy());
                }
                let receipt = self.master.take(slave.seed as u64, film).expect("a sound upload");
                assert!(receipt.is_repeated);
                slave.outbox.saved(receipt.durable_end);
                slave.outbox.received(receipt.generation);
            }
            UploadIsRefused if slave.is_connected => {
                slave.drain();
                let Some(film) = slave.outbox.next() else { return };
                let run = film.record.as_ref().expect("ours").runs[0];
                slave.refused.push(run.first..run.end);
                slave.outbox.discard();
            }
            UploadIsLost => {
                slave.drain();
                slave.is_connected = false;
            }
            Report if slave.is_connected => slave.outbox.saved(self.master.ends(slave.seed as u64).1),
            Reconnect => {
                let (merged, durable) = self.master.ends(slave.seed as u64);
                let generation = self.master.generation_of(slave.seed as u64, merged);
                assert_eq!(slave.outbox.rejoined(merged, durable, generation), 0, "nothing is lost");
                slave.is_connected = true;
            }
            SaveBegins => drop(self.copy.get_or_insert_with(|| self.master.copy()).clone()),
            SaveEnds => {
                if let Some(copy) = self.copy.take() {
                    self.master.saved(copy.record.clone().expect("ours"));
                    self.disk = copy;
                }
            }
            SaveFails => self.copy = None,
            MasterDies => {
                self.copy = None;
                self.master = Ledger::new(self.disk.clone()).expect("ours");
                self.slaves.iter_mut().for_each(|slave| slave.is_connected = false);
            }
            SlaveDies if self.born < MOST => {
                self.slaves[who] = Slave::new(self.born, 0);
                self.born += 1;
            }
            SlaveIsReplaced => {
                let first = self.master.ends(slave.seed as u64).0;
                self.slaves[who] = Slave::new(slave.seed, first);
            }
            _ => {}
        }
    }

    /// All is well again, and everybody sends all there is.
    fn ends(mut self) {
        for who in 0..SLAVES {
            self.happens(Reconnect, who);
            // What waits, and then what was rendered meanwhile.
            while self.slaves[who].drained < self.slaves[who].rendered
                || self.slaves[who].outbox.next().is_some()
            {
                self.happens(Upload, who);
            }
            let slave = &self.slaves[who];
            assert!(slave.outbox.len() <= 6 + slave.refused.len(), "memory is bounded");
        }
        let sum = self.master.copy();
        let record = sum.record.as_ref().expect("ours");
        let counts = &sum.film.layers[0].counts;
        for slave in &self.slaves {
            let runs: Vec<&Run> = record.runs.iter().filter(|run| run.seed == slave.seed as u64).collect();
            for unit in slave.first..slave.rendered {
                let was_refused = slave.refused.iter().any(|refused| refused.contains(&unit));
                let holders = runs.iter().filter(|run| (run.first..run.end).contains(&unit)).count();
                assert_eq!(holders, usize::from(!was_refused), "unit {unit} of {}", slave.seed);
            }
        }
        for (seed, count) in counts.iter().enumerate() {
            let units: u64 =
                record.runs.iter().filter(|r| r.seed == seed as u64).map(|r| r.end - r.first).sum();
            assert_eq!(*count, units as f64, "of {seed}");
        }
        assert_eq!(record.samples as f64, counts.iter().sum::<f64>());
    }
}

fn happening() -> impl Strategy<Value = Happening> {
    prop_oneof![
        6 => Just(Render),
        6 => Just(Upload),
        1 => Just(UploadIsLost),
        1 => Just(AnswerIsLost),
        1 => Just(UploadIsRepeated),
        2 => Just(Report),
        3 => Just(Reconnect),
        2 => Just(SaveBegins),
        2 => Just(SaveEnds),
        1 => Just(SaveFails),
        1 => Just(MasterDies),
        1 => Just(SlaveDies),
        1 => Just(SlaveIsReplaced),
        1 => Just(UploadIsRefused),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2000, ..ProptestConfig::default() })]
    #[test]
    fn whatever_breaks(story in prop::collection::vec((happening(), 0..SLAVES), 1..200)) {
        let mut world = World::new();
        for (what, who) in story {
            world.happens(what, who);
        }
        world.ends();
    }
}

/// A master whose disk is full for long.
#[test]
fn saves_that_fail_again_and_again_lose_nothing() {
    let mut world = World::new();
    world.happens(Reconnect, 0);
    for _ in 0..20 {
        for what in [Render, Upload, SaveBegins, SaveFails] {
            world.happens(what, 0);
        }
        assert!(world.slaves[0].outbox.len() <= 5);
    }
    world.happens(MasterDies, 0);
    world.ends();
}

/// The same where uploads were refused between, so that the oldest films do not adjoin.
#[test]
fn saves_that_fail_past_a_gap_lose_nothing_and_take_no_memory() {
    let mut world = World::new();
    world.happens(Reconnect, 0);
    let round = [Render, Upload, SaveBegins, SaveFails];
    for what in round.into_iter().chain([Render, UploadIsRefused]) {
        world.happens(what, 0);
    }
    for _ in 0..20 {
        for what in round {
            world.happens(what, 0);
        }
        assert!(world.slaves[0].outbox.len() <= 5);
    }
    world.happens(MasterDies, 0);
    world.ends();
}

/// A slave dies with what it has not sent, and nothing else.
#[test]
fn a_slave_that_dies_loses_what_it_has_not_sent() {
    let mut world = World::new();
    for what in [Reconnect, Render, Upload, Render, SlaveDies] {
        world.happens(what, 2);
    }
    assert_eq!(world.master.copy().film.layers[0].counts[2], 3.0);
    world.ends();
}
