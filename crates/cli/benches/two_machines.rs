//! What a second process adds: a working master and a slave, each with one thread, against one process with one thread.
//! Two processes that know nothing of each other tell what the machine has to give.
//!
//! `cargo bench -p indigo-cli --bench two_machines`. The machine must be otherwise idle, and have two cores.

use std::path::Path;
use std::process::{Child, Command, Stdio};

/// Seconds of each run; the first few, in which a slave loads the scene, do not count.
const RUN_S: u64 = 24;
const WARM_UP_S: f64 = 8.0;
/// Runs of each kind, in turns.
const RUNS: usize = 5;
/// A glass ball and a grey one in a room of light: bidirectional, as scenes are by default.
const SCENE: &str = "<scene>
<renderer_settings><width>640</width><height>480</height><metropolis>false</metropolis><logging>false</logging>
    <display_period>1</display_period><frame_upload_period>2</frame_upload_period></renderer_settings>
<camera><pos>0 -1 1</pos><up>0 0 1</up><forwards>0 1 -0.1</forwards><aperture_radius>0.01</aperture_radius>
    <focus_distance>4</focus_distance><aspect_ratio>1.333333</aspect_ratio><sensor_width>0.036</sensor_width>
    <lens_sensor_dist>0.03</lens_sensor_dist></camera>
<material><name>grey</name><diffuse><albedo_spectrum><uniform><value>0.5</value></uniform></albedo_spectrum></diffuse></material>
<sphere><center>0 4 0.5</center><radius>1</radius><material_name>grey</material_name></sphere>
<sphere><center>0 4 -50</center><radius>49.5</radius><material_name>grey</material_name></sphere>
<background><spectrum><uniform><value>1e5</value></uniform></spectrum></background>
<tonemapping><reinhard><pre_scale>4</pre_scale><post_scale>1</post_scale><burn>6</burn></reinhard></tonemapping>
</scene>
";

fn start(folder: &Path, arguments: &[&str]) -> Child {
    Command::new(env!("CARGO_BIN_EXE_indigo_console"))
        .args(arguments)
        .current_dir(folder)
        .env("INDIGO_CACHE", folder.join("cache"))
        .env_remove("INDIGO_KEY")
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .expect("the program starts")
}

/// Samples per second between the end of the warm-up and the end of the run, by the log.
fn rate(log: &str) -> f64 {
    let number = |line: &str, name: &str| -> Option<f64> {
        let rest = line.split(&format!("\"{name}\":")).nth(1)?;
        rest.split([',', '}']).next()?.parse().ok()
    };
    let points: Vec<(f64, f64)> = log
        .lines()
        .filter(|line| line.contains("\"level\":\"progress\""))
        .filter_map(|line| Some((number(line, "elapsed_s")?, number(line, "samples")?)))
        .filter(|(elapsed, _)| *elapsed >= WARM_UP_S && *elapsed < RUN_S as f64)
        .collect();
    let (first, last) = (points.first().expect("a first line"), points.last().expect("a last line"));
    (last.1 - first.1) / (last.0 - first.0)
}

/// Who renders beside the process that is measured.
#[derive(Clone, Copy)]
enum Other {
    Nobody,
    Slave,
    Stranger,
}

/// Samples per second of a process with one thread, and of whoever renders beside it.
fn measure(folder: &Path, name: &str, more: &[&str], other: Other) -> f64 {
    let process = |name: &str, more: &[&str]| {
        let (seconds, log, picture) = (RUN_S.to_string(), format!("{name}.json"), format!("{name}.png"));
        drop(std::fs::remove_file(folder.join(&log)));
        let arguments = ["scene.igs", "-t", "1", "-halt", &seconds, "--log-json", &log, "-o", &picture];
        start(folder, &[&arguments[..], more].concat())
    };
    let rate =
        |name: &str| rate(&std::fs::read_to_string(folder.join(format!("{name}.json"))).expect("a log"));
    let mut main = process(name, more);
    match other {
        Other::Nobody => {
            assert!(main.wait().expect("a child of ours").success());
            rate(name)
        }
        Other::Slave => {
            let mut slave = start(folder, &["-n", "s", "-h", "127.0.0.1:17777", "-t", "1"]);
            assert!(main.wait().expect("a child of ours").success());
            slave.kill().expect("a child of ours");
            slave.wait().expect("a child of ours");
            // The master counts the samples of both.
            rate(name)
        }
        Other::Stranger => {
            let mut stranger = process("stranger", &["-seed", "1"]);
            for child in [&mut main, &mut stranger] {
                assert!(child.wait().expect("a child of ours").success());
            }
            rate(name) + rate("stranger")
        }
    }
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

fn main() {
    let folder = std::env::temp_dir().join(format!("indigo-two-machines-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder");
    std::fs::write(folder.join("scene.igs"), SCENE).expect("a scene");
    let (mut together, mut apart) = (vec![], vec![]);
    for run in 0..RUNS {
        let one = measure(&folder, "one", &[], Other::Nobody);
        let two = measure(&folder, "two", &["-n", "wm", "-p", "17777"], Other::Slave);
        let strangers = measure(&folder, "apart", &[], Other::Stranger);
        let (pair, strangers) = (two / one, strangers / one);
        println!(
            "run {run}: {one:.0} samples/s by one process; {pair:.3} times as many by master and slave, {strangers:.3} by two apart"
        );
        together.push(pair);
        apart.push(strangers);
    }
    println!("median: {:.3} by master and slave, {:.3} by two apart", median(together), median(apart));
    std::fs::remove_dir_all(folder).expect("our own folder");
}
