//! The command line: one table, from which parsing, help and suggestions come.
//!
//! Long options of one dash are the manual's; each also works with two. Options may stand before or
//! after the scene.

mod completions;
mod help;
mod man;
mod network;
mod table;
mod tasks;

use crate::messages::Verbosity;
use completions::SHELLS;
pub use completions::completions;
pub use help::help;
use indigo_scene::Override;
pub use man::man;
use std::ffi::OsString;
use std::net::SocketAddr;
use table::{Action, FLAGS, Flag};

/// A part in a render of many machines.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// Renders a master's scene.
    Slave,
    /// Adds up what slaves render.
    Master,
    /// The same, and renders.
    WorkingMaster,
}

/// The command line, understood.
#[derive(Clone, Debug, Default, PartialEq)]
#[expect(clippy::struct_excessive_bools, reason = "each is a switch of its own on the command line")]
pub struct Arguments {
    /// The scene; with `merge`, `tone_map`, `pack`, `unpack` or `upgrade` all files instead.
    pub files: Vec<String>,
    /// Names of the options in the order in which they were given.
    pub given: Vec<&'static str>,
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
    /// Only pack a scene.
    pub pack: bool,
    /// Only unpack a scene.
    pub unpack: bool,
    /// Only write a scene anew.
    pub upgrade: bool,
    /// Only list the files of a scene.
    pub list_files: bool,
    /// Path of the picture.
    pub output: Option<String>,
    /// Only show what each strategy adds, by so many samples per pixel.
    pub strategies: Option<u32>,
    /// Only tell a sample: seed, unit and its number there.
    pub replay: Option<[u64; 3]>,
    /// The part in a render of many machines.
    pub network: Option<Role>,
    /// The master's host and port.
    pub host: Option<(String, u16)>,
    /// The port to listen at.
    pub port: Option<u16>,
    /// File of the shared key.
    pub key_file: Option<String>,
    /// Where to show how things stand.
    pub status: Option<SocketAddr>,
    /// Only make a key, into this file.
    pub make_key: Option<String>,
    /// Only check.
    pub check: bool,
    /// Only list the settings.
    pub print_settings: bool,
    /// Only print a picture's metadata.
    pub dump_metadata: Option<String>,
    /// Diagnostics as JSON.
    pub json: bool,
    /// How much is said.
    pub verbosity: Verbosity,
    /// File of a log as JSON.
    pub json_log: Option<String>,
    /// Only measure how fast the scene is rendered.
    pub performance_test: bool,
    /// Only print the manual page.
    pub man: bool,
    /// Only print what completes words in this shell.
    pub completions: Option<String>,
    /// Only print the help.
    pub help: bool,
    /// Only print the version.
    pub version: bool,
}

impl Arguments {
    /// Of options that are given twice the last one counts.
    fn set(&mut self, new: Override<'static>) {
        self.settings.retain(|earlier| earlier.setting != new.setting);
        self.settings.push(new);
    }
}

/// Understands a command line.
///
/// # Errors
/// A sentence for the user, with the nearest option where one is misspelt.
pub fn parse(arguments: impl IntoIterator<Item = OsString>) -> Result<Arguments, String> {
    let mut parsed = Arguments::default();
    let mut rest = arguments.into_iter();
    // Behind -- there are files alone, whatever they begin with.
    let mut are_files = false;
    while let Some(argument) = rest.next() {
        let argument = argument.into_string().map_err(|a| format!("{} is not Unicode text", a.display()))?;
        if argument == "--" && !are_files {
            are_files = true;
            continue;
        }
        let Some(written) = argument.strip_prefix('-').filter(|a| !a.is_empty() && !are_files) else {
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
            (Some(what), None) => {
                rest.next().and_then(|v| v.into_string().ok()).filter(|v| !is_option(v)).ok_or_else(|| {
                    // Elsewhere it is what asks for help.
                    let help = if flag.name == "h" { "; help is --help" } else { "" };
                    format!("-{} needs a value: -{} {what}{help}", flag.name, flag.name)
                })?
            }
        };
        parsed.given.push(flag.name);
        apply(flag, value, &mut parsed)?;
    }
    tasks::check(&parsed)?;
    Ok(parsed)
}

/// Whether a word is an option rather than the value of one, which may begin with a dash, too.
fn is_option(word: &str) -> bool {
    let name = word.trim_start_matches('-');
    name != word && FLAGS.iter().any(|f| f.name == name || f.alias == Some(name))
}

