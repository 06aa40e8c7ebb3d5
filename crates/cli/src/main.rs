//! `indigo_console`: renders a scene from the command line.

mod console;
mod cpu;
mod flags;
mod paths;
mod render;

use console::Console;
use flags::Arguments;
use indigo_diag::{Severity, Style, to_json, to_text};
use indigo_igs::Limits;
use indigo_render::disk::{DiskResolver, DiskTreeStore};
use indigo_render::pool::with_jobs;
use indigo_scene::{LoadOptions, Loaded, load};
use std::process::ExitCode;

/// Name and version, in the form that programs which call this one look for.
pub const VERSION: &str = concat!("Indigo Renderer v", env!("CARGO_PKG_VERSION"));

/// The picture was rendered.
const RENDERED: u8 = 0;
/// Rendering, or reading or writing files, failed.
const FAILED: u8 = 1;
/// The scene or the command line is wrong.
const BAD_INPUT: u8 = 2;

fn main() -> ExitCode {
    if let Err(message) = cpu::check() {
        eprintln!("{message}");
        return ExitCode::from(FAILED);
    }
    let mut console = Console::new();
    let arguments = match flags::parse(std::env::args_os().skip(1)) {
        Ok(arguments) => arguments,
        Err(message) => {
            console.say(&format!("error: {message}"));
            return ExitCode::from(BAD_INPUT);
        }
    };
    ExitCode::from(run(&arguments, &mut console))
}

fn run(arguments: &Arguments, console: &mut Console) -> u8 {
    if arguments.help {
        print!("{}", flags::help());
        return RENDERED;
    }
    if arguments.version {
        println!("{VERSION}");
        return RENDERED;
    }
    if let Some(path) = &arguments.dump_metadata {
        return dump_metadata(path, console);
    }
    let Some(scene) = &arguments.scene else {
        console.say("error: no scene is given: indigo_console SCENE.igs [options]; --help lists all options");
        return BAD_INPUT;
    };
    let loaded = load_scene(scene, arguments);
    if let Some(settings) = &loaded.settings
        && settings.bool("logging")
        && !arguments.check
        && !arguments.print_settings
    {
        console.log_to(std::path::Path::new("log.txt"));
    }
    report(&loaded, arguments.json, console);
    if arguments.print_settings {
        print_settings(&loaded);
        return if loaded.sink.has_errors() { BAD_INPUT } else { RENDERED };
    }
    match loaded.scene {
        Some(scene) => render::render(scene, arguments, console),
        None if loaded.sink.has_errors() => {
            console.say(&format!("{scene}: {}", count(loaded.sink.error_count(), "error")));
            BAD_INPUT
        }
        None => {
            console.say(&format!("{scene}: no errors"));
            RENDERED
        }
    }
}

fn load_scene(path: &str, arguments: &Arguments) -> Loaded {
    let resolver = DiskResolver::new(paths::resource_directories());
    let trees = DiskTreeStore::new(paths::tree_cache());
    let inifile = paths::inifile();
    let options = LoadOptions {
        resolver: &resolver,
        trees: &trees,
        inifile: inifile.as_deref(),
        overrides: &arguments.settings,
        limits: Limits::default(),
        check_only: arguments.check || arguments.print_settings,
    };
    with_jobs(render::logical_cores(), || load(path, &options))
}

/// Says everything that was found in the scene, errors last so that they are seen.
fn report(loaded: &Loaded, json: bool, console: &mut Console) {
    let style = if console.is_coloured() { Style::Colour } else { Style::Plain };
    let mut found: Vec<_> = loaded.sink.diagnostics().iter().collect();
    found.sort_by_key(|d| d.severity == Severity::Error);
    for diagnostic in found {
        if json {
            println!("{}", to_json(diagnostic, &loaded.sources));
        } else {
            console.say(to_text(diagnostic, &loaded.sources, style).trim_end());
        }
    }
    if loaded.sink.dropped() > 0 {
        console.say(&format!("... and {} more", loaded.sink.dropped()));
    }
}

fn count(n: usize, what: &str) -> String {
    format!("{n} {what}{}", if n == 1 { "" } else { "s" })
}

fn print_settings(loaded: &Loaded) {
    let Some(settings) = &loaded.settings else { return };
    for line in settings.listing() {
        println!("{:<28} {:<24} ({})", line.name, line.value, line.origin.words());
    }
}

fn dump_metadata(path: &str, console: &mut Console) -> u8 {
    let entries = std::fs::read(path)
        .map_err(|e| e.to_string())
        .and_then(|bytes| indigo_imaging::png::read_metadata(&bytes).map_err(|e| e.to_string()));
    match entries {
        Ok(entries) => {
            for (key, value) in entries {
                println!("{key}: {value}");
            }
            RENDERED
        }
        Err(error) => {
            console.say(&format!("error: {path}: {error}"));
            FAILED
        }
    }
}
