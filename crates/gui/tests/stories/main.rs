//! Stories of people at the window: the program runs on a display, gets keys, and what is seen is judged.
//!
//! Without `DISPLAY` they fail: `cargo xtask test` provides a display.

mod ends;
mod network;
mod screen;

use screen::{Screen, keys, scratch};
use std::path::Path;
use std::process::Command;
use std::time::Duration;

const LARGE: [u16; 2] = [1280, 800];
const SMALL: [u16; 2] = [960, 600];
/// How far from the top the control of the exposure is.
const EV: i16 = 246;
/// The grey round the picture in the dark theme, with which the window begins.
const GROUND: [u8; 3] = [38; 3];

/// Even light from everywhere, seen through a camera whose sensor gathers a fifth of what saturates it.
fn even_light(folder: &Path) -> String {
    let text = r#"<?xml version="1.0" encoding="utf-8"?>
<scene>
    <renderer_settings>
        <width>300</width><height>300</height><super_sample_factor>2</super_sample_factor>
        <bidirectional>false</bidirectional><metropolis>false</metropolis>
        <aperture_diffraction>false</aperture_diffraction><vignetting>false</vignetting>
        <save_igi>true</save_igi>
        <halt_samples_per_pixel>4</halt_samples_per_pixel>
    </renderer_settings>
    <tonemapping><camera><response_function_path></response_function_path>
        <ev_adjust>EV</ev_adjust><film_iso>100</film_iso></camera></tonemapping>
    <background><spectrum><uniform><value>1.0e8</value></uniform></spectrum></background>
    <camera>
        <pos>0 0 0</pos><up>0 0 1</up><forwards>0 1 0</forwards><aperture_radius>0.001</aperture_radius>
        <focus_distance>1</focus_distance><aspect_ratio>1</aspect_ratio><sensor_width>0.036</sensor_width>
        <lens_sensor_dist>0.05</lens_sensor_dist><exposure_duration>0.01</exposure_duration>
        <white_balance>E</white_balance>
    </camera>
</scene>
"#;
    write(folder, "even.igs", &text.replace("EV", "0.0"))
}

fn write(folder: &Path, name: &str, text: &str) -> String {
    let path = folder.join(name);
    std::fs::write(&path, text).expect("the scene is written");
    path.display().to_string()
}

/// A box with noise in its shadows, small enough to be rendered while somebody waits, also on a busy machine.
fn noisy_box(folder: &Path) -> String {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../testscenes/cornell_box.igs");
    let text = std::fs::read_to_string(path).expect("the scene is there");
    let small = text.replace(">512</width>", ">160</width>").replace(">512</height>", ">160</height>");
    assert_ne!(small, text, "the scene has another size than it had");
    write(folder, "box.igs", &small)
}

/// Waits until a picture is seen: something other than the grey around it, or the black before the window is drawn and
/// where there are no samples yet. A few pixels of a noisy picture are black, too.
fn wait_for_picture(screen: &mut Screen) {
    screen.wait_for("picture", |screen| {
        let seen = screen.see_picture();
        let is_ground = |p: &&[u8; 3]| p[0] == p[1] && p[1] == p[2] && [0, 38, 150].contains(&p[0]);
        (seen.pixels.iter().filter(is_ground).count() < seen.pixels.len() / 2).then_some(())
    });
}

/// How bright the picture is.
fn light(screen: &Screen) -> f64 {
    screen.see_picture().light()[1]
}

/// Asks a window to close in which something is rendered, and waits for its question: the picture behind it is much darker. By
/// its mean, since a picture that took long to be developed may come yet. How bright it was before.
fn ask_to_close(screen: &mut Screen) -> f64 {
    let shown = light(screen);
    screen.ask_to_close();
    screen.wait_for("question", |screen| (light(screen) < 0.6 * shown).then_some(()));
    shown
}

