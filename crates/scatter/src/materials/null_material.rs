//! `null_material`: a surface that is not there.

use indigo_decl::Block;

/// The declaration of `null_material`.
pub static BLOCK: Block = Block::new(
    "null_material",
    "A surface that does nothing to light, and so is invisible. It has no parameters. Blended with \
     another material it makes that one partly see-through.",
    &[],
)
.with_example("<null_material/>");
