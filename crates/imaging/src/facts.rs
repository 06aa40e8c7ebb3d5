//! How a picture was developed, as its metadata tell it: in the words of scenes, so that of several developments of one
//! film each can be made again.

use crate::{Metadata, PictureSettings, ToneMapping};
use std::fmt;

/// What the pixels of a file are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Content {
    /// What the tone mapping shows.
    Developed,
    /// The light on the sensor in cd/m², as linear Rec. 709.
    Luminances,
    /// Coverage by the foreground.
    Coverage,
}

impl fmt::Display for Content {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Developed => "the developed picture",
            Self::Luminances => "luminances in cd/m², without tone mapping, white balance and exposure",
            Self::Coverage => "coverage by the foreground, from 0 to 1",
        })
    }
}

impl fmt::Display for ToneMapping {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Linear { scale } => write!(f, "linear with scale {scale}"),
            Self::Reinhard { pre_scale, post_scale, burn } => {
                write!(f, "reinhard with pre_scale {pre_scale}, post_scale {post_scale}, burn {burn}")
            }
            Self::Camera { response, ev_adjust, film_iso } => {
                write!(f, "camera with ev_adjust {ev_adjust}, film_iso {film_iso}, ")?;
                match response.name() {
                    "" => f.write_str("no response_function_path"),
                    name => write!(f, "response_function_path {name}"),
                }
            }
        }
    }
}

impl PictureSettings {
    /// Says how the pictures of a film are developed.
    pub fn describe(&self, metadata: &mut Metadata) {
        metadata.set("downsize_filter", self.downsize);
        if let Some(region) = self.region {
            let ([x1, y1], [x2, y2]) = (region.start(), region.end());
            metadata.set("render_region", format!("x1 {x1}, y1 {y1}, x2 {x2}, y2 {y2}"));
        }
        metadata.set("watermark", u8::from(self.watermark));
        if self.foreground_alpha {
            return;
        }
        metadata.set("tone_mapping", &self.tone_mapping);
        metadata.set("white_balance", self.white_balance);
        metadata.set("aperture_diffraction", if self.diffraction.is_some() { "as a filter" } else { "none" });
        if let Some(bloom) = self.bloom {
            metadata.set("bloom", format!("weight {}, radius {}", bloom.weight, bloom.radius));
        }
    }

    /// The ISO speed of the film, if the tone mapping has one.
    pub fn film_iso(&self) -> Option<f64> {
        match self.tone_mapping {
            ToneMapping::Camera { film_iso, .. } => Some(film_iso),
            ToneMapping::Linear { .. } | ToneMapping::Reinhard { .. } => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Bloom, Exposure, Region, Response, WhiteBalance};
    use indigo_film::{FilmSize, Filter};
    use std::sync::Arc;

    fn said(settings: &PictureSettings) -> Vec<(String, String)> {
        let mut metadata = Metadata::default();
        settings.describe(&mut metadata);
        metadata.iter().map(|(key, value)| (key.to_owned(), value.to_owned())).collect()
    }

    #[test]
    fn every_part_of_a_development_is_told() {
        let exposure = Exposure { aperture_area: 1.0, lens_sensor_dist: 1.0, duration: 1.0 };
        let response = Arc::new(Response::display().named("data/film.txt"));
        let camera = ToneMapping::Camera { response, ev_adjust: -0.5, film_iso: 400.0 };
        let size = FilmSize::new(8, 6, 1).unwrap();
        let mut settings = PictureSettings {
            bloom: Some(Bloom { weight: 0.25, radius: 0.05 }),
            white_balance: WhiteBalance::from_white([0.34567, 0.35850]).unwrap(),
            downsize: Filter::Box,
            region: Some(Region::new([1, 2], [3, 4], size).unwrap()),
            watermark: true,
            ..PictureSettings::plain(camera, exposure)
        };
        let expected = [
            ("downsize_filter", "box"),
            ("render_region", "x1 1, y1 2, x2 3, y2 4"),
            ("watermark", "1"),
            (
                "tone_mapping",
                "camera with ev_adjust -0.5, film_iso 400, response_function_path data/film.txt",
            ),
            ("white_balance", "D50"),
            ("aperture_diffraction", "none"),
            ("bloom", "weight 0.25, radius 0.05"),
        ];
        assert_eq!(said(&settings), expected.map(|(k, v)| (k.to_owned(), v.to_owned())));
        assert_eq!(settings.film_iso(), Some(400.0));
        settings.tone_mapping = ToneMapping::Reinhard { pre_scale: 4.0, post_scale: 1.5, burn: 6.0 };
        settings.white_balance = WhiteBalance::from_white([0.3, 0.35]).unwrap();
        let value = |key: &str| said(&settings).into_iter().find(|(k, _)| k == key).map(|(_, v)| v);
        assert_eq!(value("tone_mapping").unwrap(), "reinhard with pre_scale 4, post_scale 1.5, burn 6");
        assert_eq!(value("white_balance").unwrap(), "0.3 0.35");
        assert_eq!(settings.film_iso(), None);
        settings.foreground_alpha = true;
        assert_eq!(said(&settings).len(), 3, "a mask has no tones");
    }
}
