//! The fuzz targets: every reader of files that users bring.

mod common;

use common::fuzz;
use indigo_decl::{ResolveError, Resolved, Resolver};
use indigo_film::{FilmRecord, FilmSize, FilmState, LayerKind, Run, igi};
use indigo_formats::image::Pixels;
use indigo_formats::{MeshData, MeshFormat, float_map, ies, image, nk};
use indigo_igs::pack::{MaterialPacks, Pack, PackLimits, PackWriter};
use indigo_light::Profile;
use indigo_scene::{LoadOptions, Loaded, load};

/// The files of a folder below `seeds`, in order of their names.
fn seeds(folder: &str) -> Vec<Vec<u8>> {
    let folder = format!("{}/seeds/{folder}", env!("CARGO_MANIFEST_DIR"));
    let mut paths: Vec<_> = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    paths.sort();
    paths.into_iter().map(|path| std::fs::read(path).unwrap()).collect()
}

/// Whatever is read must be a mesh that the renderer can take.
fn fuzz_mesh(format: MeshFormat, folder: &str) {
    fuzz(&seeds(folder), |bytes| match format.read(bytes) {
        Ok(mesh) => check(&mesh),
        Err(error) => assert!(!error.expected.is_empty() && !error.found.is_empty()),
    });
}

fn check(mesh: &MeshData) {
    let n = mesh.positions.len();
    assert!(mesh.positions.iter().flatten().all(|x| x.is_finite()));
    assert!(mesh.normals.iter().flatten().all(|x| x.is_finite()));
    assert!(mesh.normals.is_empty() || mesh.normals.len() == n);
    assert!(mesh.uv_sets.iter().all(|set| set.len() == n));
    assert!(mesh.uv_names.iter().all(|&(_, set)| (set as usize) < mesh.uv_sets.len()));
    assert!(mesh.triangles.iter().chain(&mesh.degenerate).flatten().all(|&i| (i as usize) < n));
    assert_eq!(mesh.degenerate_materials.len(), mesh.degenerate.len());
    assert_eq!(mesh.triangle_materials.len(), mesh.triangles.len());
    assert!(mesh.triangle_materials.iter().all(|&m| (m as usize) < mesh.material_names.len()));
}

#[test]
fn obj() {
    fuzz_mesh(MeshFormat::Obj, "obj");
}

#[test]
fn ply() {
    fuzz_mesh(MeshFormat::Ply, "ply");
}

#[test]
fn three_ds() {
    fuzz_mesh(MeshFormat::ThreeDs, "3ds");
}

#[test]
fn igmesh() {
    fuzz_mesh(MeshFormat::Igmesh, "igmesh");
}

/// TGA has no mark of its own: the name says what to try when the content does not.
#[test]
fn picture() {
    fuzz(&seeds("picture"), |bytes| {
        if let Ok(image) = image::decode("picture.tga", bytes) {
            let values = match &image.pixels {
                Pixels::U8(values) => values.len(),
                Pixels::U16(values) => values.len(),
                Pixels::F32(values) => values.len(),
            };
            assert!(matches!(image.channels, 1 | 3));
            assert_eq!(values, image.width as usize * image.height as usize * usize::from(image.channels));
        }
    });
}

/// What is read must be a distribution that a lamp can have.
#[test]
fn ies() {
    fuzz(&seeds("ies"), |bytes| match ies::decode(bytes) {
        Ok(lamp) => {
            assert_eq!(lamp.candela.len(), lamp.vertical_deg.len() * lamp.horizontal_deg.len());
            assert!(lamp.candela.iter().all(|&cd| cd >= 0.0 && cd.is_finite()));
            let profile = Profile::new(&lamp.vertical_deg, &lamp.horizontal_deg, &lamp.candela);
            assert!(profile.flux() >= 0.0 && profile.pdf(profile.sample([0.3, 0.7])).is_finite());
        }
        Err(error) => assert!(!error.expected.is_empty() && !error.found.is_empty()),
    });
}

