//! The help, as text.

use super::table::FLAGS;
use std::fmt::Write as _;

/// What the program does.
pub const SUMMARY: &str =
    "Rendering goes on, and the picture is saved again and again, until Ctrl-C or a halting condition.";

/// The help of a program that is used so: its name and the scene.
pub fn help(usage: &str) -> String {
    let mut text = format!("Indigo renders scenes by the laws of light.\n\nUsage: {usage} [options]\n\n");
    for line in wrap(SUMMARY, 90) {
        text += &line;
        text.push('\n');
    }
    text += "Exit status: 0 rendered, 1 rendering or writing failed, 2 bad scene or usage.\n\n\
             Options (with one dash or two, before or after the scene):\n";
    for flag in FLAGS {
        let alias = flag.alias.map(|a| format!(", -{a}")).unwrap_or_default();
        let left = format!("-{}{alias} {}", flag.name, flag.value.unwrap_or_default());
        let lines = wrap(flag.doc, 72);
        // Writing to a string cannot fail.
        let _ = writeln!(text, "  {:<20} {}", left.trim_end(), lines[0]);
        for line in &lines[1..] {
            let _ = writeln!(text, "  {:<20} {line}", "");
        }
    }
    text
}

/// Breaks a text into lines of at most `width` characters (longer words stand alone); never empty.
fn wrap(text: &str, width: usize) -> Vec<String> {
    let mut lines = vec![String::new()];
    for word in text.split(' ') {
        let line = lines.last_mut().map_or(0, |l| l.len());
        if line > 0 && line + 1 + word.len() > width {
            lines.push(String::new());
        }
        if let Some(last) = lines.last_mut() {
            if !last.is_empty() {
                last.push(' ');
            }
            last.push_str(word);
        }
    }
    lines
}
