//! Fuzzing that needs no more than `cargo test`: sound files (the seeds) are damaged in many ways and fed to a reader.
//!
//! Each target is a test that calls [`fuzz`]. By default it tries a fixed number of cases, so that a test run is short
//! and always the same; the variable `INDIGO_FUZZ_SECONDS` makes it go on for so long, and `INDIGO_FUZZ_CASE` tries one
//! case alone. There is no coverage feedback: what finds faults is that the seeds reach every part of a format.

use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::time::{Duration, Instant};

mod damage;

pub use damage::{Rng, damage};

/// Cases of a target where no time is given: some seconds for all targets together.
const CASES: u64 = 1000;
/// A reader that takes longer over a small file is taken to hang.
const HANG: Duration = Duration::from_secs(20);
/// The longest input that a failure prints, in bytes.
const SHOWN: usize = 4096;

/// Feeds damaged `seeds` to `target`, which panics where it finds a fault.
///
/// # Panics
/// With the target's own panic, after a report of the case's number and input; where a case takes too long; and
/// without seeds.
#[allow(clippy::print_stderr)]
pub fn fuzz(seeds: &[Vec<u8>], target: impl Fn(&[u8])) {
    assert!(!seeds.is_empty(), "a fuzz target needs seeds");
    let try_case = |case: u64| {
        let input = input(seeds, case);
        let start = Instant::now();
        if let Err(panic) = catch_unwind(AssertUnwindSafe(|| target(&input))) {
            eprintln!("INDIGO_FUZZ_CASE={case} fails with {}", describe(&input));
            resume_unwind(panic);
        }
        let took = start.elapsed();
        assert!(took < HANG, "INDIGO_FUZZ_CASE={case} took {took:?} with {}", describe(&input));
    };
    if let Some(case) = variable("INDIGO_FUZZ_CASE") {
        return try_case(case);
    }
    let end = variable("INDIGO_FUZZ_SECONDS").map(|seconds| Instant::now() + Duration::from_secs(seconds));
    let mut case = 0;
    while end.map_or(case < CASES, |end| Instant::now() < end) {
        try_case(case);
        case += 1;
    }
}

/// The input of a case: the seeds as they are come first.
fn input(seeds: &[Vec<u8>], case: u64) -> Vec<u8> {
    if let Some(seed) = seeds.get(case as usize) {
        return seed.clone();
    }
    let mut rng = Rng::new(case);
    let seed = &seeds[rng.below(seeds.len())];
    let other = &seeds[rng.below(seeds.len())];
    damage(seed, other, &mut rng)
}

fn variable(name: &str) -> Option<u64> {
    std::env::var(name).ok()?.parse().ok()
}

fn describe(input: &[u8]) -> String {
    let shown = &input[..input.len().min(SHOWN)];
    format!("{} bytes: b\"{}\"", input.len(), shown.escape_ascii())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_fault_is_found() {
        let seeds = [b"width=7 height=9".to_vec()];
        let found = catch_unwind(|| fuzz(&seeds, |input| assert!(!input.ends_with(b"0"))));
        assert!(found.is_err());
    }

    #[test]
    fn cases_are_always_the_same_and_differ() {
        let seeds = [b"a sound file".to_vec(), b"another".to_vec()];
        assert_eq!(input(&seeds, 0), seeds[0]);
        assert_eq!(input(&seeds, 77), input(&seeds, 77));
        let different: std::collections::HashSet<_> = (0..100).map(|case| input(&seeds, case)).collect();
        assert!(different.len() > 80, "{}", different.len());
    }
}
