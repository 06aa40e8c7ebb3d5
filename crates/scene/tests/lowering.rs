//! What lowering says about scenes that bind well but cannot be rendered as they are: each code with its
//! place, and settings with the layer that they come from.

use indigo_decl::{ResolveError, Resolved, Resolver};
use indigo_geom::NoStore;
use indigo_igs::Limits;
use indigo_imaging::png::Depth;
use indigo_scene::{LoadOptions, Loaded, Origin, Override, load};

/// A scene, and beside it a broken mesh, a broken picture and settings.
struct Memory(String);

impl Resolver for Memory {
    fn read(&self, path: &str, _from: &str) -> Result<Resolved, ResolveError> {
        let bytes: &[u8] = match path {
            "scene.igs" => self.0.as_bytes(),
            "broken.obj" => b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n",
            "flat.obj" => b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 1 1\n",
            "broken.png" => b"not a picture",
            "tiny.png" => return Ok(picture(path, [4, 4])),
            "oblong.png" => return Ok(picture(path, [1024, 512])),
            "odd.png" => return Ok(picture(path, [600, 600])),
            "black.png" => return Ok(picture(path, [512, 512])),
            "inifile.xml" => {
                b"<settings><width>40</width><height>30</height><max_depth>7</max_depth></settings>"
            }
            _ => return Err(ResolveError::NotFound { looked: vec![path.to_owned()] }),
        };
        Ok(Resolved { path: path.to_owned(), bytes: bytes.into() })
    }
}

/// A black PNG.
fn picture(path: &str, [width, height]: [u32; 2]) -> Resolved {
    let pixels = vec![[0.0; 4]; (width * height) as usize];
    let picture = indigo_imaging::Picture { width, height, pixels };
    let bytes = indigo_imaging::png::encode(&picture, &indigo_imaging::Metadata::default(), Depth::Eight);
    Resolved { path: path.to_owned(), bytes: bytes.expect("a picture with pixels").into() }
}

/// The first lines of every scene here: complete, and without a complaint.
const HEAD: &str = "<scene>
<renderer_settings><width>64</width><height>48</height><bidirectional>false</bidirectional><metropolis>false</metropolis><aperture_diffraction>false</aperture_diffraction></renderer_settings>
<tonemapping><linear><scale>1</scale></linear></tonemapping>
<background><spectrum><uniform><value>1</value></uniform></spectrum></background>
<material><name>white</name><diffuse><albedo_spectrum><uniform><value>0.5</value></uniform></albedo_spectrum></diffuse></material>
";
const CAMERA: &str = "<camera><pos>0 -2 1</pos><up>0 0 1</up><forwards>0 1 0</forwards><aperture_radius>0.001</aperture_radius><focus_distance>3</focus_distance><aspect_ratio>1.3333</aspect_ratio><sensor_width>0.036</sensor_width><lens_sensor_dist>0.02</lens_sensor_dist></camera>\n";
const MESH: &str = "<mesh><name>tri</name><embedded><vertex pos=\"0 0 0\"/><vertex pos=\"1 0 0\"/><vertex pos=\"0 1 0\"/><triangle_set><material_name>white</material_name><tri>0 1 2</tri></triangle_set></embedded></mesh>\n";
/// The line after `HEAD`.
const LINE: usize = 6;

fn options(resolver: &Memory) -> LoadOptions<'_> {
    LoadOptions {
        resolver,
        trees: &NoStore,
        inifile: None,
        overrides: &[],
        limits: Limits::default(),
        check_only: false,
    }
}

fn loaded(text: &str) -> Loaded {
    let memory = Memory(text.to_owned());
    load("scene.igs", &options(&memory))
}

/// Codes with line and column of everything found in `HEAD` + `rest`.
fn found(rest: &str) -> Vec<String> {
    let l = loaded(&format!("{HEAD}{rest}</scene>"));
    l.sink
        .diagnostics()
        .iter()
        .map(|d| {
            let place = d.span.map(|s| l.sources.position(s));
            place.map_or_else(|| d.code.to_owned(), |p| format!("{}:{}:{}", p.line, p.column, d.code))
        })
        .collect()
}

