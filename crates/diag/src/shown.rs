//! Texts from outside, before they come to a terminal or a log.

use std::borrow::Cow;

/// Whether a character moves the cursor, hides, or turns the direction of writing of what follows it.
#[must_use]
pub fn is_hidden(c: char) -> bool {
    let turns = matches!(c, '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
    c.is_control() || turns
}

/// A text with nothing in it that a terminal acts on: names come from files, and files from anybody. Lines behind the first are
/// indented, so that none of them passes for a message of its own.
pub fn shown(text: &str) -> Cow<'_, str> {
    if !text.contains(is_hidden) {
        return text.into();
    }
    let mut shown = String::with_capacity(text.len());
    let mut is_start = false;
    for c in text.chars() {
        if is_start && c != ' ' {
            shown.push_str("  ");
        }
        is_start = c == '\n';
        shown.push(match c {
            '\n' => c,
            '\t' => ' ',
            c if is_hidden(c) => '\u{fffd}',
            c => c,
        });
    }
    shown.into()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts_cannot_write_over_the_screen_or_pass_for_others() {
        assert_eq!(shown("a/b.igs: 3 × \"é\""), "a/b.igs: 3 × \"é\"");
        assert_eq!(
            shown("a\x1b[2J\x07\u{9b}31m\u{202e}b\r"),
            "a\u{fffd}[2J\u{fffd}\u{fffd}31m\u{fffd}b\u{fffd}"
        );
        assert_eq!(shown("a\nforged: no errors\n\n  told"), "a\n  forged: no errors\n  \n  told");
        assert_eq!(shown("key:\tvalue"), "key: value");
    }
}
