//! Fields that several materials share.

use indigo_decl::{Field, Kind, Later, Node, Parameter, Presence, Range, StandIn, codes};
use indigo_diag::{Diagnostic, Sink};
use indigo_spectrum::declare::SPECTRUM;
use indigo_texture::declare::TEXTURE;

/// The reflectance of the materials that have one.
pub const ALBEDO_SPECTRUM: Field = Field::new(
    "albedo_spectrum",
    Kind::OneOf(&SPECTRUM),
    Presence::Optional,
    "The fraction of light that is scattered, at least 0. Values above 1 are silently clamped. What emits and has no albedo \
     scatters nothing.",
);

/// Why not to write a colour as three bare numbers.
pub const COLOUR_DEPRECATED: &str = "write a spectrum of kind rgb with gamma 2.2 instead";

/// A map in place of the reflectance.
pub const ALBEDO_TEXTURE: Field = Field::new(
    "albedo_texture",
    Kind::Block(&TEXTURE),
    Presence::Optional,
    "An image map that takes the place of the albedo. Below 0 it counts as 0, and above 1 as 1, with a warning.",
);

/// A map of heights.
pub const BUMP_MAP: Field = Field::new(
    "bump_map",
    Kind::Block(&TEXTURE),
    Presence::Optional,
    "An image map of heights in metres, along the normal, by which the shading normal is bent. Its gain `b` \
     is usually small, such as 0.001.",
);

/// The width of microfacets, where the exponent of a Phong lobe is not given.
pub const ROUGHNESS: Field = Field::new(
    "roughness",
    Kind::Real,
    Presence::Optional,
    "The roughness of later versions in place of `exponent`: the width α of the distribution of small facets, from 0 \
     (smooth) to 1; an exponent n stands for α = √(2 / (n + 2)). An exponent beside it has no effect, with a warning.",
)
.range(Range::Within(0.0, 1.0));

/// A map in its place.
pub const ROUGHNESS_MAP: Field = Field::new(
    "roughness_map",
    Kind::Block(&TEXTURE),
    Presence::Optional,
    "An image map that takes the place of the roughness. Below 0 it counts as 0, and above 1 as 1, with a warning.",
);

/// `exponent` as later versions write it.
pub const EXPONENT_PARAMETER: Parameter = Parameter {
    name: "exponent",
    since: "1.1",
    constant: "exponent",
    texture: "exponent_map",
    stand_in: StandIn::Text("1000"),
};

/// The factor on reflectance as later versions write it.
pub const FRESNEL_SCALE_PARAMETER: Parameter = Parameter {
    name: "fresnel_scale",
    since: "3.0",
    constant: "fresnel_scale",
    texture: "",
    stand_in: StandIn::Text("1"),
};

/// Roughness as later versions write it.
pub const ROUGHNESS_PARAMETER: Parameter = Parameter {
    name: ROUGHNESS.name,
    since: "3.0",
    constant: ROUGHNESS.name,
    texture: ROUGHNESS_MAP.name,
    stand_in: StandIn::Text("0.3"),
};

/// The map of roughness. What it takes the place of has no effect, which is told.
pub fn map_of_widths<'a>(node: &'a Node, sink: &mut Sink) -> Option<&'a Node> {
    let map = node.node(ROUGHNESS_MAP.name)?;
    if node.has(ROUGHNESS.name) {
        let message = "<roughness> has no effect beside <roughness_map>";
        let at = node.span_of(ROUGHNESS.name);
        sink.push_or_count(Diagnostic::warning(codes::DUPLICATE_ELEMENT, at, message));
        node.disregard_field(ROUGHNESS.name);
    }
    Some(map)
}

