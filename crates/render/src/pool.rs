//! The pool for work that is not rendering: builds and development.

/// Runs a task on a rayon pool of `threads` threads (at least one, and no more than there are logical cores:
/// such work never waits, so more would only cost).
///
/// Library crates use rayon's current pool and never make one; this is where it comes from.
pub fn with_jobs<T: Send>(threads: usize, task: impl FnOnce() -> T + Send) -> T {
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    match rayon::ThreadPoolBuilder::new().num_threads(threads.clamp(1, cores)).build() {
        Ok(pool) => pool.install(task),
        // No threads to be had: the caller's own must do.
        Err(_) => task(),
    }
}
