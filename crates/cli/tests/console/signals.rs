//! Ctrl-C, and sudden death.

use super::workbench::{Running, Workbench, assert_picture};
use std::path::Path;
use std::process::Command;
use std::time::Duration;

/// Saved again and again, as fast as may be.
const OFTEN: &str = "<logging>false</logging><image_save_period>0.05</image_save_period>";

fn interrupt(running: &Running) {
    let sent =
        Command::new("kill").args(["-INT", &running.0.id().to_string()]).status().expect("the command kill");
    assert!(sent.success());
}

#[test]
fn an_interrupt_saves_and_ends_well() {
    let bench = Workbench::new(OFTEN);
    let mut running = bench.start(&["scene.igs", "-o", "a.png", "-t", "1"]);
    running.wait_for(&bench.path("a.png"));
    std::fs::remove_file(bench.path("a.png")).expect("the first save");
    interrupt(&running);
    assert_eq!(running.finish(), Some(0));
    assert_picture(&bench.path("a.png"), 40, 30);
    let said = std::fs::read_to_string(bench.path("stderr")).expect("what it said");
    assert!(said.trim_end().ends_with("Saved a.png"), "{said}");
}

/// A picture so large that saving it takes much longer than pressing Ctrl-C twice.
#[test]
fn a_second_interrupt_leaves_at_once() {
    let large = "<width>2400</width><height>1800</height><image_save_period>0.05</image_save_period><logging>false</logging>";
    let bench = Workbench::new(large);
    let mut running = bench.start(&["scene.igs", "-o", "a.png", "-t", "1"]);
    // The first save has begun, so interrupts are caught by now.
    let temporary = format!("a.png.{}.tmp", running.0.id());
    running.wait_for(&bench.path(&temporary));
    interrupt(&running);
    std::thread::sleep(Duration::from_millis(50));
    interrupt(&running);
    assert_eq!(running.finish(), Some(130));
}

/// Twenty-four deaths at any moment between and in saves: there is always a whole picture, and each
/// death leaves one unfinished file at most.
#[test]
fn sudden_death_leaves_a_whole_picture() {
    let bench = Workbench::new(&format!("{OFTEN}<width>300</width><height>225</height>"));
    let mut unfinished = 0;
    for death in 0..24u64 {
        let mut running = bench.start(&["scene.igs", "-o", "a.png", "-t", "1"]);
        if death == 0 {
            running.wait_for(&bench.path("a.png"));
        } else {
            // Until the next save has begun: the one before is on the disk.
            let temporary = format!("a.png.{}.tmp", running.0.id());
            running.wait_for(&bench.path(&temporary));
        }
        std::thread::sleep(Duration::from_millis(death * 37 % 24 * 4));
        running.0.kill().expect("a child of ours");
        running.0.wait().expect("a child of ours");
        assert_picture(&bench.path("a.png"), 300, 225);
        let left =
            bench.files().iter().filter(|n| Path::new(n).extension().is_some_and(|e| e == "tmp")).count();
        assert!(left <= unfinished + 1, "{:?}", bench.files());
        unfinished = left;
    }
}
