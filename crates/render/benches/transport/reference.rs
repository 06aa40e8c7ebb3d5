//! Long renders to compare with, made once.

use super::measure::{Run, rel_mse};
use super::modes::MODES;
use super::scenes::BenchScene;
use std::fs;
use std::path::PathBuf;

/// A long render.
pub struct Reference {
    /// X, Y and Z of each pixel.
    pub mean: Vec<[f32; 3]>,
    /// Its own relMSE in each of them.
    pub noise: [f64; 3],
}

impl Reference {
    /// The one that is kept, or a new one of so many seconds.
    pub fn of(bench: &BenchScene, seconds: f64) -> Self {
        let path = path(bench);
        if let Ok(bytes) = fs::read(&path) {
            let numbers: Vec<f32> = bytes.as_chunks::<4>().0.iter().map(|b| f32::from_le_bytes(*b)).collect();
            let pixels = numbers.as_chunks::<3>().0;
            let (a, b) = pixels.split_at(pixels.len() / 2);
            return Self::from_halves(a, b);
        }
        println!("{}: a reference of {seconds} s by {}", bench.name, bench.reference);
        let mode = MODES.iter().find(|m| m.name == bench.reference).expect("a mode of the list");
        let scene = mode.of(bench.load());
        let halves = [101, 102].map(|seed| {
            let mut run = Run::new(&scene, seed);
            while run.seconds < 0.5 * seconds {
                // Sums of single precision stay short.
                run.go_on(1.0);
            }
            run.picture()
        });
        let bytes: Vec<u8> = halves.iter().flatten().flatten().flat_map(|v| v.to_le_bytes()).collect();
        fs::create_dir_all(path.parent().expect("a folder")).expect("a folder for references");
        fs::write(path, bytes).expect("room for a reference");
        Self::from_halves(&halves[0], &halves[1])
    }

    /// Half the difference of two halves of equal length has the variance of their mean.
    fn from_halves(a: &[[f32; 3]], b: &[[f32; 3]]) -> Self {
        let mean = a.iter().zip(b).map(|(a, b)| std::array::from_fn(|c| 0.5 * (a[c] + b[c]))).collect();
        let mut reference = Self { mean, noise: [0.0; 3] };
        reference.noise =
            std::array::from_fn(|c| rel_mse(&reference, c, |i| f64::from(0.5 * (a[i][c] - b[i][c]))));
        reference
    }
}

fn path(bench: &BenchScene) -> PathBuf {
    // FNV-1a: a changed scene must not meet an old reference.
    let hash = bench
        .text
        .bytes()
        .fold(0xcbf2_9ce4_8422_2325u64, |h, b| (h ^ u64::from(b)).wrapping_mul(0x0100_0000_01b3));
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../bench-data/transport");
    PathBuf::from(folder).join(format!("{}-{hash:016x}.xyz", bench.name))
}
