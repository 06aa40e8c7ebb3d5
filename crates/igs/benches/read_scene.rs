//! Seconds and peak memory of reading large scenes: `cargo bench -p indigo-igs --bench read_scene`.
//!
//! A million embedded triangles should be read in under 2 s and within 4 times the size of the file;
//! 15,000 models in under 1 s.

#![allow(unsafe_code, reason = "a global allocator that counts cannot be written without")]

use indigo_decl::{ResolveError, Resolved, Resolver};
use indigo_diag::{Sink, SourceMap};
use indigo_igs::{Limits, read_scene};
use std::alloc::{GlobalAlloc, Layout, System};
use std::fmt::Write as _;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};
use std::time::Instant;

/// The system's allocator, counting.
struct Counting;

static NOW: AtomicUsize = AtomicUsize::new(0);
static PEAK: AtomicUsize = AtomicUsize::new(0);

fn grown(bytes: usize) {
    let now = NOW.fetch_add(bytes, Relaxed) + bytes;
    PEAK.fetch_max(now, Relaxed);
}

// SAFETY: every call goes to the system's allocator unchanged.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        grown(layout.size());
        // SAFETY: the caller keeps the contract of `alloc`.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, at: *mut u8, layout: Layout) {
        NOW.fetch_sub(layout.size(), Relaxed);
        // SAFETY: the caller keeps the contract of `dealloc`.
        unsafe { System.dealloc(at, layout) }
    }

    unsafe fn realloc(&self, at: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        // Old and new may both exist for a moment.
        grown(size);
        // SAFETY: the caller keeps the contract of `realloc`.
        let new = unsafe { System.realloc(at, layout, size) };
        NOW.fetch_sub(layout.size(), Relaxed);
        new
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// One file in memory.
struct One(Arc<[u8]>);

impl Resolver for One {
    fn read(&self, path: &str, _: &str) -> Result<Resolved, ResolveError> {
        Ok(Resolved { path: path.to_owned(), bytes: self.0.clone() })
    }
}

/// A wavy grid of `2 n²` triangles with normals and texture coordinates.
fn embedded(n: usize) -> String {
    let mut out = String::from("<scene>\n<mesh>\n<name>grid</name>\n<embedded>\n");
    for j in 0..=n {
        for i in 0..=n {
            let (u, v) = (i as f64 / n as f64, j as f64 / n as f64);
            let (nx, ny) = (0.1 * (7.0 * u).cos(), 0.1 * (5.0 * v).sin());
            let length = (1.0 + nx * nx + ny * ny).sqrt();
            let _ = writeln!(
                out,
                "\t<vertex pos=\"{:.6} {:.6} {:.6}\" normal=\"{:.6} {:.6} {:.6}\" uv0=\"{u:.6} {v:.6}\"/>",
                10.0 * u,
                10.0 * v,
                0.1 * (7.0 * u).sin(),
                nx / length,
                ny / length,
                1.0 / length,
            );
        }
    }
    out.push_str("<triangle_set><material_name>white</material_name>\n");
    for j in 0..n {
        for i in 0..n {
            let a = j * (n + 1) + i;
            let (b, c, d) = (a + 1, a + n + 2, a + n + 1);
            let _ = writeln!(out, "\t<tri>{a} {b} {c}</tri>\n\t<tri>{a} {c} {d}</tri>");
        }
    }
    out.push_str("</triangle_set>\n</embedded>\n</mesh>\n</scene>\n");
    out
}

fn models(n: usize) -> String {
    let mut out = String::from("<scene>\n");
    for i in 0..n {
        let _ = writeln!(
            out,
            "<model>\n\t<pos>{} {} 0.0</pos>\n\t<scale>1.0</scale>\n\t<rotation>\n\t\t<matrix>1 0 0 0 1 0 0 0 1</matrix>\n\t</rotation>\n\t<mesh_name>mesh{}</mesh_name>\n</model>",
            i % 100,
            i / 100,
            i % 2
        );
    }
    out.push_str("</scene>\n");
    out
}

fn measure(what: &str, text: String) {
    let resolver = One(text.into_bytes().into());
    let size = resolver.0.len();
    let (mut best, mut peak) = (f64::INFINITY, 0);
    for _ in 0..5 {
        // The file itself counts: whoever reads it must hold it.
        PEAK.store(NOW.load(Relaxed), Relaxed);
        let others = NOW.load(Relaxed) - size;
        let (mut sources, mut sink) = (SourceMap::default(), Sink::new());
        let start = Instant::now();
        let root = read_scene("scene.igs", &resolver, &mut sources, &mut sink, &Limits::default());
        best = best.min(start.elapsed().as_secs_f64());
        peak = peak.max(PEAK.load(Relaxed) - others);
        assert!(root.is_some() && sink.diagnostics().is_empty(), "{:?}", sink.diagnostics().first());
    }
    println!(
        "{what}: {:.1} MB, {best:.3} s, peak {:.1} MB = {:.2} times the file",
        size as f64 / 1e6,
        peak as f64 / 1e6,
        peak as f64 / size as f64
    );
}

fn main() {
    measure("1,000,000 embedded triangles", embedded(708));
    measure("15,000 models", models(15_000));
}