/// Expects exactly one finding in a line after the head, at the text `at`, with a code.
fn expect_one(line: &str, at: &str, code: &str) {
    let column = line.find(at).expect("the text is in the line") + 1;
    assert_eq!(found(&format!("{line}\n{CAMERA}{MESH}")), [format!("{LINE}:{column}:{code}")], "{line}");
}

#[test]
fn the_head_is_without_a_complaint() {
    assert_eq!(found(CAMERA), Vec::<String>::new());
}

#[test]
fn names_and_files_that_are_not_there() {
    expect_one(
        "<sphere><center>0 0 0</center><radius>1</radius><material_name>whiet</material_name></sphere>",
        "whiet",
        "E0301",
    );
    expect_one("<model><pos>0 0 0</pos><scale>1</scale><mesh_name>trii</mesh_name></model>", "trii", "E0301");
    let model = "<model><pos>0 0 0</pos><scale>1</scale><mesh_name>m</mesh_name></model>";
    let mesh =
        |path: &str| format!("<mesh><name>m</name><external><path>{path}</path></external></mesh>{model}");
    expect_one(&mesh("nowhere.obj"), "nowhere.obj", "E0302");
    expect_one(&mesh("broken.obj"), "broken.obj", "E0303");
}

#[test]
fn a_mesh_file_says_which_of_its_triangles_were_dropped_and_which_material_is_missing() {
    let line = "<mesh><name>m</name><external><path>flat.obj</path></external></mesh><model><pos>0 0 0</pos><scale>1</scale><mesh_name>m</mesh_name></model>";
    let column = line.find("flat.obj").unwrap() + 1;
    let codes = found(&format!("{line}\n{CAMERA}"));
    // No usemtl (a note), a triangle without area (a note), and no material named default.
    let expected = ["W0303", "W0303", "E0301"].map(|c| format!("{LINE}:{column}:{c}"));
    assert_eq!(codes, expected);
}

#[test]
fn textures_need_their_picture_and_their_coordinates() {
    let material = |path: &str, set: &str| {
        format!(
            "<material><name>t</name><diffuse><albedo_texture><uv_set>{set}</uv_set><path>{path}</path></albedo_texture></diffuse></material>"
        )
    };
    let sphere = "<sphere><center>0 0 0</center><radius>1</radius><material_name>t</material_name></sphere>";
    expect_one(&format!("{}{sphere}", material("broken.png", "any")), "broken.png", "E0303");
    expect_one(&format!("{}{sphere}", material("none.png", "any")), "none.png", "E0302");
    // On a mesh without uv sets the name is an error, too.
    let mesh = MESH.replace("white", "t").replace("tri<", "mt<");
    let model = "<model><pos>0 0 0</pos><scale>1</scale><mesh_name>mt</mesh_name></model>";
    let line = format!("{}{}{model}", material("broken.png", "albedo"), mesh.trim());
    let codes = found(&format!("{line}\n{CAMERA}"));
    let column = line.find("albedo</uv_set>").unwrap() + 1;
    assert!(codes.contains(&format!("{LINE}:{column}:E0307")), "{codes:?}");
}

#[test]
fn a_texture_that_nothing_uses_is_not_even_looked_for() {
    let line = "<material><name>t</name><diffuse><albedo_texture><path>none.png</path></albedo_texture></diffuse></material>";
    assert_eq!(found(&format!("{line}{CAMERA}")), Vec::<String>::new());
}

#[test]
fn numbers_that_make_no_space() {
    let singular = "<model><pos>0 0 0</pos><scale>1</scale><rotation><matrix>1 2 3 2 4 6 0 0 1</matrix></rotation><mesh_name>tri</mesh_name></model>";
    expect_one(singular, "1 2 3", "E0304");
    expect_one(
        "<plane><normal>0 0 0</normal><dist>0</dist><material_name>white</material_name></plane>",
        "0 0 0",
        "E0304",
    );
    expect_one(
        "<plane><normal>0 0 2</normal><dist>0</dist><material_name>white</material_name></plane>",
        "0 0 2",
        "W0307",
    );
    let camera = CAMERA.replace("<up>0 0 1", "<up>0 3 0");
    let column = camera.find("0 3 0").unwrap() + 1;
    assert_eq!(found(&camera), [format!("{LINE}:{column}:E0304")]);
}

