//! Seconds to read and check a scene of 15,000 models of two meshes, which should be under 1:
//! `cargo bench -p indigo-scene --bench many_models`.

use indigo_decl::{ResolveError, Resolved, Resolver, bind};
use indigo_diag::{Sink, SourceMap};
use indigo_igs::{Limits, read_scene};
use indigo_scene::schema::SCENE;
use std::fmt::Write as _;
use std::sync::Arc;
use std::time::Instant;

/// One file in memory.
struct One(Arc<[u8]>);

impl Resolver for One {
    fn read(&self, path: &str, _: &str) -> Result<Resolved, ResolveError> {
        Ok(Resolved { path: path.to_owned(), bytes: self.0.clone() })
    }
}

fn scene(models: usize) -> String {
    let mut out = String::from("<scene>\n");
    for name in ["tree", "stone"] {
        let _ = writeln!(out, "<mesh><name>{name}</name><external><path>{name}.obj</path></external></mesh>");
    }
    for i in 0..models {
        let _ = writeln!(
            out,
            "<model>\n\t<pos>{} {} 0.0</pos>\n\t<scale>1.0</scale>\n\t<rotation>\n\t\t<matrix>1 0 0 0 1 0 0 0 1</matrix>\n\t</rotation>\n\t<mesh_name>{}</mesh_name>\n</model>",
            i % 100,
            i / 100,
            if i % 3 == 0 { "tree" } else { "stone" }
        );
    }
    out.push_str("</scene>\n");
    out
}

fn main() {
    let file = One(scene(15_000).into_bytes().into());
    let mut best = f64::INFINITY;
    for _ in 0..7 {
        let (mut sources, mut sink) = (SourceMap::default(), Sink::new());
        let start = Instant::now();
        let root = read_scene("scene.igs", &file, &mut sources, &mut sink, &Limits::default());
        let node = bind(root.expect("a root"), &SCENE, &mut sink);
        best = best.min(start.elapsed().as_secs_f64());
        assert!(sink.diagnostics().is_empty());
        assert_eq!(node.nodes("model").count(), 15_000);
    }
    println!("15,000 models of 2 meshes: {best:.3} s");
}
