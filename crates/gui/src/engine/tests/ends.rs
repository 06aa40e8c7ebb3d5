//! How renders end, and what becomes of their films.

use super::{Folder, even_light, wait_for};
use crate::engine::{Command, Engine, Phase, Request, Update};
use eframe::egui::Context;

/// An engine that renders even light without end, of which `picture.png` is written.
fn rendering(folder: &Folder) -> Engine {
    folder.write("scene.igs", &even_light());
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
