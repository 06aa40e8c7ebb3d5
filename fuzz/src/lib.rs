//! Fuzzing that needs no more than `cargo test`: sound files (the seeds) are damaged in many ways and fed to a reader.
//!
//! Each target is a test that calls [`fuzz`]. By default it tries a fixed number of cases, so that a test run is short
//! and always the same; the variable `INDIGO_FUZZ_SECONDS` makes it go on for so long, `INDIGO_FUZZ_CASES` for so many
//! cases, and `INDIGO_FUZZ_CASE` tries one case alone. There is no coverage feedback: what finds faults is that the seeds
//! reach every part of a format.
//!
//! A target may neither panic nor hang nor take more than [`MEMORY`], which is measured by who calls: the targets have an
//! allocator that counts.

use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::time::{Duration, Instant};

mod damage;

pub use damage::{Rng, damage};

/// Cases of a target where no time is given: some seconds for all targets together.
const CASES: u64 = 1000;
/// A reader that takes longer over a small file is taken to hang.
const HANG: Duration = Duration::from_secs(20);
/// The most that a reader may hold at once over a small file, in bytes: what a file of some kilobytes says of its own size
/// must not be believed. A decoder's panic that its caller turns into an error may print a backtrace, for which the system
/// reads some 80 MB of names.
pub const MEMORY: usize = 160 << 20;
/// The longest input that a failure prints, in bytes.
const SHOWN: usize = 4096;

/// Feeds damaged `seeds` to `target`, which panics where it finds a fault. `peak_of` does a piece of work and gives the
/// most bytes that it held at once.
///
/// # Panics
/// With the target's own panic, after a report of the case's number and input; where a case takes too long or too much
/// memory; and without seeds.
#[allow(clippy::print_stderr)]
pub fn fuzz(seeds: &[Vec<u8>], peak_of: impl Fn(&mut dyn FnMut()) -> usize, target: impl Fn(&[u8])) {
    assert!(!seeds.is_empty(), "a fuzz target needs seeds");
    let try_case = |case: u64| {
        let input = input(seeds, case);
        let start = Instant::now();
        let mut outcome = Ok(());
        let peak = peak_of(&mut || outcome = catch_unwind(AssertUnwindSafe(|| target(&input))));
        if let Err(panic) = outcome {
            eprintln!("INDIGO_FUZZ_CASE={case} fails with {}", describe(&input));
            resume_unwind(panic);
        }
        let took = start.elapsed();
        assert!(took < HANG, "INDIGO_FUZZ_CASE={case} took {took:?} with {}", describe(&input));
        assert!(peak <= MEMORY, "INDIGO_FUZZ_CASE={case} held {peak} bytes with {}", describe(&input));
        peak
    };
    if let Some(case) = variable("INDIGO_FUZZ_CASE") {
        try_case(case);
        return;
    }
    let end = variable("INDIGO_FUZZ_SECONDS").map(|seconds| Instant::now() + Duration::from_secs(seconds));
    let cases = variable("INDIGO_FUZZ_CASES").unwrap_or(CASES);
    let (mut case, mut most) = (0, 0);
    while end.map_or(case < cases, |end| Instant::now() < end) {
        most = try_case(case).max(most);
        case += 1;
    }
    let thread = std::thread::current();
    let target = thread.name().unwrap_or("fuzzing");
    eprintln!("{target}: {case} cases, each with {:.1} MiB at most", most as f64 / f64::from(1 << 20));
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
    use indigo_testkit::allocation::{Counting, peak_of};

    #[global_allocator]
    static ALLOCATOR: Counting = Counting;

    fn fuzz(seeds: &[Vec<u8>], target: impl Fn(&[u8])) {
        super::fuzz(seeds, |work| peak_of(work).1, target);
    }

    #[test]
    fn a_fault_is_found() {
        let seeds = [b"width=7 height=9".to_vec()];
        let found = catch_unwind(|| fuzz(&seeds, |input| assert!(!input.ends_with(b"0"))));
        assert!(found.is_err());
    }

    #[test]
    fn greed_is_found() {
        let greedy = |input: &[u8]| drop(Vec::<u8>::with_capacity(MEMORY + input.len()));
        assert!(catch_unwind(|| fuzz(&[b"a file".to_vec()], greedy)).is_err());
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
