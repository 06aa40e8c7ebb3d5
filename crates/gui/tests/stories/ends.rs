//! How the program ends when nobody is asked.

use super::screen::{Screen, scratch};
use super::{LARGE, noisy_box, wait_for_picture};
use std::process::Command;

/// The end of a session is no end of a film.
#[test]
fn a_render_is_saved_when_the_program_is_told_to_end() {
    let folder = scratch("told");
    let scene = noisy_box(&folder);
    let mut screen = Screen::start(&folder, LARGE, &[&scene, "-o", "box.png", "-t", "1"]);
    wait_for_picture(&mut screen);
    let png = folder.join("box.png");
    // On a busy machine it may have been saved in time already.
    drop(std::fs::remove_file(&png));
    let told = Command::new("kill").args(["-TERM", &screen.program.id().to_string()]).status();
    assert!(told.expect("every system has it").success());
    assert!(screen.wait_for_end());
    assert!(png.exists(), "it was saved");
    std::fs::remove_dir_all(&folder).expect("the story's own files");
}
