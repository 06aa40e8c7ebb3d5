//! Saved films: going on, adding, developing again; on disks that fill up and with programs that die.

use super::workbench::{Ran, Workbench, assert_picture};
use indigo_film::{SavedFilm, igi};

const SAVED: &str = "<logging>false</logging><save_igi>true</save_igi>";

fn film(bench: &Workbench, name: &str) -> SavedFilm {
    let bytes = std::fs::read(bench.path(name)).expect("the film");
    igi::read(&bytes).expect("a sound film")
}

#[track_caller]
fn ok(ran: &Ran) {
    assert_eq!(ran.status, Some(0), "{ran:?}");
}

fn samples(film: &SavedFilm) -> u64 {
    film.record.as_ref().expect("a film of this program").samples
}

/// Equal but for the rounding of sums.
fn assert_same(a: &SavedFilm, b: &SavedFilm) {
    assert_eq!(samples(a), samples(b));
    for (a, b) in a.film.layers.iter().zip(&b.film.layers) {
        assert_eq!(a.counts, b.counts);
        for (a, b) in a.sums.as_flattened().iter().zip(b.sums.as_flattened()) {
            assert!((a - b).abs() <= 1e-6 * a.abs().max(b.abs()), "{a} and {b}");
        }
    }
}

#[test]
fn a_render_goes_on_where_it_ended() {
    let bench = Workbench::new(SAVED);
    ok(&bench.run(&["scene.igs", "-haltspp", "6", "-o", "once.png", "-seed", "9"]));
    ok(&bench.run(&["scene.igs", "-haltspp", "2", "-o", "a.png", "-seed", "9"]));
    // The seed is that of the film, and the file that is gone on with may be the one that is written.
    let ran = bench.run(&["scene.igs", "-haltspp", "6", "-r", "a.igi", "-o", "a.png"]);
    ok(&ran);
    assert!(ran.stderr.contains("Going on with a.igi: 2.0 spp"), "{}", ran.stderr);
    assert_same(&film(&bench, "a.igi"), &film(&bench, "once.igi"));
    let told = bench.run(&["-dumpmetadata", "a.png"]);
    assert!(told.stdout.contains("num_samples: 7200") && told.stdout.contains("seed: 9"), "{}", told.stdout);
}

/// The command of last night again, with the film forgotten, and ended before anything came.
#[test]
fn a_film_without_samples_takes_no_others_place() {
    let bench = Workbench::new(&format!("{SAVED}<image_save_period>0.1</image_save_period>"));
    ok(&bench.run(&["scene.igs", "-haltspp", "2", "-o", "a.png"]));
    let content = |name: &str| std::fs::read(bench.path(name)).expect("it is there");
    let before = [content("a.igi"), content("a.png")];
    let master = ["scene.igs", "-n", "m", "-p", "0", "-halt", "0.5", "-o"];
    let ran = bench.run(&[&master[..], &["a.png"]].concat());
    ok(&ran);
    assert!([content("a.igi"), content("a.png")] == before, "{ran:?}");
    for name in ["a.igi", "a.png"] {
        assert!(ran.stderr.contains(&format!("{name} stays as it was")), "{name}: {}", ran.stderr);
    }
    // Where there was none, there is one to go on with.
    ok(&bench.run(&[&master[..], &["b.png"]].concat()));
    assert_eq!(samples(&film(&bench, "b.igi")), 0);
    // What has samples takes its place as ever.
    ok(&bench.run(&["scene.igs", "-haltspp", "3", "-o", "a.png"]));
    assert_eq!(samples(&film(&bench, "a.igi")), 40 * 30 * 3);
}

