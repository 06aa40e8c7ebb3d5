//! The scene-format reference, written from the declarations.

use crate::codes::Code;
use crate::field::{Alternatives, Block, Field, Kind, Later, Presence, Range};
use crate::parameter::StandIn;
use std::collections::{BTreeMap, VecDeque};
use std::fmt::Write as _;

/// A block and where it was first met.
#[derive(Clone, Copy, Debug)]
struct Entry {
    block: &'static Block,
    /// Name of the block or field that leads to it; empty for the root.
    parent: &'static str,
}

/// Every block at or below `root`, each once, in the order in which it is first met.
pub fn blocks(root: &'static Block) -> Vec<&'static Block> {
    entries(root).into_iter().map(|e| e.block).collect()
}

fn entries(root: &'static Block) -> Vec<Entry> {
    let mut out: Vec<Entry> = vec![];
    let mut queue = VecDeque::from([Entry { block: root, parent: "" }]);
    while let Some(entry) = queue.pop_front() {
        if !out.iter().any(|e| std::ptr::eq(e.block, entry.block)) {
            out.push(entry);
            queue.extend(inner_blocks(entry.block));
        }
    }
    out
}

fn inner_blocks(block: &'static Block) -> Vec<Entry> {
    let mut inner = vec![];
    for field in block.fields {
        match field.kind {
            Kind::Block(b) | Kind::EmbeddedMesh(b) => inner.push(Entry { block: b, parent: block.name }),
            Kind::OneOf(a) => inner.extend(a.blocks.iter().map(|b| Entry { block: b, parent: field.name })),
            _ => {}
        }
    }
    if let Some(a) = &block.alternatives {
        inner.extend(a.blocks.iter().map(|b| Entry { block: b, parent: block.name }));
    }
    inner
}

/// Headings of all blocks: their names, with the parent's where several blocks share a name.
struct Headings(Vec<(Entry, String)>);

impl Headings {
    fn new(entries: &[Entry]) -> Self {
        let mut count: BTreeMap<&str, usize> = BTreeMap::new();
        for e in entries {
            *count.entry(e.block.name).or_default() += 1;
        }
        let heading = |e: &Entry| {
            let name = e.block.name;
            if count[name] > 1 { format!("{name} in {}", e.parent) } else { name.to_owned() }
        };
        Self(entries.iter().map(|e| (*e, heading(e))).collect())
    }

    /// A link to the section of a block.
    fn link(&self, block: &Block) -> String {
        let found = self.0.iter().find(|(e, _)| std::ptr::eq(e.block, block));
        let heading = found.map_or(block.name, |(_, h)| h.as_str());
        format!("[`{}`](#{})", block.name, heading.replace(' ', "-"))
    }

    fn links(&self, a: &Alternatives) -> String {
        a.blocks.iter().map(|b| self.link(b)).collect::<Vec<_>>().join(", ")
    }
}

/// The reference of a block and of everything below it, as Markdown: a list of all elements, then a
/// section for each.
pub fn markdown(root: &'static Block) -> String {
    let entries = entries(root);
    let headings = Headings::new(&entries);
    let mut out = String::from("## All elements\n\n");
    let mut sorted: Vec<&(Entry, String)> = headings.0.iter().collect();
    sorted.sort_by(|a, b| a.1.cmp(&b.1));
    let index: Vec<String> = sorted.iter().map(|(_, h)| format!("[{h}](#{})", h.replace(' ', "-"))).collect();
    let _ = writeln!(out, "{}\n", index.join(" · "));
    for (entry, heading) in &headings.0 {
        describe(&mut out, entry.block, heading, &headings);
    }
    out.truncate(out.trim_end().len());
    out.push('\n');
    out
}

fn describe(out: &mut String, block: &Block, heading: &str, headings: &Headings) {
    let _ = writeln!(out, "## {heading}\n\n{}\n", block.doc.trim());
    if !block.aliases.is_empty() {
        let _ = writeln!(out, "Also written {}.\n", code_list(block.aliases));
    }
    if let Some(a) = &block.alternatives {
        let count = if a.optional { "at most" } else { "exactly" };
        let _ = writeln!(out, "Holds {count} one of {}.\n", headings.links(a));
    }
    describe_fields(out, block, headings);
    for group in block.needs {
        let count = if group.exclusive { "Exactly" } else { "At least" };
        let _ = writeln!(out, "{count} one of {} must be given.\n", code_list(group.fields));
    }
    describe_parameters(out, block);
    let alternatives = block.alternatives.iter().flat_map(|a| a.later);
    let later: Vec<String> = block.later.iter().chain(alternatives).map(later_in_words).collect();
    if !later.is_empty() {
        let _ = writeln!(out, "Of later format versions, and not rendered: {}.\n", later.join(", "));
    }
    if !block.ignored.is_empty() {
        let _ = writeln!(out, "Of old exporters, and ignored: {}.\n", code_list(block.ignored));
    }
    if !block.passed_over.is_empty() {
        let _ = writeln!(out, "Read, and without effect: {}.\n", code_list(block.passed_over));
    }
    if !block.example.is_empty() {
        let _ = writeln!(out, "```xml\n{}\n```\n", block.example.trim());
    }
}

fn later_in_words(later: &Later) -> String {
    let Later { name, since, neutral, .. } = later;
    let unless = if neutral.is_empty() { String::new() } else { format!(", unless it is {neutral}") };
    format!("`{name}` ({since}{unless})")
}

fn describe_parameters(out: &mut String, block: &Block) {
    if block.parameters.is_empty() {
        return;
    }
    out.push_str(
        "As later format versions write it, with a `constant`, a `texture` or a `shader` inside:\n\n",
    );
    out.push_str("| element | since | a constant is | a texture is | in place of what is not rendered |\n|---|---|---|---|---|\n");
    let field = |name: &str| if name.is_empty() { "-".to_owned() } else { format!("`{name}`") };
    for p in block.parameters {
        let instead = match p.stand_in {
            StandIn::Nothing => "nothing",
            StandIn::Text(value) | StandIn::Uniform(value) => value,
        };
        let _ = writeln!(
            out,
            "| `{}` | {} | {} | {} | {instead} |",
            p.name,
            p.since,
            field(p.constant),
            field(p.texture)
        );
    }
    out.push('\n');
}

fn describe_fields(out: &mut String, block: &Block, headings: &Headings) {
    if block.fields.is_empty() {
        return;
    }
    out.push_str("| element | holds | unit | restriction | default | meaning |\n|---|---|---|---|---|---|\n");
    for field in block.fields {
        describe_field(out, field, headings);
    }
    out.push('\n');
}

fn describe_field(out: &mut String, field: &Field, headings: &Headings) {
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
        holds(&field.kind, headings),
        field.unit,
        doc.replace('|', "\\|")
    );
}

fn holds(kind: &Kind, headings: &Headings) -> String {
    match kind {
        Kind::Block(b) | Kind::EmbeddedMesh(b) => headings.link(b),
        Kind::OneOf(a) => format!("a {}: {}", a.what, headings.links(a)),
        Kind::Flag => "nothing".to_owned(),
        Kind::Choice(words) => format!("one of {}", code_list(words)),
        _ => kind.words(),
    }
}

fn code_list(names: &[&str]) -> String {
    names.iter().map(|n| format!("`{n}`")).collect::<Vec<_>>().join(", ")
}

/// A table of diagnostic codes with their meanings and examples, as Markdown, in order of the codes.
pub fn codes(all: &[&[Code]]) -> String {
    let mut codes: Vec<&Code> = all.iter().copied().flatten().collect();
    codes.sort_by_key(|c| c.code);
    let mut out = String::from("| code | meaning | example |\n|---|---|---|\n");
    for c in codes {
        let example = match c.example {
            "" => String::new(),
            prose if prose.starts_with('(') => prose.to_owned(),
            piece => format!("`{}`", piece.replace('|', "\\|")),
        };
        let _ = writeln!(out, "| {} | {} | {example} |", c.code, c.meaning.trim());
    }
    out
}
