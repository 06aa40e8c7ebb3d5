//! How long `indigo_console --tonemap` takes for a picture of 2 megapixels: the whole command, from its start to the PNG on the
//! disk, with the default settings (diffraction as a filter) and without diffraction, super-sampled twice and not.
//! The best of five runs, the one least disturbed by other programs.

use indigo_film::{FilmRecord, FilmSize, FilmState, LayerKind, Run, igi};
use std::path::Path;
use std::process::Command;
use std::time::Instant;

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

fn best(folder: &Path, name: &str, film: &str) {
    let mut least = f64::INFINITY;
    for _ in 0..5 {
        let start = Instant::now();
        let ran = Command::new(env!("CARGO_BIN_EXE_indigo_console"))
            .args(["--tonemap", "scene.igs", film, "picture.png"])
            .current_dir(folder)
            .output()
            .expect("the program starts");
        least = least.min(start.elapsed().as_secs_f64());
        assert!(ran.status.success(), "{}", String::from_utf8_lossy(&ran.stderr));
    }
    println!("{name}: {:.0} ms", least * 1e3);
}

fn main() {
    let folder = std::env::temp_dir().join(format!("indigo-tonemap-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder of its own");
    for super_sample in [2, 1] {
        let record = FilmRecord {
            runs: vec![Run { seed: 0, first: 0, end: 1 }],
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
