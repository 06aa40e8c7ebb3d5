//! What a run found: on the terminal, as JSON, and as a page.

use std::fmt::Write;
use std::path::Path;

use serde_json::{Value, json};

use super::check::{Check, Demand, Form, Target};
use super::judge::{Failure, Verdict};
use super::page;
use super::picture::Picture;
use super::statistics::Estimate;

/// A check, its pictures and what they said.
pub struct Checked {
    /// What was to be shown.
    pub check: Check,
    /// What was asked of it.
    pub demand: Demand,
    /// The pictures by renderer and seed.
    pub renders: Vec<Vec<Picture>>,
    /// How long the renders of each renderer took, added up.
    pub seconds: Vec<f64>,
    /// The judgements.
    pub verdicts: Vec<Verdict>,
    /// Why there are no pictures, if there are none.
    pub broken: Option<String>,
}

/// All of a run.
pub struct Report {
    /// In the order of the checks.
    pub checked: Vec<Checked>,
    /// What was typed.
    pub command: String,
    /// When it began.
    pub date: String,
    /// The machine that it ran on.
    pub machine: Value,
    /// How long it took.
    pub seconds: f64,
    /// How much was rendered.
    pub form: Form,
    /// Probability of any false alarm.
    pub family: f64,
    /// What part of all checks it tells of.
    pub extent: String,
    /// Of the console.
    pub version: String,
    /// Of the other renderer, where it rendered.
    pub peer: Option<String>,
}

/// How many checks were left out, by the reason.
#[derive(Debug, Default)]
pub struct LeftOut(Vec<(String, usize)>);

impl LeftOut {
    /// Of a reason for each check.
    pub fn count(reasons: impl Iterator<Item = String>) -> Self {
        let mut counts: Vec<(String, usize)> = vec![];
        for reason in reasons {
            match counts.iter_mut().find(|(known, _)| *known == reason) {
                Some((_, count)) => *count += 1,
                None => counts.push((reason, 1)),
            }
        }
        Self(counts)
    }

    /// All of them.
    pub fn checks(&self) -> usize {
        self.0.iter().map(|(_, count)| count).sum()
    }

    /// What part of it all so many checks are: a part must not pass for the whole.
    pub fn words(&self, rendered: usize) -> String {
        if self.0.is_empty() {
            return format!("all {rendered} checks");
        }
        let reasons: Vec<String> = self.0.iter().map(|(reason, count)| format!("{count} {reason}")).collect();
        format!("{rendered} of {} checks; left out: {}", rendered + self.checks(), reasons.join(", "))
    }
}

impl Checked {
    /// How many of its comparisons failed, or that it was not rendered.
    pub fn failures(&self) -> usize {
        let failed = self.verdicts.iter().filter(|verdict| verdict.failure.is_some()).count();
        failed + usize::from(self.broken.is_some())
    }
}

impl Report {
    /// Checks that were not rendered, and why.
    pub fn broken(&self) -> impl Iterator<Item = (&Check, &str)> {
        self.checked.iter().filter_map(|c| Some((&c.check, c.broken.as_deref()?)))
    }

    /// Comparisons that failed, with their checks.
    pub fn failures(&self) -> impl Iterator<Item = (&Check, &Verdict)> {
        self.verdicts().filter(|(_, verdict)| verdict.failure.is_some())
    }

    /// How many comparisons resolve less finely than they should, but not surely so.
    pub fn coarse(&self) -> usize {
        self.verdicts().filter(|(_, verdict)| verdict.failure.is_none() && verdict.is_coarse()).count()
    }

    /// All comparisons.
    pub fn verdicts(&self) -> impl Iterator<Item = (&Check, &Verdict)> {
        self.checked.iter().flat_map(|c| c.verdicts.iter().map(move |verdict| (&c.check, verdict)))
    }

