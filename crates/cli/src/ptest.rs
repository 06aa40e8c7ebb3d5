//! `-ptest`: how fast a scene is rendered here, by a fixed amount of work.

use crate::console::Console;
use crate::{refuse, refuse_scene, report, tell_findings};
use indigo_diag::quoted;
use indigo_front::flags::Arguments;
use indigo_front::load::with_resolver;
use indigo_front::messages::Messages as _;
use indigo_front::status::{BAD_INPUT, FAILED, RENDERED};
use indigo_front::{logical_cores, program};
use indigo_imaging::develop;
use indigo_render::pool::with_jobs;
use indigo_render::{Event, Halt, HaltReason, Options, Session};
use indigo_scene::schema::settings::MOST_THREADS;
use indigo_scene::{LoadOptions, Scene, load};
use std::fmt::Write as _;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Samples that a scene is rendered with unless it is told how many: some seconds on one core.
const SAMPLES: u64 = 4 << 20;

/// How often is looked whether each pixel has a sample, and from then on how far the render is.
const OFTEN: Duration = Duration::from_millis(1);
const SELDOM: Duration = Duration::from_millis(100);

/// A figure: its name, its value, and its unit.
type Figure = (&'static str, String, &'static str);

/// Measures; the exit status.
pub fn run(path: &str, arguments: &Arguments, console: &mut Console) -> u8 {
    match measure(path, arguments, console) {
        Ok(figures) => {
            let text = if arguments.json { as_json(&figures) } else { as_text(&figures) };
            if console.answer(&text) { RENDERED } else { FAILED }
        }
        Err(status) => status,
    }
}

fn measure(path: &str, arguments: &Arguments, console: &mut Console) -> Result<Vec<Figure>, u8> {
    let (read, load_time, scene) = load_cold(path, arguments, console)?;
    let pixels = scene.film.size.pixels() as u64;
    let passes = match arguments.settings.iter().rfind(|s| s.setting == "halt_samples_per_pixel") {
        // Checked with the scene.
        Some(_) => scene.output.halt_samples_per_pixel.map_or(1, |n| n.ceil() as u64),
        None => SAMPLES.div_ceil(pixels.max(1)),
    };
    let threads = scene.output.threads.unwrap_or_else(logical_cores).min(MOST_THREADS);
    let halt = Halt { samples_per_pixel: Some(passes), ..Halt::default() };
    let options = Options { threads, seed: arguments.seed.unwrap_or_default(), halt, ..Options::default() };
    let scene = Arc::new(scene);
    let start = Instant::now();
    let mut session =
        Session::start(Arc::clone(&scene), &options).map_err(|error| refuse(&error.to_string(), console))?;
    let threads_run = start.elapsed();
    let mut first_pass = None;
    let progress = loop {
        let event = session.wait(if first_pass.is_none() { OFTEN } else { SELDOM });
        let (Event::Progress(now) | Event::Halted(_, now)) = &event;
        // Of a region it is the region's.
        if now.samples_per_pixel >= 1.0 || matches!(event, Event::Halted(..)) {
            first_pass.get_or_insert_with(|| start.elapsed());
        }
        match event {
            // Elsewhere than on a terminal it would be a line each time.
            Event::Progress(progress) if console.is_terminal() && first_pass.is_some() => {
                console.progress(&progress);
            }
            Event::Progress(_) => {}
            Event::Halted(HaltReason::Failed(message), _) => {
                console.error(&message);
                return Err(FAILED);
            }
            Event::Halted(_, progress) => break progress,
        }
    };
    console.last_progress(&progress);
    let film = session.snapshot();
    let start = Instant::now();
    let picture = with_jobs(threads, || develop(&film, &scene.picture));
    let develop_time = start.elapsed();
    drop(picture);
    let seconds = progress.elapsed.as_secs_f64().max(f64::MIN_POSITIVE);
    let per_second = |n: u64| format!("{:.0}", n as f64 / seconds);
    let stats = scene.stats();
    let deciding = scene.identity.settings.iter().map(|(name, value)| format!("{name}={value}"));
    Ok(vec![
        ("program", program(), ""),
        ("scene", hex(&scene.identity.hash), ""),
        ("settings", deciding.collect::<Vec<_>>().join(" "), ""),
        ("technique", technique(&scene).to_owned(), ""),
        ("threads", threads.to_string(), ""),
        ("cores", logical_cores().to_string(), ""),
        ("triangles", stats.geometry.triangles.to_string(), ""),
        ("pixels", pixels.to_string(), ""),
        ("read", seconds_of(read), "s"),
        ("build", seconds_of(load_time.saturating_sub(read)), "s"),
        ("start", seconds_of(threads_run), "s"),
        ("first_pass", seconds_of(first_pass.unwrap_or_default()), "s"),
        ("render", seconds_of(progress.elapsed), "s"),
        ("develop", seconds_of(develop_time), "s"),
        ("samples", progress.samples.to_string(), ""),
        ("rays", progress.rays.to_string(), ""),
        ("samples_per_second", per_second(progress.samples), "1/s"),
        ("rays_per_second", per_second(progress.rays), "1/s"),
    ])
}

