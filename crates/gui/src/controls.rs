//! How the picture is developed, as the controls have it.

use crate::words;
use indigo_film::LightMix;
use indigo_formats::response;
use indigo_imaging::{Bloom, PictureSettings, Response, ToneMapping, WhiteBalance};
use indigo_render::disk::read_limited;
use std::path::PathBuf;
use std::sync::Arc;

/// Pre-scale, post-scale and burn of Reinhard's operator where nothing else is said: those of scenes without a tone mapping.
pub const PLAIN_REINHARD: [f64; 3] = [4.0, 1.2, 6.0];

/// Which tone mapping is chosen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mapper {
    /// Proportional.
    Linear,
    /// The operator of Reinhard et al.
    Reinhard,
    /// Exposure, speed of the film, and a response.
    Camera,
}

impl Mapper {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Linear, Self::Reinhard, Self::Camera];
}

/// All controls of development. Those of tone mappings that are not chosen keep their values.
#[derive(Clone, Debug, PartialEq)]
pub struct Controls {
    /// How bright the groups of lights are.
    pub lights: LightMix,
    /// The tone mapping.
    pub mapper: Mapper,
    /// Factor of the linear one.
    pub scale: f64,
    /// Luminance of the log average before compression.
    pub pre_scale: f64,
    /// Factor after compression.
    pub post_scale: f64,
    /// What becomes white.
    pub burn: f64,
    /// Each step of 1 doubles the exposure.
    pub ev: f64,
    /// Speed of the film.
    pub iso: f64,
    /// Response of film or sensor.
    pub response: Arc<Response>,
    /// Chromaticity of what counts as white.
    pub white: [f64; 2],
    /// Whether the aperture diffracts.
    pub diffraction: bool,
    /// Whether bright spots glow.
    pub bloom: bool,
    /// How much of the blurred picture is added.
    pub bloom_weight: f64,
    /// Width of the blur, as a part of the picture's longer side.
    pub bloom_radius: f64,
}

impl Controls {
    /// The controls that stand for settings.
    pub fn of(settings: &PictureSettings) -> Self {
        let [pre_scale, post_scale, burn] = PLAIN_REINHARD;
        let mut controls = Self {
            lights: settings.lights.clone(),
            mapper: Mapper::Linear,
            scale: 1.0,
            pre_scale,
            post_scale,
            burn,
            ev: 0.0,
            iso: 100.0,
            response: Arc::new(Response::display()),
            white: settings.white_balance.white_xy(),
            diffraction: settings.diffraction.is_some(),
            bloom: settings.bloom.is_some(),
            bloom_weight: settings.bloom.map_or(0.1, |bloom| bloom.weight),
            bloom_radius: settings.bloom.map_or(0.01, |bloom| bloom.radius),
        };
        match &settings.tone_mapping {
            ToneMapping::Linear { scale } => controls.scale = *scale,
            ToneMapping::Reinhard { pre_scale, post_scale, burn } => {
                controls.mapper = Mapper::Reinhard;
                (controls.pre_scale, controls.post_scale, controls.burn) = (*pre_scale, *post_scale, *burn);
            }
            ToneMapping::Camera { response, ev_adjust, film_iso } => {
                controls.mapper = Mapper::Camera;
                controls.response = Arc::clone(response);
                (controls.ev, controls.iso) = (*ev_adjust, *film_iso);
            }
        }
        controls
    }

    /// The settings that these controls make of a scene's.
    pub fn apply(&self, base: &PictureSettings) -> PictureSettings {
        PictureSettings {
            lights: self.lights.clone(),
            tone_mapping: self.tone_mapping(),
            white_balance: WhiteBalance::from_white(self.white).unwrap_or(base.white_balance),
            diffraction: base.diffraction.clone().filter(|_| self.diffraction),
            bloom: self.bloom.then_some(Bloom { weight: self.bloom_weight, radius: self.bloom_radius }),
            ..base.clone()
        }
    }

    fn tone_mapping(&self) -> ToneMapping {
        match self.mapper {
            Mapper::Linear => ToneMapping::Linear { scale: self.scale },
            Mapper::Reinhard => ToneMapping::Reinhard {
                pre_scale: self.pre_scale,
                post_scale: self.post_scale,
                burn: self.burn,
            },
            Mapper::Camera => ToneMapping::Camera {
                response: Arc::clone(&self.response),
                ev_adjust: self.ev,
                film_iso: self.iso,
            },
        }
    }

    /// Doubles the brightness as often as `steps` says, by whichever control does that.
    pub fn brighten(&mut self, steps: f64) {
        match self.mapper {
            Mapper::Linear => self.scale *= steps.exp2(),
            Mapper::Reinhard => self.pre_scale *= steps.exp2(),
            Mapper::Camera => self.ev += steps,
        }
    }

