//! What is printed for a failure renders what the test rendered.

use crate::common::again::{MOST_REJECTIONS, SCENE, replay};
use crate::common::text::{background, flat_camera, scene_file, settings, uniform};
use crate::common::{MODES, film, scene};
use std::fs;

#[test]
fn a_failure_tells_how_to_see_its_samples() {
    let parts = [settings(4, ""), flat_camera([0.0; 3], [0.0, 1.0, 0.0], 0.5), background(&uniform(1.0))];
    let mut rendered = scene(&scene_file(&parts));
    MODES[3].set(&mut rendered);
    film(&rendered, 77, 1);
    film(&rendered, 79, 1);
    let told = replay();
    let line = told.lines().find(|l| l.starts_with("any sample: ")).expect("a command");
    assert!(line.contains("SEED from 77 to 79"), "{line}");
    let path = line.split_whitespace().find(|word| word.ends_with(SCENE)).expect("a file");
    let again = scene(&fs::read_to_string(path).expect("a scene"));
    let metropolis = rendered.transport.metropolis.as_mut().expect("mutations");
    metropolis.max_consecutive_rejections = MOST_REJECTIONS;
    assert_eq!(again.transport, rendered.transport);
}
