//! Settings, and the layers that they come from.

use super::common::*;
use indigo_film::Filter;
use indigo_scene::{LoadOptions, Origin, Override, load};

#[test]
fn transport_settings_reach_the_scene() {
    let transport = |settings: &str| {
        let text = format!("{HEAD}{CAMERA}</scene>")
            .replace("<bidirectional>false</bidirectional>", "")
            .replace("<metropolis>false</metropolis>", "")
            .replace("<width>64</width>", &format!("<width>64</width>{settings}"));
        let l = loaded(&text);
        assert!(!l.sink.has_errors(), "{:?}", l.sink.diagnostics());
        l.scene.expect("a sound scene").transport
    };
    let default = transport("");
    assert!(default.bidirectional && !default.hybrid && default.max_depth == 10_000);
    let metropolis = default.metropolis.expect("on by default");
    assert_eq!(metropolis.large_mutation_prob, 0.4);
    assert_eq!(metropolis.max_change, 0.01);
    assert_eq!(metropolis.max_consecutive_rejections, 1000);
    let set = transport(
        "<bidirectional>false</bidirectional><large_mutation_prob>0.1</large_mutation_prob>\
         <max_change>0.5</max_change><max_num_consec_rejections>7</max_num_consec_rejections>",
    );
    assert!(!set.bidirectional);
    let metropolis = set.metropolis.expect("on by default");
    assert_eq!(metropolis.large_mutation_prob, 0.1);
    assert_eq!((metropolis.max_change, metropolis.max_consecutive_rejections), (0.5, 7));
    assert_eq!(transport("<metropolis>false</metropolis>").metropolis, None);
    // A hybrid needs Metropolis sampling for its indirect light.
    let hybrid = transport("<metropolis>false</metropolis><hybrid>true</hybrid>");
    assert!(hybrid.hybrid && hybrid.metropolis.is_some());
}

#[test]
fn pictures_of_impossible_size() {
    let codes = |settings: &str| {
        let l = loaded(&format!("{HEAD}{CAMERA}</scene>").replace("<width>64</width>", settings));
        l.sink.diagnostics().iter().map(|d| d.code).collect::<Vec<_>>()
    };
    assert!(codes("<width>2000000000</width>").contains(&"E0310"));
    let region = |x2: i32| {
        format!(
            "<width>64</width><render_region><x1>10</x1><y1>0</y1><x2>{x2}</x2><y2>9</y2></render_region>"
        )
    };
    assert_eq!(codes(&region(65)), ["E0310"]);
    assert_eq!(codes(&region(10)), ["E0310"]);
    assert_eq!(codes(&region(11)), Vec::<&str>::new());
}

#[test]
fn a_region_that_is_set_later_is_the_same_as_one_of_the_file() {
    let text = format!("{HEAD}{CAMERA}</scene>");
    let part = "<width>64</width><render_region><x1>3</x1><y1>1</y1><x2>20</x2><y2>9</y2></render_region>";
    let wanted = loaded(&text.replace("<width>64</width>", part)).scene.unwrap();
    let mut scene = loaded(&text).scene.unwrap();
    let whole = scene.identity.settings.clone();
    assert!(scene.set_region(Some([[3, 1], [65, 9]])).is_err());
    assert_eq!(scene.film.region, None, "what is wrong changes nothing");
    scene.set_region(Some([[3, 1], [20, 9]])).unwrap();
    assert_eq!(scene.film.region, wanted.film.region);
    assert_eq!(scene.picture.region, wanted.picture.region);
    assert_eq!(scene.identity.settings, wanted.identity.settings);
    scene.set_region(None).unwrap();
    assert_eq!((scene.film.region, &scene.identity.settings), (None, &whole));
}

#[test]
fn names_defined_twice_and_scenes_without_light_or_tone_mapping() {
    let white = "<material><name>white</name><null_material/></material>";
    expect_one(white, "white", "W0302");
    let bare = format!("{HEAD}{CAMERA}</scene>");
    let background = "<background><spectrum><uniform><value>1</value></uniform></spectrum></background>\n";
    let codes = |text: &str| loaded(text).sink.diagnostics().iter().map(|d| d.code).collect::<Vec<_>>();
    assert_eq!(codes(&bare.replace(background, "")), ["W0306"]);
    assert_eq!(
        codes(&bare.replace("<tonemapping><linear><scale>1</scale></linear></tonemapping>\n", "")),
        ["W0305"]
    );
}

#[test]
fn settings_come_from_the_highest_layer_that_gives_them() {
    let memory = Memory(format!("{HEAD}{CAMERA}</scene>").replace("<width>64</width>", ""));
    let overrides = [("-h", "height", "31"), ("-halt", "halt_time", "2.5")]
        .map(|(option, setting, value)| Override { option, setting, value: value.to_owned() });
    let options = LoadOptions { inifile: Some("inifile.xml"), overrides: &overrides, ..options(&memory) };
    let loaded = load("scene.igs", &options);
    let listing = loaded.settings.as_ref().unwrap().listing();
    let line =
        |name: &str| listing.iter().find(|l| l.name == name).map(|l| (l.value.as_str(), l.origin)).unwrap();
    assert_eq!(line("width"), ("40", Origin::IniFile));
    assert_eq!(line("height"), ("31", Origin::CommandLine));
    assert_eq!(line("max_depth"), ("7", Origin::IniFile));
    assert_eq!(line("metropolis"), ("false", Origin::Scene));
    assert_eq!(line("super_sample_factor"), ("2", Origin::Default));
    let scene = loaded.scene.expect("nothing is wrong with it");
    assert_eq!((scene.film.size.width(), scene.film.size.height()), (40, 31));
    assert_eq!(scene.transport.max_depth, 7);
    assert_eq!(scene.output.halt_time, Some(2.5));
}

