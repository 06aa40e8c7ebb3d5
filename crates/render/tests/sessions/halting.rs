//! Counting, halting, pausing and failing.

use super::common::text::{background, flat_camera, grey, scene_file, settings, sphere, uniform};
use super::common::{scene, scene_with};
use super::{PATIENCE, finish, options, room, run, small_scene};
use indigo_imaging::{LinearImage, Metadata, exr};
use indigo_render::{Event, Halt, HaltReason, Options, Progress, Session};
use std::sync::Arc;
use std::time::{Duration, Instant};

const ENDLESS: Halt = Halt { time: None, samples_per_pixel: None, relative_error: None };

#[test]
fn every_pixel_gets_exactly_the_samples_that_were_asked_for() {
    for (threads, super_sample, spp, deterministic) in
        [(1, 1, 5, false), (3, 1, 7, false), (2, 2, 8, true), (2, 3, 4, false)]
    {
        let scene = small_scene(super_sample, "");
        let (film, reason, progress) = run(&scene, &Options { deterministic, ..options(threads, spp) });
        assert_eq!(reason, HaltReason::Samples);
        assert_eq!(progress.samples, 48 * 48 * spp);
        assert_eq!(progress.fraction, Some(1.0));
        assert!((film.samples_per_pixel() - spp as f64).abs() < 1e-12);
        // Each output pixel's block of internal ones holds its samples.
        let (side, width) = (super_sample as usize, film.size.internal_width() as usize);
        for y in 0..48 {
            for x in 0..48 {
                let block = (0..side * side).map(|i| (y * side + i / side) * width + x * side + i % side);
                assert_eq!(
                    block.map(|i| film.layers[0].counts[i]).sum::<f64>(),
                    spp as f64,
                    "pixel {x}, {y}"
                );
            }
        }
    }
}

/// Samples per pixel count over the whole picture, and a halt at some number of them gives no fewer.
#[test]
fn at_least_the_samples_that_were_asked_for() {
    let region = "<render_region><x1>5</x1><y1>17</y1><x2>44</x2><y2>31</y2></render_region>";
    for mode in [
        "<metropolis>true</metropolis>",
        "<hybrid>true</hybrid>",
        "<bidirectional>true</bidirectional><hybrid>true</hybrid>",
    ] {
        for more in ["", region] {
            let scene = room(&format!("{mode}{more}"));
            let (film, reason, progress) = run(&scene, &options(2, 3));
            assert_eq!(reason, HaltReason::Samples);
            let (found, what) = (film.samples_per_pixel(), format!("{mode}{more}"));
            assert_eq!(found, progress.samples_per_pixel, "{what}");
            // No more than a pair of units above.
            let most = 3.0 + f64::from(2048 + 1024) / f64::from(48 * 48);
            assert!((3.0..=most).contains(&found), "{what}: {found}");
        }
    }
}

/// A picture that is soon good enough soon ends, however seldom workers hand over otherwise.
#[test]
fn an_error_is_looked_for_soon() {
    let halt = Halt { relative_error: Some(0.5), ..ENDLESS };
    let options = Options { halt, epoch: Duration::from_hours(1), deterministic: false, ..options(2, 1) };
    let (_, reason, progress) = run(&small_scene(1, ""), &options);
    assert_eq!(reason, HaltReason::Error);
    assert!(progress.relative_error.is_some_and(|error| error <= 0.5));
}

/// How a render of a black ball in some light ends that halts at an error; the ball is round the camera, and then there are as
/// many as 200 samples per pixel, or before it.
fn halted(more: &str, light: &str, is_around: bool) -> (HaltReason, Progress) {
    let ball = sphere([0.0, if is_around { 0.0 } else { 4.0 }, 0.0], 1.0, "black");
    let camera = flat_camera([0.0; 3], [0.0, 1.0, 0.0], 0.5);
    let parts = [settings(12, more), camera, grey("black", 0.0), ball, light.to_owned()];
    let halt = Halt { relative_error: Some(0.5), samples_per_pixel: is_around.then_some(200), time: None };
    let options = Options { halt, deterministic: false, ..options(1, 0) };
    let (_, reason, progress) = run(&Arc::new(scene(&scene_file(&parts))), &options);
    (reason, progress)
}

