//! What the heap is asked for, counted per thread by an allocator.
//!
//! ```
//! use indigo_testkit::allocation::{self, Counting};
//!
//! #[global_allocator]
//! static ALLOCATOR: Counting = Counting;
//!
//! let before = allocation::held();
//! let bytes = vec![0u8; 1000];
//! assert_eq!(allocation::held() - before, 1000);
//! # drop(bytes);
//! ```
#![allow(unsafe_code)]

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;

/// The system's allocator, counting what the calling thread asks for and gives back.
#[derive(Clone, Copy, Debug)]
pub struct Counting;

thread_local! {
    static CALLS: Cell<u64> = const { Cell::new(0) };
    static HELD: Cell<isize> = const { Cell::new(0) };
    static PEAK: Cell<isize> = const { Cell::new(0) };
}

/// How often this thread has asked for memory or given it back.
pub fn calls() -> u64 {
    CALLS.get()
}

/// Bytes that this thread has asked for and not given back; below 0 where it gave back what others asked for.
pub fn held() -> isize {
    HELD.get()
}

/// The most bytes that `work` held at once above what was held before, and its answer.
pub fn peak_of<T>(work: impl FnOnce() -> T) -> (T, usize) {
    let before = held();
    PEAK.set(before);
    let answer = work();
    (answer, (PEAK.get() - before) as usize)
}

fn count(change: isize) {
    // A thread that is ending has no counters left.
    let _ = CALLS.try_with(|calls| calls.set(calls.get() + 1));
    let _ = HELD.try_with(|held| {
        held.set(held.get() + change);
        let _ = PEAK.try_with(|peak| peak.set(peak.get().max(held.get())));
    });
}

// SAFETY: every call goes to the system's allocator unchanged; counting allocates nothing. A block that grows counts as a
// new one beside the old, since the system may copy it; one that shrinks keeps its place.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        count(layout.size() as isize);
        // SAFETY: as the caller promised.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        count(-(layout.size() as isize));
        // SAFETY: as the caller promised.
        unsafe { System.dealloc(pointer, layout) }
    }

    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, new_size: usize) -> *mut u8 {
        if new_size > layout.size() {
            count(new_size as isize);
            count(-(layout.size() as isize));
        } else {
            count(new_size as isize - layout.size() as isize);
        }
        // SAFETY: as the caller promised.
        unsafe { System.realloc(pointer, layout, new_size) }
    }
}
