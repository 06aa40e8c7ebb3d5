//! All automation of the project: `cargo xtask help`.
//!
//! Written in Rust rather than in a shell or a make language, so that whoever can build Indigo can run
//! it, and everything here is checked by the same compiler, linter and tests.

mod apt;
mod bench;
mod bench_machine;
mod bench_rays;
mod counts;
mod display;
mod documents;
mod fuzz;
mod generate;
mod here;
mod media_library;
mod mistakes;
mod soak;
mod stages;
mod tidy;
mod validate;
mod venv;

use std::process::ExitCode;

use xtask::{Outcome, process, scenes};

/// A command: how it is called, what it is for, what runs it.
struct Command {
    name: &'static str,
    arguments: &'static str,
    about: &'static str,
    run: fn(&[String]) -> Outcome,
}

const COMMANDS: &[Command] = &[
    Command {
        name: "test",
        arguments: "[--full | --grid | --window] [FILTER]",
        about: "everything a change must pass; with FILTER only the tests whose name has it; --grid: the whole agreement grid alone; --window: the window's tests alone",
        run: stages::test,
    },
    Command { name: "fmt", arguments: "", about: "format all Rust code", run: stages::format },
    Command {
        name: "lint",
        arguments: "",
        about: "clippy over the workspace; warnings are errors",
        run: stages::lint,
    },
    Command {
        name: "tidy",
        arguments: "",
        about: "the rules of ARCHITECTURE.md that no compiler checks",
        run: tidy::run,
    },
    Command {
        name: "gen",
        arguments: "[--check]",
        about: "write what is generated from declarations and tables, or check that it is up to date",
        run: generate::run,
    },
    Command {
        name: "scenes",
        arguments: "SCENE|all",
        about: "write the scenes that are made by program into testscenes/generated; without SCENE their list",
        run: scenes::run,
    },
    Command {
        name: "validate",
        arguments: "[--full] [--only NAME] [...]",
        about: "render scenes whose pictures are known, and write a report with a verdict on each",
        run: validate::run,
    },
    Command {
        name: "mistakes",
        arguments: "",
        about: "make mistakes in a copy of the renderer, and see whether `validate` tells: a quarter of an hour",
        run: mistakes::run,
    },
    Command {
        name: "bench",
        arguments: "machine|rays|transport|CRATE [ARGUMENTS]",
        about: "benchmarks: machine (scaling with threads, triangles, pixels and so on; all with --full), rays against Embree, transport (ways of rendering at equal time), window, or those of one crate",
        run: bench::run,
    },
    Command {
        name: "counts",
        arguments: "[--update WHY] [KERNEL]",
        about: "instructions of the kernels for a fixed amount of work beside those on record; --update puts new ones on record",
        run: counts::run_command,
    },
    Command {
        name: "fuzz",
        arguments: "[SECONDS | --cases N] [TARGET]",
        about: "feed damaged files to every reader, SECONDS (60) or N cases each target",
        run: fuzz::run,
    },
    Command {
        name: "soak",
        arguments: "",
        about: "a network render of many machines through a long night of failures: some minutes",
        run: soak::run,
    },
    Command {
        name: "doc",
        arguments: "[--open]",
        about: "the API documentation; warnings are errors",
        run: documents::run,
    },
    Command { name: "help", arguments: "", about: "this list", run: help },
];

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let Some((name, rest)) = arguments.split_first() else {
        print_help();
        return ExitCode::from(2);
    };
    let wanted = if matches!(name.as_str(), "--help" | "-h") { "help" } else { name };
    let Some(command) = COMMANDS.iter().find(|command| command.name == wanted) else {
        eprintln!("xtask: no command `{name}`");
        print_help();
        return ExitCode::from(2);
    };
    match (command.run)(rest) {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("xtask {wanted}: {message}");
            ExitCode::FAILURE
        }
    }
}

#[allow(clippy::unnecessary_wraps)] // the shape that every command has
fn help(_: &[String]) -> Outcome {
    print_help();
    Ok(())
}

fn print_help() {
    println!("cargo xtask COMMAND\n");
    for command in COMMANDS {
        println!("  {:<42} {}", format!("{} {}", command.name, command.arguments), command.about);
    }
}
