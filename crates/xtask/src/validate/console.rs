//! Renders scenes with the release console, and reads the pictures.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};

use exr::prelude::{FlatSamples, read_first_flat_layer_from_file};

use super::check::{Area, Check, Form, Quantity, Renderer};
use super::codes;
use crate::{here, process};

/// The settings that `text::settings` writes, in whose place a renderer's own stand.
pub const TECHNIQUE: &str = "<metropolis>false</metropolis><bidirectional>false</bidirectional>";
/// Rows of Rec. 709 (D65) to XYZ, as IEC 61966-2-1 derives them, to seven digits.
pub const RGB_TO_XYZ: [[f64; 3]; 3] = [
    [0.412_390_8, 0.357_584_3, 0.180_480_8],
    [0.212_639_0, 0.715_168_7, 0.072_192_3],
    [0.019_330_8, 0.119_194_8, 0.950_532_2],
];

/// How long a render may take: the longest of the full form are minutes.
const LIMIT: Duration = Duration::from_hours(1);

/// A picture in X, Y, Z, cd/m².
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// Columns and rows.
    pub size: [usize; 2],
    /// Rows from the top.
    pub pixels: Vec<[f64; 3]>,
}

impl Picture {
    /// Reads an EXR file of linear Rec. 709.
    pub fn read(path: &Path) -> Result<Self, String> {
        let (size, rgb) = read_rgb(path)?;
        let to_xyz = |rgb: [f64; 3]| RGB_TO_XYZ.map(|row| (0..3).map(|c| row[c] * rgb[c]).sum());
        Ok(Self { size, pixels: rgb.into_iter().map(to_xyz).collect() })
    }

    /// The same, if it has the size that a scene asks for: areas are of that.
    fn of_size(self, scene: &str) -> Result<Self, String> {
        let asked = ["width", "height"].map(|name| number_in(scene, name));
        if asked == self.size.map(Some) {
            return Ok(self);
        }
        Err(format!("a picture of {:?} pixels, of which the scene wants {asked:?}", self.size))
    }

    /// Mean X, Y, Z of an area, or of all.
    pub fn mean(&self, area: Option<Area>) -> [f64; 3] {
        let [x0, x1, y0, y1] = area.unwrap_or([0, self.size[0], 0, self.size[1]]);
        let mut sum = [0.0; 3];
        for y in y0..y1 {
            for pixel in &self.pixels[y * self.size[0] + x0..y * self.size[0] + x1] {
                (0..3).for_each(|c| sum[c] += pixel[c]);
            }
        }
        sum.map(|s| s / ((x1 - x0) * (y1 - y0)) as f64)
    }

    /// A number of an area.
    pub fn value(&self, quantity: Quantity, area: Option<Area>, unit: f64) -> f64 {
        let [x, y, z] = self.mean(area);
        match quantity {
            Quantity::Y => y / unit,
            Quantity::XOverY => x / y,
            Quantity::ZOverY => z / y,
        }
    }
}

/// Columns and rows, and the pixels, rows from the top, of an EXR file of linear Rec. 709.
pub fn read_rgb(path: &Path) -> Result<([usize; 2], Vec<[f64; 3]>), String> {
    let fault = |why: &dyn std::fmt::Display| format!("{}: {why}", path.display());
    let image = read_first_flat_layer_from_file(path).map_err(|error| fault(&error))?;
    let layer = image.layer_data;
    let channel = |name: &str| {
        let found = layer.channel_data.list.iter().find(|channel| channel.name.to_string() == name);
        match found.map(|channel| &channel.sample_data) {
            Some(FlatSamples::F32(values)) => Ok(values),
            _ => Err(fault(&format!("no channel {name} of 32-bit numbers"))),
        }
    };
    let (r, g, b) = (channel("R")?, channel("G")?, channel("B")?);
    let rgb = r.iter().zip(g).zip(b).map(|((r, g), b)| [*r, *g, *b].map(f64::from));
    Ok(([layer.size.x(), layer.size.y()], rgb.collect()))
}

/// The console, and where it may write.
pub struct Console {
    /// The program.
    pub program: PathBuf,
    /// A folder of this run's own.
    pub folder: PathBuf,
    /// How many run at once, each on one thread.
    pub jobs: usize,
    /// Whether it was built here, so that the commit is known.
    is_built_here: bool,
}