#[test]
fn independent_renders_add_up() {
    let bench = Workbench::new(SAVED);
    for seed in ["1", "2", "3"] {
        ok(&bench.run(&["scene.igs", "-haltspp", "2", "-o", &format!("{seed}.png"), "-seed", seed]));
    }
    let ran = bench.run(&["--merge", "1.igi", "2.igi", "3.igi", "-o", "sum.igi"]);
    ok(&ran);
    assert!(ran.stderr.contains("Saved sum.igi: 3 films, 6.0 spp"), "{}", ran.stderr);
    let sum = film(&bench, "sum.igi");
    let mut expected = film(&bench, "1.igi");
    expected.merge(&film(&bench, "2.igi")).expect("another seed");
    expected.merge(&film(&bench, "3.igi")).expect("another seed");
    assert_eq!(sum, expected);
    ok(&bench.run(&["scene.igs", "-haltspp", "7", "-r", "sum.igi", "-o", "on.png"]));
    assert_eq!(samples(&film(&bench, "on.igi")), 40 * 30 * 7);
    let before = std::fs::read(bench.path("1.igi")).expect("the film");
    let ran = bench.run(&["--merge", "./1.igi", "2.igi", "-o", "1.igi"]);
    assert!(ran.status == Some(2) && ran.stderr.contains("would be overwritten"), "{ran:?}");
    assert!(std::fs::read(bench.path("1.igi")).expect("the film") == before);
    for (films, says) in [
        (["1.igi", "1.igi"], "would count twice"),
        (["1.igi", "sum.igi"], "seed 1"),
        (["1.igi", "scene.igs"], "not an Indigo image"),
        (["1.igi", "nowhere.igi"], "cannot read nowhere.igi"),
    ] {
        let ran = bench.run(&["--merge", films[0], films[1], "-o", "no.igi"]);
        assert!(ran.status != Some(0) && ran.stderr.contains(says), "{films:?}: {ran:?}");
        assert!(!bench.path("no.igi").exists());
    }
}

#[test]
fn a_film_of_another_scene_is_not_gone_on_with() {
    let bench = Workbench::new(SAVED);
    ok(&bench.run(&["scene.igs", "-haltspp", "1", "-o", "a.png"]));
    let text = std::fs::read_to_string(bench.path("scene.igs")).expect("the scene");
    bench.write("other.igs", &text.replace("<radius>1<", "<radius>1.1<"));
    bench.write("wider.igs", &text.replace("<width>40<", "<width>44<"));
    for (scene, says) in [("other.igs", "the scene itself"), ("wider.igs", "width is 40 there, and 44 here")]
    {
        let ran = bench.run(&[scene, "-haltspp", "2", "-r", "a.igi", "-o", "b.png"]);
        assert_eq!(ran.status, Some(2), "{ran:?}");
        assert!(ran.stderr.contains(says), "{}", ran.stderr);
        assert!(!bench.path("b.png").exists());
    }
}

/// A file counts by what is in it, wherever it lies, and in the place where it is named.
#[test]
fn a_scenes_files_count_by_their_content() {
    let bench = Workbench::new(SAVED);
    // An opening and dust, as large as aperture images must be.
    let picture = |dark: usize| {
        let codes: Vec<u8> = (0..512 * 512).map(|i| if i % 512 < dark { 0 } else { 255 }).collect();
        indigo_imaging::png::encode_grey(512, &codes).expect("a picture")
    };
    let write = |name: &str, dark: usize| std::fs::write(bench.path(name), picture(dark)).expect("a file");
    write("a.png", 100);
    write("b.png", 200);
    let text = std::fs::read_to_string(bench.path("scene.igs")).expect("the scene");
    let scene = |aperture: &str, dust: &str| {
        let camera = format!(
            "<aperture_shape><image><path>{aperture}</path></image></aperture_shape><obstacle_map>{dust}</obstacle_map></camera>"
        );
        text.replace("</camera>", &camera)
    };
    bench.write("scene.igs", &scene("a.png", "b.png"));
    ok(&bench.run(&["scene.igs", "-haltspp", "1", "-o", "first.png"]));
    write("elsewhere.png", 100);
    bench.write("moved.igs", &scene("elsewhere.png", "b.png"));
    ok(&bench.run(&["moved.igs", "-haltspp", "2", "-r", "first.igi", "-o", "moved.png"]));
    std::fs::remove_file(bench.path("aperture_preview.png")).expect("the preview");
    write("a.png", 200);
    write("b.png", 100);
    let ran = bench.run(&["scene.igs", "-haltspp", "2", "-r", "first.igi", "-o", "exchanged.png"]);
    assert_eq!(ran.status, Some(2), "{ran:?}");
    assert!(ran.stderr.contains("the scene itself"), "{}", ran.stderr);
    for name in ["exchanged.png", "exchanged.igi", "aperture_preview.png"] {
        assert!(!bench.path(name).exists(), "a refused film writes {name}");
    }
    // Without a name either.
    let ran = bench.run(&["scene.igs", "-haltspp", "2", "-r", "first.igi"]);
    assert_eq!(ran.status, Some(2), "{ran:?}");
    assert!(!bench.path("renders").exists());
}

