//! The scene-format reference, written from the declarations.

use crate::field::{Alternatives, Block, Field, Kind, Presence, Range};
use std::collections::BTreeSet;
use std::fmt::Write as _;

/// The reference of a block and of everything below it, as Markdown.
///
/// Every block is described once, in the order in which it is first met.
pub fn markdown(root: &'static Block) -> String {
    let mut out = String::new();
    let mut seen = BTreeSet::new();
    let mut queue = std::collections::VecDeque::from([root]);
    while let Some(block) = queue.pop_front() {
        if seen.insert(std::ptr::from_ref(block) as usize) {
            describe(&mut out, block);
            queue.extend(inner_blocks(block));
        }
    }
    out
}

fn inner_blocks(block: &'static Block) -> Vec<&'static Block> {
    let mut inner = vec![];
    for field in block.fields {
        match field.kind {
            Kind::Block(b) => inner.push(b),
            Kind::OneOf(a) => inner.extend(a.blocks),
            _ => {}
        }
    }
    inner.extend(block.alternatives.iter().flat_map(|a| a.blocks));
    inner
}

fn describe(out: &mut String, block: &Block) {
    let _ = writeln!(out, "## `{}`\n\n{}\n", block.name, block.doc.trim());
    if !block.aliases.is_empty() {
        let _ = writeln!(out, "Also written {}.\n", code_list(block.aliases));
    }
    if let Some(a) = &block.alternatives {
        let _ = writeln!(
            out,
            "Holds {}{}.\n",
            if a.optional { "at most one of " } else { "exactly one of " },
            alternatives(a)
        );
    }
    if !block.fields.is_empty() {
        out.push_str(
            "| element | type | unit | restriction | default | meaning |\n|---|---|---|---|---|---|\n",
        );
        for field in block.fields {
            describe_field(out, field);
        }
        out.push('\n');
    }
    if !block.later.is_empty() {
        let names: Vec<String> = block.later.iter().map(|l| format!("`{}` ({})", l.name, l.since)).collect();
        let _ = writeln!(out, "Of later format versions, warned of and ignored: {}.\n", names.join(", "));
    }
    if !block.ignored.is_empty() {
        let _ = writeln!(out, "Of old exporters, warned of and ignored: {}.\n", code_list(block.ignored));
    }
    if !block.example.is_empty() {
        let _ = writeln!(out, "```xml\n{}\n```\n", block.example.trim());
    }
}

fn describe_field(out: &mut String, field: &Field) {
    let default = match field.presence {
        Presence::Required => "required".to_owned(),
        Presence::Optional => "optional".to_owned(),
        Presence::Repeated => "any number".to_owned(),
        Presence::Default(text) => format!("`{text}`"),
    };
    let range = if field.range == Range::Any { String::new() } else { field.range.words() };
    let mut doc = field.doc.trim().replace('\n', " ");
    if !field.aliases.is_empty() {
        let _ = write!(doc, " Also written {}.", code_list(field.aliases));
    }
    if !field.deprecated.is_empty() {
        let _ = write!(doc, " **Deprecated:** {}.", field.deprecated.trim_end_matches('.'));
    }
    let _ = writeln!(
        out,
        "| `{}` | {} | {} | {range} | {default} | {} |",
        field.name,
        kind_words(&field.kind),
        field.unit,
        doc.replace('|', "\\|")
    );
}

/// The type of a field in words.
pub fn kind_words(kind: &Kind) -> String {
    match kind {
        Kind::Flag => "empty element".to_owned(),
        Kind::Bool => "boolean".to_owned(),
        Kind::Int => "integer".to_owned(),
        Kind::Real => "real".to_owned(),
        Kind::Vec3 => "3 reals".to_owned(),
        Kind::Matrix3 => "9 reals, row-major".to_owned(),
        Kind::Reals => "reals".to_owned(),
        Kind::Text => "text".to_owned(),
        Kind::Path => "path".to_owned(),
        Kind::Choice(words) => format!("one of {}", words.join(", ")),
        Kind::Name => "name".to_owned(),
        Kind::Reference(what) => format!("name of a {what}"),
        Kind::Block(b) => format!("[`{}`](#{})", b.name, b.name),
        Kind::OneOf(a) => format!("one of {}", alternatives(a)),
        Kind::EmbeddedMesh => "vertices and triangles".to_owned(),
    }
}

fn alternatives(a: &Alternatives) -> String {
    a.blocks.iter().map(|b| format!("[`{}`](#{})", b.name, b.name)).collect::<Vec<_>>().join(", ")
}

fn code_list(names: &[&str]) -> String {
    names.iter().map(|n| format!("`{n}`")).collect::<Vec<_>>().join(", ")
}
