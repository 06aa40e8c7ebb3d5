//! What code of a layer must not do: print, open files, read clocks, start threads, be unsafe, or call
//! the platform's elementary functions in the kernel.

use std::collections::BTreeMap;
use std::path::Path;

use super::code::code_only;
use super::dependencies::{Layers, TOOLS};
use super::tables::section;
use super::{ARCHITECTURE, Finding};

/// Marks the list of files that may hold unsafe code.
const UNSAFE_MARKER: &str = "unsafe";
/// The first layer that owns threads and clocks.
const RENDER_LAYER: u32 = 7;
/// The layer of the programs.
const FRONT_END_LAYER: u32 = 10;

/// Crates that evaluate per sample and must give the same bits on every platform.
const KERNEL: &[&str] = &["scatter", "light", "camera", "transport"];
/// A comment that excuses a file of a kernel crate: it works while a scene is loaded, never per sample.
const LOAD_TIME: &str = "// tidy: load-time mathematics";

const PRINTING: &[&str] = &["println!", "eprintln!", "print!", "eprint!", "dbg!"];
const FILES: &[&str] = &["std::fs", "File::open", "File::create", "OpenOptions"];
const CLOCKS_AND_THREADS: &[&str] =
    &["std::time", "Instant::now", "SystemTime", "thread::spawn", "thread::scope", "thread::Builder"];
const PLATFORM_MATHEMATICS: &[&str] = &[
    ".sin()",
    ".cos()",
    ".sin_cos()",
    ".tan()",
    ".asin()",
    ".acos()",
    ".atan()",
    ".atan2(",
    ".exp()",
    ".exp2()",
    ".exp_m1()",
    ".ln()",
    ".ln_1p()",
    ".log2()",
    ".log10()",
    ".powf(",
    ".sinh()",
    ".cosh()",
    ".tanh()",
    ".cbrt()",
];

/// The rules with what they need to know, and the permissions that were used.
pub struct Boundaries<'a> {
    document: &'a str,
    layers: &'a Layers,
    /// Files that may be unsafe: the line that says so, and whether they are.
    may_be_unsafe: BTreeMap<String, (usize, bool)>,
}

impl<'a> Boundaries<'a> {
    /// Reads the list of files that may be unsafe: back-quoted paths between the markers.
    pub fn new(document: &'a str, text: &str, layers: &'a Layers, findings: &mut Vec<Finding>) -> Self {
        let mut may_be_unsafe = BTreeMap::new();
        match section(text, UNSAFE_MARKER) {
            None => {
                findings.push(Finding::new(document, 0, "no list between <!-- unsafe:begin --> and :end"));
            }
            Some(lines) => {
                for (number, line) in lines {
                    let paths = line.split('`').skip(1).step_by(2).filter(|path| is_rust(path));
                    may_be_unsafe.extend(paths.map(|path| (path.to_string(), (number, false))));
                }
            }
        }
        Self { document, layers, may_be_unsafe }
    }

    /// All rules on one source file.
    pub fn check(&mut self, path: &str, source: &str) -> Vec<Finding> {
        let code = code_only(source);
        let mut findings = self.check_unsafe(path, &code);
        let Some(place) = Place::of(path, self.layers) else { return findings };
        let mut forbid = |words: &[&str], why: &str| findings.extend(uses(path, &code, words, why));
        if place.layer < FRONT_END_LAYER {
            forbid(PRINTING, "only front ends print");
        }
        if place.layer < RENDER_LAYER {
            forbid(FILES, "bytes come through a resolver; only front ends open files");
            forbid(CLOCKS_AND_THREADS, "threads and clocks belong to the layers from render up");
        }
        if KERNEL.contains(&place.krate) && !source.contains(LOAD_TIME) {
            forbid(PLATFORM_MATHEMATICS, "differs between platforms; use the functions of math");
        }
        findings
    }

    fn check_unsafe(&mut self, path: &str, code: &str) -> Vec<Finding> {
        let found = uses(path, code, &["unsafe"], "");
        match (self.may_be_unsafe.get_mut(path), found.first()) {
            (Some(listed), Some(_)) => listed.1 = true,
            (None, Some(first)) => {
                let what = format!("unsafe code in a file that {ARCHITECTURE} does not list");
                return vec![Finding { what, ..first.clone() }];
            }
            (_, None) => {}
        }
        Vec::new()
    }

    /// Permissions that no file needs any more.
    pub fn finish(self) -> Vec<Finding> {
        let unused = self.may_be_unsafe.into_iter().filter(|(_, (_, used))| !used);
        unused
            .map(|(path, (line, _))| {
                Finding::new(self.document, line, format!("`{path}` has no unsafe code"))
            })
            .collect()
    }
}

fn is_rust(path: &str) -> bool {
    Path::new(path).extension().is_some_and(|extension| extension == "rs")
}

/// Which crate's library a file belongs to.
struct Place<'a> {
    krate: &'a str,
    layer: u32,
}

