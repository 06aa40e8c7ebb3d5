//! How renders end, and what becomes of their films.

use super::{Folder, PATIENCE, even_light, wait_for};
use crate::engine::{Command, Engine, Phase, Request, Update};
use crate::queue::Turn;
use eframe::egui::Context;
use indigo_render::output::OneFile;
use std::path::Path;
use std::time::{Duration, Instant};

/// An engine that renders even light without end, of which `picture.png` and the film are written, but not in time.
fn rendering(folder: &Folder) -> Engine {
    let settings = "<image_save_period>1e6</image_save_period><save_igi>true</save_igi></renderer_settings>";
    folder.write("scene.igs", &even_light().replace("</renderer_settings>", settings));
    let engine = Engine::new(&Context::default()).expect("threads");
    let mut request = Request { starts: true, ..folder.request() };
    request.arguments.output = Some(folder.path("picture.png"));
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
    let how = wait_for(&engine, "end", |update| match update {
        Update::Done(how) => Some(how),
        _ => None,
    });
    assert_eq!(how, Turn::Failed);
}
