//! What the program writes.

use super::workbench::{Workbench, assert_picture, scene};

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
    let ran = bench.run(&["scene.igs", "-haltspp", "1"]);
    assert_eq!(ran.status, Some(0), "{ran:?}");
    assert!(!bench.path("aperture_preview.png").exists(), "the preview lies beside the picture");
    assert!(ran.stderr.contains("aperture_preview.png"), "{}", ran.stderr);
    let bytes = std::fs::read(bench.path("renders/aperture_preview.png")).expect("the preview");
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
fn a_picture_that_cannot_be_written_is_told_before_rendering() {
    let bench = Workbench::new(QUIET);
    bench.write("wall", "not a directory");
    // Nothing would end this render.
    let ran = bench.run(&["scene.igs", "-o", "wall/a.png"]);
    assert_eq!(ran.status, Some(1), "{ran:?}");
    assert!(ran.stderr.contains("error: cannot write wall/a.png"), "{}", ran.stderr);
}

/// A picture has the name of an image map of its scene, by whatever way it is written.
#[test]
fn what_the_scene_reads_is_not_overwritten() {
    let bench = Workbench::new(QUIET);
    assert_eq!(bench.run(&["scene.igs", "-haltspp", "1", "-o", "wood.png"]).status, Some(0));
    let wood = std::fs::read(bench.path("wood.png")).expect("saved");
    let albedo = "<albedo_spectrum><uniform><value>0.5</value></uniform></albedo_spectrum>";
    let map = "<albedo_texture><path>wood.png</path><exponent>2.2</exponent></albedo_texture>";
    let text = std::fs::read_to_string(bench.path("scene.igs")).expect("the scene").replace(albedo, map);
    bench.write("wooden.igs", &text);
    for arguments in [
        &["wooden.igs", "-haltspp", "1", "-o", "wood.png"][..],
        &["wooden.igs", "-haltspp", "1", "-o", "./sub/../wood.png"],
    ] {
        std::fs::create_dir_all(bench.path("sub")).expect("the test's own directory");
        let ran = bench.run(arguments);
        assert_eq!(ran.status, Some(2), "{ran:?}");
        assert!(ran.stderr.contains("wood.png, which would be overwritten"), "{}", ran.stderr);
        assert_eq!(std::fs::read(bench.path("wood.png")).expect("still there"), wood);
    }
    assert_eq!(bench.run(&["wooden.igs", "-haltspp", "1", "-o", "other.png"]).status, Some(0));
}

/// The directory turns into a file while the program renders.
#[test]
fn a_save_that_fails_is_tried_again_and_is_a_failure_in_the_end() {
    let bench = Workbench::new(&format!("{QUIET}<image_save_period>0.02</image_save_period>"));
    let mut running = bench.start(&["scene.igs", "-halt", "2", "-o", "place/a.png"]);
    running.wait_for(&bench.path("place/a.png"));
    while std::fs::remove_dir_all(bench.path("place")).is_err() {}
    bench.write("place", "not a directory");
    assert_eq!(running.finish(), Some(1));
    let said = std::fs::read_to_string(bench.path("stderr")).expect("what it said");
    let warned = said.find("warning: cannot write place/a.png");
    let failed = said.find("error: cannot write place/a.png");
    assert!(warned.is_some() && warned < failed, "said while rendering, and at the end: {said}");
}

/// A quarter of a second holds many periods of a hundredth.
#[test]
fn pictures_are_saved_as_often_as_was_asked_for() {
    use std::collections::HashSet;
    let bench = Workbench::new(&format!("{QUIET}<image_save_period>0.01</image_save_period>"));
    let mut running = bench.start(&["scene.igs", "-halt", "2", "-o", "a.png", "-t", "1"]);
    let mut seen = HashSet::new();
    let mut status = None;
    while status.is_none() {
        let modified = std::fs::metadata(bench.path("a.png")).and_then(|m| m.modified());
        seen.extend(modified.ok());
        std::thread::sleep(std::time::Duration::from_millis(2));
        status = running.0.try_wait().expect("a child of ours");
    }
    // With a quarter of a second between them there would be eight, and one at the end.
    assert!(seen.len() > 12, "{} pictures", seen.len());
}

#[test]
fn lines_of_progress_come_as_often_as_was_asked_for() {
    let lines = |period: &str| {
        let bench = Workbench::new(&format!("{QUIET}<display_period>{period}</display_period>"));
        let ran = bench.run(&["scene.igs", "-halt", "1.5", "-o", "a.png", "-t", "1"]);
        assert_eq!(ran.status, Some(0), "{ran:?}");
        ran.stderr.lines().filter(|l| l.contains(" spp ")).count()
    };
    // One at the start and one at the end.
    assert_eq!(lines("60"), 2);
    let often = lines("0.1");
    assert!((6..=20).contains(&often), "{often} lines");
    // And no oftener than can be read: ten a second.
    let flood = lines("1e-6");
    assert!(flood <= 20, "{flood} lines");
}

