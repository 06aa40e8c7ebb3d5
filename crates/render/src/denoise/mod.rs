//! Denoising by Open Image Denoise, where the system has it.
//!
//! The library is loaded when it is asked for; nothing else depends on it. It is called with the picture in linear
//! Rec. 709 and cd/m² and, where they are known, with the reflectances and normals of what the pixels show.

mod library;

use indigo_film::FirstHit;
use indigo_imaging::LinearImage;
use indigo_imaging::layers::{Channel, first_hit_channels};
use library::{Input, Library};
use std::ffi::OsString;

/// Names the library's file, before all other places.
const VARIABLE: &str = "INDIGO_OIDN";

/// The names of version 2 on the systems that it is made for; the system knows where such files lie.
#[cfg(windows)]
const NAMES: &[&str] = &["OpenImageDenoise.dll"];
#[cfg(target_os = "macos")]
const NAMES: &[&str] = &["libOpenImageDenoise.2.dylib", "libOpenImageDenoise.dylib"];
#[cfg(not(any(windows, target_os = "macos")))]
const NAMES: &[&str] = &["libOpenImageDenoise.so.2", "libOpenImageDenoise.so"];

/// Why a picture could not be denoised.
#[derive(Debug, thiserror::Error)]
pub enum DenoiseError {
    /// No library, or one that lacks what is needed.
    #[error(
        "Open Image Denoise, version 2, was not found ({0}); install it, or name its file in the environment as \
         {VARIABLE}"
    )]
    NotFound(String),
    /// The library's own words.
    #[error("Open Image Denoise: {0}")]
    Failed(String),
}

/// The library, loaded.
pub struct Denoiser {
    library: Library,
}

impl Denoiser {
    /// Looks for the library.
    ///
    /// # Errors
    /// Where there is none that can be used.
    pub fn find() -> Result<Self, DenoiseError> {
        let named = std::env::var_os(VARIABLE);
        let candidates: Vec<OsString> = match named {
            Some(path) => vec![path],
            None => NAMES.iter().map(OsString::from).collect(),
        };
        let mut reasons = vec![];
        for candidate in candidates {
            match Library::load(&candidate) {
                Ok(library) => return Ok(Self { library }),
                Err(reason) => reasons.push(reason),
            }
        }
        Err(DenoiseError::NotFound(reasons.join("; ")))
    }

    /// Denoises a picture. Coverage stays as it is; colours come out without negative components, which the library does
    /// not know. `hits` are the pixels' own, or there are none.
    ///
    /// # Errors
    /// What the library says.
    pub fn denoise(
        &self,
        image: &LinearImage,
        hits: Option<&[FirstHit]>,
    ) -> Result<LinearImage, DenoiseError> {
        let colour: Vec<f32> = image.pixels.iter().flat_map(|p| [p[0], p[1], p[2]]).collect();
        let mut inputs = vec![Input { name: c"color", values: colour }];
        if let Some(hits) = hits.filter(|hits| hits.len() == image.pixels.len()) {
            // Albedo and normal are the first three channels, and the next.
            let channels = first_hit_channels(hits);
            inputs.push(Input { name: c"albedo", values: interleaved(&channels[0..3]) });
            inputs.push(Input { name: c"normal", values: interleaved(&channels[3..6]) });
        }
        let size = [image.width as usize, image.height as usize];
        let output = self.library.run(inputs, size).map_err(DenoiseError::Failed)?;
        let pixels = output.chunks_exact(3).zip(&image.pixels).map(|(rgb, p)| [rgb[0], rgb[1], rgb[2], p[3]]);
        Ok(LinearImage { width: image.width, height: image.height, pixels: pixels.collect() })
    }
}

fn interleaved(channels: &[Channel]) -> Vec<f32> {
    let pixels = channels.first().map_or(0, |c| c.values.len());
    (0..pixels).flat_map(|i| channels.iter().map(move |c| c.values[i])).collect()
}