#[test]
fn cameras() {
    assert_eq!(found(""), ["1:1:E0305"]);
    let stretched = CAMERA.replace("1.3333", "1.5");
    let column = stretched.find("1.5").unwrap() + 1;
    assert_eq!(found(&stretched), [format!("{LINE}:{column}:W0304")]);
    let white = CAMERA.replace("</camera>", "<white_balance>D66</white_balance></camera>");
    let column = white.find("D66").unwrap() + 1;
    assert_eq!(found(&white), [format!("{LINE}:{column}:E0309")]);
}

/// Where and with which code a camera with an aperture shape is refused.
fn expect_aperture(shape: &str, at: &str, code: &str) {
    let camera = CAMERA.replace("</camera>", &format!("<aperture_shape>{shape}</aperture_shape></camera>"));
    let column = camera.find(at).expect("the text is in the camera") + 1;
    assert_eq!(found(&camera), [format!("{LINE}:{column}:{code}")], "{shape}");
}

#[test]
fn apertures() {
    let image = |path: &str| format!("<image><path>{path}</path></image>");
    expect_aperture(&image("nowhere.png"), "nowhere.png", "E0302");
    for path in ["broken.png", "broken.obj", "tiny.png", "oblong.png", "odd.png", "black.png"] {
        expect_aperture(&image(path), path, "E0303");
    }
    let blades = |count: &str, offset: &str, radius: &str| {
        format!(
            "<generated><num_blades>{count}</num_blades><start_angle>0</start_angle><blade_offset>{offset}</blade_offset><blade_curvature_radius>{radius}</blade_curvature_radius></generated>"
        )
    };
    expect_aperture(&blades("2", "0.3", "1"), "2</num_blades>", "E0203");
    expect_aperture(&blades("10001", "0.3", "1"), "10001", "E0203");
    expect_aperture(&blades("5", "0.3", "0.14"), "0.14", "E0203");
    let good = CAMERA.replace(
        "</camera>",
        &format!("<aperture_shape>{}</aperture_shape></camera>", blades("5", "0.3", "1")),
    );
    assert_eq!(found(&good), Vec::<String>::new());
}

#[test]
fn bloom_is_deprecated() {
    let camera =
        CAMERA.replace("</camera>", "<bloom><weight>0.1</weight><radius>0.1</radius></bloom></camera>");
    let column = camera.find("<bloom>").unwrap() + 1;
    assert_eq!(found(&camera), [format!("{LINE}:{column}:W0104")]);
}

/// What stands before the lens matters to diffraction alone.
#[test]
fn obstacles() {
    let with = |path: &str, diffraction: bool| {
        let camera = CAMERA.replace("</camera>", &format!("<obstacle_map>{path}</obstacle_map></camera>"));
        let column = camera.find(path).expect("the path") + 1;
        let on = format!("<aperture_diffraction>{diffraction}</aperture_diffraction>");
        let head = HEAD.replace("<aperture_diffraction>false</aperture_diffraction>", &on);
        let l = loaded(&format!("{head}{camera}</scene>"));
        let place = |d: &indigo_diag::Diagnostic| d.span.map(|s| l.sources.position(s));
        let places: Vec<_> = l.sink.diagnostics().iter().map(|d| (d.code, place(d))).collect();
        assert!(places.iter().all(|(_, p)| p.is_some_and(|p| (p.line, p.column) == (LINE, column))));
        places.into_iter().map(|(code, _)| code).collect::<Vec<_>>()
    };
    assert_eq!(with("nowhere.png", false), Vec::<&str>::new());
    assert_eq!(with("nowhere.png", true), ["E0302"]);
    assert_eq!(with("broken.png", true), ["E0303"]);
    assert_eq!(with("tiny.png", true), ["E0303"], "all black");
}

