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

const USAGE: &str = "usage: cargo xtask counts [KERNEL | --update WHY [--drop KERNEL]...]";
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

/// What is wanted.
#[derive(Debug, PartialEq)]
enum Task<'a> {
    /// To compare all, or one.
    Compare(Option<&'a str>),
    /// To write down all, for a reason, without kernels that are on record and are no more.
    Update(&'a str, Vec<&'a str>),
}

fn task(arguments: &[String]) -> Option<Task<'_>> {
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    match words[..] {
        [] => Some(Task::Compare(None)),
        [kernel] if !kernel.starts_with('-') => Some(Task::Compare(Some(kernel))),
        ["--update", why, ref rest @ ..] if !why.trim().is_empty() => {
            let (pairs, odd) = rest.as_chunks::<2>();
            let is_right = odd.is_empty() && pairs.iter().all(|[flag, _]| *flag == "--drop");
            is_right.then(|| Task::Update(why, pairs.iter().map(|[_, kernel]| *kernel).collect()))
        }
        _ => None,
    }
}

/// Counts, and compares or writes down.
///
/// # Errors
/// What could not be built, counted, read or written; kernels whose counts are not those on record.
pub fn run_command(arguments: &[String]) -> Outcome {
    if let Some(note) = judged(arguments)? {
        println!("{note}");
    }
    Ok(())
}

/// The same; what was not judged, and why, is given back, so that it can be said where it is seen.
///
/// # Errors
/// As those of [`run_command`].
pub fn judged(arguments: &[String]) -> Result<Option<String>, String> {
    let task = task(arguments).ok_or(USAGE)?;
    if !cfg!(all(target_os = "linux", target_arch = "x86_64")) {
        return Ok(Some("instructions were not counted: that is done on x86-64 under Linux alone".into()));
    }
    VALGRIND.ensure()?;
    let program = build()?;
    let names = String::from_utf8_lossy(&capture(&mut command(&program, &[]))?).into_owned();
    let only = if let Task::Compare(only) = task { only } else { None };
    let wanted = names.lines().filter(|name| only.is_none_or(|only| only == *name));
    let counts: Vec<(String, u64)> =
        wanted.map(|name| Ok((name.to_owned(), count(&program, name)?))).collect::<Result<_, String>>()?;
    if counts.is_empty() && only.is_some_and(|only| !can_run(only)) {
        return Ok(Some("not counted, since this processor has no AVX2".into()));
    }
    if counts.is_empty() {
        return Err(format!("no such kernel; there are:\n{names}"));
    }
    let record = root().join(RECORD);
    match task {
        Task::Update(why, dropped) => {
            let before = read(&record)?;
            let lost = lost(&before, &counts, &dropped);
            if !lost.is_empty() {
                return Err(format!(
                    "{} would be lost from the record: --drop KERNEL for each that is no more, or count where there are such kernels",
                    lost.join(", ")
                ));
            }
            write(&record, &updated(&before, &counts, why, &compiler()?)).map(|()| None)
        }
        Task::Compare(_) => compare(&read(&record)?, &counts, only.is_none()),
    }
}

/// Kernels on record that were not counted, but for those that are meant to go.
fn lost(record: &Record, counts: &[(String, u64)], dropped: &[&str]) -> Vec<String> {
    let is_kept = |name: &&String| {
        counts.iter().any(|(counted, _)| counted == *name) || dropped.contains(&name.as_str())
    };
    record.counts.keys().filter(|name| !is_kept(name)).cloned().collect()
}

