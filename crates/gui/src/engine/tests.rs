//! The engine as the window has it, without a window.

mod ends;

use super::{Command, Engine, Phase, Request, Update, load};
use crate::part::Part;
use crate::recent::Recent;
use crate::scene_file::SceneFile;
use crate::state::State;
use crate::words;
use eframe::egui::Context;
use indigo_front::flags::Arguments;
use indigo_render::output::OneFile;
use indigo_scene::Stop;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::sync::mpsc::channel;
use std::time::{Duration, Instant};

/// Longer than anything takes here, even on a busy machine.
pub(super) const PATIENCE: Duration = Duration::from_mins(2);
/// Columns and rows of a wavy sheet of a million triangles.
const SHEET: [usize; 2] = [1000, 500];

const SCENE: &str = r#"<?xml version="1.0" encoding="utf-8"?>
<scene>
    <renderer_settings>
        <width>8</width><height>8</height><cache_trees>false</cache_trees><logging>false</logging>
        <bidirectional>false</bidirectional><metropolis>false</metropolis>
        <aperture_diffraction>false</aperture_diffraction>
    </renderer_settings>
    <tonemapping><linear><scale>1</scale></linear></tonemapping>
    <background><spectrum><uniform><value>1</value></uniform></spectrum></background>
    <camera>
        <pos>0 -3 0</pos><up>0 0 1</up><forwards>0 1 0</forwards><aperture_radius>0.001</aperture_radius>
        <focus_distance>3</focus_distance><aspect_ratio>1</aspect_ratio><sensor_width>0.036</sensor_width>
        <lens_sensor_dist>0.05</lens_sensor_dist><white_balance>D65</white_balance>
    </camera>
    <material><name>default</name><diffuse><albedo_spectrum><uniform><value>0.5</value></uniform></albedo_spectrum>
        </diffuse></material>
    <mesh><name>sheet</name><normal_smoothing>false</normal_smoothing><external><path>sheet.ply</path></external></mesh>
    <model><pos>0 0 0</pos><scale>1</scale><mesh_name>sheet</mesh_name></model>
</scene>
"#;

/// The same scene without the mesh: nothing but even light.
pub(super) fn even_light() -> String {
    let (start, end) = (SCENE.find("<mesh>").expect("a mesh"), SCENE.find("</scene>").expect("an end"));
    format!("{}{}", &SCENE[..start], &SCENE[end..])
}

/// A folder of a test's own.
pub(super) struct Folder(PathBuf);

impl Folder {
    pub(super) fn new(name: &str) -> Self {
        let folder = std::env::temp_dir().join(format!("indigo-engine-{}-{name}", std::process::id()));
        drop(std::fs::remove_dir_all(&folder));
        std::fs::create_dir_all(&folder).expect("a folder for the test");
        Self(folder)
    }

    /// With a scene of a million triangles.
    fn with_large_scene(name: &str) -> Self {
        let folder = Self::new(name);
        folder.write("scene.igs", SCENE);
        write_sheet(&folder.0.join("sheet.ply")).expect("the mesh is written");
        folder
    }

    pub(super) fn path(&self, name: &str) -> String {
        self.0.join(name).display().to_string()
    }

    pub(super) fn write(&self, name: &str, text: &str) {
        std::fs::write(self.0.join(name), text).expect("a scene is written");
    }

    /// The request for `scene.igs`.
    fn request(&self) -> Request {
        let arguments = Arguments::default();
        Request {
            path: self.path("scene.igs"),
            part: Part::of(&arguments),
            arguments,
            film: None,
            starts: false,
            halts_at: None,
            kept: None,
        }
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        // Left for the system to clear away, at worst.
        drop(std::fs::remove_dir_all(&self.0));
    }
}

fn write_sheet(path: &Path) -> std::io::Result<()> {
    let [columns, rows] = SHEET;
    let (vertices, triangles) = ((columns + 1) * (rows + 1), 2 * columns * rows);
    let mut file = std::io::BufWriter::new(std::fs::File::create(path)?);
    write!(
        file,
        "ply\nformat binary_little_endian 1.0\nelement vertex {vertices}\nproperty float x\nproperty float y\n\
         property float z\nelement face {triangles}\nproperty list uchar int vertex_indices\nend_header\n"
    )?;
    for row in 0..=rows {
        for column in 0..=columns {
            let (x, z) = (column as f32 / columns as f32 - 0.5, row as f32 / rows as f32 - 0.5);
            for value in [x, 0.1 * (40.0 * x).sin() * (30.0 * z).cos(), z] {
                file.write_all(&value.to_le_bytes())?;
            }
        }
    }
    let at = |row: usize, column: usize| (row * (columns + 1) + column) as i32;
    for row in 0..rows {
        for column in 0..columns {
            let [a, b, c, d] =
                [at(row, column), at(row, column + 1), at(row + 1, column + 1), at(row + 1, column)];
            for corners in [[a, b, c], [a, c, d]] {
                file.write_all(&[3])?;
                for corner in corners {
                    file.write_all(&corner.to_le_bytes())?;
                }
            }
        }
    }
    file.flush()
}

/// The first of the news that something is found in.
fn wait_for<T>(engine: &Engine, what: &str, mut find: impl FnMut(Update) -> Option<T>) -> T {
    let start = Instant::now();
    while start.elapsed() < PATIENCE {
        if let Some(found) = engine.news().into_iter().find_map(&mut find) {
            return found;
        }
        std::thread::sleep(Duration::from_millis(2));
    }
    panic!("there is no {what}");
}

