//! The manual page, in the language of `man`: `indigo_console -man | man -l -`.

use super::help::SUMMARY;
use super::table::{FLAGS, Flag};
use std::fmt::Write as _;

/// The page.
pub fn man() -> String {
    let mut page = format!(
        ".TH INDIGO_CONSOLE 1 \"\" \"Indigo {}\" \"Indigo\"\n\
         .SH NAME\nindigo_console \\- renders scenes by the laws of light\n\
         .SH SYNOPSIS\n.B indigo_console\n.I SCENE.igs\n[options]\n.br\n.B indigo_console\n.I SCENE.pigs\n[options]\n\
         .SH DESCRIPTION\n{}\n.SH OPTIONS\n\
         Options stand before or after the scene, with one dash or two.\n",
        env!("CARGO_PKG_VERSION"),
        escaped(SUMMARY)
    );
    for flag in FLAGS {
        // Writing to a string cannot fail.
        let _ = write!(page, ".TP\n{}\n{}\n", head(flag), escaped(flag.doc));
    }
    page.push_str(
        ".SH EXIT STATUS\n\
         .TP\n.B 0\nThe scene was rendered, or what else was asked for is done.\n\
         .TP\n.B 1\nRendering, or reading or writing files, failed.\n\
         .TP\n.B 2\nThe scene or the command line is wrong.\n\
         .SH ENVIRONMENT\n\
         .TP\n.B INDIGO_CACHE\nThe folder that keeps built trees, and scenes of network masters.\n\
         .TP\n.B INDIGO_KEY\nThe key of a network render, where no file of it is given.\n\
         .TP\n.B INDIGO_OIDN\nThe file of the library Open Image Denoise.\n\
         .TP\n.B INDIGO_RESOURCES\nA folder of files that scenes may name, such as nkdata.\n\
         .TP\n.B NO_COLOR\nIf it is set, messages have no colours.\n\
         .SH FILES\n\
         .TP\n.I inifile.xml\nSettings for all scenes, in the current folder or beside the program.\n\
         .TP\n.I log.txt\nWhat was said, in the current folder.\n",
    );
    page
}

fn head(flag: &Flag) -> String {
    let names: Vec<String> = std::iter::once(flag.name)
        .chain(flag.alias)
        .map(|name| format!("\\fB\\-{}\\fR", escaped(name)))
        .collect();
    match flag.value {
        Some(value) => format!("{} \\fI{}\\fR", names.join(", "), escaped(value)),
        None => names.join(", "),
    }
}

/// Text in which nothing is taken for a command: no dash for a hyphen, no backslash, no point at the start of a line.
fn escaped(text: &str) -> String {
    let text = text.replace('\\', "\\e").replace('-', "\\-");
    if text.starts_with(['.', '\'']) { format!("\\&{text}") } else { text }
}
