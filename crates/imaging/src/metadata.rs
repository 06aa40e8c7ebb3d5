//! Facts about a render that travel inside its pictures.

use crate::{CameraFacts, ImagingError};
use std::fmt;

/// Keys and values, kept in the order in which they were added. Files hold them sorted by key.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Metadata {
    entries: Vec<(String, String)>,
    /// The camera, for formats that have attributes of their own for it.
    pub camera: Option<CameraFacts>,
    /// When the picture was taken, `YYYY:MM:DD hh:mm:ss` in UTC, for the same formats.
    pub captured: Option<String>,
}

impl Metadata {
    /// Adds a fact; a key that is there already gets the new value.
    pub fn set(&mut self, key: impl Into<String>, value: impl fmt::Display) {
        let (key, value) = (key.into(), format!("{value}"));
        match self.entries.iter_mut().find(|(k, _)| *k == key) {
            Some(entry) => entry.1 = value,
            None => self.entries.push((key, value)),
        }
    }

    /// The value of a key.
    pub fn get(&self, key: &str) -> Option<&str> {
        self.entries.iter().find(|(k, _)| k == key).map(|(_, v)| v.as_str())
    }

    /// Keys and values in order of addition.
    pub fn iter(&self) -> impl Iterator<Item = (&str, &str)> {
        self.entries.iter().map(|(k, v)| (k.as_str(), v.as_str()))
    }

    /// Keys and values sorted by key, all of which PNG and EXR can hold.
    pub(crate) fn sorted(&self) -> Result<Vec<(&str, &str)>, ImagingError> {
        let mut entries: Vec<_> = self.iter().collect();
        entries.sort_unstable();
        match entries.iter().find(|(key, value)| !storable(key, value)) {
            Some((key, _)) => Err(ImagingError::Metadata((*key).to_owned())),
            None => Ok(entries),
        }
    }
}

/// Whether PNG (1 to 79 printable characters, no space at the ends or beside another) and EXR hold
/// a key, and a value: all text without NUL.
fn storable(key: &str, value: &str) -> bool {
    (1..=79).contains(&key.len())
        && key.bytes().all(|b| (b' '..=b'~').contains(&b))
        && key.trim() == key
        && !key.contains("  ")
        && !value.contains('\0')
}

/// What a picture's metadata says of its render, under the keys that pictures of the format's
/// family have always had (`maxdepth` has no underscore, switches are 0 or 1, reals have five
/// decimals), and `height`, which they lack.
#[derive(Clone, Debug, PartialEq)]
pub struct RenderFacts {
    /// The program: name, version and platform.
    pub version: String,
    /// Path of the scene file, as given.
    pub scene_path: String,
    /// Width of the picture in pixels.
    pub width: u32,
    /// Height of the picture in pixels.
    pub height: u32,
    /// Internal pixels per output pixel along one axis.
    pub super_sample_factor: u32,
    /// Whether paths were traced from both ends.
    pub bidirectional: bool,
    /// Whether Markov chains drove the paths.
    pub metropolis: bool,
    /// Whether direct light was sampled apart from a Metropolis render of the rest.
    pub hybrid: bool,
    /// Probability of a large mutation.
    pub large_mutation_prob: f64,
    /// Largest change of a small mutation.
    pub max_change: f64,
    /// After so many rejections in a row a mutation is accepted.
    pub max_num_consec_rejections: u32,
    /// The most scattering events of a path.
    pub max_depth: u32,
    /// Threads that rendered.
    pub num_threads: u32,
    /// Samples of the whole picture.
    pub num_samples: f64,
    /// Seconds of rendering.
    pub elapsed_s: f64,
}

impl RenderFacts {
    /// The facts as metadata, to which more may be added.
    pub fn metadata(&self) -> Metadata {
        let pixels = f64::from(self.width) * f64::from(self.height);
        let per_second = if self.elapsed_s > 0.0 { self.num_samples / self.elapsed_s } else { 0.0 };
        let real = |v: f64| format!("{v:.5}");
        let mut all = Metadata::default();
        all.set("Indigo version used", &self.version);
        all.set("scene_file_path", &self.scene_path);
        all.set("width", self.width);
        all.set("height", self.height);
        all.set("super_sample_factor", self.super_sample_factor);
        all.set("bidirectional", u8::from(self.bidirectional));
        all.set("metropolis", u8::from(self.metropolis));
        all.set("hybrid", u8::from(self.hybrid));
        all.set("large_mutation_prob", real(self.large_mutation_prob));
        all.set("max_change", real(self.max_change));
        all.set("max_num_consec_rejections", self.max_num_consec_rejections);
        all.set("maxdepth", self.max_depth);
        all.set("num_threads", self.num_threads);
        all.set("num_samples", format!("{:.0}", self.num_samples));
        all.set("samples_per_pixel", real(self.num_samples / pixels));
        all.set("samples_per_sec", real(per_second));
        all.set("render time elapsed", real(self.elapsed_s));
        all
    }
}
