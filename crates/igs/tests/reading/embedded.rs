//! Embedded meshes: arrays, and the places of faults.

use crate::common::{Files, Read};
use indigo_decl::EmbeddedMesh;
use indigo_diag::{Sink, SourceMap};
use indigo_igs::{Limits, read_scene_until};
use std::cell::Cell;

fn read(inside: &str) -> (EmbeddedMesh, Vec<String>) {
    let text =
        format!("<scene><mesh><name>m</name>\n<embedded>\n{inside}\n</embedded></mesh><after/></scene>");
    let read = Read::text(&text);
    assert_eq!(read.root().children.len(), 2, "{inside}");
    let mesh = read.root().children[0].child("embedded").and_then(|e| e.mesh.clone()).expect("a mesh");
    (*mesh, read.findings())
}

/// A triangle's vertices, as attributes that follow each position.
fn vertices(attributes: [&str; 3]) -> String {
    let pos = ["0 0 0", "1 0 0", "0 1 0"];
    (0..3).map(|i| format!("<vertex pos=\"{}\" {}/>", pos[i], attributes[i])).collect::<Vec<_>>().concat()
}

const SET: &str = "<triangle_set><material_name>white</material_name><tri>0 1 2</tri></triangle_set>";

#[test]
fn the_example_of_the_manual() {
    let (mesh, findings) = read(
        r#"<expose_uv_set><index>0</index><name>albedo</name></expose_uv_set>
        <expose_uv_set><index>0</index><name>bump</name></expose_uv_set>
        <vertex pos="-10 -10 0" normal="0 0 1" uv0="0 0" />
        <vertex pos="-10 10 0" normal="0 0 1" uv0="0 10" />
        <vertex pos="10 10 0" normal="0 0 1" uv0="10 10" />
        <vertex pos="10 -10 0" normal="0 0 1" uv0="10 0" />
        <triangle_set>
            <material_name>white</material_name>
            <tri>0 1 2</tri>
            <tri>0 2 3</tri>
        </triangle_set>
        <vertex pos="-10 3 0" normal="0 -1 1" uv0="0 0" />
        <vertex pos="-10 3 20" normal="0 -1 1" uv0="0 10" />
        <vertex pos="10 3 20" normal="0 -1 1" uv0="10 10" />
        <vertex pos="10 3 0" normal="0 -1 1" uv0="10 0" />
        <triangle_set>
            <material_name>checker</material_name>
            <tri>4 5 6</tri>
            <tri>4 6 7</tri>
        </triangle_set>"#,
    );
    // Four of its normals are longer than 1.
    assert_eq!(findings, ["W0011 2:1"]);
    let data = &mesh.data;
    assert_eq!((data.positions.len(), data.normals.len()), (8, 8));
    let half = 0.5_f32.sqrt();
    assert_eq!((data.normals[0], data.normals[7]), ([0.0, 0.0, 1.0], [0.0, -half, half]));
    assert_eq!(data.uv_sets[0][2], [10.0, 10.0]);
    assert_eq!(data.uv_names, [("albedo".to_owned(), 0), ("bump".to_owned(), 0)]);
    assert_eq!(data.triangles, [[0, 1, 2], [0, 2, 3], [4, 5, 6], [4, 6, 7]]);
    assert_eq!(data.triangle_materials, [0, 0, 1, 1]);
    assert_eq!(data.material_names, ["white", "checker"]);
    assert_eq!(mesh.material_spans.len(), 2);
}

#[test]
fn normals_and_uvs_may_be_missing() {
    let (mesh, findings) = read(&(vertices([""; 3]) + SET));
    assert!(findings.is_empty() && mesh.data.normals.is_empty() && mesh.data.uv_sets.is_empty());
    // Where some vertices have them, the others get what they need.
    let (mesh, findings) = read(&(vertices(["normal=\"1 0 0\"", "", "uv1='3 4'"]) + SET));
    assert_eq!(findings, ["W0012 2:1", "W0012 2:1", "W0012 2:1"]);
    assert_eq!(mesh.data.normals, [[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, 0.0, 1.0]]);
    assert_eq!(mesh.data.uv_sets, [vec![[0.0; 2]; 3], vec![[0.0; 2], [0.0; 2], [3.0, 4.0]]]);
}

