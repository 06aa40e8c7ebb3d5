//! Media of a scene: what lowering makes of their elements, and in which of them a point lies.

use indigo_decl::{ResolveError, Resolved, Resolver};
use indigo_diag::Severity;
use indigo_math::Vec3;
use indigo_scatter::phase::PhaseFunction;
use indigo_scene::{LoadOptions, Loaded, Scene, load};

struct Memory(String);

impl Resolver for Memory {
    fn read(&self, path: &str, _from: &str) -> Result<Resolved, ResolveError> {
        Ok(Resolved { path: path.to_owned(), bytes: self.0.as_bytes().into() })
    }
}

const HEAD: &str = "<scene><renderer_settings><width>8</width><height>8</height><aperture_diffraction>false</aperture_diffraction></renderer_settings>
<tonemapping><linear><scale>1</scale></linear></tonemapping>
<background><spectrum><uniform><value>1</value></uniform></spectrum></background>
";

fn camera(pos: &str) -> String {
    format!(
        "<camera><pos>{pos}</pos><up>0 0 1</up><forwards>0 1 0</forwards><aperture_radius>0.001</aperture_radius><focus_distance>3</focus_distance><aspect_ratio>1</aspect_ratio><sensor_width>0.036</sensor_width><lens_sensor_dist>0.02</lens_sensor_dist></camera>\n"
    )
}

fn loaded(rest: &str) -> Loaded {
    let memory = Memory(format!("{HEAD}{rest}</scene>"));
    load("scene.igs", &LoadOptions::new(&memory))
}

fn scene(rest: &str) -> Scene {
    let loaded = loaded(rest);
    let complaints = loaded.sink.diagnostics();
    assert!(complaints.is_empty(), "{complaints:?}");
    loaded.scene.expect("a scene")
}

fn medium(name: &str, precedence: u32, content: &str) -> String {
    format!("<medium><name>{name}</name><precedence>{precedence}</precedence>{content}</medium>")
}

fn glass(name: &str, precedence: u32, ior: f64) -> String {
    medium(name, precedence, &format!("<basic><ior>{ior}</ior></basic>"))
}

/// A sphere with a medium inside.
fn ball(center: &str, radius: f64, medium: &str) -> String {
    format!(
        "<material><name>to {medium}</name><specular><internal_medium_name>{medium}</internal_medium_name></specular></material>
<sphere><center>{center}</center><radius>{radius}</radius><material_name>to {medium}</material_name></sphere>"
    )
}

#[test]
fn every_element_of_a_medium_is_read() {
    let content = "<basic><ior>1.4</ior><cauchy_b_coeff>0.005</cauchy_b_coeff>
<absorption_coefficient_spectrum><rgb><rgb>2 2 2</rgb></rgb></absorption_coefficient_spectrum>
<subsurface_scattering><scattering_coefficient_spectrum><uniform><value>30</value></uniform></scattering_coefficient_spectrum>
<phase_function><henyey_greenstein><g_spectrum><uniform><value>0.7</value></uniform></g_spectrum></henyey_greenstein></phase_function></subsurface_scattering></basic>";
    let scene = scene(&(camera("0 -4 0") + &medium("m", 5, content) + &ball("0 0 0", 1.0, "m")));
    let [_, m] = scene.media.as_slice() else { panic!("air and one medium") };
    assert_eq!((m.ior.a, m.ior.b), (1.4, 0.005));
    assert_eq!((m.absorption.at(500.0), m.scattering.at(500.0)), (2.0, 30.0));
    assert!(matches!(m.phase, PhaseFunction::HenyeyGreenstein(_)));
}

#[test]
fn skin_media_are_read() {
    let epidermis = "<epidermis><melanin_fraction>0.05</melanin_fraction><melanin_type_blend>0.5</melanin_type_blend></epidermis>";
    let dermis = "<dermis><hemoglobin_fraction>0.02</hemoglobin_fraction></dermis>";
    for (content, absorption) in [(epidermis, 4336.9), (dermis, 900.592)] {
        let scene = scene(&(camera("0 -4 0") + &medium("m", 5, content) + &ball("0 0 0", 1.0, "m")));
        let found = scene.media[1].absorption.at(450.0);
        assert!((found / absorption - 1.0).abs() < 1e-4, "{found} instead of {absorption}");
    }
}

#[test]
fn names_that_are_not_there_are_named_where_they_stand() {
    let l = loaded(&(camera("0 -4 0") + &glass("glass", 5, 1.5) + &ball("0 0 0", 1.0, "gloss")));
    let [d] = l.sink.diagnostics() else { panic!("{:?}", l.sink.diagnostics()) };
    assert_eq!((d.code, d.severity), ("E0301", Severity::Error));
    assert_eq!(d.hint.as_deref(), Some("did you mean glass?"));
    assert!(d.span.is_some() && l.scene.is_none());
}

#[test]
fn media_that_nothing_names_have_no_effect() {
    let scene = scene(&(camera("0 -4 0") + &glass("glass", 5, 1.5)));
    assert!(scene.media.is_empty());
}

/// The medium round a point, by its index of refraction.
fn ior_at(scene: &Scene, p: [f32; 3]) -> f64 {
    scene.media[scene.media_at(Vec3::new(p[0] as _, p[1] as _, p[2] as _)).current().index()].ior.a
}

#[test]
fn the_medium_of_highest_precedence_is_there_where_objects_overlap() {
    let objects = glass("low", 5, 1.1)
        + &glass("high", 9, 1.9)
        + &ball("0 0 0", 1.0, "low")
        + &ball("1 0 0", 1.0, "high");
    // Render space begins at the camera.
    let scene = scene(&(camera("0 -4 0") + &objects));
    assert_eq!(ior_at(&scene, [-0.5, 4.0, 0.0]), 1.1);
    assert_eq!(ior_at(&scene, [0.5, 4.0, 0.0]), 1.9);
    assert_eq!(ior_at(&scene, [1.5, 4.0, 0.0]), 1.9);
    assert_eq!(ior_at(&scene, [0.0, 0.0, 0.0]), 1.0);
}

#[test]
fn of_equal_precedence_the_later_definition_is_there() {
    for names in [["a", "b"], ["b", "a"]] {
        let defined = glass(names[0], 5, 1.2) + &glass(names[1], 5, 1.3);
        let objects = ball("0 0 0", 1.0, "a") + &ball("0.5 0 0", 1.0, "b");
        let scene = scene(&(camera("0.2 0 0") + &defined + &objects));
        assert_eq!(ior_at(&scene, [0.0; 3]), 1.3);
    }
}

#[test]
fn the_camera_finds_its_medium() {
    for (pos, ior) in [("0 0 0", 1.5), ("0 -4 0", 1.0), ("0 -0.9 0.1", 1.5)] {
        let scene = scene(&(camera(pos) + &glass("g", 5, 1.5) + &ball("0 0 0", 1.0, "g")));
        assert_eq!(scene.media[scene.camera_media.current().index()].ior.a, ior, "{pos}");
    }
}
