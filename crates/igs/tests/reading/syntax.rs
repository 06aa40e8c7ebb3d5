//! Syntax: what is accepted, and where faults are found.

use crate::common::{Files, Read};
use indigo_igs::Limits;

/// Text of the only child called `t`.
fn text_of(body: &str) -> String {
    let read = Read::text(&format!("<scene>{body}</scene>"));
    assert!(read.sink.diagnostics().is_empty(), "{body}: {:?}", read.sink.diagnostics());
    read.root().child("t").expect("t").text.value.to_string()
}

#[test]
fn text_in_all_its_forms() {
    assert_eq!(text_of("<t>\n\t 0.4 0.5 \n</t>"), "0.4 0.5");
    assert_eq!(text_of("<t><![CDATA[ a < b & c ]]></t>"), "a < b & c");
    assert_eq!(text_of("<t>a &lt;<![CDATA[&lt;]]></t>"), "a <&lt;");
    assert_eq!(text_of("<t>1 <!-- one --> <!-- two -->2</t>"), "1  2");
    assert_eq!(text_of("<!==== TITLE ====><t a='1>2' b = \"x\" >x</t ><!========>"), "x");
    assert_eq!(text_of("<!RENDER SETTINGS><t>x</t><!CAMERA a=1>"), "x");
    assert_eq!(text_of("<t/>"), "");
    assert_eq!(text_of("<t>€ größe</t>"), "€ größe");
}

#[test]
fn prologue_and_roots() {
    for text in [
        "\u{FEFF}<?xml version=\"1.0\" encoding=\"utf-8\" ?><scene/>",
        "<?xml version='1.0'?>\n<!-- hello -->\n<scenedata></scenedata>\n<!-- bye -->\n",
    ] {
        assert!(Read::text(text).findings().is_empty(), "{text}");
    }
    for (text, finding) in [
        ("", "E0008 1:1"),
        ("<!-- nothing -->", "E0008 1:1"),
        ("<scen/>", "E0008 1:1"),
        ("<scene/><scene/>", "E0009 1:9"),
        ("<scene/> more", "E0009 1:10"),
        ("<?xml version='1.0' encoding='utf-16'?><scene/>", "E0012 1:1"),
    ] {
        assert_eq!(Read::text(text).findings(), [finding], "{text}");
    }
    let wide: Vec<u8> = "<scene/>".encode_utf16().flat_map(u16::to_le_bytes).collect();
    assert_eq!(Read::of(&Files::scene(&wide), &Limits::default()).findings(), ["E0012 1:1"]);
}

#[test]
fn every_fault_is_found_where_it_is() {
    for (text, findings) in [
        ("<scene>\n<t>a < b</t></scene>", vec!["E0002 2:6"]),
        ("<scene>\n<t>a & b &lol;</t></scene>", vec!["E0003 2:6", "E0003 2:10"]),
        (
            "<scene><t a=1 b/>\n<t a='1' a='2'/><t <u/></t></scene>",
            vec!["E0004 1:13", "E0004 2:10", "E0004 2:17"],
        ),
        ("<scene><t a='1></t></scene>", vec!["E0004 1:13"]),
        ("<scene>\n<max depth>3</max depth></scene>", vec!["E0004 2:6", "E0004 2:19"]),
        ("<scene><a><b></a></scene>", vec!["E0006 1:11"]),
        ("<scene><colour>1</color></scene>", vec!["E0006 1:17"]),
        ("<scene><a></zebra></a></scene>", vec!["E0006 1:11"]),
        ("<scene><a><b>", vec!["E0005 1:11"]),
        ("<scene><a ", vec!["E0005 1:8"]),
        ("<scene><!-- a", vec!["E0005 1:8"]),
        ("<scene><![CDATA[", vec!["E0005 1:8"]),
        ("<!DOCTYPE s [<!ENTITY a 'b'>]><scene>&a;</scene>", vec!["E0007 1:1", "E0003 1:38"]),
        ("<scene><!ELEMENT a ANY><!NOTATION b></scene>", vec!["E0007 1:8", "E0007 1:24"]),
    ] {
        assert_eq!(Read::text(text).findings(), findings, "{text}");
    }
}

#[test]
fn what_stands_beside_a_fault_is_kept() {
    let read = Read::text("<scene><a>1</a><b x=></b><c>3</c></d></scene>");
    let names: Vec<&str> = read.root().children.iter().map(|c| &*c.name).collect();
    assert_eq!(names, ["a", "b", "c"]);
    let cut = Read::text("<scene><a>1</a><b><c>2</c>");
    assert_eq!(cut.root().children.len(), 1, "an element that was cut off is left out");
}

#[test]
fn bytes_that_are_not_utf8_are_latin1_with_one_warning() {
    let files = Files::scene(b"<scene><!-- \xE4 --><t>gr\xF6\xDFe</t><t>\xE4</t></scene>");
    let read = Read::of(&files, &Limits::default());
    assert_eq!(read.findings(), ["W0001 1:23"]);
    assert_eq!(&*read.root().child("t").expect("t").text.value, "größe");
    let declared = Files::scene(b"<?xml version='1.0' encoding='ISO-8859-1'?><scene><t>\xE4</t></scene>");
    assert!(Read::of(&declared, &Limits::default()).findings().is_empty());
}

#[test]
fn depth_and_number_of_elements_are_limited() {
    let deep = format!("<scene>{}", "<a>".repeat(100_000));
    assert_eq!(Read::text(&deep).findings(), ["E0011 1:305"]);
    let many = format!("<scene>{}</scene>", "<a/>".repeat(100));
    let limits = Limits { elements: 50, ..Limits::default() };
    let read = Read::of(&Files::scene(many.as_bytes()), &limits);
    assert_eq!(read.findings(), ["E0011 1:204"]);
    assert_eq!(read.root().children.len(), 49);
}
