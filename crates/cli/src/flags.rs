//! The command line: one table, from which parsing, help and suggestions come.
//!
//! Long options of one dash are the manual's; each also works with two. Options may stand before or
//! after the scene.

use indigo_scene::Override;
use std::ffi::OsString;
use std::fmt::Write as _;

/// What an option does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Action {
    /// The option, for messages, sets a setting of `renderer_settings` to its value.
    Setting(&'static str, &'static str),
    /// The option, for messages, switches a setting on.
    SwitchOn(&'static str, &'static str),
    /// Sets the number of threads.
    Threads,
    /// Names the random sequence.
    Seed,
    /// Stops at an estimated error.
    HaltError,
    /// Names the picture.
    Output,
    /// Goes on with a saved film.
    Resume,
    /// Adds saved films.
    Merge,
    /// Develops a saved film.
    ToneMap,
    /// Writes what each strategy adds.
    Strategies,
    /// Reads and reports, without rendering.
    Check,
    /// Lists the settings.
    PrintSettings,
    /// Prints the text entries of a PNG.
    DumpMetadata,
    /// Diagnostics as JSON.
    Json,
    /// Prints the help.
    Help,
    /// Prints the version.
    Version,
}

/// An option.
#[derive(Debug)]
pub struct Flag {
    /// Name without dashes.
    pub name: &'static str,
    /// Another name, if any.
    pub alias: Option<&'static str>,
    /// What stands for its value in the help; `None` if it takes none.
    pub value: Option<&'static str>,
    /// What it does, for the help.
    pub doc: &'static str,
    /// What it does.
    pub action: Action,
}

const fn flag(name: &'static str, value: Option<&'static str>, action: Action, doc: &'static str) -> Flag {
    Flag { name, alias: None, value, doc, action }
}

/// All options.
pub static FLAGS: &[Flag] = &[
    flag(
        "halt",
        Some("SECONDS"),
        Action::Setting("-halt", "halt_time"),
        "Stop after this time of rendering.",
    ),
    flag(
        "haltspp",
        Some("N"),
        Action::Setting("-haltspp", "halt_samples_per_pixel"),
        "Stop at this number of samples per pixel, or a little above it.",
    ),
    flag(
        "halterror",
        Some("E"),
        Action::HaltError,
        "Stop when the picture's relative error is estimated to be E or less: the root mean square of the luminance's error over its mean. 0.01 is hardly visible. The true error is at most 1.2 times the estimate in 95 of 100 runs, if the light is not in a few pixels. Takes the memory of two more films.",
    ),
    flag(
        "o",
        Some("PATH"),
        Action::Output,
        "Write the picture to PATH (.png, which may be left out); other files take the same stem. Without it: renders/im_<UTC time>_<scene>.png.",
    ),
    flag(
        "r",
        Some("IGI"),
        Action::Resume,
        "Go on with the film saved in IGI (see save_igi). It must be of this scene with the same deciding settings. Its samples count towards -haltspp.",
    ),
    flag(
        "layers",
        None,
        Action::SwitchOn("-layers", "save_layers_exr"),
        "Also save an EXR with layers: the picture, albedo, normal, depth, numbers of objects and materials.",
    ),
    flag(
        "denoise",
        None,
        Action::SwitchOn("-denoise", "denoise"),
        "Also save a denoised picture, if the system has the library Open Image Denoise; INDIGO_OIDN may name its file.",
    ),
    flag(
        "merge",
        None,
        Action::Merge,
        "Add the films of independent renders, with different seeds, of one scene: --merge A.igi B.igi ... -o SUM.igi",
    ),
    flag(
        "tonemap",
        None,
        Action::ToneMap,
        "Develop a saved film by the settings of a scene, without rendering: --tonemap SCENE.igs FILM.igi PICTURE.png",
    ),
    flag(
        "t",
        Some("N"),
        Action::Threads,
        "Render with N threads, at most 1024. Without it: as many as there are logical cores.",
    ),
    flag(
        "seed",
        Some("N"),
        Action::Seed,
        "Choose the random sequence: the same seed gives the same picture. Without it: 0, or the seed of the film that is gone on with.",
    ),
    flag(
        "strategies",
        Some("N"),
        Action::Strategies,
        "For developers: write to -o, instead of the picture, a pyramid of small pictures of what each strategy of bidirectional path tracing adds, by N samples per pixel. Rows hold paths of 1 to 7 edges, columns those made with 0 to 7 vertices from the light; on the left as if there were no other strategy, on the right as they are weighted.",
    ),
    flag("check", None, Action::Check, "Read the scene and report what is wrong with it, without rendering."),
    flag(
        "print-settings",
        None,
        Action::PrintSettings,
        "List each setting, its value, and where the value comes from.",
    ),
    flag(
        "dumpmetadata",
        Some("PNG"),
        Action::DumpMetadata,
        "Print what a picture says about how it was rendered.",
    ),
    flag("json", None, Action::Json, "Report errors and warnings as JSON, a line each."),
    flag("help", None, Action::Help, "Print this help."),
    Flag {
        name: "version",
        alias: Some("v"),
        value: None,
        doc: "Print the version.",
        action: Action::Version,
    },
];

