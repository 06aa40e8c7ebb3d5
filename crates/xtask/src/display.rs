//! A display for the tests of the window, on machines that have none: Xvfb, and Mesa drawing without a graphics card.

use std::io::{BufRead, BufReader};
use std::process::{Child, Command, Stdio};

use crate::apt::Needed;
use crate::process::command;

/// A display without a screen, drivers that draw without a graphics card, and the libraries that the window looks for
/// when it starts.
const DISPLAY: Needed = Needed {
    what: "for the tests of the window Xvfb and Mesa's software drivers are",
    program: "Xvfb",
    packages: &[
        "xvfb",
        "libgl1-mesa-dri",
        "libgl1",
        "libegl1",
        "libxkbcommon-x11-0",
        "libx11-xcb1",
        "libxcursor1",
        "libxi6",
        "libxrandr2",
    ],
};
/// Wide enough for the window with all its panels.
const SCREEN: &str = "1920x1200x24";

/// A display for the tests of a command, and the environment by which they find it. Linux gets one of its own, so that no window
/// opens on the desktop and nobody's mouse disturbs; elsewhere the desktop serves.
///
/// # Errors
/// What is not installed and cannot be.
pub fn for_tests(tests: &mut Command) -> Result<Option<Display>, String> {
    if !cfg!(target_os = "linux") {
        return Ok(None);
    }
    DISPLAY.ensure()?;
    let display = Display::start()?;
    tests.env("DISPLAY", &display.name).env_remove("WAYLAND_DISPLAY");
    tests.env("LIBGL_ALWAYS_SOFTWARE", "1").env("WINIT_UNIX_BACKEND", "x11");
    Ok(Some(display))
}

/// A display without a screen, which goes when this does.
pub struct Display {
    server: Child,
    /// What `DISPLAY` must be.
    name: String,
}

impl Display {
    /// Starts one under a number that is free, which the server itself finds and tells.
    fn start() -> Result<Self, String> {
        let arguments = ["-displayfd", "1", "-screen", "0", SCREEN, "-nolisten", "tcp"];
        let mut server = command("Xvfb", &arguments)
            .stdout(Stdio::piped())
            .spawn()
            .map_err(|error| DISPLAY.wanted(&format!("Xvfb: {error}")))?;
        let mut number = String::new();
        if let Some(said) = server.stdout.take() {
            // An error reads as a server that says nothing.
            let _ = BufReader::new(said).read_line(&mut number);
        }
        let number = number.trim();
        let display = Self { server, name: format!(":{number}") };
        match number.parse::<u16>() {
            Ok(_) => Ok(display),
            Err(_) => Err(format!("Xvfb did not tell the number of its display but `{number}`")),
        }
    }
}

impl Drop for Display {
    fn drop(&mut self) {
        // It may have ended by itself.
        let _ = self.server.kill();
        let _ = self.server.wait();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Where there is a server to be started.
    #[test]
    fn two_displays_are_two_and_go_when_they_are_dropped() {
        if !crate::apt::is_there("Xvfb") {
            return;
        }
        let socket = |display: &Display| format!("/tmp/.X11-unix/X{}", &display.name[1..]);
        let pair = [Display::start().unwrap(), Display::start().unwrap()];
        assert_ne!(pair[0].name, pair[1].name);
        let sockets = pair.each_ref().map(socket);
        assert!(sockets.iter().all(|path| std::fs::exists(path).unwrap()), "{sockets:?}");
        let servers = pair.each_ref().map(|display| display.server.id());
        drop(pair);
        for id in servers {
            assert!(!std::fs::exists(format!("/proc/{id}")).unwrap());
        }
    }
}