/// The picture that a render saved is the one that its film gives; with other settings it is another.
#[test]
fn a_film_is_developed_again() {
    let bench = Workbench::new(SAVED);
    ok(&bench.run(&["scene.igs", "-haltspp", "3", "-o", "a.png"]));
    let ran = bench.run(&["--tonemap", "scene.igs", "a.igi", "again.png"]);
    ok(&ran);
    let pixels = |name: &str| {
        let bytes = std::fs::read(bench.path(name)).expect("the picture");
        indigo_formats::image::decode(name, &bytes).expect("a picture").pixels
    };
    assert!(pixels("a.png") == pixels("again.png"));
    assert!(!bench.path("again.igi").exists());
    let text = std::fs::read_to_string(bench.path("scene.igs")).expect("the scene");
    bench.write("darker.igs", &text.replace("<pre_scale>4<", "<pre_scale>1<"));
    ok(&bench.run(&["--tonemap", "darker.igs", "a.igi", "darker.png"]));
    assert!(pixels("a.png") != pixels("darker.png"));
    bench.write("broken.igi", "no film");
    assert_eq!(bench.run(&["--tonemap", "scene.igs", "broken.igi", "x.png"]).status, Some(1));
}

/// A film of deflected rays is not to be diffracted again without a word; and layers are of a scene, not of a film.
#[test]
fn what_developing_cannot_do_right_is_said() {
    let bench = Workbench::new(SAVED);
    let text = std::fs::read_to_string(bench.path("scene.igs")).expect("the scene");
    let diffracting = |filter: bool| {
        let on = format!(
            "<aperture_diffraction>true</aperture_diffraction><post_process_diffraction>{filter}</post_process_diffraction>"
        );
        text.replace("<aperture_diffraction>false</aperture_diffraction>", &on)
    };
    bench.write("rays.igs", &diffracting(false));
    bench.write("filter.igs", &diffracting(true));
    ok(&bench.run(&["rays.igs", "-haltspp", "1", "-o", "a.png"]));
    for (scene, warns) in [("rays.igs", false), ("filter.igs", true)] {
        let ran = bench.run(&["--tonemap", scene, "a.igi", "b.png"]);
        ok(&ran);
        assert_eq!(ran.stderr.contains("warning: light is diffracted twice"), warns, "{}", ran.stderr);
    }
    let ran = bench.run(&["--tonemap", "rays.igs", "a.igi", "c.png", "-layers"]);
    ok(&ran);
    assert!(ran.stderr.contains("note: the layers are made while a scene is rendered"), "{}", ran.stderr);
    assert!(bench.path("c.png").exists() && !bench.path("c_layers.exr").exists());
    // Of another program's film, which has no mark, a pixel that is no number.
    let mut foreign = std::fs::read(bench.path("a.igi")).expect("the film");
    let internal = |at: usize| u32::from_le_bytes(std::array::from_fn(|i| foreign[at + i])) as usize;
    let pixels = internal(16) * internal(20);
    foreign.truncate(5040 + 12 * pixels);
    foreign[40..52].fill(0);
    for (pixel, says) in [(0.5, false), (f32::NAN, true)] {
        foreign[5040..5044].copy_from_slice(&pixel.to_le_bytes());
        std::fs::write(bench.path("foreign.igi"), &foreign).expect("room on the disk");
        let ran = bench.run(&["--tonemap", "rays.igs", "foreign.igi", "d.png"]);
        ok(&ran);
        assert_eq!(ran.stderr.contains("1 pixels of the film"), says, "{}", ran.stderr);
    }
}

/// What hides the background is no light, and light does not tell what hides the background: a film is developed as what
/// it holds, and the setting that differs is the one that is named.
#[test]
fn masks_and_light_are_not_taken_for_each_other() {
    let bench = Workbench::new(SAVED);
    let text = std::fs::read_to_string(bench.path("scene.igs")).expect("the scene");
    let mask = "<render_foreground_alpha>true</render_foreground_alpha></renderer_settings>";
    bench.write("mask.igs", &text.replace("</renderer_settings>", mask));
    ok(&bench.run(&["scene.igs", "-haltspp", "1", "-o", "light.png"]));
    ok(&bench.run(&["mask.igs", "-haltspp", "1", "-o", "mask.png"]));
    ok(&bench.run(&["--tonemap", "mask.igs", "mask.igi", "again.png"]));
    for (scene, film, says) in [
        ("scene.igs", "mask.igi", "holds what hides the background, and no light"),
        ("mask.igs", "light.igi", "holds light, but in the scene render_foreground_alpha is true"),
    ] {
        let ran = bench.run(&["--tonemap", scene, film, "x.png"]);
        assert!(ran.status == Some(2) && ran.stderr.contains(says), "{ran:?}");
        assert!(!bench.path("x.png").exists());
        let ran = bench.run(&[scene, "-haltspp", "2", "-r", film, "-o", "x.png"]);
        assert!(ran.status == Some(2) && ran.stderr.contains(": render_foreground_alpha is "), "{ran:?}");
        assert!(!ran.stderr.contains("max_depth") && !ran.stderr.contains("layers"), "{}", ran.stderr);
    }
}

