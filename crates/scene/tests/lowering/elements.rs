//! Elements that cannot be rendered as they are.

use super::common::*;
use indigo_camera::{Aperture, Blades};

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
fn texels_that_are_no_numbers_are_told_and_dark() {
    let material = "<material><name>t</name><diffuse><albedo_texture><path>no_numbers.exr</path><exponent>1</exponent></albedo_texture></diffuse></material>";
    let sphere = "<sphere><center>0 0 0</center><radius>1</radius><material_name>t</material_name></sphere>";
    let line = format!("{material}{sphere}");
    let loaded = loaded(&format!("{HEAD}{line}{CAMERA}</scene>"));
    let told: Vec<&str> = loaded.sink.diagnostics().iter().map(|d| d.message.as_str()).collect();
    assert!(told.len() == 1 && told[0].contains("2 of its values are infinite or no numbers"), "{told:?}");
    let scene = loaded.scene.expect("a scene");
    let texture = &scene.textures[0];
    assert_eq!(texture.rgb(indigo_math::Vec2::new(0.0, 0.0)), [0.0, 0.5, 0.0]);
}

/// What is found in a scene with an element that has placeholders for what is missing, and the scene.
fn with_placeholders(line: &str) -> (Vec<String>, Option<indigo_scene::Scene>) {
    let head = HEAD.replace("<renderer_settings>", "<renderer_settings><placeholders>true</placeholders>");
    let l = loaded(&format!("{head}{line}\n{CAMERA}</scene>"));
    let place = |d: &indigo_diag::Diagnostic| {
        let p = l.sources.position(d.span.expect("a place"));
        format!("{}:{}:{}", p.line, p.column, d.code)
    };
    (l.sink.diagnostics().iter().map(place).collect(), l.scene)
}

