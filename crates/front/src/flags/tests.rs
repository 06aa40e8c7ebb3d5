//! Command lines, good and bad.

use super::*;

fn parsed(words: &[&str]) -> Result<Arguments, String> {
    parse(words.iter().map(OsString::from))
}

#[test]
fn options_stand_anywhere_with_one_dash_or_two() {
    let a = parsed(&["-haltspp", "64", "a.igs", "--o", "x.png", "-t", "2", "--seed=7"]).unwrap();
    assert_eq!(a.files, ["a.igs"]);
    assert_eq!(a.output.as_deref(), Some("x.png"));
    assert_eq!(a.seed, Some(7));
    let settings: Vec<_> = a.settings.iter().map(|s| (s.option, s.setting, s.value.as_str())).collect();
    assert_eq!(
        settings,
        [
            ("-haltspp", "halt_samples_per_pixel", "64"),
            ("-t", "num_threads", "2"),
            ("", "auto_choose_num_threads", "false")
        ]
    );
}

#[test]
fn of_options_given_twice_the_last_counts() {
    let a = parsed(&["-halt", "1", "-o", "a.png", "a.igs", "-halt", "2", "-o", "b.png"]).unwrap();
    let settings: Vec<_> = a.settings.iter().map(|s| (s.option, s.value.as_str())).collect();
    assert_eq!(settings, [("-halt", "2")]);
    assert_eq!(a.output.as_deref(), Some("b.png"));
}

#[test]
fn behind_two_dashes_are_files_alone() {
    let a = parsed(&["-t", "2", "--", "-odd.igs"]).unwrap();
    assert_eq!(a.files, ["-odd.igs"]);
    assert_eq!(parsed(&["--pack", "--", "--", "-o"]).unwrap().files, ["--", "-o"]);
}

#[test]
fn mistakes_get_a_helpful_answer() {
    let error = |words: &[&str]| parsed(words).unwrap_err();
    assert_eq!(error(&["-haltsp", "3"]), "unknown option -haltsp; did you mean -haltspp?");
    assert_eq!(error(&["-V"]), "unknown option -V; did you mean -v?");
    assert_eq!(error(&["-j"]), "unknown option -j; did you mean -json?");
    assert_eq!(error(&["-HaltSPP", "3"]), "unknown option -HaltSPP; did you mean -haltspp?");
    assert_eq!(error(&["-é"]), "unknown option -é; --help lists all options");
    assert_eq!(error(&["-halt"]), "-halt needs a value: -halt SECONDS");
    assert_eq!(error(&["-h"]), "-h needs a value: -h HOST:PORT; help is --help");
    assert_eq!(
        error(&["a.igs", "b.igs"]),
        "two scenes are given, a.igs and b.igs; one is rendered at a time"
    );
    assert!(error(&["--merge", "a.igi", "-o", "b.igi"]).contains("two or more"));
    assert!(error(&["--merge", "a.igi", "b.igi"]).contains("-o SUM.igi"));
    assert_eq!(error(&["a.igs", "-o", "-t", "1"]), "-o needs a value: -o PATH");
    assert!(error(&["--merge", "a.igi", "b.igi", "-o", "a.igs"]).contains("end with .igi"));
    assert!(error(&["--tonemap", "a.igs", "a.igi"]).contains("PICTURE.png"));
    assert!(
        error(&["--tonemap", "a.igs", "a.igi", "b.png", "-o", "c.png"]).contains("the last name of -tonemap")
    );
    for option in [&["-haltspp", "4"][..], &["-r", "f.igi"], &["-seed", "1"], &["-t", "2"]] {
        let words = [&["--tonemap", "s.igs", "f.igi", "x.png"], option].concat();
        assert!(error(&words).contains(&format!("{} has no part in -tonemap", option[0].replace("--", "-"))));
    }
    assert!(
        error(&["--merge", "a.igi", "b.igi", "-o", "c.igi", "-denoise"]).contains("-denoise has no part")
    );
    assert!(parsed(&["--tonemap", "s.igs", "f.igi", "x.png", "-denoise", "-layers", "-json"]).is_ok());
    assert_eq!(error(&["--check=1"]), "-check takes no value");
    assert!(error(&["-seed", "-3"]).contains("whole number"));
    for value in ["1", "1:2", "1:2:3:4", "1:2:x", "1:2:-3"] {
        assert!(error(&["a.igs", "-replay", value]).contains("SEED:UNIT:INDEX"), "{value}");
    }
    assert_eq!(parsed(&["a.igs", "-replay", "1:2:3"]).unwrap().replay, Some([1, 2, 3]));
}

