//! What shells offer after a part of a word: `indigo_console -completions bash`.

use super::table::{FLAGS, Flag, Value};
use std::fmt::Write as _;

/// The shells that completions are written for.
pub const SHELLS: [&str; 3] = ["bash", "zsh", "fish"];

/// Endings of files that are a scene, a film or a picture.
const FILES: &str = "igs|pigs|igi|png";

/// The completions for a shell; `None` for a shell that is not known.
pub fn completions(shell: &str) -> Option<String> {
    match shell {
        "bash" => Some(bash()),
        "zsh" => Some(zsh()),
        "fish" => Some(fish()),
        _ => None,
    }
}

fn names(flag: &Flag) -> impl Iterator<Item = &'static str> {
    std::iter::once(flag.name).chain(flag.alias)
}

fn bash() -> String {
    let all: Vec<String> =
        FLAGS.iter().flat_map(names).flat_map(|name| [format!("-{name}"), format!("--{name}")]).collect();
    let mut choices = String::new();
    for flag in FLAGS {
        let Some(Value::Choice(words)) = flag.value.map(Value::of) else { continue };
        let names: Vec<String> = names(flag).flat_map(|n| [format!("-{n}"), format!("--{n}")]).collect();
        // Writing to a string cannot fail.
        let _ = write!(
            choices,
            "{}) mapfile -t COMPREPLY < <(compgen -W '{}' -- \"$word\"); return ;;\n        ",
            names.join("|"),
            words.join(" ")
        );
    }
    let with = |is_wanted: fn(&Value) -> bool| -> String {
        let wanted = FLAGS.iter().filter(|f| f.value.is_some_and(|value| is_wanted(&Value::of(value))));
        let names: Vec<String> =
            wanted.flat_map(names).flat_map(|n| [format!("-{n}"), format!("--{n}")]).collect();
        names.join("|")
    };
    format!(
        "_indigo_console() {{\n    \
         local word=${{COMP_WORDS[COMP_CWORD]}} before=${{COMP_WORDS[COMP_CWORD-1]}}\n    \
         COMPREPLY=()\n    \
         case $before in\n        \
         {choices}{}) return ;;\n        \
         {}) compopt -o filenames; mapfile -t COMPREPLY < <(compgen -f -- \"$word\"); return ;;\n    \
         esac\n    \
         if [[ $word == -* ]]; then\n        \
         mapfile -t COMPREPLY < <(compgen -W '{}' -- \"$word\")\n    \
         else\n        \
         compopt -o filenames\n        \
         mapfile -t COMPREPLY < <(compgen -d -- \"$word\"; compgen -f -- \"$word\" | grep -Ei '\\.({FILES})$')\n    \
         fi\n\
         }}\n\
         complete -F _indigo_console indigo_console\n",
        with(|value| *value == Value::Word),
        with(|value| *value == Value::File),
        all.join(" ")
    )
}

fn zsh() -> String {
    let mut script = String::from("#compdef indigo_console\n_arguments \\\n");
    for flag in FLAGS {
        let doc = first_sentence(flag.doc)
            .replace('\'', "'\\''")
            .replace('[', "\\[")
            .replace(']', "\\]")
            .replace(':', "\\:");
        for name in names(flag) {
            let value = flag.value.map_or_else(String::new, |value| match Value::of(value) {
                Value::Choice(words) => format!(":{}:({})", flag.name, words.join(" ")),
                Value::Word => format!(":{value}:"),
                Value::File => format!(":{value}:_files"),
            });
            // Writing to a string cannot fail.
            let _ = writeln!(script, "    '-{name}[{doc}]{value}' \\\n    '--{name}[{doc}]{value}' \\");
        }
    }
    let _ = writeln!(script, "    '*:file:_files -g \"*.({FILES})(-.)\"'");
    script
}

fn fish() -> String {
    let mut script = String::new();
    for flag in FLAGS {
        let doc = first_sentence(flag.doc).replace('\\', "\\\\").replace('\'', "\\'");
        for name in names(flag) {
            let value = match flag.value.map(Value::of) {
                None => String::new(),
                Some(Value::Word) => " -x".to_owned(),
                Some(Value::Choice(words)) => format!(" -x -a '{}'", words.join(" ")),
                Some(Value::File) => " -r".to_owned(),
            };
            // A long option, or a letter.
            let twice = if name.len() > 1 { format!(" -l {name}") } else { String::new() };
            // Writing to a string cannot fail.
            let _ = writeln!(script, "complete -c indigo_console -o {name}{twice}{value} -d '{doc}'");
        }
    }
    script
}

fn first_sentence(doc: &str) -> &str {
    let end = [". ", ": ", "; ", " ("].iter().filter_map(|mark| doc.find(mark)).min().unwrap_or(doc.len());
    doc.get(..end).unwrap_or(doc).trim_end_matches('.')
}
