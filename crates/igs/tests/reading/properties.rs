//! Laws: what is written is read back; no bytes make the reader panic.

use crate::common::{Files, Read};
use indigo_decl::{Attribute, Element, EmbeddedMesh, MeshData};
use indigo_diag::{SourceId, Span, Spanned};
use indigo_igs::{Limits, write};
use proptest::collection::vec;
use proptest::prelude::*;

pub const HERE: Span = Span { source: SourceId(0), len: 0, start: 0 };

/// A tree with all places forgotten.
pub fn placeless(mut element: Element) -> Element {
    element.span = HERE;
    element.text.span = HERE;
    for a in &mut element.attributes {
        a.name.span = HERE;
        a.value.span = HERE;
    }
    if let Some(mesh) = &mut element.mesh {
        mesh.material_spans.fill(HERE);
    }
    element.children = element.children.into_iter().map(placeless).collect();
    element
}

pub fn text() -> impl Strategy<Value = String> {
    "[ -~äß€\n\t]{0,12}".prop_map(|s| s.trim_ascii().to_owned())
}

fn attributes() -> impl Strategy<Value = Vec<Attribute>> {
    proptest::collection::btree_map("[a-z_][a-z0-9_.-]{0,6}", text(), 0..3).prop_map(|map| {
        map.into_iter()
            .map(|(name, value)| Attribute {
                name: Spanned::new(name.into(), HERE),
                value: Spanned::new(value.into(), HERE),
            })
            .collect()
    })
}

pub fn element() -> impl Strategy<Value = Element> {
    // Not "include", "mesh" or "embedded", which have a meaning.
    let name = "[a-df-hj-ln-z_ä][a-z0-9_.-]{0,6}";
    let leaf = (name, attributes(), text()).prop_map(|(name, attributes, text)| Element {
        attributes,
        text: Spanned::new(text.into(), HERE),
        ..Element::new(&name, HERE)
    });
    leaf.prop_recursive(4, 40, 5, move |inner| {
        (name, attributes(), text(), vec(inner, 0..5)).prop_map(|(name, attributes, text, children)| {
            Element {
                attributes,
                children,
                text: Spanned::new(text.into(), HERE),
                ..Element::new(&name, HERE)
            }
        })
    })
}

/// A mesh as the reader makes it: materials in order of their first use, no triangle without area.
fn mesh() -> impl Strategy<Value = EmbeddedMesh> {
    let position = || [-1e3_f32..1e3, -1.0_f32..1.0, -1e-3_f32..1e-3];
    (vec(position(), 3..20), 0_usize..3, vec(any::<[u8; 3]>(), 0..20), "[a-z]{1,5}").prop_map(
        |(positions, sets, picks, name)| {
            let n = positions.len();
            let mut triangles: Vec<[u32; 3]> =
                picks.iter().map(|p| p.map(|i| u32::from(i) % n as u32)).collect();
            let point = |i: u32| positions[i as usize].map(f64::from);
            triangles.retain(|t| {
                let (a, b, c) = (point(t[0]), point(t[1]), point(t[2]));
                let (u, v) = ([b[0] - a[0], b[1] - a[1]], [c[0] - a[0], c[1] - a[1]]);
                (u[0] * v[1] - u[1] * v[0]).abs() > 1e-15
            });
            let half = triangles.len() / 2;
            let materials: Vec<u32> =
                (0..triangles.len()).map(|i| u32::from(i >= half && half > 0)).collect();
            let used = materials.iter().max().map_or(0, |m| m + 1);
            let names: Vec<String> = (0..used).map(|i| format!("{name} & <{i}>")).collect();
            let uv = |i: usize| [i as f32 * 0.37, 1.0 / (i as f32 + 1.0)];
            EmbeddedMesh {
                material_spans: vec![HERE; names.len()],
                data: MeshData {
                    normals: vec![[0.0, 0.0, 1.0]; if sets == 1 { n } else { 0 }],
                    uv_sets: vec![(0..n).map(uv).collect(); sets],
                    uv_names: (0..sets as u32).map(|i| (format!("uv{i}"), i)).collect(),
                    triangle_materials: materials,
                    material_names: names,
                    triangles,
                    positions,
                    ..MeshData::default()
                },
            }
        },
    )
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 256,
        rng_seed: proptest::test_runner::RngSeed::Fixed(2008),
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    #[test]
    fn what_is_written_is_read_back(children in vec(element(), 0..6)) {
        let root = Element { children, ..Element::new("scene", HERE) };
        let read = Read::text(&write(&root));
        prop_assert!(read.sink.diagnostics().is_empty(), "{:?}", read.sink.diagnostics());
        prop_assert_eq!(placeless(read.root().clone()), root);
    }

    #[test]
    fn meshes_are_read_back(mesh in mesh()) {
        let embedded = Element { mesh: Some(Box::new(mesh)), ..Element::new("embedded", HERE) };
        let outer = Element { children: vec![embedded], ..Element::new("mesh", HERE) };
        let root = Element { children: vec![outer], ..Element::new("scene", HERE) };
        let read = Read::text(&write(&root));
        prop_assert!(read.sink.diagnostics().is_empty(), "{:?}", read.sink.diagnostics());
        prop_assert_eq!(placeless(read.root().clone()), root);
    }

    #[test]
    fn no_bytes_make_it_panic(bytes in vec(any::<u8>(), 0..300)) {
        let _ = Read::of(&Files::scene(&bytes), &Limits::default()).findings();
    }

    /// Pieces of the syntax in any order reach deeper than any bytes.
    #[test]
    fn no_syntax_makes_it_panic(pieces in vec(proptest::sample::select(PIECES), 0..60)) {
        let _ = Read::text(&format!("<scene><mesh><embedded>{}", pieces.concat())).findings();
        let _ = Read::text(&pieces.concat()).findings();
    }
}

const PIECES: &[&str] = &[
    "<",
    ">",
    "/",
    "/>",
    "</",
    "<scene>",
    "</scene>",
    "<mesh>",
    "</mesh>",
    "<embedded>",
    "</embedded>",
    "<vertex",
    " pos=\"1 2 3\"",
    " normal='0 0 2'",
    " uv0=\"",
    " uv3=\"1 1\"",
    "\"",
    "'",
    "=",
    " ",
    "\n",
    "<tri>",
    "</tri>",
    "0 1 2",
    "<triangle_set>",
    "</triangle_set>",
    "<material_name>",
    "</material_name>",
    "white",
    "<!--",
    "-->",
    "<![CDATA[",
    "]]>",
    "<!",
    "<!DOCTYPE",
    "[",
    "]",
    "<?xml ",
    "?>",
    "encoding='x'",
    "&",
    "&amp;",
    "&#x41;",
    "&#",
    ";",
    "<expose_uv_set>",
    "</expose_uv_set>",
    "<index>",
    "</index>",
    "<name>",
    "</name>",
    "ä",
    "\u{FEFF}",
    "<include><pathname>scene.igs</pathname></include>",
    "<a b='c'/>",
    "</x>",
];
