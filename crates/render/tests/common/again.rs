//! What a failed test says of how to run it again, and how to look at any of its samples.
//!
//! Scenes are texts in memory: a test's thread remembers the last of them and how they were rendered, and a failure writes
//! them to files that the console program reads.

use indigo_scene::{Scene, TransportSettings};
use std::cell::RefCell;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::{fs, io};

/// Scenes that a thread remembers.
const KEPT: usize = 4;

/// The largest whole number of a scene file.
pub const MOST_REJECTIONS: i64 = 9_000_000_000_000_000;

/// The name of a scene's own file.
pub const SCENE: &str = "test.igs";

/// A scene and its renders.
struct Kept {
    hash: [u8; 32],
    /// Its files by name, [`SCENE`] among them.
    files: Vec<(String, Vec<u8>)>,
    runs: Vec<Run>,
}

/// Renders in one mode.
struct Run {
    transport: TransportSettings,
    /// The first and last seed, and units of work of each.
    seeds: [u64; 2],
    units: u64,
}

thread_local! {
    static SCENES: RefCell<Vec<Kept>> = const { RefCell::new(vec![]) };
}

/// Remembers a scene.
pub fn remember_scene<'a>(scene: &Scene, files: impl Iterator<Item = (&'a String, &'a Vec<u8>)>) {
    let files = files.map(|(name, bytes)| (name.clone(), bytes.clone())).collect();
    SCENES.with_borrow_mut(|scenes| {
        scenes.retain(|kept| kept.hash != scene.identity.hash);
        if scenes.len() == KEPT {
            scenes.remove(0);
        }
        scenes.push(Kept { hash: scene.identity.hash, files, runs: vec![] });
    });
}

/// Remembers a render of so many units.
pub fn remember_render(scene: &Scene, seed: u64, units: u64) {
    SCENES.with_borrow_mut(|scenes| {
        let Some(kept) = scenes.iter_mut().find(|kept| kept.hash == scene.identity.hash) else { return };
        match kept.runs.iter_mut().find(|run| run.transport == scene.transport && run.units == units) {
            Some(run) => run.seeds = [run.seeds[0].min(seed), run.seeds[1].max(seed)],
            None => kept.runs.push(Run { transport: scene.transport, seeds: [seed; 2], units }),
        }
    });
}

/// The command that runs the test at hand again, with the same seeds: they are fixed. And those that print any sample of
/// what it rendered.
pub fn replay() -> String {
    // The harness names a test's thread by the test.
    let thread = std::thread::current();
    let name = thread.name().unwrap_or_default().to_owned();
    let (package, program) = (env!("CARGO_PKG_NAME"), env!("CARGO_CRATE_NAME"));
    let mut told = format!("cargo test -p {package} --test {program} {name} -- --include-ignored");
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR"))
        .join("failed")
        .join(format!("{program}-{}", name.replace("::", "-")));
    SCENES.with_borrow(|scenes| {
        let runs = scenes.iter().flat_map(|kept| kept.runs.iter().map(move |run| (run, kept)));
        for (i, (run, kept)) in runs.enumerate() {
            let folder = folder.join(i.to_string());
            let _ = match write_files(&folder, run, kept) {
                Ok(scene) => writeln!(
                    told,
                    "\nany sample: cargo run --release -- {} -replay SEED:UNIT:INDEX, SEED from {} to {}, UNIT below {}",
                    scene.display(),
                    run.seeds[0],
                    run.seeds[1],
                    run.units
                ),
                Err(e) => writeln!(told, "\n{}: {e}", folder.display()),
            };
        }
    });
    told
}

fn write_files(folder: &Path, run: &Run, kept: &Kept) -> io::Result<PathBuf> {
    fs::create_dir_all(folder)?;
    for (name, bytes) in &kept.files {
        let path = folder.join(name);
        if name == SCENE {
            fs::write(path, in_mode(&String::from_utf8_lossy(bytes), &run.transport))?;
        } else {
            fs::write(path, bytes)?;
        }
    }
    Ok(folder.join(SCENE))
}

/// A scene's text with other settings of how light is carried.
fn in_mode(text: &str, transport: &TransportSettings) -> String {
    let mut settings = vec![
        ("max_depth", transport.max_depth.to_string()),
        ("bidirectional", transport.bidirectional.to_string()),
        ("metropolis", transport.metropolis.is_some().to_string()),
        ("hybrid", transport.hybrid.to_string()),
    ];
    if let Some(metropolis) = &transport.metropolis {
        settings.push(("large_mutation_prob", metropolis.large_mutation_prob.to_string()));
        settings.push(("max_change", metropolis.max_change.to_string()));
        // What a file can hold; more are as good as endless.
        let rejections = metropolis.max_consecutive_rejections.min(MOST_REJECTIONS);
        settings.push(("max_num_consec_rejections", rejections.to_string()));
    }
    settings.iter().fold(text.to_owned(), |text, (name, value)| with_setting(&text, name, value))
}

fn with_setting(text: &str, name: &str, value: &str) -> String {
    let (open, close) = (format!("<{name}>"), format!("</{name}>"));
    let element = format!("{open}{value}{close}");
    match (text.find(&open), text.find(&close)) {
        (Some(from), Some(to)) if from < to => {
            format!("{}{element}{}", &text[..from], &text[to + close.len()..])
        }
        _ => text.replacen("</renderer_settings>", &format!("{element}</renderer_settings>"), 1),
    }
}
