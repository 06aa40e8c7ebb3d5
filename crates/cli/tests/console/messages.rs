//! What the program says, and the status that it ends with.

use super::workbench::{Workbench, scene};

#[test]
fn help_and_version_are_answers_not_errors() {
    let bench = Workbench::new("");
    for arguments in [["--help"], ["-help"]] {
        let ran = bench.run(&arguments);
        assert_eq!(ran.status, Some(0));
        assert!(ran.stdout.contains("Usage: indigo_console") && ran.stdout.contains("-haltspp"), "{ran:?}");
    }
    let ran = bench.run(&["--version"]);
    assert_eq!(ran.status, Some(0));
    assert!(ran.stdout.starts_with("Indigo Renderer v") && ran.stderr.is_empty(), "{ran:?}");
}

#[test]
fn bad_usage_ends_with_2_and_a_way_out() {
    let bench = Workbench::new("<logging>false</logging>");
    for (arguments, says) in [
        (vec![], "no scene is given"),
        (vec!["scene.igs", "-haltsp", "3"], "did you mean -haltspp?"),
        (vec!["scene.igs", "-halt"], "-halt needs a value"),
        (vec!["scene.igs", "-seed", "x"], "whole number"),
        (vec!["scene.igs", "other.igs"], "two scenes"),
        (vec!["scene.igs", "-haltspp", "many"], "many"),
        (vec!["scene.igs", "-t", "0"], "-t 0"),
        (vec!["scene.igs", "-t", "100000"], "must be in [1, 1024]"),
        (vec!["scene.igs", "-halt", "soon"], "-halt soon"),
        (vec!["nowhere.igs"], "nowhere.igs"),
    ] {
        let ran = bench.run(&arguments);
        assert_eq!(ran.status, Some(2), "{arguments:?}: {ran:?}");
        assert!(ran.stderr.contains(says), "{arguments:?}: {ran:?}");
    }
    assert_eq!(bench.files(), ["scene.igs"], "nothing is written");
}

#[test]
fn a_bad_scene_ends_with_2_and_every_fault_with_its_place() {
    let bench = Workbench::new("<logging>false</logging>");
    let text = scene("").replace("<radius>1<", "<radius>-1<").replace("<value>1e5<", "<value>bright<");
    bench.write("bad.igs", &text);
    for arguments in [vec!["bad.igs", "-haltspp", "1"], vec!["bad.igs", "--check"]] {
        let ran = bench.run(&arguments);
        assert_eq!(ran.status, Some(2), "{ran:?}");
        let line_of = |what: &str| 1 + text.lines().position(|l| l.contains(what)).expect("the fault");
        for line in [line_of("<radius>-1"), line_of("bright")] {
            assert!(ran.stderr.contains(&format!("bad.igs:{line}:")), "line {line}: {}", ran.stderr);
        }
        assert!(ran.stderr.contains("2 errors"), "{}", ran.stderr);
    }
}

#[test]
fn check_reports_without_rendering() {
    let bench = Workbench::new("<logging>true</logging>");
    let ran = bench.run(&["scene.igs", "--check"]);
    assert_eq!(ran.status, Some(0), "{ran:?}");
    assert!(ran.stderr.contains("scene.igs: no errors"), "{ran:?}");
    assert_eq!(bench.files(), ["scene.igs"], "nothing is written");
}

#[test]
fn settings_are_listed_with_their_origins() {
    let bench = Workbench::new("<max_depth>7</max_depth><halt_time>5</halt_time>");
    bench.write(
        "inifile.xml",
        "<settings><max_depth>3</max_depth><image_save_period>2.5</image_save_period></settings>",
    );
    let ran = bench.run(&["scene.igs", "--print-settings", "-halt", "9"]);
    assert_eq!(ran.status, Some(0), "{ran:?}");
    for (name, value, origin) in [
        ("max_depth", "7", "scene"),
        ("halt_time", "9", "command line"),
        ("image_save_period", "2.5", "inifile.xml"),
        ("super_sample_factor", "2", "default"),
        ("width", "40", "scene"),
    ] {
        let line = ran.stdout.lines().find(|l| l.split_whitespace().next() == Some(name));
        let words: Vec<&str> = line.unwrap_or_else(|| panic!("{name} is missing")).splitn(2, ' ').collect();
        let rest = words[1].trim();
        assert_eq!(rest.split_whitespace().next(), Some(value), "{name}");
        assert!(rest.ends_with(&format!("({origin})")), "{name}: {rest}");
    }
}