#[test]
fn loading_a_million_triangles_ends_when_it_is_cancelled() {
    let scene = Folder::with_large_scene("stopped");
    let (give, take) = channel();
    let stop = Stop::default();
    load::spawn(7, scene.request(), stop.clone(), give).expect("a thread");
    stop.set();
    let Ok(Command::Loaded(7, outcome)) = take.recv_timeout(PATIENCE) else { panic!("it goes on") };
    assert!(outcome.scene.is_none(), "it was loaded to the end");
}

#[test]
fn the_engine_listens_while_a_million_triangles_are_loaded() {
    let scene = Folder::with_large_scene("listens");
    let engine = Engine::new(&Context::default()).expect("threads");
    let is_phase = |wanted: Phase| {
        move |update: Update| matches!(update, Update::Phase(phase) if phase == wanted).then_some(())
    };
    engine.send(Command::Open(Box::new(scene.request())));
    engine.send(Command::Save(OneFile::Picture, "x.png".into()));
    // An answer to what came later, and nothing of the scene before it.
    wait_for(&engine, "answer", |update| match update {
        Update::Scene(..) => panic!("it waited for the scene"),
        Update::Line(line) => (line.text == words::NOTHING_TO_SAVE).then_some(()),
        _ => None,
    });
    engine.send(Command::Cancel);
    wait_for(&engine, "end of loading", is_phase(Phase::Empty));
    engine.send(Command::Open(Box::new(scene.request())));
    let facts = wait_for(&engine, "scene", |update| match update {
        Update::Scene(facts, _) => Some(facts),
        _ => None,
    });
    assert_eq!(facts.stats.geometry.triangles, 2 * SHEET[0] * SHEET[1]);
}

/// Loads what is asked for, and tells the window's state of it.
fn load_into(state: &mut State, engine: &Engine, request: Request) {
    state.wanted = Some(request.path.clone());
    engine.send(Command::Open(Box::new(request)));
    wait_for(engine, "end of loading", |update| {
        let has_ended = matches!(update, Update::Phase(Phase::Ready | Phase::Empty));
        // The findings and the scene come before.
        state.take(update);
        has_ended.then_some(())
    });
}

/// What was tried out on a scene stays when it is loaded once more, but for what its files say otherwise now; and a scene
/// that cannot be loaded changes nothing of the one that is open.
#[test]
fn what_is_loaded_once_more_is_as_it_was_unless_its_files_changed() {
    let folder = Folder::new("again");
    let scene = even_light();
    let path = |name: &str| folder.path(name);
    folder.write("a.igs", &scene);
    folder.write("broken.igs", "<scene><camera></scene>");

    let engine = Engine::new(&Context::default()).expect("threads");
    let mut state = State::new(Arguments::default(), Recent::default());
    let request = state.request(&path("a.igs"), false);
    load_into(&mut state, &engine, request);
    assert_eq!(state.path, Some(path("a.igs")));
    let scale = |state: &State| state.controls.as_ref().map(|controls| controls.scale);
    assert_eq!(scale(&state), Some(1.0));
    for (phase, starts) in [(Phase::Rendering, true), (Phase::Paused, false), (Phase::Ready, false)] {
        state.phase = phase;
        assert_eq!(state.request_again().map(|request| request.starts), Some(starts), "{:?}", state.phase);
    }
    state.brighten(1.0);
    let work = state.work.as_mut().expect("a scene");
    work.halt_spp = (true, 6);

    let again = state.request_again().expect("a scene");
    assert!(again.arguments.settings.is_empty(), "no mode was chosen");
    load_into(&mut state, &engine, again);
    assert_eq!((scale(&state), state.work.map(|work| work.halt_spp)), (Some(2.0), Some((true, 6))));

    // Changed elements are kept while only another part of the picture is rendered.
    let mut file = SceneFile::read(&path("a.igs")).expect("the scene");
    file.changes.insert(vec![0, 0], "9".to_owned());
    state.file = Some(file);
    let facts = state.facts.clone().expect("a scene");
    state.take(Update::Scene(Box::new(facts), None));
    assert!(state.has_unsaved());

    // Another scene fails, and is what is tried again.
    let request = state.request(&path("broken.igs"), false);
    load_into(&mut state, &engine, request);
    assert_eq!((state.path.clone(), scale(&state)), (Some(path("a.igs")), Some(2.0)));
    assert!(state.request_again().is_none() && state.wanted == Some(path("broken.igs")));

    // Its files say something else of the picture and of when to halt.
    let settings = "<halt_samples_per_pixel>9</halt_samples_per_pixel></renderer_settings>";
    folder.write(
        "a.igs",
        &scene.replace("<scale>1</scale>", "<scale>5</scale>").replace("</renderer_settings>", settings),
    );
    state.wanted.clone_from(&state.path);
    let mode = state.mode.as_mut().expect("a scene");
    (mode.bidirectional, state.mode_is_chosen) = (true, true);
    let again = state.request_again().expect("a scene");
    assert!(again.arguments.settings.iter().any(|o| o.setting == "bidirectional" && o.value == "true"));
    load_into(&mut state, &engine, again);
    assert_eq!((scale(&state), state.work.map(|work| work.halt_spp)), (Some(5.0), Some((true, 9))));
    assert!(state.mode.is_some_and(|mode| mode.bidirectional));
    assert!(state.file.is_none() && state.has_unsaved(), "its elements are others; what was changed waits");
}
