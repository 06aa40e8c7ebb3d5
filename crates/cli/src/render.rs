//! Rendering a scene until it is done, saving on the way.

use crate::console::{Console, clock, scaled};
use crate::flags::Arguments;
use crate::saver::Saver;
use crate::{BAD_INPUT, FAILED, RENDERED, VERSION, count, paths};
use indigo_film::SavedFilm;
use indigo_render::denoise::Denoiser;
use indigo_render::first_hits::SceneFirstHits;
use indigo_render::output::{OutputPaths, SaveJob, Saved};
use indigo_render::{Event, Halt, HaltReason, Options, Progress, Session, SessionError, preview};
use indigo_scene::schema::settings::MOST_THREADS;
use indigo_scene::{Development, OutputSettings, Scene};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant, SystemTime};

/// How often Ctrl-C was pressed.
static INTERRUPTS: AtomicUsize = AtomicUsize::new(0);

/// How often the progress line is renewed on a terminal, where it costs no room. Elsewhere the setting
/// `display_period` decides how often a line is written.
const ON_TERMINAL: Duration = Duration::from_millis(250);
/// The least time between lines of progress elsewhere, however small the setting: ten a second say all that can be read, and
/// a log is not flooded.
const LEAST_BETWEEN_LINES: Duration = Duration::from_millis(100);

/// Number of logical cores.
pub fn logical_cores() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}

/// A render that can begin: what it takes was found, and what it writes can be written.
pub struct Prepared {
    /// The scene.
    pub scene: Arc<Scene>,
    /// What a session is told to do.
    pub options: Options,
    /// What is saved, and where to.
    pub job: SaveJob,
    /// Keeps others away from the picture's name.
    _picture: Picture,
}

/// Renders a scene; the exit status.
///
/// `saved` is the film to go on with, if any; `named` is the picture's path, if the user has given one; `read` are the files
/// that the scene was read from.
pub fn render(
    scene: Scene,
    read: &[PathBuf],
    arguments: &Arguments,
    saved: Option<SavedFilm>,
    named: Option<PathBuf>,
    console: &mut Console,
) -> u8 {
    let prepared = match prepare(scene, read, arguments, saved.as_ref(), named, console) {
        Ok(prepared) => prepared,
        Err(status) => return status,
    };
    let Prepared { scene, options, job, .. } = &prepared;
    let session = match &saved {
        Some(saved) => Session::go_on(Arc::clone(scene), options, saved),
        None => Session::start(Arc::clone(scene), options),
    };
    match session {
        Ok(session) => {
            describe_film(arguments.resume.as_deref(), saved.as_ref(), console);
            // The session has a copy.
            drop(saved);
            follow(session, job, console)
        }
        Err(error) => fail(&error, console),
    }
}

/// Gets ready to render a scene; see [`render`].
///
/// # Errors
/// The exit status where that cannot be; the reason was told.
pub fn prepare(
    scene: Scene,
    read: &[PathBuf],
    arguments: &Arguments,
    saved: Option<&SavedFilm>,
    named: Option<PathBuf>,
    console: &mut Console,
) -> Result<Prepared, u8> {
    let scene = Arc::new(scene);
    describe(&scene, console);
    // Before anything is written.
    if let Some(Err(error)) = saved.map(|saved| Session::check(&scene, saved)) {
        return Err(fail(&error, console));
    }
    let picture = match Picture::new(named, &scene, arguments, console) {
        Ok(picture) => picture,
        Err(error) => {
            console.error(&format!("there can be no picture in renders: {error}"));
            return Err(FAILED);
        }
    };
    let options = Options {
        threads: scene.output.threads.unwrap_or_else(logical_cores).min(MOST_THREADS),
        seed: arguments.seed.unwrap_or_else(|| seed_of(saved)),
        halt: Halt { relative_error: arguments.halt_error, ..halt(&scene.output) },
        epoch: epoch(&scene.output),
        ..Options::default()
    };
    let mut development = scene.development();
    // A master that dies is started anew with its film.
    development.output.igi |= arguments.network.is_some();
    let job = SaveJob {
        denoiser: denoiser(&development, console),
        development,
        paths: OutputPaths::new(picture.path()),
        version: program(),
        threads: options.threads,
        first_hits: (scene.output.layers_exr || scene.output.denoised)
            .then(|| Arc::new(SceneFirstHits::of(Arc::clone(&scene)))),
    };
    let preview =
        scene.output.aperture_preview.then(|| picture.path().with_file_name(paths::APERTURE_PREVIEW));
    if let Some(error) = overwrites(job.files().chain(preview.clone()), read) {
        console.error(&error);
        return Err(BAD_INPUT);
    }
    if let Some(path) = preview {
        preview_aperture(&scene, &path, console);
    }
    if arguments.output.is_some() {
        say_missing_folder(picture.path(), console);
    }
    // Now rather than after hours of rendering.
    if let Err(error) = job.check_writable() {
        console.error(&error.to_string());
        return Err(FAILED);
    }
    catch_interrupts(console);
    Ok(Prepared { scene, options, job, _picture: picture })
}

