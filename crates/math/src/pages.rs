//! Large arrays in huge pages.
//!
//! A ray touches a few dozen far-apart places of a tree; with pages of 4 KiB most of them also miss
//! the processor's table of pages. Measured: up to a tenth of the time of incoherent rays, and a
//! sixth of that of building, most of which was spent on getting small pages one by one. Getting them is also a third of
//! the time of developing a film, whose arrays are written once and read once.
#![allow(unsafe_code)]

/// Smaller arrays gain nothing.
const LARGE: usize = 4 << 20;

/// Room for so many items, in huge pages where that is much and the system has such pages to give.
pub fn with_capacity<T>(items: usize) -> Vec<T> {
    let mut empty = Vec::with_capacity(items);
    if items * size_of::<T>() >= LARGE {
        // Before anything is written: pages are chosen when they are first touched.
        advise(empty.spare_capacity_mut());
    }
    empty
}

/// A vector that has just been made of zeros, in huge pages if it is large. Zeros come with the pages, so nothing has been
/// written yet.
pub fn fresh<T>(mut zeros: Vec<T>) -> Vec<T> {
    if size_of_val(&*zeros) >= LARGE {
        advise(&mut zeros);
    }
    zeros
}

/// So many times the same item, in huge pages if that is much. For zeros of plain numbers [`fresh`] is quicker.
pub fn filled<T: Clone>(item: T, items: usize) -> Vec<T> {
    let mut vec = with_capacity(items);
    vec.resize(items, item);
    vec
}

/// The same items, in huge pages if there are many.
pub fn in_huge_pages<T: Copy>(items: &[T]) -> Vec<T> {
    let mut moved = with_capacity(items.len());
    moved.extend_from_slice(items);
    moved
}

#[cfg(target_os = "linux")]
fn advise<T>(memory: &mut [T]) {
    const PAGE: usize = 4096;
    let range = memory.as_mut_ptr_range();
    let start = range.start.cast::<u8>();
    let skipped = start.align_offset(PAGE);
    let length = (range.end.addr() - range.start.addr()).saturating_sub(skipped) & !(PAGE - 1);
    // SAFETY: whole pages inside memory that is exclusively borrowed; this advice changes neither
    // contents nor access, and that it may be refused does not matter.
    unsafe { libc::madvise(start.wrapping_add(skipped).cast(), length, libc::MADV_HUGEPAGE) };
}

#[cfg(not(target_os = "linux"))]
fn advise<T>(_memory: &mut [T]) {}
