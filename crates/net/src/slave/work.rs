//! A scene that a slave renders, across all connections that are lost meanwhile.

use super::engine::Engine;
use crate::outbox::Outbox;
use indigo_film::{FilmRecord, Run};
use indigo_render::saved::blank_record;
use indigo_render::{Options, Session};
use indigo_scene::Scene;
use std::sync::Arc;

/// The scene, its session, and what is still needed of what that has rendered.
pub struct Work {
    scene: Arc<Scene>,
    /// Of the scene, as it must be for a master to be the same's.
    pub record: FilmRecord,
    /// The session.
    pub engine: Engine,
    /// Films that the master may still need.
    pub outbox: Outbox,
}

impl Work {
    /// Starts rendering behind the units of `seed` that the master has.
    ///
    /// # Errors
    /// Why there is no session, in words.
    pub fn start(
        scene: Scene,
        threads: usize,
        seed: u64,
        merged_end: u64,
        program: &str,
    ) -> Result<Self, String> {
        let scene = Arc::new(scene);
        let record = blank_record(&scene, program);
        let engine = engine(&scene, threads, seed, merged_end, program)?;
        Ok(Self { scene, record, engine, outbox: Outbox::default() })
    }

    /// Samples that are still to be sent.
    pub fn waiting_samples(&self) -> u64 {
        self.engine.untaken() + self.outbox.waiting_samples()
    }

    /// Renders on, behind what there is, if the session was told to end by a master that is no more; whether it was.
    ///
    /// # Errors
    /// As [`start`](Self::start).
    pub fn go_on(
        &mut self,
        threads: usize,
        seed: u64,
        merged_end: u64,
        program: &str,
    ) -> Result<bool, String> {
        let has_ended = self.engine.has_ended();
        if has_ended {
            let first = merged_end.max(self.outbox.end());
            self.engine = engine(&self.scene, threads, seed, first, program)?;
        }
        Ok(has_ended)
    }
}

/// A session of the units of a seed from `first`.
fn engine(
    scene: &Arc<Scene>,
    threads: usize,
    seed: u64,
    first: u64,
    program: &str,
) -> Result<Engine, String> {
    let options = Options { threads, seed, ..Options::default() };
    let used = FilmRecord { runs: vec![Run { seed, first: 0, end: first }], ..FilmRecord::default() };
    let session =
        Session::start_beside(Arc::clone(scene), &options, &used).map_err(|error| error.to_string())?;
    Engine::start(session, program.to_owned())
        .map_err(|error| format!("there is no thread for the session: {error}"))
}
