//! Every file of `media/` can be included, and its medium used, without a complaint.

use indigo_decl::{ResolveError, Resolved, Resolver};
use indigo_scene::{LoadOptions, load};
use std::path::Path;

/// A scene in memory and the files of the repository.
struct Repository(String);

impl Resolver for Repository {
    fn read(&self, path: &str, _from: &str) -> Result<Resolved, ResolveError> {
        let not_found = || ResolveError::NotFound { looked: vec![path.to_owned()] };
        let bytes = if path == "scene.igs" {
            self.0.clone().into_bytes()
        } else {
            let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
            std::fs::read(root.join(path)).map_err(|_| not_found())?
        };
        Ok(Resolved { path: path.to_owned(), bytes: bytes.into() })
    }
}

const HEAD: &str = "<renderer_settings><width>8</width><height>8</height><aperture_diffraction>false</aperture_diffraction></renderer_settings>
<tonemapping><linear><scale>1</scale></linear></tonemapping>
<camera><pos>0 -4 0</pos><up>0 0 1</up><forwards>0 1 0</forwards><aperture_radius>0.001</aperture_radius><focus_distance>3</focus_distance><aspect_ratio>1</aspect_ratio><sensor_width>0.036</sensor_width><lens_sensor_dist>0.02</lens_sensor_dist></camera>
<background><spectrum><uniform><value>1</value></uniform></spectrum></background>
<sphere><center>0 0 0</center><radius>1</radius><material_name>surface</material_name></sphere>
";

#[test]
fn every_medium_of_the_library_loads() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../media");
    let mut count = 0;
    for file in std::fs::read_dir(folder).expect("the folder of media") {
        let path = file.expect("a file").path();
        if path.extension().is_none_or(|extension| extension != "igs") {
            continue;
        }
        let name = path.file_stem().expect("a name").to_string_lossy().into_owned();
        let scene = format!(
            "<scene>{HEAD}<include><pathname>media/{name}.igs</pathname></include><material><name>surface</name><specular><internal_medium_name>{name}</internal_medium_name></specular></material></scene>"
        );
        let repository = Repository(scene);
        let options = LoadOptions::new(&repository);
        let loaded = load("scene.igs", &options);
        assert!(loaded.sink.diagnostics().is_empty(), "{name}: {:?}", loaded.sink.diagnostics());
        let scene = loaded.scene.expect("a scene");
        assert_eq!(scene.media.len(), 2, "{name}");
        let medium = &scene.media[1];
        // Nothing here is lighter than ice, and nothing but diamond is denser than sapphire.
        assert!((1.3..2.4).contains(&medium.ior.a), "{name}");
        // A row of liquids has absorption, a dielectric dispersion.
        assert!(medium.absorption.max() > 0.0 || medium.ior.b > 0.0, "{name}");
        count += 1;
    }
    assert_eq!(count, 55);
}
