//! Law: a changed text reads as the tree that was read, but for the change, and keeps all comments.

use crate::common::{Files, Read};
use crate::properties::{HERE, element, placeless, text};
use indigo_decl::Element;
use indigo_igs::edit::{EditError, Edits, range_of};
use indigo_igs::{Limits, write};
use proptest::collection::vec;
use proptest::prelude::*;
use std::fmt::Write as _;

/// One change, of the element that comes `pick`th.
#[derive(Clone, Debug)]
enum Change {
    Text(String),
    Child(Vec<String>, String),
    Replace(Element),
    Remove,
}

fn change() -> impl Strategy<Value = Change> {
    let name = "[a-d]{1,2}";
    prop_oneof![
        text().prop_map(Change::Text),
        (vec(name, 1..4), text()).prop_map(|(path, text)| Change::Child(path, text)),
        element().prop_map(Change::Replace),
        Just(Change::Remove),
    ]
}

/// Writes elements in all the ways that people and programs do, as `choices` say.
struct Messy {
    out: String,
    choices: Vec<u8>,
    next: usize,
    newline: &'static str,
    unit: &'static str,
}

impl Messy {
    fn choose(&mut self, n: u8) -> u8 {
        self.next += 1;
        self.choices[self.next % self.choices.len()] % n
    }

    fn line(&mut self, depth: usize) {
        if self.choose(8) == 0 {
            let number = self.next;
            let _ = write!(self.out, " <!-- note {number} <b> -->");
        }
        if self.choose(6) > 0 {
            self.out.push_str(self.newline);
            self.out.extend(std::iter::repeat_n(self.unit, depth));
        }
    }

    fn text(&mut self, text: &str) {
        let escaped = text.replace('&', "&amp;").replace('<', "&lt;").replace('€', "&#8364;");
        match (self.choose(4), text.split_once(' ')) {
            (0, _) => self.out.push_str(&format!("<![CDATA[{text}]]>").replace('€', "E")),
            (1, Some((a, b))) if !text.contains(['&', '<', '€']) => {
                let _ = write!(self.out, "{a} <!-- amid -->\t{b}");
            }
            _ => self.out.push_str(&escaped),
        }
    }

    fn element(&mut self, element: &Element, depth: usize) {
        let _ = write!(self.out, "<{}", element.name);
        for a in &element.attributes {
            let value = a.value.value.replace('&', "&amp;").replace('<', "&lt;").replace('€', "&#8364;");
            let _ = write!(self.out, "  {} = \"{}\"", a.name.value, value.replace('"', "&quot;"));
        }
        if element.children.is_empty() && element.text.value.is_empty() && self.choose(2) == 0 {
            self.out.push_str(" />");
            return;
        }
        self.out.push('>');
        self.text(&element.text.value);
        for child in &element.children {
            self.line(depth + 1);
            self.element(child, depth + 1);
        }
        self.line(depth);
        if self.choose(10) == 0 {
            self.out.push_str("tail");
        }
        let _ = write!(self.out, "</{} >", element.name);
    }
}

/// A scene as bytes of some encoding.
fn scene() -> impl Strategy<Value = Vec<u8>> {
    let newline = proptest::sample::select(vec!["\n", "\r\n", "\r", ""]);
    let unit = proptest::sample::select(vec!["\t", "  ", "", "    "]);
    (vec(element(), 0..4), vec(any::<u8>(), 8..60), newline, unit, 0..3).prop_map(
        |(children, choices, newline, unit, encoding)| {
            let root = Element { children, ..Element::new("scene", HERE) };
            let mut messy = Messy { out: String::new(), choices, next: 0, newline, unit };
            messy.element(&root, 0);
            let text = messy.out;
            match encoding {
                0 => text.into_bytes(),
                1 => [b"\xEF\xBB\xBF", text.as_bytes()].concat(),
                _ => {
                    let latin1 = text.chars().map(|c| u8::try_from(c).unwrap());
                    b"<?xml version='1.0' encoding='latin1'?>".iter().copied().chain(latin1).collect()
                }
            }
        },
    )
}

/// Paths by numbers of children to all elements of a tree.
fn paths(element: &Element, here: &[usize], all: &mut Vec<Vec<usize>>) {
    all.push(here.to_vec());
    for (i, child) in element.children.iter().enumerate() {
        paths(child, &[here, &[i]].concat(), all);
    }
}

fn at<'e>(root: &'e mut Element, path: &[usize]) -> &'e mut Element {
    path.iter().fold(root, |e, &i| &mut e.children[i])
}

/// The tree after a change that moves no element.
fn set(element: &mut Element, change: &Change) {
    match change {
        Change::Text(text) => element.text.value = text.trim_ascii().into(),
        Change::Child(names, text) => {
            let child = names.iter().fold(element, |e, name| {
                let known = e.children.iter().position(|c| &*c.name == name);
                let i = known.unwrap_or_else(|| {
                    e.children.push(Element::new(name, HERE));
                    e.children.len() - 1
                });
                &mut e.children[i]
            });
            set(child, &Change::Text(text.clone()));
        }
        Change::Replace(other) => *element = other.clone(),
        Change::Remove => {}
    }
}

