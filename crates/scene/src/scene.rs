//! A scene that can be traced.

use indigo_camera::Camera;
use indigo_film::{FilmFilter, FilmSize, Filter};
use indigo_geom::{Accel, SurfacePoint};
use indigo_imaging::{CameraFacts, ImagingError, PictureSettings, Region, png};
use indigo_light::LightTable;
use indigo_math::Real;
use indigo_scatter::{Interface, Material, MaterialContext, Medium, MediumStack};
use indigo_spectrum::{SampledWavelengths, WavelengthSampler};
use indigo_texture::Texture;

/// Everything that rendering needs, in render space: the world moved so that the camera is its origin.
pub struct Scene {
    /// All geometry.
    pub accel: Accel,
    /// All lights.
    pub lights: LightTable,
    /// Draws the wavelengths of paths.
    pub wavelengths: Box<WavelengthSampler>,
    /// The camera.
    pub camera: Camera,
    /// All textures.
    pub textures: Vec<Texture>,
    pub(crate) materials: Vec<Material>,
    /// For each object the first of its material slots in `slots`.
    pub(crate) first_slot: Vec<u32>,
    /// Material number of each slot of each object.
    pub(crate) slots: Vec<u32>,
    /// All media, of which the first is air; none where no material has anything inside.
    pub media: Vec<Medium>,
    /// The media round the camera, or most of it.
    pub camera_media: MediumStack,
    /// Whether the surface of a medium is so near that rays may begin on both its sides.
    pub(crate) camera_meets_interface: bool,
    /// For each lamp the media round all of it, or `None` where they must be looked for.
    pub(crate) lamp_media: Vec<Option<MediumStack>>,
    /// Whether light may pass some surface as if it were not there, so that rays must look for them.
    pub has_unseen_surfaces: bool,
    /// Floor under the distance by which rays start off a surface, metres.
    pub nudge_m: Real,
    /// What objects and materials are called.
    pub names: Names,
    /// How light is transported.
    pub transport: TransportSettings,
    /// The film.
    pub film: FilmSettings,
    /// How the picture is made from the film.
    pub picture: PictureSettings,
    /// What pictures tell of the camera.
    pub camera_facts: CameraFacts,
    /// What is written, and when.
    pub output: OutputSettings,
    /// What films of this scene have in common.
    pub identity: Identity,
}

/// What objects and materials are called, in the order of their numbers.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Names {
    /// Of a mesh its name, of other objects their element's. First come models, then spheres, planes, mesh lights and rectangle lights,
    /// each in the order of the scene. A model is one object for each of its materials that emit, and one for the rest.
    pub objects: Vec<String>,
    /// In the order in which objects use them. A material with textures is there once for each arrangement of uv sets;
    /// what scatters nothing, as rectangle lights are made of, is called `black`.
    pub materials: Vec<String>,
}

/// The name of the setting of an [`Identity`] that is `true` where diffraction deflects rays.
pub const DIFFRACTION_OF_RAYS: &str = "diffraction of rays";

/// The name of the setting of an [`Identity`] that is `true` where the film holds what hides the background and no light.
pub const FOREGROUND_ALPHA: &str = "render_foreground_alpha";

/// The name of the setting of an [`Identity`] that tells names and colours of the layers of lights.
pub const LAYER_SETTING: &str = "layer_setting";

/// The name of the setting of an [`Identity`] that tells the part of the picture that is rendered.
pub const RENDER_REGION: &str = "render_region";

/// The value of that setting.
pub(crate) fn region_in_words(region: Option<[[u32; 2]; 2]>) -> String {
    region.map_or_else(|| "the whole".to_owned(), |[x, y]| format!("{x:?} {y:?}"))
}

/// The same from such a value, which a film has; `None` for one that is no such.
pub fn region_of_words(value: &str) -> Option<Option<[[u32; 2]; 2]>> {
    let mut numbers = value.split(|c: char| !c.is_ascii_digit()).filter_map(|number| number.parse().ok());
    let [x1, x2, y1, y2] = std::array::from_fn(|_| numbers.next());
    let region = x1.zip(x2).zip(y1.zip(y2)).map(|((x1, x2), (y1, y2))| [[x1, x2], [y1, y2]]);
    (region_in_words(region) == value).then_some(region)
}

/// What a film must have been rendered from to be of the same picture.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Identity {
    /// Hash of all elements and files that the film depends on.
    pub hash: [u8; 32],
    /// Name and value of the settings that decide what the film converges to, or which layers it has.
    pub settings: Vec<(String, String)>,
}

/// All of a scene that making and saving a picture of its film takes.
#[derive(Clone, Debug)]
pub struct Development {
    /// How light was transported, as pictures tell.
    pub transport: TransportSettings,
    /// Resolution that the scene asks for.
    pub size: FilmSize,
    /// How the picture is made from the film.
    pub picture: PictureSettings,
    /// What a film depends on of the layers of lights, as its record tells; `None` without any.
    pub light_layers: Option<String>,
    /// What pictures tell of the camera.
    pub camera: CameraFacts,
    /// What is written.
    pub output: OutputSettings,
}

/// How light is transported.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TransportSettings {
    /// Largest number of scattering events between camera and light.
    pub max_depth: u32,
    /// Whether paths are built from both ends.
    pub bidirectional: bool,
    /// How paths are mutated, where Metropolis sampling chooses them.
    pub metropolis: Option<MetropolisSettings>,
    /// Whether direct light is left to independent samples; only with `metropolis`.
    pub hybrid: bool,
}

