//! Renders scenes with the release console.

use std::fs::{File, TryLockError};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};

use super::check::{Check, Form, Renderer};
use super::codes;
use super::kept::{Keep, Stamp};
use super::picture::Picture;
use crate::{Outcome, here, process};

/// The settings that `text::settings` writes, in whose place a renderer's own stand.
pub const TECHNIQUE: &str = "<metropolis>false</metropolis><bidirectional>false</bidirectional>";
/// How long a render may take: the longest of the full form are minutes.
const LIMIT: Duration = Duration::from_mins(10);

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
    /// What becomes of pictures.
    pub keep: Keep,
    /// Of the program.
    stamp: Stamp,
    _lock: File,
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

/// A file that stays locked while a run uses its folder: two runs would take each other's pictures.
fn lock(folder: &Path) -> Result<File, String> {
    let path = folder.join("lock");
    let fault = |why: &dyn std::fmt::Display| format!("{}: {why}", path.display());
    let file = File::create(&path).map_err(|error| fault(&error))?;
    match file.try_lock() {
        Err(TryLockError::WouldBlock) => Err(format!("another run uses {}", folder.display())),
        // Where there are no locks, none is missed.
        _ => Ok(file),
    }
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
    pub fn new(program: Option<PathBuf>, folder: &Path, jobs: usize, keep: Keep) -> Result<Self, String> {
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
        let bytes = std::fs::read(&program).map_err(|e| format!("{}: {e}", program.display()))?;
        let stamp = Stamp::of([&bytes[..]]);
        let lock = lock(&folder)?;
        Ok(Self { program, folder, jobs, is_built_here, keep, stamp, _lock: lock })
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
                let samples = check.samples(form, renderer);
                self.write_scene(check, renderer, samples)?;
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

    /// Writes what a renderer needs, and takes away pictures that are not this run's.
    fn write_scene(&self, check: &Check, renderer: Renderer, samples: u32) -> Outcome {
        let folder = self.folder_of(check);
        let scene = write_scene(&folder, &check.scene, &check.files, renderer)
            .map_err(|error| format!("{}: {error}", check.name))?;
        let text = std::fs::read(&scene).map_err(|error| format!("{}: {error}", scene.display()))?;
        let head = [self.stamp.bytes().to_vec(), samples.to_le_bytes().to_vec(), text];
        let files = check.files.iter().flat_map(|(name, bytes)| [name.as_bytes(), &bytes[..]]);
        let stamp = Stamp::of(head.iter().map(Vec::as_slice).chain(files));
        let mark = scene.with_extension("stamp");
        if self.keep == Keep::Resume && stamp.is_in(&mark) {
            return Ok(());
        }
        // In this order: were it ended in between, pictures of another program would pass for this one's.
        self.clear(check, renderer)?;
        stamp.write(&mark)
    }

    /// Takes a renderer's pictures away: thousands of them would fill folders that nobody looks at. The scenes stay.
    fn clear(&self, check: &Check, renderer: Renderer) -> Outcome {
        for path in (0..Form::Full.seeds()).flat_map(|seed| self.pictures(check, renderer, seed)) {
            match std::fs::remove_file(&path) {
                Err(error) if error.kind() != std::io::ErrorKind::NotFound => {
                    return Err(format!("{}: cannot be removed: {error}", path.display()));
                }
                _ => {}
            }
        }
        Ok(())
    }

    /// Takes all pictures away that were kept, once the report is written.
    pub fn clear_all<'a>(&self, checks: impl IntoIterator<Item = &'a Check>) {
        let checks = checks.into_iter().filter(|_| self.keep != Keep::Nothing);
        for check in checks {
            // A picture that stays does no harm: a later run takes it away, or says that it cannot.
            check.renderers.iter().for_each(|renderer| drop(self.clear(check, *renderer)));
        }
    }

    /// Where a render's PNG and its untonemapped EXR lie.
    fn pictures(&self, check: &Check, renderer: Renderer, seed: usize) -> [PathBuf; 2] {
        let stem = format!("{renderer:?}_{seed}").to_lowercase();
        let folder = self.folder_of(check);
        [folder.join(format!("{stem}.png")), folder.join(format!("{stem}_untonemapped.exr"))]
    }

    fn run(&self, job: &Job) -> Result<Render, String> {
        let [picture, linear] = self.pictures(job.check, job.renderer, job.seed);
        let fault = |why: String| format!("{}, {}: {why}", job.check.name, job.renderer.name());
        // Each is written whole or not at all.
        if !picture.exists() || !linear.exists() {
            self.call(job, &picture).map_err(fault)?;
        }
        let read = Picture::read(&linear).and_then(|picture| picture.of_size(&job.check.scene));
        let wrong_codes = match job.check.screen {
            Some(scale) => codes::wrong(&linear, &picture, scale),
            None => Ok(0),
        };
        let render = read.and_then(|picture| Ok(Render { picture, wrong_codes: wrong_codes?, seconds: 0.0 }));
        if self.keep == Keep::Nothing {
            drop((std::fs::remove_file(&linear), std::fs::remove_file(&picture)));
        }
        render.map_err(fault)
    }

    fn call(&self, job: &Job, picture: &Path) -> Outcome {
        let folder = self.folder_of(job.check);
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
            .arg(picture)
            .current_dir(&folder);
        let log = picture.with_extension("log");
        ended(&mut command, &log, LIMIT)?;
        drop(std::fs::remove_file(&log));
        Ok(())
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
    let said = std::fs::read(log).unwrap_or_default();
    Err(format!("{status}\n{}", end_of(&String::from_utf8_lossy(&said))))
}

/// The last lines of what a program said: why it ended, and not all before.
fn end_of(text: &str) -> String {
    const LINES: usize = 20;
    const LONGEST: usize = 400;
    let count = text.lines().count();
    let left_out = count.saturating_sub(LINES);
    let note = (left_out > 0).then(|| format!("({left_out} lines before these)"));
    let lines = text.lines().skip(left_out).map(|line| line.chars().take(LONGEST).collect());
    note.into_iter().chain(lines).collect::<Vec<String>>().join("\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_lines_are_told() {
        assert_eq!(end_of("a\nb\n"), "a\nb");
        let many = (0..50).map(|i| i.to_string()).collect::<Vec<_>>().join("\n");
        let end = end_of(&many);
        assert!(end.starts_with("(30 lines before these)\n30\n") && end.ends_with("\n49"), "{end}");
    }

    #[test]
    fn one_run_uses_a_folder() {
        let folder = std::env::temp_dir().join(format!("indigo-locked-{}", std::process::id()));
        std::fs::create_dir_all(&folder).expect("a folder");
        let first = lock(&folder);
        assert!(first.is_ok() && lock(&folder).is_err_and(|why| why.contains("another run")));
        drop(first);
        assert!(lock(&folder).is_ok());
        std::fs::remove_dir_all(folder).expect("it was made");
    }

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
}
