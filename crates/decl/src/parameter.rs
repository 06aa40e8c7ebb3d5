//! Parameters as later versions of the format write them: one name, whatever it holds.
//!
//! Version 1.0 has an element for each form of a parameter, `albedo_spectrum` and `albedo_texture`. Later versions have
//! one, `albedo`, that holds a `constant`, a `texture` or a `shader`; and of the material's textures, which stand in
//! a list beside it, a `texture` may name one by its `texture_index`. Here the later forms become those of 1.0, before
//! anything is bound: both spellings are one thing from then on.

use crate::codes;
use crate::element::Element;
use crate::field::Block;
use crate::report;
use indigo_diag::{Diagnostic, Sink, Spanned};

/// A parameter that later versions of the format write under one name.
#[derive(Clone, Copy, Debug)]
pub struct Parameter {
    /// Its name there.
    pub name: &'static str,
    /// The version that brought it.
    pub since: &'static str,
    /// The field that a constant is for; empty where a constant does nothing (the same height all over).
    pub constant: &'static str,
    /// The field that an image map is for; empty where none is rendered.
    pub texture: &'static str,
    /// What stands in for a form that is not rendered.
    pub stand_in: StandIn,
}

impl Parameter {
    /// Whether an element of 1.0 says the same, and so has no effect beside it. Where the name has stayed the same
    /// nothing tells which is meant.
    fn overrides(&self, name: &str) -> bool {
        self.name != self.constant && [self.constant, self.texture].contains(&name)
    }
}

/// What stands in for a shader, or for an image map where none is rendered.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StandIn {
    /// Nothing.
    Nothing,
    /// A text, such as that of a number.
    Text(&'static str),
    /// A spectrum of the same value everywhere.
    Uniform(&'static str),
}

impl StandIn {
    /// In words: "0.5 stands in".
    pub(crate) fn words(self) -> String {
        match self {
            Self::Nothing => "nothing stands in".to_owned(),
            Self::Text(value) | Self::Uniform(value) => format!("{value} stands in"),
        }
    }
}

/// Name of the elements in the list of a material's textures, and of those that refer to them.
pub(crate) const TEXTURE: &str = "texture";
/// Name of what such an element refers by, counted from 0.
const INDEX: &str = "texture_index";
/// Name of the elements that hold programs, which are not run.
const SHADER: &str = "shader";

/// Turns later forms of parameters among the children of an element into those of 1.0.
pub(crate) fn settle(children: Vec<Element>, block: &'static Block, sink: &mut Sink) -> Vec<Element> {
    if block.parameters.is_empty() {
        return children;
    }
    let declares_list = block.fields.iter().any(|f| f.is_called(TEXTURE));
    let is_listed = |child: &Element| &*child.name == TEXTURE && !declares_list;
    let (list, rest): (Vec<_>, Vec<_>) = children.into_iter().partition(is_listed);
    let settling = Settling { list: &list };
    // Each with the place of its last element: of two forms it would not be seen any more that they were of one name.
    let overriding: Vec<(&Parameter, usize)> = block
        .parameters
        .iter()
        .filter_map(|p| Some((p, rest.iter().rposition(|child| &*child.name == p.name)?)))
        .collect();
    let mut settled = Vec::with_capacity(rest.len());
    for (i, child) in rest.into_iter().enumerate() {
        if let Some((parameter, last)) = overriding.iter().find(|(p, _)| *child.name == *p.name) {
            if i < *last {
                report::duplicate(&child, block.name, sink);
                continue;
            }
            settled.extend(settling.parameter(child, parameter, sink));
        } else if let Some((p, _)) = overriding.iter().find(|(p, _)| p.overrides(&child.name)) {
            sink.push(Diagnostic::warning(
                codes::DUPLICATE_ELEMENT,
                child.span,
                format!("<{}> has no effect beside <{}>", child.name, p.name),
            ));
        } else {
            settled.push(child);
        }
    }
    settled
}

struct Settling<'a> {
    /// The textures that are counted by `texture_index`.
    list: &'a [Element],
}

impl Settling<'_> {
    fn parameter(&self, mut child: Element, parameter: &Parameter, sink: &mut Sink) -> Option<Element> {
        if let Some(i) = child.children.iter().rposition(|c| &*c.name == TEXTURE) {
            let texture = child.children.remove(i);
            report_beside(&child, TEXTURE, sink);
            if parameter.texture.is_empty() {
                return stand_in(&child, &texture, parameter, sink);
            }
            let mut texture = self.meant(texture, sink)?;
            texture.name = parameter.texture.into();
            return Some(texture);
        }
        if let Some(i) = child.children.iter().rposition(|c| &*c.name == SHADER) {
            let shader = child.children.remove(i);
            report_beside(&child, SHADER, sink);
            return stand_in(&child, &shader, parameter, sink);
        }
        if parameter.constant.is_empty() {
            return None;
        }
        child.name = parameter.constant.into();
        Some(child)
    }

    /// The texture itself: that of the list where it names one by its number.
    fn meant(&self, mut texture: Element, sink: &mut Sink) -> Option<Element> {
        let Some(i) = texture.children.iter().rposition(|c| &*c.name == INDEX) else {
            return Some(texture);
        };
        let index = texture.children.remove(i);
        report_beside(&texture, INDEX, sink);
        let number = index.text.value.trim().parse::<usize>().ok();
        let Some(listed) = number.and_then(|i| self.list.get(i)) else {
            let there_are = match self.list.len() {
                0 => "there is no <texture> beside it".to_owned(),
                1 => "expected 0: there is 1 <texture>".to_owned(),
                n => format!("expected 0 to {}: there are {n} <texture>s", n - 1),
            };
            let span = if index.text.value.is_empty() { index.span } else { index.text.span };
            sink.push(
                Diagnostic::error(
                    codes::OUT_OF_RANGE,
                    span,
                    "<texture_index> counts no <texture> of this material",
                )
                .expected(there_are),
            );
            return None;
        };
        Some(Element { span: texture.span, ..listed.clone() })
    }
}

/// Tells of all that is left in an element beside a child that counts alone.
fn report_beside(element: &Element, counts: &str, sink: &mut Sink) {
    report::stray_text(element, sink);
    for other in &element.children {
        if *other.name == *counts {
            report::duplicate(other, &element.name, sink);
            continue;
        }
        let message = format!("<{}> in <{}> has no effect beside <{counts}>", other.name, element.name);
        sink.push(Diagnostic::warning(codes::DUPLICATE_ELEMENT, other.span, message));
    }
}

/// What stands in for a form that is not rendered, after saying so.
fn stand_in(child: &Element, form: &Element, parameter: &Parameter, sink: &mut Sink) -> Option<Element> {
    sink.push_or_count(Diagnostic::warning(
        codes::LATER_ELEMENT,
        form.span,
        format!(
            "<{}> in <{}> is of a later format version ({}) and not rendered: {}",
            form.name,
            child.name,
            parameter.since,
            parameter.stand_in.words()
        ),
    ));
    if parameter.constant.is_empty() {
        return None;
    }
    let leaf = |name: &str, text: &str| {
        let mut element = Element::new(name, child.span);
        element.text = Spanned::new(text.into(), child.span);
        element
    };
    match parameter.stand_in {
        StandIn::Nothing => None,
        StandIn::Text(text) => Some(leaf(parameter.constant, text)),
        StandIn::Uniform(value) => {
            let mut uniform = Element::new("uniform", child.span);
            uniform.children.push(leaf("value", value));
            let mut whole = Element::new(parameter.constant, child.span);
            whole.children.push(uniform);
            Some(whole)
        }
    }
}
