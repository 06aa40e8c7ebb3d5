//! Indigo images: what is written comes back, what is damaged is refused, other programs' files are read.

use indigo_film::igi::{IgiError, IgiFile, read, write};
use indigo_film::{DevelopedFilm, FilmRecord, FilmSize, FilmState, LayerKind, Mismatch, Run, SavedFilm};
use indigo_math::rng::Rng;

const LAYERS: [(LayerKind, &str); 2] =
    [(LayerKind::PerPixel, "camera"), (LayerKind::PerScreen, "metropolis")];

/// A film of random sums, as `f32` additions leave them.
fn saved(seed: u64) -> SavedFilm {
    of_size(FilmSize::new(19, 13, 3).unwrap(), seed)
}

fn of_size(size: FilmSize, seed: u64) -> SavedFilm {
    let mut film = FilmState::new(size, &LAYERS);
    let mut rng = Rng::new(seed);
    for layer in &mut film.layers {
        for sum in &mut layer.sums {
            *sum = std::array::from_fn(|_| f64::from((rng.next_f64() * 1e4) as f32));
        }
        layer.counts.fill_with(|| (rng.next_f64() * 9.0).floor());
        layer.totals.n_samples = 247.0 * 64.0;
    }
    (film.layers[1].totals.b_sum, film.layers[1].totals.b_count) = (123.456, 78.0);
    film.layers[1].totals.n_idle = 9.0;
    film.refused = 3;
    let record = FilmRecord {
        program: "Indigo".into(),
        scene_path: "σκηνή.igs".into(),
        scene_hash: [7; 32],
        settings: vec![("width".into(), "19".into()), ("max_depth".into(), "5".into())],
        runs: vec![Run { seed, first: 0, end: 40 }, Run { seed: u64::MAX, first: 3, end: 9 }],
        samples: 247 * 64,
        elapsed_s: 12.5,
    };
    SavedFilm { film, record: Some(record) }
}

fn bytes(saved: &SavedFilm) -> Vec<u8> {
    let mut file = Vec::new();
    write(&mut file, &saved.film, saved.record.as_ref().unwrap()).unwrap();
    file
}

fn develop(file: &[u8]) -> Result<DevelopedFilm, IgiError> {
    IgiFile::load(file, file.len() as u64)
        .expect("bytes in memory")
        .develop(&indigo_film::LightMix::default())
}

#[test]
fn a_film_comes_back_bit_for_bit() {
    let film = saved(1);
    assert_eq!(read(&bytes(&film)).unwrap(), film);
    let empty = FilmState::new(FilmSize::new(1, 1, 1).unwrap(), &LAYERS);
    let empty = SavedFilm { film: empty, record: Some(FilmRecord::default()) };
    assert_eq!(read(&bytes(&empty)).unwrap(), empty);
}

/// To the same bits, also where blocks end within rows and the last of them is cut off; a pixel without samples is missing.
#[test]
fn developing_a_file_is_developing_its_film() {
    for (width, height) in [(1, 1), (19, 13), (151, 143)] {
        let mut film = of_size(FilmSize::new(width, height, 2).unwrap(), 7);
        let file = bytes(&film);
        let developed = develop(&file).unwrap();
        assert_eq!((developed.image, developed.record), (film.film.develop(), film.record.clone()));
        assert_eq!(developed.refused, film.film.refused);
        film.film.layers.swap(0, 1);
        let swapped = develop(&bytes(&film)).unwrap().image;
        assert!(swapped == film.film.develop() && (width == 1 || swapped.missing.contains(&true)));
        film.film.layers.remove(1);
        assert_eq!(develop(&bytes(&film)).unwrap().image, film.film.develop(), "no layer of pixels");
    }
}

