//! `indigo_console`: renders a scene from the command line.

mod console;
mod films;
mod interrupts;
mod list_files;
mod net;
mod packs;
mod ptest;
mod render;
mod upgrade;

use console::Console;
use indigo_diag::{Diagnostic, Severity, Sink, SourceMap, quoted, shown, summary_to_json, to_json};
use indigo_front::flags::{self, Arguments, Role};
use indigo_front::load::load_scene;
use indigo_front::messages::{Messages as _, Verbosity, count};
use indigo_front::status::{BAD_INPUT, FAILED, RENDERED};
use indigo_front::{VERSION, cpu, logical_cores, paths};
use indigo_render::output::write_strategies;
use indigo_render::pool::with_jobs;
use indigo_render::saved::read_film;
use indigo_scene::codes::BAD_FILE;
use indigo_scene::{Loaded, Scene};
use std::path::Path;
use std::process::ExitCode;
use std::time::Instant;

fn main() -> ExitCode {
    if let Err(message) = cpu::check() {
        eprintln!("{message}");
        return ExitCode::from(FAILED);
    }
    let arguments = match flags::parse(std::env::args_os().skip(1)) {
        Ok(arguments) => arguments,
        Err(message) => {
            let json = flags::wants_json(std::env::args_os().skip(1));
            return ExitCode::from(refuse(&message, &mut Console::new(Verbosity::Usual).with_json(json)));
        }
    };
    let mut console = Console::new(arguments.verbosity).with_json(arguments.json);
    interrupts::catch(&mut console);
    ExitCode::from(run(&arguments, &mut console))
}

fn run(arguments: &Arguments, console: &mut Console) -> u8 {
    if arguments.help {
        return answer(&flags::help("indigo_console SCENE.igs"), console);
    }
    if arguments.man {
        return answer(&flags::man(), console);
    }
    if let Some(shell) = arguments.completions.as_deref().and_then(flags::completions) {
        return answer(&shell, console);
    }
    if arguments.version {
        return answer(&format!("{VERSION}\n"), console);
    }
    if let Some(path) = &arguments.dump_metadata {
        return dump_metadata(path, arguments.json, console);
    }
    if let Some(log) = &arguments.json_log
        && let Err(error) = console.log_json_to(Path::new(log))
    {
        console.error(&format!("no log can be kept: {log}: {error}"));
        return FAILED;
    }
    if arguments.merge {
        return films::merge(arguments, console);
    }
    if arguments.tone_map {
        return films::tone_map(arguments, console);
    }
    if arguments.pack {
        return packs::pack(arguments, console);
    }
    if arguments.unpack {
        return packs::unpack(arguments, console);
    }
    if arguments.upgrade {
        return upgrade::upgrade(arguments, console);
    }
    if arguments.list_files {
        return list_files::run(arguments, console);
    }
    if let Some(path) = &arguments.make_key {
        return net::make_key(Path::new(path), console);
    }
    if arguments.network == Some(Role::Slave) {
        return net::slave(arguments, console);
    }
    let Some(scene) = arguments.files.first() else {
        console.error("no scene is given: indigo_console SCENE.igs [options]; --help lists all options");
        return BAD_INPUT;
    };
    if arguments.performance_test {
        return ptest::run(scene, arguments, console);
    }
    let renders = !arguments.check && !arguments.print_settings;
    let named = match arguments.output.as_deref().filter(|_| renders).map(paths::picture_named).transpose() {
        Ok(named) => named,
        Err(reason) => {
            console.error(&format!("-o {}: {reason}", arguments.output.as_deref().unwrap_or_default()));
            return BAD_INPUT;
        }
    };
    // Before a scene that may take its time to be read.
    let saved = match arguments.resume.as_ref().map(|path| read_film(Path::new(path))).transpose() {
        Ok(saved) => saved,
        Err(error) => return films::fail(&error, console),
    };
    let start = Instant::now();
    let (loaded, read) = match load_scene(scene, arguments, None) {
        Ok(loaded) => loaded,
        Err(message) => return refuse_scene(scene, message, arguments, console),
    };
    let loading = start.elapsed();
    if let Some(settings) = &loaded.settings
        && settings.bool("logging")
        && renders
    {
        console.log_to(std::path::Path::new("log.txt"));
    }
    if !tell_findings(scene, &loaded.sink, &loaded.sources, arguments, console) {
        return FAILED;
    }
    for file in &read {
        console.detail(&format!("Read {}", file.display()));
    }
    console.detail(&format!("Loaded in {:.2} s", loading.as_secs_f64()));
    if arguments.print_settings && answer(&settings_listing(&loaded), console) != RENDERED {
        return FAILED;
    }
    match loaded.scene {
        Some(scene) => match (arguments.strategies, named) {
            _ if arguments.replay.is_some() => tell_sample(&scene, arguments, console),
            (Some(passes), Some(picture)) => show_strategies(&scene, arguments, passes, &picture, console),
            (_, named) if arguments.network.is_some() => {
                net::master(scene, &read, arguments, saved, named, console)
            }
            (_, named) => render::render(scene, &read, arguments, saved, named, console),
        },
        None if loaded.sink.has_errors() => BAD_INPUT,
        None => RENDERED,
    }
}

