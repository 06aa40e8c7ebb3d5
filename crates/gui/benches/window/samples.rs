//! The time to a number of samples, by the window and by the console, in turn.

use crate::screen::Screen;
use crate::{median, scene};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::Instant;

/// Two runs of one program differ by some per cent on a machine that others use, too.
const PAIRS: usize = 7;
/// Half a minute: what happens but once, such as making the first pictures, is not all that is measured.
const SAMPLES_PER_PIXEL: &str = "60";
const SIZE: [u16; 2] = [1280, 800];

/// Seconds of a run.
struct Taken {
    /// Of rendering, as the picture tells.
    rendering: f64,
    /// From the start of the program until the picture was there.
    all: f64,
}

/// Measures, and tells.
pub fn measure(folder: &Path) {
    println!(
        "seconds to {SAMPLES_PER_PIXEL} samples per pixel: rendering (and all until the picture was there)"
    );
    let scene = saved_once(folder);
    let mut ratios = vec![];
    for pair in 0..PAIRS {
        // Neither always comes first, where a machine is faster after a rest.
        let (console, window) = if pair % 2 == 0 {
            let console = by_console(folder, &scene);
            (console, by_window(folder, &scene))
        } else {
            let window = by_window(folder, &scene);
            (by_console(folder, &scene), window)
        };
        let ratio = window.rendering / console.rendering;
        println!(
            "  console {:.2} ({:.2}), window {:.2} ({:.2}): {:+.1} %",
            console.rendering,
            console.all,
            window.rendering,
            window.all,
            100.0 * (ratio - 1.0)
        );
        ratios.push(ratio);
    }
    println!("  median {:+.1} %", 100.0 * (median(ratios) - 1.0));
}

/// The scene, saved at the end alone: that the picture is there tells the end.
fn saved_once(folder: &Path) -> String {
    const SETTINGS: &str = "<renderer_settings>";
    let text = std::fs::read_to_string(scene()).expect("the scene is there");
    assert!(text.contains(SETTINGS) && !text.contains("image_save_period"), "the scene has other settings");
    let never = format!("{SETTINGS}<image_save_period>1000000</image_save_period>");
    let path = folder.join("scene.igs");
    std::fs::write(&path, text.replace(SETTINGS, &never)).expect("the scene is written");
    path.display().to_string()
}

/// The console that was built beside the window.
fn console() -> PathBuf {
    let window = Path::new(env!("CARGO_BIN_EXE_indigo"));
    window.with_file_name(format!("indigo_console{}", std::env::consts::EXE_SUFFIX))
}

fn by_console(folder: &Path, scene: &str) -> Taken {
    let picture = folder.join("console.png");
    let start = Instant::now();
    let status = Command::new(console())
        .args([scene, "-haltspp", SAMPLES_PER_PIXEL, "-o"])
        .arg(&picture)
        .env("INDIGO_CACHE", folder)
        .stdin(Stdio::null())
        .stderr(Stdio::null())
        .status();
    let all = start.elapsed().as_secs_f64();
    assert!(status.expect("the console starts: cargo xtask bench window builds it").success());
    Taken { rendering: told_by(&picture), all }
}

fn by_window(folder: &Path, scene: &str) -> Taken {
    let picture = folder.join("window.png");
    drop(std::fs::remove_file(&picture));
    let start = Instant::now();
    let name = picture.display().to_string();
    let mut screen = Screen::start(folder, SIZE, &[scene, "-haltspp", SAMPLES_PER_PIXEL, "-o", &name]);
    screen.wait_for("picture", |_| picture.exists().then_some(()));
    Taken { rendering: told_by(&picture), all: start.elapsed().as_secs_f64() }
}

/// What a picture says of the time that rendering it took.
fn told_by(picture: &Path) -> f64 {
    let told =
        Command::new(console()).arg("--dumpmetadata").arg(picture).output().expect("the console starts");
    let told = String::from_utf8_lossy(&told.stdout);
    let line = told.lines().find_map(|line| line.split_once("render time elapsed"));
    let number = line.map(|(_, value)| value.trim_matches(|c: char| !c.is_ascii_digit() && c != '.'));
    number.and_then(|number| number.parse().ok()).unwrap_or_else(|| panic!("no time in {told}"))
}
