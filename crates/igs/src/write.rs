//! Trees to text.

use indigo_decl::{Alternatives, Block, Element, EmbeddedMesh, Kind};
use std::collections::HashSet;
use std::fmt::Write as _;

/// How what is written is laid out.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Layout {
    /// What ends a line; empty for everything in one line.
    pub newline: String,
    /// What stands before the outermost element in each of its lines.
    pub base: String,
    /// What children are indented by.
    pub unit: String,
}

/// An element and all below it as XML, indented; what [`read_document`](crate::read_document) reads
/// back is the same, places apart.
///
/// Text is written without blanks around it. Characters that XML cannot hold are left out.
pub fn write(element: &Element) -> String {
    let layout = Layout { newline: "\n".into(), base: String::new(), unit: "\t".into() };
    let mut writer = Writer { out: HEAD.to_owned(), layout: &layout, said: None };
    writer.element(element, None, 0);
    writer.out
}

/// The same of an element of a declaration, with comments: `title` in front, and before the first element of each kind what
/// that is.
pub fn write_explained(element: &Element, block: &'static Block, title: &str) -> String {
    let layout = Layout { newline: "\n".into(), base: String::new(), unit: "\t".into() };
    let mut writer = Writer { out: HEAD.to_owned(), layout: &layout, said: Some(HashSet::new()) };
    writer.comment(title, 0);
    writer.element(element, Some(Declared::Block(block)), 0);
    writer.out
}

const HEAD: &str = "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n";

/// An element and all below it, without blanks before and after it.
pub(crate) fn fragment(element: &Element, layout: &Layout) -> String {
    let mut writer = Writer { out: String::new(), layout, said: None };
    writer.element(element, None, 0);
    writer.out.trim_ascii().to_owned()
}

/// A text as it stands between tags and in the quotes of an attribute.
pub(crate) fn escape(out: &mut String, text: &str) {
    for c in text.chars() {
        match c {
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '&' => out.push_str("&amp;"),
            '"' => out.push_str("&quot;"),
            '\r' => out.push_str("&#13;"),
            c if c < ' ' && !matches!(c, '\t' | '\n') => {}
            c => out.push(c),
        }
    }
}

/// How an element with children is declared.
#[derive(Clone, Copy)]
enum Declared {
    Block(&'static Block),
    OneOf(&'static Alternatives),
}

impl Declared {
    /// What a child of a name is, the unit of its numbers, and how it is declared itself if it has children.
    fn child(self, name: &str) -> Option<(&'static str, &'static str, Option<Self>)> {
        let alternatives = match self {
            Self::Block(block) => {
                if let Some(field) = block.fields.iter().find(|field| field.is_called(name)) {
                    let declared = match field.kind {
                        Kind::Block(inner) => Some(Self::Block(inner)),
                        Kind::OneOf(alternatives) => Some(Self::OneOf(alternatives)),
                        _ => None,
                    };
                    return Some((field.doc, field.unit, declared));
                }
                block.alternatives.as_ref()?
            }
            Self::OneOf(alternatives) => alternatives,
        };
        let chosen = alternatives.blocks.iter().find(|block| block.is_called(name))?;
        Some((chosen.doc, "", Some(Self::Block(chosen))))
    }
}

/// The first sentence of a documentation, without its marks. A point before a small letter or a digit is that of an
/// abbreviation, and one behind a single letter that of a first name.
fn first_sentence(doc: &str) -> String {
    let is_initial = |at: usize| {
        let mut before = doc[..at].chars().rev();
        before.next().is_some_and(char::is_uppercase) && before.next().is_none_or(|c| !c.is_alphanumeric())
    };
    let is_small = |at: usize| doc[at + 2..].starts_with(|c: char| c.is_lowercase() || c.is_ascii_digit());
    let goes_on = |at: usize| is_small(at) || is_initial(at);
    let end = doc.match_indices(". ").map(|(at, _)| at).find(|at| !goes_on(*at)).unwrap_or(doc.len());
    let sentence = doc[..end].trim_end_matches('.');
    sentence.split_whitespace().collect::<Vec<_>>().join(" ").replace('`', "")
}

struct Writer<'a> {
    out: String,
    layout: &'a Layout,
    /// What was explained before, if anything is.
    said: Option<HashSet<&'static str>>,
}

impl Writer<'_> {
    fn comment(&mut self, text: &str, depth: usize) {
        self.indent(depth);
        self.out.push_str("<!-- ");
        for c in text.chars().filter(|c| *c >= ' ') {
            // No comment can hold two dashes side by side.
            if c == '-' && self.out.ends_with('-') {
                self.out.push(' ');
            }
            self.out.push(c);
        }
        self.out.push_str(" -->");
        self.end_line();
    }

    /// A child of an element that is declared like this.
    fn child(&mut self, element: &Element, parent: Option<Declared>, depth: usize) {
        let found = parent.and_then(|parent| parent.child(&element.name));
        if let Some((doc, unit, _)) = found
            && self.said.as_mut().is_some_and(|said| !doc.is_empty() && said.insert(doc))
        {
            let unit = if unit.is_empty() { String::new() } else { format!(" ({unit})") };
            self.comment(&(first_sentence(doc) + &unit), depth);
        }
        self.element(element, found.and_then(|(_, _, declared)| declared), depth);
    }

