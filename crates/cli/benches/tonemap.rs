//! How long `indigo_console --tonemap` takes for a picture of 2 megapixels: the whole command, from its start to the PNG on the
//! disk, with the default settings (diffraction as a filter) and without diffraction, super-sampled twice and not.
//! The best of five runs, the one least disturbed by other programs, with the time of all processors together and
//! the most memory that it had.

use indigo_film::{FilmRecord, FilmSize, FilmState, LayerKind, Run, igi};
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// Size of the picture.
const SIZE: [u32; 2] = [1632, 1224];

/// A film of noisy gradients with a lamp in it, as a render makes them.
fn film(super_sample: u32) -> FilmState {
    let size = FilmSize::new(SIZE[0], SIZE[1], super_sample).expect("a good size");
    let mut film = FilmState::new(size, &[(LayerKind::PerPixel, "camera")]);
    let width = size.internal_width() as usize;
    let layer = &mut film.layers[0];
    for (i, (sum, count)) in layer.sums.iter_mut().zip(&mut layer.counts).enumerate() {
        let noise = (i as u64).wrapping_mul(0x9E37_79B9_7F4A_7C15) >> 40;
        let is_lamp = i % width < 40 && i / width < 40;
        let v =
            if is_lamp { 1e6 } else { 10.0 + (i % 4000) as f64 * 0.1 + noise as f64 / f64::from(1 << 24) };
        // Sums of single-precision numbers, as they come.
        *sum = [v * 3.8, v * 4.0, v * 3.0, 4.0].map(|v| f64::from(v as f32));
        *count = 4.0;
    }
    film
}

fn scene(super_sample: u32, settings: &str) -> String {
    format!(
        "<scene><renderer_settings><width>{}</width><height>{}</height><logging>false</logging>
<super_sample_factor>{super_sample}</super_sample_factor>{settings}</renderer_settings>
<camera><pos>0 0 0</pos><up>0 0 1</up><forwards>0 1 0</forwards><aperture_radius>0.002</aperture_radius>
<focus_distance>4</focus_distance><aspect_ratio>1.3333333</aspect_ratio><sensor_width>0.036</sensor_width>
<lens_sensor_dist>0.03</lens_sensor_dist></camera>
<background><spectrum><uniform><value>1e5</value></uniform></spectrum></background>
<tonemapping><reinhard><pre_scale>4</pre_scale><post_scale>1</post_scale></reinhard></tonemapping></scene>",
        SIZE[0], SIZE[1]
    )
}

/// What a run took.
#[derive(Clone, Copy)]
struct Cost {
    wall_s: f64,
    /// Of all threads together, in hundredths of a second as the system counts; 0 where it does not tell.
    cpu_s: f64,
    peak_bytes: f64,
}

fn run(folder: &Path, film: &str) -> Cost {
    let start = Instant::now();
    let mut child = Command::new(env!("CARGO_BIN_EXE_indigo_console"))
        .args(["--tonemap", "scene.igs", film, "picture.png"])
        .current_dir(folder)
        .stdout(Stdio::null())
        .spawn()
        .expect("the program starts");
    let mut cost = Cost { wall_s: 0.0, cpu_s: 0.0, peak_bytes: 0.0 };
    // Nobody has asked how it ended, so what Linux knows of it stays to be read: until its state is Z.
    while let Some((state, cpu_s)) = processor_time(child.id()) {
        cost.peak_bytes = peak_memory(child.id()).unwrap_or(cost.peak_bytes);
        cost.cpu_s = cpu_s;
        if state == "Z" {
            break;
        }
        std::thread::sleep(Duration::from_millis(1));
    }
    let status = child.wait().expect("it is ours");
    cost.wall_s = start.elapsed().as_secs_f64();
    assert!(status.success());
    cost
}

/// State of a process, and seconds that its threads have run.
fn processor_time(process: u32) -> Option<(String, f64)> {
    const TICKS_PER_SECOND: f64 = 100.0;
    let text = std::fs::read_to_string(format!("/proc/{process}/stat")).ok()?;
    // Behind the name, which may hold anything: the state is the third field, times are the 14th and the 15th.
    let fields: Vec<&str> = text.rsplit_once(')')?.1.split_whitespace().collect();
    let ticks = |field: usize| fields.get(field - 3)?.parse::<f64>().ok();
    Some(((*fields.first()?).to_owned(), (ticks(14)? + ticks(15)?) / TICKS_PER_SECOND))
}

fn peak_memory(process: u32) -> Option<f64> {
    let text = std::fs::read_to_string(format!("/proc/{process}/status")).ok()?;
    let line = text.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    Some(line.trim().strip_suffix(" kB")?.parse::<f64>().ok()? * 1024.0)
}

fn best(folder: &Path, name: &str, film: &str) {
    let runs = (0..5).map(|_| run(folder, film));
    let Some(Cost { wall_s, cpu_s, peak_bytes }) = runs.min_by(|a, b| a.wall_s.total_cmp(&b.wall_s)) else {
        return;
    };
    println!(
        "{name}: {:.0} ms, {:.0} ms of processors, {:.0} MB",
        wall_s * 1e3,
        cpu_s * 1e3,
        peak_bytes / 1e6
    );
}

fn main() {
    let folder = std::env::temp_dir().join(format!("indigo-tonemap-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder of its own");
    for super_sample in [2, 1] {
        let record = FilmRecord {
            runs: vec![Run { seed: 0, first: 0, end: 1 }],
            settings: vec![(indigo_scene::FOREGROUND_ALPHA.to_owned(), "false".to_owned())],
            samples: u64::from(SIZE[0] * SIZE[1] * super_sample * super_sample * 4),
            ..FilmRecord::default()
        };
        let file = std::fs::File::create(folder.join("film.igi")).expect("a file");
        igi::write(&mut std::io::BufWriter::new(file), &film(super_sample), &record).expect("a film");
        for (what, settings) in
            [("", ""), (", no diffraction", "<aperture_diffraction>false</aperture_diffraction>")]
        {
            std::fs::write(folder.join("scene.igs"), scene(super_sample, settings)).expect("a scene");
            best(&folder, &format!("2 megapixels, super-sampled {super_sample}{what}"), "film.igi");
        }
    }
    std::fs::remove_dir_all(folder).expect("the folder is there");
}
