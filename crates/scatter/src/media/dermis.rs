//! `dermis`: the inner layer of skin.

use super::{Medium, skin};
use indigo_decl::{Block, Field, Kind, Node, Presence, Range};
use indigo_diag::Sink;

/// The declaration of `dermis`.
pub static BLOCK: Block = Block::new(
    "dermis",
    "The inner layer of skin: C. Donner and H. W. Jensen, A Spectral BSSRDF for Shading Human Skin (2006).",
    &[Field::new(
        "hemoglobin_fraction",
        Kind::Real,
        Presence::Required,
        "Volume fraction of hemoglobin in the tissue, typically 0.001 to 0.1.",
    )
    .range(Range::Within(0.0, 1.0))],
)
.with_example("<dermis><hemoglobin_fraction>0.01</hemoglobin_fraction></dermis>");

/// From its element.
pub fn build(node: &Node, _sink: &mut Sink) -> Medium {
    medium(node.real("hemoglobin_fraction"))
}

/// Tissue with a share of blood; it scatters half as much as the outer layer.
pub(super) fn medium(blood: f64) -> Medium {
    skin::layer(|nm, i| blood * skin::blood(i) + (1.0 - blood) * skin::baseline(nm), 0.5)
}