/// Options of the manual that this version does not have yet, by name: better a clear answer than a guess.
const NOT_YET: &[&str] = &["h", "n", "p", "ptest", "pack"];

/// The command line, understood.
#[derive(Debug, Default, PartialEq)]
#[expect(clippy::struct_excessive_bools, reason = "each is a switch of its own on the command line")]
pub struct Arguments {
    /// The scene; with `merge` or `tone_map` all files instead.
    pub files: Vec<String>,
    /// Settings.
    pub settings: Vec<Override<'static>>,
    /// Estimated relative error at which to stop.
    pub halt_error: Option<f64>,
    /// Seed of the random sequence, if one is asked for.
    pub seed: Option<u64>,
    /// Film to go on with.
    pub resume: Option<String>,
    /// Only add films.
    pub merge: bool,
    /// Only develop a film.
    pub tone_map: bool,
    /// Path of the picture.
    pub output: Option<String>,
    /// Only show what each strategy adds, by so many samples per pixel.
    pub strategies: Option<u32>,
    /// Only check.
    pub check: bool,
    /// Only list the settings.
    pub print_settings: bool,
    /// Only print a picture's metadata.
    pub dump_metadata: Option<String>,
    /// Diagnostics as JSON.
    pub json: bool,
    /// Only print the help.
    pub help: bool,
    /// Only print the version.
    pub version: bool,
}

/// Understands a command line.
///
/// # Errors
/// A sentence for the user, with the nearest option where one is misspelt.
pub fn parse(arguments: impl IntoIterator<Item = OsString>) -> Result<Arguments, String> {
    let mut parsed = Arguments::default();
    let mut rest = arguments.into_iter();
    while let Some(argument) = rest.next() {
        let argument = argument.into_string().map_err(|a| format!("{} is not Unicode text", a.display()))?;
        let Some(written) = argument.strip_prefix('-').filter(|a| !a.is_empty()) else {
            parsed.files.push(argument);
            continue;
        };
        let written = written.strip_prefix('-').unwrap_or(written);
        let (name, attached) = match written.split_once('=') {
            Some((name, value)) => (name, Some(value.to_owned())),
            None => (written, None),
        };
        let flag = find(name)?;
        let value = match (flag.value, attached) {
            (None, None) => String::new(),
            (None, Some(_)) => return Err(format!("-{} takes no value", flag.name)),
            (Some(_), Some(value)) => value,
            (Some(what), None) => rest
                .next()
                .and_then(|v| v.into_string().ok())
                .ok_or_else(|| format!("-{} needs a value: -{} {what}", flag.name, flag.name))?,
        };
        apply(flag, value, &mut parsed)?;
    }
    if parsed.strategies.is_some() && parsed.output.is_none() {
        return Err("-strategies needs the picture to write: -strategies 64 -o PICTURE.png".to_owned());
    }
    check_files(&parsed)?;
    Ok(parsed)
}

/// Whether there are as many files as what is asked for takes.
fn check_files(parsed: &Arguments) -> Result<(), String> {
    match (&parsed.files[..], parsed.merge, parsed.tone_map) {
        (_, true, true) => Err("-merge and -tonemap are two things to do; one is done at a time".to_owned()),
        ([] | [_], true, _) => {
            Err("-merge needs two or more films: --merge A.igi B.igi -o SUM.igi".to_owned())
        }
        (_, true, _) if parsed.output.is_none() => {
            Err("-merge needs the file to write: --merge A.igi B.igi -o SUM.igi".to_owned())
        }
        (_, true, _)
            if !parsed.output.as_ref().is_some_and(|path| path.to_ascii_lowercase().ends_with(".igi")) =>
        {
            Err("-merge writes a film: the name behind -o must end with .igi".to_owned())
        }
        (_, _, true) if parsed.output.is_some() => {
            Err("-o is for renders; the third file of -tonemap is the picture".to_owned())
        }
        (files, _, true) if files.len() != 3 => {
            Err("-tonemap needs a scene, a film and a picture: --tonemap SCENE.igs FILM.igi PICTURE.png"
                .to_owned())
        }
        ([first, second, ..], false, false) => {
            Err(format!("two scenes are given, {first} and {second}; one is rendered at a time"))
        }
        _ => Ok(()),
    }
}

