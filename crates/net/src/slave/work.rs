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
        let options = Options { threads, seed, ..Options::default() };
        let used =
            FilmRecord { runs: vec![Run { seed, first: 0, end: merged_end }], ..FilmRecord::default() };
        let session = Session::start_beside(scene, &options, &used).map_err(|error| error.to_string())?;
        let engine = Engine::start(session, program.to_owned())
            .map_err(|error| format!("there is no thread for the session: {error}"))?;
        Ok(Self { record, engine, outbox: Outbox::default() })
    }
}
