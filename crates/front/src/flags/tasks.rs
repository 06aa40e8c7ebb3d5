//! What can be asked for, and which options have a part in it.

use super::{Arguments, Role};

/// Something to do, instead of rendering a scene.
struct Task {
    /// The option that asks for it.
    option: &'static str,
    /// How it is asked for, for messages.
    usage: &'static str,
    /// Options that have a part in it, besides [`ALWAYS`].
    with: &'static [&'static str],
    /// The fewest and most files that it takes.
    files: [usize; 2],
    /// What is said where there are more or fewer, in front of the usage.
    takes: &'static str,
}

const fn task(
    option: &'static str,
    files: [usize; 2],
    takes: &'static str,
    usage: &'static str,
    with: &'static [&'static str],
) -> Task {
    Task { option, usage, with, files, takes }
}

/// What is said and kept whatever is done.
const ALWAYS: &[&str] = &["quiet", "verbose", "log-json"];
/// Options that are for many machines.
const OF_NETWORKS: &[&str] = &["h", "p", "key-file", "status-port"];

/// All tasks; the first that is asked for is the one that is done, and those after it have a part in it or are mistakes.
static TASKS: &[Task] = &[
    task("merge", [2, usize::MAX], "two or more films", "--merge A.igi B.igi -o SUM.igi", &["o"]),
    task(
        "tonemap",
        [3, 3],
        "a scene, a film and a picture",
        "--tonemap SCENE.igs FILM.igi PICTURE.png",
        &["layers", "denoise", "json"],
    ),
    task(
        "pack",
        [2, 2],
        "a scene and a file to write",
        "--pack SCENE.igs OUT.pigs",
        &["placeholders", "json"],
    ),
    task("unpack", [2, 2], "a packed scene and a folder to make", "--unpack SCENE.pigs FOLDER", &[]),
    task(
        "upgrade",
        [2, 2],
        "a scene and a file to write",
        "--upgrade SCENE.igs OUT.igs",
        &["placeholders", "json"],
    ),
    task("list-files", [1, 1], "a scene", "--list-files SCENE.igs", &["json"]),
    task("make-key", [0, 0], "no file but its own", "--make-key FILE", &[]),
    task("dumpmetadata", [0, 0], "no file but its own", "--dumpmetadata PICTURE.png", &["json"]),
    task("ptest", [0, 1], "a scene", "--ptest SCENE.igs", &["haltspp", "t", "seed", "placeholders", "json"]),
    task(
        "check",
        [0, 1],
        "a scene",
        "--check SCENE.igs",
        &["print-settings", "r", "json", "halt", "haltspp", "t", "layers", "denoise", "placeholders"],
    ),
    task(
        "print-settings",
        [0, 1],
        "a scene",
        "--print-settings SCENE.igs",
        &["json", "halt", "haltspp", "t", "layers", "denoise"],
    ),
    task("replay", [0, 1], "a scene", "-replay SEED:UNIT:INDEX SCENE.igs", &["json"]),
    task("strategies", [0, 1], "a scene", "-strategies 64 -o PICTURE.png SCENE.igs", &["o", "seed", "json"]),
];

/// What a slave takes.
const OF_SLAVES: &[&str] = &["n", "h", "key-file", "t", "seed", "halt"];
/// What a master takes; a working master also a seed.
const OF_MASTERS: &[&str] = &[
    "n",
    "p",
    "key-file",
    "status-port",
    "o",
    "r",
    "layers",
    "denoise",
    "halt",
    "haltspp",
    "t",
    "json",
    "placeholders",
    "seed",
];

/// Whether every option has a part in what is done, and there are as many files as that takes.
///
/// # Errors
/// A sentence for the user.
pub fn check(parsed: &Arguments) -> Result<(), String> {
    if parsed.help || parsed.man || parsed.version || parsed.completions.is_some() {
        return Ok(());
    }
    let given = |name: &str| parsed.given.contains(&name);
    if given("quiet") && given("verbose") {
        return Err("-quiet and -verbose are opposites; one is given at a time".to_owned());
    }
    let tasks: Vec<&Task> = TASKS.iter().filter(|task| given(task.option)).collect();
    let stranger = |with: &[&str]| {
        parsed.given.iter().find(|name| !with.contains(name) && !ALWAYS.contains(name)).copied()
    };
    match (&tasks[..], parsed.network) {
        ([first, second, ..], _) if !first.with.contains(&second.option) => Err(format!(
            "-{} and -{} are two things to do; one is done at a time",
            first.option, second.option
        )),
        ([task, ..], _) => {
            let with = [task.with, &[task.option]].concat();
            match stranger(&with) {
                Some("o") if task.files[0] > 1 => Err(format!(
                    "-o is for renders; the last name of -{} is what is written: {}",
                    task.option, task.usage
                )),
                Some(name) => {
                    Err(format!("-{name} has no part in -{}, which renders no picture", task.option))
                }
                None => check_files(task, parsed),
            }
        }
        ([], None) => {
            if let Some(name) = parsed.given.iter().find(|name| OF_NETWORKS.contains(name)) {
                return Err(format!("-{name} is for network rendering: -n s, -n m or -n wm"));
            }
            one_scene(parsed)
        }
        ([], Some(Role::Slave)) => {
            if let Some(file) = parsed.files.first() {
                return Err(format!("a slave gets its scene from the master, so {file} has no part in -n s"));
            }
            match stranger(OF_SLAVES) {
                Some("p") => {
                    Err("-p is a master's; for a slave the port stands behind the host: -h HOST:PORT"
                        .to_owned())
                }
                Some(name) => Err(format!("-{name} has no part in -n s: it is the master's to say")),
                None => Ok(()),
            }
        }
        ([], Some(role)) => match stranger(OF_MASTERS) {
            Some(name) => Err(format!("-{name} has no part in the work of a network master")),
            None if role == Role::Master && given("seed") => {
                Err("-seed has no part in -n m, which renders nothing itself; give it to -n wm, or to slaves"
                    .to_owned())
            }
            None => one_scene(parsed),
        },
    }
}

fn one_scene(parsed: &Arguments) -> Result<(), String> {
    match &parsed.files[..] {
        [first, second, ..] => {
            Err(format!("two scenes are given, {first} and {second}; one is rendered at a time"))
        }
        _ => Ok(()),
    }
}

fn check_files(task: &Task, parsed: &Arguments) -> Result<(), String> {
    let [fewest, most] = task.files;
    if !(fewest..=most).contains(&parsed.files.len()) {
        return Err(format!("-{} takes {}: {}", task.option, task.takes, task.usage));
    }
    match (task.option, parsed.output.as_deref()) {
        ("merge" | "strategies", None) => {
            Err(format!("-{} needs the file to write behind -o: {}", task.option, task.usage))
        }
        ("merge", Some(sum)) if !sum.to_ascii_lowercase().ends_with(".igi") => {
            Err("-merge writes a film: the name behind -o must end with .igi".to_owned())
        }
        _ => Ok(()),
    }
}