/// Squares of whatever size the damage leaves, and the one that was asked for.
#[test]
fn float() {
    let seeds: Vec<Vec<u8>> =
        (1..5u32).map(|n| (0..3 * n * n).flat_map(|i| (i as f32).to_le_bytes()).collect()).collect();
    fuzz(&seeds, |bytes| {
        let side = (bytes.len() as f64 / 12.0).sqrt() as u32;
        for width in [0, 3, side, u32::MAX] {
            match float_map::decode(bytes, width) {
                Ok(image) => {
                    let Pixels::F32(values) = image.pixels else { panic!("other values than floats") };
                    assert!(values.len() == 3 * (width * width) as usize && values.len() * 4 == bytes.len());
                }
                Err(error) => assert!(!error.expected.is_empty() && !error.found.is_empty()),
            }
        }
    });
}

#[test]
fn complex_index() {
    fuzz(&seeds("nk"), |bytes| match nk::read(bytes) {
        Ok(index) => {
            let [first, last] = index.range_nm();
            assert!(first > 0.0 && first <= last && last.is_finite());
            assert!(
                [first, 555.0, last]
                    .iter()
                    .all(|&nm| index.at(nm).iter().all(|v| v.is_finite() && *v >= 0.0))
            );
        }
        Err(error) => assert!(!error.expected.is_empty() && !error.found.is_empty()),
    });
}

/// A scene in memory; everything that it includes is missing.
struct Memory<'a>(&'a [u8]);

impl Resolver for Memory<'_> {
    fn read(&self, path: &str, from: &str) -> Result<Resolved, ResolveError> {
        if from.is_empty() {
            Ok(Resolved { path: path.to_owned(), bytes: self.0.into() })
        } else {
            Err(ResolveError::NotFound { looked: vec![path.to_owned()] })
        }
    }
}

#[test]
fn scene() {
    fuzz(&seeds("scene"), |bytes| {
        let memory = Memory(bytes);
        // Trees are left out: a number in a damaged file may ask for a large picture, and they take time.
        let options = LoadOptions { check_only: true, ..LoadOptions::new(&memory) };
        let Loaded { sources, sink, settings, .. } = load("scene.igs", &options);
        assert!(settings.is_some() || sink.has_errors(), "nothing was read, and nothing was said of it");
        for diagnostic in sink.diagnostics() {
            let json = indigo_diag::to_json(diagnostic, &sources);
            assert!(!json.is_empty());
        }
    });
}

/// A small film, as it is saved.
fn film() -> Vec<u8> {
    let size = FilmSize::new(4, 3, 2).unwrap();
    let layers = [(LayerKind::PerPixel, "camera"), (LayerKind::PerScreen, "light")];
    let mut film = FilmState::new(size, &layers);
    film.layers[0].counts.fill(2.0);
    let record = FilmRecord {
        program: "Indigo".into(),
        settings: vec![("width".into(), "4".into())],
        runs: vec![Run { seed: 1, first: 0, end: 9 }],
        samples: 96,
        ..FilmRecord::default()
    };
    let mut file = Vec::new();
    igi::write(&mut file, &film, &record).unwrap();
    file
}

/// Once as damaged, which the checksum tells, and once with a forged checksum. The free room of the header
/// is left out of the damage, or little else would be hit.
#[test]
fn igi() {
    const FREE: std::ops::Range<usize> = 52..5040;
    let whole = film();
    let seed: Vec<u8> = [&whole[..FREE.start], &whole[FREE.end..]].concat();
    let mut foreign = seed.clone();
    foreign[40..FREE.start].fill(0);
    let mut later = seed.clone();
    later[4] = 7;
    fuzz(&[seed, foreign, later], |bytes| {
        let (head, tail) = bytes.split_at(bytes.len().min(FREE.start));
        let mut file = [head, &vec![0; FREE.len()], tail].concat();
        for _ in 0..2 {
            let read = igi::read(&file);
            assert_eq!(
                igi::IgiFile::load(&*file, 0).unwrap().develop(&indigo_film::LightMix::default()).is_ok(),
                read.is_ok()
            );
            if let Ok(saved) = read {
                let pixels = saved.film.size.internal_pixels();
                assert!(saved.film.layers.iter().all(|l| l.sums.len() == pixels));
                assert!(saved.film.layers.iter().flat_map(|l| &l.sums).flatten().all(|v| v.is_finite()));
            }
            if let Some(content) = file.len().checked_sub(32) {
                let hash = *blake3::hash(&file[..content]).as_bytes();
                file[content..].copy_from_slice(&hash);
            }
        }
    });
}

