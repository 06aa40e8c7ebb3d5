//! `cargo xtask bench machine`: how the release console scales on this machine, with threads, triangles, lamps, texels and
//! pixels: samples and rays a second, seconds to read, build, start and develop, and memory.
//!
//! Seconds belong to a machine and to what else it does, so that they gate nothing: a run is compared with a named earlier
//! one, ratios first. All figures are the console's own (`-ptest`), the median of a few runs.

mod others;
mod page;
mod series;

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::Duration;

use serde_json::{Value, json};

use crate::validate::check::Renderer;
use crate::validate::console::{Console, write_scene};
use crate::validate::kept::Keep;
use crate::{Outcome, here, process};
use others::OTHERS;
use series::{Point, SERIES, Series};

const USAGE: &str = "usage: cargo xtask bench machine [--name NAME] [--against RUN.json] [--full | --only SERIES] [--repeat N] [--console PROGRAM]";
/// Runs of each point, of which the median counts.
const REPEAT: usize = 3;

/// One figure of one point.
#[derive(Clone, Debug, PartialEq)]
pub struct Figure {
    /// The name of the series.
    pub series: String,
    /// Where in the series.
    pub x: f64,
    /// What was measured.
    pub name: String,
    /// How much it is: the median of the runs.
    pub value: f64,
    /// The least and the most of the runs, where there were several.
    pub spread: Option<[f64; 2]>,
}

impl Figure {
    /// How many times better it is than what was: above 1 is better, be it more of a speed or less of seconds, memory and errors.
    pub fn gain(&self, then: f64) -> f64 {
        if self.more_is_better() { self.value / then } else { then / self.value }
    }

    /// Whether it is a speed.
    pub fn more_is_better(&self) -> bool {
        ["per_second", "per second", "as fast"].iter().any(|speed| self.name.ends_with(speed))
    }
}

struct Options {
    name: String,
    against: Option<PathBuf>,
    only: Option<String>,
    full: bool,
    repeat: usize,
    console: Option<PathBuf>,
}

impl Options {
    fn parse(arguments: &[String]) -> Result<Self, String> {
        let mut options = Self {
            name: "machine".into(),
            against: None,
            only: None,
            full: false,
            repeat: REPEAT,
            console: None,
        };
        let mut words = arguments.iter();
        while let Some(word) = words.next() {
            if word == "--full" {
                options.full = true;
                continue;
            }
            let value = words.next().ok_or(USAGE)?.clone();
            match word.as_str() {
                "--name" if Path::new(&value).file_name() == Some(value.as_ref()) => options.name = value,
                "--against" => options.against = Some(value.into()),
                "--only" => options.only = Some(value),
                "--repeat" => options.repeat = value.parse().ok().filter(|n| *n > 0).ok_or(USAGE)?,
                "--console" => options.console = Some(value.into()),
                _ => return Err(USAGE.into()),
            }
        }
        Ok(options)
    }
}

/// Runs it.
///
/// # Errors
/// What could not be run, read or written.
pub fn run(arguments: &[String]) -> Outcome {
    let options = Options::parse(arguments)?;
    let folder = process::target_dir().join("bench");
    let console = Console::new(options.console.clone(), &folder, 1, Keep::Nothing)?;
    let path = |ending: &str| folder.join(format!("{}.{ending}", options.name));
    let earlier = options.against.as_deref().map(|against| earlier(against, &path("json"))).transpose()?;
    let wanted = |series: &&Series| options.only.as_ref().is_none_or(|only| series.name == only);
    let mut figures = vec![];
    for series in SERIES.iter().filter(wanted) {
        for point in (series.points)() {
            println!("  {}, {}", series.name, point.x);
            figures.extend(measure(&console, series, &point, options.repeat)?);
        }
    }
    // What cannot be run, for want of a network say, loses nothing of what was measured.
    let mut missing = vec![];
    for other in OTHERS {
        if options.only.as_ref().map_or(options.full, |only| other.name == only) {
            other.measure().map_or_else(|why| missing.push(why), |more| figures.extend(more));
        }
    }
    if figures.is_empty() && missing.is_empty() {
        return Err(format!("no series of that name; there are {}", names().join(", ")));
    }
    let write = |ending: &str, text: String| {
        let path = path(ending);
        std::fs::write(&path, text).map_err(|error| format!("{}: {error}", path.display()))?;
        println!("{}", path.display());
        Ok::<(), String>(())
    };
    let run = json!({
        "name": options.name,
        "date": here::date(),
        "version": console.version(),
        "machine": here::machine(),
        "figures": figures.iter().map(to_json).collect::<Vec<_>>(),
    });
    write("json", format!("{run:#}\n"))?;
    write("html", page::page(&run, &figures, earlier.as_ref()))?;
    say(&figures, earlier.as_ref());
    if missing.is_empty() { Ok(()) } else { Err(missing.join("\n")) }
}