#[test]
fn exposure_changes_the_light_by_its_factor_and_reset_takes_it_back() {
    let folder = scratch("exposure");
    let mut screen = Screen::start(&folder, LARGE, &[&even_light(&folder), "-o", "even.png"]);
    // With all its samples: the light of fewer is another.
    screen.wait_for("the end", |_| folder.join("even.png").exists().then_some(()));
    wait_for_picture(&mut screen);
    std::thread::sleep(Duration::from_secs(2));
    let before = screen.see_picture().light();
    assert!(before.iter().all(|light| (0.02..0.4).contains(light)), "{before:?}");
    // Codes are whole numbers: at 0.1 of full light a step between two is less than 2.5 % of the light.
    let is_times = |factor: f64, after: [f64; 3]| {
        before.iter().zip(after).all(|(before, after)| (after / before / factor - 1.0).abs() < 0.03)
    };
    // Something else may be seen on the way, and even this in passing: only what stays counts.
    let becomes = |screen: &mut Screen, factor: f64| {
        screen.wait_for("light", |screen| is_times(factor, screen.see_picture().light()).then_some(()));
        std::thread::sleep(Duration::from_secs(2));
        let after = screen.see_picture().light();
        assert!(is_times(factor, after), "{after:?} is not {factor} times {before:?}");
    };
    // Half a stop each.
    for (key, factor) in [(keys::BRACKET_RIGHT, 2.0), (keys::BRACKET_LEFT, 1.0), (keys::BRACKET_LEFT, 0.5)] {
        screen.press(&[key]);
        screen.press(&[key]);
        becomes(&mut screen, factor);
    }
    // The number of the control itself.
    screen.click([LARGE[0] as i16 - 40, EV]);
    std::thread::sleep(Duration::from_millis(500));
    screen.press(&[u32::from(b'1')]);
    screen.press(&[keys::RETURN]);
    becomes(&mut screen, 2.0);
    screen.press(&[keys::ESCAPE]);
    screen.press(&[keys::BACKSPACE]);
    screen.wait_for("the first light", |screen| {
        let after = screen.see_picture().light();
        before.iter().zip(after).all(|(a, b)| (a - b).abs() < 1e-6).then_some(())
    });
    std::fs::remove_dir_all(&folder).expect("the story's own files");
}

#[test]
fn a_picture_grows_rests_is_saved_and_seen_again() {
    let folder = scratch("growing");
    let scene = noisy_box(&folder);
    let mut screen = Screen::start(&folder, LARGE, &[&scene, "-o", "box.png", "-t", "1"]);
    wait_for_picture(&mut screen);
    let first = screen.see_picture().pixels;
    screen.wait_for("change", |screen| (screen.see_picture().pixels != first).then_some(()));
    screen.press(&[u32::from(b'p')]);
    // The threads finish what they are at, and the picture is shown with all of it.
    let mut last = screen.see_picture().pixels;
    screen.wait_for("rest", |screen| {
        std::thread::sleep(Duration::from_secs(2));
        let now = screen.see_picture().pixels;
        let rests = now == last;
        last = now;
        rests.then_some(())
    });
    screen.press(&[keys::CONTROL, u32::from(b's')]);
    let png = folder.join("box.png");
    screen.wait_for("saved picture", |_| std::fs::metadata(&png).is_ok_and(|m| m.len() > 0).then_some(()));
    // A render is not lost by closing.
    let shown = ask_to_close(&mut screen);
    std::thread::sleep(Duration::from_millis(500));
    screen.see().keep("closing");
    screen.press(&[keys::ESCAPE]);
    screen.wait_for("the picture again", |screen| (light(screen) > 0.9 * shown).then_some(()));
    // The first answer is to save.
    std::fs::remove_file(&png).expect("the picture is there");
    ask_to_close(&mut screen);
    screen.press(&[keys::SPACE]);
    assert!(screen.wait_for_end());
    assert!(png.exists(), "it was saved");
    drop(screen);
    let mut again = Screen::start(&folder, LARGE, &[&scene, "-o", "again.png", "-haltspp", "1"]);
    wait_for_picture(&mut again);
    std::fs::remove_dir_all(&folder).expect("the story's own files");
}

