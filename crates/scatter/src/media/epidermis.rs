//! `epidermis`: the outer layer of skin.

use super::{Medium, skin};
use indigo_decl::{Block, Field, Kind, Node, Presence, Range};
use indigo_diag::Sink;

/// The declaration of `epidermis`.
pub static BLOCK: Block = Block::new(
    "epidermis",
    "The outer layer of skin: C. Donner and H. W. Jensen, A Spectral BSSRDF for Shading Human Skin (2006).",
    &[
        Field::new(
            "melanin_fraction",
            Kind::Real,
            Presence::Required,
            "Volume fraction of melanin in the tissue, typically up to 0.5.",
        )
        .range(Range::Within(0.0, 1.0)),
        Field::new(
            "melanin_type_blend",
            Kind::Real,
            Presence::Required,
            "The share of eumelanin (brown) against pheomelanin (reddish).",
        )
        .range(Range::Within(0.0, 1.0)),
    ],
)
.with_example(
    "<epidermis>
    <melanin_fraction>0.1</melanin_fraction>
    <melanin_type_blend>0.5</melanin_type_blend>
</epidermis>",
);

/// From its element.
pub fn build(node: &Node, _sink: &mut Sink) -> Medium {
    medium(node.real("melanin_fraction"), node.real("melanin_type_blend"))
}

/// Tissue with a share of melanin, of which a share is eumelanin.
pub(super) fn medium(melanin: f64, eumelanin: f64) -> Medium {
    skin::layer(|nm, _| melanin * skin::melanin(nm, eumelanin) + (1.0 - melanin) * skin::baseline(nm), 1.0)
}