/// What to say where a file that is to be written is one of those that were read, by whatever name.
pub fn overwrites(mut written: impl Iterator<Item = PathBuf>, read: &[PathBuf]) -> Option<String> {
    let is_read = |path: &PathBuf| {
        let Ok(path) = path.canonicalize() else { return false };
        read.iter().any(|file| file.canonicalize().is_ok_and(|file| file == path))
    };
    written.find(is_read).map(|file| {
        format!(
            "the scene reads {}, which would be overwritten: give the picture another name, or that file",
            file.display()
        )
    })
}

/// Says that a folder will be made, should it be a slip of the pen.
pub fn say_missing_folder(file: &Path, console: &mut Console) {
    if let Some(folder) = file.parent().filter(|folder| !folder.as_os_str().is_empty() && !folder.exists()) {
        console.say(&format!("note: the folder {} is new", folder.display()));
    }
}

/// Says why there is no session; the exit status.
pub fn fail(error: &SessionError, console: &mut Console) -> u8 {
    console.error(&error.to_string());
    if matches!(error, SessionError::Mismatch(_)) { BAD_INPUT } else { FAILED }
}

/// Where the picture goes.
enum Picture {
    Named(PathBuf),
    Reserved(paths::Reserved),
}

impl Picture {
    fn new(
        named: Option<PathBuf>,
        scene: &Scene,
        arguments: &Arguments,
        console: &mut Console,
    ) -> std::io::Result<Self> {
        let Some(path) = named else {
            return paths::reserve_picture(&scene.output.scene_path, SystemTime::now()).map(Self::Reserved);
        };
        if arguments.output.as_deref().is_some_and(|given| Path::new(given) != path) {
            console.say(&format!("note: the picture is written to {}", path.display()));
        }
        Ok(Self::Named(path))
    }

    fn path(&self) -> &Path {
        match self {
            Self::Named(path) => path,
            Self::Reserved(reserved) => &reserved.path,
        }
    }
}

/// Name, version and platform of the program.
pub fn program() -> String {
    format!("{VERSION}, {} {} build.", std::env::consts::OS, std::env::consts::ARCH)
}

/// The seed that a film was last rendered with; without a film the first of all.
fn seed_of(saved: Option<&SavedFilm>) -> u64 {
    saved.and_then(|s| s.record.as_ref()?.runs.last()).map_or(0, |run| run.seed)
}

/// Says what is gone on with.
pub fn describe_film(path: Option<&str>, saved: Option<&SavedFilm>, console: &mut Console) {
    let (Some(path), Some(SavedFilm { film, record: Some(record) })) = (path, saved) else { return };
    let spp = record.samples as f64 / film.size.pixels() as f64;
    let time = clock(Duration::try_from_secs_f64(record.elapsed_s).unwrap_or_default());
    console.say(&format!("Going on with {path}: {spp:.1} spp, {time} of rendering"));
}

fn describe(scene: &Scene, console: &mut Console) {
    let s = scene.stats();
    console.say(&format!(
        "{}: {} triangle{}, {}, {}, {}; {} × {} pixels",
        scene.output.scene_path,
        scaled(s.geometry.triangles as f64),
        if s.geometry.triangles == 1 { "" } else { "s" },
        count(s.objects, "object"),
        count(s.lights, "light"),
        count(s.materials, "material"),
        scene.film.size.width(),
        scene.film.size.height(),
    ));
    if let Some(metropolis) = scene.transport.metropolis {
        console.say(&format!(
            "note: strictly speaking max_num_consec_rejections = {} biases the picture: after so many rejections in a \
             row a mutation is accepted whatever it is",
            metropolis.max_consecutive_rejections
        ));
    }
    if let Some(n) = scene.output.halt_samples_per_pixel.filter(|n| n.fract() != 0.0) {
        console.say(&format!("note: whole samples are taken: halting at {} per pixel, not at {n}", n.ceil()));
    }
}