/// Where no program of the desktop asks for files, the window does.
#[test]
fn a_scene_is_opened_by_its_typed_path() {
    let folder = scratch("typed");
    even_light(&folder);
    let mut screen = Screen::start(&folder, LARGE, &[]);
    // A corner of the area of the picture, which becomes darker behind a question.
    let ground = |screen: &Screen| screen.see_at([10, 60]);
    screen.wait_for("ground of the picture", |screen| (ground(screen) == GROUND).then_some(()));
    screen.press(&[keys::CONTROL, u32::from(b'o')]);
    screen.wait_for("question", |screen| (ground(screen) != GROUND).then_some(()));
    std::thread::sleep(Duration::from_millis(500));
    for key in "even.ig".bytes() {
        screen.press(&[u32::from(key)]);
    }
    screen.press(&[keys::RETURN]);
    std::thread::sleep(Duration::from_millis(500));
    screen.see().keep("typed");
    // There is none of that name, and the line can be mended.
    screen.press(&[u32::from(b's')]);
    screen.press(&[keys::RETURN]);
    wait_for_picture(&mut screen);
    std::fs::remove_dir_all(&folder).expect("the story's own files");
}

#[test]
fn a_film_is_looked_at_again() {
    let folder = scratch("film");
    let mut screen = Screen::start(&folder, LARGE, &[&even_light(&folder), "-o", "even.png"]);
    let film = folder.join("even.igi");
    screen.wait_for("film", |_| std::fs::metadata(&film).is_ok_and(|m| m.len() > 0).then_some(()));
    // When nothing is rendered the window closes at once.
    screen.wait_for("the end of saving", |_| folder.join("even.png").exists().then_some(()));
    std::thread::sleep(Duration::from_secs(1));
    screen.ask_to_close();
    assert!(screen.wait_for_end());
    drop(screen);
    let mut again = Screen::start(&folder, LARGE, &[&film.display().to_string()]);
    wait_for_picture(&mut again);
    again.see().keep("film");
    std::fs::remove_dir_all(&folder).expect("the story's own files");
}

/// Both themes at two sizes, with all that a scene brings: kept for people to look at. That something is there, and that the
/// themes differ, is judged here.
#[test]
fn both_themes_at_two_sizes() {
    for (size, name) in [(LARGE, "large"), (SMALL, "small")] {
        let folder = scratch(name);
        let scene = noisy_box(&folder);
        let mut screen = Screen::start(&folder, size, &[&scene, "-o", "box.png", "-haltspp", "32"]);
        wait_for_picture(&mut screen);
        screen.wait_for("the end", |_| folder.join("box.png").exists().then_some(()));
        screen.point([(size[0] - 324) as i16 / 2, 250]);
        std::thread::sleep(Duration::from_secs(2));
        let dark = screen.see();
        dark.keep(&format!("dark-{name}"));
        screen.press(&[keys::F2]);
        // The tool bar's ground.
        let at = 4 * usize::from(size[0]) + 4;
        let light = screen.wait_for("light theme", |screen| {
            let seen = screen.see();
            (seen.pixels[at][0] > dark.pixels[at][0] + 100).then_some(seen)
        });
        light.keep(&format!("light-{name}"));
        for tab in ["render", "scene", "queue"] {
            // Control and the number of a tab.
            let number = match tab {
                "render" => b'2',
                "scene" => b'3',
                _ => b'4',
            };
            screen.press(&[keys::CONTROL, u32::from(number)]);
            std::thread::sleep(Duration::from_millis(400));
            screen.see().keep(&format!("light-{name}-{tab}"));
        }
        std::fs::remove_dir_all(&folder).expect("the story's own files");
    }
}

/// The elements of a scene as they are declared, with a value that is not what it should be: kept for people to look at.
#[test]
fn elements_in_both_themes() {
    let folder = scratch("elements");
    let scene = noisy_box(&folder);
    let mut screen = Screen::start(&folder, LARGE, &[&scene, "-o", "box.png", "-haltspp", "1"]);
    screen.wait_for("the end", |_| folder.join("box.png").exists().then_some(()));
    wait_for_picture(&mut screen);
    screen.press(&[keys::CONTROL, u32::from(b'3')]);
    let side = LARGE[0] as i16 - 324;
    // The page of elements, the camera, the settings above it, and the first of these.
    for at in [[side + 120, 100], [side + 40, 216], [side + 40, 168], [side + 250, 196]] {
        std::thread::sleep(Duration::from_millis(800));
        screen.click(at);
    }
    screen.press(&[keys::END]);
    screen.press(&[u32::from(b'x')]);
    for theme in ["dark", "light"] {
        std::thread::sleep(Duration::from_millis(800));
        screen.see().keep(&format!("{theme}-elements"));
        screen.press(&[keys::ESCAPE]);
        screen.press(&[keys::F2]);
    }
    std::fs::remove_dir_all(&folder).expect("the story's own files");
}