#[test]
fn something_stands_in_for_files_that_are_missing_if_that_is_asked_for() {
    let place = |line: &str, at: &str| format!("{LINE}:{}:W0326", line.find(at).expect("it is there") + 1);
    let line = "<material><name>t</name><diffuse><albedo_texture><uv_set>any</uv_set><path>none.png</path><exponent>1</exponent></albedo_texture></diffuse></material><sphere><center>0 0 0</center><radius>1</radius><material_name>t</material_name></sphere>";
    let (told, scene) = with_placeholders(line);
    assert_eq!(told, [place(line, "none.png")]);
    let texture = &scene.expect("a scene").textures[0];
    // Squares of an eighth: texels of each, and of the next one.
    let at =
        |x: f64, y: f64| texture.rgb(indigo_math::Vec2::new(x as indigo_math::Real, y as indigo_math::Real));
    assert_eq!([at(0.06, 0.94), at(0.19, 0.94)], [[1.0, 0.0, 1.0], [0.0; 3]]);

    // Whatever its scale and its materials, a metre wide; the lamp shines beside the background.
    let mesh = "<mesh><name>m</name><scale>0.001</scale><external><path>none.obj</path></external></mesh>";
    let placed = "<pos>0 0 0</pos><scale>1</scale><mesh_name>m</mesh_name>";
    let lit = "<material><name>lit</name><diffuse><base_emission><uniform><value>1</value></uniform></base_emission></diffuse></material>";
    let scale = "<emission_scale><material_name>lit</material_name><measure>luminance</measure><value>1</value></emission_scale>";
    let model = format!(
        "{mesh}{lit}<model>{placed}<materials><material_name>white</material_name></materials>{scale}</model>"
    );
    let lamp = format!(
        "{mesh}<meshlight>{placed}<spectrum><uniform><value>1</value></uniform></spectrum></meshlight>"
    );
    for (line, lights) in [(&model, 1), (&lamp, 2)] {
        let (told, scene) = with_placeholders(line);
        assert_eq!(told, [place(line, "none.obj")]);
        let scene = scene.expect("a scene");
        assert_eq!(scene.lights.len(), lights);
        let size = scene.accel.object_bounds(0).size();
        assert!(size.to_array().iter().all(|x| (x - 1.0).abs() < 1e-5), "{size:?}");
    }
    // No opening is a cube.
    let portal = format!("{mesh}<exit_portal>{placed}</exit_portal>");
    let (told, scene) = with_placeholders(&portal);
    assert_eq!(told, [place(&portal, "none.obj")]);
    assert!(scene.expect("a scene").lights.portals().is_none());
    // What is there but broken is a fault.
    let (told, _) = with_placeholders(
        &mesh.replace("none", "broken").replace("</mesh>", &format!("</mesh><model>{placed}</model>")),
    );
    assert!(told.iter().all(|code| code.ends_with("E0303")) && told.len() == 1, "{told:?}");
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
    let rest = "<white_balance>D50</white_balance><exposure_duration>1</exposure_duration></camera>";
    for camera in [&camera, &camera.replace("</camera>", rest)] {
        assert_eq!(found(camera), [format!("{LINE}:{column}:E0304")]);
    }
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

#[test]
fn a_white_point_counts_unless_a_white_is_named() {
    let point = |x: &str, y: &str| {
        format!(
            "<white_point><chromaticity_coordinates><x>{x}</x><y>{y}</y></chromaticity_coordinates></white_point>"
        )
    };
    let with = |more: &str| CAMERA.replace("</camera>", &format!("{more}</camera>"));
    let white = |more: &str| {
        let text = format!("{HEAD}{}</scene>", with(more));
        loaded(&text).scene.expect("a scene without faults").picture.white_balance.white_xy()
    };
    let named = "<white_balance>0.31 0.4</white_balance>";
    assert_eq!(white(&point("0.31", "0.4")), white(named));
    assert_ne!(white(&point("0.31", "0.4")), white(""));
    // The film is the same whatever is white in its picture.
    let identity = |more: &str| {
        loaded(&format!("{HEAD}{}</scene>", with(more))).scene.expect("a scene without faults").identity
    };
    assert_eq!(identity(&point("0.31", "0.4")), identity(&point("0.25", "0.3")));
    assert_eq!(identity(&point("0.31", "0.4")), identity(named));
    let twice = with(&(named.to_owned() + &point("0.25", "0.3")));
    let place = |camera: &str, at: &str, code: &str| {
        format!("{LINE}:{}:{code}", camera.find(at).expect("the text is in the camera") + 1)
    };
    assert_eq!(found(&twice), [place(&twice, "<white_point>", "W0324")]);
    assert_eq!(white(&(named.to_owned() + &point("0.25", "0.3"))), [0.31, 0.4]);
    let impossible = with(&point("0.7", "0.6"));
    assert_eq!(found(&impossible), [place(&impossible, "<chromaticity", "E0309")]);
    let negative = with(&point("-7", "0.3"));
    assert_eq!(found(&negative), [place(&negative, "-7", "E0203")]);
}

#[test]
fn what_only_a_lens_makes_use_of_is_told_of_cameras_without_one() {
    let with = |more: &str| CAMERA.replace("</camera>", &format!("{more}</camera>"));
    let place = |camera: &str, at: &str, code: &str| {
        format!("{LINE}:{}:{code}", camera.find(at).expect("the text is in the camera") + 1)
    };
    let kind = |name: &str| format!("<camera_type>{name}</camera_type>");
    let shifted = "<lens_shift_up_distance>0.01</lens_shift_up_distance><autofocus/>";
    assert_eq!(found(&with(&kind("orthographic"))), Vec::<String>::new());
    assert_eq!(found(&with(&(kind("orthographic") + shifted))), Vec::<String>::new());
    let obstacles = with(&(kind("orthographic") + "<obstacle_map>broken.png</obstacle_map>"));
    assert!(found(&obstacles).contains(&place(&obstacles, "broken.png", "W0325")));
    let sphere = with(&(kind("Spherical") + shifted));
    let told = found(&sphere);
    for (at, code) in [("Spherical", "W0304"), ("0.01<", "W0325")] {
        assert!(told.contains(&place(&sphere, at, code)), "{told:?}");
    }
    assert_eq!(told.len(), 2, "{told:?}");
    let wrong = with(&kind("fisheye"));
    assert_eq!(found(&wrong), [place(&wrong, "fisheye", "E0202")]);
}

/// Where and with which code a camera with an aperture shape is refused.
fn expect_aperture(shape: &str, at: &str, code: &str) {
    let camera = CAMERA.replace("</camera>", &format!("<aperture_shape>{shape}</aperture_shape></camera>"));
    let column = camera.find(at).expect("the text is in the camera") + 1;
    assert_eq!(found(&camera), [format!("{LINE}:{column}:{code}")], "{shape}");
}

/// An exporter may write a path that names nothing: that is none where none is needed, and one error where one is.
#[test]
fn empty_paths() {
    let with = |more: &str| CAMERA.replace("</camera>", &format!("{more}</camera>"));
    assert_eq!(found(&with("<obstacle_map></obstacle_map>")), [""; 0]);
    let image = with("<aperture_shape><image><path></path></image></aperture_shape>");
    let found = found(&image);
    assert!(found.len() == 1 && found[0].ends_with(":E0202"), "{found:?}");
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

/// Each number of the blades shapes the opening.
#[test]
fn blades_reach_the_camera() {
    let shape = "<aperture_shape><generated><num_blades>5</num_blades><start_angle>0.4</start_angle><blade_offset>0.35</blade_offset><blade_curvature_radius>0.8</blade_curvature_radius></generated></aperture_shape></camera>";
    let text = format!("{HEAD}{}</scene>", CAMERA.replace("</camera>", shape));
    let scene = loaded(&text).scene.expect("a scene without faults");
    let expected =
        Aperture::generated(&Blades::new(5, 0.4, 0.35, 0.8).expect("blades that leave an opening"));
    assert_eq!(scene.camera.aperture().draw(64), expected.draw(64));
}

#[test]
fn a_table_in_nanometres_is_suspect() {
    let table = |start: &str, end: &str| {
        format!(
            "<rectanglelight><pos>0 0 3</pos><width>1</width><height>1</height><spectrum><regular_tabulated>\
             <start_wavelength>{start}</start_wavelength>\
             <end_wavelength>{end}</end_wavelength><num_values>2</num_values><values>1 1</values>\
             </regular_tabulated></spectrum></rectanglelight>{CAMERA}"
        )
    };
    assert_eq!(found(&table("4e-7", "7e-7")), Vec::<String>::new());
    let column = table("400", "700").find("400").unwrap() + 1;
    assert_eq!(found(&table("400", "700")), [format!("{LINE}:{column}:W0108")]);
}

#[test]
fn bloom_is_deprecated() {
    let camera =
        CAMERA.replace("</camera>", "<bloom><weight>0.1</weight><radius>0.1</radius></bloom></camera>");
    let column = camera.find("<bloom>").unwrap() + 1;
    assert_eq!(found(&camera), [format!("{LINE}:{column}:W0104")]);
}

/// What stands before the lens matters to diffraction alone, but a file that is wrong is wrong all the same.
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
    for diffraction in [false, true] {
        assert_eq!(with("nowhere.png", diffraction), ["E0302"]);
        assert_eq!(with("broken.png", diffraction), ["E0303"]);
        assert_eq!(with("tiny.png", diffraction), ["E0303"], "all black");
        assert_eq!(with("grey.png", diffraction), ["W0303"], "the same all over");
        assert_eq!(with("dusty.png", diffraction), [""; 0]);
    }
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
