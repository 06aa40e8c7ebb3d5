//! Trees to text.

use indigo_decl::{Element, EmbeddedMesh};
use std::fmt::Write as _;

/// An element and all below it as XML, indented; what [`read_document`](crate::read_document) reads
/// back is the same, places apart.
///
/// Text is written without blanks around it. Characters that XML cannot hold are left out.
pub fn write(element: &Element) -> String {
    let mut out = String::from("<?xml version=\"1.0\" encoding=\"utf-8\"?>\n");
    element_at(&mut out, element, 0);
    out
}

fn element_at(out: &mut String, element: &Element, depth: usize) {
    indent(out, depth);
    let _ = write!(out, "<{}", element.name);
    for a in &element.attributes {
        let _ = write!(out, " {}=\"", a.name.value);
        escape(out, &a.value.value);
        out.push('"');
    }
    let text = &element.text.value;
    if element.children.is_empty() && element.mesh.is_none() {
        if text.is_empty() {
            out.push_str("/>\n");
        } else {
            out.push('>');
            escape(out, text);
            let _ = writeln!(out, "</{}>", element.name);
        }
        return;
    }
    out.push('>');
    escape(out, text);
    out.push('\n');
    if let Some(mesh) = &element.mesh {
        mesh_at(out, mesh, depth + 1);
    }
    for child in &element.children {
        element_at(out, child, depth + 1);
    }
    indent(out, depth);
    let _ = writeln!(out, "</{}>", element.name);
}

fn indent(out: &mut String, depth: usize) {
    out.extend(std::iter::repeat_n('\t', depth));
}

fn escape(out: &mut String, text: &str) {
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

fn numbers<const N: usize>(out: &mut String, name: &str, values: [f32; N]) {
    let _ = write!(out, " {name}=\"");
    for (i, v) in values.iter().enumerate() {
        let _ = write!(out, "{}{v}", if i == 0 { "" } else { " " });
    }
    out.push('"');
}

fn mesh_at(out: &mut String, mesh: &EmbeddedMesh, depth: usize) {
    let data = &mesh.data;
    for (name, index) in &data.uv_names {
        indent(out, depth);
        let _ = write!(out, "<expose_uv_set><index>{index}</index><name>");
        escape(out, name);
        out.push_str("</name></expose_uv_set>\n");
    }
    for (i, &p) in data.positions.iter().enumerate() {
        indent(out, depth);
        out.push_str("<vertex");
        numbers(out, "pos", p);
        if let Some(&n) = data.normals.get(i) {
            numbers(out, "normal", n);
        }
        for (set, values) in data.uv_sets.iter().enumerate() {
            if let Some(&uv) = values.get(i) {
                numbers(out, &format!("uv{set}"), uv);
            }
        }
        out.push_str("/>\n");
    }
    let triangles: Vec<(&[u32; 3], &u32)> = data.triangles.iter().zip(&data.triangle_materials).collect();
    for run in triangles.chunk_by(|a, b| a.1 == b.1) {
        triangle_set(out, mesh, run, depth);
    }
}

fn triangle_set(out: &mut String, mesh: &EmbeddedMesh, run: &[(&[u32; 3], &u32)], depth: usize) {
    let material = run.first().and_then(|(_, m)| mesh.data.material_names.get(**m as usize));
    indent(out, depth);
    out.push_str("<triangle_set><material_name>");
    escape(out, material.map_or("", String::as_str));
    out.push_str("</material_name>\n");
    for ([a, b, c], _) in run {
        indent(out, depth + 1);
        let _ = writeln!(out, "<tri>{a} {b} {c}</tri>");
    }
    indent(out, depth);
    out.push_str("</triangle_set>\n");
}
