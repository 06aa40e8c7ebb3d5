//! Getting ready to render: what it takes is found, and what it writes can be written.

use crate::claim::Claim;
use crate::flags::Arguments;
use crate::messages::{Messages, clock, count, scaled};
use crate::status::{BAD_INPUT, FAILED};
use crate::{logical_cores, paths, program};
use indigo_film::SavedFilm;
use indigo_render::denoise::Denoiser;
use indigo_render::first_hits::SceneFirstHits;
use indigo_render::output::{OutputPaths, SaveJob};
use indigo_render::{Halt, Options, Session, SessionError, preview};
use indigo_scene::schema::settings::MOST_THREADS;
use indigo_scene::{Development, OutputSettings, Scene};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, SystemTime};

/// A render that can begin: what it takes was found, and what it writes can be written.
pub struct Prepared {
    /// The scene.
    pub scene: Arc<Scene>,
    /// What a session is told to do.
    pub options: Options,
    /// What is saved, and where to.
    pub job: SaveJob,
    /// Keep others away from the picture's name.
    _picture: Picture,
    _claim: Claim,
}

/// Gets ready to render a scene.
///
/// `saved` is the film to go on with, if any; `named` is the picture's path, if the user has given one; `read` are the files
/// that the scene was read from.
///
/// # Errors
/// The exit status where that cannot be; the reason was told.
pub fn prepare(
    scene: Arc<Scene>,
    read: &[PathBuf],
    arguments: &Arguments,
    saved: Option<&SavedFilm>,
    named: Option<PathBuf>,
    messages: &mut dyn Messages,
) -> Result<Prepared, u8> {
    describe(&scene, messages);
    say_no_halt(arguments, messages);
    // Before anything is written.
    if let Some(Err(error)) = saved.map(|saved| Session::check(&scene, saved)) {
        return Err(fail(&error, messages));
    }
    let picture = match Picture::new(named, &scene, arguments, messages) {
        Ok(picture) => picture,
        Err(error) => {
            messages.error(&format!("there can be no picture in renders: {error}"));
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
        denoiser: denoiser(&development, messages),
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
        messages.error(&error);
        return Err(BAD_INPUT);
    }
    if let Some(path) = preview {
        preview_aperture(&scene, &path, messages);
    }
    if arguments.output.is_some() {
        say_missing_folder(picture.path(), messages);
    }
    // Now rather than after hours of rendering.
    if let Err(error) = job.check_writable() {
        messages.error(&error.to_string());
        return Err(FAILED);
    }
    let claim = Claim::of(&job.paths.igi(), messages)?;
    Ok(Prepared { scene, options, job, _picture: picture, _claim: claim })
}

/// What to say where a file that is to be written is one of those that were read.
pub fn overwrites(written: impl IntoIterator<Item = PathBuf>, read: &[PathBuf]) -> Option<String> {
    reads_too(written, read).map(|file| {
        format!(
            "the scene reads {}, which would be overwritten: give the picture another name, or that file",
            file.display()
        )
    })
}

/// The first of the files that are to be written which is one of those that are read, by whatever name.
pub fn reads_too(written: impl IntoIterator<Item = PathBuf>, read: &[PathBuf]) -> Option<PathBuf> {
    written.into_iter().find(|path| {
        let Ok(path) = path.canonicalize() else { return false };
        read.iter().any(|file| file.canonicalize().is_ok_and(|file| file == path))
    })
}

/// Says that a folder will be made, should it be a slip of the pen.
pub fn say_missing_folder(file: &Path, messages: &mut dyn Messages) {
    if let Some(folder) = file.parent().filter(|folder| !folder.as_os_str().is_empty() && !folder.exists()) {
        messages.say(&format!("note: the folder {} is new", folder.display()));
    }
}

/// Says why there is no session; the exit status.
pub fn fail(error: &SessionError, messages: &mut dyn Messages) -> u8 {
    messages.error(&error.to_string());
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
        messages: &mut dyn Messages,
    ) -> std::io::Result<Self> {
        let Some(path) = named else {
            return paths::reserve_picture(&scene.output.scene_path, SystemTime::now()).map(Self::Reserved);
        };
        if arguments.output.as_deref().is_some_and(|given| Path::new(given) != path) {
            messages.say(&format!("note: the picture is written to {}", path.display()));
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

/// The seed that a film was last rendered with; without a film the first of all.
fn seed_of(saved: Option<&SavedFilm>) -> u64 {
    saved.and_then(|s| s.record.as_ref()?.runs.last()).map_or(0, |run| run.seed)
}

/// Says what is gone on with.
pub fn describe_film(path: Option<&str>, saved: Option<&SavedFilm>, messages: &mut dyn Messages) {
    let (Some(path), Some(SavedFilm { film, record: Some(record) })) = (path, saved) else { return };
    let spp = record.samples as f64 / film.size.pixels() as f64;
    let time = clock(Duration::try_from_secs_f64(record.elapsed_s).unwrap_or_default());
    messages.say(&format!("Going on with {path}: {spp:.1} spp, {time} of rendering"));
}

fn describe(scene: &Scene, messages: &mut dyn Messages) {
    let s = scene.stats();
    messages.say(&format!(
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
        messages.say(&format!(
            "note: strictly speaking max_num_consec_rejections = {} biases the picture: after so many rejections in a \
             row a mutation is accepted whatever it is",
            metropolis.max_consecutive_rejections
        ));
    }
    if let Some(n) = scene.output.halt_samples_per_pixel.filter(|n| n.fract() != 0.0) {
        messages
            .say(&format!("note: whole samples are taken: halting at {} per pixel, not at {n}", n.ceil()));
    }
}

/// Says that what was given as a halting condition is none: numbers that are not positive mean never, as in scenes.
fn say_no_halt(arguments: &Arguments, messages: &mut dyn Messages) {
    for given in &arguments.settings {
        let is_halt = ["halt_time", "halt_samples_per_pixel"].contains(&given.setting);
        if is_halt && given.value.parse().is_ok_and(|value: f64| value <= 0.0) {
            messages.say(&format!("note: {} {} is never, as without it", given.option, given.value));
        }
    }
}

/// A scene with an aperture shape of its own gets a picture of it, beside that of the scene. It is for looking at: a
/// failure costs a warning.
fn preview_aperture(scene: &Scene, path: &Path, messages: &mut dyn Messages) {
    match preview::save_aperture(scene.camera.aperture(), path) {
        Ok(()) => messages.say(&format!("Saved {}", path.display())),
        Err(error) => messages.warn(&error.to_string()),
    }
}

/// What denoises, if that is asked for and there is such a thing: a picture is rendered either way.
pub fn denoiser(development: &Development, messages: &mut dyn Messages) -> Option<Arc<Denoiser>> {
    if !development.output.denoised {
        return None;
    }
    if development.picture.foreground_alpha {
        messages.say("note: coverage by the foreground is not denoised");
        return None;
    }
    match Denoiser::find() {
        Ok(denoiser) => Some(Arc::new(denoiser)),
        Err(error) => {
            messages.warn(&format!("no denoised picture: {error}"));
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
