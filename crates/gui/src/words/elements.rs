//! What the window says of a scene's elements, most of it from their declarations: the fourth part of its list of words.

use indigo_decl::{Field, Meaning, Presence, Range};
use indigo_front::messages::count;

/// How many elements are to be changed.
pub fn changes(n: usize) -> String {
    if n == 0 { "No changes".to_owned() } else { count(n, "change") }
}

/// The second and further of elements of one name.
pub fn one_of_many(title: &str, number: usize) -> String {
    format!("{title} ({number})")
}

/// Elements that are not listed.
pub fn more_elements(n: usize) -> String {
    format!("and {n} more")
}

/// Texts that are not what they should be.
pub fn faulty(n: usize) -> String {
    let them = if n == 1 { "it" } else { "them" };
    format!("{} invalid: correct {them} under Scene, Elements first", of_values(n))
}

fn of_values(n: usize) -> String {
    if n == 1 { "1 value is".to_owned() } else { format!("{n} values are") }
}

/// Changed elements that would be lost.
pub fn unsaved(n: usize) -> String {
    format!("{} to the scene's elements would be lost.", count(n, "change"))
}

/// Changes of elements that are not there any more as they were.
pub fn lost_changes(n: usize) -> String {
    format!("{} to elements that the file no longer holds as they were: lost", count(n, "change"))
}

/// Adds something to an element.
pub fn add_to(name: &str) -> String {
    format!("Add an element to {name}, with the value that holds without it")
}

/// Does not add it after all.
pub fn take_back(name: &str) -> String {
    format!("Do not add {name}")
}

/// What holds without a field.
pub fn default(field: &Field, text: &str) -> String {
    let text = if text.is_empty() { "empty" } else { text };
    match unit_beside(field) {
        "" => text.to_owned(),
        unit => format!("{text} {unit}"),
    }
}

/// A unit as far as it can stand beside a number; empty for none.
pub fn unit_beside(field: &Field) -> &'static str {
    // Some depend on what the number is used for, which takes a sentence.
    if field.unit.contains(',') { "" } else { field.unit }
}

/// What the declarations say of an element.
pub fn meaning(meaning: Meaning) -> String {
    match meaning {
        Meaning::Value(field) => declared(field),
        Meaning::Unknown => "Unknown to the format: it is ignored".to_owned(),
        Meaning::Later(later) => {
            format!("Of a later version of the format ({}): it {}", later.since, later.instead)
        }
        Meaning::Parameter(Some(field), _) if meaning.value().is_some() => declared(field),
        _ => {
            meaning.docs().map(plain).into_iter().filter(|doc| !doc.is_empty()).collect::<Vec<_>>().join("\n")
        }
    }
}

/// What is declared of a value: what it means, what it may be, and what holds without it.
pub fn declared(field: &Field) -> String {
    let unit = if field.unit.is_empty() { String::new() } else { format!(" ({})", field.unit) };
    let mut facts = vec![format!("{}{unit}", capital(&field.kind.words()))];
    if field.range != Range::Any {
        facts.push(field.range.words());
    }
    match field.presence {
        Presence::Required => facts.push("required".to_owned()),
        Presence::Default(text) => facts.push(format!("{} if not given", default(field, text))),
        Presence::Optional | Presence::Repeated => {}
    }
    let mut lines = vec![plain(field.doc), format!("{}.", facts.join(", "))];
    if !field.deprecated.is_empty() {
        lines.push(format!("Deprecated: {}.", field.deprecated.trim_end_matches('.')));
    }
    lines.join("\n")
}

/// Words of the reference without its marks for code.
fn plain(doc: &str) -> String {
    doc.trim().replace('`', "").replace('\n', " ")
}

/// Words with a capital letter in front.
pub(super) fn capital(words: &str) -> String {
    let mut letters = words.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use indigo_decl::Kind;

    #[test]
    fn a_declaration_is_told_in_full() {
        let field = Field::new("radius", Kind::Real, Presence::Default("0.5"), "How `far`.");
        let field = field.unit("m").range(Range::Above(0.0));
        assert_eq!(declared(&field), "How far.\nA number (m), must be > 0, 0.5 m if not given.");
        let field =
            Field::new("name", Kind::Name, Presence::Required, "Its name.").deprecated("write another");
        assert_eq!(declared(&field), "Its name.\nA name, required.\nDeprecated: write another.");
    }
}
