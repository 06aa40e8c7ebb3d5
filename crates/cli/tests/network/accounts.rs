//! What logs tell of uploads, added up.

use std::collections::{BTreeMap, BTreeSet};

/// A log of `--log-json`.
pub struct Log(pub String);

/// An upload that was acknowledged.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Upload {
    pub seed: u64,
    pub first: u64,
    pub end: u64,
    pub samples: u64,
}

impl Log {
    /// The uploads that it tells of as added or sent.
    pub fn uploads(&self) -> impl Iterator<Item = Upload> + '_ {
        let is_upload =
            |line: &&str| line.contains("\"event\":\"added\"") || line.contains("\"event\":\"sent\"");
        // A line that its writer was killed in is none.
        self.0.lines().filter(|line| line.ends_with('}')).filter(is_upload).map(|line| Upload {
            seed: number(line, "seed"),
            first: number(line, "first_unit"),
            end: number(line, "end_unit"),
            samples: number(line, "samples"),
        })
    }
}

pub fn number(line: &str, name: &str) -> u64 {
    let value = line.split(&format!("\"{name}\":")).nth(1).unwrap_or_else(|| panic!("no {name}: {line}"));
    let digits: String = value.trim_start_matches('"').chars().take_while(char::is_ascii_digit).collect();
    digits.parse().unwrap_or_else(|_| panic!("{name} is no number: {line}"))
}

/// Samples of one seed up to unit `end`, by what the logs tell. An upload that was sent again, alone or with others, is in
/// the logs more than once; so is what a working master rendered again after a death, in other pieces. Some of all those
/// follow one another from the first unit to the last.
pub fn samples_up_to(logs: &[Log], seed: u64, end: u64) -> u64 {
    let uploads = logs.iter().flat_map(Log::uploads).filter(|upload| upload.seed == seed);
    // In the order of their first units: how a place is reached is known before anything goes on from there.
    let pieces: BTreeSet<Upload> = uploads.collect();
    let mut reached = BTreeMap::from([(0, 0)]);
    for piece in &pieces {
        let Some(before) = reached.get(&piece.first) else { continue };
        let samples = before + piece.samples;
        assert_eq!(
            *reached.entry(piece.end).or_insert(samples),
            samples,
            "{piece:?}: units are always the same"
        );
    }
    *reached.get(&end).unwrap_or_else(|| panic!("the logs tell of {pieces:?}, and the film ends at {end}"))
}
