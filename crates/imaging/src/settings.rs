//! How a picture is made from the film.

use crate::{Bloom, Diffraction, ImagingError, ToneMapping, WhiteBalance};
use indigo_film::{FilmSize, Filter, LightMix};
use std::sync::Arc;

/// All that a picture depends on besides the film.
#[derive(Clone, Debug)]
pub struct PictureSettings {
    /// How bright each group of lights is.
    pub lights: LightMix,
    /// Diffraction by the camera's aperture as a filter on the film's light.
    pub diffraction: Option<Arc<Diffraction>>,
    /// A glow round bright spots.
    pub bloom: Option<Bloom>,
    /// From light to display-linear values.
    pub tone_mapping: ToneMapping,
    /// What counts as white.
    pub white_balance: WhiteBalance,
    /// The filter from internal to output pixels, measured in output pixels; without effect where
    /// the film is not super-sampled. Its parameters must pass [`Filter::check`]; those outside
    /// [0, 1] may ring visibly.
    pub downsize: Filter,
    /// From luminance to the light that a pixel of the sensor gathers.
    pub exposure: Exposure,
    /// Show the coverage by the foreground as grey instead of the light.
    pub foreground_alpha: bool,
    /// The part of the picture that is rendered; the rest of it stays black. None: all of it.
    pub region: Option<Region>,
    /// Whether the program's name is drawn into the lower right corner.
    pub watermark: bool,
}

impl PictureSettings {
    /// A tone mapping and an exposure, and nothing else out of the ordinary.
    pub fn plain(tone_mapping: ToneMapping, exposure: Exposure) -> Self {
        Self {
            lights: LightMix::default(),
            diffraction: None,
            bloom: None,
            tone_mapping,
            white_balance: WhiteBalance::NONE,
            downsize: Filter::MN_DEFAULT,
            exposure,
            foreground_alpha: false,
            region: None,
            watermark: false,
        }
    }

    /// Does in advance what takes time and depends on a film's size alone. Runs on the caller's rayon pool.
    pub fn prepare(&self, film: FilmSize) {
        if let Some(diffraction) = &self.diffraction {
            diffraction.prepare(film, self.rendered(film));
        }
    }

    /// The part of a film's picture that is rendered.
    pub(crate) fn rendered(&self, film: FilmSize) -> Region {
        Region::or_whole(self.region, film)
    }
}

/// The facts of a camera that decide its exposure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Exposure {
    /// Area of the aperture's opening in m²: π r² for a circle of radius r.
    pub aperture_area: f64,
    /// Distance from lens to sensor in metres.
    pub lens_sensor_dist: f64,
    /// How long the shutter is open, in seconds.
    pub duration: f64,
}

impl Exposure {
    /// Exposure of the sensor in lux·s for a luminance of 1 cd/m²: the sensor sees the opening, of
    /// area A at a distance d, under the projected solid angle A / d².
    pub fn lux_seconds_per_nit(&self) -> f64 {
        self.aperture_area / (self.lens_sensor_dist * self.lens_sensor_dist) * self.duration
    }
}

/// A half-open rectangle of output pixels: x1 ≤ x < x2 and y1 ≤ y < y2.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Region {
    x1: u32,
    y1: u32,
    x2: u32,
    y2: u32,
}

impl Region {
    /// A region of a picture. Errors: it is empty, or leaves the picture.
    pub fn new([x1, y1]: [u32; 2], [x2, y2]: [u32; 2], size: FilmSize) -> Result<Self, ImagingError> {
        let (width, height) = (size.width(), size.height());
        if x1 < x2 && x2 <= width && y1 < y2 && y2 <= height {
            Ok(Self { x1, y1, x2, y2 })
        } else {
            Err(ImagingError::Region { x1, y1, x2, y2, width, height })
        }
    }

    /// The whole picture.
    pub fn whole(size: FilmSize) -> Self {
        Self { x1: 0, y1: 0, x2: size.width(), y2: size.height() }
    }

    /// A region if there is one, as far as it lies within a picture, should it have been made for another; else the whole.
    pub(crate) fn or_whole(region: Option<Self>, size: FilmSize) -> Self {
        let Some(Self { x1, y1, x2, y2 }) = region else { return Self::whole(size) };
        let (x2, y2) = (x2.min(size.width()), y2.min(size.height()));
        Self { x1: x1.min(x2), y1: y1.min(y2), x2, y2 }
    }

    /// First column and row.
    pub fn start(&self) -> [u32; 2] {
        [self.x1, self.y1]
    }

    /// The column and the row after the last.
    pub fn end(&self) -> [u32; 2] {
        [self.x2, self.y2]
    }
}
