//! Fuzzing with memory counted.

use indigo_testkit::allocation::{Counting, peak_of};

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// Feeds damaged `seeds` to `target`.
pub fn fuzz(seeds: &[Vec<u8>], target: impl Fn(&[u8])) {
    indigo_fuzz::fuzz(seeds, |work| peak_of(work).1, target);
}
