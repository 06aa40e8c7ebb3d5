//! The table of all options.

use super::completions::SHELLS;

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
    /// Packs a scene.
    Pack,
    /// Unpacks a scene.
    Unpack,
    /// Writes a scene anew.
    Upgrade,
    /// Lists the files that a scene needs.
    ListFiles,
    /// Writes what each strategy adds.
    Strategies,
    /// Tells a sample in words.
    Replay,
    /// Takes part in a render of many machines.
    Network,
    /// Names the master's machine.
    Host,
    /// Chooses the port that a master listens at.
    Port,
    /// Names the file of the shared key.
    KeyFile,
    /// Makes a key.
    MakeKey,
    /// Shows how things stand.
    StatusPort,
    /// Reads and reports, without rendering.
    Check,
    /// Lists the settings.
    PrintSettings,
    /// Prints the text entries of a PNG.
    DumpMetadata,
    /// Diagnostics as JSON.
    Json,
    /// Says less.
    Quiet,
    /// Says more.
    Verbose,
    /// Keeps a log as JSON.
    JsonLog,
    /// Measures how fast the scene is rendered here.
    PerformanceTest,
    /// Prints the manual page.
    Man,
    /// Prints what completes words in a shell.
    Completions,
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
        "Stop at this number of samples per pixel: exactly, where a render of independent samples begins. Metropolis rounds it up to some thousand mutations, a film that is gone on with to whole passes, and many machines to what they render in a fraction of a second.",
    ),
    flag(
        "halterror",
        Some("E"),
        Action::HaltError,
        "Stop when the picture's relative error is estimated to be E or less: the root mean square of the luminance's error over its mean. 0.01 is hardly visible. The true error is at most 1.2 times the estimate in 95 of 100 runs, if the light is not in a few pixels. Of a picture that is black so far nothing is known, however many samples it has, and it is gone on with: where that may be, give -halt or -haltspp besides. Without any light in the scene it ends at once. It is estimated after a quarter more of the time each, and each second at least. Takes the memory of two more films.",
    ),
    flag(
        "o",
        Some("PATH"),
        Action::Output,
        "Write the picture to PATH (.png, which may be left out); other files take the same stem. Folders that are missing are made. Without it: renders/im_<UTC time>_<scene>.png.",
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
        "Also save an EXR with layers: the picture, foreground and background, direct and indirect light, albedo, normal, depth, numbers of objects and materials.",
    ),
    flag(
        "denoise",
        None,
        Action::SwitchOn("-denoise", "denoise"),
        "Also save a denoised picture, if the system has the library Open Image Denoise; INDIGO_OIDN may name its file.",
    ),
    flag(
        "placeholders",
        None,
        Action::SwitchOn("-placeholders", "placeholders"),
        "Render although files of textures and meshes are missing: something that is seen at a glance stands in for them, with a warning each. With --pack and --upgrade: write the scene without them; it names them by the paths that it had, as it does where nothing uses them.",
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
        "pack",
        None,
        Action::Pack,
        "Pack a scene and every file that it needs into one: --pack SCENE.igs OUT.pigs. A packed scene is rendered like any other.",
    ),
    flag(
        "unpack",
        None,
        Action::Unpack,
        "Unpack a packed scene into a new folder: --unpack SCENE.pigs FOLDER",
    ),
    flag(
        "upgrade",
        None,
        Action::Upgrade,
        "Write a scene, of whatever version of the format, anew: one file, in the form of the manual, with comments: --upgrade SCENE.igs OUT.igs. What has no effect is left out, and told. Files of packed scenes and materials go into the folder OUT_files beside it.",
    ),
    flag(
        "list-files",
        None,
        Action::ListFiles,
        "List every file that a scene names, one a line: its size in bytes and where it was found, or that it is missing and where it is named. The exit status is 2 if one is missing.",
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
    flag(
        "replay",
        Some("SEED:UNIT:INDEX"),
        Action::Replay,
        "For developers: print a single sample of the render, instead of rendering: where it falls, its wavelengths, its vertices, and what each strategy adds. Units are numbered from 0, and a unit's samples, too.",
    ),
    flag(
        "n",
        Some("s|m|wm"),
        Action::Network,
        "Render on many machines: as slave (s), which gets its scene from a master; as master (m), which adds up what slaves render, and saves it; or as working master (wm), which renders besides. The film (.igi) is always saved: a master that was killed goes on with it (-r), and its slaves with it.",
    ),
    flag(
        "h",
        Some("HOST:PORT"),
        Action::Host,
        "The machine on which a slave finds its master, and the port, if that is not 7777. Without it the local network is searched for a master.",
    ),
    flag("p", Some("PORT"), Action::Port, "Let a master listen at this port. Without it: 7777."),
    flag(
        "key-file",
        Some("FILE"),
        Action::KeyFile,
        "The file of the key that a master and its slaves share; or the variable INDIGO_KEY holds the key itself. Without a key only slaves on the master's own machine can join.",
    ),
    flag(
        "make-key",
        Some("FILE"),
        Action::MakeKey,
        "Make a new key, and write it to a new file that nobody else may read: copy it to all machines of a network render.",
    ),
    flag(
        "status-port",
        Some("PORT"),
        Action::StatusPort,
        "Let a master show how things stand at http://localhost:PORT/: a page with the picture and all slaves; /status.json for scripts, /metrics for Prometheus. For other machines to see it, give the address to listen at, too: 0.0.0.0:PORT.",
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
    flag("quiet", None, Action::Quiet, "Say nothing but warnings and errors."),
    flag("verbose", None, Action::Verbose, "Also say what takes time."),
    flag(
        "log-json",
        Some("FILE"),
        Action::JsonLog,
        "Append everything that is said to FILE, as an object of JSON in a line of its own: time, level, message, and numbers of the progress. The setting logging keeps log.txt, in plain text.",
    ),
    flag(
        "ptest",
        None,
        Action::PerformanceTest,
        "Measure how fast this machine renders the scene, without saving a picture: a fixed amount of work (as many samples per pixel as make four million, or -haltspp), always the same random numbers, and nothing taken from the cache. Prints a line for each figure; with -json an object.",
    ),
    flag("man", None, Action::Man, "Print the manual page: indigo_console -man | man -l -"),
    flag(
        "completions",
        Some("SHELL"),
        Action::Completions,
        "Print what completes options in a shell: bash, zsh or fish. For bash: source <(indigo_console -completions bash)",
    ),
    flag("help", None, Action::Help, "Print this help."),
    Flag {
        name: "version",
        alias: Some("v"),
        value: None,
        doc: "Print the version.",
        action: Action::Version,
    },
];

/// What the value of an option is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Value {
    /// The path of a file.
    File,
    /// One of these.
    Choice(Vec<&'static str>),
    /// Anything else.
    Word,
}

impl Value {
    /// Of what stands for it in the help.
    pub fn of(name: &'static str) -> Self {
        match name {
            "PATH" | "FILE" | "IGI" | "PNG" => Self::File,
            "SHELL" => Self::Choice(SHELLS.into()),
            _ if name.contains('|') => Self::Choice(name.split('|').collect()),
            _ => Self::Word,
        }
    }
}