#[test]
fn triangles_without_area_are_dropped_with_a_count() {
    let more =
        "<triangle_set><tri>0 0 1</tri><tri>2 1 0</tri><material_name>b</material_name></triangle_set>";
    let (mesh, findings) = read(&(vertices([""; 3]) + SET + more));
    assert!(findings.is_empty());
    assert_eq!(mesh.data.degenerate.len(), 1);
    assert_eq!(mesh.data.triangles, [[0, 1, 2], [2, 1, 0]]);
    assert_eq!(mesh.data.triangle_materials, [0, 1]);
}

#[test]
fn faults_have_places() {
    for (inside, expected) in [
        ("<vertex/>", vec!["E0101 3:1"]),
        ("<vertex pos='1 2'/>", vec!["E0101 3:14"]),
        ("<vertex pos='1 2 3' normal='0 0 x'/>", vec!["E0101 3:29"]),
        ("<vertex pos='1 2 3' uv0='0 0 0'/>", vec!["E0101 3:26"]),
        ("<vertex pos='1 2 1e40'/>", vec!["E0101 3:14"]),
        ("<triangle_set><material_name>w</material_name><tri>0 1 2</tri></triangle_set>", vec!["E0103 3:52"]),
        ("<triangle_set><material_name>w</material_name><tri> 0 1 </tri></triangle_set>", vec!["E0102 3:53"]),
        ("<triangle_set><material_name>w</material_name><tri/></triangle_set>", vec!["E0102 3:47"]),
        ("<triangle_set></triangle_set>", vec!["E0104 3:1"]),
        ("<triangle_set/>", vec!["E0104 3:1"]),
        ("<expose_uv_set><index>0</index><name>a</name></expose_uv_set>", vec!["E0105 3:23"]),
        ("<expose_uv_set><index>x</index><name>a</name></expose_uv_set>", vec!["E0105 3:23"]),
        ("<expose_uv_set><name>a</name></expose_uv_set>", vec!["E0105 3:1"]),
        ("<expose_uv_set><index>0</index><name> </name></expose_uv_set>", vec!["E0105 3:1"]),
        (
            "<vertex pos='0 0 0' uv0='1 2' uv1='3 4'/><expose_uv_set><index>0</index><name>a</name></expose_uv_set><expose_uv_set><index>1</index><name>a</name></expose_uv_set><expose_uv_set><index>0</index><name>a</name></expose_uv_set>",
            vec!["E0105 3:140"],
        ),
        ("<vertex pos='0 0 0' normal='0 0 0'/><vertex pos='0 0 0' normal='0 0 0'/>", vec!["W0011 2:1"]),
        (
            "<vertex pos='0 0 0' uv7='1 2' colour='3'/><vertex pos='0 0 0' uv7='1 2'/>",
            vec!["W0105 3:21", "W0105 3:31"],
        ),
        ("<quad>1 <b>2</b></quad><quad/>text", vec!["W0101 3:1", "W0106 3:31"]),
    ] {
        assert_eq!(read(inside).1, expected, "{inside}");
    }
}

#[test]
fn a_million_faults_are_counted_and_not_listed() {
    let (_, findings) = read(&"<vertex/>\n".repeat(1000));
    assert_eq!(findings.len(), 21);
    assert_eq!(findings[20], "E0106 2:1");
}

#[test]
fn mismatched_tags_inside() {
    for (inside, expected) in [
        ("<triangle_set><material_name>w</material_name>", vec!["E0006 4:1"]),
        ("<triangle_set><material_name>w</material_nam></triangle_set>", vec!["E0006 3:31"]),
        ("<vertex pos='0 0 0'></verteks>", vec!["E0006 3:21"]),
        ("</foo>", vec!["E0006 3:1"]),
        ("<vertex pos='0 0 0'><vertex pos='1 0 0'/>", vec!["E0006 3:21"]),
        (
            "<vertex pos='0 0 0'/><triangle_set><material_name>a</material_name><tri>0 0 0<tri>0 0 0</tri></triangle_set>",
            vec!["E0006 3:78"],
        ),
        ("<foo><vertex pos='0 0 0'/>", vec!["W0101 3:1", "E0006 4:1"]),
    ] {
        assert_eq!(read(inside).1, expected, "{inside}");
    }
}

