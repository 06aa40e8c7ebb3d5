//! `meshlight`: a lamp in the shape of a mesh.

use super::LAYER;
use super::efficacy::EFFICACY_SCALE;
use super::placement::{MESH_NAME, POS, ROTATION, SCALE};
use indigo_decl::{Block, Field, Kind, Later, Presence};
use indigo_spectrum::declare::SPECTRUM;
use indigo_texture::declare::TEXTURE;

/// The declaration of `meshlight`.
pub static BLOCK: Block = Block::new(
    "meshlight",
    "A lamp in the shape of a mesh. It emits from the front of its triangles (the side from which their \
     vertices run counter-clockwise in the mesh itself: a transformation that mirrors the mesh carries its front \
     along), and scatters light by the mesh's materials besides.",
    &[
        POS,
        SCALE,
        ROTATION,
        MESH_NAME,
        Field::new("spectrum", Kind::OneOf(&SPECTRUM), Presence::Required, "What it emits."),
        EFFICACY_SCALE,
        Field::new(
            "texture",
            Kind::Block(&TEXTURE),
            Presence::Optional,
            "An image map that multiplies the spectrum. Its values may go beyond 1.",
        ),
        Field::new(
            "ies_profile",
            Kind::Block(&IES_PROFILE),
            Presence::Optional,
            "A measured distribution over directions. The flux is then that of the file, and `efficacy_scale` \
             has no effect.",
        ),
        LAYER,
    ],
)
.with_later(&[Later::new("uid", "3.0")])
.with_example(
    "<meshlight>
    <pos>0 0 3</pos>
    <scale>1.0</scale>
    <rotation><matrix>1 0 0 0 1 0 0 0 1</matrix></rotation>
    <mesh_name>bulb</mesh_name>
    <spectrum>
        <blackbody><temperature>3500</temperature><gain>1.0</gain></blackbody>
    </spectrum>
    <efficacy_scale>
        <power_drawn>150</power_drawn>
        <overall_luminous_efficacy>20</overall_luminous_efficacy>
    </efficacy_scale>
</meshlight>",
);

/// The declaration of `ies_profile`.
pub static IES_PROFILE: Block = Block::new(
    "ies_profile",
    "A measured distribution of light over directions, from a file by IES LM-63 (1986, 1991, 1995, 2002 or 2019). \
     Each triangle emits about its own normal, so the mesh should be flat; one that is not is warned of. Horizontal \
     angles count from the x axis of the mesh, counter-clockwise seen from behind the lamp; a mesh that lies across \
     its x axis has no such angle, and is to be modelled level and turned by its `rotation`. Files of photometric \
     type C with vertical angles from 0 to 90 degrees are supported, and from 0 to 180: such a lamp shines from the \
     back of its triangles, too. Candelas count by the multiplier, the ballast factor and, up to the edition of 2002, \
     the ballast-lamp factor; in its place the edition of 2019 has the file generation type, which is no factor. \
     Lumens per lamp and factors for tilt do not count: these do not apply to a fixed lamp, be they in the file \
     (TILT=INCLUDE) or in another, which is not read.",
    &[Field::new("path", Kind::Path, Presence::Required, "The IES file, relative to the scene file.")],
)
.with_later(&[Later::new("material_name", "1.1")])
.with_example("<ies_profile><path>lamp.ies</path></ies_profile>");
