//! `indigo`: a window in which a picture is watched while it grows, and finished.

mod action;
mod app;
mod comparison;
mod controls;
mod dialog;
mod engine;
mod log;
mod panels;
mod part;
mod question;
mod queue;
mod recent;
mod scene_file;
mod shrink;
mod signals;
mod state;
mod theme;
mod view;
mod words;
mod work;

use eframe::egui;
use indigo_front::flags::{self, Arguments};
use indigo_front::status::{BAD_INPUT, FAILED, RENDERED};
use indigo_front::{VERSION, cpu};
use std::io::Write as _;
use std::process::ExitCode;

/// The size of the window when it is opened for the first time, in points.
const FIRST_SIZE: [f32; 2] = [1280.0, 800.0];
/// The least that all panels fit in.
const LEAST_SIZE: egui::Vec2 = egui::vec2(960.0, 600.0);

fn main() -> ExitCode {
    ExitCode::from(run())
}

fn run() -> u8 {
    if let Err(message) = cpu::check() {
        // It is one of its own already, as the console says it.
        eprintln!("{message}");
        return FAILED;
    }
    let arguments = match flags::parse(std::env::args_os().skip(1)) {
        Ok(arguments) => arguments,
        Err(message) => return refuse(&message, BAD_INPUT),
    };
    if arguments.help {
        return answer(&format!("{}{}", words::HELP, flags::help("indigo [SCENE.igs]")));
    }
    if arguments.version {
        return answer(&format!("{VERSION}\n"));
    }
    if let Some(option) = only_of_console(&arguments) {
        return refuse(&words::only_of_console(option), BAD_INPUT);
    }
    if !has_display() {
        return refuse(words::NO_DISPLAY, FAILED);
    }
    match open_window(arguments) {
        Ok(()) => RENDERED,
        // What the system says of this is the place in somebody's source.
        Err(eframe::Error::WinitEventLoop(_)) => refuse(words::DEAF_DISPLAY, FAILED),
        Err(error) => refuse(&words::no_window(&error.to_string()), FAILED),
    }
}

/// An option that asks for something that no window is needed for.
fn only_of_console(arguments: &Arguments) -> Option<&'static str> {
    const OF_CONSOLE: &[&str] = &[
        "merge",
        "tonemap",
        "pack",
        "unpack",
        "upgrade",
        "list-files",
        "make-key",
        "dumpmetadata",
        "ptest",
        "check",
        "print-settings",
        "replay",
        "strategies",
        "man",
        "completions",
        "json",
        "quiet",
        "verbose",
        "log-json",
    ];
    arguments.given.iter().find(|name| OF_CONSOLE.contains(name)).copied()
}

/// Whether there is a screen. Where windows are not of X11 or Wayland there always is.
fn has_display() -> bool {
    let is_set = |name: &str| std::env::var_os(name).is_some_and(|value| !value.is_empty());
    !cfg!(all(unix, not(target_os = "macos"))) || is_set("DISPLAY") || is_set("WAYLAND_DISPLAY")
}

fn open_window(arguments: Arguments) -> eframe::Result {
    let viewport = egui::ViewportBuilder::default()
        .with_app_id("indigo")
        .with_title(words::PROGRAM)
        .with_inner_size(FIRST_SIZE)
        .with_min_inner_size(LEAST_SIZE)
        .with_drag_and_drop(true);
    let options = eframe::NativeOptions { viewport, ..eframe::NativeOptions::default() };
    let make = |context: &eframe::CreationContext<'_>| {
        Ok(Box::new(app::App::new(context, arguments)) as Box<dyn eframe::App>)
    };
    eframe::run_native("indigo", options, Box::new(make))
}

/// Writes what was asked for; the exit status.
fn answer(text: &str) -> u8 {
    match std::io::stdout().write_all(text.as_bytes()) {
        Ok(()) => RENDERED,
        Err(_) => FAILED,
    }
}

/// Says why there is no window; the exit status.
fn refuse(message: &str, status: u8) -> u8 {
    eprintln!("error: {message}");
    status
}
