//! Loading scenes, each on a thread of its own, which nobody need wait for.

use super::{Command, Request, message_of};
use crate::log::{Finding, Line, Weight, findings};
use crate::words;
use indigo_diag::SourceMap;
use indigo_film::{FilmSize, SavedFilm};
use indigo_front::load::load_scene;
use indigo_imaging::PictureSettings;
use indigo_render::saved::read_film;
use indigo_scene::{OutputSettings, Scene, SceneStats, Stop, TransportSettings};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::mpsc::Sender;
use std::time::Instant;

/// What became of a scene.
pub struct Outcome {
    /// What was asked for.
    pub request: Request,
    /// The scene, if it can be rendered.
    pub scene: Option<Arc<Scene>>,
    /// The files that it was read from.
    pub read: Vec<PathBuf>,
    /// The film to go on with.
    pub film: Option<SavedFilm>,
    /// What was found.
    pub findings: Vec<Finding>,
    /// All files.
    pub sources: Arc<SourceMap>,
    /// What else to tell.
    pub lines: Vec<Line>,
}

/// What the window shows of a scene.
#[derive(Clone, Debug)]
pub struct LoadedFacts {
    /// Its path.
    pub path: String,
    /// Resolution.
    pub size: FilmSize,
    /// How much it holds.
    pub stats: SceneStats,
    /// Number of media.
    pub media: usize,
    /// How the picture is made.
    pub picture: PictureSettings,
    /// What is written, and when.
    pub output: OutputSettings,
    /// How light is transported.
    pub transport: TransportSettings,
    /// The part that is rendered: first column and row, and those after the last.
    pub region: Option<[[u32; 2]; 2]>,
}

impl LoadedFacts {
    /// Of a scene.
    pub fn of(scene: &Scene) -> Self {
        Self {
            path: scene.output.scene_path.clone(),
            size: scene.film.size,
            stats: scene.stats(),
            // The first is air.
            media: scene.media.len().saturating_sub(1),
            picture: scene.picture.clone(),
            output: scene.output.clone(),
            transport: scene.transport,
            region: scene.film.region.map(|[[x1, x2], [y1, y2]]| [[x1, y1], [x2, y2]]),
        }
    }
}

/// Starts to load; what comes of it is sent with the ticket, soon and without a scene where it was stopped.
pub fn spawn(ticket: u64, request: Request, stop: Stop, to: Sender<Command>) -> std::io::Result<()> {
    let thread = std::thread::Builder::new().name("load".to_owned());
    thread.spawn(move || {
        let outcome = guarded(request, |request| load(request, &stop));
        // The engine may have ended.
        drop(to.send(Command::Loaded(ticket, Box::new(outcome))));
    })?;
    Ok(())
}

/// Nothing came of it, for this reason.
fn nothing(request: Request, text: String) -> Outcome {
    Outcome {
        request,
        scene: None,
        read: vec![],
        film: None,
        findings: vec![],
        sources: Arc::default(),
        lines: vec![Line { weight: Weight::Error, text }],
    }
}

/// What `load` makes of a request, also where it fails by a bug: somebody waits for an answer.
fn guarded(request: Request, load: impl FnOnce(Request) -> Outcome) -> Outcome {
    let asked = request.clone();
    catch_unwind(AssertUnwindSafe(|| load(request)))
        .unwrap_or_else(|panic| nothing(asked, words::failed_by_bug(message_of(&*panic))))
}

fn load(request: Request, stop: &Stop) -> Outcome {
    let start = Instant::now();
    let film = match request.film.as_deref().map(read_film).transpose() {
        Ok(film) => film,
        Err(error) => return nothing(request, error.to_string()),
    };
    match load_scene(&request.path, &request.arguments, Some(stop)) {
        Ok((loaded, read)) => {
            let seconds = start.elapsed().as_secs_f64();
            let is_loaded = loaded.scene.is_some();
            let line = Line { weight: Weight::Info, text: words::loaded(&request.path, seconds) };
            Outcome {
                request,
                scene: loaded.scene.map(Arc::new),
                read,
                film,
                findings: findings(&loaded.sink, &loaded.sources),
                sources: Arc::new(loaded.sources),
                lines: if is_loaded { vec![line] } else { vec![] },
            }
        }
        Err(message) => nothing(request, message),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::part::Part;
    use indigo_front::flags::Arguments;

    #[test]
    fn loading_that_fails_by_a_bug_is_answered() {
        let arguments = Arguments::default();
        let request = Request {
            path: "a.igs".to_owned(),
            part: Part::of(&arguments),
            arguments,
            film: None,
            starts: true,
            halts_at: None,
            kept: None,
        };
        let outcome = guarded(request, |_| panic!("a mesh of the test"));
        assert!(outcome.scene.is_none() && outcome.request.path == "a.igs");
        assert!(outcome.lines[0].text.contains("a mesh of the test"), "{}", outcome.lines[0].text);
    }
}