/// Writes what each strategy adds to the picture; the exit status.
fn show_strategies(
    scene: &Scene,
    arguments: &Arguments,
    passes: u32,
    picture: &Path,
    console: &mut Console,
) -> u8 {
    let seed = arguments.seed.unwrap_or_default();
    match with_jobs(logical_cores(), || write_strategies(scene, seed, passes, picture)) {
        Ok(path) => {
            console.say(&format!("Saved {}: {passes} samples per pixel of each picture", path.display()));
            RENDERED
        }
        Err(error) => {
            console.error(&error.to_string());
            FAILED
        }
    }
}

/// Prints a sample; the exit status.
fn tell_sample(scene: &Scene, arguments: &Arguments, console: &mut Console) -> u8 {
    let [seed, unit, index] = arguments.replay.unwrap_or_default();
    match indigo_render::replay(scene, seed, unit, index) {
        Ok(replay) => answer(&replay.to_string(), console),
        Err(0) => refuse(&format!("unit {unit} has no samples"), console),
        Err(all) => {
            let last = all - 1;
            refuse(&format!("unit {unit} has samples 0 to {last}, and so none of number {index}"), console)
        }
    }
}

/// Writes what was asked for; the exit status.
fn answer(text: &str, console: &mut Console) -> u8 {
    if console.answer(text) { RENDERED } else { FAILED }
}

/// Says what is wrong with what was given; the exit status.
fn refuse(message: &str, console: &mut Console) -> u8 {
    console.error(message);
    BAD_INPUT
}

/// Says why a scene is not even read, as text or JSON; the exit status.
fn refuse_scene(scene: &str, message: String, arguments: &Arguments, console: &mut Console) -> u8 {
    if !arguments.json {
        return refuse(&message, console);
    }
    let mut sink = Sink::new();
    sink.push(Diagnostic::error(BAD_FILE, None, message));
    if tell_findings(scene, &sink, &SourceMap::default(), arguments, console) { BAD_INPUT } else { FAILED }
}

/// Says what was found in a scene, as text or JSON; whether what was asked for arrived.
fn tell_findings(
    scene: &str,
    sink: &Sink,
    sources: &SourceMap,
    arguments: &Arguments,
    console: &mut Console,
) -> bool {
    if !arguments.json {
        report(scene, sink, sources, arguments.check, console);
        return true;
    }
    for diagnostic in found(sink) {
        console.log_diagnostic(diagnostic, sources);
    }
    console.answer(&json_report(scene, sink, sources))
}

/// Everything that was found in the scene, errors last so that they are seen.
fn found(sink: &Sink) -> Vec<&Diagnostic> {
    let mut found: Vec<_> = sink.diagnostics().iter().collect();
    found.sort_by_key(|d| d.severity == Severity::Error);
    found
}

fn report(scene: &str, sink: &Sink, sources: &SourceMap, is_check: bool, console: &mut Console) {
    for diagnostic in found(sink) {
        console.diagnose(diagnostic, sources);
    }
    if sink.dropped() > 0 {
        console.say(&format!("... and {} more", sink.dropped()));
    }
    if sink.has_errors() {
        console.say(&format!("{scene}: {}", count(sink.error_count(), "error")));
    } else if is_check {
        console.say(&format!("{scene}: no errors"));
    }
}

/// The same as a line of JSON each, and a summary.
fn json_report(scene: &str, sink: &Sink, sources: &SourceMap) -> String {
    let lines = found(sink).into_iter().map(|d| to_json(d, sources));
    lines.chain([summary_to_json(scene, sink)]).map(|line| line + "\n").collect()
}

fn settings_listing(loaded: &Loaded) -> String {
    let lines = loaded.settings.iter().flat_map(indigo_scene::Settings::listing);
    let text: Vec<String> = lines
        .map(|line| format!("{:<28} {:<24} ({})\n", line.name, shown(&line.value), line.origin.words()))
        .collect();
    text.concat()
}

/// Prints what a picture says of itself; the exit status.
fn dump_metadata(path: &str, json: bool, console: &mut Console) -> u8 {
    let entries = indigo_render::disk::read_limited(path.as_ref())
        .map_err(|e| e.to_string())
        .and_then(|bytes| indigo_imaging::png::read_metadata(&bytes).map_err(|e| e.to_string()));
    let line = |(key, value): &(String, String)| {
        if json {
            format!("{{\"key\":{},\"value\":{}}}\n", quoted(key), quoted(value))
        } else {
            format!("{}: {}\n", shown(key), shown(value))
        }
    };
    match entries {
        Ok(entries) => answer(&entries.iter().map(line).collect::<String>(), console),
        Err(error) => {
            console.error(&format!("{path}: {error}"));
            FAILED
        }
    }
}
