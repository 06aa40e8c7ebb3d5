//! What materials emit.

use super::Context;
use super::light_layers::{Layer, Layers};
use crate::codes;
use indigo_decl::Node;
use indigo_diag::{Diagnostic, Sink, Span};
use indigo_scatter::materials::fields::{EMISSION_FIELDS, EMISSION_PARAMETER};
use indigo_spectrum::{Spectrum, read};

/// What a material emits.
#[derive(Clone)]
pub(super) struct Emission<'a> {
    /// Radiance before any scale, without the map.
    pub(super) radiance: Spectrum,
    /// The map that multiplies it.
    pub(super) texture: Option<&'a Node>,
    /// The layer that it belongs to.
    pub(super) layer: Layer,
}

/// Whether a kind of material has fields of emission, and one of them is given.
pub(super) fn is_given(kind: &Node) -> bool {
    let has = |name: &str| kind.block.declares(name) && kind.has(name);
    EMISSION_FIELDS[..3].iter().any(|name| has(name))
}

/// Says that what a material emits is read elsewhere, or has no effect, which was reported.
pub(super) fn disregard(kind: &Node) {
    let declared = EMISSION_FIELDS.iter().filter(|name| kind.block.declares(name));
    declared.for_each(|name| kind.disregard_field(name));
}

impl<'a> Emission<'a> {
    /// Of a kind of material; `None` where it emits nothing.
    pub(super) fn of(kind: &'a Node, layers: &Layers, sink: &mut Sink) -> Option<Self> {
        if !is_given(kind) {
            return None;
        }
        let base = kind.node("base_emission");
        let texture = kind.node("emission_texture");
        // A map takes the place of a spectrum.
        let colour = kind.node("emission").filter(|_| texture.is_none());
        let radiance = radiance(base, colour, sink).unwrap_or(Spectrum::uniform(1.0));
        let layer = layers.of(kind.int("layer"));
        (radiance.max() > 0.0).then_some(Self { radiance, texture, layer })
    }
}

impl Emission<'_> {
    /// A part of it.
    pub(super) fn dimmed(self, share: f64) -> Self {
        Self { radiance: self.radiance.scaled(share), ..self }
    }

    /// Both together, if that is a spectrum of one layer, times a map at most.
    pub(super) fn plus(self, other: Option<Self>) -> Option<Self> {
        let Some(other) = other else { return Some(self) };
        let is_simple = self.texture.is_none() && other.texture.is_none();
        (is_simple && self.layer.group == other.layer.group)
            .then(|| Self { radiance: self.radiance.plus(&other.radiance), ..self })
    }
}

/// What `base_emission` and `emission` make together; `None` without both. Over an even base, which only says how much there is,
/// `emission` is light as it is alone: white `rgb` is white under D65. A base with a spectrum of its own is tinted by it.
pub(super) fn radiance(base: Option<&Node>, colour: Option<&Node>, sink: &mut Sink) -> Option<Spectrum> {
    let base = base.map(|base| read::emission(base, sink));
    let product = |radiance: Spectrum, colour: &Node, sink: &mut Sink| {
        read::refuse_excess(&radiance, colour.span, sink);
        Some(radiance)
    };
    match (base, colour) {
        (Some(Spectrum::Uniform(value)), Some(colour)) => {
            let radiance = read::emission(colour, sink).times(&Spectrum::Uniform(value));
            product(radiance, colour, sink)
        }
        (Some(base), Some(colour)) => product(base.times(&read::factor(colour, sink)), colour, sink),
        (Some(base), None) => Some(base),
        (None, Some(colour)) => Some(read::emission(colour, sink)),
        (None, None) => None,
    }
}

/// Says that something of an emitting material gives no light.
pub(super) fn warn_of_darkness(what: &str, hint: &str, span: Span, context: &mut Context) {
    let since = EMISSION_PARAMETER.since;
    context.sink.push_or_count(
        Diagnostic::warning(
            codes::NOT_EMITTING,
            span,
            format!("{what} of a material with <emission> (format version {since}) gives no light"),
        )
        .hint(hint),
    );
}
