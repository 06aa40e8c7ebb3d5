//! `cargo xtask tidy`: the rules of ARCHITECTURE.md that no compiler checks.
//!
//! Each check is a function from text to findings, so that each is tested on small strings; only this
//! file touches git and the disk.

mod boundaries;
mod code;
mod dependencies;
mod tables;
mod text;

use std::collections::BTreeSet;
use std::fmt;
use std::path::Path;

use crate::Outcome;
use crate::process::{self, capture, cargo, command};
use boundaries::Boundaries;
use dependencies::Layers;

/// The document that holds the tables the code is compared with.
const ARCHITECTURE: &str = "ARCHITECTURE.md";

/// Something that a person should change, and where.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Finding {
    path: String,
    /// From 1; 0 means the file as a whole.
    line: usize,
    what: String,
}

impl Finding {
    fn new(path: &str, line: usize, what: impl Into<String>) -> Self {
        Self { path: path.into(), line, what: what.into() }
    }
}

impl fmt::Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.line == 0 {
            write!(f, "{}: {}", self.path, self.what)
        } else {
            write!(f, "{}:{}: {}", self.path, self.line, self.what)
        }
    }
}

/// Findings, which fail the run, and notices, which do not.
#[derive(Default)]
struct Report {
    findings: Vec<Finding>,
    notices: Vec<Finding>,
}

/// Checks the whole repository and prints what it finds.
pub fn run(arguments: &[String]) -> Outcome {
    if !arguments.is_empty() {
        return Err("usage: cargo xtask tidy".into());
    }
    let mut report = check_repository()?;
    report.findings.sort();
    report.notices.sort();
    for notice in &report.notices {
        println!("notice: {notice}");
    }
    for finding in &report.findings {
        println!("{finding}");
    }
    match report.findings.len() {
        0 => Ok(()),
        1 => Err("1 finding".into()),
        n => Err(format!("{n} findings")),
    }
}

fn check_repository() -> Result<Report, String> {
    let root = process::root();
    let mut report = Report::default();
    let architecture = std::fs::read_to_string(root.join(ARCHITECTURE)).unwrap_or_default();
    let metadata = capture(&mut cargo(&["metadata", "--no-deps", "--format-version", "1"]))?;
    let graph = dependencies::parse_metadata(&metadata)?;
    let layers = Layers::parse(ARCHITECTURE, &architecture, &mut report.findings);
    report.findings.extend(dependencies::compare(ARCHITECTURE, &layers, &graph));
    let mut boundaries = Boundaries::new(ARCHITECTURE, &architecture, &layers, &mut report.findings);
    let mut asset_bytes = 0;
    for path in tracked_files(&root)? {
        let Ok(bytes) = std::fs::read(root.join(&path)) else { continue };
        asset_bytes += if text::is_asset(&path) { bytes.len() } else { 0 };
        check_file(&path, &bytes, &mut boundaries, &mut report);
    }
    report.findings.extend(boundaries.finish());
    report.findings.extend(text::asset_total(asset_bytes));
    Ok(report)
}

fn check_file(path: &str, bytes: &[u8], boundaries: &mut Boundaries, report: &mut Report) {
    report.findings.extend(text::size(path, bytes.len()));
    let Ok(content) = std::str::from_utf8(bytes) else { return };
    report.findings.extend(text::forbidden_words(path, content));
    if path == "CHANGELOG.md" {
        report.findings.extend(text::changelog(path, content));
    }
    if text::is_our_text(path) {
        report.findings.extend(text::whitespace(path, content));
    }
    if Path::new(path).extension().is_some_and(|extension| extension == "rs") {
        report.findings.extend(text::module_documentation(path, content));
        text::length(path, content, report);
        report.findings.extend(boundaries.check(path, content));
    }
}

/// Files that git knows, and new ones that it does not ignore: what a commit could hold.
fn tracked_files(root: &Path) -> Result<BTreeSet<String>, String> {
    let list = ["ls-files", "-z", "--cached", "--others", "--exclude-standard"];
    let output = capture(command("git", &list).current_dir(root))?;
    let names = output.split(|&byte| byte == 0).filter(|name| !name.is_empty());
    Ok(names.map(|name| String::from_utf8_lossy(name).into_owned()).collect())
}