/// Makes every run of blanks in texts one blank.
fn squeeze(element: &mut Element) {
    let words: Vec<&str> = element.text.value.split_ascii_whitespace().collect();
    element.text.value = words.join(" ").into();
    element.children.iter_mut().for_each(squeeze);
}

/// A replacement as it is put in, plain enough for Latin-1.
fn fragment(element: &Element) -> String {
    let text = write(element).replace('€', "&#8364;");
    text.split_once('\n').unwrap().1.to_owned()
}

fn comments(bytes: &[u8]) -> usize {
    bytes.windows(4).filter(|w| w == b"<!--").count()
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 1024,
        rng_seed: proptest::test_runner::RngSeed::Fixed(2008),
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    /// Any changes at once: those of elements where they stand come first, since they move nothing.
    #[test]
    fn a_changed_text_reads_as_the_changed_tree(
        bytes in scene(),
        changes in vec((any::<prop::sample::Index>(), change()), 1..4),
    ) {
        let read = Read::of(&Files::scene(&bytes), &Limits::default());
        prop_assert!(read.sink.diagnostics().is_empty(), "{:?}", read.sink.diagnostics());
        let (mut all, mut expected) = (vec![], read.root().clone());
        paths(&expected, &[], &mut all);
        let mut edits = Edits::default();
        let mut removed = vec![];
        let mut whole = vec![];
        for (pick, change) in &changes {
            let path = pick.get(&all);
            let element = at(&mut expected.clone(), path).clone();
            let original = path.iter().fold(read.root(), |e, &i| &e.children[i]);
            match change {
                // The root must be a scene.
                Change::Replace(_) | Change::Remove if path.is_empty() => continue,
                Change::Text(text) => edits.set_text(original, text),
                Change::Child(names, text) => edits.set_child(original, &names.join("/"), text).unwrap(),
                Change::Replace(other) => edits.replace(original, &fragment(other)).unwrap(),
                Change::Remove => edits.remove(original),
            }
            match change {
                Change::Replace(_) => whole.push((path.clone(), change.clone())),
                Change::Remove => removed.push(path.clone()),
                _ => set(at(&mut expected, path), change),
            }
            prop_assert_eq!(element.name, original.name.clone());
        }
        let files = match edits.apply(&read.sources) {
            Ok(files) => files,
            Err(EditError::Overlap(_)) => {
                prop_assert!(changes.len() > 1, "one change overlaps with itself");
                return Ok(());
            }
            Err(error) => return Err(TestCaseError::fail(error.to_string())),
        };
        if whole.iter().any(|(path, _)| removed.contains(path)) || whole.len() > 1 {
            // Which of two is the last is not the matter here.
            return Ok(());
        }
        for (path, change) in &whole {
            set(at(&mut expected, path), change);
        }
        removed.sort();
        removed.dedup();
        for path in removed.iter().rev() {
            let (last, parent) = path.split_last().unwrap();
            at(&mut expected, parent).children.remove(*last);
        }
        let after = files.into_iter().next().map_or_else(|| bytes.clone(), |file| file.bytes);
        let again = Read::of(&Files::scene(&after), &Limits::default());
        let shown = String::from_utf8_lossy(&after).into_owned();
        prop_assert!(again.sink.diagnostics().is_empty(), "{:?} in {shown}", again.sink.diagnostics());
        let (mut after_root, mut expected) = (placeless(again.root().clone()), placeless(expected));
        if !removed.is_empty() {
            // Two runs of blanks amid text, on both sides of what was removed, have become one.
            squeeze(&mut after_root);
            squeeze(&mut expected);
        }
        prop_assert_eq!(after_root, expected, "{}", shown);
        if whole.is_empty() && removed.is_empty() {
            prop_assert_eq!(comments(&after), comments(&bytes), "{}", shown);
        }
    }

    /// Not one byte before and after the changed element is another.
    #[test]
    fn nothing_else_changes(bytes in scene(), pick in any::<prop::sample::Index>(), new in text()) {
        let read = Read::of(&Files::scene(&bytes), &Limits::default());
        let mut all = vec![];
        paths(read.root(), &[], &mut all);
        let element = pick.get(&all).iter().fold(read.root(), |e, &i| &e.children[i]);
        let range = range_of(element, &read.sources).unwrap();
        let mut edits = Edits::default();
        edits.set_text(element, &new);
        edits.set_child(element, "fresh/deep", &new).unwrap();
        let after = edits.apply(&read.sources).unwrap().remove(0).bytes;
        prop_assert!(after.starts_with(&bytes[..range.start]) && after.ends_with(&bytes[range.end..]));
    }

    #[test]
    fn no_bytes_make_it_panic(bytes in vec(any::<u8>(), 0..200), start in 0_u32..200, new in text()) {
        let scene = [b"<scene><a>", &bytes[..], b"</a><b/></scene>"].concat();
        let read = Read::of(&Files::scene(&scene), &Limits::default());
        let mut elements = read.root.iter().cloned().collect::<Vec<_>>();
        let mut astray = Element::new("a", HERE);
        astray.span.start = start;
        elements.push(astray);
        for element in &elements {
            let mut edits = Edits::default();
            edits.set_text(element, &new);
            edits.set_child(element, "b/c", &new).unwrap();
            let _ = edits.apply(&read.sources);
        }
    }
}