/// Writes a scene to be rendered by one of Indigo's ways, and its files, into a folder; gives its path.
pub fn write_scene(
    folder: &Path,
    scene: &str,
    files: &[(String, Vec<u8>)],
    renderer: Renderer,
) -> Result<PathBuf, String> {
    let write = |path: &Path, bytes: &[u8]| {
        std::fs::write(path, bytes).map_err(|error| format!("{}: {error}", path.display()))
    };
    if scene.matches(TECHNIQUE).count() != 1 {
        return Err("the scene's settings are not as they are written here".into());
    }
    std::fs::create_dir_all(folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    for (name, bytes) in files {
        write(&folder.join(name), bytes)?;
    }
    let saved = "<save_untonemapped_exr>true</save_untonemapped_exr><logging>false</logging>";
    let path = scene_path(folder, renderer);
    let settings = format!("{}{saved}", renderer.settings());
    write(&path, scene.replace(TECHNIQUE, &settings).as_bytes())?;
    Ok(path)
}

fn scene_path(folder: &Path, renderer: Renderer) -> PathBuf {
    folder.join(format!("{renderer:?}.igs").to_lowercase())
}

/// Of a render: neither two ways nor two checks share random numbers, so that no two verdicts hang together.
pub fn seed(check: &Check, renderer: Renderer, render: usize) -> u64 {
    // FNV-1a, of 32 bits: names that meet would do no harm.
    let name = check
        .slug()
        .bytes()
        .fold(0x811c_9dc5_u32, |hash, byte| (hash ^ u32::from(byte)).wrapping_mul(0x0100_0193));
    u64::from(name) * 10_000 + 1000 * renderer as u64 + render as u64
}

/// What came of a check: for each renderer its pictures by seed, or why there are none.
pub type Rendered = Result<Vec<Series>, String>;

/// Pictures of one renderer.
#[derive(Clone, Debug, Default)]
pub struct Series {
    /// By seed.
    pub pictures: Vec<Picture>,
    /// Codes of their PNGs that are not those of their luminances, if they are judged.
    pub wrong_codes: usize,
    /// How long their renders took, added up; those that run at once hold one another up.
    pub seconds: f64,
}

/// One picture.
struct Render {
    picture: Picture,
    wrong_codes: usize,
    seconds: f64,
}

/// One call of the console.
struct Job<'a> {
    check: &'a Check,
    renderer: Renderer,
    seed: usize,
    samples: u32,
}

impl Console {
    /// Builds the release console, if it must be, or takes another program.
    pub fn new(program: Option<PathBuf>, folder: &Path, jobs: usize) -> Result<Self, String> {
        let is_built_here = program.is_none();
        let program = match program {
            Some(program) => program,
            None => {
                let build = ["build", "--release", "--workspace", "--bin", "indigo_console"];
                process::run(&mut process::cargo(&build))?;
                process::target_dir()
                    .join("release")
                    .join(format!("indigo_console{}", std::env::consts::EXE_SUFFIX))
            }
        };
        std::fs::create_dir_all(folder).map_err(|error| format!("{}: {error}", folder.display()))?;
        let program = std::fs::canonicalize(&program).map_err(|e| format!("{}: {e}", program.display()))?;
        let folder = std::fs::canonicalize(folder).map_err(|e| format!("{}: {e}", folder.display()))?;
        Ok(Self { program, folder, jobs, is_built_here })
    }

    /// The console's own words, and the commit if it was built here from one.
    pub fn version(&self) -> String {
        let said = process::capture(Command::new(&self.program).arg("-version"));
        let said = said.map(|bytes| String::from_utf8_lossy(&bytes).into_owned()).unwrap_or_default();
        let said = said.lines().next().unwrap_or("unknown version").trim();
        if self.is_built_here {
            return format!("{said}, commit {}", here::commit());
        }
        format!("{said}, a console that was given: {}, commit unknown", self.program.display())
    }

    /// Renders checks by all of Indigo's ways that they name; without pictures for other renderers. A check of which one render
    /// fails has that failure in its place.
    ///
    /// # Errors
    /// Scenes that cannot be written.
    pub fn render(&self, checks: &[Check], form: Form) -> Result<Vec<Rendered>, String> {
        let mut jobs = vec![];
        for check in checks {
            for &renderer in check.renderers.iter().filter(|r| **r != Renderer::Mitsuba) {
                self.write_scene(check, renderer)?;
                let samples = check.samples(form, renderer);
                jobs.extend((0..form.seeds()).map(|seed| Job { check, renderer, seed, samples }));
            }
        }
        let next = AtomicUsize::new(0);
        let done: Mutex<Vec<Option<Result<Render, String>>>> =
            Mutex::new((0..jobs.len()).map(|_| None).collect());
        std::thread::scope(|scope| {
            for _ in 0..self.jobs {
                scope.spawn(|| {
                    while let Some((i, job)) =
                        Some(next.fetch_add(1, Ordering::Relaxed)).and_then(|i| Some((i, jobs.get(i)?)))
                    {
                        if job.seed == 0 {
                            println!("  {}, {}", job.check.name, job.renderer.name());
                        }
                        let start = Instant::now();
                        let result = self
                            .run(job)
                            .map(|render| Render { seconds: start.elapsed().as_secs_f64(), ..render });
                        done.lock().expect("no thread panics")[i] = Some(result);
                    }
                });
            }
        });
        let mut done = done.into_inner().expect("no thread panics").into_iter().flatten();
        let mut series = |renderer: &Renderer| {
            let count = if *renderer == Renderer::Mitsuba { 0 } else { form.seeds() };
            let of_renderer: Vec<_> = done.by_ref().take(count).collect();
            let renders: Vec<Render> = of_renderer.into_iter().collect::<Result<_, String>>()?;
            let seconds = renders.iter().map(|render| render.seconds).sum();
            let wrong_codes = renders.iter().map(|render| render.wrong_codes).sum();
            let pictures = renders.into_iter().map(|render| render.picture).collect();
            Ok(Series { pictures, wrong_codes, seconds })
        };
        let of_check = |check: &Check| {
            // All are taken, even after one that failed.
            let all: Vec<Result<Series, String>> = check.renderers.iter().map(&mut series).collect();
            all.into_iter().collect()
        };
        Ok(checks.iter().map(of_check).collect())
    }

