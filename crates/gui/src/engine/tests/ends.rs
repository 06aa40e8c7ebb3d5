//! How renders end, and what becomes of their films.

use super::{Folder, PATIENCE, even_light, wait_for};
use crate::engine::{Command, Engine, Phase, Request, Update};
use crate::part::Part;
use crate::queue::Turn;
use crate::work::Work;
use eframe::egui::Context;
use indigo_front::flags::Arguments;
use indigo_render::output::OneFile;
use std::path::Path;
use std::time::{Duration, Instant};

/// An engine that renders even light without end, of which `picture.png` and the film are written, but not in time.
fn rendering(folder: &Folder) -> Engine {
    rendering_to(folder, "picture.png")
}

/// The same with another name.
fn rendering_to(folder: &Folder, picture: &str) -> Engine {
    let settings = "<image_save_period>1e6</image_save_period><save_igi>true</save_igi></renderer_settings>";
    folder.write("scene.igs", &even_light().replace("</renderer_settings>", settings));
    let engine = Engine::new(&Context::default()).expect("threads");
    let mut request = Request { starts: true, ..folder.request() };
    request.arguments.output = Some(folder.path(picture));
    engine.send(Command::Open(Box::new(request)));
    wait_for(&engine, "render", |update| matches!(update, Update::Phase(Phase::Rendering)).then_some(()));
    engine
}

/// Whoever cancels loading may have been a moment late.
#[test]
fn cancel_leaves_a_render_alone_that_has_begun_meanwhile() {
    let folder = Folder::new("late");
    let engine = rendering(&folder);
    engine.send(Command::Cancel);
    engine.send(Command::Stop);
    wait_for(&engine, "end", |update| match update {
        Update::Phase(Phase::Ready | Phase::Empty) => panic!("the render is given up"),
        Update::Phase(phase) => matches!(phase, Phase::Halted(_)).then_some(()),
        _ => None,
    });
}

/// Waits until a file holds something.
fn wait_for_file(path: &str) {
    let start = Instant::now();
    while !std::fs::metadata(path).is_ok_and(|meta| meta.len() > 0) {
        assert!(start.elapsed() < PATIENCE, "{path} is not written");
        std::thread::sleep(Duration::from_millis(5));
    }
}

/// Ends the engine without the render's files.
fn discard(engine: &Engine) {
    engine.send(Command::Quit { saves: false });
    wait_for(engine, "end", |update| matches!(update, Update::Gone).then_some(()));
}

/// Whoever lets a render rest may leave the machine, or switch it off.
#[test]
fn what_rests_is_saved() {
    let folder = Folder::new("rests");
    let engine = rendering(&folder);
    assert!(!Path::new(&folder.path("picture.igi")).exists(), "it is not time yet");
    engine.send(Command::Pause);
    wait_for_file(&folder.path("picture.igi"));
    wait_for_file(&folder.path("picture.png"));
}

#[test]
fn what_is_saved_by_wish_is_there_at_the_end() {
    let folder = Folder::new("wish");
    let engine = rendering(&folder);
    engine.send(Command::SaveAll);
    engine.send(Command::Save(OneFile::Luminances, folder.path("other.exr").into()));
    discard(&engine);
    for name in ["picture.png", "picture.igi", "other.exr"] {
        assert!(Path::new(&folder.path(name)).exists(), "{name}");
    }
}

/// It would be written by two that do not know of each other.
#[test]
fn a_file_of_the_render_is_saved_with_its_others() {
    let folder = Folder::new("own");
    let engine = rendering(&folder);
    // By another name of the same file.
    let same = folder.0.join("..").join(folder.0.file_name().expect("a name")).join("picture.png");
    engine.send(Command::Save(OneFile::Picture, same));
    wait_for_file(&folder.path("picture.igi"));
    discard(&engine);
}

#[test]
fn a_scene_with_errors_has_had_its_turn() {
    let folder = Folder::new("broken");
    folder.write("scene.igs", "<scene><camera></scene>");
    let engine = Engine::new(&Context::default()).expect("threads");
    engine.send(Command::Open(Box::new(Request { starts: true, ..folder.request() })));
    let mut lines = vec![];
    let how = wait_for(&engine, "end", |update| match update {
        Update::Done(how) => Some(how),
        Update::Line(line) => {
            lines.push(line.text);
            None
        }
        _ => None,
    });
    assert_eq!(how, Turn::Failed);
    // The log keeps why, whatever is loaded next.
    assert!(lines.iter().any(|line| line.contains("scene.igs:1:")), "{lines:?}");
}

