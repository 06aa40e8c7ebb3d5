//! Saving pictures: developed from a copy of the film, on a thread of their own.

mod metadata;
mod one;
mod paths;

pub use one::save_film_as;
pub use paths::{OutputPaths, PicturePaths};

use crate::atomic::{check_writable, write_atomically};
use crate::denoise::{DenoiseError, Denoiser};
use crate::first_hits::SceneFirstHits;
use crate::pool::with_jobs;
use indigo_film::{DevelopedFilm, FilmRecord, FilmState, Filter, SavedFilm, XyzImage, igi, mix};
use indigo_imaging::{
    Content, Exposure, ImagingError, LinearImage, Metadata, Picture, PictureSettings, ToneMapping, coverage,
    develop_image, exr, from_linear, layers, linear_picture, on_sensor, png, untonemapped,
};
use indigo_scene::{Development, Scene};
use indigo_transport::driver::{is_background, is_indirect};
use indigo_transport::strategies::Strategies;
use std::fs::File;
use std::io::{BufWriter, Write as _};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::thread::JoinHandle;

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
    /// Those that were there before and stay: a film without samples takes nothing's place.
    pub kept: Vec<PathBuf>,
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
        Self { failures: vec![error], ..Self::default() }
    }
}

/// One of the files that can be made of a film.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OneFile {
    /// The picture as PNG.
    Picture,
    /// The luminances as EXR.
    Luminances,
    /// The film.
    Film,
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
    /// disk that is nearly full a small picture is kept where the film has no room. A film without samples, and its black picture,
    /// take no other's place: the render before may be that of a night.
    pub fn save(&self, saved: &SavedFilm) -> Saved {
        with_jobs(self.threads, || self.save_on_pool(saved))
    }

    fn save_on_pool(&self, saved: &SavedFilm) -> Saved {
        let is_blank = saved.record.as_ref().is_some_and(|record| record.samples == 0);
        let kept: Vec<PathBuf> = self.files().filter(|path| is_blank && has_content(path)).collect();
        if !kept.is_empty() {
            return Saved { kept, ..Saved::default() };
        }
        let mut all = Saved::default();
        // First what cannot be made again.
        if let (true, Some(record)) = (self.development.output.igi, &saved.record) {
            all.add(write_film(&self.paths.igi(), &saved.film, record));
        }
        let light = saved.film.develop_mixed(&self.development.picture.lights, |_| true);
        self.save_light(light, saved.record.as_ref(), Some(&saved.film), &mut all);
        all
    }

    /// Writes the files of a film that is developed already, but neither the film nor what its layers tell.
    pub fn save_developed(&self, film: DevelopedFilm) -> Saved {
        with_jobs(self.threads, || {
            let mut all = Saved::default();
            self.save_light(film.image, film.record.as_ref(), None, &mut all);
            all
        })
    }

    /// Writes the pictures of a film's light; those of its layers, too, where it is there.
    fn save_light(
        &self,
        light: XyzImage,
        record: Option<&FilmRecord>,
        film: Option<&FilmState>,
        all: &mut Saved,
    ) {
        let (settings, output) = (&self.development.picture, &self.development.output);
        let denoiser = self.active_denoiser();
        let noisy = denoiser.map(|_| light.clone());
        let metadata = metadata::of(self, light.size, record);
        let image = on_sensor(light, settings);
        self.write_pictures(&image, &metadata, &self.paths.pictures(), all);
        if let (true, Some(hits), Some(film)) = (output.layers_exr, &self.first_hits, film) {
            all.add(self.write_layers(&image, film, hits, &metadata));
        }
        if let (Some(denoiser), Some(noisy)) = (denoiser, &noisy) {
            match self.denoised(noisy, denoiser) {
                Ok(light) => {
                    let mut metadata = metadata;
                    metadata.set("denoised", "by Open Image Denoise");
                    let image = on_sensor(light, settings);
                    self.write_pictures(&image, &metadata, &self.paths.denoised(), all);
                }
                Err(error) => all.failures.push(error),
            }
        }
    }

    /// What denoises, if anything is to be: coverage has no noise worth it.
    fn active_denoiser(&self) -> Option<&Denoiser> {
        let Development { picture, output, .. } = &self.development;
        self.denoiser.as_deref().filter(|_| output.denoised && !picture.foreground_alpha)
    }

    /// Writes the pictures of the light on the sensor.
    fn write_pictures(&self, image: &XyzImage, metadata: &Metadata, paths: &PicturePaths, all: &mut Saved) {
        let Development { picture: settings, output, .. } = &self.development;
        let picture = develop_image(image, settings);
        let shown =
            said(metadata, if settings.foreground_alpha { Content::Coverage } else { Content::Developed });
        all.add(encoded(&paths.png, png::encode(&picture, &shown, output.png)));
        if output.untonemapped_exr {
            let linear = linear_picture(image, settings);
            let bytes = if settings.foreground_alpha {
                exr::encode_display_linear(&linear, &shown)
            } else {
                exr::encode(&linear, &said(metadata, Content::Luminances))
            };
            all.add(encoded(&paths.untonemapped_exr, bytes));
        }
        if output.tonemapped_exr {
            let bytes = exr::encode_display_linear(&as_linear(&picture), &shown);
            all.add(encoded(&paths.tonemapped_exr, bytes));
        }
    }

    fn write_layers(
        &self,
        image: &XyzImage,
        film: &FilmState,
        hits: &SceneFirstHits,
        metadata: &Metadata,
    ) -> Result<PathBuf, SaveError> {
        let settings = &self.development.picture;
        let linear = linear_picture(image, settings);
        let mut channels = layers::rgb_channels(&linear);
        if !settings.foreground_alpha {
            // Not the film's coverage: what light paths and Markov chains add to a film has none.
            let mut foreground = self.part(film, |layer| !is_background(layer));
            let coverage = coverage(film.size, hits.weights(), settings.downsize, settings.region);
            foreground.pixels.iter_mut().zip(coverage).for_each(|(pixel, covered)| pixel[3] = covered);
            channels.extend(layers::foreground_channels(&foreground));
            channels.extend(layers::background_channels(&self.part(film, is_background)));
            channels.extend(layers::direct_channels(&self.part(film, |layer| !is_indirect(layer))));
            channels.extend(layers::indirect_channels(&self.part(film, is_indirect)));
            for (number, group) in settings.lights.0.iter().enumerate() {
                let light = self.part(film, |layer| mix::split(layer).1 == Some(&group.name));
                channels.extend(layers::light_channels(number, &light));
            }
        }
        channels.extend(layers::first_hit_channels(hits.get()));
        let content = if settings.foreground_alpha { Content::Coverage } else { Content::Luminances };
        let mut metadata = said(metadata, content);
        metadata.set("object_names", layers::manifest(hits.names().objects.iter().map(|name| &**name)));
        metadata.set("material_names", layers::manifest(hits.names().materials.iter().map(|name| &**name)));
        if !settings.lights.0.is_empty() {
            let names = settings.lights.0.iter().map(|group| &*group.name);
            metadata.set("light_names", layers::manifest(names));
        }
        let bytes = exr::encode_layers([linear.width, linear.height], channels, &metadata, content)?;
        write(&self.paths.layers_exr(), &bytes)
    }

    /// The linear picture of some of a film's layers.
    fn part(&self, film: &FilmState, is_wanted: impl Fn(&str) -> bool) -> LinearImage {
        let settings = &self.development.picture;
        let image = on_sensor(film.develop_mixed(&settings.lights, is_wanted), settings);
        untonemapped(&image, settings.downsize, settings.region)
    }

    /// A film's light denoised, before it is developed as ever, with diffraction by the aperture.
    ///
    /// A denoiser takes what neighbouring pixels share for a part of the picture: so it gets plain means over output pixels,
    /// which have noise of their own each, neither blurred by diffraction nor by the downsize filter.
    fn denoised(&self, film: &XyzImage, denoiser: &Denoiser) -> Result<XyzImage, SaveError> {
        let hits = self.first_hits.as_ref().map(|hits| hits.get());
        let noisy = untonemapped(film, Filter::Box, self.development.picture.region);
        from_linear(&denoiser.denoise(&noisy, hits)?).map_err(|e| SaveError::Thread(e.to_string()))
    }

    /// The files that it writes.
    pub fn files(&self) -> impl Iterator<Item = PathBuf> {
        let output = &self.development.output;
        let pictures = |paths: PicturePaths| {
            [
                (true, paths.png),
                (output.untonemapped_exr, paths.untonemapped_exr),
                (output.tonemapped_exr, paths.tonemapped_exr),
            ]
        };
        let mut wanted = vec![
            (output.igi, self.paths.igi()),
            (output.layers_exr && self.first_hits.is_some(), self.paths.layers_exr()),
        ];
        wanted.extend(pictures(self.paths.pictures()));
        if self.active_denoiser().is_some() {
            wanted.extend(pictures(self.paths.denoised()));
        }
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

/// Whether a file is there that is not empty, as one is that only keeps a name.
fn has_content(path: &Path) -> bool {
    std::fs::metadata(path).is_ok_and(|meta| meta.is_file() && meta.len() > 0)
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

/// The metadata of a file with that content.
fn said(metadata: &Metadata, content: Content) -> Metadata {
    let mut metadata = metadata.clone();
    metadata.set("content", content);
    metadata
}

fn as_linear(picture: &Picture) -> LinearImage {
    LinearImage { width: picture.width, height: picture.height, pixels: picture.pixels.clone() }
}