/// Nothing is known of the light in a black picture unless there is none.
#[test]
fn a_black_picture_has_no_known_error_unless_the_scene_is_dark() {
    let even = background(&uniform(1e3));
    let off = "<layer_setting><enabled>false</enabled></layer_setting>";
    for mode in
        ["", "<metropolis>true</metropolis>", "<bidirectional>true</bidirectional><hybrid>true</hybrid>"]
    {
        let (reason, progress) = halted(mode, &even, true);
        assert_eq!((reason, progress.relative_error), (HaltReason::Samples, None), "{mode}");
        let black = background(&uniform(0.0));
        for (more, light) in
            [(mode.to_owned(), ""), (mode.to_owned(), &*black), (format!("{mode}{off}"), &*even)]
        {
            let (reason, progress) = halted(&more, light, false);
            assert_eq!((reason, progress.relative_error), (HaltReason::Error, Some(0.0)), "{more}{light}");
        }
        // Where something is lit the error is estimated as ever.
        let (reason, progress) = halted(mode, &even, false);
        assert!(reason == HaltReason::Error && progress.relative_error > Some(0.0), "{mode}: {progress:?}");
    }
    // A mask shows coverage, of which an edge has noise, light or not.
    let (reason, progress) = halted("<render_foreground_alpha>true</render_foreground_alpha>", "", false);
    assert!(reason == HaltReason::Error && progress.relative_error > Some(0.0), "{progress:?}");
}

/// No machine has so many threads, and no driver so much to do at once; it must neither fail nor take long.
#[test]
fn a_thousand_threads_start_and_stop() {
    for mode in ["", "<metropolis>true</metropolis>", "<hybrid>true</hybrid>"] {
        let scene = room(mode);
        let started = Instant::now();
        let mut session =
            Session::start(scene, &Options { halt: ENDLESS, deterministic: false, ..options(1024, 0) })
                .expect("threads");
        session.wait(Duration::from_millis(10));
        session.stop();
        assert_eq!(finish(&mut session).0, HaltReason::Stopped);
        assert!(started.elapsed() < Duration::from_secs(30), "{mode}: {:?}", started.elapsed());
    }
}

#[test]
fn time_halts_and_stop_stops() {
    let scene = small_scene(1, "");
    let halt = Halt { time: Some(Duration::from_millis(100)), ..Halt::default() };
    let (film, reason, progress) = run(&scene, &Options { halt, deterministic: false, ..options(2, 0) });
    assert_eq!(reason, HaltReason::Time);
    assert!(progress.elapsed >= Duration::from_millis(100));
    // What was counted is on the film.
    assert_eq!(film.layers[0].totals.n_samples, progress.samples as f64);

    for deterministic in [false, true] {
        let mut session =
            Session::start(Arc::clone(&scene), &Options { halt: ENDLESS, deterministic, ..options(2, 0) })
                .expect("threads");
        assert!(matches!(session.wait(Duration::from_millis(50)), Event::Progress(_)));
        session.stop();
        let (reason, progress) = finish(&mut session);
        assert_eq!(reason, HaltReason::Stopped);
        assert_eq!(session.snapshot().layers[0].totals.n_samples, progress.samples as f64);
    }
}

/// Waits until every worker rests, and returns the number of samples.
fn settled(session: &mut Session) -> u64 {
    let deadline = Instant::now() + PATIENCE;
    while !session.is_resting() {
        assert!(Instant::now() < deadline, "still rendering while paused");
        session.wait(Duration::from_millis(20));
    }
    session.progress().samples
}

#[test]
fn a_pause_rests_the_workers_and_the_clock_and_loses_nothing() {
    let scene = small_scene(1, "");
    for deterministic in [false, true] {
        let mut session =
            Session::start(Arc::clone(&scene), &Options { halt: ENDLESS, deterministic, ..options(2, 0) })
                .expect("threads");
        session.wait(Duration::from_millis(50));
        assert!(!session.is_resting(), "nothing was paused");
        session.pause();
        let samples = settled(&mut session);
        let clock = session.elapsed();
        assert_eq!(
            session.snapshot().layers[0].totals.n_samples,
            samples as f64,
            "all handed over in a pause"
        );
        std::thread::sleep(Duration::from_millis(300));
        assert!(
            session.elapsed().saturating_sub(clock) < Duration::from_millis(150),
            "the clock runs on in a pause"
        );
        assert_eq!(session.progress().samples, samples, "rendering goes on in a pause");
        session.resume();
        let deadline = Instant::now() + PATIENCE;
        while session.progress().samples == samples {
            assert!(Instant::now() < deadline, "nothing goes on after the pause");
            session.wait(Duration::from_millis(20));
        }
        session.pause();
        settled(&mut session);
        // A paused session can be stopped.
        session.stop();
        assert_eq!(finish(&mut session).0, HaltReason::Stopped);
    }
}