/// Whether this processor can run a kernel: what needs AVX2 says so in its name.
fn can_run(kernel: &str) -> bool {
    #[cfg(target_arch = "x86_64")]
    let has_avx2 = std::is_x86_feature_detected!("avx2");
    #[cfg(not(target_arch = "x86_64"))]
    let has_avx2 = false;
    has_avx2 || !kernel.ends_with("_avx2")
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

/// Kernels by name, the compiler of the counts, and why each is what it is.
struct Record {
    compiler: String,
    counts: Map<String, Value>,
    why: Map<String, Value>,
}

fn read(path: &Path) -> Result<Record, String> {
    let fault = |why: &dyn std::fmt::Display| format!("{}: {why}", path.display());
    let text = std::fs::read_to_string(path).map_err(|error| fault(&error))?;
    let record: Value = serde_json::from_str(&text).map_err(|error| fault(&error))?;
    let of = |key: &str| record[key].as_object().cloned().ok_or_else(|| fault(&format!("holds no {key}")));
    let compiler = record["compiler"].as_str().unwrap_or_default().to_owned();
    Ok(Record { compiler, counts: of("instructions")?, why: of("why")? })
}

/// The record after an update. Of one compiler a kernel within the tolerance keeps its count and its reason, so that many small
/// steps, none of which is told, do not become a large one.
fn updated(before: &Record, counts: &[(String, u64)], why: &str, compiler: &str) -> Record {
    let mut after = Record { compiler: compiler.to_owned(), counts: Map::new(), why: Map::new() };
    for (name, count) in counts {
        let then = before.counts.get(name).and_then(Value::as_u64);
        let is_kept = before.compiler == compiler && verdict(*count, then) == Verdict::Same;
        let kept = then.filter(|_| is_kept).zip(before.why.get(name).cloned());
        let (count, why) = kept.unwrap_or_else(|| (*count, json!(why)));
        after.counts.insert(name.clone(), json!(count));
        after.why.insert(name.clone(), why);
    }
    after
}

fn write(path: &Path, record: &Record) -> Outcome {
    let record = json!({
        "about": format!("instructions of `cargo xtask counts`, built for {PROCESSOR}"),
        "compiler": record.compiler,
        "why": record.why,
        "instructions": record.counts,
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

/// Against the record, of which none may be missing where `are_all` are counted. Gives back what was not judged.
fn compare(record: &Record, counts: &[(String, u64)], are_all: bool) -> Result<Option<String>, String> {
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
    let missing = if are_all { lost(record, counts, &[]) } else { vec![] };
    let (gone, skipped): (Vec<String>, Vec<String>) = missing.into_iter().partition(|name| can_run(name));
    if !gone.is_empty() {
        return Err(format!("{} on record, and there is no such kernel", gone.join(", ")));
    }
    let here = compiler()?;
    if here != record.compiler {
        return Ok(Some(format!(
            "INSTRUCTIONS WERE NOT JUDGED: the record is of {}, and this is {here}; `cargo xtask counts --update \"why\"` makes it this one’s",
            record.compiler
        )));
    }
    if others.is_empty() {
        let note = || format!("not counted, since this processor has no AVX2: {}", skipped.join(", "));
        return Ok((!skipped.is_empty()).then(note));
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
    fn no_kernel_is_lost_by_an_update_unless_it_is_named() {
        let counts = [("a", 1), ("b", 2), ("c", 3)].map(|(name, n)| (name.to_owned(), json!(n)));
        let record =
            Record { compiler: String::new(), counts: counts.into_iter().collect(), why: Map::new() };
        let counted = [("a".to_owned(), 1)];
        assert_eq!(lost(&record, &counted, &[]), ["b", "c"]);
        assert_eq!(lost(&record, &counted, &["c"]), ["b"]);
        assert!(can_run("rays_closest"));
    }

    #[test]
    fn an_update_rewrites_what_changed_alone() {
        let of =
            |pairs: [(&str, Value); 2]| pairs.into_iter().map(|(name, v)| (name.to_owned(), v)).collect();
        let before = Record {
            compiler: "now".into(),
            counts: of([("a", json!(1000)), ("b", json!(1000))]),
            why: of([("a", json!("of old")), ("b", json!("of old"))]),
        };
        let counts = [("a".to_owned(), 1019), ("b".to_owned(), 1030)];
        let after = updated(&before, &counts, "more work", "now");
        assert_eq!(after.counts, of([("a", json!(1000)), ("b", json!(1030))]));
        assert_eq!(after.why, of([("a", json!("of old")), ("b", json!("more work"))]));
        // Another compiler makes other kernels of all.
        let after = updated(&before, &counts, "compiler", "later");
        assert_eq!(after.counts, of([("a", json!(1019)), ("b", json!(1030))]));
    }

    #[test]
    fn an_update_says_why_and_what_is_dropped() {
        let of = |words: &[&str]| words.iter().map(|word| (*word).to_owned()).collect::<Vec<String>>();
        let update = of(&["--update", "fewer boxes", "--drop", "old"]);
        assert_eq!(task(&update), Some(Task::Update("fewer boxes", vec!["old"])));
        for wrong in [&["--update"][..], &["--update", " "], &["--update", "why", "--drop"], &["--all"]] {
            assert_eq!(task(&of(wrong)), None);
        }
    }

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