#[test]
fn every_option_is_in_the_help_and_has_a_name_of_its_own() {
    let help = help("indigo_console SCENE.igs");
    for (i, flag) in FLAGS.iter().enumerate() {
        assert!(help.contains(&format!("  -{}", flag.name)));
        assert!(FLAGS[i + 1..].iter().all(|f| f.name != flag.name));
    }
    assert!(help.lines().all(|l| l.len() <= 100), "{help}");
}

#[test]
fn network_options_go_with_their_part() {
    let error = |words: &[&str]| parsed(words).unwrap_err();
    let slave = parsed(&["-n", "s", "-h", "lust:7778", "-t", "2", "-seed", "3"]).unwrap();
    assert_eq!((slave.network, slave.host), (Some(Role::Slave), Some(("lust".to_owned(), 7778))));
    let master = parsed(&["a.igs", "-n", "wm", "-p", "8000", "--key-file", "k"]).unwrap();
    assert_eq!((master.network, master.port), (Some(Role::WorkingMaster), Some(8000)));
    assert!(
        parsed(&["a.igs", "-n", "m", "-placeholders"]).is_ok()
            && parsed(&["a.igs", "-check", "-placeholders"]).is_ok()
    );
    for task in [["-pack", "a.igs", "b.pigs"], ["-upgrade", "a.igs", "b.igs"]] {
        assert!(parsed(&[&task[..], &["-placeholders"]].concat()).is_ok(), "{task:?}");
    }
    assert!(error(&["-unpack", "a.pigs", "f", "-placeholders"]).contains("has no part in -unpack"));
    let status = |value: &str| parsed(&["a.igs", "-n", "m", "--status-port", value]).map(|a| a.status);
    assert_eq!(status("8080"), Ok(Some("127.0.0.1:8080".parse().unwrap())));
    assert_eq!(status("0.0.0.0:8080"), Ok(Some("0.0.0.0:8080".parse().unwrap())));
    assert!(status("lust").unwrap_err().contains("0.0.0.0:8080"));
    assert!(error(&["-n", "x"]).contains("s (slave), m (master) or wm (working master), not x"));
    assert!(error(&["-n", "s", "a.igs"]).contains("gets its scene from the master"));
    assert!(error(&["-n", "s", "-p", "1"]).contains("-h HOST:PORT"));
    assert!(error(&["-n", "s", "-o", "x.png"]).contains("-o has no part in -n s"));
    assert!(error(&["-n", "s", "-h", "lust:x"]).contains("-h lust:7777"));
    assert!(error(&["a.igs", "-n", "m", "-p", "70000"]).contains("number of a port"));
    assert!(error(&["a.igs", "-n", "m", "-h", "lust"]).contains("-h has no part"));
    assert!(error(&["a.igs", "-n", "m", "-seed", "1"]).contains("-seed has no part in -n m"));
    assert!(error(&["a.igs", "-n", "wm", "-halterror", "0.1"]).contains("-halterror has no part"));
    assert!(error(&["a.igs", "-p", "1"]).contains("-n s, -n m or -n wm"));
}

#[test]
fn every_option_has_a_part_in_what_is_done() {
    let error = |words: &[&str]| parsed(words).unwrap_err();
    for (task, others) in [
        (&["a.igs", "-ptest"][..], &["-halt", "-o", "-layers", "-r"][..]),
        (&["a.igs", "-check"], &["-o", "-seed", "-halterror"]),
        (&["a.igs", "-print-settings"], &["-o", "-seed"]),
        (&["a.igs", "-replay", "1:2:3"], &["-seed", "-haltspp", "-o", "-t"]),
        (&["a.igs", "-strategies", "3", "-o", "s.png"], &["-haltspp", "-halt", "-t"]),
        (&["-pack", "a.igs", "a.pigs"], &["-t", "-haltspp"]),
        (&["-unpack", "a.pigs", "f"], &["-t", "-seed"]),
        (&["-list-files", "a.igs"], &["-t", "-o"]),
        (&["-make-key", "k"], &["-t", "-key-file"]),
        (&["-dumpmetadata", "a.png"], &["-t"]),
    ] {
        assert!(parsed(task).is_ok(), "{task:?}");
        for option in others {
            let text = error(&[task, &[option, "7"]].concat());
            assert!(
                text.starts_with(&format!("{option} has no part in ")) || text.starts_with("-o is for"),
                "{text}"
            );
        }
    }
    assert_eq!(
        error(&["a.igs", "-check", "-ptest"]),
        "-ptest and -check are two things to do; one is done at a time"
    );
    assert!(parsed(&["a.igs", "-check", "-print-settings"]).is_ok());
    assert!(error(&["-make-key", "k", "a.igs"]).contains("takes no file but its own"));
    assert!(error(&["a.igs", "-n", "m", "-check"]).contains("-n has no part in -check"));
    assert!(error(&["a.igs", "-quiet", "-verbose"]).contains("opposites"));
}
