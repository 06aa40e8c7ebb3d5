//! Phase functions: into which directions a medium scatters light.

pub mod henyey_greenstein;
pub mod uniform;

use indigo_decl::{Alternatives, Block};

/// The kinds of phase function.
pub static KINDS: &[&Block] = &[&uniform::BLOCK, &henyey_greenstein::BLOCK];

/// The content of `phase_function`.
pub static PHASE_FUNCTION: Alternatives = Alternatives::new("phase function", KINDS);
