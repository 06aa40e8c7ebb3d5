//! Rules about files as text: white space, length, size, words, headings.

use super::{Finding, Report};

/// Above this many lines a file is probably two files.
const SOFT_LINES: usize = 400;
/// Above this many lines it certainly is.
const HARD_LINES: usize = 700;
/// The largest file that may be committed.
const MAX_FILE: usize = 1 << 20;
/// The most that all test assets together may weigh, so that a clone stays quick.
const MAX_ASSETS: usize = 40 << 20;

/// Words of one machine or one way of working, which mean nothing to a reader of the repository.
/// Spelt in two halves here, so that this list does not find itself.
const FORBIDDEN: &[&str] = &[
    concat!("/wo", "rk/"),
    concat!("/tmp", "/target"),
    concat!("/ro", "ot/"),
    concat!("helper ", "agent"),
    concat!("sub", "agent"),
    concat!("this ", "workplace"),
    concat!("language ", "model"),
];

/// Whether we wrote the file ourselves, in a format whose white space we care about.
pub fn is_our_text(path: &str) -> bool {
    let ours = [".rs", ".md", ".toml"].iter().any(|ending| path.ends_with(ending));
    ours && !is_asset(path)
}

/// Whether the file is a test asset: what it holds is its maker's business.
pub fn is_asset(path: &str) -> bool {
    path.split('/').any(|part| part == "assets") || path.starts_with("testscenes/")
}

/// No tabs, no trailing blanks, no CR, and a line end at the end of the file.
pub fn whitespace(path: &str, content: &str) -> Vec<Finding> {
    let mut findings = Vec::new();
    for (i, line) in content.split('\n').enumerate() {
        let mut note = |what: &str| findings.push(Finding::new(path, i + 1, what));
        if line.ends_with('\r') {
            note("carriage return; lines end with a line feed alone");
        } else if line.ends_with([' ', '\t']) {
            note("trailing white space");
        }
        if line.contains('\t') {
            note("tab; indent with spaces");
        }
    }
    if !content.is_empty() && !content.ends_with('\n') {
        findings.push(Finding::new(path, content.split('\n').count(), "no line end at the end of the file"));
    }
    findings
}

/// No word of [`FORBIDDEN`].
pub fn forbidden_words(path: &str, content: &str) -> Vec<Finding> {
    let in_line = |(i, line): (usize, &str)| {
        let line = line.to_lowercase();
        let word = FORBIDDEN.iter().find(|word| line.contains(**word))?;
        Some(Finding::new(path, i + 1, format!("`{word}` means nothing to a reader elsewhere")))
    };
    content.lines().enumerate().filter_map(in_line).collect()
}

/// Every source file says in its first line what it is, but for the tests of the file beside them.
pub fn module_documentation(path: &str, content: &str) -> Option<Finding> {
    if path.ends_with("/tests.rs") {
        return None;
    }
    let documented =
        content.lines().find(|line| !line.starts_with("#![")).is_some_and(|l| l.starts_with("//!"));
    (!documented).then(|| Finding::new(path, 1, "no `//!` line that says what the file is"))
}

/// Long files are noticed, very long ones refused, unless they are tables of numbers.
pub fn length(path: &str, content: &str, report: &mut Report) {
    let lines = content.lines().count();
    let table = path.split('/').any(|part| part == "data" || part.contains("table"));
    if lines > HARD_LINES && !table {
        report.findings.push(Finding::new(
            path,
            0,
            format!("{lines} lines; split it ({HARD_LINES} at most)"),
        ));
    } else if lines > SOFT_LINES && !table {
        report.notices.push(Finding::new(
            path,
            0,
            format!("{lines} lines; more than {SOFT_LINES} read badly"),
        ));
    }
}

/// No file above [`MAX_FILE`].
pub fn size(path: &str, bytes: usize) -> Option<Finding> {
    (bytes > MAX_FILE)
        .then(|| Finding::new(path, 0, format!("{bytes} bytes; at most {MAX_FILE} are committed")))
}

/// All assets together below [`MAX_ASSETS`].
pub fn asset_total(bytes: usize) -> Option<Finding> {
    let what = || format!("test assets of {bytes} bytes altogether; at most {MAX_ASSETS}");
    (bytes > MAX_ASSETS).then(|| Finding::new("testscenes", 0, what()))
}

/// The change log has a place for what is not yet released.
pub fn changelog(path: &str, content: &str) -> Option<Finding> {
    let found = content.lines().any(|line| line.starts_with('#') && line.contains("Unreleased"));
    (!found).then(|| Finding::new(path, 0, "no heading `Unreleased`"))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lines(findings: &[Finding]) -> Vec<usize> {
        findings.iter().map(|finding| finding.line).collect()
    }

    #[test]
    fn white_space_is_found_by_line() {
        assert!(whitespace("a.rs", "fine\nalso fine\n").is_empty());
        assert_eq!(lines(&whitespace("a.rs", "x \nok\n\ty\nz\r\n")), [1, 3, 4]);
        assert_eq!(lines(&whitespace("a.rs", "no end")), [1]);
    }

    #[test]
    fn forbidden_words_in_any_case() {
        let text = format!("ok\nsee {}x\n{}\n", FORBIDDEN[0], FORBIDDEN[3].to_uppercase());
        assert_eq!(lines(&forbidden_words("a.md", &text)), [2, 3]);
    }

    #[test]
    fn this_file_does_not_find_itself() {
        assert!(forbidden_words("text.rs", include_str!("text.rs")).is_empty());
    }

    #[test]
    fn module_documentation_comes_first() {
        assert!(module_documentation("lib.rs", "//! A crate.\nmod a;\n").is_none());
        assert!(module_documentation("lib.rs", "#![forbid(unsafe_code)]\n//! A crate.\n").is_none());
        assert!(module_documentation("lib.rs", "mod a;\n//! Late.\n").is_some());
        assert!(module_documentation("lib.rs", "").is_some());
        assert!(module_documentation("src/obj/tests.rs", "use super::*;\n").is_none());
    }

    #[test]
    fn length_has_a_notice_and_a_limit() {
        let count = |path: &str, lines: usize| {
            let mut report = Report::default();
            length(path, &"\n".repeat(lines), &mut report);
            (report.notices.len(), report.findings.len())
        };
        assert_eq!(count("a.rs", SOFT_LINES), (0, 0));
        assert_eq!(count("a.rs", SOFT_LINES + 1), (1, 0));
        assert_eq!(count("a.rs", HARD_LINES + 1), (0, 1));
        assert_eq!(count("src/tables/cie.rs", HARD_LINES + 1), (0, 0));
    }

    #[test]
    fn sizes_are_limited() {
        assert!(size("a.ply", MAX_FILE).is_none() && size("a.ply", MAX_FILE + 1).is_some());
        assert!(asset_total(MAX_ASSETS).is_none() && asset_total(MAX_ASSETS + 1).is_some());
    }

    #[test]
    fn assets_are_left_as_they_are() {
        assert!(is_our_text("crates/math/src/lib.rs") && is_our_text("README.md"));
        assert!(!is_our_text("crates/formats/tests/assets/notes.md") && !is_our_text("a.ply"));
    }

    #[test]
    fn change_log_needs_its_heading() {
        assert!(changelog("CHANGELOG.md", "# Changes\n\n## Unreleased\n").is_none());
        assert!(changelog("CHANGELOG.md", "# Changes\nUnreleased things\n").is_some());
    }
}