/// Films of before that was said in them are taken as the scene has it, and that is told.
#[test]
fn a_film_that_does_not_say_what_it_holds_is_taken_as_the_scene_has_it() {
    let bench = Workbench::new(SAVED);
    let text = std::fs::read_to_string(bench.path("scene.igs")).expect("the scene");
    let mask = "<render_foreground_alpha>true</render_foreground_alpha></renderer_settings>";
    bench.write("mask.igs", &text.replace("</renderer_settings>", mask));
    ok(&bench.run(&["scene.igs", "-haltspp", "1", "-o", "a.png"]));
    let mut old =
        indigo_film::igi::read(&std::fs::read(bench.path("a.igi")).expect("a film")).expect("a film");
    let record = old.record.as_mut().expect("a film of this program");
    record.settings.retain(|(name, _)| name != "render_foreground_alpha");
    let mut file = Vec::new();
    indigo_film::igi::write(&mut file, &old.film, old.record.as_ref().expect("its record")).expect("a film");
    std::fs::write(bench.path("old.igi"), file).expect("a file");
    for (scene, taken) in [("scene.igs", "light"), ("mask.igs", "what hides the background")] {
        let ran = bench.run(&["--tonemap", scene, "old.igi", "x.png"]);
        ok(&ran);
        let says = format!(
            "does not say whether it was rendered with render_foreground_alpha, as it is of an older \
                            version: it is taken for {taken}, as in the scene"
        );
        assert!(ran.stderr.contains(&says), "{}", ran.stderr);
        let ran = bench.run(&["--tonemap", scene, "a.igi", "x.png"]);
        assert!(!ran.stderr.contains("does not say"), "{}", ran.stderr);
    }
}

/// What is named by mistake is told before a scene is read that may take its time, and without rendering, too.
#[test]
fn a_file_that_is_no_film_is_told_before_the_scene_is_read() {
    let bench = Workbench::new(SAVED);
    for (film, says) in
        [("scene.igs", "this is not an Indigo image (.igi)"), ("none.igi", "cannot read none.igi")]
    {
        for more in ["-haltspp=1", "--check"] {
            let ran = bench.run(&["missing.igs", "-r", film, more]);
            assert!(ran.status == Some(1) && ran.stderr.contains(says), "{ran:?}");
            assert!(!ran.stderr.contains("missing.igs"), "{}", ran.stderr);
        }
    }
}

/// A folder of a name that is mistyped is made, but not without a word.
#[test]
fn new_folders_are_told() {
    let bench = Workbench::new(SAVED);
    ok(&bench.run(&["scene.igs", "-haltspp", "1", "-o", "1.png", "-seed", "1"]));
    ok(&bench.run(&["scene.igs", "-haltspp", "1", "-o", "2.png", "-seed", "2"]));
    for (arguments, folder) in [
        (&["--merge", "1.igi", "2.igi", "-o", "a/sum.igi"][..], "a"),
        (&["--tonemap", "scene.igs", "1.igi", "b/c/x.png"], "b/c"),
        (&["scene.igs", "-haltspp", "1", "-o", "d/x.png"], "d"),
    ] {
        let says = format!("note: the folder {folder} is new");
        let ran = bench.run(arguments);
        ok(&ran);
        assert!(ran.stderr.contains(&says), "{}", ran.stderr);
        assert!(!bench.run(arguments).stderr.contains(&says));
    }
}

