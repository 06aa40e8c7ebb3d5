//! Saving pictures: developed from a copy of the film, on a thread of their own.

use crate::Progress;
use crate::disk::write_atomically;
use crate::pool::with_jobs;
use indigo_film::FilmState;
use indigo_imaging::{
    ImagingError, LinearImage, Metadata, Picture, RenderFacts, develop_image, exr, on_sensor, png,
    untonemapped,
};
use indigo_scene::Scene;
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

/// What a picture is saved with besides the film.
#[derive(Clone)]
pub struct SaveJob {
    /// The scene: how to develop, and what to write.
    pub scene: Arc<Scene>,
    /// Where to.
    pub paths: OutputPaths,
    /// Name, version and platform of the program.
    pub version: String,
    /// Threads that render.
    pub threads: usize,
    /// Seed of the render.
    pub seed: u64,
}

impl SaveJob {
    /// Develops a film and writes all files that the scene asks for; returns their paths.
    ///
    /// # Errors
    /// The first file that could not be written; the files before it are complete.
    pub fn save(&self, film: &FilmState, progress: &Progress) -> Result<Vec<PathBuf>, SaveError> {
        with_jobs(self.threads, || self.save_on_pool(film, progress))
    }

    fn save_on_pool(&self, film: &FilmState, progress: &Progress) -> Result<Vec<PathBuf>, SaveError> {
        let (scene, output) = (&self.scene, &self.scene.output);
        let image = on_sensor(film.develop(), &scene.picture);
        let metadata = self.metadata(progress);
        let picture = develop_image(&image, &scene.picture);
        let png = png::encode(&picture, &metadata, png::Depth::Eight)?;
        let mut written = vec![write(&self.paths.png, &png)?];
        if output.untonemapped_exr {
            let linear = untonemapped(&image, scene.picture.downsize, scene.picture.region);
            written.push(write(&self.paths.untonemapped_exr(), &exr::encode(&linear, &metadata)?)?);
        }
        if output.tonemapped_exr {
            let linear = as_linear(&picture);
            written.push(write(&self.paths.tonemapped_exr(), &exr::encode(&linear, &metadata)?)?);
        }
        Ok(written)
    }

    fn metadata(&self, progress: &Progress) -> Metadata {
        let scene = &self.scene;
        let (size, transport) = (scene.film.size, &scene.transport);
        let mut metadata = RenderFacts {
            version: self.version.clone(),
            scene_path: scene.output.scene_path.clone(),
            width: size.width(),
            height: size.height(),
            super_sample_factor: size.super_sample(),
            bidirectional: transport.bidirectional,
            metropolis: transport.metropolis.is_some(),
            hybrid: transport.hybrid,
            // Without Metropolis sampling nothing is mutated: 0.
            large_mutation_prob: transport.metropolis.map_or(0.0, |m| m.large_mutation_prob),
            max_change: transport.metropolis.map_or(0.0, |m| f64::from(m.max_change)),
            max_num_consec_rejections: transport
                .metropolis
                .map_or(0, |m| u32::try_from(m.max_consecutive_rejections).unwrap_or(u32::MAX)),
            max_depth: transport.max_depth,
            num_threads: self.threads as u32,
            num_samples: progress.samples as f64,
            elapsed_s: progress.elapsed.as_secs_f64(),
        }
        .metadata();
        metadata.set("seed", self.seed);
        metadata.set("aperture_area", scene.picture.exposure.aperture_area);
        metadata.set("lens_sensor_dist", scene.picture.exposure.lens_sensor_dist);
        metadata.set("exposure_duration", scene.picture.exposure.duration);
        metadata
    }

    /// Starts [`save`](Self::save) on a thread of its own.
    ///
    /// # Errors
    /// Where the system gives no thread.
    pub fn spawn(&self, film: FilmState, progress: Progress) -> Result<Saving, SaveError> {
        let job = self.clone();
        let thread = std::thread::Builder::new().name("save".to_owned());
        let handle =
            thread.spawn(move || job.save(&film, &progress)).map_err(|e| SaveError::Thread(e.to_string()))?;
        Ok(Saving { handle })
    }
}

/// A picture being saved.
pub struct Saving {
    handle: JoinHandle<Result<Vec<PathBuf>, SaveError>>,
}

impl Saving {
    /// Whether it is done, well or badly.
    pub fn is_finished(&self) -> bool {
        self.handle.is_finished()
    }

    /// Waits for the end.
    ///
    /// # Errors
    /// As [`SaveJob::save`].
    pub fn finish(self) -> Result<Vec<PathBuf>, SaveError> {
        self.handle
            .join()
            .unwrap_or_else(|_| Err(SaveError::Thread("the thread that saves failed".to_owned())))
    }
}

fn write(path: &Path, bytes: &[u8]) -> Result<PathBuf, SaveError> {
    write_atomically(path, bytes).map_err(|source| SaveError::Write { path: path.to_path_buf(), source })?;
    Ok(path.to_path_buf())
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
    }
}
