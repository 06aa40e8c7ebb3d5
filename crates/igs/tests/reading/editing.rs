//! Changes in the text of scenes: what they look like, and what is refused.

use crate::common::{Files, Read};
use indigo_decl::Element;
use indigo_igs::Limits;
use indigo_igs::edit::{EditError, Edits, range_of};

/// The text of a scene after changes.
fn edited(text: &str, change: impl FnOnce(&Element, &mut Edits)) -> String {
    let bytes = edited_bytes(text.as_bytes(), change);
    String::from_utf8(bytes).unwrap()
}

fn edited_bytes(bytes: &[u8], change: impl FnOnce(&Element, &mut Edits)) -> Vec<u8> {
    let read = Read::of(&Files::scene(bytes), &Limits::default());
    let mut edits = Edits::default();
    change(read.root(), &mut edits);
    let files = edits.apply(&read.sources).unwrap();
    files.into_iter().next().map_or_else(|| bytes.to_vec(), |file| file.bytes)
}

fn refused(text: &str, change: impl FnOnce(&Element, &mut Edits)) -> EditError {
    let read = Read::text(text);
    let mut edits = Edits::default();
    change(read.root(), &mut edits);
    edits.apply(&read.sources).unwrap_err()
}

#[test]
fn a_text_takes_the_place_of_the_old_one_alone() {
    let scene =
        "<scene>\r\n  <a  b='1'> 1 <!-- one --> more </a>\r\n  <b/><c></c><d><![CDATA[ x ]]></d>\r\n</scene>";
    let changed = edited(scene, |root, edits| {
        edits.set_text(&root.children[0], " 2 & <3> ");
        edits.set_text(&root.children[1], "line\nline");
        edits.set_text(&root.children[2], "c");
        edits.set_text(&root.children[3], "y");
    });
    assert_eq!(
        changed,
        "<scene>\r\n  <a  b='1'> 2 &amp; &lt;3&gt; <!-- one -->  </a>\r\n  <b>line\r\nline</b><c>c</c><d>y</d>\r\n</scene>"
    );
}

#[test]
fn children_are_put_behind_the_others_and_indented_like_them() {
    let scene =
        "<scene>\n    <a>\n        <b>1</b> <!-- of b -->\n    </a>\n    <c/>\n    <d><e/></d>\n</scene>\n";
    let changed = edited(scene, |root, edits| {
        edits.set_child(root, "a/new", "2").unwrap();
        edits.set_child(root, "c/x/y", "3").unwrap();
        edits.set_child(root, "c/x/z", "4").unwrap();
        edits.set_child(root, "d/f", "5").unwrap();
        edits.set_child(root, "last", "6").unwrap();
    });
    assert_eq!(
        changed,
        "<scene>\n    <a>\n        <b>1</b> <!-- of b -->\n        <new>2</new>\n    </a>\n    <c>\n        <x>\n            \
         <y>3</y>\n            <z>4</z>\n        </x>\n    </c>\n    <d><e/><f>5</f></d>\n    <last>6</last>\n</scene>\n"
    );
}

#[test]
fn a_child_that_is_there_gets_another_text() {
    let scene = "<scene><tonemapping><linear><scale>1</scale></linear></tonemapping></scene>";
    let path = "tonemapping/linear/scale";
    let changed = edited(scene, |root, edits| {
        edits.set_child(root, path, "2").unwrap();
        edits.set_child(root, path, "3").unwrap();
    });
    assert_eq!(changed, scene.replace('1', "3"));
}

#[test]
fn an_element_is_replaced_with_the_indentation_of_its_place() {
    let scene = "<scene>\r\n\t<a>\r\n\t\t<b/>\r\n\t</a> <!-- why -->\r\n</scene>";
    let changed = edited(scene, |root, edits| {
        edits.replace(&root.children[0], "<n>\n  <!-- new -->\n  <m>1</m>\n</n>\n").unwrap();
    });
    assert_eq!(
        changed,
        "<scene>\r\n\t<n>\r\n\t  <!-- new -->\r\n\t  <m>1</m>\r\n\t</n> <!-- why -->\r\n</scene>"
    );
    // Comments that were in it stay, each once; what looks like one is none.
    let scene = "<scene>\n  <a>\n    <!-- one -->\n    <b>1</b> <!-- two\n lines -->\n    <c><![CDATA[<!-- no -->]]></c>\n  </a>\n</scene>";
    let changed =
        edited(scene, |root, edits| edits.replace(&root.children[0], "<n><!-- one --></n>").unwrap());
    assert_eq!(changed, "<scene>\n  <n><!-- one --></n>\n  <!-- two\n lines -->\n</scene>");
    // The text of an element as it stands is no change.
    let same = edited(scene, |root, edits| {
        let sources = Read::text(scene).sources;
        let range = range_of(&root.children[0], &sources).unwrap();
        edits.replace(&root.children[0], &scene[range]).unwrap();
    });
    assert_eq!(same, scene);
}

#[test]
fn an_element_goes_with_its_line() {
    let scene = "<scene>\n  <a/>\n  <b>\n  </b>\n  <c/> <d/>\n</scene>";
    let changed = edited(scene, |root, edits| {
        edits.remove(&root.children[1]);
        edits.remove(&root.children[2]);
    });
    assert_eq!(changed, "<scene>\n  <a/>\n   <d/>\n</scene>");
}

