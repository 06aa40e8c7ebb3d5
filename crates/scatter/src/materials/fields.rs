//! Fields that several materials share.

use indigo_decl::{Field, Kind, Later, Presence};
use indigo_spectrum::declare::SPECTRUM;
use indigo_texture::declare::TEXTURE;

/// The reflectance of the materials that have one.
pub const ALBEDO_SPECTRUM: Field = Field::new(
    "albedo_spectrum",
    Kind::OneOf(&SPECTRUM),
    Presence::Optional,
    "The fraction of light that is scattered, at least 0. Values above 1 are silently clamped.",
);

/// Why not to write a colour as three bare numbers.
pub const COLOUR_DEPRECATED: &str = "write a spectrum of kind rgb with gamma 2.2 instead";

/// A map in place of the reflectance.
pub const ALBEDO_TEXTURE: Field = Field::new(
    "albedo_texture",
    Kind::Block(&TEXTURE),
    Presence::Optional,
    "An image map that takes the place of the albedo.",
);

/// A map of heights.
pub const BUMP_MAP: Field = Field::new(
    "bump_map",
    Kind::Block(&TEXTURE),
    Presence::Optional,
    "An image map of heights in metres, along the normal, by which the shading normal is bent. Its gain `b` \
     is usually small, such as 0.001.",
);

/// The medium inside.
pub const INTERNAL_MEDIUM_NAME: Field = Field::new(
    "internal_medium_name",
    Kind::Reference("medium"),
    Presence::Required,
    "Name of the medium that fills the inside of the object. It gives the index of refraction, too.",
);

/// What later versions put into every material.
pub const LATER: &[Later] = &[
    Later::new("texture", "1.1"),
    Later::new("albedo", "1.1"),
    Later::new("diffuse_albedo", "1.1"),
    Later::new("specular_reflectivity", "1.1"),
    Later::new("bump", "1.1"),
    Later::new("displacement", "1.1"),
    Later::new("base_emission", "1.1"),
    Later::new("emission", "1.1"),
    Later::new("layer", "1.1"),
    Later::new("internal_medium_uid", "3.0"),
    Later::new("random_triangle_colours", "2.0"),
    Later::new("backface_emit", "4.0"),
    Later::new("emission_sampling_factor", "4.0"),
    Later::new("invisible_to_camera", "4.0"),
    Later::new("shadow_catcher", "4.0"),
    Later::new("absorption_layer_transmittance", "3.0"),
    Later::new("arch_glass", "3.0"),
    Later::new("single_face", "3.0"),
    Later::new("roughness", "3.0"),
    Later::new("fresnel_scale", "3.0"),
];
