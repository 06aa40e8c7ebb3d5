//! `uniform`: scattering into all directions alike.

use indigo_decl::Block;

/// The declaration of `uniform`.
pub static BLOCK: Block =
    Block::new("uniform", "Light is scattered into all directions alike. It has no parameters.", &[])
        .with_example("<uniform/>");