    fn element(&mut self, element: &Element, declared: Option<Declared>, depth: usize) {
        self.indent(depth);
        let _ = write!(self.out, "<{}", element.name);
        for a in &element.attributes {
            let _ = write!(self.out, " {}=\"", a.name.value);
            escape(&mut self.out, &a.value.value);
            self.out.push('"');
        }
        let text = &element.text.value;
        if element.children.is_empty() && element.mesh.is_none() {
            if text.is_empty() {
                self.out.push_str("/>");
            } else {
                self.out.push('>');
                escape(&mut self.out, text);
                let _ = write!(self.out, "</{}>", element.name);
            }
            self.end_line();
            return;
        }
        self.out.push('>');
        escape(&mut self.out, text);
        self.end_line();
        if let Some(mesh) = &element.mesh {
            self.mesh(mesh, depth + 1);
        }
        for child in &element.children {
            self.child(child, declared, depth + 1);
        }
        self.indent(depth);
        let _ = write!(self.out, "</{}>", element.name);
        self.end_line();
    }

    fn indent(&mut self, depth: usize) {
        self.out.push_str(&self.layout.base);
        self.out.extend(std::iter::repeat_n(self.layout.unit.as_str(), depth));
    }

    fn end_line(&mut self) {
        self.out.push_str(&self.layout.newline);
    }

    fn numbers<const N: usize>(&mut self, name: &str, values: [f32; N]) {
        let _ = write!(self.out, " {name}=\"");
        for (i, v) in values.iter().enumerate() {
            let _ = write!(self.out, "{}{v}", if i == 0 { "" } else { " " });
        }
        self.out.push('"');
    }

    fn mesh(&mut self, mesh: &EmbeddedMesh, depth: usize) {
        let data = &mesh.data;
        for (name, index) in &data.uv_names {
            self.indent(depth);
            let _ = write!(self.out, "<expose_uv_set><index>{index}</index><name>");
            escape(&mut self.out, name);
            self.out.push_str("</name></expose_uv_set>");
            self.end_line();
        }
        for (i, &p) in data.positions.iter().enumerate() {
            self.indent(depth);
            self.out.push_str("<vertex");
            self.numbers("pos", p);
            if let Some(&n) = data.normals.get(i) {
                self.numbers("normal", n);
            }
            for (set, values) in data.uv_sets.iter().enumerate() {
                if let Some(&uv) = values.get(i) {
                    self.numbers(&format!("uv{set}"), uv);
                }
            }
            self.out.push_str("/>");
            self.end_line();
        }
        self.unordered_names(mesh, depth);
        // Those without area close the surface.
        let degenerate = data.degenerate.iter().zip(&data.degenerate_materials);
        let triangles: Vec<(&[u32; 3], &u32)> =
            data.triangles.iter().zip(&data.triangle_materials).chain(degenerate).collect();
        for run in triangles.chunk_by(|a, b| a.1 == b.1) {
            self.triangle_set(mesh, run, depth);
        }
    }

    /// Sets without triangles for all materials, where those that have some would number them otherwise: models may
    /// name materials by these numbers.
    fn unordered_names(&mut self, mesh: &EmbeddedMesh, depth: usize) {
        let mut next = 0;
        for &material in mesh.data.triangle_materials.iter().chain(&mesh.data.degenerate_materials) {
            if material > next {
                break;
            }
            next = next.max(material + 1);
        }
        if next as usize == mesh.data.material_names.len() {
            return;
        }
        for name in &mesh.data.material_names {
            self.indent(depth);
            self.out.push_str("<triangle_set><material_name>");
            escape(&mut self.out, name);
            self.out.push_str("</material_name></triangle_set>");
            self.end_line();
        }
    }

    fn triangle_set(&mut self, mesh: &EmbeddedMesh, run: &[(&[u32; 3], &u32)], depth: usize) {
        let material = run.first().and_then(|(_, m)| mesh.data.material_names.get(**m as usize));
        self.indent(depth);
        self.out.push_str("<triangle_set><material_name>");
        escape(&mut self.out, material.map_or("", String::as_str));
        self.out.push_str("</material_name>");
        self.end_line();
        for ([a, b, c], _) in run {
            self.indent(depth + 1);
            let _ = write!(self.out, "<tri>{a} {b} {c}</tri>");
            self.end_line();
        }
        self.indent(depth);
        self.out.push_str("</triangle_set>");
        self.end_line();
    }
}

#[cfg(test)]
mod tests {
    use super::first_sentence;

    #[test]
    fn sentences_end_before_capital_letters() {
        let doc = "The `pos` of a lamp, e.g. one of a room (fig. 3). It is in metres.";
        assert_eq!(first_sentence(doc), "The pos of a lamp, e.g. one of a room (fig. 3)");
        assert_eq!(first_sentence("A sphere."), "A sphere");
        assert_eq!(first_sentence("Burns: E. Reinhard, 2002. More."), "Burns: E. Reinhard, 2002");
    }
}
