//! What the program says: how much, to whom, and what it prints of itself.

use super::workbench::Workbench;

const QUIET: &str = "<logging>false</logging>";

#[test]
fn quiet_leaves_warnings_and_errors() {
    let bench = Workbench::new(QUIET);
    let ran = bench.run(&["scene.igs", "-haltspp", "2", "-o", "a.png", "-quiet"]);
    assert_eq!((ran.status, &*ran.stderr), (Some(0), ""));
    let scene = std::fs::read_to_string(bench.path("scene.igs")).expect("the scene");
    bench.write("odd.igs", &scene.replace("<camera>", "<camera><shutter>1</shutter>"));
    let odd = bench.run(&["odd.igs", "-haltspp", "2", "-o", "a.png", "-quiet"]);
    assert!(odd.stderr.contains("odd.igs:") && odd.stderr.contains("shutter"), "{}", odd.stderr);
    assert!(!odd.stderr.contains("Saved"), "{}", odd.stderr);
}

#[test]
fn verbose_tells_what_takes_time() {
    let bench = Workbench::new(QUIET);
    let usual = bench.run(&["scene.igs", "-haltspp", "2", "-o", "a.png"]);
    let verbose = bench.run(&["scene.igs", "-haltspp", "2", "-o", "a.png", "-verbose"]);
    for words in ["Read scene.igs", "Loaded in ", "Developed and saved in "] {
        assert!(verbose.stderr.contains(words), "{}", verbose.stderr);
        assert!(!usual.stderr.contains(words), "{}", usual.stderr);
    }
}

#[test]
fn a_log_of_json_has_a_line_for_each_message() {
    let bench = Workbench::new(QUIET);
    let scene = std::fs::read_to_string(bench.path("scene.igs")).expect("the scene");
    bench.write("scene.igs", &scene.replace("<camera>", "<camera><shutter>1</shutter>"));
    let arguments = ["scene.igs", "-haltspp", "2", "-o", "a \"b\".png", "-quiet", "--log-json", "log.json"];
    assert_eq!(bench.run(&arguments).status, Some(0));
    let log = std::fs::read_to_string(bench.path("log.json")).expect("a log");
    for line in log.lines() {
        assert!(line.starts_with("{\"time\":\"2") && line.ends_with('}'), "{line}");
        assert!(line.contains("Z\",\"level\":\""), "{line}");
    }
    assert!(log.contains("\"level\":\"warning\"") && log.contains("\"diagnostic\":{"), "{log}");
    assert!(log.contains("\"level\":\"progress\"") && log.contains("\"samples_per_pixel\":2"), "{log}");
    assert!(log.contains("Saved a \\\"b\\\".png"), "{log}");
    // Where the file was forgotten, the scene stands in its place.
    let before = std::fs::read(bench.path("scene.igs")).expect("the scene");
    let forgotten = bench.run(&["--log-json", "scene.igs"]);
    assert!(forgotten.status == Some(2) && forgotten.stderr.contains("none by its name"), "{forgotten:?}");
    assert_eq!(std::fs::read(bench.path("scene.igs")).expect("the scene"), before);
    let nowhere = bench.run(&["scene.igs", "-haltspp", "2", "--log-json", "no/such/folder/log.json"]);
    assert_eq!(nowhere.status, Some(1));
    assert!(nowhere.stderr.contains("no log can be kept"), "{}", nowhere.stderr);
}

/// `/dev/full` takes nothing, like a full disk: that is told once, and the picture is rendered.
#[cfg(target_os = "linux")]
#[test]
fn a_log_that_cannot_be_written_is_told_of_once() {
    let bench = Workbench::new(QUIET);
    let ran = bench.run(&["scene.igs", "-haltspp", "2", "-o", "a.png", "--log-json", "/dev/full"]);
    assert_eq!(ran.status, Some(0), "{ran:?}");
    let told = "warning: the log lacks lines from now on: /dev/full: ";
    assert_eq!(ran.stderr.matches(told).count(), 1, "{}", ran.stderr);
    assert!(bench.path("a.png").exists());
}

/// Of files that are no logs nothing is appended to, whatever their names are: a key would be none any more.
#[test]
fn a_log_is_not_appended_to_another_file() {
    let bench = Workbench::new(QUIET);
    assert_eq!(bench.run(&["--make-key", "key"]).status, Some(0));
    bench.write("scene.txt", &super::workbench::scene(QUIET));
    for (name, more) in
        [("key", &["-n", "m", "-p", "0", "-halt", "0.1", "--key-file", "key"][..]), ("scene.txt", &[])]
    {
        let before = std::fs::read(bench.path(name)).expect("it is there");
        let ran =
            bench.run(&[&["scene.igs", "-haltspp", "1", "-o", "a.png", "--log-json", name], more].concat());
        assert_eq!(ran.status, Some(1), "{name}: {ran:?}");
        assert!(ran.stderr.contains(&format!("no log can be kept: {name}: this is another file")), "{ran:?}");
        assert!(std::fs::read(bench.path(name)).expect("it is there") == before, "{name} is as it was");
    }
    // A log is, and so is a file that is empty.
    bench.write("log", "");
    let lines = [1, 2].map(|_| {
        let ran = bench.run(&["scene.igs", "-haltspp", "1", "-o", "a.png", "--log-json", "log"]);
        assert_eq!(ran.status, Some(0), "{ran:?}");
        std::fs::read_to_string(bench.path("log")).expect("the log").lines().count()
    });
    assert!(0 < lines[0] && lines[0] < lines[1], "{lines:?}");
}

