//! What the program writes.

use super::workbench::{Workbench, assert_picture};

const QUIET: &str = "<logging>false</logging>";

#[test]
fn the_picture_goes_where_it_was_asked_for_and_its_siblings_beside_it() {
    let both =
        "<save_untonemapped_exr>true</save_untonemapped_exr><save_tonemapped_exr>true</save_tonemapped_exr>";
    let bench = Workbench::new(&format!("{QUIET}{both}"));
    let ran = bench.run(&["scene.igs", "-haltspp", "2", "-o", "new/place/shot.png", "-t", "1"]);
    assert_eq!(ran.status, Some(0), "{ran:?}");
    for name in ["shot.png", "shot_untonemapped.exr", "shot_tonemapped.exr"] {
        assert_picture(&bench.path("new/place").join(name), 40, 30);
        assert!(ran.stderr.contains(name), "{name} is not named: {}", ran.stderr);
    }
    assert_eq!(std::fs::read_dir(bench.path("new/place")).expect("it was made").count(), 3);
}

#[test]
fn without_a_name_the_picture_is_named_by_time_and_scene() {
    let bench = Workbench::new(QUIET);
    let ran = bench.run(&["-haltspp", "1", "scene.igs"]);
    assert_eq!(ran.status, Some(0), "{ran:?}");
    let names: Vec<String> = std::fs::read_dir(bench.path("renders"))
        .expect("the directory of pictures")
        .map(|e| e.expect("an entry").file_name().to_string_lossy().into_owned())
        .collect();
    let [name] = &names[..] else { panic!("{names:?}") };
    // im_20081122T041500Z_scene.png
    let stamp =
        name.strip_prefix("im_").and_then(|n| n.strip_suffix("_scene.png")).expect("the form of names");
    assert!(stamp.len() == 16 && stamp.as_bytes()[8] == b'T' && stamp.ends_with('Z'), "{name}");
    assert!(ran.stderr.contains(name), "the picture is not named: {}", ran.stderr);
    assert_picture(&bench.path("renders").join(name), 40, 30);
}

/// White in the middle and black in the corners, as large as an aperture image must be; and none without a
/// shape of its own.
#[test]
fn an_aperture_shape_is_shown() {
    let bench = Workbench::new(QUIET);
    assert_eq!(bench.run(&["scene.igs", "-haltspp", "1", "-o", "a.png"]).status, Some(0));
    assert!(!bench.path("aperture_preview.png").exists());
    let scene = std::fs::read_to_string(bench.path("scene.igs")).expect("the scene");
    let blades = "<aperture_shape><generated><num_blades>5</num_blades><start_angle>0</start_angle><blade_offset>0.3</blade_offset><blade_curvature_radius>1</blade_curvature_radius></generated></aperture_shape></camera>";
    bench.write("scene.igs", &scene.replace("</camera>", blades));
    let ran = bench.run(&["scene.igs", "-haltspp", "1", "-o", "a.png"]);
    assert_eq!(ran.status, Some(0), "{ran:?}");
    assert!(ran.stderr.contains("aperture_preview.png"), "{}", ran.stderr);
    let bytes = std::fs::read(bench.path("aperture_preview.png")).expect("the preview");
    let image = indigo_formats::image::decode("x.png", &bytes).expect("a picture");
    let indigo_formats::image::Pixels::U8(codes) = image.pixels else { panic!("8 bits are expected") };
    assert_eq!((image.width, image.height, image.channels), (512, 512, 1));
    assert_eq!((codes[256 * 512 + 256], codes[0], codes[512 * 512 - 1]), (255, 0, 0));
    // The blade to the right ends at 0.3 of the width from the middle; the corner to the left does not.
    let open = |x: usize| codes[256 * 512 + x] == 255;
    assert!(open(256 + 150) && !open(256 + 157) && open(256 - 157));
}

#[test]
fn a_log_is_kept_if_wanted() {
    let bench = Workbench::new("<logging>true</logging>");
    let ran = bench.run(&["scene.igs", "-haltspp", "1", "-o", "a.png"]);
    assert_eq!(ran.status, Some(0), "{ran:?}");
    let log = std::fs::read_to_string(bench.path("log.txt")).expect("a log");
    assert!(log.contains("Saved a.png"), "{log}");
    let quiet = Workbench::new(QUIET);
    assert_eq!(quiet.run(&["scene.igs", "-haltspp", "1", "-o", "a.png"]).status, Some(0));
    assert!(!quiet.path("log.txt").exists());
}

#[test]
fn a_picture_says_how_it_was_made() {
    let bench = Workbench::new(&format!("{QUIET}<max_depth>6</max_depth>"));
    let ran =
        bench.run(&["scene.igs", "-haltspp", "3", "-o", "a.png", "-seed", "12345678901234567890", "-t", "2"]);
    assert_eq!(ran.status, Some(0), "{ran:?}");
    let told = bench.run(&["-dumpmetadata", "a.png"]);
    assert_eq!(told.status, Some(0), "{told:?}");
    for line in ["seed: 12345678901234567890", "maxdepth: 6", "num_threads: 2", "num_samples: 3600"] {
        assert!(told.stdout.contains(line), "{line}: {}", told.stdout);
    }
    bench.write("b.png", "not a picture");
    assert_eq!(bench.run(&["-dumpmetadata", "b.png"]).status, Some(1));
    assert_eq!(bench.run(&["-dumpmetadata", "nowhere.png"]).status, Some(1));
}

