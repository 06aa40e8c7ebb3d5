//! `cargo xtask counts`: how many instructions the kernels take for a fixed amount of work, counted by valgrind, beside
//! those on record.
//!
//! Seconds change with whatever else a machine does; instructions do not. They say nothing of memory and of how many run
//! at once, so that benchmarks still have the last word on speed; but what makes a kernel do more than it did is seen at
//! once, and by which change.

use std::path::{Path, PathBuf};

use serde_json::{Map, Value, json};

use crate::Outcome;
use crate::apt::Needed;
use crate::process::{self, capture, cargo, command, root, target_dir};

const USAGE: &str = "usage: cargo xtask counts [--update WHY] [KERNEL]";
const VALGRIND: Needed =
    Needed { what: "for counting instructions valgrind is", program: "valgrind", packages: &["valgrind"] };
/// What is on record.
const RECORD: &str = "tests/instructions.json";
/// What is counted, by its name in the benchmark.
const COUNTED: &str = "*indigo_counted*";
/// Counts may differ by this part. Runs of one program differ by nothing at all; but a compiler lays out a kernel a little differently when a neighbour changes, and
/// that is not what is to be caught.
const TOLERANCE: f64 = 0.02;
/// The processor that the kernels are built for here: valgrind before 3.23 does not know all instructions of x86-64-v3, for which
/// Indigo is built otherwise. The ray kernel uses AVX2 all the same.
const PROCESSOR: &str = "x86-64-v2";

/// Counts, and compares or writes down.
///
/// # Errors
/// What could not be built, counted, read or written; kernels whose counts are not those on record.
pub fn run_command(arguments: &[String]) -> Outcome {
    let (why, only) = match arguments {
        [flag, why] if flag == "--update" && !why.trim().is_empty() => (Some(why), None),
        [] => (None, None),
        [kernel] if !kernel.starts_with('-') => (None, Some(kernel)),
        _ => return Err(USAGE.into()),
    };
    if !cfg!(all(target_os = "linux", target_arch = "x86_64")) {
        println!("instructions are counted on x86-64 under Linux alone");
        return Ok(());
    }
    VALGRIND.ensure()?;
    let program = build()?;
    let names = String::from_utf8_lossy(&capture(&mut command(&program, &[]))?).into_owned();
    let wanted = names.lines().filter(|name| only.is_none_or(|only| only == name));
    let counts: Vec<(String, u64)> =
        wanted.map(|name| Ok((name.to_owned(), count(&program, name)?))).collect::<Result<_, String>>()?;
    if counts.is_empty() {
        return Err(format!("no such kernel; there are:\n{names}"));
    }
    let record = root().join(RECORD);
    match why {
        Some(why) => write(&record, why, &counts),
        None => compare(&read(&record)?, &counts, only.is_none()),
    }
}

/// Builds the kernels in a folder of their own, since they are built for another processor.
fn build() -> Result<PathBuf, String> {
    let arguments = ["bench", "--no-run", "--package", "indigo-transport", "--bench", "counts"];
    let mut bench = cargo(&arguments);
    bench
        .env("CARGO_TARGET_DIR", target_dir().join("counts"))
        .env("RUSTFLAGS", format!("-Ctarget-cpu={PROCESSOR}"));
    process::build(&mut bench, "counts")
}

fn count(program: &Path, kernel: &str) -> Result<u64, String> {
    let file = target_dir().join("counts").join(format!("{kernel}.callgrind"));
    let mut valgrind = command("valgrind", &["--tool=callgrind", "--quiet"]);
    valgrind
        .arg(format!("--toggle-collect={COUNTED}"))
        .arg(format!("--callgrind-out-file={}", file.display()))
        .arg(program)
        .arg(kernel)
        // One thread, which valgrind does not switch away from.
        .env("RAYON_NUM_THREADS", "1");
    capture(&mut valgrind)?;
    let fault = |why: &dyn std::fmt::Display| format!("{}: {why}", file.display());
    let text = std::fs::read_to_string(&file).map_err(|error| fault(&error))?;
    total(&text).filter(|&n| n > 0).ok_or_else(|| fault(&"holds no count"))
}

/// The sum that callgrind writes at the end of its file.
fn total(text: &str) -> Option<u64> {
    text.lines().rev().find_map(|line| line.strip_prefix("totals:"))?.trim().parse().ok()
}