/// How Metropolis sampling mutates paths.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MetropolisSettings {
    /// Probability of starting afresh.
    pub large_mutation_prob: f64,
    /// Radius of small mutations, of the unit cube's sides.
    pub max_change: Real,
    /// Rejections in a row after which a mutation is accepted whatever it is.
    pub max_consecutive_rejections: i64,
}

/// The film and how samples fall on it.
#[derive(Clone, Debug)]
pub struct FilmSettings {
    /// Resolution.
    pub size: FilmSize,
    /// Splat filter.
    pub splat: Filter,
    /// The splat filter, prepared for this size.
    pub filter: FilmFilter,
    /// Columns and rows of the output picture that are rendered: first and last (excluded).
    pub region: Option<[[u32; 2]; 2]>,
}

/// What is written, and when; times in seconds.
#[derive(Clone, Debug, PartialEq)]
#[expect(clippy::struct_excessive_bools, reason = "each is a switch of the scene's own")]
pub struct OutputSettings {
    /// Path of the scene, as given.
    pub scene_path: String,
    /// Whether an EXR of luminances is written.
    pub untonemapped_exr: bool,
    /// Whether an EXR of the developed picture is written.
    pub tonemapped_exr: bool,
    /// An EXR with layers: what the pixels show besides light.
    pub layers_exr: bool,
    /// A denoised picture.
    pub denoised: bool,
    /// Whether a picture of the aperture's shape is written.
    pub aperture_preview: bool,
    /// Whether the film itself is written.
    pub igi: bool,
    /// How the PNG holds its pixels.
    pub png: png::Format,
    /// How often pictures are written.
    pub image_save_period: f64,
    /// How often a network slave sends what it has rendered, in seconds.
    pub frame_upload_period: f64,
    /// Rendering time after which to halt.
    pub halt_time: Option<f64>,
    /// Samples per output pixel at which to halt.
    pub halt_samples_per_pixel: Option<f64>,
    /// Number of threads; `None`: as many as there are logical cores.
    pub threads: Option<usize>,
    /// Whether a log file is written.
    pub logging: bool,
    /// How often the picture on a screen is renewed.
    pub display_period: f64,
}

/// How much a scene holds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SceneStats {
    /// Geometry.
    pub geometry: indigo_geom::Stats,
    /// Placed objects.
    pub objects: usize,
    /// Lights.
    pub lights: usize,
    /// Materials in use.
    pub materials: usize,
    /// Textures in use.
    pub textures: usize,
}

impl Scene {
    /// All materials in use, in the order of their numbers.
    pub fn materials(&self) -> &[Material] {
        &self.materials
    }

    /// The material at a point of a surface.
    #[inline]
    pub fn material_at(&self, at: &SurfacePoint) -> &Material {
        &self.materials[self.material_number_at(at) as usize]
    }

    /// Its number, in the order in which the scene uses them.
    #[inline]
    pub fn material_number_at(&self, at: &SurfacePoint) -> u32 {
        self.slots[(self.first_slot[at.object as usize] + at.material_slot) as usize]
    }

    /// What materials may look at, for the wavelengths of a path, the indices on the two sides of a
    /// surface, and a number in [0, 1) that chooses among blended materials.
    #[inline]
    pub fn material_context<'a>(
        &'a self,
        lambda: &'a SampledWavelengths,
        interface: Interface,
        choice: Real,
    ) -> MaterialContext<'a> {
        let (textures, materials) = (&self.textures, &self.materials);
        MaterialContext { textures, materials, lambda, interface, choice, is_front: true }
    }

    /// What making and saving a picture of its film takes.
    pub fn development(&self) -> Development {
        Development {
            transport: self.transport,
            size: self.film.size,
            picture: self.picture.clone(),
            light_layers: self.identity.settings.iter().find(|s| s.0 == LAYER_SETTING).map(|s| s.1.clone()),
            camera: self.camera_facts,
            output: self.output.clone(),
        }
    }

    /// Renders another part of the picture from now on, or all of it: first column and row, and those after the last.
    ///
    /// # Errors
    /// The part is empty, or leaves the picture; then nothing changes.
    pub fn set_region(&mut self, part: Option<[[u32; 2]; 2]>) -> Result<(), ImagingError> {
        let region = part.map(|[start, end]| Region::new(start, end, self.film.size)).transpose()?;
        self.film.region = part.map(|[[x1, y1], [x2, y2]]| [[x1, x2], [y1, y2]]);
        self.picture.region = region;
        for (name, value) in &mut self.identity.settings {
            if name == RENDER_REGION {
                *value = region_in_words(self.film.region);
            }
        }
        Ok(())
    }

    /// How much the scene holds.
    pub fn stats(&self) -> SceneStats {
        SceneStats {
            geometry: self.accel.stats(),
            objects: self.accel.objects().len(),
            lights: self.lights.len(),
            materials: self.materials.len(),
            textures: self.textures.len(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn regions_are_read_again() {
        for region in [None, Some([[138, 231], [121, 192]]), Some([[0, 1], [0, u32::MAX]])] {
            assert_eq!(region_of_words(&region_in_words(region)), Some(region));
        }
        for other in ["", "1 2 3 4", "[1, 2] [3, 4] [5]", "[1, 2] [3, 99999999999]"] {
            assert_eq!(region_of_words(other), None, "{other}");
        }
    }
}
