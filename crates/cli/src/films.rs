//! What is done with saved films alone: adding them, and developing one again.

use crate::console::Console;
use crate::{refuse_scene, tell_findings};
use indigo_front::claim::Claim;
use indigo_front::flags::Arguments;
use indigo_front::load::with_load_options;
use indigo_front::messages::{Messages as _, say_saved};
use indigo_front::prepare::{denoiser, overwrites, reads_too, say_missing_folder};
use indigo_front::status::{BAD_INPUT, FAILED, RENDERED};
use indigo_front::{logical_cores, paths, program};
use indigo_render::output::{OutputPaths, SaveJob, write_film};
use indigo_render::pool::with_jobs;
use indigo_render::saved::{FilmFileError, develop_film, merge_films};
use indigo_scene::{
    DIFFRACTION_OF_RAYS, FOREGROUND_ALPHA, LAYER_SETTING, LoadedDevelopment, load_development,
};
use std::path::{Path, PathBuf};

/// Adds films; the exit status.
pub fn merge(arguments: &Arguments, console: &mut Console) -> u8 {
    let paths: Vec<PathBuf> = arguments.files.iter().map(PathBuf::from).collect();
    let output = arguments.output.as_ref().map(PathBuf::from);
    if let Some(film) = reads_too(output, &paths) {
        console.error(&format!(
            "-merge reads {}, which would be overwritten: give the sum another name",
            film.display()
        ));
        return BAD_INPUT;
    }
    let sum = match merge_films(&paths) {
        Ok(sum) => sum,
        Err(error) => return fail(&error, console),
    };
    // The command line was checked for two films and an output.
    let (Some(sum), Some(output)) = (sum, &arguments.output) else { return BAD_INPUT };
    let Some(record) = &sum.record else {
        console.error(&format!("{}: a film of another program cannot be added to", arguments.files[0]));
        return BAD_INPUT;
    };
    say_missing_folder(Path::new(output), console);
    let _claim = match Claim::for_moment(Path::new(output), console) {
        Ok(claim) => claim,
        Err(status) => return status,
    };
    match with_jobs(logical_cores(), || write_film(Path::new(output), &sum.film, record)) {
        Ok(path) => {
            let spp = record.samples as f64 / sum.film.size.pixels() as f64;
            console.say(&format!("Saved {}: {} films, {spp:.1} spp", path.display(), paths.len()));
            RENDERED
        }
        Err(error) => {
            console.error(&error.to_string());
            FAILED
        }
    }
}

/// Develops a film by the settings of a scene; the exit status.
pub fn tone_map(arguments: &Arguments, console: &mut Console) -> u8 {
    // The command line was checked for just these.
    let [scene, film, picture] = &arguments.files[..] else { return BAD_INPUT };
    let picture = match paths::picture_named(picture) {
        Ok(picture) => picture,
        Err(reason) => {
            console.error(&format!("{picture}: {reason}"));
            return BAD_INPUT;
        }
    };
    let loaded = with_load_options(scene, arguments, |options| load_development(scene, options));
    let (loaded, read): (LoadedDevelopment, _) = match loaded {
        Ok(loaded) => loaded,
        Err(message) => return refuse_scene(scene, message, arguments, console),
    };
    if !tell_findings(scene, &loaded.sink, &loaded.sources, arguments, console) {
        return FAILED;
    }
    let Some(mut development) = loaded.development else { return BAD_INPUT };
    let developed = match develop_film(Path::new(film), &development.picture, development.size) {
        Ok(developed) => developed,
        Err(error) => return fail(&error, console),
    };
    if developed.image.size != development.size {
        console.warn(&format!(
            "the film is {}, the scene asks for {}: the picture has the film's size",
            developed.image.size, development.size
        ));
    }
    if developed.record.is_none() && developed.refused > 0 {
        console.warn(&format!(
            "{} pixels of the film {film} hold what is no number: they are black",
            developed.refused
        ));
    }
    let said = |setting| developed.record.as_ref().and_then(|record| record.setting(setting));
    let is_true = |setting| said(setting) == Some("true");
    if developed.record.is_some() && said(FOREGROUND_ALPHA).is_none() {
        let taken = if development.picture.foreground_alpha { "what hides the background" } else { "light" };
        console.warn(&format!(
            "the film {film} does not say whether it was rendered with {FOREGROUND_ALPHA}, as it is of an older \
             version: it is taken for {taken}, as in the scene"
        ));
    } else if is_true(FOREGROUND_ALPHA) != development.picture.foreground_alpha {
        let (holds, asked) = if is_true(FOREGROUND_ALPHA) {
            ("what hides the background, and no light", "false")
        } else {
            ("light", "true")
        };
        console.error(&format!(
            "the film {film} holds {holds}, but in the scene {FOREGROUND_ALPHA} is {asked}: a film is developed \
             with this setting as it was rendered"
        ));
        return BAD_INPUT;
    }
    if developed.record.is_some() && said(LAYER_SETTING) != development.light_layers.as_deref() {
        console.warn(&format!(
            "the film {film} was rendered with other layers of lights, or layers of other colours, than the scene has: their \
             colours are those of the film, and of layers that it does not know by name nothing is turned up or down"
        ));
    }
    if development.picture.diffraction.is_some() && is_true(DIFFRACTION_OF_RAYS) {
        console.warn(
            "light is diffracted twice: when the film was rendered, by its rays, and now by the filter; set \
             post_process_diffraction to false, as it was then",
        );
    }
    // The film is there already.
    development.output.igi = false;
    let paths = OutputPaths::new(picture);
    if development.output.layers_exr {
        console.say(
            "note: the layers are made while a scene is rendered, not of a film: no EXR with layers is saved",
        );
    }
    let denoiser = denoiser(&development, console);
    let job = SaveJob {
        development,
        paths,
        version: program(),
        threads: logical_cores(),
        first_hits: None,
        denoiser,
    };
    if let Some(error) = overwrites(job.files(), &read) {
        console.error(&error);
        return BAD_INPUT;
    }
    say_missing_folder(&job.paths.png, console);
    let _claim = match Claim::for_moment(&job.paths.igi(), console) {
        Ok(claim) => claim,
        Err(status) => return status,
    };
    if say_saved(&job.save_developed(developed), console) { RENDERED } else { FAILED }
}

/// Says what is wrong with a film; the exit status.
pub fn fail(error: &FilmFileError, console: &mut Console) -> u8 {
    console.error(&error.to_string());
    if matches!(error, FilmFileError::Mismatch { .. }) { BAD_INPUT } else { FAILED }
}