impl<'a> Place<'a> {
    /// `None` for tests, benchmarks, examples, build scripts and tools, which may do as they need.
    fn of(path: &'a str, layers: &Layers) -> Option<Self> {
        let parts: Vec<&str> = path.split('/').collect();
        let ["crates", krate, "src", inside @ ..] = parts.as_slice() else { return None };
        if inside.iter().any(|part| *part == "tests" || *part == "tests.rs" || *part == "bin") {
            return None;
        }
        let layer = layers.layer(krate).filter(|&layer| layer != TOOLS)?;
        Some(Self { krate, layer })
    }
}

/// A finding for each line of code that has one of the words, as a word of its own.
fn uses(path: &str, code: &str, words: &[&str], why: &str) -> Vec<Finding> {
    let in_line = |(i, line): (usize, &str)| {
        let word = words.iter().find(|word| has_word(line, word))?;
        Some(Finding::new(path, i + 1, format!("`{word}`: {why}")))
    };
    code.lines().enumerate().filter_map(in_line).collect()
}

fn has_word(line: &str, word: &str) -> bool {
    let part_of_name = |c: char| c.is_alphanumeric() || c == '_';
    let open_left = !word.starts_with(part_of_name);
    let open_right = !word.ends_with(part_of_name);
    line.match_indices(word).any(|(at, _)| {
        let left = open_left || !line[..at].ends_with(part_of_name);
        let right = open_right || !line[at + word.len()..].starts_with(part_of_name);
        left && right
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const TABLE: &str = "<!-- dependencies:begin -->\n| scatter | L4 | none |\n| film | L3 | none |\n\
        | render | L7 | none |\n| cli | L10 | none |\n| xtask | dev | none |\n<!-- dependencies:end -->\n\
        <!-- unsafe:begin -->\n- `crates/film/src/simd.rs`: why\n<!-- unsafe:end -->\n";

    fn check(path: &str, source: &str) -> Vec<String> {
        let mut findings = Vec::new();
        let layers = Layers::parse("A.md", TABLE, &mut findings);
        let mut boundaries = Boundaries::new("A.md", TABLE, &layers, &mut findings);
        assert!(findings.is_empty(), "{findings:?}");
        boundaries.check(path, source).iter().map(ToString::to_string).collect()
    }

    #[test]
    fn printing_is_for_front_ends() {
        let source = "fn f() {\n    println!(\"x\");\n}\n";
        assert_eq!(
            check("crates/render/src/lib.rs", source),
            ["crates/render/src/lib.rs:2: `println!`: only front ends print"]
        );
        for path in ["crates/cli/src/main.rs", "crates/xtask/src/main.rs", "crates/film/tests/laws.rs"] {
            assert!(check(path, source).is_empty(), "{path}");
        }
    }

    #[test]
    fn files_clocks_and_threads_are_for_render_and_above() {
        for line in
            ["use std::fs;", "File::open(p);", "let t = std::time::Instant::now();", "thread::spawn(f);"]
        {
            assert_eq!(check("crates/film/src/a.rs", line).len(), 1, "{line}");
            assert!(check("crates/render/src/a.rs", line).is_empty(), "{line}");
        }
    }

    #[test]
    fn comments_strings_and_tests_may_say_anything() {
        let source =
            "// println!\nlet s = \"std::fs\";\n#[cfg(test)]\nmod tests {\n fn f() { println!(); }\n}\n";
        assert!(check("crates/film/src/a.rs", source).is_empty());
    }

    #[test]
    fn words_are_whole_words() {
        assert!(check("crates/film/src/a.rs", "my_print!(); #![forbid(unsafe_code)]").is_empty());
    }

    #[test]
    fn unsafe_code_needs_a_line_in_the_list() {
        let source = "unsafe { f() }";
        assert!(check("crates/film/src/simd.rs", source).is_empty());
        assert!(check("crates/film/src/other.rs", source)[0].contains("does not list"));
        assert!(check("crates/xtask/src/main.rs", source)[0].contains("does not list"));
    }

    #[test]
    fn an_unused_permission_is_found() {
        let layers = Layers::default();
        let boundaries = Boundaries::new("A.md", TABLE, &layers, &mut Vec::new());
        assert_eq!(
            boundaries.finish(),
            [Finding::new("A.md", 9, "`crates/film/src/simd.rs` has no unsafe code")]
        );
    }

    #[test]
    fn kernel_code_uses_our_elementary_functions() {
        assert_eq!(check("crates/scatter/src/a.rs", "let s = x.sin();").len(), 1);
        assert!(check("crates/film/src/a.rs", "let s = x.sin();").is_empty());
        assert!(check("crates/scatter/src/a.rs", &format!("{LOAD_TIME}\nlet s = x.sin();")).is_empty());
        assert!(check("crates/scatter/src/a.rs", "let s = x.sqrt();").is_empty());
    }
}
