//! Texts of peers, before they come to terminals, logs and pages.

use crate::limits::{NAME, TEXT};
use indigo_diag::is_hidden;

/// The text without what a terminal could take for a command or a log for a line of its own, and not too long.
pub fn plain(text: &str) -> String {
    let mut plain = cleaned(text, TEXT, |c| !is_hidden(c));
    if text.chars().nth(TEXT).is_some() {
        plain.push_str("...");
    }
    plain
}

/// The same of several lines.
pub fn plain_lines(text: &str) -> String {
    /// More of them nobody reads.
    const LINES: usize = 20;
    let lines: Vec<String> =
        text.lines().take(LINES).map(|line| cleaned(line, TEXT, |c| !is_hidden(c))).collect();
    lines.join("\n")
}

/// The same of a machine's name, which also stands where a text might begin.
pub fn name_of(name: &str) -> String {
    let name = cleaned(name, NAME, |c| c.is_alphanumeric() || " .-_()".contains(c));
    if name.trim().is_empty() { "a slave".to_owned() } else { name }
}

fn cleaned(text: &str, most: usize, may_stay: impl Fn(char) -> bool) -> String {
    text.chars().take(most).map(|c| if may_stay(c) { c } else { '_' }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_cannot_write_over_the_screen() {
        assert_eq!(name_of("render-3.local (night)"), "render-3.local (night)");
        assert_eq!(name_of("\x1b[2J<b>\n"), "__2J_b__");
        assert_eq!(name_of(&"x".repeat(1000)).len(), NAME);
        assert_eq!(name_of(" "), "a slave");
    }

    #[test]
    fn texts_cannot_either() {
        assert_eq!(plain("max_depth is 3 there, \"é\""), "max_depth is 3 there, \"é\"");
        assert_eq!(plain("\x1b[2J\r\nWarning:\u{202e}"), "_[2J__Warning:_");
        assert_eq!(plain(&"x".repeat(40 << 20)).len(), TEXT + 3);
        assert_eq!(plain(&"x".repeat(TEXT)).len(), TEXT);
    }
}