    /// What counts as white, in words.
    pub fn white_name(&self) -> String {
        // Exporters and the sRGB standard round to four digits.
        let is_near = |white: [f64; 2]| (0..2).all(|i| (white[i] - self.white[i]).abs() < 1e-4);
        match indigo_spectrum::illuminant::ALL.iter().find(|i| is_near(i.white_xy)) {
            Some(illuminant) => illuminant.name.to_owned(),
            None => words::chromaticity(self.white),
        }
    }

    /// Light of this XYZ becomes grey, if it can.
    pub fn take_grey(&mut self, [x, y, z]: [f32; 3]) -> bool {
        let sum = f64::from(x + y + z);
        let white = [f64::from(x) / sum, f64::from(y) / sum];
        let is_white = WhiteBalance::from_white(white).is_ok();
        if is_white {
            self.white = white;
        }
        is_white
    }
}

/// The response curves that come with the program: their names as scenes give them, and their files.
pub fn responses() -> Vec<(String, PathBuf)> {
    const FOLDER: &str = "data/camera_response_functions";
    let folders = indigo_front::paths::resource_directories().into_iter().map(|folder| folder.join(FOLDER));
    let entries = folders.filter_map(|folder| std::fs::read_dir(folder).ok()).flatten().flatten();
    let mut found: Vec<(String, PathBuf)> = entries
        .map(|entry| entry.path())
        .filter(|path| path.extension().is_some_and(|ending| ending == "txt"))
        .filter_map(|path| Some((format!("{FOLDER}/{}", path.file_name()?.to_str()?), path)))
        .collect();
    found.sort();
    found.dedup_by(|a, b| a.0 == b.0);
    found
}

/// Reads a response curve.
///
/// # Errors
/// What is wrong with the file.
pub fn read_response(name: &str, path: &std::path::Path) -> Result<Arc<Response>, String> {
    let bytes = read_limited(path).map_err(|error| format!("{}: {error}", path.display()))?;
    let curves = response::read(&bytes).map_err(|error| format!("{}: {error}", path.display()))?;
    Response::new([0, 1, 2].map(|c: usize| (&*curves[c].irradiance, &*curves[c].brightness)))
        .map(|response| Arc::new(response.named(name)))
        .ok_or_else(|| format!("{}: {}", path.display(), words::NO_CURVE))
}

#[cfg(test)]
mod tests {
    use super::*;
    use indigo_imaging::Exposure;

    fn settings(tone_mapping: ToneMapping) -> PictureSettings {
        let exposure = Exposure { aperture_area: 1e-6, lens_sensor_dist: 0.1, duration: 0.01 };
        PictureSettings::plain(tone_mapping, exposure)
    }

    #[test]
    fn controls_stand_for_the_settings_they_were_made_of() {
        let response = Arc::new(Response::display());
        for mapping in [
            ToneMapping::Linear { scale: 3.0 },
            ToneMapping::Reinhard { pre_scale: 1.0, post_scale: 2.0, burn: 3.0 },
            ToneMapping::Camera { response, ev_adjust: -2.0, film_iso: 400.0 },
        ] {
            let mut base = settings(mapping.clone());
            base.bloom = Some(Bloom { weight: 0.2, radius: 0.03 });
            base.white_balance = WhiteBalance::from_white([0.31, 0.32]).unwrap();
            let made = Controls::of(&base).apply(&settings(ToneMapping::Linear { scale: 9.0 }));
            assert_eq!(
                (made.tone_mapping, made.bloom, made.white_balance),
                (mapping, base.bloom, base.white_balance)
            );
        }
    }

    #[test]
    fn a_step_doubles_the_light() {
        let mut controls = Controls::of(&settings(ToneMapping::Linear { scale: 3.0 }));
        controls.brighten(1.0);
        assert_eq!(controls.scale, 6.0);
        controls.mapper = Mapper::Camera;
        controls.brighten(-0.5);
        assert_eq!(controls.ev, -0.5);
    }

    #[test]
    fn a_grey_point_becomes_white() {
        let mut controls = Controls::of(&settings(ToneMapping::Linear { scale: 1.0 }));
        assert_eq!(controls.white_name(), "D65", "by four digits");
        assert!(controls.take_grey([20.0, 20.0, 10.0]));
        assert_eq!(controls.white, [0.4, 0.4]);
        assert_eq!(controls.white_name(), "x 0.4000, y 0.4000");
        assert!(!controls.take_grey([0.0, 0.0, 0.0]), "black has no colour");
        assert_eq!(controls.white, [0.4, 0.4]);
    }

    #[test]
    fn curves_come_with_the_program() {
        let found = responses();
        let (name, path) =
            found.iter().find(|(name, _)| name.ends_with("film_soft.txt")).expect("it is there");
        let response = read_response(name, path).unwrap();
        assert_eq!(response.name(), "data/camera_response_functions/film_soft.txt");
        assert!(response.brightness(1, 0.9) > response.brightness(1, 0.1));
    }
}