#[test]
fn a_pause_does_not_change_the_film() {
    let scene = small_scene(1, "");
    let (straight, ..) = run(&scene, &options(2, 40));
    let mut session = Session::start(Arc::clone(&scene), &options(2, 40)).expect("threads");
    session.pause();
    settled(&mut session);
    session.resume();
    assert_eq!(finish(&mut session).0, HaltReason::Samples);
    assert!(session.snapshot() == straight);
}

#[test]
fn dropping_a_session_ends_its_threads() {
    let scene = small_scene(1, "");
    for paused in [false, true] {
        let mut session =
            Session::start(Arc::clone(&scene), &Options { halt: ENDLESS, ..options(2, 0) }).expect("threads");
        if paused {
            session.pause();
        }
        drop(session);
    }
    assert_eq!(Arc::strong_count(&scene), 1, "a thread still holds the scene");
}

/// Whoever wants to know the error need not end by it.
#[test]
fn an_error_is_estimated_without_being_a_reason_to_stop() {
    let halt = Halt { samples_per_pixel: Some(8), ..ENDLESS };
    for estimates_error in [false, true] {
        let options = Options { halt, estimates_error, ..options(2, 0) };
        let (_, reason, progress) = run(&small_scene(1, ""), &options);
        assert_eq!((reason, progress.relative_error.is_some()), (HaltReason::Samples, estimates_error));
    }
}

/// The tile with the sphere, whose texture is gone, is the last of nine; what came before it stays.
#[test]
fn a_failure_leaves_what_was_done_before_it() {
    let mut broken = broken_scene(96, "1.5 4 -1.5", "0.3");
    broken.textures.clear();
    let broken = Arc::new(broken);
    for deterministic in [false, true] {
        let halt = Options { halt: ENDLESS, deterministic, epoch: Duration::from_hours(1), ..options(1, 0) };
        let (film, reason, progress) = run(&broken, &halt);
        assert!(matches!(reason, HaltReason::Failed(_)), "{reason:?}");
        assert_eq!(progress.samples, 8 * 32 * 32);
        let counted = film.layers[0].totals.n_samples;
        // With those of the ninth tile before the sphere.
        assert!(counted > progress.samples as f64 && counted < 9.0 * 32.0 * 32.0, "{counted}");
        assert_eq!(film.layers[0].counts.iter().sum::<f64>(), counted);
    }
}

/// A sphere whose texture is in a file, before a background.
fn broken_scene(side: u32, center: &str, radius: &str) -> indigo_scene::Scene {
    let texel = LinearImage { width: 1, height: 1, pixels: vec![[0.5; 4]] };
    let texture = exr::encode(&texel, &Metadata::default()).expect("a picture");
    let text = scene_file(&[
        settings(side, ""),
        flat_camera([0.0; 3], [0.0, 1.0, 0.0], 0.5),
        "<material><name>m</name><diffuse><albedo_texture><path>t.exr</path></albedo_texture></diffuse></material>"
            .to_owned(),
        format!("<sphere><center>{center}</center><radius>{radius}</radius><material_name>m</material_name></sphere>"),
        background(&uniform(1e4)),
    ]);
    scene_with(&text, [("t.exr", texture)])
}

/// A bug in the kernel, here a texture that is gone, ends the session with a message that says how to
/// see it again.
#[test]
fn a_worker_that_fails_is_reported() {
    for deterministic in [false, true] {
        let mut broken = broken_scene(48, "0 4 0", "1");
        broken.textures.clear();
        let (_, reason, _) =
            run(&Arc::new(broken), &Options { halt: ENDLESS, deterministic, ..options(3, 0) });
        let HaltReason::Failed(message) = reason else { panic!("{reason:?}") };
        assert!(message.contains("seed 11") && message.contains("unit"), "{message}");
    }
}