#[test]
fn lamps() {
    let lamp = |spectrum: &str| {
        format!(
            "<rectanglelight><pos>0 0 2</pos><width>1</width><height>1</height><spectrum>{spectrum}</spectrum><efficacy_scale><power_drawn>1</power_drawn><overall_luminous_efficacy>1</overall_luminous_efficacy></efficacy_scale></rectanglelight>"
        )
    };
    expect_one(&lamp("<uniform><value>0</value></uniform>"), "<efficacy_scale>", "E0308");
    expect_one(&lamp("<uniform><value>-2</value></uniform>"), "-2", "E0203");
    let table = "<regular_tabulated><start_wavelength>4e-7</start_wavelength><end_wavelength>7e-7</end_wavelength><num_values>3</num_values><values>1 2</values></regular_tabulated>";
    expect_one(&lamp(table), "1 2<", "E0203");
}

/// A sphere of a material.
fn sphere_of(material: &str) -> String {
    format!(
        "<sphere><center>0 0 0</center><radius>1</radius><material_name>{material}</material_name></sphere>"
    )
}

fn material(name: &str, kind: &str) -> String {
    format!("<material><name>{name}</name>{kind}</material>")
}

fn blend(a: &str, b: &str) -> String {
    format!("<blend><blend_factor>0.5</blend_factor><a_name>{a}</a_name><b_name>{b}</b_name></blend>")
}

#[test]
fn blends_of_what_cannot_be_blended() {
    let null = material("none", "<null_material/>");
    let glass = |name: &str, medium: &str| {
        material(name, &format!("<specular><internal_medium_name>{medium}</internal_medium_name></specular>"))
    };
    let frosted = |name: &str, medium: &str| {
        let kind = format!(
            "<glossy_transparent><internal_medium_name>{medium}</internal_medium_name><exponent>9</exponent></glossy_transparent>"
        );
        material(name, &kind)
    };
    let media = ["ice", "oil"]
        .map(|m| format!("<medium><name>{m}</name><basic><ior>1.3</ior></basic></medium>"))
        .concat();
    let line = |parts: &[String]| parts.concat();
    // Of itself, at once and by another.
    let own = line(&[material("m", &blend("white", "m")), sphere_of("m")]);
    expect_one(&own, "m</b_name>", "E0312");
    let round =
        line(&[material("m", &blend("n", "white")), material("n", &blend("white", "m")), sphere_of("m")]);
    expect_one(&round, "m</b_name>", "E0312");
    // Two of delta kind, at any depth.
    let two = line(&[
        null.clone(),
        glass("g", "ice"),
        media.clone(),
        material("m", &blend("g", "none")),
        sphere_of("m"),
    ]);
    let deep = line(&[
        null.clone(),
        material("h", &blend("none", "white")),
        material("m", &blend("h", "none")),
        sphere_of("m"),
    ]);
    expect_one(
        &two.replace("<medium><name>oil</name><basic><ior>1.3</ior></basic></medium>", ""),
        "none</b_name>",
        "E0207",
    );
    expect_one(&deep, "none</b_name></blend></material><sphere>", "E0207");
    // Different media inside.
    let media_of = line(&[
        frosted("f", "ice"),
        frosted("h", "oil"),
        media,
        material("m", &blend("f", "h")),
        sphere_of("m"),
    ]);
    expect_one(&media_of, "h</b_name>", "E0207");
    // A name that is not there.
    let unknown = line(&[material("m", &blend("white", "nobody")), sphere_of("m")]);
    expect_one(&unknown, "nobody", "E0301");
    // One of delta kind is fine, and so is what many of them share.
    let fine = line(&[
        null,
        material("h", &blend("none", "white")),
        material("m", &blend("h", "white")),
        sphere_of("m"),
    ]);
    assert_eq!(found(&format!("{fine}\n{CAMERA}{MESH}")), Vec::<String>::new());
}

#[test]
fn a_chain_of_blends_may_be_long_but_not_without_end() {
    let chain = |n: usize| {
        let link = |i: usize| material(&format!("m{i}"), &blend("white", &format!("m{}", i + 1)));
        (0..n).map(link).collect::<String>()
            + &material(&format!("m{n}"), "<null_material/>")
            + &sphere_of("m0")
    };
    assert_eq!(found(&format!("{}\n{CAMERA}", chain(150))), Vec::<String>::new());
    let codes = found(&format!("{}\n{CAMERA}", chain(5000)));
    assert!(codes.len() == 1 && codes[0].ends_with("E0312"), "{codes:?}");
}

