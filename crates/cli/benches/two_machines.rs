//! What a second process adds: a working master and a slave, each with one thread, against one process with one thread.
//! Two processes that know nothing of each other tell what the machine has to give.
//!
//! `cargo bench --workspace --bench two_machines`: five minutes. The machine must be otherwise idle, have two cores and run Linux.
//!
//! All five processes live through the whole of the bench, and take turns: all but those whose turn it is are halted
//! (SIGSTOP). A machine that is faster in one minute than in the next is so for all three kinds alike.

use std::io::{Read, Write};
use std::net::TcpStream;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

/// Each kind's turn, well within the half minute after which master and slave would take one another for dead.
const TURN: Duration = Duration::from_secs(4);
const ROUNDS: usize = 24;
/// In these a slave fetches the scene and all get going; they do not count.
const FIRST_ROUNDS: usize = 3;
const PORT: &str = "17777";
const PAGE: &str = "17778";
/// A glass ball and a grey one in a room of light: bidirectional, as scenes are by default.
const SCENE: &str = "<scene>
<renderer_settings><width>640</width><height>480</height><metropolis>false</metropolis><logging>false</logging>
    <display_period>1</display_period></renderer_settings>
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

/// A process of ours, which ends with this.
struct Process(Child);

impl Process {
    fn new(folder: &Path, arguments: &[&str]) -> Self {
        let child = Command::new(env!("CARGO_BIN_EXE_indigo_console"))
            .args(arguments)
            .current_dir(folder)
            .env("INDIGO_CACHE", folder.join("cache"))
            .env_remove("INDIGO_KEY")
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn();
        Self(child.expect("the program starts"))
    }

    /// One that renders by itself, or as arguments say.
    fn rendering(folder: &Path, name: &str, more: &[&str]) -> Self {
        let (log, picture) = (format!("{name}.json"), format!("{name}.png"));
        let arguments = ["scene.igs", "-t", "1", "--log-json", &log, "-o", &picture];
        Self::new(folder, &[&arguments[..], more].concat())
    }

    fn signal(&self, signal: &str) {
        let status = Command::new("kill").args([signal, &self.0.id().to_string()]).status();
        assert!(status.expect("kill is there").success(), "a process of ours ended early");
    }

    /// Seconds of a processor that it has had (proc(5): utime and stime, in hundredths).
    fn processor_s(&self) -> f64 {
        let text = std::fs::read_to_string(format!("/proc/{}/stat", self.0.id())).expect("a process of ours");
        let after_name = text.rsplit(')').next().expect("a name");
        let number = |at: usize| after_name.split_whitespace().nth(at).and_then(|n| n.parse::<f64>().ok());
        (number(11).expect("utime") + number(12).expect("stime")) / 100.0
    }
}

impl Drop for Process {
    fn drop(&mut self) {
        // That it is gone already is as good.
        drop(self.0.kill());
        drop(self.0.wait());
    }
}

fn number(line: &str, name: &str) -> Option<f64> {
    let rest = line.split(&format!("\"{name}\":")).nth(1)?;
    rest.split([',', '}']).next()?.parse().ok()
}

/// Samples that a process has told of in its log.
fn logged(folder: &Path, name: &str) -> f64 {
    let log = std::fs::read_to_string(folder.join(format!("{name}.json"))).unwrap_or_default();
    log.lines().rev().find_map(|line| number(line, "samples")).unwrap_or(0.0)
}

/// Samples of a master and its slave, by the status page: those in the film, and those that the slave has yet to send.
fn of_master() -> f64 {
    let ask = || -> std::io::Result<String> {
        let mut page = TcpStream::connect(format!("127.0.0.1:{PAGE}"))?;
        page.write_all(b"GET /status.json HTTP/1.1\r\nHost: 127.0.0.1\r\nConnection: close\r\n\r\n")?;
        let mut answer = String::new();
        page.read_to_string(&mut answer)?;
        Ok(answer)
    };
    let answer = ask().unwrap_or_default();
    number(&answer, "samples").unwrap_or(0.0) + number(&answer, "waiting_samples").unwrap_or(0.0)
}

/// Who takes turns: their processes, and how many samples they have made so far.
struct Kind<'a> {
    processes: Vec<Process>,
    samples: Box<dyn Fn() -> f64 + 'a>,
    /// Of the turns that count.
    turns_s: f64,
    first: [f64; 2],
}

impl Kind<'_> {
    fn new<'a>(processes: Vec<Process>, samples: impl Fn() -> f64 + 'a) -> Kind<'a> {
        Kind { processes, samples: Box::new(samples), turns_s: 0.0, first: [0.0; 2] }
    }

    /// Samples, and seconds of processors.
    fn now(&self) -> [f64; 2] {
        [(self.samples)(), self.processes.iter().map(Process::processor_s).sum()]
    }

    fn take_turn(&mut self, counts: bool) {
        let started = Instant::now();
        self.processes.iter().for_each(|process| process.signal("-CONT"));
        sleep(TURN);
        if !counts {
            self.first = self.now();
        }
        self.processes.iter().for_each(|process| process.signal("-STOP"));
        if counts {
            self.turns_s += started.elapsed().as_secs_f64();
        }
    }

    /// Samples per second, samples per second of a processor, and processors.
    fn rates(&self) -> [f64; 3] {
        self.processes.iter().for_each(|process| process.signal("-CONT"));
        let now = self.now();
        let [samples, processor_s] = [now[0] - self.first[0], now[1] - self.first[1]];
        [samples / self.turns_s, samples / processor_s, processor_s / self.turns_s]
    }
}

fn main() {
    let folder = std::env::temp_dir().join(format!("indigo-two-machines-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder");
    std::fs::write(folder.join("scene.igs"), SCENE).expect("a scene");
    let rendering = |name: &str, more: &[&str]| Process::rendering(&folder, name, more);
    let one = Kind::new(vec![rendering("one", &[])], || logged(&folder, "one"));
    let master = rendering("two", &["-n", "wm", "-p", PORT, "--status-port", PAGE]);
    let slave =
        Process::new(&folder, &["-n", "s", "-h", &format!("127.0.0.1:{PORT}"), "-t", "1", "-seed", "2"]);
    let two = Kind::new(vec![master, slave], of_master);
    let strangers = vec![rendering("apart", &["-seed", "3"]), rendering("stranger", &["-seed", "4"])];
    let apart = Kind::new(strangers, || logged(&folder, "apart") + logged(&folder, "stranger"));
    let mut kinds = [one, two, apart];
    for kind in &kinds {
        kind.processes.iter().for_each(|process| process.signal("-STOP"));
    }
    for round in 0..ROUNDS {
        for kind in &mut kinds {
            kind.take_turn(round >= FIRST_ROUNDS);
        }
    }
    let [one, two, apart] = kinds.map(|kind| kind.rates());
    for (name, kind) in [("one process", one), ("master and slave", two), ("two processes apart", apart)] {
        println!(
            "{name}: {:.0} samples/s, {:.3} times those of one process; {:.3} processors; {:.0} samples per second of a \
             processor, {:.3} of one process's",
            kind[0],
            kind[0] / one[0],
            kind[2],
            kind[1],
            kind[1] / one[1]
        );
    }
    std::fs::remove_dir_all(folder).expect("our own folder");
}