/// Kernels by name, and the compiler of the counts.
struct Record {
    compiler: String,
    counts: Map<String, Value>,
}

fn read(path: &Path) -> Result<Record, String> {
    let fault = |why: &dyn std::fmt::Display| format!("{}: {why}", path.display());
    let text = std::fs::read_to_string(path).map_err(|error| fault(&error))?;
    let record: Value = serde_json::from_str(&text).map_err(|error| fault(&error))?;
    let counts =
        record["instructions"].as_object().cloned().ok_or_else(|| fault(&"holds no instructions"))?;
    Ok(Record { compiler: record["compiler"].as_str().unwrap_or_default().to_owned(), counts })
}

fn write(path: &Path, why: &str, counts: &[(String, u64)]) -> Outcome {
    let counts: Map<String, Value> = counts.iter().map(|(name, n)| (name.clone(), json!(n))).collect();
    let record = json!({
        "about": format!("instructions of `cargo xtask counts`, built for {PROCESSOR}"),
        "compiler": compiler()?,
        "why": why,
        "instructions": counts,
    });
    std::fs::write(path, format!("{record:#}\n")).map_err(|error| format!("{}: {error}", path.display()))?;
    println!("{}", path.display());
    Ok(())
}

fn compiler() -> Result<String, String> {
    let said = capture(&mut command("rustc", &["--version"]))?;
    Ok(String::from_utf8_lossy(&said).trim().to_owned())
}

/// What became of a kernel.
#[derive(Debug, PartialEq)]
enum Verdict {
    Same,
    More,
    Fewer,
    New,
}

fn verdict(count: u64, on_record: Option<u64>) -> Verdict {
    match on_record.map(|then| count as f64 / then as f64) {
        None => Verdict::New,
        Some(ratio) if ratio > 1.0 + TOLERANCE => Verdict::More,
        Some(ratio) if ratio < 1.0 - TOLERANCE => Verdict::Fewer,
        Some(_) => Verdict::Same,
    }
}

/// Against the record, of which none may be missing where `are_all` are counted.
fn compare(record: &Record, counts: &[(String, u64)], are_all: bool) -> Outcome {
    let mut others = vec![];
    println!("{:<26} {:>14} {:>14} {:>8}", "kernel", "instructions", "on record", "ratio");
    for (name, count) in counts {
        let then = record.counts.get(name).and_then(Value::as_u64);
        let verdict = verdict(*count, then);
        let ratio = then.map_or_else(String::new, |then| format!("{:.4}", *count as f64 / then as f64));
        let word = if verdict == Verdict::Same { String::new() } else { format!("  {verdict:?}") };
        println!(
            "{name:<26} {count:>14} {:>14} {ratio:>8}{word}",
            then.map_or_else(String::new, |n| n.to_string())
        );
        if verdict != Verdict::Same {
            others.push(name.as_str());
        }
    }
    let is_counted = |name: &&String| counts.iter().any(|(counted, _)| counted == *name);
    if let Some(name) = record.counts.keys().find(|name| are_all && !is_counted(name)) {
        return Err(format!("{name} is on record, and there is no such kernel"));
    }
    let here = compiler()?;
    if here != record.compiler {
        println!("not judged: the record is of {}, and this is {here}", record.compiler);
        return Ok(());
    }
    if others.is_empty() {
        return Ok(());
    }
    Err(format!(
        "not within {} percent of the record: {}; if this is meant, `cargo xtask counts --update \"why\"` writes a new one",
        100.0 * TOLERANCE,
        others.join(", ")
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_sum_is_read() {
        assert_eq!(total("events: Ir\nfn=(1) a\n1 5\n\ntotals: 1234\n"), Some(1234));
        assert_eq!(total("events: Ir\n"), None);
    }

    #[test]
    fn kernels_are_judged_by_the_tolerance_to_both_sides() {
        assert_eq!(verdict(1019, Some(1000)), Verdict::Same);
        assert_eq!(verdict(1021, Some(1000)), Verdict::More);
        assert_eq!(verdict(979, Some(1000)), Verdict::Fewer);
        assert_eq!(verdict(1, None), Verdict::New);
    }
}
