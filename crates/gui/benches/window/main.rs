//! What the window costs: its part of the time to a number of samples, processor time while it rests, and the time from a
//! control's move to the picture.
//!
//! `cargo xtask bench window` builds the console, too, and provides the display. Each part can be run alone, by its name.

#[path = "../../src/engine/develop.rs"]
#[expect(dead_code, reason = "the window reads more of a picture")]
mod develop;
mod moves;
mod rest;
mod samples;
#[path = "../../tests/stories/screen.rs"]
#[expect(dead_code, reason = "stories do more with it")]
mod screen;
#[path = "../../src/shrink.rs"]
mod shrink;

use std::path::Path;

/// A part and what it is called.
type Part = (&'static str, fn(&Path));

const PARTS: [Part; 3] = [("samples", samples::measure), ("rest", rest::measure), ("moves", moves::measure)];

fn main() {
    // Cargo says `--bench`.
    let wanted: Vec<String> = std::env::args().skip(1).filter(|word| !word.starts_with('-')).collect();
    let folder = screen::scratch("bench");
    for (name, measure) in PARTS {
        if wanted.is_empty() || wanted.iter().any(|word| word == name) {
            measure(&folder);
        }
    }
    std::fs::remove_dir_all(&folder).expect("our own files");
}

/// A scene that comes with the program.
fn scene() -> String {
    concat!(env!("CARGO_MANIFEST_DIR"), "/../../testscenes/cornell_box.igs").to_owned()
}

/// The middle one.
fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}
