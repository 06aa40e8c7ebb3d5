//! Settings in layers: default < inifile.xml < renderer_settings < command line.

use crate::schema::filter::{GAUSSIAN, MN_CUBIC};
use crate::schema::settings::RENDERER_SETTINGS;
use indigo_decl::{Element, Field, Node, Presence, Value, bind, report_unread};
use indigo_diag::{Severity, Sink, Span, Spanned};

/// Which layer a setting's value comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Origin {
    /// The built-in default.
    Default,
    /// `inifile.xml`.
    IniFile,
    /// The scene's `renderer_settings`.
    Scene,
    /// The command line.
    CommandLine,
}

impl Origin {
    /// In words, for listings.
    pub fn words(self) -> &'static str {
        match self {
            Self::Default => "default",
            Self::IniFile => "inifile.xml",
            Self::Scene => "scene",
            Self::CommandLine => "command line",
        }
    }
}

/// All settings, each from the highest layer that gives it.
pub struct Settings {
    /// From the highest layer to the lowest.
    layers: Vec<(Origin, Node)>,
    defaults: Node,
}

/// A line of the settings listing.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Listed {
    /// Name of the setting.
    pub name: &'static str,
    /// Its value as it would stand in a file.
    pub value: String,
    /// Where the value comes from.
    pub origin: Origin,
}

impl Settings {
    /// From the nodes of the layers that exist; `nowhere` is the place of values that have none.
    pub fn new(layers: Vec<(Origin, Node)>, nowhere: Span) -> Self {
        // A setting without a child has its declared default; the filters are blocks, which have none.
        let mut defaults = Element::new(RENDERER_SETTINGS.name, nowhere);
        for (setting, filter) in [("splat_filter", &GAUSSIAN), ("downsize_filter", &MN_CUBIC)] {
            let mut child = Element::new(setting, nowhere);
            child.children.push(Element::new(filter.name, nowhere));
            defaults.children.push(child);
        }
        // Nothing can be wrong with them.
        Self { layers, defaults: bind(defaults, &RENDERER_SETTINGS, &mut Sink::new()) }
    }

    /// The layer that decides a setting. The ones below it have no say: their values count as used.
    fn deciding(&self, field: &str) -> (Origin, &Node) {
        let mut given = self.layers.iter().filter(|(_, node)| node.has(field));
        let decides = given.next();
        for (_, overruled) in given {
            overruled.disregard_field(field);
        }
        decides.map_or((Origin::Default, &self.defaults), |(origin, node)| (*origin, node))
    }

    /// Where a setting's value comes from.
    pub fn origin(&self, field: &str) -> Origin {
        self.deciding(field).0
    }

    /// The place of a setting's value.
    pub fn span_of(&self, field: &str) -> Span {
        self.deciding(field).1.span_of(field)
    }

    /// Whether what decides a setting is wrong, which was reported; its value is but a stand-in.
    pub fn is_faulty(&self, field: &str) -> bool {
        self.deciding(field).1.is_faulty(field)
    }

    /// A truth value.
    pub fn bool(&self, field: &str) -> bool {
        self.deciding(field).1.bool(field)
    }

    /// A whole number.
    pub fn int(&self, field: &str) -> Spanned<i64> {
        let node = self.deciding(field).1;
        Spanned::new(node.int(field), node.span_of(field))
    }

    /// A real number.
    pub fn real(&self, field: &str) -> f64 {
        self.deciding(field).1.real(field)
    }

    /// A text or choice.
    pub fn text(&self, field: &str) -> Spanned<String> {
        let node = self.deciding(field).1;
        Spanned::new(node.text(field).value.clone(), node.span_of(field))
    }

    /// A block.
    pub fn node(&self, field: &str) -> Option<&Node> {
        self.deciding(field).1.node(field)
    }

    /// The blocks of a setting that may be given several times.
    pub fn nodes(&self, field: &str) -> impl Iterator<Item = &Node> {
        self.deciding(field).1.nodes(field)
    }

    /// All blocks of a setting that may be given several times, as text.
    pub fn listed_blocks(&self, field: &str) -> String {
        self.nodes(field).map(block_text).collect::<Vec<_>>().join("; ")
    }

    /// Marks a setting as used though its value has no effect in this run.
    pub fn disregard(&self, field: &str) {
        for (_, node) in &self.layers {
            node.disregard_field(field);
        }
    }

    /// Reports what was given but has no effect.
    pub(crate) fn report_unread(&self, sink: &mut Sink) {
        for (_, node) in &self.layers {
            node.mark_used();
            report_unread(node, Severity::Error, sink);
        }
    }

    /// Every setting with its value and its origin, in the order of the manual.
    pub fn listing(&self) -> Vec<Listed> {
        RENDERER_SETTINGS
            .fields
            .iter()
            .map(|field| {
                let (origin, node) = self.deciding(field.name);
                Listed { name: field.name, value: text_of(node, field), origin }
            })
            .collect()
    }
}

/// A setting's value as text.
fn text_of(node: &Node, field: &Field) -> String {
    if field.presence == Presence::Repeated {
        let blocks: Vec<String> = node.nodes(field.name).map(block_text).collect();
        return if blocks.is_empty() { "-".to_owned() } else { blocks.join("; ") };
    }
    if node.is_block(field.name) {
        return node.node(field.name).map_or_else(|| "-".to_owned(), block_text);
    }
    node.value(field.name).map_or_else(|| "-".to_owned(), |v| value_text(&v.value))
}

fn block_text(node: &Node) -> String {
    let fields = node.block.fields.iter().map(|f| format!("{}={}", f.name, text_of(node, f)));
    let mut words: Vec<String> = fields.collect();
    if let Some(chosen) = node.alternative() {
        words.push(format!("{} {}", chosen.block.name, block_text(chosen)).trim_end().to_owned());
    }
    words.join(" ")
}

fn value_text(value: &Value) -> String {
    let join = |v: &[f64]| v.iter().map(f64::to_string).collect::<Vec<_>>().join(" ");
    match value {
        Value::Flag => "present".to_owned(),
        Value::Bool(b) => b.to_string(),
        Value::Int(i) => i.to_string(),
        Value::Real(r) => r.to_string(),
        Value::Vec3(v) => join(v),
        Value::Matrix3(v) => join(v),
        Value::Reals(v) => join(v),
        Value::Text(t) => t.clone(),
    }
}