/// A number of a line "name value unit".
fn figure(text: &str, name: &str) -> f64 {
    let line = text.lines().find(|l| l.split_whitespace().next() == Some(name));
    let value =
        line.and_then(|l| l.split_whitespace().nth(1)).unwrap_or_else(|| panic!("no {name} in {text}"));
    value.parse().unwrap_or_else(|_| panic!("{name} is {value}"))
}

#[test]
fn the_performance_test_does_the_same_work_each_time() {
    let bench = Workbench::new(QUIET);
    let run = |more: &[&str]| {
        let ran = bench.run(&[&["scene.igs", "--ptest", "-haltspp", "4"], more].concat());
        assert_eq!(ran.status, Some(0), "{ran:?}");
        ran.stdout
    };
    let (one, two) = (run(&["-t", "1"]), run(&["-t", "2"]));
    assert_eq!(figure(&one, "samples"), 4.0 * 1200.0);
    for figures in [&one, &two] {
        assert!(figure(figures, "samples_per_second") > 0.0 && figure(figures, "render") > 0.0, "{figures}");
        // A camera ray for each sample, and often more.
        assert!(figure(figures, "rays") >= figure(figures, "samples"), "{figures}");
    }
    for same in ["samples", "rays", "pixels", "triangles"] {
        assert_eq!(figure(&one, same), figure(&two, same), "{same}");
    }
    assert_eq!(bench.files().iter().filter(|f| f.contains(".png")).count(), 0, "no picture is written");
    assert!(!bench.path("cache").exists() && !bench.path("renders").exists());
    let json = run(&["-json", "-t", "1"]);
    assert!(json.starts_with("{\"program\":\"Indigo") && json.contains("\"samples\":4800,"), "{json}");
    let bad = bench.run(&["nowhere.igs", "--ptest"]);
    assert_eq!(bad.status, Some(2));
}

#[test]
fn the_manual_page_and_completions_know_every_option() {
    let bench = Workbench::new(QUIET);
    let help = bench.run(&["-help"]).stdout;
    let names: Vec<&str> = help
        .lines()
        .filter_map(|l| l.strip_prefix("  -"))
        .map(|l| l.split([' ', ',']).next().unwrap_or(l))
        .collect();
    assert!(names.len() > 20, "{help}");
    let man = bench.run(&["-man"]).stdout;
    for name in &names {
        assert!(man.contains(&format!("\\fB\\-{}\\fR", name.replace('-', "\\-"))), "{name} in {man}");
    }
    for shell in ["bash", "zsh", "fish"] {
        let script = bench.run(&["-completions", shell]).stdout;
        let words: Vec<&str> = script
            .split(|c: char| !c.is_ascii_alphanumeric() && c != '-')
            .map(|w| w.trim_start_matches('-'))
            .collect();
        for name in &names {
            assert!(words.contains(name), "{name} for {shell}");
        }
    }
    let unknown = bench.run(&["-completions", "csh"]);
    assert!(unknown.status == Some(2) && unknown.stderr.contains("bash, zsh, fish"), "{unknown:?}");
}

/// A real shell completes by the script, where there is one.
#[cfg(target_os = "linux")]
#[test]
fn bash_completes_options_and_files() {
    let bench = Workbench::new(QUIET);
    bench.write("script", &bench.run(&["-completions", "bash"]).stdout);
    let complete = |words: &str, at: usize| {
        let line = format!(
            "source ./script; COMP_WORDS=(indigo_console {words}); COMP_CWORD={at}; _indigo_console 2>/dev/null; \
             printf '%s\\n' \"${{COMPREPLY[@]}}\""
        );
        let out = std::process::Command::new("bash")
            .args(["-c", &line])
            .current_dir(&bench.directory)
            .output()
            .expect("Linux has bash");
        String::from_utf8(out.stdout).expect("text")
    };
    assert_eq!(complete("-haltsp", 1), "-haltspp\n");
    assert_eq!(complete("--haltsp", 1), "--haltspp\n");
    assert_eq!(complete("-completions z", 2), "zsh\n");
    assert_eq!(complete("sc", 1), "scene.igs\n");
    assert_eq!(complete("-haltspp 3", 2), "\n");
    assert!(complete("-r s", 2).contains("scene.igs"));
}

/// Why a render has ended is said with the number that counts.
#[test]
fn why_it_halts_is_said() {
    let bench = Workbench::new("<logging>false</logging>");
    for (condition, said) in [
        (["-haltspp", "3"], "Halted with the samples per pixel that were asked for: 3.00\n"),
        (["-halt", "0.2"], "Halted after the time that was asked for: 0.2 s\n"),
        (["-halterror", "0.5"], "Halted with the estimated error that was asked for: "),
    ] {
        let ran = bench.run(&[&["scene.igs", "-o", "a.png", "-t", "1"], &condition[..]].concat());
        assert_eq!(ran.status, Some(0), "{ran:?}");
        assert!(ran.stderr.contains(said), "{said}: {}", ran.stderr);
    }
}