/// A slip of the mouse may drop something else on the window.
#[test]
fn what_cannot_be_opened_ends_no_render() {
    let folder = Folder::new("slip");
    let engine = rendering(&folder);
    folder.write("broken.igs", "<scene><camera></scene>");
    for (is_paused, expected) in [(false, Phase::Rendering), (true, Phase::Paused)] {
        if is_paused {
            engine.send(Command::Pause);
        }
        let path = folder.path("broken.igs");
        engine.send(Command::Open(Box::new(Request { path, starts: true, ..folder.request() })));
        wait_for(&engine, "loading", |update| matches!(update, Update::Phase(Phase::Loading)).then_some(()));
        let phase = wait_for(&engine, "end of loading", |update| match update {
            Update::Done(_) => panic!("its turn has not ended"),
            Update::Phase(phase) => Some(phase),
            _ => None,
        });
        assert_eq!(phase, expected);
    }
    engine.send(Command::Resume);
    let samples = |engine: &Engine| {
        wait_for(engine, "progress", |update| match update {
            Update::Progress(progress, _) => Some(progress.samples),
            _ => None,
        })
    };
    let before = samples(&engine);
    assert!(samples(&engine) > before, "it goes on");
    // A scene that can be rendered takes its place, and all files are there.
    engine.send(Command::Open(Box::new(folder.request())));
    wait_for(&engine, "next scene", |update| matches!(update, Update::Cleared).then_some(()));
    assert!(Path::new(&folder.path("picture.igi")).exists());
}

/// An engine with a film that could not be saved: where its folder was there is a file.
fn unsaved(folder: &Folder) -> Engine {
    let away = folder.0.join("away");
    std::fs::create_dir(&away).expect("a folder");
    let engine = rendering_to(folder, "away/picture.png");
    std::fs::remove_dir_all(&away).expect("our own files");
    std::fs::write(&away, "").expect("a file in the way");
    engine.send(Command::Stop);
    let (mut left, mut how) = (None, None);
    wait_for(&engine, "end", |update| {
        match update {
            Update::Unsaved(n) => left = Some(n),
            Update::Done(turn) => how = Some(turn),
            _ => {}
        }
        left.zip(how)
    });
    assert_eq!((left, how), (Some(1), Some(Turn::Failed)));
    engine
}

/// The disk has room again.
fn make_room(folder: &Folder) {
    std::fs::remove_file(folder.0.join("away")).expect("our own file");
    std::fs::create_dir(folder.0.join("away")).expect("a folder");
}

#[expect(clippy::needless_pass_by_value, reason = "what was heard is handed over")]
fn n_unsaved(update: Update) -> Option<usize> {
    match update {
        Update::Unsaved(n) => Some(n),
        Update::Gone => panic!("it has ended"),
        _ => None,
    }
}

#[test]
fn a_film_that_cannot_be_saved_is_kept_until_it_is() {
    let folder = Folder::new("full");
    let engine = unsaved(&folder);
    // Neither another part of the picture nor the end take it away, and nor does trying again.
    engine.send(Command::SetRegion(Some([[0, 0], [4, 4]]), Work::endless()));
    engine.send(Command::SaveAll);
    assert_eq!(wait_for(&engine, "answer", n_unsaved), 1);
    engine.send(Command::Quit { saves: true });
    assert_eq!(wait_for(&engine, "answer", n_unsaved), 1);
    make_room(&folder);
    engine.send(Command::SaveAll);
    assert_eq!(wait_for(&engine, "answer", n_unsaved), 0);
    assert!(Path::new(&folder.path("away/picture.png")).exists());
    engine.send(Command::Quit { saves: true });
    wait_for(&engine, "end", |update| matches!(update, Update::Gone).then_some(()));
}

/// Whoever has saved it elsewhere need not be asked what becomes of it.
#[test]
fn a_film_that_is_saved_elsewhere_is_in_memory_alone_no_more() {
    let folder = Folder::new("elsewhere");
    let engine = unsaved(&folder);
    engine.send(Command::Save(OneFile::Film, folder.path("other.igi").into()));
    assert_eq!(wait_for(&engine, "answer", n_unsaved), 0);
    engine.send(Command::Quit { saves: true });
    wait_for(&engine, "end", |update| matches!(update, Update::Gone).then_some(()));
}

/// What is told of a film that is opened is of that film.
#[test]
fn a_film_of_the_open_scene_tells_how_far_it_came() {
    let folder = Folder::new("came");
    let engine = rendering(&folder);
    engine.send(Command::Stop);
    let mut last = None;
    wait_for(&engine, "end", |update| match update {
        Update::Progress(progress, _) => {
            last = Some(progress.samples);
            None
        }
        Update::Done(_) => Some(()),
        _ => None,
    });
    let path = folder.path("picture.igi");
    engine.send(Command::Start(Work::endless(), Box::new(Part::of(&Arguments::default()))));
    wait_for(&engine, "more", |update| match update {
        Update::Progress(progress, _) => (Some(progress.samples) > last).then_some(()),
        _ => None,
    });
    std::fs::copy(&path, folder.path("before.igi")).expect("the film");
    engine.send(Command::OpenFilm(folder.path("before.igi").into()));
    let kept = wait_for(&engine, "film", |update| match update {
        Update::Progress(progress, _) => {
            last = Some(progress.samples);
            None
        }
        Update::Kept(samples) => Some(samples),
        _ => None,
    });
    assert_eq!(last, Some(kept));
}