#[test]
fn a_fraction_of_a_sample_is_rounded_up_and_said() {
    let bench = Workbench::new("<logging>false</logging>");
    let ran = bench.run(&["scene.igs", "-haltspp", "1.5", "-o", "a.png"]);
    assert_eq!(ran.status, Some(0), "{ran:?}");
    assert!(ran.stderr.contains("halting at 2 per pixel, not at 1.5"), "{}", ran.stderr);
    assert!(bench.run(&["-dumpmetadata", "a.png"]).stdout.contains("samples_per_pixel: 2.00000"));
    let told = bench.run(&["-dumpmetadata", "a.png", "-json"]).stdout;
    assert!(told.contains("{\"key\":\"samples_per_pixel\",\"value\":\"2.00000\"}\n"), "{told}");
}

/// What is no halting condition is not taken for one without a word.
#[test]
fn a_halt_that_is_none_is_told() {
    let bench = Workbench::new("<logging>false</logging>");
    for halt in [["-halt", "0"], ["-halt", "-1"]] {
        let ran = bench.run(&[&["scene.igs", "-haltspp", "1", "-o", "a.png"], &halt[..]].concat());
        assert_eq!(ran.status, Some(0), "{ran:?}");
        assert!(ran.stderr.contains(&format!("note: {} {} is never", halt[0], halt[1])), "{}", ran.stderr);
    }
    let ran = bench.run(&["scene.igs", "-haltspp", "0", "-halt", "0.1", "-o", "a.png"]);
    assert_eq!(ran.status, Some(0), "{ran:?}");
    assert!(ran.stderr.contains("note: -haltspp 0 is never"), "{}", ran.stderr);
}

/// What files are called, and what they say, comes to no terminal as a command.
#[cfg(unix)]
#[test]
fn texts_from_outside_are_shown_and_do_nothing() {
    let bench = Workbench::new("<logging>false</logging>");
    let name = "a\x1b[2J\x07\nforged: no errors.igs";
    let include = "<include><pathname>b\u{9b}31m&#10;forged: no errors</pathname></include></scene>";
    bench.write(name, &scene("<logging>false</logging>"));
    bench.write("odd.igs", &scene("").replace("</scene>", include));
    let is_hidden = |c: char| c.is_control() && c != '\n';
    for arguments in [
        &["--check", name][..],
        &["--check", "odd.igs"],
        &["--list-files", "odd.igs"],
        &[name, "-haltspp", "1", "-o", "a.png"],
        &["--dumpmetadata", "a.png"],
        &["--print-settings", name],
    ] {
        let ran = bench.run(arguments);
        for text in [&ran.stdout, &ran.stderr] {
            assert!(!text.contains(is_hidden), "{arguments:?}: {text:?}");
            assert!(!text.lines().any(|line| line.starts_with("forged")), "{arguments:?}: {text:?}");
        }
    }
    let told = bench.run(&["--dumpmetadata", "a.png"]).stdout;
    assert!(told.contains("a\u{fffd}[2J\u{fffd}"), "the scene's name is there: {told:?}");
    let json = bench.run(&["--check", "odd.igs", "-json"]).stdout;
    assert!(json.contains("b\\u009b31m\\u000aforged") && !json.contains(is_hidden), "{json:?}");
}

