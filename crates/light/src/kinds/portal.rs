//! `exit_portal`: the openings through which outdoor light comes in.

use super::placement::{MESH_NAME, POS, ROTATION, SCALE};
use indigo_decl::{Block, Later};

/// The declaration of `exit_portal`.
pub static BLOCK: Block = Block::new(
    "exit_portal",
    "A mesh over an opening of an interior that is lit from outside by `background`, `skylight` or \
     `env_map`: light through the opening is then found faster. If there are portals at all, they must \
     cover every opening through which a path from the camera can leave the scene, and their fronts \
     must face the interior (the side from which their vertices run counter-clockwise in the mesh itself). What stands outside is then lit by light that is found by chance, and noisier. \
     Portals find what comes through them, not what it does inside: where most of the light is that of a patch of sun \
     on a floor or wall, they gain little alone, and much with `bidirectional`.",
    &[POS, SCALE, ROTATION, MESH_NAME],
)
.with_later(&[Later::new("uid", "3.0")])
.with_example(
    "<exit_portal>
    <pos>0 0 2</pos>
    <scale>1.0</scale>
    <rotation><matrix>1 0 0 0 1 0 0 0 1</matrix></rotation>
    <mesh_name>window</mesh_name>
</exit_portal>",
);
