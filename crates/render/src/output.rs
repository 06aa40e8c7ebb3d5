//! Saving pictures: developed from a copy of the film, on a thread of their own.

use crate::atomic::{check_writable, write_atomically};
use crate::denoise::{DenoiseError, Denoiser};
use crate::first_hits::SceneFirstHits;
use crate::pool::with_jobs;
use indigo_film::{FilmRecord, FilmState, Filter, FirstHit, SavedFilm, XyzImage, igi};
use indigo_imaging::{
    Exposure, ImagingError, LinearImage, Metadata, Picture, PictureSettings, RenderFacts, ToneMapping,
    develop_image, exr, from_linear, layers, on_sensor, png, untonemapped,
};
use indigo_scene::{Development, Scene};
use indigo_transport::driver::is_indirect;
use indigo_transport::strategies::Strategies;
use std::fs::File;
use std::io::{BufWriter, Write as _};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::thread::JoinHandle;

/// Where pictures go.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct OutputPaths {
    /// The PNG.
    pub png: PathBuf,
}

impl OutputPaths {
    /// From the path of the PNG; its siblings share its stem.
    pub fn new(png: impl Into<PathBuf>) -> Self {
        Self { png: png.into() }
    }

    /// The EXR of luminances.
    pub fn untonemapped_exr(&self) -> PathBuf {
        self.sibling("_untonemapped.exr")
    }

    /// The EXR of the developed picture.
    pub fn tonemapped_exr(&self) -> PathBuf {
        self.sibling("_tonemapped.exr")
    }

    /// The EXR with layers.
    pub fn layers_exr(&self) -> PathBuf {
        self.sibling("_layers.exr")
    }

    /// The denoised PNG.
    pub fn denoised(&self) -> PathBuf {
        self.sibling("_denoised.png")
    }

    /// The film.
    pub fn igi(&self) -> PathBuf {
        self.sibling(".igi")
    }

    fn sibling(&self, ending: &str) -> PathBuf {
        let stem = self.png.file_stem().unwrap_or_default().to_string_lossy();
        self.png.with_file_name(format!("{stem}{ending}"))
    }
}