/// The start of the file as another program's reader of version 1 sees it.
#[test]
fn a_reader_of_version_1_finds_the_picture() {
    let film = saved(2);
    let file = bytes(&film);
    let u32_at = |at: usize| u32::from_le_bytes(file[at..at + 4].try_into().unwrap());
    let samples = f64::from_le_bytes(file[8..16].try_into().unwrap());
    assert_eq!([u32_at(0), u32_at(4), u32_at(16), u32_at(20), u32_at(24)], [66_613_373, 1, 57, 39, 3]);
    assert_eq!([u32_at(28), u32_at(32), u32_at(36)], [0, 57 * 39 * 12, 0]);
    assert_eq!(samples, 247.0 * 64.0);
    let developed = film.film.develop();
    for (i, pixel) in developed.pixels.iter().enumerate() {
        for (c, value) in pixel[..3].iter().enumerate() {
            let stored = f32::from_bits(u32_at(5040 + 12 * i + 4 * c));
            assert!(
                (f64::from(stored) / (samples / 247.0) - f64::from(*value)).abs() <= 1e-6 * f64::from(*value)
            );
        }
    }
    // Without the mark it is such a file, and develops to the same picture.
    let mut foreign = file[..5040 + 57 * 39 * 12].to_vec();
    foreign[40..52].fill(0);
    let developed_at_once = develop(&foreign).unwrap();
    let foreign = read(&foreign).unwrap();
    assert_eq!(foreign.record, None);
    assert_eq!((developed_at_once.image, developed_at_once.record), (foreign.film.develop(), None));
    for (a, b) in foreign.film.develop().pixels.iter().zip(&developed.pixels) {
        assert!(a[..3].iter().zip(b).all(|(a, b)| (a / b - 1.0).abs() < 1e-5));
    }
    // What is no number is black, and counted.
    let mut broken = file[..5040 + 57 * 39 * 12].to_vec();
    broken[40..52].fill(0);
    for (pixel, value) in [(3, f32::NAN), (500, f32::INFINITY)] {
        broken[5040 + 12 * pixel..][..4].copy_from_slice(&value.to_le_bytes());
    }
    assert_eq!(develop(&broken).unwrap().refused, 2);
    // A length of 0 is none; any other must be right. And nobody takes so many samples.
    let mut changed = file[..5040 + 57 * 39 * 12].to_vec();
    changed[40..52].fill(0);
    for (length, is_sound) in [(0u32, true), (5, false), (57 * 39 * 12 + 1, false)] {
        changed[32..36].copy_from_slice(&length.to_le_bytes());
        assert_eq!(read(&changed).is_ok(), is_sound, "{length}");
    }
    changed[32..36].fill(0);
    changed[8..16].copy_from_slice(&1e300f64.to_le_bytes());
    assert!(read(&changed).unwrap_err().to_string().contains("no count"));
}

#[test]
fn any_damage_is_told() {
    let file = bytes(&saved(3));
    for at in (0..file.len()).step_by(97).chain([0, 5, file.len() - 1]).chain(40..49) {
        let mut damaged = file.clone();
        damaged[at] ^= 0x10;
        assert_eq!(develop(&damaged).err(), read(&damaged).err(), "byte {at}");
        match read(&damaged) {
            Ok(_) => panic!("byte {at} does not matter"),
            Err(IgiError::NotIgi) => assert!(at < 4),
            Err(IgiError::Version(_)) => assert!((4..8).contains(&at)),
            Err(IgiError::Section(_)) => assert!((48..52).contains(&at)),
            Err(error) => assert_eq!(error, IgiError::Checksum, "byte {at}"),
        }
    }
    // Half of the mark, and less of it, as another program might leave there.
    for (lost, is_damage) in [(4, true), (5, false), (8, false)] {
        let mut damaged = file.clone();
        damaged[40..40 + lost].fill(0);
        assert_eq!(read(&damaged).err() == Some(IgiError::Checksum), is_damage, "{lost} bytes of the mark");
    }
    for length in [0, 3, 8, 39, 45, 60, 5039, 5040, 5041, file.len() / 2, file.len() - 33, file.len() - 1] {
        let error = read(&file[..length]).unwrap_err();
        assert_eq!(develop(&file[..length]), Err(error), "{length} bytes");
    }
    assert_eq!(read(b"not a film at all"), Err(IgiError::NotIgi));
}