/// Loads a scene once so that the system has its files at hand, once to see how long reading takes, and once wholly,
/// with all trees built anew: the last two times, and the scene. The settings file of this machine does not count.
fn load_cold(
    path: &str,
    arguments: &Arguments,
    console: &mut Console,
) -> Result<(Duration, Duration, Scene), u8> {
    let loaded = with_resolver(path, |resolver, _| {
        let options = LoadOptions { overrides: &arguments.settings, ..LoadOptions::new(resolver) };
        let timed = |options: &LoadOptions| {
            let start = Instant::now();
            let loaded = with_jobs(logical_cores(), || load(path, options));
            (start.elapsed(), loaded)
        };
        let reading = LoadOptions { check_only: true, ..options };
        drop(timed(&reading));
        let (read, _) = timed(&reading);
        let (load_time, loaded) = timed(&options);
        (read, load_time, loaded)
    });
    let ((read, load_time, loaded), _) =
        loaded.map_err(|message| refuse_scene(path, message, arguments, console))?;
    let Some(scene) = loaded.scene else {
        let is_told = tell_findings(path, &loaded.sink, &loaded.sources, arguments, console);
        return Err(if is_told { BAD_INPUT } else { FAILED });
    };
    // With -json the figures are the only object.
    report(path, &loaded.sink, &loaded.sources, false, console);
    Ok((read, load_time, scene))
}

fn technique(scene: &Scene) -> &'static str {
    let t = &scene.transport;
    match (t.bidirectional, t.metropolis.is_some(), t.hybrid) {
        (false, false, _) => "path",
        (true, false, _) => "bidirectional",
        (false, true, false) => "path-metropolis",
        (true, true, false) => "bidirectional-metropolis",
        (false, true, true) => "path-hybrid",
        (true, true, true) => "bidirectional-hybrid",
    }
}

fn seconds_of(time: Duration) -> String {
    format!("{:.6}", time.as_secs_f64())
}

fn hex(bytes: &[u8]) -> String {
    bytes.iter().fold(String::new(), |mut text, byte| {
        // Writing to a string cannot fail.
        let _ = write!(text, "{byte:02x}");
        text
    })
}

fn as_text(figures: &[Figure]) -> String {
    let lines =
        figures.iter().map(|(name, value, unit)| format!("{name:<20} {value} {unit}").trim_end().to_owned());
    lines.map(|line| line + "\n").collect()
}

fn as_json(figures: &[Figure]) -> String {
    let field = |(name, value, _): &Figure| {
        // All that is not text is a number, in the form of JSON.
        let is_number = value.parse::<f64>().is_ok_and(f64::is_finite) && *name != "scene";
        format!("{}:{}", quoted(name), if is_number { value.clone() } else { quoted(value) })
    };
    format!("{{{}}}\n", figures.iter().map(field).collect::<Vec<_>>().join(","))
}
