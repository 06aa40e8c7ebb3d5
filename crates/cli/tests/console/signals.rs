//! Ctrl-C, and sudden death.

use super::workbench::{PATIENCE, Running, Workbench, assert_picture};
use std::process::Command;
use std::time::{Duration, Instant};

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
    assert!(said.contains("Interrupted: saving what was rendered"), "{said}");
}

/// On a disk that is full nothing is said to be saved that is not.
#[test]
fn an_interrupt_promises_nothing() {
    let size =
        "<width>400</width><height>300</height><logging>false</logging><display_period>0.1</display_period>";
    let mut bench = Workbench::new(size);
    // Files end at 8 KiB, or 16 in some shells: enough for what is said, and not for the picture.
    let limited = "trap '' XFSZ; ulimit -f 16; exec \"$0\" \"$@\"";
    bench.wrapper = ["sh", "-c", limited].map(str::to_owned).into();
    let mut running = bench.start(&["scene.igs", "-o", "a.png", "-t", "1"]);
    let said = || std::fs::read_to_string(bench.path("stderr")).expect("what it said");
    let deadline = Instant::now() + PATIENCE;
    while !said().contains(" spp ") {
        assert!(Instant::now() < deadline, "{}", said());
        std::thread::sleep(Duration::from_millis(5));
    }
    interrupt(&running);
    assert_eq!(running.finish(), Some(1));
    let said = said();
    assert!(said.contains("Interrupted") && said.contains("cannot write a.png"), "{said}");
    assert!(!said.contains("saved"), "{said}");
}

/// A picture so large that saving it takes much longer than pressing Ctrl-C twice.
#[test]
fn a_second_interrupt_leaves_at_once() {
    let large = "<width>2400</width><height>1800</height><image_save_period>0.05</image_save_period><logging>false</logging>";
    let bench = Workbench::new(large);
    let mut running = bench.start(&["scene.igs", "-o", "a.png", "-t", "1"]);
    // The first save has begun, so interrupts are caught by now.
    running.wait_for_save(&bench, "a.png");
    interrupt(&running);
    std::thread::sleep(Duration::from_millis(50));
    interrupt(&running);
    assert_eq!(running.finish(), Some(130));
    assert_eq!(unfinished(&bench), [""; 0]);
}

/// Names of what was being written.
fn unfinished(bench: &Workbench) -> Vec<String> {
    bench
        .files()
        .into_iter()
        .filter(|name| name.contains(".indigo.") || name.contains(".unpacking"))
        .collect()
}

/// What renders nothing has nothing to save: it leaves by the first one, and takes along what is not finished.
#[test]
fn an_interrupted_pack_leaves_nothing_behind() {
    let bench = Workbench::new("<logging>false</logging>");
    // Nothing is decoded, and a picture is not compressed again.
    let texture = std::fs::File::create(bench.path("a.png")).expect("the test's own directory");
    texture.set_len(100 << 20).expect("a hole takes no room");
    let material = "<material><name>wood</name><diffuse><albedo_texture><uv_set>uv</uv_set><path>a.png</path>\
                    </albedo_texture></diffuse></material></scene>";
    bench.write("scene.igs", &super::workbench::scene("").replace("</scene>", material));
    let mut running = bench.start(&["--pack", "scene.igs", "out.pigs"]);
    running.wait_for_save(&bench, "out.pigs");
    interrupt(&running);
    assert_eq!(running.finish(), Some(130));
    assert_eq!(bench.files(), ["a.png", "scene.igs", "stderr", "stdout"]);
    assert_eq!(bench.run(&["--pack", "scene.igs", "out.pigs"]).status, Some(0));
    // The texture is the first of two files in it.
    let mut running = bench.start(&["--unpack", "out.pigs", "folder"]);
    running.wait_for(&bench.path("folder.unpacking/PACKED_0_a.png"));
    interrupt(&running);
    assert_eq!(running.finish(), Some(130));
    assert!(!bench.path("folder").exists() && unfinished(&bench).is_empty(), "{:?}", bench.files());
}

/// Deaths at any moment between and in saves: there are always a whole picture and a whole film, each
/// death leaves one unfinished file at most, and the next save clears it away.
#[test]
fn sudden_death_leaves_a_whole_picture_and_film() {
    const DEATHS: u64 = 40;
    let settings = format!("{OFTEN}<save_igi>true</save_igi><width>300</width><height>225</height>");
    let bench = Workbench::new(&settings);
    for death in 0..DEATHS {
        let left = unfinished(&bench);
        let mut running = bench.start(&["scene.igs", "-o", "a.png", "-t", "1"]);
        if death == 0 {
            running.wait_for(&bench.path("a.png"));
        } else {
            // Until the next save has begun, with the film: the one before is on the disk.
            running.wait_for_save(&bench, "a.igi");
            // The program also tries for a moment whether it can write, before any save.
            let is_cleared = || left.iter().all(|name| !bench.path(name).exists());
            let patience = Instant::now() + Duration::from_secs(20);
            while !is_cleared() && Instant::now() < patience {
                std::thread::sleep(Duration::from_millis(1));
            }
            assert!(is_cleared(), "{left:?} is still there");
        }
        // A save takes about 50 ms: spread the deaths over it.
        std::thread::sleep(Duration::from_millis(death * 37 % DEATHS * 2));
        running.0.kill().expect("a child of ours");
        running.0.wait().expect("a child of ours");
        assert_picture(&bench.path("a.png"), 300, 225);
        let film = std::fs::read(bench.path("a.igi")).expect("the film");
        let film = indigo_film::igi::read(&film).expect("a whole film");
        assert_eq!(film.film.size.width(), 300);
        assert!(unfinished(&bench).len() <= 1, "{:?}", bench.files());
    }
}
