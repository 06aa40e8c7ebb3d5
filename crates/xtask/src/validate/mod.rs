//! `cargo xtask validate`: renders scenes whose pictures are known, and says in a report whether they came out.
//!
//! Nothing of the renderer is linked: scenes are files, pictures are what the release console writes.

pub mod agreement;
pub mod change;
pub mod check;
pub mod codes;
pub mod console;
pub mod cross;
pub mod encode;
pub mod grid;
pub mod hung;
pub mod images;
pub mod judge;
pub mod kept;
pub mod oracles;
pub mod page;
pub mod picture;
#[path = "../../../testkit/src/png.rs"]
mod png;
pub mod report;
#[path = "../../../render/tests/common/shapes.rs"]
#[allow(dead_code, reason = "the renderer's tests make their scenes of the same parts")]
pub mod shapes;
pub mod signs;
pub mod statistics;
#[path = "../../../render/tests/common/text.rs"]
#[allow(dead_code, reason = "the renderer's tests make their scenes of the same parts")]
pub mod text;

use std::path::PathBuf;
use std::time::Instant;

use check::{Check, Form};
use console::{Console, Rendered};
use judge::{FAMILY, Judge, threshold};
use kept::Keep;
use report::{Checked, LeftOut, Report};

use crate::{Outcome, here, process, venv};

const USAGE: &str = "usage: cargo xtask validate [--full] [--only GROUP OR NAME] [--console PROGRAM] [--jobs N] \
                     [--no-mitsuba] [--resume] [--list] [--out FOLDER]";

struct Options {
    form: Form,
    only: Option<String>,
    console: Option<PathBuf>,
    jobs: usize,
    mitsuba: bool,
    resume: bool,
    list: bool,
    out: PathBuf,
}

impl Options {
    fn parse(arguments: &[String]) -> Result<Self, String> {
        let mut options = Self {
            form: Form::Quick,
            only: None,
            console: None,
            // A short render waits for its files to reach the disk for half of its time.
            jobs: 2 * std::thread::available_parallelism().map_or(1, usize::from),
            mitsuba: true,
            resume: false,
            list: false,
            out: process::target_dir().join("validation"),
        };
        let mut words = arguments.iter();
        while let Some(word) = words.next() {
            let mut value = || words.next().ok_or(USAGE);
            match word.as_str() {
                "--full" => options.form = Form::Full,
                "--no-mitsuba" => options.mitsuba = false,
                "--resume" => options.resume = true,
                "--list" => options.list = true,
                "--only" => options.only = Some(value()?.to_lowercase()),
                "--console" => options.console = Some(value()?.into()),
                "--jobs" => options.jobs = value()?.parse().map_err(|_| USAGE)?,
                "--out" => options.out = value()?.into(),
                _ => return Err(USAGE.into()),
            }
        }
        if options.resume && options.form == Form::Quick {
            return Err(format!("--resume goes on with a run of --full, which keeps its pictures\n{USAGE}"));
        }
        Ok(Self { jobs: options.jobs.max(1), ..options })
    }

    /// Why a check is left out, if it is.
    fn leaves_out(&self, check: &Check) -> Option<String> {
        let is_named = |only: &String| {
            check.group.to_lowercase().contains(only) || check.name.to_lowercase().contains(only)
        };
        match &self.only {
            Some(only) if !is_named(only) => Some(format!("not named “{only}” (--only)")),
            _ if check.full_only && self.form != Form::Full => Some("of the full form alone".to_owned()),
            _ if check.mitsuba.is_some() && !self.mitsuba => Some("beside Mitsuba (--no-mitsuba)".to_owned()),
            _ => None,
        }
    }
}

/// All checks.
fn all() -> Vec<Check> {
    [oracles::all(), agreement::all(), grid::all(), cross::all()].concat()
}

/// The p-value below which a comparison fails in the quick form of all checks.
pub fn quick_threshold() -> f64 {
    let checks: Vec<Check> = all().into_iter().filter(|check| !check.full_only).collect();
    threshold(comparisons(&checks))
}

fn comparisons(checks: &[Check]) -> usize {
    checks.iter().map(Check::comparisons).sum::<usize>() + signs::ways(checks).len()
}

