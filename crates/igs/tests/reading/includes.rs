//! Files that bring in other files.

use crate::common::{Files, Read};
use indigo_decl::{ResolveError, Resolved, Resolver};
use indigo_diag::{Sink, SourceMap, Style, to_text};
use indigo_igs::{Limits, read_scene};

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
        let found = read.findings();
        assert!(found.len() == 1 && found[0].starts_with("E0011 "), "{found:?}");
    }
    let small = Limits { file_bytes: 10, ..Limits::default() };
    assert_eq!(Read::of(&files, &small).findings(), ["E0011"]);
}

/// Files as on a disk that does not tell upper and lower case apart, and knows `.` and `..`.
struct Disk(Files);

impl Resolver for Disk {
    fn read(&self, path: &str, from: &str) -> Result<Resolved, ResolveError> {
        let name = path.rsplit('/').next().unwrap_or_default().to_lowercase();
        let found = self.0.read(&name, from)?;
        Ok(Resolved { path: path.to_owned(), ..found })
    }
}

#[test]
fn a_circle_is_one_however_its_files_are_written() {
    for way in ["./scene.igs", "x/../scene.igs", "./x/./../scene.igs", "SCENE.igs"] {
        let files = Disk(Files::new([("scene.igs", &format!("<scene>{}</scene>", include(way)))]));
        let (mut sources, mut sink) = (SourceMap::default(), Sink::new());
        read_scene("scene.igs", &files, &mut sources, &mut sink, &Limits::default());
        let codes: Vec<&str> = sink.diagnostics().iter().map(|d| d.code).collect();
        assert_eq!(codes, ["E0010"], "{way}");
    }
}

#[test]
fn a_large_circle_is_told_by_its_ends() {
    let texts: Vec<(String, String)> = (0..12)
        .map(|i| {
            (format!("f{i}"), format!("<scenedata>{}</scenedata>", include(&format!("f{}", (i + 1) % 12))))
        })
        .chain([("scene.igs".to_owned(), format!("<scene>{}</scene>", include("f0")))])
        .collect();
    let files: [(&str, &str); 13] = std::array::from_fn(|i| (&*texts[i].0, &*texts[i].1));
    let read = Read::of(&Files::new(files), &Limits::default());
    assert_eq!(read.sink.diagnostics().len(), 1);
    let message = &read.sink.diagnostics()[0].message;
    assert_eq!(message, "f0 includes itself: f0 -> f1 -> ... -> f11 -> f0");
}

#[test]
fn what_is_no_text_is_one_error() {
    let mut picture = b"\x89PNG\r\n\x1A\n\0\0\0\rIHDR".to_vec();
    picture.extend((0..5000_u32).map(|i| (i * 37 % 251) as u8));
    let read = Read::of(&Files::scene(&picture), &Limits::default());
    assert_eq!(read.findings(), ["E0012 1:1"]);
    let text = to_text(&read.sink.diagnostics()[0], &read.sources, Style::Plain);
    assert!(text.contains("not a text file") && !text.contains("IHDR"), "{text}");
}