#[test]
fn latin1_stays_latin1() {
    let scene = b"<?xml version='1.0' encoding='ISO-8859-1'?>\n<scene><a>gr\xF6n</a><b>x</b></scene>";
    let changed = edited_bytes(scene, |root, edits| edits.set_text(&root.children[1], "blå €"));
    assert_eq!(
        changed,
        b"<?xml version='1.0' encoding='ISO-8859-1'?>\n<scene><a>gr\xF6n</a><b>bl\xE5 &#8364;</b></scene>"
    );
    let read = Read::of(&Files::scene(scene), &Limits::default());
    let mut edits = Edits::default();
    edits.replace(&read.root().children[0], "<a>€</a>").unwrap();
    let error = edits.apply(&read.sources).unwrap_err();
    assert_eq!(error.to_string(), "the file is in Latin-1, which has no `€`; expected &#8364;");
}

#[test]
fn bytes_of_no_encoding_stay_as_they_are() {
    let changed = edited_bytes(b"\xEF\xBB\xBF<scene><a>\xFF</a><b>1</b></scene>", |root, edits| {
        edits.set_text(&root.children[1], "é");
    });
    assert_eq!(changed, b"\xEF\xBB\xBF<scene><a>\xFF</a><b>\xC3\xA9</b></scene>");
}

#[test]
fn elements_are_changed_in_the_file_that_they_come_from() {
    let files = Files::new([
        ("scene.igs", "<scene>\n<include><pathname>lamp.igs</pathname></include>\n<a>1</a>\n</scene>"),
        ("lamp.igs", "<scenedata>\n<lamp>1</lamp>\n</scenedata>"),
    ]);
    let read = Read::of(&files, &Limits::default());
    let mut edits = Edits::default();
    edits.set_child(read.root(), "lamp", "2").unwrap();
    let changed = edits.apply(&read.sources).unwrap();
    assert_eq!(changed.len(), 1);
    assert_eq!(changed[0].path, "lamp.igs");
    assert_eq!(read.sources.name(changed[0].source), "lamp.igs");
    assert_eq!(changed[0].bytes, b"<scenedata>\n<lamp>2</lamp>\n</scenedata>");
}

#[test]
fn a_file_that_is_included_twice_is_changed_once() {
    let files = Files::new([
        (
            "scene.igs",
            "<scene><include><pathname>b</pathname></include><include><pathname>b</pathname></include></scene>",
        ),
        ("b", "<scene><b>1</b><c>1</c></scene>"),
    ]);
    let read = Read::of(&files, &Limits::default());
    let [b, _, second_b, second_c] = &read.root().children[..] else { panic!("four elements") };
    let mut edits = Edits::default();
    edits.set_text(b, "2");
    edits.set_text(second_c, "3");
    let changed = edits.apply(&read.sources).unwrap();
    assert_eq!(changed.len(), 1);
    assert_eq!(changed[0].bytes, b"<scene><b>2</b><c>3</c></scene>");
    edits.set_text(second_b, "4");
    assert_eq!(edits.apply(&read.sources).unwrap_err(), EditError::Overlap(second_b.span));
}

#[test]
fn no_change_is_no_file() {
    let scene = "<scene><a>1</a></scene>";
    let read = Read::text(scene);
    let mut edits = Edits::default();
    assert!(edits.is_empty());
    edits.set_text(&read.root().children[0], "1");
    assert!(!edits.is_empty());
    assert_eq!(edits.apply(&read.sources), Ok(vec![]));
}

#[test]
fn what_cannot_be_done_is_refused_with_its_place() {
    let overlap = refused("<scene><a><b/></a></scene>", |root, edits| {
        edits.remove(&root.children[0]);
        edits.set_text(&root.children[0].children[0], "1");
    });
    assert!(matches!(overlap, EditError::Overlap(span) if span.start == 10), "{overlap:?}");
    let malformed = refused("<scene><a><b></a><c>1</c></scene>", |root, edits| {
        edits.set_text(&root.children[1], "2");
    });
    assert!(matches!(malformed, EditError::Malformed(span) if span.start == 13), "{malformed:?}");
    let elsewhere = refused("<scene><a/></scene>", |root, edits| {
        let mut other = root.children[0].clone();
        other.name = "b".into();
        edits.set_text(&other, "2");
    });
    assert!(elsewhere.to_string().starts_with("there is no <b> in the file here"), "{elsewhere}");
}

#[test]
fn only_whole_elements_and_names_are_taken() {
    let read = Read::text("<scene><a/></scene>");
    let (root, mut edits) = (read.root(), Edits::default());
    for bad in ["", "text", "<a>", "<a/><b/>", "<a/> x", "<a></b>", "<?xml version='1.0'?><a/>", "<a b=1/>"] {
        assert!(matches!(edits.replace(root, bad), Err(EditError::BadText { .. })), "{bad}");
    }
    for bad in ["", "a/", "/a", "a b", "1", "a<b", "ä"] {
        assert!(matches!(edits.set_child(root, bad, "1"), Err(EditError::BadName(_))), "{bad}");
    }
    assert!(edits.is_empty());
}

#[test]
fn faults_that_are_no_matter_of_tags_can_be_mended() {
    let changed = edited("<scene><a>1 < 2 & 3</a></scene>", |root, edits| {
        edits.set_text(&root.children[0], "1");
    });
    assert_eq!(changed, "<scene><a>1</a></scene>");
}