/// `cargo xtask validate`.
///
/// # Errors
/// What could not be begun, or how much failed; there is a report of the latter.
pub fn run(arguments: &[String]) -> Outcome {
    let options = Options::parse(arguments)?;
    let date = here::date();
    let all = all();
    let left_out = LeftOut::count(all.iter().filter_map(|check| options.leaves_out(check)));
    let checks: Vec<Check> = all.into_iter().filter(|check| options.leaves_out(check).is_none()).collect();
    if checks.is_empty() {
        return Err("no check has that name".into());
    }
    if options.list {
        for check in &checks {
            list(check, options.form);
        }
        return Ok(());
    }
    let keep = match options.form {
        _ if options.resume => Keep::Resume,
        Form::Full => Keep::Pictures,
        Form::Quick => Keep::Nothing,
    };
    let console = Console::new(options.console.clone(), &options.out.join("scenes"), options.jobs, keep)?;
    if checks.iter().any(|check| check.mitsuba.is_some()) {
        // Before all that takes long: it may need a network.
        venv::for_validation().map_err(|error| format!("{error}\n--no-mitsuba does without it"))?;
    }
    let ways = signs::ways(&checks);
    let comparisons = comparisons(&checks);
    let form = options.form;
    // The program is built, and the other renderer installed.
    let start = Instant::now();
    println!("{} checks, {comparisons} comparisons, {} renders each", checks.len(), form.seeds());
    let mut renders = console.render(&checks, form)?;
    cross::render(&checks, &mut renders, &console, form)?;
    let has_peer = checks.iter().any(|check| check.mitsuba.is_some());
    let peer = has_peer.then(|| cross::version(&console.folder)).flatten();
    let threshold = threshold(comparisons);
    let count = checks.len();
    let pairs = checks.into_iter().zip(renders);
    let mut checked: Vec<Checked> =
        pairs.map(|(check, rendered)| judged(check, rendered, form, threshold)).collect();
    checked.extend(signs::check(&checked, &ways, form, threshold));
    let report = Report {
        checked,
        extent: left_out.words(count),
        command: format!("cargo xtask validate {}", typed(arguments)),
        date,
        machine: here::machine(),
        seconds: start.elapsed().as_secs_f64(),
        form,
        family: FAMILY,
        version: console.version(),
        peer,
    };
    report.write(&options.out)?;
    report.say();
    console.clear_all(report.checked.iter().map(|checked| &checked.check));
    match (report.failures().count(), report.broken().count()) {
        (0, 0) => Ok(()),
        (failed, broken) => Err(format!(
            "{failed} of {} comparisons failed, and {broken} checks were not rendered",
            report.verdicts().count()
        )),
    }
}

/// Arguments as they may be typed.
fn typed(arguments: &[String]) -> String {
    let quoted = |word: &String| if word.contains(' ') { format!("\"{word}\"") } else { word.clone() };
    arguments.iter().map(quoted).collect::<Vec<_>>().join(" ")
}

/// A line of a check: what is rendered of it, and with how many samples per pixel.
fn list(check: &Check, form: Form) {
    let samples = check.renderers.iter().map(|by| format!("{} {}", by.name(), check.samples(form, *by)));
    println!("{}: {}: {}", check.group, check.name, samples.collect::<Vec<_>>().join(", "));
}

fn judged(check: Check, rendered: Rendered, form: Form, threshold: f64) -> Checked {
    let demand = form.demand(&check);
    let (series, broken) = match rendered {
        Ok(series) => (series, None),
        Err(error) => (vec![], Some(error)),
    };
    let seconds = series.iter().map(|s| s.seconds).collect();
    let wrong_codes: Vec<usize> = series.iter().map(|s| s.wrong_codes).collect();
    let renders: Vec<_> = series.into_iter().map(|s| s.pictures).collect();
    let judge = Judge { check: &check, demand, renders: &renders, threshold };
    let mut verdicts = if broken.is_some() { vec![] } else { judge.verdicts() };
    if check.screen.is_some() && broken.is_none() {
        verdicts.extend(check.renderers.iter().zip(wrong_codes).map(|(who, wrong)| judge.codes(*who, wrong)));
    }
    Checked { check, demand, renders, seconds, verdicts, broken }
}

#[cfg(test)]
mod tests {
    use super::check::Renderer;
    use super::picture::Picture;
    use super::*;

    #[test]
    fn every_check_has_a_name_of_its_own_and_expects_something() {
        let all = all();
        let mut slugs: Vec<String> = all.iter().map(Check::slug).collect();
        slugs.sort();
        let shared: Vec<_> = slugs.windows(2).filter(|pair| pair[0] == pair[1]).collect();
        assert!(shared.is_empty(), "two checks share their files: {shared:?}");
        assert!(all.iter().all(|check| check.comparisons() > 0 && !check.renderers.is_empty()));
    }

    fn verdicts(check: &Check, renders: &[Vec<Picture>]) -> Vec<judge::Verdict> {
        Judge { check, demand: check.quick, renders, threshold: threshold(300) }.verdicts()
    }

    /// A picture of one value, noisy so that its mean is known to a hundredth of a percent.
    fn pictures(value: f64) -> Vec<Picture> {
        let noise = |seed: usize| 1.0 + 4e-4 * (f64::from(seed as u32 % 4) - 1.5);
        (0..16).map(|seed| Picture { size: [8, 8], pixels: vec![[value * noise(seed); 3]; 64] }).collect()
    }

    /// The threshold hangs on how many comparisons there will be.
    #[test]
    fn as_many_comparisons_are_made_as_were_counted() {
        // As large as any.
        let picture = Picture { size: [64; 2], pixels: vec![[1.0; 3]; 64 * 64] };
        for check in all() {
            let series =
                |_| console::Series { pictures: vec![picture.clone(); 2], wrong_codes: 0, seconds: 0.0 };
            let (counted, name) = (check.comparisons(), check.name.clone());
            let rendered = Ok(check.renderers.iter().map(series).collect());
            let checked = judged(check, rendered, Form::Quick, 1e-6);
            assert_eq!(checked.verdicts.len(), counted, "{name}");
        }
    }

