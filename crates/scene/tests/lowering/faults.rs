//! Faults told once, with their place, and at a cost in proportion.

use super::common::*;

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
    assert_eq!(found(&format!("{air}{air}{CAMERA}")), [""; 0]);
    let line = format!("{air}{}", air.replace("<ior>1<", "<ior>1.0003<"));
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

#[test]
fn colours_are_not_negative() {
    let sphere = SPHERE.replace("white", "t");
    for kind in ["diffuse", "diffuse_transmitter"] {
        let with = |colour: &str| {
            format!(
                "<material><name>t</name><{kind}><colour>{colour}</colour></{kind}></material>{sphere}{CAMERA}"
            )
        };
        let [bad, sound] = ["0.5 -1 0.5", "0.5 0 0.5"].map(|colour| found(&with(colour)));
        assert_eq!(bad.iter().filter(|f| f.ends_with("E0203")).count(), 1, "{bad:?}");
        assert!(sound.iter().all(|f| f.ends_with("W0104")), "{sound:?}");
    }
}

#[test]
fn exponents_of_a_map_are_above_0() {
    let sphere = SPHERE.replace("white", "t");
    for (path, b, code) in [("dusty", 100, "W0322"), ("tiny", 100, "E0203"), ("grey", -100, "E0203")] {
        let map =
            format!("<exponent_map><path>{path}.png</path><exponent>1</exponent><b>{b}</b></exponent_map>");
        let material =
            format!("<material><name>t</name><phong><ior>1.5</ior>{map}</phong></material>{sphere}");
        expect_one(&material, "<exponent_map>", code);
    }
    let map = "<exponent_map><path>grey.png</path><exponent>1</exponent><b>100</b></exponent_map>";
    let material = format!("<material><name>t</name><phong><ior>1.5</ior>{map}</phong></material>{sphere}");
    assert_eq!(found(&format!("{material}{CAMERA}")), Vec::<String>::new());
}

#[test]
fn media_too_dense_for_their_size_are_told() {
    let warned = |side: f64, density: f64, phase: &str| {
        let scattering = format!(
            "<subsurface_scattering><scattering_coefficient_spectrum><uniform><value>{density}</value></uniform></scattering_coefficient_spectrum><phase_function>{phase}</phase_function></subsurface_scattering>"
        );
        let medium = format!(
            "<medium><name>g</name><precedence>10</precedence><basic><ior>1.5</ior><cauchy_b_coeff>0</cauchy_b_coeff>{scattering}</basic></medium>"
        );
        let glass = "<material><name>white</name><specular><transparent>true</transparent><internal_medium_name>g</internal_medium_name></specular></material>";
        let head = HEAD.replace("<material><name>white</name><diffuse><albedo_spectrum><uniform><value>0.5</value></uniform></albedo_spectrum></diffuse></material>", glass);
        let model = format!("<model><pos>0 0 0</pos><scale>{side}</scale><mesh_name>tri</mesh_name></model>");
        let loaded = loaded(&format!("{head}{medium}{CAMERA}{MESH}{model}</scene>"));
        let codes: Vec<&str> = loaded.sink.diagnostics().iter().map(|d| d.code).collect();
        // A triangle is not closed, either.
        assert!(codes.iter().all(|code| ["W0323", "W0329"].contains(code)), "{codes:?}");
        codes.contains(&"W0323")
    };
    // Rays keep 36 roundings of a triangle's side off it, 2 micrometres of a metre.
    assert!(warned(1.0, 1e5, "<uniform/>"));
    assert!(!warned(1.0, 1e3, "<uniform/>"));
    assert!(!warned(0.01, 1e5, "<uniform/>"));
    // What is scattered ahead goes on.
    let ahead = "<henyey_greenstein><g_spectrum><uniform><value>0.95</value></uniform></g_spectrum></henyey_greenstein>";
    assert!(!warned(1.0, 1e5, ahead));
}

#[test]
fn refractive_indices_are_those_of_visible_light() {
    let sphere = SPHERE.replace("white", "t");
    let with = |file: &str| {
        format!(
            "<material><name>t</name><phong><nk_data>{file}.nk</nk_data><exponent>100</exponent></phong></material>{sphere}"
        )
    };
    expect_one(&with("ultraviolet"), "ultraviolet.nk", "E0303");
    expect_one(&with("blue"), "blue.nk", "W0303");
    expect_one(&with("green"), "green.nk", "W0303");
    assert_eq!(found(&format!("{}{CAMERA}", with("whole"))), Vec::<String>::new());
    let said = |file: &str| {
        let loaded = loaded(&format!("{HEAD}{}{CAMERA}</scene>", with(file)));
        loaded.sink.diagnostics()[0].message.clone()
    };
    assert!(said("green").ends_with("those at 500 nm are held below, and those at 550 nm are held above"));
    assert!(said("blue").ends_with("seen: those at 500 nm are held above"), "{}", said("blue"));
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

/// What a model says of its materials is sound, though its mesh is not.
#[test]
fn a_mesh_that_cannot_be_read_is_the_only_fault_of_its_model() {
    let of_white = "<material_name>white</material_name>";
    let scale = "<measure>luminance</measure><value>1</value>";
    let model = format!(
        "<model2><pos>0 0 0</pos><scale>1</scale><mesh_name>m</mesh_name><materials>{of_white}</materials>\
         <emission_scale><material_name>lit</material_name>{scale}</emission_scale>\
         <ies_profile><material_name>lit</material_name><path>none.ies</path></ies_profile></model2>\
         <material><name>lit</name><diffuse><base_emission><uniform><value>1</value></uniform></base_emission></diffuse></material>"
    );
    for (file, code) in [("broken.obj", "E0303"), ("none.obj", "E0302")] {
        let mesh = format!("<mesh><name>m</name><external><path>{file}</path></external></mesh>");
        expect_one(&format!("{mesh}{model}"), file, code);
    }
    // Of a name that no mesh has.
    expect_one(&model, "m</mesh_name>", "E0301");
    // Materials that are not there are faults of their own.
    let mesh = "<mesh><name>m</name><external><path>broken.obj</path></external></mesh>";
    let line = format!("{mesh}{}", model.replace(of_white, "<material_name>whitr</material_name>"));
    let column = line.find("whitr").expect("it is there") + 1;
    let found = found(&format!("{line}{CAMERA}"));
    assert!(found.len() == 2 && found.contains(&format!("{LINE}:{column}:E0301")), "{found:?}");
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