#[test]
fn metals_need_their_file() {
    let metal = |path: &str, more: &str| {
        let kind = format!("<phong><nk_data>{path}</nk_data><exponent>9</exponent>{more}</phong>");
        material("p", &kind) + &sphere_of("p")
    };
    expect_one(&metal("nowhere.nk", ""), "nowhere.nk", "E0302");
    expect_one(&metal("broken.obj", ""), "broken.obj", "E0303");
    // An empty path is none, so the coat needs its index.
    expect_one(&metal("", ""), "<phong>", "E0201");
    assert_eq!(found(&format!("{}\n{CAMERA}", metal("", "<ior>1.5</ior>"))), Vec::<String>::new());
}

#[test]
fn whatever_is_not_rendered_yet_is_named_where_it_stands() {
    let saved = "<renderer_settings><save_igi>true</save_igi></renderer_settings>";
    expect_one(saved, "true</save_igi>", "E0205");
}

#[test]
fn a_plane_is_refused_where_light_is_traced_from_both_ends() {
    let bidirectional = "<bidirectional>false</bidirectional>";
    let plane =
        "<plane><normal>0 0 1</normal><dist>0</dist><material_name>white</material_name></plane></scene>";
    // Also where it is on by default.
    for on in ["<bidirectional>true</bidirectional>", ""] {
        let l = loaded(&format!("{HEAD}{CAMERA}{plane}").replace(bidirectional, on));
        assert!(
            l.sink
                .diagnostics()
                .iter()
                .any(|d| d.code == "E0311" && d.hint.as_ref().is_some_and(|h| h.contains("mesh")))
        );
    }
}

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
    assert_eq!(loaded.sources.line(d.span.unwrap()), ("-halt soon ".to_owned(), 6..10));
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

/// 20,000 unknown names among 20,000 known ones: compared one with the other, they would take minutes.
#[test]
fn unknown_names_cost_time_in_proportion_to_their_number() {
    use std::fmt::Write as _;
    let mut text = String::from(HEAD);
    for i in 0..20_000 {
        let sphere = format!(
            "<sphere><center>0 {i} 0</center><radius>0.1</radius><material_name>materiel {i}</material_name></sphere>"
        );
        let _ = write!(text, "<material><name>material_{i}</name><null_material/></material>{sphere}");
    }
    let started = std::time::Instant::now();
    let loaded = loaded(&format!("{text}{CAMERA}</scene>"));
    assert_eq!(loaded.sink.error_count(), 20_000);
    let hints = loaded.sink.diagnostics().iter().filter(|d| d.hint.is_some()).count();
    assert_eq!(hints, 20);
    assert_eq!(loaded.sink.diagnostics()[3].hint.as_deref(), Some("did you mean material_3?"));
    // A second where nothing else runs; the test machine may be busy.
    assert!(started.elapsed() < std::time::Duration::from_secs(20), "{:?}", started.elapsed());
}

#[test]
fn names_are_checked_where_nothing_uses_them() {
    let medium = "<specular><internal_medium_name>vlass</internal_medium_name></specular>";
    let blend = "<blend><blend_factor>0.5</blend_factor><a_name>white</a_name><b_name>whita</b_name></blend>";
    for (kind, name) in [(medium, "vlass"), (blend, "whita")] {
        expect_one(&format!("<material><name>t</name>{kind}</material>"), name, "E0301");
    }
    let air =
        "<medium><name>air</name><basic><ior>1</ior><cauchy_b_coeff>0</cauchy_b_coeff></basic></medium>";
    let line = format!("{air}{air}");
    let column = line.rfind("air<").unwrap() + 1;
    assert_eq!(found(&format!("{line}{CAMERA}")), [format!("{LINE}:{column}:W0302")]);
}

const SPHERE: &str =
    "<sphere><center>0 0 0</center><radius>1</radius><material_name>white</material_name></sphere>";

