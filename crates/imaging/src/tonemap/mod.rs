//! Tone mapping: from the light on the sensor to what a display can show.

mod camera;
mod linear;
mod reinhard;

pub use camera::Response;

use crate::PictureSettings;
use camera::Camera;
use linear::Linear;
use reinhard::Reinhard;
use std::sync::Arc;

/// How light becomes display-linear values.
#[derive(Clone, Debug, PartialEq)]
pub enum ToneMapping {
    /// scale · H, where H is the white-balanced exposure in lux·s.
    Linear {
        /// The factor, at least 0.
        scale: f64,
    },
    /// The global operator of Reinhard et al., "Photographic Tone Reproduction for Digital
    /// Images", SIGGRAPH 2002, section 3.1. It adapts itself to the picture, so the exposure has no
    /// part in it.
    Reinhard {
        /// Luminance of the picture's log average before compression: the paper's key a.
        pre_scale: f64,
        /// Factor after compression.
        post_scale: f64,
        /// The scaled luminance that becomes white, unless the picture's largest is less.
        burn: f64,
    },
    /// Exposure and speed of the film, through the response of film or sensor.
    Camera {
        /// The response.
        response: Arc<Response>,
        /// Each step of 1 doubles the exposure.
        ev_adjust: f64,
        /// ISO speed, above 0.
        film_iso: f64,
    },
}

/// A tone mapping with its numbers worked out for one film.
pub(crate) enum ToneMapper {
    Linear(Linear),
    Reinhard(Reinhard),
    Camera(Camera),
}

impl ToneMapper {
    /// Prepares the settings' tone mapping for the rows (XYZ and alpha) that it will be given.
    pub(crate) fn new<'a, R>(settings: &PictureSettings, rows: R) -> Self
    where
        R: rayon::iter::IndexedParallelIterator<Item = &'a [[f32; 4]]>,
    {
        match &settings.tone_mapping {
            ToneMapping::Linear { scale } => Self::Linear(Linear::new(*scale, settings)),
            ToneMapping::Reinhard { pre_scale, post_scale, burn } => {
                let parameters = [*pre_scale, *post_scale, *burn];
                Self::Reinhard(Reinhard::new(parameters, settings.white_balance, rows))
            }
            ToneMapping::Camera { response, ev_adjust, film_iso } => {
                Self::Camera(Camera::new(response, *ev_adjust, *film_iso, settings))
            }
        }
    }

    /// Maps a row of XYZ and alpha to display-linear RGB, not clamped, and alpha.
    pub(crate) fn map_row(&self, from: &[[f32; 4]], to: &mut [[f32; 4]]) {
        match self {
            Self::Linear(linear) => linear.map_row(from, to),
            Self::Reinhard(reinhard) => reinhard.map_row(from, to),
            Self::Camera(camera) => camera.map_row(from, to),
        }
    }
}