fn names() -> Vec<&'static str> {
    SERIES.iter().map(|series| series.name).chain(OTHERS.iter().map(|other| other.name)).collect()
}

fn to_json(figure: &Figure) -> Value {
    let [least, most] = figure.spread.unwrap_or([figure.value; 2]);
    json!({"series": figure.series, "x": figure.x, "figure": figure.name, "value": figure.value,
           "least": least, "most": most, "more_is_better": figure.more_is_better()})
}

/// An earlier run: its name and figures.
pub struct Earlier {
    /// As it was called.
    pub name: String,
    /// What was measured, when and on which machine, in words.
    pub about: String,
    figures: Vec<Figure>,
}

impl Earlier {
    /// What a figure was then.
    pub fn value(&self, figure: &Figure) -> Option<f64> {
        let is_same = |f: &&Figure| f.series == figure.series && f.x == figure.x && f.name == figure.name;
        self.figures.iter().find(is_same).map(|f| f.value)
    }
}

/// A run to compare with, which the one that writes to a path would not destroy.
fn earlier(against: &Path, own: &Path) -> Result<Earlier, String> {
    let earlier = read(against)?;
    let is_own = std::fs::canonicalize(against).ok() == std::fs::canonicalize(own).ok();
    if is_own {
        return Err(format!("{} would be written over: give this run another --name", against.display()));
    }
    Ok(earlier)
}

fn read(path: &Path) -> Result<Earlier, String> {
    let fault = |why: &dyn std::fmt::Display| format!("{}: {why}", path.display());
    let text = std::fs::read_to_string(path).map_err(|error| fault(&error))?;
    let run: Value = serde_json::from_str(&text).map_err(|error| fault(&error))?;
    let list = run["figures"].as_array().ok_or_else(|| fault(&"holds no figures"))?;
    let text = |value: &Value| value.as_str().unwrap_or_default().to_owned();
    let figure = |value: &Value| {
        Some(Figure {
            series: text(&value["series"]),
            x: value["x"].as_f64()?,
            name: text(&value["figure"]),
            value: value["value"].as_f64()?,
            spread: None,
        })
    };
    let figures = list.iter().filter_map(figure).collect();
    Ok(Earlier { name: text(&run["name"]), about: about(&run), figures })
}

/// What a run measured, when and on which machine, in words.
fn about(run: &Value) -> String {
    let text = |key: &str| run[key].as_str().unwrap_or("unknown").to_owned();
    format!("{}; {}; {}", text("version"), text("date"), here::in_words(&run["machine"]))
}

/// Figures of a point: the median of each.
fn measure(console: &Console, series: &Series, point: &Point, repeat: usize) -> Result<Vec<Figure>, String> {
    let folder = console.folder.join(format!("{}-{}", series.name, point.x));
    let scene = write_scene(&folder, &point.scene, &point.files, Renderer::Path)?;
    let saves = series.figures.contains(&SAVE);
    let run = |_| {
        let mut values = once(console, &scene, point)?;
        // A run of its own, which costs time: only where it is asked for.
        values.push(if saves { save_seconds(console, &scene, point)? } else { 0.0 });
        Ok(values)
    };
    let runs = (0..repeat).map(run).collect::<Result<Vec<_>, String>>()?;
    let figure = |(i, name): (usize, &&str)| {
        let mut values: Vec<f64> = runs.iter().map(|run| run[i]).collect();
        values.sort_by(f64::total_cmp);
        Figure {
            series: series.name.to_owned(),
            x: point.x,
            name: (*name).to_owned(),
            value: 0.5 * (values[values.len() / 2] + values[(values.len() - 1) / 2]),
            spread: Some([values[0], values[values.len() - 1]]),
        }
    };
    let figures = FIGURES.iter().enumerate().map(figure);
    // The system may not tell of memory.
    let is_known = |figure: &Figure| figure.name != MEMORY || figure.value > 0.0;
    Ok(figures.filter(|figure| series.figures.contains(&figure.name.as_str()) && is_known(figure)).collect())
}

/// What is measured of each run, in this order.
const FIGURES: &[&str] = &[
    "samples_per_second",
    "rays_per_second",
    "read_s",
    "build_s",
    "start_s",
    "first_pixel_s",
    "develop_s",
    MEMORY,
    SAVE,
];
const MEMORY: &str = "peak_memory_mb";
const SAVE: &str = "develop_and_save_s";

/// Seconds to develop the film and to save the picture, the untonemapped one and the film.
fn save_seconds(console: &Console, scene: &Path, point: &Point) -> Result<f64, String> {
    let mut command = Command::new(&console.program);
    command.arg(scene).args(["-verbose", "-haltspp", "1", "-t", &point.threads.to_string()]);
    command.arg("-o").arg(scene.with_extension("png"));
    let output = command.output().map_err(|error| format!("{}: {error}", scene.display()))?;
    let said = [output.stdout, output.stderr].concat();
    seconds_told(&String::from_utf8_lossy(&said))
        .filter(|_| output.status.success())
        .ok_or_else(|| format!("{}: the console does not tell how long saving took", scene.display()))
}