/// With the part of the picture that it is of.
#[test]
fn a_film_of_a_region_is_gone_on_with() {
    const REGION: [[u32; 2]; 2] = [[2, 3], [7, 8]];
    let folder = Folder::new("part");
    let engine = rendering(&folder);
    let region = |engine: &Engine, what: &str| {
        wait_for(engine, what, |update| match update {
            Update::Scene(facts, _) => Some(facts.region),
            _ => None,
        })
    };
    engine.send(Command::SetRegion(Some(REGION), Work::endless()));
    assert_eq!(region(&engine, "region"), Some(REGION));
    wait_for(&engine, "samples", |update| match update {
        Update::Progress(progress, _) => (progress.samples > 0).then_some(()),
        _ => None,
    });
    engine.send(Command::Stop);
    wait_for(&engine, "end", |update| matches!(update, Update::Done(_)).then_some(()));
    let film = folder.path("part.igi");
    engine.send(Command::Save(OneFile::Film, film.clone().into()));
    wait_for(&engine, "film", |update| matches!(update, Update::Kept(_)).then_some(()));
    engine.send(Command::SetRegion(None, Work::endless()));
    assert_eq!(region(&engine, "whole"), None);
    engine.send(Command::OpenFilm(film.into()));
    let mut taken = None;
    wait_for(&engine, "scene", |update| match update {
        Update::Scene(facts, _) => {
            taken = facts.region;
            None
        }
        Update::Film(..) => panic!("it is of no scene"),
        Update::Phase(phase) => (phase == Phase::Ready).then_some(()),
        _ => None,
    });
    assert_eq!(taken, Some(REGION));
}

/// A queue does not wait for anybody, and the disk may have room again in the morning.
#[test]
fn a_film_that_cannot_be_saved_outlives_the_next_scene() {
    let folder = Folder::new("next");
    let engine = unsaved(&folder);
    let mut request = folder.request();
    request.arguments.output = Some(folder.path("next.png"));
    engine.send(Command::Open(Box::new(request)));
    wait_for(&engine, "next scene", |update| matches!(update, Update::Scene(..)).then_some(()));
    make_room(&folder);
    engine.send(Command::Quit { saves: true });
    wait_for(&engine, "end", |update| matches!(update, Update::Gone).then_some(()));
    assert!(Path::new(&folder.path("away/picture.png")).exists());
}

#[test]
fn a_film_that_is_gone_on_with_is_saved_with_what_is_added() {
    let folder = Folder::new("on");
    let engine = unsaved(&folder);
    make_room(&folder);
    engine.send(Command::Start(Work::endless(), Box::new(Part::of(&Arguments::default()))));
    assert_eq!(wait_for(&engine, "answer", n_unsaved), 0);
    engine.send(Command::Quit { saves: true });
    wait_for(&engine, "end", |update| matches!(update, Update::Gone).then_some(()));
    assert!(Path::new(&folder.path("away/picture.png")).exists());
}

/// The window may go without a question: its display is lost, or what draws it fails.
#[test]
fn a_render_is_saved_when_the_window_is_lost() {
    let folder = Folder::new("lost");
    let engine = rendering(&folder);
    drop(engine);
    assert!(Path::new(&folder.path("picture.igi")).exists());
}

#[test]
fn a_window_that_is_lost_waits_for_no_answer() {
    let folder = Folder::new("answer");
    drop(unsaved(&folder));
}

/// A bug in what is beside the render costs neither the film nor the window.
#[test]
fn an_engine_that_fails_saves_and_goes_on() {
    let folder = Folder::new("fails");
    let engine = rendering(&folder);
    engine.send(Command::Fail);
    let how = wait_for(&engine, "end", |update| match update {
        Update::Done(how) => Some(how),
        _ => None,
    });
    assert_eq!(how, Turn::Failed);
    assert!(Path::new(&folder.path("picture.igi")).exists());
    engine.send(Command::Fail);
    engine.send(Command::Quit { saves: true });
    wait_for(&engine, "end", |update| matches!(update, Update::Gone).then_some(()));
}

/// Whoever wants to know the error asks for it while the picture grows.
#[test]
fn the_error_is_estimated_from_the_moment_that_it_is_asked_for() {
    let folder = Folder::new("error");
    let engine = rendering(&folder);
    let error = |update| match update {
        Update::Progress(progress, _) => Some(progress.relative_error),
        _ => None,
    };
    assert_eq!(wait_for(&engine, "progress", error), None);
    engine.send(Command::Adjust(Work { estimates_error: true, ..Work::endless() }));
    wait_for(&engine, "estimate", |update| error(update).flatten());
    discard(&engine);
}
