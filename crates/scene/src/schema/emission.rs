//! What scales the light of emitting materials, declared.

use indigo_decl::{Block, Field, Kind, Presence, Range};
use indigo_spectrum::declare::SPECTRUM;

const MEASURES: &[&str] = &["luminous_flux", "luminous_intensity", "luminance", "luminous_emittance"];

const MEASURE: Field = Field::new(
    "measure",
    Kind::Choice(MEASURES),
    Presence::Required,
    "What is given: the luminous flux in lm; the luminous intensity in cd, as a flux of π times that; the mean luminance \
     in cd/m²; or the flux by the area, in lm/m².",
);

const VALUE: Field =
    Field::new("value", Kind::Real, Presence::Required, "How much of it.").range(Range::AtLeast(0.0));

/// The declaration of `emission_scale` in a model.
pub static EMISSION_SCALE: Block = Block::new(
    "emission_scale",
    "Scales what a material emits, on this model alone.",
    &[
        Field::new("material_name", Kind::Reference("material"), Presence::Required, "Name of the material.")
            .aliases(&["material_uid"]),
        MEASURE,
        VALUE,
    ],
)
.with_example(
    "<emission_scale>
    <material_name>lamp</material_name>
    <measure>luminous_flux</measure>
    <value>800</value>
</emission_scale>",
);

/// The declaration of `ies_profile` in a model.
pub static IES_PROFILE: Block = Block::new(
    "ies_profile",
    "A measured distribution over directions of what a material emits on this model, as in `meshlight`. The flux is that of \
     the file, unless there is an `emission_scale`.",
    &[
        Field::new("material_name", Kind::Reference("material"), Presence::Required, "Name of the material.")
            .aliases(&["material_uid"]),
        Field::new("path", Kind::Path, Presence::Required, "The IES file, relative to the scene file."),
    ],
)
.with_example("<ies_profile><material_name>lamp</material_name><path>lamp.ies</path></ies_profile>");

/// The declaration of `layer_setting`.
pub static LAYER_SETTING: Block = Block::new(
    "layer_setting",
    "How bright the lights of one `layer` are: the first of these is for layer 0, and so on. Lights that name no layer are of layer 0, \
     and those of a layer that has no setting are as they are. The film keeps the light of each layer apart, of up to 15, so that their \
     brightness may be changed after the render, in the window or here: `--tonemap` and a film that is gone on with take it as it \
     is then. Each layer takes as much memory as a film without layers. Independent samples choose lamps by how bright these \
     are in the picture, as the scene has it. Metropolis sampling goes by the light as it is rendered, whatever its layer's \
     brightness: a layer that is turned down strongly, or off, keeps its share of the samples, which the others lack, and the noise that \
     comes of them; one that is turned up gets no more. What is meant to be dim for good is better given a lower emission.",
    &[
        Field::new("name", Kind::Text, Presence::Optional, "What the layer is called."),
        Field::new("enabled", Kind::Bool, Presence::Default("true"), "Whether their light is in the picture. What is switched off is rendered all the same, and can be switched on later."),
        Field::new(
            "layer_scale",
            Kind::OneOf(&SPECTRUM),
            Presence::Optional,
            "What multiplies their light: a colour (1, 1, 1) changes nothing. Of a `blackbody` it is the colour with the \
             luminance of (1, 1, 1), times its gain. Its brightness is that of the picture, as a ratio of luminances; its colour is rendered, \
             so that a film of another colour is another film. The sun, the sky and pictures of surroundings keep their colours.",
        ),
    ],
)
.with_example("<layer_setting><name>lamps</name><enabled>true</enabled><layer_scale><rgb><rgb>1 1 1</rgb></rgb></layer_scale></layer_setting>");

/// The declaration of `background_settings`.
pub static BACKGROUND_SETTINGS: Block = Block::new(
    "background_settings",
    "What surrounds the scene, as later versions write it: `background`, `skylight` or `env_map` in the form of a material that \
     emits. Its light adds to theirs.",
    &[
        Field::new(
            "background_material",
            Kind::Block(&BACKGROUND_MATERIAL),
            Presence::Optional,
            "The material. Without it there is nothing.",
        ),
        Field::new(
            "emission_scale",
            Kind::Block(&BACKGROUND_SCALE),
            Presence::Optional,
            "Scales its light.",
        ),
    ],
)
.with_example(
    "<background_settings>
    <background_material>
        <material>
            <name>surroundings</name>
            <diffuse><base_emission><constant><uniform><value>1e9</value></uniform></constant></base_emission></diffuse>
        </material>
    </background_material>
    <emission_scale>
        <material_name>surroundings</material_name>
        <measure>luminance</measure>
        <value>100</value>
    </emission_scale>
</background_settings>",
);

/// The declaration of `background_material`.
pub static BACKGROUND_MATERIAL: Block = Block::new(
    "background_material",
    "The material of what surrounds the scene: of any kind that emits, `sunsky`, or the `sum` of such. An `emission` texture \
     is a picture of the surroundings.",
    &[Field::new(
        "material",
        Kind::Block(&super::BACKGROUND_KIND),
        Presence::Required,
        "The material; its name is its own.",
    )],
)
.with_example("<background_material><material><sunsky><sundir>0 0.6 1</sundir></sunsky></material></background_material>");

/// The declaration of `emission_scale` in `background_settings`.
pub static BACKGROUND_SCALE: Block = Block::new(
    "emission_scale",
    "Scales the light of the surroundings to a mean luminance over all directions. It has no effect on a `sunsky`, of which \
     a warning tells.",
    &[
        Field::new("material_name", Kind::Text, Presence::Optional, "Name of the background's material. A scale of another has no effect, of which a warning tells.")
            .aliases(&["material_uid"]),
        Field::new("measure", Kind::Choice(&["luminance"]), Presence::Required, "What is given: the luminance, in cd/m²."),
        VALUE,
    ],
)
.with_example("<emission_scale><material_name>surroundings</material_name><measure>luminance</measure><value>100</value></emission_scale>");
