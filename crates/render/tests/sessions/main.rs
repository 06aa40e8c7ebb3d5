//! Sessions: the same seed is the same picture, counts are exact, and nothing hangs.
//!
//! Waiting has a limit everywhere, so that what would hang fails instead.

#[path = "../common/mod.rs"]
mod common;

mod again;
mod determinism;
mod direct;
mod draining;
mod error;
mod halting;
mod light_groups;
mod regions;
mod resuming;

use common::text::{background, flat_camera, grey, scene_file, settings, uniform};
use indigo_film::FilmState;
use indigo_render::{Event, Halt, HaltReason, Options, Progress, Session};
use indigo_scene::Scene;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// No session of these tests has work for longer, even on a slow and busy machine.
const PATIENCE: Duration = Duration::from_mins(1);

/// A sphere on a floor under a lamp and a sky: paths of all lengths, and noise. 48 by 48 output
/// pixels: more than one tile.
fn small_scene(super_sample: u32, more_settings: &str) -> Arc<Scene> {
    small_scene_with(super_sample, |text| {
        text.replace("<cache_trees>", &format!("{more_settings}<cache_trees>"))
    })
}

/// The same with its text changed.
fn small_scene_with(super_sample: u32, change: impl Fn(String) -> String) -> Arc<Scene> {
    let text =
        settings(48, "").replace("<super_sample_factor>1", &format!("<super_sample_factor>{super_sample}"));
    let text = scene_file(&[
        text,
        flat_camera([0.0, -4.0, 1.5], [0.0, 4.0, -1.0], 0.5),
        grey("grey", 0.6),
        "<plane><normal>0 0 1</normal><dist>0</dist><material_name>grey</material_name></plane>".to_owned(),
        "<sphere><center>0 0 0.7</center><radius>0.7</radius><material_name>grey</material_name></sphere>"
            .to_owned(),
        format!(
            "<rectanglelight><pos>0 0 3</pos><width>1</width><height>1</height><spectrum>{}</spectrum></rectanglelight>",
            uniform(1e5)
        ),
        background(&uniform(1e4)),
    ]);
    Arc::new(common::scene(&change(text)))
}

/// A sphere and a lamp in the air: for every technique and driver.
fn room(more_settings: &str) -> Arc<Scene> {
    Arc::new(common::scene(&scene_file(&[
        // Of what is given twice the last counts.
        settings(48, more_settings),
        flat_camera([0.0, -4.0, 1.5], [0.0, 4.0, -1.0], 0.5),
        grey("grey", 0.6),
        "<sphere><center>0 0 0.7</center><radius>0.7</radius><material_name>grey</material_name></sphere>"
            .to_owned(),
        format!(
            "<rectanglelight><pos>0 0 3</pos><width>1</width><height>1</height><spectrum>{}</spectrum></rectanglelight>",
            uniform(1e5)
        ),
    ])))
}

fn options(threads: usize, samples_per_pixel: u64) -> Options {
    Options {
        threads,
        seed: 11,
        halt: Halt { samples_per_pixel: Some(samples_per_pixel), ..Halt::default() },
        epoch: Duration::from_millis(5),
        deterministic: true,
        estimates_error: false,
    }
}

/// Waits for the end.
fn finish(session: &mut Session) -> (HaltReason, Progress) {
    let deadline = Instant::now() + PATIENCE;
    loop {
        match session.wait(Duration::from_millis(50)) {
            Event::Halted(reason, progress) => return (reason, progress),
            Event::Progress(p) => assert!(Instant::now() < deadline, "the session hangs at {p:?}"),
        }
    }
}

fn run(scene: &Arc<Scene>, options: &Options) -> (FilmState, HaltReason, Progress) {
    let mut session = Session::start(Arc::clone(scene), options).expect("threads");
    let (reason, progress) = finish(&mut session);
    (session.snapshot(), reason, progress)
}