    /// The groups in their order, each with its checks.
    pub fn groups(&self) -> Vec<(&'static str, Vec<&Checked>)> {
        let mut groups: Vec<(&'static str, Vec<&Checked>)> = vec![];
        for checked in &self.checked {
            match groups.iter_mut().find(|(name, _)| *name == checked.check.group) {
                Some((_, list)) => list.push(checked),
                None => groups.push((checked.check.group, vec![checked])),
            }
        }
        groups
    }

    /// Writes `report.html` and `report.json` into a folder.
    pub fn write(&self, folder: &Path) -> Result<(), String> {
        let write = |name: &str, text: String| {
            let path = folder.join(name);
            std::fs::write(&path, text).map_err(|error| format!("{}: {error}", path.display()))?;
            println!("{}", path.display());
            Ok::<(), String>(())
        };
        write("report.json", format!("{:#}\n", self.json()))?;
        write("report.html", page::page(self))
    }

    /// Says on the terminal what failed, and a line for each group.
    pub fn say(&self) {
        for (check, verdict) in self.failures() {
            println!("FAILED {}", sentence(check, verdict));
        }
        for (check, error) in self.broken() {
            println!("NOT RENDERED {}: {}: {error}", check.group, check.name);
        }
        for (name, list) in self.groups() {
            let verdicts: Vec<&Verdict> = list.iter().flat_map(|c| &c.verdicts).collect();
            let failed: usize = list.iter().map(|checked| checked.failures()).sum();
            let least = verdicts.iter().map(|verdict| verdict.comparison.p).fold(1.0, f64::min);
            println!("{name:<28} {:>4} comparisons, {failed:>3} failed, least p {least:.1e}", verdicts.len());
        }
        let coarse = self.coarse();
        if coarse > 0 {
            println!(
                "{coarse} comparisons resolve less finely than asked, but not beyond the error of their noise"
            );
        }
        println!("{}", self.extent);
        println!("{:.0} s, without what was built or installed", self.seconds);
    }

    fn json(&self) -> Value {
        let interval = |e: &Estimate| [e.mean - e.half_interval(), e.mean + e.half_interval()];
        let verdict = |v: &Verdict| {
            json!({
                "renderer": v.renderer.name(),
                "what": v.what,
                "area": v.area,
                "expected": v.expected.mean,
                "expected_standard_error": v.expected.error,
                "at_most": v.is_bound,
                "expected_interval": interval(&v.expected),
                "measured": v.measured.mean,
                "standard_error": v.measured.error,
                "interval": interval(&v.measured),
                "renders": v.measured.count,
                "granted": v.allowance,
                "t": written(v.comparison.t),
                "degrees_of_freedom": v.comparison.freedom,
                "p": v.comparison.p,
                "threshold": v.threshold,
                "resolution": v.resolution,
                "demand": v.demand,
                "failure": v.failure.map(Failure::words),
                "pass": v.failure.is_none(),
            })
        };
        let check = |c: &Checked| {
            json!({
                "group": c.check.group,
                "name": c.check.name,
                "about": c.check.about,
                "unit_cd_per_m2": c.check.unit,
                "samples_per_pixel": c.check.renderers.iter()
                    .map(|&renderer| (renderer.name().to_owned(), json!(c.check.samples(self.form, renderer))))
                    .collect::<serde_json::Map<_, _>>(),
                "seconds_of_renders": c.check.renderers.iter().zip(&c.seconds)
                    .map(|(renderer, seconds)| (renderer.name().to_owned(), json!(seconds)))
                    .collect::<serde_json::Map<_, _>>(),
                "not_rendered": c.broken,
                "verdicts": c.verdicts.iter().map(verdict).collect::<Vec<_>>(),
            })
        };
        json!({
            "command": self.command,
            "form": match self.form {
                Form::Quick => "quick",
                Form::Full => "full",
            },
            "version": self.version,
            "beside": self.peer,
            "date": self.date,
            "machine": self.machine,
            "seconds": self.seconds,
            "renders": self.form.seeds(),
            "family_false_alarm": self.family,
            "extent": self.extent,
            "comparisons": self.verdicts().count(),
            "failures": self.failures().count(),
            "coarse": self.coarse(),
            "pass": self.failures().count() == 0 && self.broken().count() == 0,
            "checks_not_rendered": self.broken().count(),
            "checks": self.checked.iter().map(check).collect::<Vec<_>>(),
        })
    }
}

/// A number, or its name where JSON has none for it.
fn written(value: f64) -> Value {
    if value.is_finite() { json!(value) } else { json!(value.to_string()) }
}

/// A judgement in words.
pub fn sentence(check: &Check, verdict: &Verdict) -> String {
    let mut text = format!("{}: {}, {}", check.group, check.name, verdict.renderer.name());
    if !verdict.what.is_empty() {
        let _ = write!(text, ", {}", verdict.what);
    }
    let (m, e) = (&verdict.measured, &verdict.expected);
    let against = match check.rows.first().map(|row| &row.target) {
        Some(Target::First(_)) => "the first renderer's",
        _ if verdict.is_bound => "at most",
        _ => "expected",
    };
    let reason = verdict.failure.map_or("agrees", Failure::words);
    let (t, p) = (verdict.comparison.t, verdict.comparison.p);
    let percent = 100.0 * (m.mean / e.mean - 1.0);
    let _ = write!(
        text,
        ": {reason}: {:.6} (standard error {:.6}), {against} {:.6} ({percent:+.3} %), {t:+.1} standard errors, p = {p:.1e}",
        m.mean, m.error, e.mean
    );
    if verdict.failure == Some(Failure::Unresolved) {
        let [shows, must] = [verdict.resolution, verdict.demand].map(|share| 100.0 * share);
        let _ = write!(text, "; shows {shows:.3} % where {must} % must be");
    }
    text
}
