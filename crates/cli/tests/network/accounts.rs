//! What logs tell of uploads, added up.

use std::collections::BTreeMap;

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
/// the logs more than once; those of the smallest pieces tell all.
pub fn samples_up_to(logs: &[Log], seed: u64, end: u64) -> u64 {
    // By the first unit; of several the one that ends first is a piece of the others.
    let mut pieces: BTreeMap<u64, Upload> = BTreeMap::new();
    for upload in logs.iter().flat_map(Log::uploads).filter(|upload| upload.seed == seed) {
        let piece = pieces.entry(upload.first).or_insert(upload);
        if upload.end < piece.end {
            *piece = upload;
        } else if upload.end == piece.end {
            assert_eq!(upload, *piece, "an upload is always the same");
        }
    }
    let (mut at, mut samples) = (0, 0);
    while at < end {
        let piece = pieces.get(&at).unwrap_or_else(|| {
            panic!("no log tells of unit {at} of seed {seed}, but {:?}", pieces.range(at..).next())
        });
        assert!(piece.end <= end, "the film ends at {end}, within {piece:?}");
        (at, samples) = (piece.end, samples + piece.samples);
    }
    samples
}