/// Why a picture could not be saved.
#[derive(Debug, thiserror::Error)]
pub enum SaveError {
    /// The picture cannot be encoded.
    #[error(transparent)]
    Encode(#[from] ImagingError),
    /// The picture cannot be denoised.
    #[error(transparent)]
    Denoise(#[from] DenoiseError),
    /// The file cannot be written.
    #[error("cannot write {}: {source}", .path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// The thread that saves could not start, or failed.
    #[error("the picture could not be saved: {0}")]
    Thread(String),
}

/// What became of the files of a picture.
#[derive(Debug, Default)]
pub struct Saved {
    /// Those that are complete.
    pub written: Vec<PathBuf>,
    /// Why the others are not; what was there of them before still is.
    pub failures: Vec<SaveError>,
}

impl Saved {
    fn add(&mut self, result: Result<PathBuf, SaveError>) {
        match result {
            Ok(path) => self.written.push(path),
            Err(error) => self.failures.push(error),
        }
    }
}

impl From<SaveError> for Saved {
    fn from(error: SaveError) -> Self {
        Self { written: vec![], failures: vec![error] }
    }
}

/// What a picture is saved with besides the film.
#[derive(Clone)]
pub struct SaveJob {
    /// How to develop, and what to write.
    pub development: Development,
    /// Where to.
    pub paths: OutputPaths,
    /// Name, version and platform of the program.
    pub version: String,
    /// Threads that render or develop.
    pub threads: usize,
    /// What the pixels show, for layers and denoising; without it there are no layers.
    pub first_hits: Option<Arc<SceneFirstHits>>,
    /// What denoises; without it nothing is.
    pub denoiser: Option<Arc<Denoiser>>,
}

impl SaveJob {
    /// Develops a film and writes all files that the scene asks for. What one of them costs the others do not pay: on a
    /// disk that is nearly full a small picture is kept where the film has no room.
    pub fn save(&self, saved: &SavedFilm) -> Saved {
        with_jobs(self.threads, || self.save_on_pool(saved))
    }

    fn save_on_pool(&self, saved: &SavedFilm) -> Saved {
        let (settings, output) = (&self.development.picture, &self.development.output);
        let mut all = Saved::default();
        // First what cannot be made again.
        if let (true, Some(record)) = (output.igi, &saved.record) {
            all.add(write_film(&self.paths.igi(), &saved.film, record));
        }
        let image = on_sensor(saved.film.develop(), settings);
        let metadata = self.metadata(saved);
        let picture = develop_image(&image, settings);
        all.add(encoded(&self.paths.png, png::encode(&picture, &metadata, output.png)));
        let linear = || untonemapped(&image, settings.downsize, settings.region);
        if output.untonemapped_exr {
            all.add(encoded(&self.paths.untonemapped_exr(), exr::encode(&linear(), &metadata)));
        }
        if output.tonemapped_exr {
            let bytes = exr::encode_display_linear(&as_linear(&picture), &metadata);
            all.add(encoded(&self.paths.tonemapped_exr(), bytes));
        }
        if let (true, Some(hits)) = (output.layers_exr, &self.first_hits) {
            all.add(self.write_layers(linear(), &saved.film, hits.get(), &metadata));
        }
        if let (true, Some(denoiser)) = (output.denoised, &self.denoiser) {
            all.add(self.write_denoised(&saved.film.develop(), denoiser, &metadata));
        }
        all
    }

    fn write_layers(
        &self,
        mut linear: LinearImage,
        film: &FilmState,
        hits: &[FirstHit],
        metadata: &Metadata,
    ) -> Result<PathBuf, SaveError> {
        // Not the film's coverage: what light paths and Markov chains add to a film has none.
        linear.pixels.iter_mut().zip(hits).for_each(|(pixel, hit)| pixel[3] = hit.coverage);
        let mut channels = layers::picture_channels(&linear);
        channels.extend(layers::direct_channels(&self.part(film, |layer| !is_indirect(layer))));
        channels.extend(layers::indirect_channels(&self.part(film, is_indirect)));
        channels.extend(layers::first_hit_channels(hits));
        let bytes = exr::encode_layers([linear.width, linear.height], channels, metadata)?;
        write(&self.paths.layers_exr(), &bytes)
    }

    /// The linear picture of some of a film's layers.
    fn part(&self, film: &FilmState, is_wanted: impl Fn(&str) -> bool) -> LinearImage {
        let settings = &self.development.picture;
        let image = on_sensor(film.develop_layers(is_wanted), settings);
        untonemapped(&image, settings.downsize, settings.region)
    }

    /// The film's light is denoised, and then developed as ever, with diffraction by the aperture.
    ///
    /// A denoiser takes what neighbouring pixels share for a part of the picture: so it gets plain means over output pixels,
    /// which have noise of their own each, neither blurred by diffraction nor by the downsize filter.
    fn write_denoised(
        &self,
        film: &XyzImage,
        denoiser: &Denoiser,
        metadata: &Metadata,
    ) -> Result<PathBuf, SaveError> {
        let Development { picture: settings, output, .. } = &self.development;
        let hits = self.first_hits.as_ref().map(|hits| hits.get());
        let clean = denoiser.denoise(&untonemapped(film, Filter::Box, settings.region), hits)?;
        let light = from_linear(&clean).map_err(|e| SaveError::Thread(e.to_string()))?;
        let image = on_sensor(light, settings);
        let png = png::encode(&develop_image(&image, settings), metadata, output.png)?;
        write(&self.paths.denoised(), &png)
    }

    /// The files that it writes.
    pub fn files(&self) -> impl Iterator<Item = PathBuf> {
        let output = &self.development.output;
        let wanted = [
            (true, self.paths.png.clone()),
            (output.igi, self.paths.igi()),
            (output.untonemapped_exr, self.paths.untonemapped_exr()),
            (output.tonemapped_exr, self.paths.tonemapped_exr()),
            (output.layers_exr && self.first_hits.is_some(), self.paths.layers_exr()),
            (output.denoised && self.denoiser.is_some(), self.paths.denoised()),
        ];
        wanted.into_iter().filter(|(is_wanted, _)| *is_wanted).map(|(_, path)| path)
    }

    /// Whether all files could be written.
    ///
    /// # Errors
    /// The first file that could not.
    pub fn check_writable(&self) -> Result<(), SaveError> {
        for path in self.files() {
            check_writable(&path).map_err(|source| SaveError::Write { path, source })?;
        }
        Ok(())
    }

    fn metadata(&self, saved: &SavedFilm) -> Metadata {
        let Development { transport, picture, output, .. } = &self.development;
        let size = saved.film.size;
        let nothing = FilmRecord::default();
        let record = saved.record.as_ref().unwrap_or(&nothing);
        let metropolis = transport.metropolis;
        let mut metadata = RenderFacts {
            version: self.version.clone(),
            scene_path: output.scene_path.clone(),
            width: size.width(),
            height: size.height(),
            super_sample_factor: size.super_sample(),
            bidirectional: transport.bidirectional,
            // Without Metropolis sampling nothing is mutated: 0.
            metropolis: metropolis.is_some(),
            hybrid: transport.hybrid,
            large_mutation_prob: metropolis.map_or(0.0, |m| m.large_mutation_prob),
            max_change: metropolis.map_or(0.0, |m| f64::from(m.max_change)),
            max_num_consec_rejections: metropolis
                .map_or(0, |m| u32::try_from(m.max_consecutive_rejections).unwrap_or(u32::MAX)),
            max_depth: transport.max_depth,
            num_threads: self.threads as u32,
            num_samples: record.samples as f64,
            elapsed_s: record.elapsed_s,
        }
        .metadata();
        let seeds: Vec<String> = record.runs.iter().map(|run| run.seed.to_string()).collect();
        metadata.set("seed", seeds.join(" "));
        metadata.set("aperture_area", picture.exposure.aperture_area);
        metadata.set("lens_sensor_dist", picture.exposure.lens_sensor_dist);
        metadata.set("exposure_duration", picture.exposure.duration);
        metadata
    }

    /// Starts [`save`](Self::save) on a thread of its own.
    ///
    /// # Errors
    /// Where the system gives no thread.
    pub fn spawn(&self, saved: SavedFilm) -> Result<Saving, SaveError> {
        let job = self.clone();
        let thread = std::thread::Builder::new().name("save".to_owned());
        let handle = thread.spawn(move || job.save(&saved)).map_err(|e| SaveError::Thread(e.to_string()))?;
        Ok(Saving { handle })
    }
}

/// A picture being saved.
pub struct Saving {
    handle: JoinHandle<Saved>,
}

impl Saving {
    /// Whether it is done, well or badly.
    pub fn is_finished(&self) -> bool {
        self.handle.is_finished()
    }

    /// Waits for the end.
    pub fn finish(self) -> Saved {
        let failed = || SaveError::Thread("the thread that saves failed".to_owned());
        self.handle.join().unwrap_or_else(|_| failed().into())
    }
}

/// Writes a picture if it could be encoded.
fn encoded(path: &Path, bytes: Result<Vec<u8>, ImagingError>) -> Result<PathBuf, SaveError> {
    write(path, &bytes?)
}

fn write(path: &Path, bytes: &[u8]) -> Result<PathBuf, SaveError> {
    write_with(path, |file| file.write_all(bytes))
}

/// Writes a film with its record.
///
/// # Errors
/// What the system says; a file that was there before is untouched then.
pub fn write_film(path: &Path, film: &FilmState, record: &FilmRecord) -> Result<PathBuf, SaveError> {
    write_with(path, |file| igi::write(file, film, record))
}

fn write_with(
    path: &Path,
    write: impl Fn(&mut BufWriter<&File>) -> std::io::Result<()>,
) -> Result<PathBuf, SaveError> {
    write_atomically(path, write).map_err(|source| SaveError::Write { path: path.to_path_buf(), source })?;
    Ok(path.to_path_buf())
}

/// Writes what each strategy of bidirectional path tracing adds to a scene's picture, as [`Strategies::pyramids`] shows
/// it, to a PNG.
///
/// # Errors
/// A picture that could not be encoded or written.
pub fn write_strategies(scene: &Scene, seed: u64, passes: u32, path: &Path) -> Result<PathBuf, SaveError> {
    let image =
        Strategies::gather(scene, seed, passes).pyramids().map_err(|e| SaveError::Thread(e.to_string()))?;
    // A quarter of full white for the mean of a row: twice as bright as print, since what is dark matters here.
    let linear = ToneMapping::Linear { scale: 0.25 };
    let exposure = Exposure { aperture_area: 1.0, lens_sensor_dist: 1.0, duration: 1.0 };
    let picture = develop_image(&image, &PictureSettings::plain(linear, exposure));
    write(path, &png::encode(&picture, &Metadata::default(), png::Format::default())?)
}

fn as_linear(picture: &Picture) -> LinearImage {
    LinearImage { width: picture.width, height: picture.height, pixels: picture.pixels.clone() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn siblings_share_the_stem() {
        let paths = OutputPaths::new("out/x.y.png");
        assert_eq!(paths.untonemapped_exr(), Path::new("out/x.y_untonemapped.exr"));
        assert_eq!(paths.tonemapped_exr(), Path::new("out/x.y_tonemapped.exr"));
        assert_eq!(paths.layers_exr(), Path::new("out/x.y_layers.exr"));
        assert_eq!(paths.denoised(), Path::new("out/x.y_denoised.png"));
        assert_eq!(paths.igi(), Path::new("out/x.y.igi"));
    }
}