/// Versions 7 and 8 as other programs write them: layers with a margin of four output pixels.
#[test]
fn films_of_later_versions_are_read() {
    let (width, height, factor, margin) = (5u32, 4u32, 2u32, 4u32);
    for version in [7u32, 8] {
        let text = |file: &mut Vec<u8>, text: &str| {
            file.extend((text.len() as u32).to_le_bytes());
            file.extend(text.as_bytes());
        };
        let mut file = Vec::new();
        file.extend(66_613_373u32.to_le_bytes());
        file.extend(version.to_le_bytes());
        file.extend((20.0f64 * 50.0).to_le_bytes());
        file.extend([width, height, factor].iter().flat_map(|v| v.to_le_bytes()));
        file.extend(9.5f64.to_le_bytes());
        file.extend(0u32.to_le_bytes());
        text(&mut file, "scene.igs");
        if version == 8 {
            text(&mut file, "<scenedata/>");
        }
        file.extend(1u32.to_le_bytes());
        file.extend(100u32.to_le_bytes());
        text(&mut file, "layers");
        file.extend(2u32.to_le_bytes());
        let [w, h] = [width, height].map(|v| factor * (v + 2 * margin));
        for layer in 1..=2u32 {
            text(&mut file, "light");
            file.extend(1u32.to_le_bytes());
            file.extend(w.to_le_bytes());
            file.extend(h.to_le_bytes());
            for y in 0..h {
                for x in 0..w {
                    let inside = (8..18).contains(&x) && (8..16).contains(&y);
                    let value = if inside { (layer * (x + 100 * y)) as f32 } else { 1e9 };
                    file.extend([1.0, 2.0, 3.0].iter().flat_map(|c| (c * value).to_le_bytes()));
                }
            }
        }
        file.extend(0u32.to_le_bytes());
        let film = read(&file).unwrap();
        assert_eq!(film.film.size, FilmSize::new(width, height, factor).unwrap());
        let developed = film.film.develop();
        for (i, pixel) in developed.pixels.iter().enumerate() {
            let (x, y) = (i as u32 % 10 + 8, i as u32 / 10 + 8);
            // 50 samples per output pixel, both layers together.
            let value = (3 * (x + 100 * y)) as f32 / 50.0;
            assert!((pixel[0] / value - 1.0).abs() < 1e-5 && (pixel[2] / value - 3.0).abs() < 1e-5);
        }
        assert!(read(&file[..file.len() / 2]).is_err());
    }
}

#[test]
fn independent_films_add_up_and_the_same_samples_are_refused() {
    let (mut a, b) = (saved(4), saved(5));
    assert!(matches!(a.clone().merge(&a.clone()).unwrap_err()[..], [Mismatch::SameSamples { seed: 4, .. }]));
    // Both hold units 3 to 9 of one seed.
    assert!(matches!(a.merge(&b).unwrap_err()[..], [Mismatch::SameSamples { seed: u64::MAX, .. }]));
    let mut b = b;
    b.record.as_mut().unwrap().runs.pop();
    let before = a.clone();
    a.merge(&b).unwrap();
    for (layer, sum) in a.film.layers.iter().enumerate() {
        let (x, y) = (&before.film.layers[layer], &b.film.layers[layer]);
        assert_eq!(sum.totals.b_count, x.totals.b_count + y.totals.b_count);
        assert_eq!(sum.totals.n_idle, x.totals.n_idle + y.totals.n_idle);
        assert!(sum.sums.iter().zip(x.sums.iter().zip(&y.sums)).all(|(s, (x, y))| s[1] == x[1] + y[1]));
    }
    let record = a.record.as_ref().unwrap();
    assert_eq!((record.samples, record.elapsed_s, record.runs.len()), (2 * 247 * 64, 25.0, 3));
    let mut other = saved(6);
    other.record.as_mut().unwrap().settings[1].1 = "6".into();
    other.record.as_mut().unwrap().scene_hash = [8; 32];
    assert_eq!(a.merge(&other).unwrap_err().len(), 3, "a setting, the scene, the samples");
}