/// A seed that is not itself read teaches nothing.
#[test]
fn seeds_are_sound() {
    for (folder, format) in [
        ("obj", MeshFormat::Obj),
        ("ply", MeshFormat::Ply),
        ("3ds", MeshFormat::ThreeDs),
        ("igmesh", MeshFormat::Igmesh),
    ] {
        for seed in seeds(folder) {
            assert_eq!(format.read(&seed).err(), None, "{folder}");
        }
    }
    // A reader of every version, and of both forms of the last, is fuzzed.
    let version = |seed: &[u8]| (seed[4], seed[4] == 4 && seed[8] == 1);
    let mut versions: Vec<_> = seeds("igmesh").iter().map(|seed| version(seed)).collect();
    versions.sort_unstable();
    assert_eq!(versions, [(1, false), (2, false), (3, false), (4, false), (4, true)]);
    for seed in seeds("ies") {
        assert_eq!(ies::decode(&seed).err(), None);
    }
    for seed in seeds("nk") {
        assert_eq!(nk::read(&seed).err(), None);
    }
    assert!(igi::read(&film()).is_ok());
    for seed in seeds("picture") {
        assert_eq!(image::decode("picture.tga", &seed).err(), None);
    }
}

/// A scene that includes a packed material, which is all that there is beside it.
struct Library<'a>(&'a [u8]);

impl Resolver for Library<'_> {
    fn read(&self, path: &str, _from: &str) -> Result<Resolved, ResolveError> {
        let bytes: &[u8] = match path {
            "scene.igs" => b"<scene><include><pathname>m.pigm</pathname><offset_uids>true</offset_uids></include></scene>",
            "m.pigm" => self.0,
            _ => return Err(ResolveError::NotFound { looked: vec![path.to_owned()] }),
        };
        Ok(Resolved { path: path.to_owned(), bytes: bytes.into() })
    }
}

#[test]
fn packed_material() {
    let mut out = std::io::Cursor::new(vec![]);
    let mut pack = PackWriter::new(&mut out);
    pack.add("brick.png", include_bytes!("../seeds/picture/grey.png")).unwrap();
    pack.finish("wall.igs", include_bytes!("../seeds/scene/material.igm")).unwrap();
    // The writer knows packed scenes alone; names have no checksum.
    let mut seed = out.into_inner();
    let name = b"wall.igs";
    let places: Vec<usize> =
        seed.windows(name.len()).enumerate().filter(|(_, w)| w == name).map(|(i, _)| i).collect();
    assert_eq!(places.len(), 2, "at the member, and in the list");
    for i in places {
        seed[i..i + name.len()].copy_from_slice(b"wall.igm");
    }
    let limits = || PackLimits { always_allowed: 1 << 20, ..PackLimits::default() };
    let errors = |bytes: &[u8]| {
        let library = Library(bytes);
        let packs = MaterialPacks::new(&library, limits());
        let options = LoadOptions { check_only: true, ..LoadOptions::new(&packs) };
        load("scene.igs", &options).sink.error_count()
    };
    assert_eq!(errors(&seed), 1, "there is no camera, and nothing else is wrong");
    fuzz(&[seed], |bytes| assert!(errors(bytes) > 0));
}

/// A packed scene: its list of members may promise anything, and so may each of them.
#[test]
fn pack() {
    let mut out = std::io::Cursor::new(vec![]);
    let mut pack = PackWriter::new(&mut out);
    pack.add("wood.png", b"stored as it is").unwrap();
    pack.add("au.nk", &[b'7'; 300]).unwrap();
    pack.finish("room.igs", b"<scene><include><pathname>PACKED_1_au.nk</pathname></include></scene>")
        .unwrap();
    let limits = PackLimits { always_allowed: 1 << 20, ..PackLimits::default() };
    fuzz(&[out.into_inner()], |bytes| {
        let Ok(pack) = Pack::open(bytes.into(), &limits) else { return };
        // Some of the names are damaged, and then there may be no scene or two.
        drop((pack.main(), pack.material()));
        for (name, size) in pack.members() {
            assert!(name.split('/').all(|part| !part.is_empty() && part != ".."), "{name}");
            assert!(pack.read(name).map_or(0, |content| content.len() as u64) <= size);
        }
    });
}