/// Of two developments of one film the pictures tell which is which.
#[test]
fn pictures_tell_how_they_were_developed() {
    let bench = Workbench::new(SAVED);
    ok(&bench.run(&["scene.igs", "-haltspp", "1", "-o", "a.png"]));
    let text = std::fs::read_to_string(bench.path("scene.igs")).expect("the scene");
    let camera = "<exposure_duration>0.5</exposure_duration><white_balance>D50</white_balance></camera>";
    let (from, to) = (text.find("<reinhard>"), text.find("</tonemapping>"));
    let (from, to) = (from.expect("tone mapping"), to.expect("its end"));
    let mapping = "<camera><response_function_path></response_function_path><ev_adjust>1.5</ev_adjust><film_iso>200</film_iso></camera>";
    let text = format!("{}{mapping}{}", text[..from].replace("</camera>", camera), &text[to..]);
    let box_filter = "<downsize_filter><box/></downsize_filter></renderer_settings>";
    bench.write("b.igs", &text.replace("</renderer_settings>", box_filter));
    ok(&bench.run(&["--tonemap", "b.igs", "a.igi", "b.png"]));
    let expected = [
        (
            "a.png",
            [
                "tone_mapping: reinhard with pre_scale 4, post_scale 1, burn 6",
                "white_balance: D65",
                "exposure_duration: 0.01",
                "downsize_filter: mn_cubic with blur 0.6, ring 0.2",
            ],
        ),
        (
            "b.png",
            [
                "tone_mapping: camera with ev_adjust 1.5, film_iso 200, no response_function_path",
                "white_balance: D50",
                "exposure_duration: 0.5",
                "downsize_filter: box",
            ],
        ),
    ];
    for (picture, lines) in expected {
        let told = bench.run(&["-dumpmetadata", picture]).stdout;
        for line in lines.into_iter().chain([
            "splat_filter: gaussian",
            "aperture_diffraction: none",
            "content: the developed picture",
            "camera_position: 0 0 0",
            "camera_forwards: 0 1 0",
            "camera_up: 0 0 1",
            "sensor_width: 0.036",
            "focus_distance: 4",
        ]) {
            assert!(told.lines().any(|l| l == line), "{picture} lacks '{line}':\n{told}");
        }
    }
}

/// A disk that holds some saves and then no more: the limit on the size of files stands in for it. Whatever fits
/// is complete, and what does not leaves the last one.
#[cfg(unix)]
#[test]
fn a_full_disk_leaves_what_was_complete() {
    let bench = Workbench::new(SAVED);
    ok(&bench.run(&["scene.igs", "-haltspp", "2", "-o", "a.png"]));
    let before = film(&bench, "a.igi");
    let sizes = ["a.igi", "a.png"].map(|name| std::fs::metadata(bench.path(name)).expect("saved").len());
    // In blocks of 512 bytes: nothing at all, and the picture but not the film, with room to spare and with hardly any.
    for blocks in [0, sizes[0] / 1024, (sizes[1] / 512 + 2).min(sizes[0] / 512 - 1)] {
        let ran = bench.run_limited(blocks, &["scene.igs", "-haltspp", "9", "-r", "a.igi", "-o", "a.png"]);
        assert_eq!(ran.status, Some(1), "{blocks} blocks: {ran:?}");
        assert!(ran.stderr.contains("error: cannot write a.igi"), "{}", ran.stderr);
        assert_eq!(ran.stderr.contains("Saved a.png"), blocks > 0, "{blocks} blocks: {}", ran.stderr);
        assert_eq!(film(&bench, "a.igi"), before);
        assert_picture(&bench.path("a.png"), 40, 30);
        assert_eq!(bench.files(), ["a.igi", "a.png", "scene.igs"], "nothing half-made stays");
    }
}