#[test]
fn a_picture_names_the_technique_and_the_mutations_that_made_it() {
    let bench = Workbench::new(&format!(
        "{QUIET}<large_mutation_prob>0.25</large_mutation_prob><max_change>0.03</max_change><max_num_consec_rejections>77</max_num_consec_rejections><save_untonemapped_exr>true</save_untonemapped_exr>"
    ));
    let text = std::fs::read_to_string(bench.path("scene.igs")).expect("the scene");
    for off in ["<metropolis>false", "<bidirectional>false"] {
        assert!(text.contains(off));
    }
    let text = text.replace("<metropolis>false", "<hybrid>true</hybrid><metropolis>true");
    bench.write("scene.igs", &text.replace("<bidirectional>false", "<bidirectional>true"));
    let ran = bench.run(&["scene.igs", "-haltspp", "1", "-o", "a.png"]);
    assert_eq!(ran.status, Some(0), "{ran:?}");
    assert!(ran.stderr.contains("max_num_consec_rejections = 77 biases the picture"), "{}", ran.stderr);
    let told = bench.run(&["-dumpmetadata", "a.png"]).stdout;
    for line in [
        "bidirectional: 1",
        "metropolis: 1",
        "hybrid: 1",
        "large_mutation_prob: 0.25000",
        "max_change: 0.03000",
        "max_num_consec_rejections: 77",
    ] {
        assert!(told.contains(line), "{line}: {told}");
    }
}

/// Two programs that start in the same second: neither loses its picture to the other.
#[test]
fn pictures_of_the_same_second_stand_beside_each_other() {
    let bench = Workbench::new(QUIET);
    let mut running: Vec<_> =
        (0..4).map(|_| bench.start(&["-haltspp", "1", "scene.igs", "-t", "1"])).collect();
    for program in &mut running {
        assert_eq!(program.finish(), Some(0));
    }
    let names = || std::fs::read_dir(bench.path("renders")).expect("the directory of pictures");
    assert_eq!(names().count(), 4);
    for name in names() {
        assert_picture(&name.expect("an entry").path(), 40, 30);
    }
}

#[test]
fn a_path_that_no_picture_can_have_is_refused_before_rendering() {
    let bench = Workbench::new(QUIET);
    std::fs::create_dir(bench.path("place")).expect("the test's own directory");
    for (path, says) in [
        ("a.jpg", "ends in .png is expected, not in .jpg"),
        ("x.exr", "ends in .png is expected, not in .exr"),
        ("", "is empty"),
        ("place", "is a directory"),
        ("new/", "is a directory"),
        ("..", "is a directory"),
        #[cfg(unix)]
        ("/dev/null", "is a device"),
    ] {
        let ran = bench.run(&["scene.igs", "-halt", "100", "-o", path]);
        assert_eq!(ran.status, Some(2), "{path}: {ran:?}");
        assert!(ran.stderr.contains(says), "{path}: {ran:?}");
    }
    let ran = bench.run(&["scene.igs", "-haltspp", "1", "-o", "new/shot"]);
    assert_eq!(ran.status, Some(0), "{ran:?}");
    assert!(ran.stderr.contains("note: the picture is written to new/shot.png"), "{ran:?}");
    assert_picture(&bench.path("new/shot.png"), 40, 30);
}

#[test]
fn the_same_seed_gives_the_same_picture() {
    let bench = Workbench::new(QUIET);
    let picture = |name: &str, seed: &str, threads: &str| {
        let ran = bench.run(&["scene.igs", "-haltspp", "4", "-o", name, "-seed", seed, "-t", threads]);
        assert_eq!(ran.status, Some(0), "{ran:?}");
        let bytes = std::fs::read(bench.path(name)).expect("the picture");
        let image = indigo_formats::image::decode(name, &bytes).expect("a picture");
        let indigo_formats::image::Pixels::U8(values) = image.pixels else { panic!("8 bits are expected") };
        values
    };
    let (a, b, c) = (picture("a.png", "5", "1"), picture("b.png", "5", "3"), picture("c.png", "6", "1"));
    // The rounding of sums may turn a value at the border between two levels.
    assert!(a.iter().zip(&b).all(|(x, y)| x.abs_diff(*y) <= 1));
    assert!(a != c, "another seed gives the same picture");
}

/// A file stands where the directory ought to be: even the system's owner cannot write there.
#[test]
fn a_picture_that_cannot_be_written_is_a_failure_that_says_so() {
    let bench = Workbench::new(&format!("{QUIET}<image_save_period>0.05</image_save_period>"));
    bench.write("wall", "not a directory");
    let ran = bench.run(&["scene.igs", "-halt", "1", "-o", "wall/a.png"]);
    assert_eq!(ran.status, Some(1), "{ran:?}");
    let warned = ran.stderr.find("warning: cannot write wall/a.png");
    let failed = ran.stderr.find("error: cannot write wall/a.png");
    assert!(warned.is_some() && warned < failed, "said while rendering, and at the end: {}", ran.stderr);
}