/// An element is changed, and the window closed: what was changed is asked about, and saved by the first answer.
#[test]
fn a_changed_element_is_not_lost_by_closing() {
    let folder = scratch("unsaved");
    let scene = even_light(&folder);
    let mut screen = Screen::start(&folder, LARGE, &[&scene, "-o", "even.png"]);
    screen.wait_for("the end", |_| folder.join("even.png").exists().then_some(()));
    wait_for_picture(&mut screen);
    screen.press(&[keys::CONTROL, u32::from(b'3')]);
    let side = LARGE[0] as i16 - 324;
    // The page of elements, the first of them, and the field of its first child.
    for at in [[side + 120, 100], [side + 30, 164], [side + 250, 192]] {
        std::thread::sleep(Duration::from_millis(800));
        screen.click(at);
    }
    screen.press(&[keys::END]);
    screen.press(&[u32::from(b'9')]);
    std::thread::sleep(Duration::from_millis(500));
    screen.see().keep("changed");
    ask_to_close(&mut screen);
    std::thread::sleep(Duration::from_millis(500));
    screen.see().keep("unsaved");
    screen.press(&[keys::SPACE]);
    assert!(screen.wait_for_end());
    let text = std::fs::read_to_string(&scene).expect("the scene");
    assert!(text.contains("<width>3009</width>"), "{text}");
    std::fs::remove_dir_all(&folder).expect("the story's own files");
}

#[test]
fn the_height_of_the_log_and_the_tab_are_remembered() {
    let folder = scratch("height");
    let edge = LARGE[1] - 30 - 152;
    // Above the line with the pixel's values at first.
    let ground = |screen: &Screen| screen.see_at([10, edge - 50]);
    let mut screen = Screen::start(&folder, LARGE, &[]);
    screen.wait_for("ground of the picture", |screen| (ground(screen) == GROUND).then_some(()));
    screen.drag([200, edge as i16], [200, edge as i16 - 100]);
    let log = screen.wait_for("higher log", |screen| Some(ground(screen)).filter(|seen| *seen != GROUND));
    // The names of the tabs, of which one is marked.
    let tabs = |screen: &Screen| {
        let seen = screen.see();
        let end = 60 * seen.width + seen.width;
        seen.pixels[end - 320..end].to_vec()
    };
    let first = tabs(&screen);
    screen.press(&[keys::CONTROL, u32::from(b'4')]);
    let chosen = screen.wait_for("another tab", |screen| Some(tabs(screen)).filter(|seen| *seen != first));
    screen.ask_to_close();
    assert!(screen.wait_for_end());
    drop(screen);
    let mut again = Screen::start(&folder, LARGE, &[]);
    again.wait_for("log of the same height", |screen| (ground(screen) == log).then_some(()));
    again.wait_for("the same tab", |screen| (tabs(screen) == chosen).then_some(()));
    std::fs::remove_dir_all(&folder).expect("the story's own files");
}

#[test]
fn the_keyboard_reaches_the_controls() {
    let folder = scratch("keyboard");
    let mut screen = Screen::start(&folder, LARGE, &[]);
    std::thread::sleep(Duration::from_secs(1));
    // The first control is the menu of files: Tab goes there, Space opens it.
    screen.press(&[keys::TAB]);
    let closed = screen.see().pixels;
    screen.press(&[keys::SPACE]);
    screen.wait_for("menu", |screen| {
        let now = screen.see().pixels;
        (now.iter().zip(&closed).filter(|(a, b)| a != b).count() > 3000).then_some(())
    });
}

#[test]
fn without_a_display_the_console_is_named() {
    let mut command = Command::new(env!("CARGO_BIN_EXE_indigo"));
    let output = command.env_remove("DISPLAY").env_remove("WAYLAND_DISPLAY").output().expect("it starts");
    assert_eq!(output.status.code(), Some(1));
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(said.contains("indigo_console") && said.contains("display"), "{said}");
}

#[test]
fn options_of_the_console_are_named() {
    let mut command = Command::new(env!("CARGO_BIN_EXE_indigo"));
    let output = command.args(["--merge", "a.igi", "b.igi", "-o", "c.igi"]).output().expect("it starts");
    assert_eq!(output.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&output.stderr).contains("indigo_console"));
}