/// Through the curves that come with the program, through a file beside the scene, and with other speed: each is
/// another picture; twice the speed is one step of exposure.
#[test]
fn a_camera_develops_by_its_response_and_speed() {
    let bench = Workbench::new(SAVED);
    ok(&bench.run(&["scene.igs", "-haltspp", "2", "-o", "a.png"]));
    let text = std::fs::read_to_string(bench.path("scene.igs")).expect("the scene");
    let (before, rest) = text.split_once("<reinhard>").expect("a tone mapping");
    let (_, after) = rest.split_once("</reinhard>").expect("a tone mapping");
    bench.write("dim.txt", "dim\ngraph\nI =\n0 1\nB =\n0 0.5\n");
    let develop = |path: &str, ev: &str, iso: &str| {
        let camera = format!(
            "<camera><response_function_path>{path}</response_function_path><ev_adjust>{ev}</ev_adjust>\
             <film_iso>{iso}</film_iso></camera>"
        );
        bench.write("camera.igs", &format!("{before}{camera}{after}"));
        ok(&bench.run(&["--tonemap", "camera.igs", "a.igi", "camera.png"]));
        let bytes = std::fs::read(bench.path("camera.png")).expect("the picture");
        let indigo_formats::image::Pixels::U8(values) =
            indigo_formats::image::decode("camera.png", &bytes).expect("a picture").pixels
        else {
            panic!("8 bits")
        };
        values
    };
    let shipped = "data/camera_response_functions/film_contrast.txt";
    let mut pictures = vec![
        develop("", "0", "800"),
        develop("dim.txt", "0", "800"),
        develop(shipped, "0", "800"),
        develop(shipped, "1", "800"),
    ];
    assert_eq!(develop(shipped, "0", "1600"), pictures[3]);
    assert!(pictures[1].iter().all(|&v| v <= 128), "brighter than the end of the curve");
    let mean = |p: &[u8]| p.iter().map(|&v| u64::from(v)).sum::<u64>() / p.len() as u64;
    assert!(pictures.iter().all(|p| mean(p) > 5 && mean(p) < 250), "not the range of these curves");
    pictures.dedup();
    assert_eq!(pictures.len(), 4);
    bench.write("odd.txt", "dim\nI = 0 .5 1\nB = 0 1 .5\n");
    let text = std::fs::read_to_string(bench.path("camera.igs")).expect("the scene");
    bench.write("odd.igs", &text.replace(shipped, "odd.txt"));
    let ran = bench.run(&["odd.igs", "--check"]);
    let says = "odd.txt:3:9: expected brightnesses that do not decrease, found 0.5 after 1";
    assert!(ran.status == Some(0) && ran.stderr.matches(says).count() == 1, "{ran:?}");
    bench.write("broken.txt", "dim\nI = 0 1\nB = 0 2\n");
    let scene = std::fs::read_to_string(bench.path("camera.igs")).expect("the scene");
    for (path, says, status) in [
        ("broken.txt", "3:7: expected a brightness", 2),
        ("none.txt", "the response of a display stands in", 0),
    ] {
        bench.write("bad.igs", &scene.replace(shipped, path));
        let ran = bench.run(&["bad.igs", "--check"]);
        assert!(
            ran.status == Some(status) && ran.stderr.contains(says) && ran.stderr.contains("bad.igs:"),
            "{ran:?}"
        );
    }
}

/// A scene with two lights in layers of their own.
fn lit(layers: &str) -> String {
    format!(
        "{SAVED}<save_untonemapped_exr>true</save_untonemapped_exr><save_layers_exr>true</save_layers_exr>{layers}"
    )
}

/// A film does not know how bright its lights are in the picture: it is developed, and gone on with, as the scene says then.
#[test]
fn lights_are_turned_up_and_down_after_the_render() {
    let layer = |gain: f64| {
        format!(
            "<layer_setting><name>all</name><layer_scale><uniform><value>{gain}</value></uniform></layer_scale></layer_setting>"
        )
    };
    let bench = Workbench::new(&lit(&layer(1.0)));
    ok(&bench.run(&["scene.igs", "-haltspp", "2", "-o", "a.png", "-seed", "3"]));
    let mean = |name: &str, channel: &str| {
        let image = exr::prelude::read_first_flat_layer_from_file(bench.path(name)).expect("an EXR");
        let channels = &image.layer_data.channel_data.list;
        let green = channels.iter().find(|c| c.name.eq(channel)).expect("a channel");
        let values: Vec<f64> = green.sample_data.values_as_f32().map(f64::from).collect();
        values.iter().sum::<f64>() / values.len() as f64
    };
    let before = mean("a_untonemapped.exr", "G");
    assert!(before > 0.0);
    assert!((mean("a_layers.exr", "light1.G") / before - 1.0).abs() < 1e-4);
    let scene = std::fs::read_to_string(bench.path("scene.igs")).expect("the scene");
    for (name, setting, factor) in [
        ("dim", layer(0.25), 0.25),
        ("off", layer(1.0).replace("<name>", "<enabled>false</enabled><name>"), 0.0),
    ] {
        bench.write("other.igs", &scene.replace(&layer(1.0), &setting));
        ok(&bench.run(&["--tonemap", "other.igs", "a.igi", &format!("{name}.png")]));
        let after = mean(&format!("{name}_untonemapped.exr"), "G");
        assert!((after / before - factor).abs() < 1e-4, "{name}: {after} of {before}");
        // The film is of that scene, too.
        let ran = bench.run(&["other.igs", "-haltspp", "3", "-r", "a.igi", "-o", &format!("{name}2.png")]);
        ok(&ran);
        assert!(ran.stderr.contains("Going on with a.igi"), "{}", ran.stderr);
        let gone_on = mean(&format!("{name}2_untonemapped.exr"), "G");
        assert!((gone_on / before - factor).abs() < 0.1, "{name}: {gone_on} of {before}");
    }
}