fn image(bench: &Workbench, name: &str) -> indigo_formats::image::Pixels {
    let bytes = std::fs::read(bench.path(name)).expect("the picture");
    indigo_formats::image::decode(name, &bytes).expect("a picture").pixels
}

/// Each of these settings makes another file of the same film, and each does what it says.
#[test]
fn settings_of_the_picture_have_their_effects() {
    use indigo_formats::image::Pixels;
    let settings = format!("{QUIET}<save_igi>true</save_igi><width>200</width><height>150</height>");
    let bench = Workbench::new(&settings);
    assert_eq!(bench.run(&["scene.igs", "-haltspp", "4", "-o", "a.png"]).status, Some(0));
    let text = std::fs::read_to_string(bench.path("scene.igs")).expect("the scene");
    let developed = |more: &str| {
        bench.write("b.igs", &text.replace("<save_igi>true</save_igi>", more));
        let ran = bench.run(&["--tonemap", "b.igs", "a.igi", "b.png"]);
        assert_eq!(ran.status, Some(0), "{more}: {ran:?}");
        image(&bench, "b.png")
    };
    let Pixels::U8(plain) = developed("") else { panic!("8 bits by default") };
    let Pixels::U16(deep) = developed("<png_bits>16</png_bits>") else { panic!("16 bits were asked for") };
    assert!(plain.iter().zip(&deep).all(|(a, b)| (i32::from(*a) * 257 - i32::from(*b)).abs() <= 129));
    let Pixels::U8(dithered) = developed("<dithering>true</dithering>") else { panic!("8 bits") };
    assert!(plain != dithered && plain.iter().zip(&dithered).all(|(a, b)| a.abs_diff(*b) <= 1));
    let Pixels::U8(marked) = developed("<watermark>true</watermark>") else { panic!("8 bits") };
    let changed: Vec<usize> =
        (0..200 * 150).filter(|i| plain[3 * i..3 * i + 3] != marked[3 * i..3 * i + 3]).collect();
    assert!(
        changed.len() > 100 && changed.iter().all(|i| i % 200 >= 100 && i / 200 >= 135),
        "{}",
        changed.len()
    );
    let Pixels::U8(region) =
        developed("<render_region><x1>20</x1><y1>30</y1><x2>120</x2><y2>90</y2></render_region>")
    else {
        panic!("8 bits")
    };
    for i in 0..200 * 150 {
        let is_inside = (20..120).contains(&(i % 200)) && (30..90).contains(&(i / 200));
        assert_eq!(region[3 * i..3 * i + 3] != [0, 0, 0], is_inside, "pixel {i}");
    }
}

/// White where the sphere is, black where the surroundings are seen, grey along the edge alone; with light paths and
/// Markov chains asked for, too.
#[test]
fn foreground_alpha_is_smooth_in_every_mode() {
    use indigo_formats::image::Pixels;
    for mode in [
        "<metropolis>false</metropolis><bidirectional>false<",
        "<metropolis>true</metropolis><bidirectional>true<",
    ] {
        let bench =
            Workbench::new(&format!("{QUIET}<render_foreground_alpha>true</render_foreground_alpha>"));
        let text = std::fs::read_to_string(bench.path("scene.igs")).expect("the scene");
        bench.write("m.igs", &text.replace("<metropolis>false</metropolis><bidirectional>false<", mode));
        let ran = bench.run(&["m.igs", "-haltspp", "64", "-o", "a.png"]);
        assert_eq!(ran.status, Some(0), "{ran:?}");
        let Pixels::U8(values) = image(&bench, "a.png") else { panic!("8 bits") };
        let count = |test: &dyn Fn(u8) -> bool| values.iter().filter(|v| test(**v)).count() / 3;
        let (black, white) = (count(&|v| v == 0), count(&|v| v == 255));
        let grey = 40 * 30 - black - white;
        // A sphere of radius 1 at distance 4: 7.75 rows of pixels from its centre to its edge, times the splat filter.
        assert!(
            (500..1100).contains(&black) && (100..350).contains(&white) && (30..250).contains(&grey),
            "{black} {white} {grey}"
        );
    }
}

