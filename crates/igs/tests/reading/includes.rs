//! Files that bring in other files.

use crate::common::{Files, Read};
use indigo_diag::{Style, to_text};
use indigo_igs::Limits;

fn include(name: &str) -> String {
    format!("<include><pathname>{name}</pathname></include>")
}

#[test]
fn children_stand_where_the_include_stood() {
    let main = format!("<scene><a/>{}<d/>{}</scene>", include("one"), include("two"));
    let one = format!("<scenedata><b/>{}<c/></scenedata>", include("two"));
    let files = Files::new([("scene.igs", &main), ("one", &one), ("two", "<scene><x/></scene>")]);
    let read = Read::of(&files, &Limits::default());
    assert!(read.findings().is_empty());
    let names: String = read.root().children.iter().map(|c| &*c.name).collect();
    assert_eq!(names, "abxcdx");
}

#[test]
fn a_circle_is_named_with_all_its_files() {
    let files = Files::new([
        ("scene.igs", &format!("<scene>{}</scene>", include("one"))),
        ("one", &format!("<scenedata>\n{}</scenedata>", include("two"))),
        ("two", &format!("<scenedata><a/>{}</scenedata>", include("one"))),
    ]);
    let read = Read::of(&files, &Limits::default());
    assert_eq!(read.findings(), ["E0010 1:35"]);
    assert_eq!(read.root().children.len(), 1);
    let text = to_text(&read.sink.diagnostics()[0], &read.sources, Style::Plain);
    assert!(text.contains("one -> two -> one"), "{text}");
    assert!(text.contains("included from one:2:20\n"), "{text}");
    assert!(text.contains("included from scene.igs:1:27\n"), "{text}");
}

#[test]
fn missing_files_and_wrong_roots_do_not_stop_the_others() {
    let main = format!("<scene>{}{}{}<a/></scene>", include("none"), include("ini"), include(""));
    let files = Files::new([("scene.igs", &main), ("ini", "<settings><width>3</width></settings>")]);
    let read = Read::of(&files, &Limits::default());
    assert_eq!(read.findings(), ["E0001 1:27", "E0008 1:1", "E0202 1:104"]);
    assert_eq!(read.root().children.len(), 1);
}

#[test]
fn depth_number_and_size_are_limited() {
    // Each file includes the next one twice: without limits, 2^30 files.
    let mut files = vec![("scene.igs".to_owned(), format!("<scene>{0}{0}</scene>", include("f0")))];
    for i in 0..30 {
        let next = include(&format!("f{}", i + 1));
        files.push((format!("f{i}"), format!("<scenedata>{next}{next}</scenedata>")));
    }
    files.push(("f30".to_owned(), "<scenedata/>".to_owned()));
    let files: [(&str, &str); 32] = std::array::from_fn(|i| (&*files[i].0, &*files[i].1));
    let files = Files::new(files);
    for limits in [
        Limits { include_depth: 3, ..Limits::default() },
        Limits { files: 20, ..Limits::default() },
        Limits { total_bytes: 1000, ..Limits::default() },
    ] {
        let read = Read::of(&files, &limits);
        assert!(read.findings().iter().all(|f| f.starts_with("E0011 ")), "{:?}", read.findings());
        assert!(read.sink.has_errors());
    }
    let small = Limits { file_bytes: 10, ..Limits::default() };
    assert_eq!(Read::of(&files, &small).findings(), ["E0011"]);
}