#[test]
fn what_is_too_large_to_be_computed_with_is_told_with_its_place() {
    let sphere = |from: &str, to: &str| SPHERE.replace(from, to);
    for (line, at, code) in [
        (sphere("<radius>1", "<radius>1e39"), "1e39", "E0203"),
        (sphere("<radius>1", "<radius>1e13"), "<sphere>", "E0306"),
        (sphere("<center>0", "<center>1e37"), "<sphere>", "E0306"),
        (
            "<model><pos>0 0 0</pos><scale>1e20</scale><mesh_name>tri</mesh_name></model>".to_owned(),
            "<model>",
            "E0306",
        ),
        (
            "<plane><normal>0 0 1</normal><dist>-1e30</dist><material_name>white</material_name></plane>"
                .to_owned(),
            "<plane>",
            "E0306",
        ),
        (
            "<skylight><sundir>0 0 -1</sundir><turbidity>2</turbidity></skylight>".to_owned(),
            "0 0 -1",
            "E0203",
        ),
    ] {
        expect_one(&line, at, code);
    }
    let lamp = |spectrum: &str, more: &str| {
        format!(
            "<rectanglelight><pos>0 0 9</pos><width>1</width><height>1</height><spectrum>{spectrum}</spectrum>{more}</rectanglelight>"
        )
    };
    for (spectrum, at) in [
        ("<uniform><value>1e300</value></uniform>", "1e300"),
        ("<uniform><value>1e38</value></uniform>", "<uniform>"),
        ("<blackbody><temperature>1e9</temperature><gain>1e30</gain></blackbody>", "<blackbody>"),
        ("<rgb><rgb>1e38 0 1</rgb></rgb>", "<rgb>"),
        (
            "<peak><peak_min>-5</peak_min><peak_width>900</peak_width><base_value>0</base_value><peak_value>1</peak_value></peak>",
            "-5",
        ),
        ("<uniform><value>-1</value></uniform>", "-1"),
    ] {
        expect_one(&lamp(spectrum, ""), at, "E0203");
    }
    let power = "<efficacy_scale><power_drawn>1e35</power_drawn><overall_luminous_efficacy>20</overall_luminous_efficacy></efficacy_scale>";
    expect_one(&lamp("<uniform><value>1</value></uniform>", power), "<efficacy_scale>", "E0203");
    // The camera's own place is told once, not with everything that is far from it.
    let far = CAMERA.replace("<pos>0 -2 1", "<pos>0 1e20 1");
    let column = far.find("0 1e20").unwrap() + 1;
    assert_eq!(found(&format!("{far}{SPHERE}")), [format!("{LINE}:{column}:E0203")]);
}

#[test]
fn reflectances_and_coefficients_are_not_negative() {
    let sphere = SPHERE.replace("white", "t");
    for spectrum in ["<rgb><rgb>0.5 -0.1 0.5</rgb></rgb>", "<uniform><value>-0.5</value></uniform>"] {
        let at = if spectrum.contains("rgb") { "0.5 -0.1" } else { "-0.5" };
        let material = format!(
            "<material><name>t</name><diffuse><albedo_spectrum>{spectrum}</albedo_spectrum></diffuse></material>{sphere}"
        );
        expect_one(&material, at, "E0203");
        let glass = format!(
            "<material><name>t</name><specular><internal_medium_name>g</internal_medium_name></specular></material>{sphere}<medium><name>g</name><basic><ior>1.5</ior><cauchy_b_coeff>0</cauchy_b_coeff><absorption_coefficient_spectrum>{spectrum}</absorption_coefficient_spectrum></basic></medium>"
        );
        expect_one(&glass, at, "E0203");
    }
    // Above 1 it is clamped without a word, as the manual says.
    let white = "<material><name>t</name><diffuse><albedo_spectrum><rgb><rgb>2 1 0</rgb></rgb></albedo_spectrum></diffuse></material>";
    assert_eq!(found(&format!("{white}{sphere}{CAMERA}")), Vec::<String>::new());
}