#[test]
fn a_mesh_that_is_cut_off() {
    let whole = format!("<scene><mesh><name>m</name><embedded>{}{SET}", vertices(["normal='0 0 1'"; 3]));
    for length in 40..whole.len() {
        let read = Read::text(&whole[..length]);
        assert!(read.sink.has_errors(), "{}", &whole[..length]);
        assert!(read.root().children.is_empty(), "what was cut off is left out");
    }
}

#[test]
fn entities_stand_for_their_characters_in_numbers_too() {
    let inside = "<vertex pos=\"&#49;&#32;2&#x20;3\"/><vertex pos=\"1 0 0\"/><vertex pos=\"0 1 0\"/>\
                  <triangle_set><material_name>white</material_name><tri>0&#32;1 2</tri></triangle_set>";
    let (mesh, findings) = read(inside);
    assert_eq!(findings, Vec::<String>::new());
    assert_eq!((mesh.data.positions[0], &mesh.data.triangles[..]), ([1.0, 2.0, 3.0], &[[0, 1, 2]][..]));
}

/// A vertex that cannot be read is one fault; that its triangles seem to have no area is not another.
#[test]
fn triangles_of_a_bad_vertex_are_not_counted_as_degenerate() {
    let vertices = "<vertex pos=\"0 0 0\"/><vertex pos=\"nan 0 0\"/><vertex pos=\"0 1 0\"/>";
    let (mesh, findings) = read(&format!("{vertices}{SET}"));
    assert_eq!((findings.len(), mesh.data.degenerate.len()), (1, 0), "{findings:?}");
    let vertices = "<vertex pos=\"0 0 0\"/><vertex pos=\"0 0 0\"/><vertex pos=\"0 1 0\"/>";
    assert_eq!(read(&format!("{vertices}{SET}")).0.data.degenerate.len(), 1);
}

/// A file can be hundreds of megabytes of one mesh: it is asked amid them whether anybody still wants it.
#[test]
fn reading_is_stopped_within_a_mesh() {
    const MEBIBYTES: usize = 8;
    let vertex = "<vertex pos=\"1 2 3\" />\n";
    let text = format!(
        "<scene><mesh><name>m</name><embedded>{}</embedded></mesh></scene>",
        vertex.repeat((MEBIBYTES << 20) / vertex.len())
    );
    let files = Files::scene(text.as_bytes());
    // Whether a scene comes, how often was asked, and how much was found, where the answer is no from some question on.
    let read = |last: usize| {
        let asked = Cell::new(0);
        let is_stopped = || asked.replace(asked.get() + 1) >= last;
        let (mut sources, mut sink) = (SourceMap::default(), Sink::new());
        let root =
            read_scene_until("scene.igs", &files, &mut sources, &mut sink, &Limits::default(), &is_stopped);
        (root.is_some(), asked.get(), sink.diagnostics().len())
    };
    let (is_read, asked, _) = read(usize::MAX);
    assert!(is_read && asked >= MEBIBYTES, "{asked}");
    let (is_read, asked, found) = read(2);
    // The third question is answered so, and what was read until then is not judged: it is not known whether it is whole.
    assert!(!is_read && (3..MEBIBYTES).contains(&asked) && found == 0, "{asked}, {found}");
}

#[test]
fn triangles_without_area_are_written_again() {
    let text = format!(
        "<scene><mesh><embedded>{}<triangle_set><material_name>a</material_name><tri>0 1 1</tri></triangle_set>{SET}<triangle_set><material_name>b</material_name><tri>2 2 2</tri></triangle_set></embedded></mesh></scene>",
        vertices(["", "", ""])
    );
    let before = Read::text(&text);
    let after = Read::text(&indigo_igs::write(before.root()));
    let mesh = |read: &Read| read.root().children[0].children[0].mesh.clone().expect("a mesh").data;
    let [before, after] = [&before, &after].map(mesh);
    assert_eq!(before.degenerate, [[0, 1, 1], [2, 2, 2]]);
    assert_eq!((&after.degenerate, after.material_names.len()), (&before.degenerate, 3));
    let names = |data: &indigo_decl::MeshData| -> Vec<String> {
        let of = |m: &u32| data.material_names[*m as usize].clone();
        data.triangle_materials.iter().chain(&data.degenerate_materials).map(of).collect()
    };
    assert_eq!(names(&after), ["white", "a", "b"]);
    assert_eq!(names(&after), names(&before));
    assert_eq!(after.material_names, before.material_names);
}
