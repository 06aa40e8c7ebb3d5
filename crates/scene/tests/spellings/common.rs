//! Two spellings of a scene, and what they are lowered to.

use indigo_decl::{ResolveError, Resolved, Resolver};
use indigo_diag::Severity;
use indigo_scene::{LoadOptions, Loaded, Scene, load, load_canonical};

/// A scene and the files beside it.
pub struct Memory(pub Vec<(&'static str, Vec<u8>)>);

impl Resolver for Memory {
    fn read(&self, path: &str, _from: &str) -> Result<Resolved, ResolveError> {
        let found = self.0.iter().find(|(name, _)| *name == path);
        let (_, bytes) = found.ok_or_else(|| ResolveError::NotFound { looked: vec![path.to_owned()] })?;
        Ok(Resolved { path: path.to_owned(), bytes: bytes.clone().into() })
    }
}

/// Two texels side by side.
pub fn bmp(texels: [[u8; 3]; 2]) -> Vec<u8> {
    let mut bytes = b"BM".to_vec();
    for word in [62_u32, 0, 54, 40, 2, 1] {
        bytes.extend(word.to_le_bytes());
    }
    bytes.extend([1, 0, 24, 0]);
    for word in [0_u32, 8, 0, 0, 0, 0] {
        bytes.extend(word.to_le_bytes());
    }
    bytes.extend(texels.concat());
    bytes.extend([0, 0]);
    bytes
}

/// Two texels of high range side by side: red, green and blue with a common exponent.
pub fn hdr(texels: [[u8; 4]; 2]) -> Vec<u8> {
    let header = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n";
    header.iter().copied().chain(texels.concat()).collect()
}

const SETTINGS: &str = "<renderer_settings><width>64</width><height>48</height><bidirectional>false</bidirectional><metropolis>false</metropolis><aperture_diffraction>false</aperture_diffraction></renderer_settings>
<tonemapping><linear><scale>1</scale></linear></tonemapping>";
pub const CAMERA: &str = "<camera><pos>0 -2 1</pos><up>0 0 1</up><forwards>0 1 0</forwards><aperture_radius>0.001</aperture_radius><focus_distance>3</focus_distance><aspect_ratio>1.3333</aspect_ratio><sensor_width>0.036</sensor_width><lens_sensor_dist>0.02</lens_sensor_dist></camera>";
pub const LIGHT: &str = "<background><spectrum><uniform><value>1</value></uniform></spectrum></background>";
/// A triangle with two uv sets, of the materials `m` and `n`.
pub const MESH: &str = "<mesh><name>tri</name><uid>7</uid><embedded><expose_uv_set><index>0</index><name>albedo</name></expose_uv_set><expose_uv_set><index>1</index><name>other</name></expose_uv_set><vertex pos=\"0 0 0\" uv0=\"0 0\" uv1=\"0.5 0.5\"/><vertex pos=\"1 0 0\" uv0=\"1 0\" uv1=\"1 0\"/><vertex pos=\"0 1 0\" uv0=\"0 1\" uv1=\"0 1\"/><vertex pos=\"1 1 0\" uv0=\"0 1\" uv1=\"0 1\"/><triangle_set><material_name>m</material_name><tri>0 1 2</tri></triangle_set><triangle_set><material_name>n</material_name><tri>1 3 2</tri></triangle_set></embedded></mesh>";
/// That triangle in the scene.
pub const MODEL: &str = "<model><pos>1 2 3</pos><scale>0.5</scale><mesh_name>tri</mesh_name></model>";
/// A material of every name that is not what a test is about.
pub const GREY: &str =
    "<diffuse><albedo_spectrum><uniform><value>0.25</value></uniform></albedo_spectrum></diffuse>";

pub fn material(name: &str, kind: &str) -> String {
    format!("<material><name>{name}</name>{kind}</material>")
}

/// A scene of these elements, beside some files.
pub fn loaded(elements: &str) -> Loaded {
    load("scene.igs", &LoadOptions::new(&beside(format!("<scene>{SETTINGS}{elements}</scene>"))))
}

/// The same in the form that this program writes, of which no more than `told` is told.
pub fn canonical(elements: &str, told: &[&str]) -> Loaded {
    let scene = beside(format!("<scene>{SETTINGS}{elements}</scene>"));
    let written = load_canonical("scene.igs", &LoadOptions::new(&scene), "A scene ---- anew-", &|file| {
        file.written.into()
    });
    let text = written.text.expect("a scene without errors");
    let loaded = load("scene.igs", &LoadOptions::new(&beside(text.clone())));
    assert_eq!(beyond(told, &loaded), [], "nothing is left to be told of\n{text}");
    loaded
}

fn beside(scene: String) -> Memory {
    Memory(vec![
        ("scene.igs", scene.into_bytes()),
        ("a.bmp", bmp([[0, 60, 120], [200, 220, 240]])),
        ("b.bmp", bmp([[9, 9, 9], [250, 250, 250]])),
        ("sky.hdr", hdr([[10, 20, 30, 129], [200, 100, 50, 131]])),
        ("lamp.ies", include_bytes!("../../../../testscenes/ies/lambert_1000cd.ies").to_vec()),
        ("au.nk", include_bytes!("../../../../nkdata/au.nk").to_vec()),
    ])
}

/// Everything that was found, as code and message.
pub fn findings(loaded: &Loaded) -> Vec<(Severity, String)> {
    loaded.sink.diagnostics().iter().map(|d| (d.severity, format!("{} {}", d.code, d.message))).collect()
}

/// Those with other beginnings than these.
fn beyond(told: &[&str], loaded: &Loaded) -> Vec<(Severity, String)> {
    let mut found = findings(loaded);
    found.retain(|(_, said)| !told.iter().any(|known| said.starts_with(known)));
    found
}

/// What light meets in a scene, in full.
pub fn dump(scene: &Scene) -> String {
    let Scene { lights, camera, textures, media, names, .. } = scene;
    let (objects, meshes) = (scene.accel.objects(), scene.accel.meshes());
    let materials = scene.materials();
    format!(
        "{names:?}\n{objects:?}\n{meshes:?}\n{materials:?}\n{textures:?}\n{media:?}\n{lights:?}\n{camera:?}"
    )
}

/// The scene of these elements, of which only warnings with these beginnings are expected.
#[track_caller]
pub fn scene_with(elements: &str, expected: &[&str]) -> Scene {
    let loaded = loaded(elements);
    let found = findings(&loaded);
    let matches = found.len() == expected.len()
        && found.iter().zip(expected).all(|((_, text), start)| text.starts_with(start));
    assert!(matches, "{found:#?}\nin {elements}");
    loaded.scene.expect("a scene without errors")
}

/// Says that two spellings are the same scene, and that a third is another: so that the comparison can fail. The second is the
/// same, too, when it is written anew.
#[track_caller]
pub fn assert_same(spellings: [&str; 3]) {
    assert_same_told(&[], spellings);
}

/// The same of spellings of which something is told, with these beginnings and no others.
#[track_caller]
pub fn assert_same_told(told: &[&str], [old, new, other]: [&str; 3]) {
    let all: Vec<String> = findings(&loaded(new)).into_iter().map(|(_, said)| said).collect();
    assert!(told.iter().all(|known| all.iter().any(|said| said.starts_with(known))), "{all:?}");
    let anew = dump(&canonical(new, told).scene.expect("a scene without errors"));
    let [old, new, other] = [old, new, other].map(|elements| {
        let loaded = loaded(elements);
        assert_eq!(beyond(told, &loaded), [], "in {elements}");
        dump(&loaded.scene.expect("a scene without errors"))
    });
    assert!(old == new, "the spellings differ:\n{}", difference(&old, &new));
    assert!(old != other, "the comparison sees no difference");
    assert!(old == anew, "written anew it differs:\n{}", difference(&old, &anew));
}

/// The radiance of the surroundings towards the zenith, at some wavelength.
pub fn surroundings(scene: &Scene) -> f64 {
    let lambda = indigo_spectrum::SampledWavelengths::sample(0.4);
    let up = indigo_math::Vec3::new(0.0, 0.0, 1.0);
    scene.lights.environment(up, &lambda).expect("there are surroundings").hero().into()
}

/// The surroundings of the first difference.
fn difference(a: &str, b: &str) -> String {
    let at = a.bytes().zip(b.bytes()).position(|(a, b)| a != b).unwrap_or(0);
    let around = |text: &str| {
        let bytes = &text.as_bytes()[at.saturating_sub(200)..text.len().min(at + 200)];
        String::from_utf8_lossy(bytes).into_owned()
    };
    format!("{}\n-- and --\n{}", around(a), around(b))
}
