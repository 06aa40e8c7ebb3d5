//! `layer_setting`s: groups of lights, each of which may be brighter or darker in the picture than it was rendered.
//!
//! What a layer multiplies light by is taken apart: its colour, of the luminance of white, is rendered; its
//! brightness, and whether it is switched on, are left to development ([`LightMix`]). So a film does not
//! depend on how bright its layers are.

use crate::codes;
use crate::settings::Settings;
use indigo_decl::Node;
use indigo_diag::{Diagnostic, Sink};
use indigo_film::mix::MOST_GROUPS;
use indigo_film::{LightGroup, LightMix};
use indigo_spectrum::{Spectrum, read};

/// The layers in their order.
pub(super) struct Layers(Vec<(LightGroup, Option<Spectrum>)>);

/// The layer of a light.
#[derive(Clone)]
pub(super) struct Layer {
    /// Its number; of lights that are as they are one more than any layer has.
    pub(super) group: u16,
    /// What it multiplies light by before rendering; as it is, where there is nothing.
    pub(super) colour: Option<Spectrum>,
}

impl Layer {
    /// Says of light whose colour is given otherwise that the layer's is left out.
    pub(super) fn keep_colour_out_of(&self, node: &Node, sink: &mut Sink) {
        if self.colour.is_some() {
            let message = "this light keeps its colour: of its layer's only the brightness counts";
            sink.push(Diagnostic::warning(codes::IDLE_SCALE, node.span, message));
        }
    }
}

impl Layers {
    pub(super) fn new(settings: &Settings, sink: &mut Sink) -> Self {
        let mut layers: Vec<(LightGroup, Option<Spectrum>)> = vec![];
        for (number, node) in settings.nodes("layer_setting").enumerate() {
            let (gain, colour) = node.node("layer_scale").map_or((1.0, None), |s| scale(s, sink));
            let is_on = node.bool("enabled");
            if number == MOST_GROUPS - 1 {
                let message = format!("only the first {number} layers are kept apart in the film");
                let hint = "the brightness of the others is rendered, and cannot be changed after it";
                sink.push(Diagnostic::warning(codes::STANDS_IN, node.span, message).hint(hint));
            }
            layers.push(if number < MOST_GROUPS - 1 {
                let name = name(node, number, &layers);
                (LightGroup { name, gain, is_on, layer: Some(number as u16) }, colour)
            } else {
                node.disregard_field("name");
                let gain = if is_on { gain } else { 0.0 };
                (rest(), Some(colour.unwrap_or(Spectrum::uniform(1.0)).scaled(gain)))
            });
        }
        Self(layers)
    }

    /// How many are kept apart in the film.
    fn apart(&self) -> usize {
        self.0.len().min(MOST_GROUPS - 1)
    }

    /// The layer of a number. A light of one that is not set is as it is.
    pub(super) fn of(&self, number: i64) -> Layer {
        let number = usize::try_from(number).unwrap_or(usize::MAX);
        let colour = self.0.get(number).and_then(|(_, colour)| colour.clone());
        Layer { group: number.min(self.apart()) as u16, colour }
    }

    /// How bright all layers are, whether or not any light is of them.
    pub(super) fn all(&self) -> LightMix {
        LightMix(self.0[..self.apart()].iter().map(|(group, _)| group.clone()).collect())
    }

    /// What a film depends on of the layers: their names, and hashes of their colours. `None` without layers.
    pub(super) fn decisive(&self) -> Option<String> {
        let colour = |colour: &Option<Spectrum>| match colour {
            Some(colour) => {
                let mut hasher = blake3::Hasher::new();
                // To digits that the division by its brightness does not change.
                let digits = |nm: u16| format!("{:.4e} ", colour.at(f64::from(nm)));
                for nm in 360..=830 {
                    hasher.update(digits(nm).as_bytes());
                }
                hasher.finalize().to_hex()[..16].to_owned()
            }
            None => "white".to_owned(),
        };
        let named = |(group, is): &(LightGroup, Option<Spectrum>)| format!("{}: {}", group.name, colour(is));
        (!self.0.is_empty()).then(|| self.0.iter().map(named).collect::<Vec<_>>().join("; "))
    }

    /// How bright the layers are, of those that have any of the lights, whose groups these are; and for each group
    /// its number among them. Nothing is kept apart where there are no layers.
    pub(super) fn mix(&self, used: impl Iterator<Item = u16>) -> (LightMix, Vec<u16>) {
        let mut is_used = vec![false; self.apart() + 1];
        used.for_each(|group| is_used[usize::from(group)] = true);
        if self.0.is_empty() {
            return (LightMix::default(), vec![0]);
        }
        let (mut groups, mut numbers) = (vec![], vec![]);
        for (group, is_used) in is_used.into_iter().enumerate() {
            numbers.push(groups.len() as u16);
            if is_used {
                groups.push(if group < self.apart() { self.0[group].0.clone() } else { rest() });
            }
        }
        (LightMix(groups), numbers)
    }
}

/// What the lights of no layer are called.
const REST: &str = "other lights";

/// Those lights, which are as they are.
fn rest() -> LightGroup {
    LightGroup { name: REST.to_owned(), gain: 1.0, is_on: true, layer: None }
}

/// A layer's name, or its number, as no other is called.
fn name(node: &Node, number: usize, others: &[(LightGroup, Option<Spectrum>)]) -> String {
    let given = node.text("name").value;
    let mut name = if given.is_empty() { format!("layer {number}") } else { given };
    while name == REST || others.iter().any(|(other, _)| other.name == name) {
        name = format!("{name} ({number})");
    }
    name
}

/// The brightness of a factor on light, and its colour if that is not white. A black body's factor is its colour with the
/// luminance of its gain.
fn scale(node: &Node, sink: &mut Sink) -> (f64, Option<Spectrum>) {
    let factor = read::factor(node, sink);
    let relative = factor.luminance() / Spectrum::uniform(1.0).luminance();
    if !(relative > 0.0 && relative.is_finite()) {
        return (0.0, None);
    }
    let brightness = if node.block.name == "blackbody" { node.real("gain") } else { relative };
    (brightness, Some(factor.scaled(1.0 / relative)).filter(|colour| !is_white(colour)))
}

/// Whether a factor leaves light as it is.
fn is_white(colour: &Spectrum) -> bool {
    matches!(colour, Spectrum::Uniform(value) if (*value - 1.0).abs() < 1e-6)
}