fn find(name: &str) -> Result<&'static Flag, String> {
    if let Some(flag) = FLAGS.iter().find(|f| f.name == name || f.alias == Some(name)) {
        return Ok(flag);
    }
    Err(match hint(name) {
        Some(hint) => format!("unknown option -{name}; did you mean -{hint}?"),
        None => format!("unknown option -{name}; --help lists all options"),
    })
}

/// The option that may be meant by a name that is none.
fn hint(name: &str) -> Option<&'static str> {
    let names = || FLAGS.iter().flat_map(|flag| std::iter::once(flag.name).chain(flag.alias));
    let begins = |other: &&str| other.get(..name.len()).is_some_and(|start| start.eq_ignore_ascii_case(name));
    let alike = names().find(|other| other.eq_ignore_ascii_case(name));
    // Of single letters all are as near.
    let near = || match name.chars().count() {
        1 => names().find(begins),
        _ => indigo_diag::nearest(name, FLAGS.iter().map(|flag| flag.name)),
    };
    alike.or_else(near)
}

/// Whether a command line, however wrong, asks for JSON.
pub fn wants_json(mut arguments: impl Iterator<Item = OsString>) -> bool {
    arguments.any(|argument| argument == "-json" || argument == "--json")
}

fn apply(flag: &Flag, value: String, parsed: &mut Arguments) -> Result<(), String> {
    match flag.action {
        // The setting's own declaration checks the value.
        Action::Setting(option, setting) => parsed.set(Override { option, setting, value }),
        Action::SwitchOn(option, setting) => {
            parsed.set(Override { option, setting, value: "true".to_owned() });
        }
        Action::Threads => {
            parsed.set(Override { option: "-t", setting: "num_threads", value });
            let implied = "auto_choose_num_threads";
            if parsed.settings.iter().all(|setting| setting.setting != implied) {
                parsed.settings.push(Override { option: "", setting: implied, value: "false".to_owned() });
            }
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
        Action::Pack => parsed.pack = true,
        Action::Unpack => parsed.unpack = true,
        Action::Upgrade => parsed.upgrade = true,
        Action::ListFiles => parsed.list_files = true,
        Action::Strategies => {
            let passes = value.parse().ok().filter(|n: &u32| *n > 0);
            parsed.strategies =
                Some(passes.ok_or_else(|| format!("-strategies needs a whole number above 0, not {value}"))?);
            // What cannot be traced from both ends is refused.
            let setting = "bidirectional";
            parsed.settings.push(Override { option: "-strategies", setting, value: "true".to_owned() });
        }
        Action::Replay => {
            let numbers: Vec<u64> = value.split(':').map_while(|n| n.parse().ok()).collect();
            let is_whole = numbers.len() == value.split(':').count();
            parsed.replay = Some(numbers.try_into().ok().filter(|_| is_whole).ok_or_else(|| {
                format!("-replay needs three whole numbers SEED:UNIT:INDEX, such as 0:12:345, not {value}")
            })?);
        }
        Action::Network => parsed.network = Some(network::role(&value)?),
        Action::Host => parsed.host = Some(network::host(&value)?),
        Action::Port => parsed.port = Some(network::port(&value)?),
        Action::KeyFile => parsed.key_file = Some(value),
        Action::StatusPort => parsed.status = Some(network::status(&value)?),
        Action::MakeKey => parsed.make_key = Some(value),
        Action::Check => parsed.check = true,
        Action::PrintSettings => parsed.print_settings = true,
        Action::DumpMetadata => parsed.dump_metadata = Some(value),
        Action::Json => parsed.json = true,
        Action::Quiet => parsed.verbosity = Verbosity::Quiet,
        Action::Verbose => parsed.verbosity = Verbosity::Verbose,
        Action::JsonLog => {
            let endings = [".igs", ".pigs", ".igi", ".png", ".exr", ".xml"];
            if endings.iter().any(|ending| value.to_ascii_lowercase().ends_with(ending)) {
                return Err(format!("-log-json appends to a log, and {value} is none by its name"));
            }
            parsed.json_log = Some(value);
        }
        Action::PerformanceTest => parsed.performance_test = true,
        Action::Man => parsed.man = true,
        Action::Completions => {
            if !SHELLS.contains(&value.as_str()) {
                return Err(format!("-completions needs one of {}, not {value}", SHELLS.join(", ")));
            }
            parsed.completions = Some(value);
        }
        Action::Help => parsed.help = true,
        Action::Version => parsed.version = true,
    }
    Ok(())
}

#[cfg(test)]
mod tests;