fn find(name: &str) -> Result<&'static Flag, String> {
    if let Some(flag) = FLAGS.iter().find(|f| f.name == name || f.alias == Some(name)) {
        return Ok(flag);
    }
    if NOT_YET.contains(&name) {
        return Err(format!("-{name} is not in this version yet"));
    }
    let hint = indigo_diag::nearest(name, FLAGS.iter().map(|f| f.name));
    Err(match hint {
        Some(hint) => format!("unknown option -{name}; did you mean -{hint}?"),
        None => format!("unknown option -{name}; --help lists all options"),
    })
}

fn apply(flag: &Flag, value: String, parsed: &mut Arguments) -> Result<(), String> {
    match flag.action {
        // The setting's own declaration checks the value.
        Action::Setting(option, setting) => parsed.settings.push(Override { option, setting, value }),
        Action::SwitchOn(option, setting) => {
            parsed.settings.push(Override { option, setting, value: "true".to_owned() });
        }
        Action::Threads => {
            parsed.settings.push(Override { option: "-t", setting: "num_threads", value });
            let implied = "auto_choose_num_threads";
            parsed.settings.push(Override { option: "", setting: implied, value: "false".to_owned() });
        }
        Action::Seed => {
            let seed = value.parse();
            parsed.seed =
                Some(seed.map_err(|_| {
                    format!("-seed needs a whole number from 0 to {}, not {value}", u64::MAX)
                })?);
        }
        Action::HaltError => {
            let error = value.parse().ok().filter(|e: &f64| *e > 0.0 && e.is_finite());
            parsed.halt_error =
                Some(error.ok_or_else(|| {
                    format!("-halterror needs a number above 0, such as 0.01, not {value}")
                })?);
        }
        Action::Output => parsed.output = Some(value),
        Action::Resume => parsed.resume = Some(value),
        Action::Merge => parsed.merge = true,
        Action::ToneMap => parsed.tone_map = true,
        Action::Strategies => {
            let passes = value.parse().ok().filter(|n: &u32| *n > 0);
            parsed.strategies =
                Some(passes.ok_or_else(|| format!("-strategies needs a whole number above 0, not {value}"))?);
        }
        Action::Check => parsed.check = true,
        Action::PrintSettings => parsed.print_settings = true,
        Action::DumpMetadata => parsed.dump_metadata = Some(value),
        Action::Json => parsed.json = true,
        Action::Help => parsed.help = true,
        Action::Version => parsed.version = true,
    }
    Ok(())
}

/// The help.
pub fn help() -> String {
    let mut text = String::from(
        "Indigo renders scenes by the laws of light.\n\n\
         Usage: indigo_console SCENE.igs [options]\n\n\
         Rendering goes on, and the picture is saved again and again, until Ctrl-C or a halting\n\
         condition. Exit status: 0 rendered, 1 rendering or writing failed, 2 bad scene or usage.\n\n\
         Options (with one dash or two, before or after the scene):\n",
    );
    for flag in FLAGS {
        let alias = flag.alias.map(|a| format!(", -{a}")).unwrap_or_default();
        let left = format!("-{}{alias} {}", flag.name, flag.value.unwrap_or_default());
        let lines = wrap(flag.doc, 72);
        // Writing to a string cannot fail.
        let _ = writeln!(text, "  {:<20} {}", left.trim_end(), lines[0]);
        for line in &lines[1..] {
            let _ = writeln!(text, "  {:<20} {line}", "");
        }
    }
    text
}

/// Breaks a text into lines of at most `width` characters (longer words stand alone); never empty.
fn wrap(text: &str, width: usize) -> Vec<String> {
    let mut lines = vec![String::new()];
    for word in text.split(' ') {
        let line = lines.last_mut().map_or(0, |l| l.len());
        if line > 0 && line + 1 + word.len() > width {
            lines.push(String::new());
        }
        if let Some(last) = lines.last_mut() {
            if !last.is_empty() {
                last.push(' ');
            }
            last.push_str(word);
        }
    }
    lines
}

#[cfg(test)]
mod tests;