/// One fault is one message.
#[test]
fn faults_have_no_false_followers() {
    let with = |settings: &str| {
        let text = format!("{HEAD}{CAMERA}</scene>").replace("<width>64</width>", settings);
        loaded(&text).sink.diagnostics().iter().map(|d| d.code).collect::<Vec<_>>()
    };
    assert_eq!(with("<width>wide</width>"), ["E0202"]);
    assert_eq!(with("<width>-800</width>"), ["E0203"]);
    let dark = |light: &str| {
        let head = HEAD.replace(
            "<background><spectrum><uniform><value>1</value></uniform></spectrum></background>",
            light,
        );
        loaded(&format!("{head}{CAMERA}</scene>"))
            .sink
            .diagnostics()
            .iter()
            .map(|d| d.code)
            .collect::<Vec<_>>()
    };
    assert_eq!(dark(""), ["W0306"]);
    assert_eq!(
        dark("<background><spectrum><uniform><value>dim</value></uniform></spectrum></background>"),
        ["E0202"]
    );
    let bad = MESH.replace("1 0 0", "nan 0 0");
    let model = "<model><pos>0 0 0</pos><scale>1</scale><mesh_name>tri</mesh_name></model>";
    let codes = found(&format!("{bad}{model}{CAMERA}"));
    assert!(codes.len() == 1 && codes[0].ends_with("E0101"), "{codes:?}");
}

#[test]
fn directions_are_reported_where_they_are_wrong() {
    for (from, to, at) in [
        ("<forwards>0 1 0", "<forwards>0 0 0", "0 0 0</forwards>"),
        ("<up>0 0 1", "<up>0 0 0", "0 0 0</up>"),
        ("<up>0 0 1", "<up>0 3 0", "0 3 0</up>"),
    ] {
        let camera = CAMERA.replace(from, to);
        let column = camera.find(at).unwrap() + 1;
        assert_eq!(found(&camera), [format!("{LINE}:{column}:E0304")]);
    }
}

#[test]
fn a_mesh_without_triangles_is_told_of() {
    for inside in ["", "<vertex pos=\"0 0 0\"/>"] {
        let line = format!(
            "<mesh><name>m</name><embedded>{inside}</embedded></mesh><model><pos>0 0 0</pos><scale>1</scale><mesh_name>m</mesh_name></model>"
        );
        assert_eq!(found(&format!("{line}{CAMERA}")), [format!("{LINE}:1:W0303")], "{inside}");
    }
    // Outside a set a triangle has no material.
    let line = "<mesh><name>m</name><embedded><vertex pos=\"0 0 0\"/><tri>0 0 0</tri></embedded></mesh><model><pos>0 0 0</pos><scale>1</scale><mesh_name>m</mesh_name></model>";
    let column = line.find("<tri>").unwrap() + 1;
    assert_eq!(
        found(&format!("{line}{CAMERA}")),
        [format!("{LINE}:{column}:W0101"), format!("{LINE}:1:W0303")]
    );
}

#[test]
fn any_nudge_distance_is_taken() {
    for (text, value) in [("0", 0.0), ("1e-4", 1e-4), ("0.5", 0.5)] {
        let settings =
            format!("<width>64</width><ray_origin_nudge_distance>{text}</ray_origin_nudge_distance>");
        let loaded = loaded(&format!("{HEAD}{CAMERA}</scene>").replace("<width>64</width>", &settings));
        assert!(loaded.sink.diagnostics().is_empty(), "{text}");
        assert_eq!(f64::from(loaded.scene.expect("a scene").nudge_m as f32), f64::from(value as f32));
    }
}

/// The examples of the manual's list of errors have the fault that they show.
#[test]
fn every_code_has_an_example() {
    let whole = format!("{HEAD}{CAMERA}{MESH}");
    for code in indigo_scene::codes::ALL {
        assert!(!code.example.is_empty(), "{}", code.code);
        if !code.example.starts_with('(') {
            let loaded = loaded(&format!("{whole}{}</scene>", code.example));
            let found: Vec<&str> = loaded.sink.diagnostics().iter().map(|d| d.code).collect();
            assert!(found.contains(&code.code), "{}: {found:?}", code.code);
        }
    }
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