/// An exponent has no effect where a material says by its roughness how rough it is; that is told.
pub fn disregard_exponents(node: &Node, sink: &mut Sink) {
    // In the order in which they count.
    let given =
        |names: [&'static str; 2]| names.into_iter().find(|name| node.block.declares(name) && node.has(name));
    let Some(counts) = given(["roughness_map", "roughness"]) else { return };
    let exponents = ["exponent_map", "exponent"];
    if let Some(other) = given(exponents) {
        let message = format!("<{other}> has no effect beside <{counts}>");
        sink.push_or_count(Diagnostic::warning(codes::DUPLICATE_ELEMENT, node.span_of(other), message));
    }
    exponents.iter().filter(|name| node.block.declares(name)).for_each(|name| node.disregard_field(name));
}

/// The medium inside.
pub const INTERNAL_MEDIUM_NAME: Field = Field::new(
    "internal_medium_name",
    Kind::Reference("medium"),
    Presence::Required,
    "Name of the medium that fills the inside of the object. It gives the index of refraction, too.",
)
.aliases(&["internal_medium_uid"]);

/// The reflectance as later versions write it.
pub const ALBEDO: Parameter = Parameter {
    name: "albedo",
    since: "1.1",
    constant: ALBEDO_SPECTRUM.name,
    texture: ALBEDO_TEXTURE.name,
    stand_in: StandIn::Uniform("0.5"),
};

/// Bumps as later versions write them.
pub const BUMP: Parameter = Parameter {
    name: "bump",
    since: "1.1",
    constant: "",
    texture: BUMP_MAP.name,
    stand_in: StandIn::Nothing,
};

/// What the surface emits.
pub const BASE_EMISSION: Field = Field::new(
    "base_emission",
    Kind::OneOf(&SPECTRUM),
    Presence::Optional,
    "Spectral radiance that the front of a mesh of this material emits, besides what it scatters. The model may rescale it.",
)
.unit("W m^-3 sr^-1");

/// What multiplies that.
pub const EMISSION: Field = Field::new(
    "emission",
    Kind::OneOf(&SPECTRUM),
    Presence::Optional,
    "What multiplies `base_emission`. Over a base of `uniform` it is light of its own, so that `rgb` (1, 1, 1) is white under \
     D65; a base with a spectrum of its own is tinted by it, and (1, 1, 1) changes nothing. Where there is no `base_emission` it is \
     the radiance itself.",
);

/// A map in its place.
pub const EMISSION_TEXTURE: Field = Field::new(
    "emission_texture",
    Kind::Block(&TEXTURE),
    Presence::Optional,
    "An image map that takes the place of `emission`.",
);

/// Whose switch it hangs on.
pub const LAYER: Field = Field::index(
    "layer",
    "Number of the `layer_setting` in `renderer_settings` that its emission is scaled by.",
);

/// Emission as later versions write it.
pub const BASE_EMISSION_PARAMETER: Parameter = Parameter {
    name: BASE_EMISSION.name,
    since: "1.1",
    constant: BASE_EMISSION.name,
    texture: "",
    stand_in: StandIn::Uniform("0"),
};

/// Its factor as later versions write it.
pub const EMISSION_PARAMETER: Parameter = Parameter {
    name: EMISSION.name,
    since: "1.1",
    constant: EMISSION.name,
    texture: EMISSION_TEXTURE.name,
    stand_in: StandIn::Uniform("1"),
};

/// The fields of what a material of any kind emits. They are read with the lamps of a scene, not with the material.
pub const EMISSION_FIELDS: [&str; 4] = [BASE_EMISSION.name, EMISSION.name, EMISSION_TEXTURE.name, LAYER.name];

/// What later versions put into every material, and is not rendered.
pub const LATER: &[Later] = &[
    Later::new("displacement", "1.1").instead("is left out: the surface stays where its mesh is"),
    Later::new("random_triangle_colours", "2.0").unless("false"),
    Later::new("backface_emit", "4.0").unless("false"),
    // It decides how often the lamp is drawn, and not what it gives.
    Later::new("emission_sampling_factor", "4.0").unless("1"),
    Later::new("invisible_to_camera", "4.0").unless("false"),
    Later::new("shadow_catcher", "4.0").unless("false"),
    Later::new("arch_glass", "3.0").unless("false"),
    Later::new("single_face", "3.0").unless("false"),
    Later::new("absorption_layer_transmittance", "3.0"),
];