/// Whichever EXR somebody takes for a mask is one, without a luminance of white.
#[test]
fn every_exr_of_a_mask_is_the_mask() {
    let settings = "<render_foreground_alpha>true</render_foreground_alpha><save_untonemapped_exr>true</save_untonemapped_exr>\
        <save_tonemapped_exr>true</save_tonemapped_exr><save_layers_exr>true</save_layers_exr>";
    let bench = Workbench::new(&format!("{QUIET}{settings}"));
    let ran = bench.run(&["scene.igs", "-haltspp", "16", "-o", "a.png", "-denoise"]);
    assert_eq!(ran.status, Some(0), "{ran:?}");
    assert!(ran.stderr.contains("note: coverage by the foreground is not denoised"), "{}", ran.stderr);
    let red = |name: &str| {
        let image = exr::prelude::read_first_flat_layer_from_file(bench.path(name)).expect("an EXR");
        let attributes = &image.layer_data.attributes;
        let content = attributes.other.get(&exr::prelude::Text::from("indigo.content"));
        (
            image
                .layer_data
                .channel_data
                .list
                .iter()
                .find(|c| c.name.eq("R"))
                .expect("red")
                .sample_data
                .values_as_f32()
                .collect::<Vec<_>>(),
            attributes.white_luminance,
            format!("{content:?}"),
        )
    };
    let mask = red("a_tonemapped.exr").0;
    assert!(mask[15 * 40 + 20] == 1.0 && mask[0] == 0.0 && mask.iter().any(|v| (0.1..0.9).contains(v)));
    for name in ["a_untonemapped.exr", "a_tonemapped.exr", "a_layers.exr"] {
        let (values, white, content) = red(name);
        let is_near = |(a, b): (&f32, &f32)| (a - b).abs() < 0.3;
        assert!(values.iter().zip(&mask).all(is_near) && values[0] == 0.0, "{name}");
        assert_eq!(white, None, "{name}");
        assert!(content.contains("coverage by the foreground"), "{name}: {content}");
    }
}

#[test]
fn an_estimated_error_ends_a_render() {
    let bench = Workbench::new(QUIET);
    let ran = bench.run(&["scene.igs", "-halterror", "0.05", "-o", "a.png"]);
    assert_eq!(ran.status, Some(0), "{ran:?}");
    assert_picture(&bench.path("a.png"), 40, 30);
    let last = ran.stderr.lines().rfind(|l| l.contains(" spp ")).expect("a line of progress");
    let error = last.split("error ").nth(1).and_then(|rest| rest.split('%').next()).expect("the error");
    assert!(error.parse::<f64>().expect("a number") <= 5.0, "{last}");
    assert_eq!(bench.run(&["scene.igs", "-halterror", "-1"]).status, Some(2));
}

/// Two renders of one name would write over each other's film; by whatever path they are called.
#[test]
fn a_picture_is_one_renders_at_a_time() {
    let bench = Workbench::new(&format!("{QUIET}<image_save_period>0.05</image_save_period>"));
    bench.write("film.igs", &scene(&format!("{QUIET}<save_igi>true</save_igi>")));
    let mut first = bench.start(&["scene.igs", "-o", "a.png", "-t", "1"]);
    first.wait_for(&bench.path("a.png"));
    let path = bench.path("a.png").display().to_string();
    // The last has the same film.
    for name in ["a.png", "./a.png", &path, "a.PNG"] {
        let second = bench.run(&["scene.igs", "-o", name, "-haltspp", "1"]);
        assert_eq!(second.status, Some(1), "{second:?}");
        assert!(
            second.stderr.contains("another render writes") && second.stderr.contains("(-o)"),
            "{second:?}"
        );
    }
    let other = bench.run(&["scene.igs", "-o", "b.png", "-haltspp", "1"]);
    assert_eq!(other.status, Some(0), "another name is free: {other:?}");
    // What is added up or developed would be gone with the next save.
    for seed in ["1", "2"] {
        let ran = bench.run(&["film.igs", "-o", &format!("{seed}.png"), "-seed", seed, "-haltspp", "1"]);
        assert_eq!(ran.status, Some(0), "{ran:?}");
    }
    for arguments in
        [&["--merge", "1.igi", "2.igi", "-o", "a.igi"][..], &["--tonemap", "scene.igs", "1.igi", "a.png"]]
    {
        let ran = bench.run(arguments);
        assert!(ran.status == Some(1) && ran.stderr.contains("another render writes"), "{ran:?}");
        assert!(!bench.path("a.igi").exists());
    }
    let ran = bench.run(&["--merge", "1.igi", "2.igi", "-o", "new/sum.igi"]);
    assert!(ran.status == Some(0) && !ran.stderr.contains("warning"), "{ran:?}");
    // Who can keep no lock is told so.
    let ran = bench.run_with(
        "INDIGO_CACHE",
        &bench.path("scene.igs"),
        &["scene.igs", "-o", "c.png", "-haltspp", "1"],
    );
    let says = "whether another render writes c.igi cannot be told";
    assert!(
        ran.status == Some(0) && ran.stderr.contains(says) && ran.stderr.contains("INDIGO_CACHE"),
        "{ran:?}"
    );
    first.0.kill().expect("a child of ours");
    first.0.wait().expect("a child of ours");
    assert_eq!(
        bench.run(&["scene.igs", "-o", "a.png", "-haltspp", "1"]).status,
        Some(0),
        "and so is a dead one's"
    );
}
