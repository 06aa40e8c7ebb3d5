//! `cargo xtask gen`: files that are written from the scene's declarations and from tables.

use std::path::Path;

use crate::Outcome;
use crate::media_library;
use crate::process::{self, capture, cargo};

/// Generated files, and the example programs that print them.
const GENERATED: &[(&str, &str)] =
    &[("docs/manual/scene-format.md", "reference"), ("docs/manual/errors.md", "errors")];

/// Writes every generated file, or with `--check` only says which would change.
pub fn run(arguments: &[String]) -> Outcome {
    let check = match arguments {
        [] => false,
        [flag] if flag == "--check" => true,
        _ => return Err("usage: cargo xtask gen [--check]".into()),
    };
    let mut files = Vec::new();
    for &(path, example) in GENERATED {
        // From the whole workspace, whose tests have built most of it.
        let program = process::build(&mut cargo(&["build", "--workspace", "--example", example]), example)?;
        files.push((path.to_owned(), capture(&mut process::command(program, &[]))?));
    }
    files.extend(media_library::files().into_iter().map(|(path, text)| (path, text.into_bytes())));
    let mut stale = Vec::new();
    for (name, text) in files {
        let path = process::root().join(&name);
        if up_to_date(&path, &text) {
            continue;
        }
        if check {
            stale.push(name);
        } else {
            write(&path, &text)?;
            println!("{name} written");
        }
    }
    if stale.is_empty() { Ok(()) } else { Err(format!("stale: {}; run `cargo xtask gen`", stale.join(", "))) }
}

/// Whether the file holds this text; line ends that git rewrote on checkout do not count.
fn up_to_date(path: &Path, text: &[u8]) -> bool {
    let plain = |bytes: &[u8]| bytes.iter().copied().filter(|&byte| byte != b'\r').collect::<Vec<_>>();
    std::fs::read(path).is_ok_and(|current| plain(&current) == plain(text))
}

fn write(path: &Path, text: &[u8]) -> Outcome {
    let failed = |error: std::io::Error| format!("{}: {error}", path.display());
    if let Some(folder) = path.parent() {
        std::fs::create_dir_all(folder).map_err(failed)?;
    }
    std::fs::write(path, text).map_err(failed)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_a_changed_text_is_stale() {
        let path = process::target_dir().join(format!("xtask-generate-{}.md", std::process::id()));
        write(&path, b"one\r\ntwo\r\n").unwrap();
        assert!(up_to_date(&path, b"one\ntwo\n"));
        assert!(!up_to_date(&path, b"one\nthree\n"));
        std::fs::remove_file(&path).unwrap();
        assert!(!up_to_date(&path, b"one\ntwo\n"));
    }
}