/// The console's "Developed and saved in 1.23 s".
fn seconds_told(text: &str) -> Option<f64> {
    let (_, after) = text.split_once("Developed and saved in ")?;
    after.split_ascii_whitespace().next()?.parse().ok()
}

fn once(console: &Console, scene: &Path, point: &Point) -> Result<Vec<f64>, String> {
    let fault = |why: &dyn std::fmt::Display| format!("{}: {why}", scene.display());
    let mut child = Command::new(&console.program)
        .arg(scene)
        .args([
            "-ptest",
            "-json",
            "-quiet",
            "-t",
            &point.threads.to_string(),
            "-haltspp",
            &point.samples.to_string(),
        ])
        .stdout(Stdio::piped())
        .spawn()
        .map_err(|error| fault(&error))?;
    let mut peak = 0.0f64;
    // Linux keeps the peak itself; it is read until the process has gone.
    while child.try_wait().map_err(|error| fault(&error))?.is_none() {
        peak = peak.max(peak_memory_mb(child.id()).unwrap_or(0.0));
        std::thread::sleep(Duration::from_millis(5));
    }
    let output = child.wait_with_output().map_err(|error| fault(&error))?;
    if !output.status.success() {
        return Err(fault(&output.status));
    }
    let said: Value = serde_json::from_slice(&output.stdout).map_err(|error| fault(&error))?;
    let of = |key: &str| said[key].as_f64().ok_or_else(|| fault(&format!("-ptest does not tell {key}")));
    let [read, build, start, pass, develop] = ["read", "build", "start", "first_pass", "develop"].map(of);
    let (read, build, develop) = (read?, build?, develop?);
    let speeds = [of("samples_per_second")?, of("rays_per_second")?];
    // The first picture that somebody sees has a sample in each pixel.
    let first = read + build + pass? + develop;
    Ok([&speeds[..], &[read, build, start?, first, develop, peak]].concat())
}

fn peak_memory_mb(process: u32) -> Option<f64> {
    let status = std::fs::read_to_string(format!("/proc/{process}/status")).ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    let kilobytes: f64 = line.trim().trim_end_matches("kB").trim().parse().ok()?;
    Some(kilobytes / 1024.0)
}

fn say(figures: &[Figure], earlier: Option<&Earlier>) {
    for figure in figures {
        let gain = earlier.and_then(|earlier| earlier.value(figure)).map(|then| figure.gain(then));
        let ratio = gain.map_or_else(String::new, |gain| format!("{gain:>8.3} ×"));
        println!(
            "{ratio:>10} {:<12} {:>10} {:<20} {:>14.4}",
            figure.series, figure.x, figure.name, figure.value
        );
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn series_ask_for_figures_that_are_measured() {
        for series in SERIES {
            assert!(series.figures.iter().all(|name| FIGURES.contains(name)), "{}", series.name);
        }
    }

    fn of(name: &str, x: f64, value: f64) -> Figure {
        Figure { series: "s".into(), x, name: name.into(), value, spread: None }
    }

    #[test]
    fn a_gain_is_above_one_where_it_is_better() {
        let gains = [
            "rays_per_second",
            "path: rays per second",
            "read_s",
            "peak_memory_mb",
            "path: relMSE after 5 s",
        ]
        .map(|name| of(name, 0.0, 2.0).gain(1.0));
        assert_eq!(gains, [2.0, 2.0, 0.5, 0.5, 0.5]);
    }

    #[test]
    fn a_run_does_not_write_over_what_it_is_compared_with() {
        let file = std::env::temp_dir().join(format!("indigo-bench-{}.json", std::process::id()));
        std::fs::write(&file, r#"{"name": "a", "figures": []}"#).expect("it can be written");
        assert!(earlier(&file, &file).is_err());
        assert!(earlier(&file, &file.with_extension("other")).is_ok());
        std::fs::remove_file(&file).expect("it is there");
    }

    #[test]
    fn the_time_of_saving_is_read() {
        assert_eq!(seconds_told("x\nDeveloped and saved in 0.42 s\n"), Some(0.42));
        assert_eq!(seconds_told("saved"), None);
    }

    #[test]
    fn an_earlier_run_is_found_by_series_place_and_figure() {
        let figure = |x: f64, value: f64| of("f", x, value);
        let earlier = Earlier {
            name: String::new(),
            about: String::new(),
            figures: vec![figure(1.0, 2.0), figure(2.0, 8.0)],
        };
        assert_eq!(earlier.value(&figure(2.0, 4.0)), Some(8.0));
        assert_eq!(earlier.value(&figure(3.0, 4.0)), None);
    }
}