    fn folder_of(&self, check: &Check) -> PathBuf {
        self.folder.join(check.slug())
    }

    fn write_scene(&self, check: &Check, renderer: Renderer) -> Result<PathBuf, String> {
        write_scene(&self.folder_of(check), &check.scene, &check.files, renderer)
            .map_err(|error| format!("{}: {error}", check.name))
    }

    fn run(&self, job: &Job) -> Result<Render, String> {
        let stem = format!("{:?}_{}", job.renderer, job.seed).to_lowercase();
        let folder = self.folder_of(job.check);
        let picture = folder.join(format!("{stem}.png"));
        let linear = folder.join(format!("{stem}_untonemapped.exr"));
        // What a run that was killed has left would be taken for this one's.
        drop((std::fs::remove_file(&linear), std::fs::remove_file(&picture)));
        let seed = seed(job.check, job.renderer, job.seed);
        let mut command = Command::new(&self.program);
        command
            .arg(scene_path(&folder, job.renderer))
            .args([
                "-quiet",
                "-t",
                &job.renderer.threads().to_string(),
                "-seed",
                &seed.to_string(),
                "-haltspp",
                &job.samples.to_string(),
                "-o",
            ])
            .arg(&picture)
            .current_dir(&folder);
        let log = folder.join(format!("{stem}.log"));
        let fault = |why: String| format!("{}, {}: {why}", job.check.name, job.renderer.name());
        ended(&mut command, &log, LIMIT).map_err(fault)?;
        let read = Picture::read(&linear).and_then(|picture| picture.of_size(&job.check.scene));
        let wrong_codes = match job.check.screen {
            Some(scale) => codes::wrong(&linear, &picture, scale),
            None => Ok(0),
        };
        let render = read.and_then(|picture| Ok(Render { picture, wrong_codes: wrong_codes?, seconds: 0.0 }));
        // Thousands of them would fill folders that nobody looks at: the scenes stay.
        drop((std::fs::remove_file(&linear), std::fs::remove_file(&picture), std::fs::remove_file(&log)));
        render.map_err(fault)
    }
}

/// Runs a program to its end, or ends it when a time is over. What it says goes to a file, which no pipe can stop.
fn ended(command: &mut Command, log: &Path, limit: Duration) -> Result<(), String> {
    let program = command.get_program().to_string_lossy().into_owned();
    let fault = |why: &dyn std::fmt::Display| format!("{program}: {why}");
    let file = std::fs::File::create(log).map_err(|error| format!("{}: {error}", log.display()))?;
    let start = Instant::now();
    let started = command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(file).spawn();
    let mut child = started.map_err(|error| fault(&error))?;
    let status = loop {
        if let Some(status) = child.try_wait().map_err(|error| fault(&error))? {
            break status;
        }
        if start.elapsed() > limit {
            drop((child.kill(), child.wait()));
            return Err(fault(&format!("not done after {} s", limit.as_secs())));
        }
        // Short beside the shortest render, some tens of milliseconds.
        std::thread::sleep(Duration::from_millis(2));
    };
    if status.success() {
        return Ok(());
    }
    Err(format!("{status}\n{}", std::fs::read_to_string(log).unwrap_or_default()))
}

/// The number that the one element of a name holds.
fn number_in(scene: &str, name: &str) -> Option<usize> {
    let (_, after) = scene.split_once(&format!("<{name}>"))?;
    after.split_once('<')?.0.trim().parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[cfg(unix)]
    #[test]
    fn a_program_that_does_not_end_is_ended() {
        let log = std::env::temp_dir().join(format!("indigo-ended-{}", std::process::id()));
        let run = |words: &str, limit: u64| {
            ended(Command::new("sh").args(["-c", words]), &log, Duration::from_millis(limit))
        };
        assert_eq!(run("exit 0", 60_000), Ok(()));
        assert!(run("echo why >&2; exit 3", 60_000).is_err_and(|said| said.contains("why")));
        assert!(run("exec sleep 60", 50).is_err_and(|said| said.contains("not done")));
        std::fs::remove_file(&log).expect("it was written");
    }

    #[test]
    fn a_picture_of_another_size_than_the_scene_s_is_refused() {
        let picture = Picture { size: [8, 4], pixels: vec![[0.0; 3]; 32] };
        let scene = |width: u32| format!("<width>{width}</width><height>4</height>");
        assert_eq!(picture.clone().of_size(&scene(8)), Ok(picture.clone()));
        assert!(picture.clone().of_size(&scene(16)).is_err());
        assert!(picture.of_size("").is_err());
    }
}