#[test]
fn a_bad_command_line_value_has_a_place_too() {
    let memory = Memory(format!("{HEAD}{CAMERA}</scene>"));
    let overrides = [Override { option: "-halt", setting: "halt_time", value: "soon".to_owned() }];
    let loaded = load("scene.igs", &LoadOptions { overrides: &overrides, ..options(&memory) });
    let d = &loaded.sink.diagnostics()[0];
    assert_eq!((d.code, loaded.sources.name(d.span.unwrap().source)), ("E0202", "command line"));
    let excerpt = loaded.sources.excerpt(d.span.unwrap(), 80);
    assert_eq!((excerpt.text.as_str(), excerpt.marked), ("-halt soon ", 6..10));
    assert!(loaded.scene.is_none());
}

#[test]
fn the_filters_in_force_are_listed() {
    let value = |settings: &str, name: &str| {
        let memory = Memory(format!("{HEAD}{CAMERA}</scene>").replace("<width>64</width>", settings));
        let loaded = load("scene.igs", &options(&memory));
        let listing = loaded.settings.expect("settings").listing();
        listing.into_iter().find(|l| l.name == name).expect("a setting").value
    };
    assert_eq!(value("", "splat_filter"), "gaussian");
    assert_eq!(value("", "downsize_filter"), "mn_cubic blur=0.6 ring=0.2");
    let chosen = "<splat_filter><mn_cubic><blur>0.5</blur></mn_cubic></splat_filter><downsize_filter><box/></downsize_filter>";
    assert_eq!(value(chosen, "splat_filter"), "mn_cubic blur=0.5 ring=0.2");
    assert_eq!(value(chosen, "downsize_filter"), "box");
}

#[test]
fn the_filters_are_the_documented_ones_where_none_is_given() {
    let memory = Memory(format!("{HEAD}{CAMERA}</scene>"));
    let scene = load("scene.igs", &options(&memory)).scene.expect("nothing is wrong with it");
    assert_eq!(scene.picture.downsize, indigo_film::Filter::MN_DEFAULT);
    let gaussian = indigo_film::FilmFilter::new(indigo_film::Filter::Gaussian, scene.film.size).unwrap();
    let at = indigo_math::Vec2::new(9.3, 7.8);
    assert_eq!(scene.film.filter.footprint(at).rows, gaussian.footprint(at).rows);
}

#[test]
fn threads_have_a_ceiling() {
    let with = |threads: &str| {
        let settings = format!("<width>64</width><num_threads>{threads}</num_threads>");
        let memory = Memory(format!("{HEAD}{CAMERA}</scene>").replace("<width>64</width>", &settings));
        let loaded = load("scene.igs", &options(&memory));
        let places =
            loaded.sink.diagnostics().iter().map(|d| (d.code, loaded.sources.position(d.span.unwrap()).line));
        places.collect::<Vec<_>>()
    };
    assert_eq!(with("1024"), []);
    assert_eq!(with("1025"), [("E0203", 2)]);
    assert_eq!(with("0"), [("E0203", 2)]);
}

/// Filters are those that are listed, with all their numbers, on the film and on the picture.
#[test]
fn filters_reach_the_scene() {
    let cubic = |blur: f64, ring: f64| format!("<mn_cubic><blur>{blur}</blur><ring>{ring}</ring></mn_cubic>");
    let filters = format!(
        "<width>64</width><splat_filter>{}</splat_filter><downsize_filter>{}</downsize_filter>",
        cubic(0.5, 0.7),
        cubic(0.3, 0.1)
    );
    let text = format!("{HEAD}{CAMERA}</scene>").replace("<width>64</width>", &filters);
    let scene = loaded(&text).scene.expect("a scene without faults");
    assert_eq!(scene.film.splat, Filter::MitchellNetravali { blur: 0.5, ring: 0.7 });
    assert_eq!(scene.picture.downsize, Filter::MitchellNetravali { blur: 0.3, ring: 0.1 });
}

/// What is asked for of the picture and its files reaches the scene, and coverage is left to camera samples.
#[test]
fn settings_of_the_picture_reach_the_scene() {
    let with = |settings: &str| {
        let text = format!("{HEAD}{CAMERA}</scene>").replace(
            "<bidirectional>false</bidirectional>",
            &format!("<bidirectional>true</bidirectional>{settings}"),
        );
        loaded(&text).scene.expect("a scene without faults")
    };
    let plain = with("");
    let (output, picture) = (&plain.output, &plain.picture);
    assert!(!(output.igi || output.png.dithered || picture.watermark || picture.foreground_alpha));
    assert!(plain.transport.bidirectional);
    let more = with(
        "<save_igi>true</save_igi><dithering>true</dithering><png_bits>16</png_bits><watermark>true</watermark>",
    );
    assert!(more.output.igi && more.output.png.dithered && more.picture.watermark);
    assert_ne!(more.output.png.depth, plain.output.png.depth);
    assert_eq!(more.identity, plain.identity, "the film is the same");
    let alpha = with("<render_foreground_alpha>true</render_foreground_alpha>");
    assert!(alpha.picture.foreground_alpha);
    assert!(!alpha.transport.bidirectional && alpha.transport.metropolis.is_none());
}
