//! What materials emit.

use super::Context;
use crate::codes;
use crate::settings::Settings;
use indigo_decl::Node;
use indigo_diag::{Diagnostic, Sink, Span};
use indigo_scatter::materials::fields::EMISSION_FIELDS;
use indigo_spectrum::{Spectrum, read};

/// What a material emits.
#[derive(Clone)]
pub(super) struct Emission<'a> {
    /// Radiance before any scale, without the map.
    pub(super) radiance: Spectrum,
    /// The map that multiplies it.
    pub(super) texture: Option<&'a Node>,
    /// What the layer multiplies in the end.
    pub(super) layer: Option<Spectrum>,
}

/// Factors of the layers in their order: nothing where one is as it is, and black where one is switched off.
pub(super) struct Layers(Vec<Option<Spectrum>>);

impl Layers {
    pub(super) fn new(settings: &Settings, sink: &mut Sink) -> Self {
        let factor = |layer: &Node, sink: &mut Sink| {
            layer.disregard_field("name");
            let scale = layer.node("layer_scale").map(|scale| read_factor(scale, sink));
            if layer.bool("enabled") { scale } else { Some(Spectrum::BLACK) }
        };
        Self(settings.nodes("layer_setting").map(|layer| factor(layer, sink)).collect())
    }

    /// What a layer multiplies light by.
    pub(super) fn factor(&self, layer: i64) -> Option<Spectrum> {
        usize::try_from(layer).ok().and_then(|i| self.0.get(i)).cloned().flatten()
    }
}

/// A factor on light. A black body's is its colour alone.
fn read_factor(node: &Node, sink: &mut Sink) -> Spectrum {
    let factor = read::factor(node, sink);
    if node.block.name != "blackbody" {
        return factor;
    }
    let luminance = factor.luminance();
    let relative = node.real("gain") * Spectrum::uniform(1.0).luminance() / luminance;
    if relative.is_finite() { factor.scaled(relative) } else { Spectrum::BLACK }
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
        let radiance = match (base, colour) {
            (Some(base), Some(colour)) => read::emission(base, sink).times(&read::factor(colour, sink)),
            (Some(base), None) => read::emission(base, sink),
            (None, Some(colour)) => read::emission(colour, sink),
            (None, None) => Spectrum::uniform(1.0),
        };
        let layer = layers.factor(kind.int("layer"));
        let is_dark = radiance.max() <= 0.0 || layer.as_ref().is_some_and(|l| l.max() <= 0.0);
        (!is_dark).then_some(Self { radiance, texture, layer })
    }
}

/// Says that something of an emitting material gives no light.
pub(super) fn warn_of_darkness(what: &str, span: Span, context: &mut Context) {
    context.sink.push_or_count(
        Diagnostic::warning(
            codes::NOT_EMITTING,
            span,
            format!("{what} of an emitting material gives no light"),
        )
        .hint("only a model shines by its materials: place a mesh instead"),
    );
}
