//! Processor time of a window that rests.

use crate::scene;
use crate::screen::Screen;
use std::path::Path;
use std::time::{Duration, Instant};

const SIZE: [u16; 2] = [1280, 800];
const TIME: Duration = Duration::from_secs(30);

/// Measures, and tells.
pub fn measure(folder: &Path) {
    println!("processor time over {} s, of one core", TIME.as_secs());
    {
        let screen = Screen::start(folder, SIZE, &[]);
        std::thread::sleep(Duration::from_secs(3));
        println!("  nothing is open: {:.2} %", 100.0 * part(&screen));
    }
    let screen = Screen::start(folder, SIZE, &[&scene(), "-o", "rest.png"]);
    std::thread::sleep(Duration::from_secs(10));
    screen.press(&[u32::from(b'p')]);
    // The threads finish what they are at, and the picture is shown with all of it.
    std::thread::sleep(Duration::from_secs(5));
    println!("  paused: {:.2} %", 100.0 * part(&screen));
}

/// The part of a core that the program takes.
fn part(screen: &Screen) -> f64 {
    let (start, before) = (Instant::now(), used(screen.program.id()));
    std::thread::sleep(TIME);
    (used(screen.program.id()) - before) / start.elapsed().as_secs_f64()
}

/// Seconds that a process has computed so far (proc_pid_stat(5)).
fn used(process: u32) -> f64 {
    /// Linux counts hundredths for programs, whatever its own clock.
    const TICKS_PER_SECOND: f64 = 100.0;
    let stat = std::fs::read_to_string(format!("/proc/{process}/stat")).expect("Linux tells");
    // The name may hold blanks, and stands in brackets. Behind it the times are the 12th and 13th.
    let (_, rest) = stat.rsplit_once(')').expect("a name in brackets");
    let ticks = rest.split_whitespace().skip(11).take(2);
    ticks.map(|ticks| ticks.parse::<f64>().expect("a number")).sum::<f64>() / TICKS_PER_SECOND
}