/// A scene with an aperture shape of its own gets a picture of it, beside that of the scene. It is for looking at: a
/// failure costs a warning.
fn preview_aperture(scene: &Scene, path: &Path, console: &mut Console) {
    match preview::save_aperture(scene.camera.aperture(), path) {
        Ok(()) => console.say(&format!("Saved {}", path.display())),
        Err(error) => console.warn(&error.to_string()),
    }
}

/// What denoises, if that is asked for and there is such a thing: a picture is rendered either way.
pub fn denoiser(development: &Development, console: &mut Console) -> Option<Arc<Denoiser>> {
    if !development.output.denoised {
        return None;
    }
    if development.picture.foreground_alpha {
        console.say("note: coverage by the foreground is not denoised");
        return None;
    }
    match Denoiser::find() {
        Ok(denoiser) => Some(Arc::new(denoiser)),
        Err(error) => {
            console.warn(&format!("no denoised picture: {error}"));
            None
        }
    }
}

fn halt(output: &OutputSettings) -> Halt {
    Halt {
        time: output.halt_time.and_then(|t| Duration::try_from_secs_f64(t).ok()),
        // A fraction of a sample cannot be taken: at least as many as were asked for.
        samples_per_pixel: output.halt_samples_per_pixel.map(|n| n.ceil() as u64),
        relative_error: None,
    }
}

/// Workers hand over as often as pictures are saved, or none would show what the last save did not.
fn epoch(output: &OutputSettings) -> Duration {
    let period = Duration::try_from_secs_f64(output.image_save_period).unwrap_or(Duration::MAX);
    Options::default().epoch.min(period)
}

/// Whether Ctrl-C was pressed.
pub fn is_interrupted() -> bool {
    INTERRUPTS.load(Ordering::Relaxed) > 0
}

/// The first Ctrl-C ends the render in good order, the second one leaves at once.
pub fn catch_interrupts(console: &mut Console) {
    #[expect(clippy::disallowed_methods, reason = "the second Ctrl-C asks for just that")]
    let leave = || std::process::exit(130);
    let caught = ctrlc::set_handler(move || {
        if INTERRUPTS.fetch_add(1, Ordering::Relaxed) > 0 {
            leave();
        }
    });
    if let Err(error) = caught {
        console.warn(&format!("Ctrl-C will not save the picture: {error}"));
    }
}

/// Time between lines of progress.
pub fn between_lines(output: &OutputSettings, console: &Console) -> Duration {
    if console.is_terminal() {
        ON_TERMINAL
    } else {
        Duration::try_from_secs_f64(output.display_period).unwrap_or(Duration::MAX).max(LEAST_BETWEEN_LINES)
    }
}

/// Follows a session to its end; the exit status.
fn follow(mut session: Session, job: &SaveJob, console: &mut Console) -> u8 {
    let output = &job.development.output;
    let mut saver = Saver::new(job);
    let mut last_line: Option<Instant> = None;
    let between = between_lines(output, console);
    loop {
        match session.wait(ON_TERMINAL.min(between).min(saver.until_due())) {
            Event::Progress(progress) => {
                if last_line.is_none_or(|t| t.elapsed() >= between) {
                    console.progress(&progress);
                    last_line = Some(Instant::now());
                }
                saver.tend(|| session.saved(&job.version), console);
                if is_interrupted() {
                    session.stop();
                }
            }
            Event::Halted(reason, progress) => return finish(&session, &reason, &progress, saver, console),
        }
    }
}

fn finish(
    session: &Session,
    reason: &HaltReason,
    progress: &Progress,
    mut saver: Saver,
    console: &mut Console,
) -> u8 {
    saver.wait_for_last(console);
    console.last_progress(progress);
    if let HaltReason::Failed(message) = reason {
        console.error(message);
    }
    let saved = session.saved(&saver.job().version);
    if saved.film.refused > 0 {
        console.warn(&format!(
            "{} contributions were not finite and were left out: this is a bug, please report it",
            saved.film.refused
        ));
    }
    let start = Instant::now();
    let is_saved = say_saved(&saver.job().save(&saved), console);
    console.detail(&format!("Developed and saved in {:.2} s", start.elapsed().as_secs_f64()));
    if is_saved && !matches!(reason, HaltReason::Failed(_)) { RENDERED } else { FAILED }
}

/// Names the files that were written and those that were not; whether all were.
pub fn say_saved(saved: &Saved, console: &mut Console) -> bool {
    for file in &saved.written {
        console.say(&format!("Saved {}", file.display()));
    }
    for error in &saved.failures {
        console.error(&error.to_string());
    }
    saved.failures.is_empty()
}
