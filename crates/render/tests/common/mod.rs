//! Scenes from text in memory, rendered in small independent batches, and judged.
#![allow(dead_code, reason = "every test program uses its own part")]

pub mod again;
pub mod judge;
pub mod noise;
pub mod shapes;
pub mod small_sun;
pub mod starved;
pub mod text;
pub mod window;

use indigo_decl::{ResolveError, Resolved, Resolver};
use indigo_diag::{Style, to_text};
use indigo_film::FilmState;
use indigo_scene::{LoadOptions, MetropolisSettings, Scene, load};
use indigo_testkit::stats::Moments;
use indigo_transport::driver::Driver;
use std::collections::HashMap;
use std::fmt;

/// Files by name.
#[derive(Default)]
pub struct Files(pub HashMap<String, Vec<u8>>);

impl Resolver for Files {
    fn read(&self, path: &str, _from: &str) -> Result<Resolved, ResolveError> {
        match self.0.get(path) {
            Some(bytes) => Ok(Resolved { path: path.to_owned(), bytes: bytes.clone().into() }),
            None => Err(ResolveError::NotFound { looked: vec![path.to_owned()] }),
        }
    }
}

/// The scene of a text; every complaint but a warning ends the test with its message.
pub fn scene(text: &str) -> Scene {
    scene_with(text, [])
}

/// The scene of a text that names other files.
pub fn scene_with<'a>(text: &str, files: impl IntoIterator<Item = (&'a str, Vec<u8>)>) -> Scene {
    let mut files: HashMap<String, Vec<u8>> = files.into_iter().map(|(n, b)| (n.to_owned(), b)).collect();
    files.insert(again::SCENE.to_owned(), text.as_bytes().to_vec());
    let files = Files(files);
    let loaded = load(again::SCENE, &LoadOptions::new(&files));
    let complaints = || loaded.sink.diagnostics().iter().map(|d| to_text(d, &loaded.sources, Style::Plain));
    let scene =
        loaded.scene.unwrap_or_else(|| panic!("the scene has errors:\n{}", complaints().collect::<String>()));
    again::remember_scene(&scene, files.0.iter());
    scene
}

/// A film with `passes` samples for each output pixel.
pub fn film(scene: &Scene, seed: u64, passes: u64) -> FilmState {
    let driver = Driver::new(scene, seed);
    let mut film = FilmState::new(scene.film.size, driver.layers());
    let mut delta = film.delta();
    let mut tracer = driver.tracer();
    again::remember_render(scene, seed, driver.units(passes));
    for unit in 0..driver.units(passes) {
        driver.render_unit(scene, unit, &mut tracer, &mut delta);
        // Often enough that single precision loses nothing that these tests could see.
        if unit % 64 == 63 {
            film.merge(&delta).expect("made by this film");
            delta.clear();
        }
    }
    film.merge(&delta).expect("made by this film");
    assert_eq!(film.refused, 0, "contributions that are not finite");
    film
}

/// First and last (excluded) internal column and row.
pub type Region = [[usize; 2]; 2];

/// Mean X, Y, Z and alpha over a region of internal pixels.
pub fn mean(film: &FilmState, region: Region) -> [f64; 4] {
    let (layer, width) = (&film.layers[0], film.size.internal_width() as usize);
    let pixels =
        (region[1][0]..region[1][1]).flat_map(|y| (region[0][0]..region[0][1]).map(move |x| y * width + x));
    let (mut sum, mut count) = ([0.0; 4], 0.0);
    for i in pixels.clone() {
        count += layer.counts[i];
        for (s, v) in sum.iter_mut().zip(layer.sums[i]) {
            *s += v;
        }
    }
    let mut mean = sum.map(|s| s / count);
    // What light paths bring is in layers that are not averages of samples.
    if film.layers.len() > 1 {
        let rest = film.develop_layers(|name| name != layer.name);
        let pixels: Vec<usize> = pixels.collect();
        for (c, mean) in mean.iter_mut().enumerate().take(3) {
            *mean += pixels.iter().map(|&i| f64::from(rest.pixels[i][c])).sum::<f64>() / pixels.len() as f64;
        }
    }
    mean
}

/// The whole of a scene's film.
pub fn whole(scene: &Scene) -> Region {
    [[0, scene.film.size.internal_width() as usize], [0, scene.film.size.internal_height() as usize]]
}

/// Means over a region in independent renders of different seeds.
pub struct Measured {
    /// X, Y, Z in cd/m² and alpha.
    pub xyza: [Moments; 4],
}

impl Measured {
    /// Luminance in cd/m².
    pub fn luminance(&self) -> &Moments {
        &self.xyza[1]
    }
}

/// Renders `batches` times with `passes` samples per output pixel each, and measures the regions: XYZ of all layers, and
/// the alpha of camera paths.
pub fn measure_regions(scene: &Scene, regions: &[Region], batches: u64, passes: u64) -> Vec<Measured> {
    let mut measured: Vec<Measured> =
        regions.iter().map(|_| Measured { xyza: [Moments::default(); 4] }).collect();
    for seed in 0..batches {
        let film = film(scene, 1000 + seed, passes);
        for (m, &region) in measured.iter_mut().zip(regions) {
            for (moments, value) in m.xyza.iter_mut().zip(mean(&film, region)) {
                moments.add(value);
            }
        }
    }
    measured
}

/// [`measure_regions`] of the whole picture.
pub fn measure(scene: &Scene, batches: u64, passes: u64) -> Measured {
    measure_regions(scene, &[whole(scene)], batches, passes).remove(0)
}

/// A technique under a driver.
#[derive(Clone, Copy)]
pub struct Mode {
    pub bidirectional: bool,
    pub metropolis: bool,
}

/// All of them; the first is plain path tracing.
pub const MODES: [Mode; 4] = [mode(false, false), mode(true, false), mode(false, true), mode(true, true)];

const fn mode(bidirectional: bool, metropolis: bool) -> Mode {
    Mode { bidirectional, metropolis }
}

impl fmt::Display for Mode {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(if self.bidirectional { "bidirectional" } else { "path" })?;
        f.write_str(if self.metropolis { ", Metropolis" } else { "" })
    }
}

impl Mode {
    /// Makes a scene render in this mode.
    pub fn set(self, scene: &mut Scene) {
        scene.transport.bidirectional = self.bidirectional;
        scene.transport.metropolis = self.metropolis.then_some(MetropolisSettings {
            large_mutation_prob: 0.5,
            max_change: 0.02,
            // What the manual's finite default does is a bias, if a tiny one.
            max_consecutive_rejections: i64::MAX,
        });
    }
}

/// Mean luminances of developed pictures in a mode.
pub fn luminance_in_mode(scene: &mut Scene, mode: Mode, batches: u64, passes: u64) -> Moments {
    xyz_in_mode(scene, mode, batches, passes)[1]
}

/// Mean X, Y and Z of developed pictures in a mode: of all layers of the film.
pub fn xyz_in_mode(scene: &mut Scene, mode: Mode, batches: u64, passes: u64) -> [Moments; 3] {
    mode.set(scene);
    let mut measured = [Moments::default(); 3];
    for seed in 0..batches {
        let picture = film(scene, 7000 + seed, passes).develop();
        for (c, moments) in measured.iter_mut().enumerate() {
            let sum: f64 = picture.pixels.iter().map(|p| f64::from(p[c])).sum();
            moments.add(sum / picture.pixels.len() as f64);
        }
    }
    measured
}