    #[test]
    fn a_wrong_picture_fails_and_a_right_one_passes() {
        let scene = text::scene_file(&[text::settings(8, "")]);
        let check = Check::new("g", "n", "", scene).is(2.0, 0.0).by(check::TECHNIQUES);
        let fails = |first: f64, second: f64| {
            let verdicts = verdicts(&check, &[pictures(first), pictures(second)]);
            verdicts.iter().filter(|verdict| verdict.failure.is_some()).count()
        };
        assert_eq!(fails(2.0, 2.0), 0);
        assert_eq!(fails(2.01, 2.0), 2, "the value, and the pictures beside each other");
        assert_eq!(fails(2.0, f64::NAN), 3, "and the pixels");
    }

    #[test]
    fn what_is_left_out_is_counted_by_its_reason() {
        let words = |list: &[&str]| list.iter().map(|word| (*word).to_owned()).collect::<Vec<_>>();
        let options = Options::parse(&words(&["--no-mitsuba", "--only", "glass"])).expect("it is right");
        let all = all();
        let out = LeftOut::count(all.iter().filter_map(|check| options.leaves_out(check)));
        let kept = all.iter().filter(|check| options.leaves_out(check).is_none()).count();
        assert_eq!(out.checks() + kept, all.len());
        let text = out.words(kept);
        assert!(text.starts_with(&format!("{kept} of {} checks; left out: ", all.len())), "{text}");
        assert!(
            text.contains("--only") && text.contains("full form") && text.contains("--no-mitsuba"),
            "{text}"
        );
        assert_eq!(LeftOut::default().words(3), "all 3 checks");
    }

    /// A surface that lets nothing through makes pictures that agree, and agree with no light.
    #[test]
    fn black_pictures_fail_though_they_agree() {
        let scene = text::scene_file(&[text::settings(8, "")]);
        let check = Check::new("g", "n", "", scene).by(check::TECHNIQUES);
        let check = check.row("picture", check::Quantity::Y, None, check::Target::First(0.0));
        let failures = |value: f64| {
            let verdicts = verdicts(&check, &[pictures(value), pictures(value)]);
            verdicts.into_iter().filter_map(|verdict| verdict.failure).collect::<Vec<_>>()
        };
        assert_eq!(failures(0.0), [judge::Failure::NoLight]);
        assert!(failures(2.0).is_empty());
        let noise =
            |seed: usize| Picture { size: [1, 1], pixels: vec![[f64::from(seed as u32 % 2) - 0.4; 3]] };
        let noisy: Vec<_> = (0..16).map(noise).collect();
        assert!(verdicts(&check, &[noisy.clone(), noisy])[0].failure.is_some());
    }

    #[test]
    fn a_picture_that_must_be_even_fails_where_it_is_not() {
        let scene = text::scene_file(&[text::settings(8, "")]);
        let check = Check::new("g", "n", "", scene).is(2.0, 0.0).by(check::PATH).flat();
        let even = |picture: &mut Picture| {
            for pixel in &mut picture.pixels {
                (0..3).for_each(|c| pixel[c] *= oracles::EVEN_LIGHT[c]);
            }
        };
        let fails = |slope: f64| {
            let mut renders = pictures(2.0);
            for picture in &mut renders {
                even(picture);
                // The mean stays.
                (0..64).for_each(|i| picture.pixels[i][1] *= 1.0 + slope * ((i % 8) as f64 - 3.5));
            }
            verdicts(&check, &[renders]).iter().filter(|v| v.failure.is_some()).count()
        };
        assert_eq!([fails(0.0), fails(0.01)], [0, 1]);
    }

    #[test]
    fn a_pixel_that_is_no_number_fails_wherever_it_is() {
        let scene = text::scene_file(&[text::settings(8, "")]);
        let corner = Some([0, 4, 0, 4]);
        let check = Check::new("g", "n", "", scene).by(check::PATH);
        let check = check.row("corner", check::Quantity::Y, corner, check::Target::Value(2.0, 0.0));
        let mut renders = pictures(2.0);
        assert!(verdicts(&check, &[renders.clone()]).iter().all(|v| v.failure.is_none()));
        renders[3].pixels[63] = [1.0, f64::NAN, 1.0];
        let verdicts = verdicts(&check, &[renders]);
        assert_eq!(verdicts.iter().filter(|v| v.failure == Some(judge::Failure::NoNumber)).count(), 1);
    }

    #[test]
    fn noise_is_no_excuse() {
        let scene = text::scene_file(&[text::settings(8, "")]);
        let check = Check::new("g", "n", "", scene).is(2.0, 0.0).by(check::PATH);
        let noisy = (0..16).map(|s| Picture { size: [1, 1], pixels: vec![[f64::from(s % 5); 3]] }).collect();
        assert_eq!(verdicts(&check, &[noisy])[0].failure, Some(judge::Failure::Unresolved));
        assert_ne!(Renderer::Path.settings(), Renderer::Hybrid.settings());
    }
}