/// Every line is JSON, the last one a summary.
#[test]
fn json_is_complete() {
    let bench = Workbench::new("<logging>false</logging>");
    let text = scene("").replace("<radius>1<", "<radius>-1<");
    bench.write("bad.igs", &text.replace("<pos>0 0 0</pos>", "<pos>0 0 0</pos><poss>0</poss>"));
    for (name, status, summary) in [
        ("bad.igs", 2, "{\"summary\":{\"file\":\"bad.igs\",\"errors\":1,\"warnings\":1,\"not_listed\":0}}"),
        (
            "scene.igs",
            0,
            "{\"summary\":{\"file\":\"scene.igs\",\"errors\":0,\"warnings\":0,\"not_listed\":0}}",
        ),
    ] {
        let ran = bench.run(&[name, "--check", "--json"]);
        assert_eq!(ran.status, Some(status), "{ran:?}");
        assert_eq!(ran.stderr, "", "all is in the JSON");
        assert!(ran.stdout.lines().all(|l| l.starts_with('{') && l.ends_with('}')), "{}", ran.stdout);
        assert_eq!(ran.stdout.lines().last(), Some(summary));
    }
}

/// What no scene, picture or output file comes of is told to programs, too.
#[test]
fn json_tells_of_every_failure() {
    let bench = Workbench::new("<logging>false</logging>");
    bench.write("bad.pigs", "no zip file");
    bench.write("bad.png", "no picture");
    for arguments in [
        &["--check", "bad.pigs"][..],
        &["--list-files", "bad.pigs"],
        &["--ptest", "bad.pigs"],
        &["--tonemap", "bad.pigs", "a.igi", "a.png"],
        &["--dumpmetadata", "bad.png"],
        &["--dumpmetadata", "nowhere.png"],
        &["--tonemap", "scene.igs", "nowhere.igi", "a.png"],
        &["--pack", "scene.igs", "no_folder.igs/"],
        &["--ptest", "nowhere.igs"],
        &["bad.pigs", "-o", "a.png"],
        &["scene.igs", "-haltspp", "1", "-r", "nowhere.igi"],
        &["scene.igs", "-nosuchoption"],
    ] {
        let ran = bench.run(&[arguments, &["--json"]].concat());
        assert!(matches!(ran.status, Some(1 | 2)), "{arguments:?}: {ran:?}");
        let is_json = |line: &str| line.starts_with('{') && line.ends_with('}');
        assert!(ran.stdout.lines().all(is_json), "{arguments:?}: {}", ran.stdout);
        let told =
            ran.stdout.lines().find(|line| line.contains("\"severity\":\"error\"")).unwrap_or_default();
        let name = arguments.iter().find(|a| a.contains("bad") || a.contains("no")).expect("what is wrong");
        assert!(told.contains(name), "{arguments:?}: {ran:?}");
    }
}

/// `/dev/full` takes nothing, like a full disk.
#[cfg(target_os = "linux")]
#[test]
fn an_answer_that_cannot_be_written_is_a_failure_and_no_panic() {
    let bench = Workbench::new("<logging>false</logging>");
    for arguments in [
        vec!["--help"],
        vec!["--version"],
        vec!["scene.igs", "--print-settings"],
        vec!["scene.igs", "--check", "--json"],
    ] {
        let full = std::fs::OpenOptions::new().write(true).open("/dev/full").expect("a device of Linux");
        let ran = bench.run_into(&arguments, full);
        assert_eq!(ran.status, Some(1), "{arguments:?}: {ran:?}");
        assert!(ran.stderr.starts_with("error: cannot write to standard output"), "{arguments:?}: {ran:?}");
        assert_eq!(ran.stderr.lines().count(), 1, "{ran:?}");
    }
}

/// With an address space of 2 GB there is none for the sums of a 20,000 by 20,000 picture.
#[cfg(target_os = "linux")]
#[test]
fn a_picture_that_does_not_fit_into_memory_is_refused_with_its_numbers() {
    let size = "<width>20000</width><height>20000</height><super_sample_factor>1</super_sample_factor>";
    let bench = Workbench::new(&format!("<logging>false</logging>{size}"));
    let ran = bench.run_in_memory(2_000_000, &["scene.igs", "-haltspp", "1", "-o", "a.png", "-t", "1"]);
    assert_eq!(ran.status, Some(1), "{ran:?}");
    for part in ["error: ", "width 20000", "height 20000", "super_sample_factor 1", "MiB of memory"] {
        assert!(ran.stderr.contains(part), "{part}: {}", ran.stderr);
    }
    assert_eq!(bench.files(), ["scene.igs"], "nothing is written");
}
