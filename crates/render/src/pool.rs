//! The pool for work that is not rendering: builds and development.

/// Runs a task on a rayon pool of `threads` threads (at least one).
///
/// Library crates use rayon's current pool and never make one; this is where it comes from.
pub fn with_jobs<T: Send>(threads: usize, task: impl FnOnce() -> T + Send) -> T {
    match rayon::ThreadPoolBuilder::new().num_threads(threads.max(1)).build() {
        Ok(pool) => pool.install(task),
        // No threads to be had: the caller's own must do.
        Err(_) => task(),
    }
}
