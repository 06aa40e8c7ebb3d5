//! A master and its slaves, as processes of their own.

use super::accounts::Log;
use super::workbench::{PATIENCE, Running, Workbench};
use indigo_film::{SavedFilm, igi};
use std::process::Command;
use std::time::{Duration, Instant};

/// Uploads and saves follow each other quickly, so that a short story has many.
pub const HASTE: &str =
    "<logging>false</logging><frame_upload_period>0.4</frame_upload_period><save_igi>true</save_igi>";

/// Where a master and its slaves work.
pub struct Farm {
    pub bench: Workbench,
    pub master: Option<Running>,
    pub port: u16,
    starts: usize,
}

impl Farm {
    /// With a key, and a scene of these settings.
    pub fn new(settings: &str) -> Self {
        Self::saving_each(0.25, settings)
    }

    /// The same with so many seconds from one save to the next.
    pub fn saving_each(seconds: f64, settings: &str) -> Self {
        let period = format!("<image_save_period>{seconds}</image_save_period>");
        let bench = Workbench::new(&format!("{HASTE}{period}{settings}"));
        let made = bench.run(&["--make-key", "key"]);
        assert_eq!(made.status, Some(0), "{made:?}");
        Self { bench, master: None, port: 0, starts: 0 }
    }

    /// Starts a master with more arguments, at the port of the one before, if there was one.
    pub fn start_master(&mut self, role: &str, more: &[&str]) {
        self.starts += 1;
        let name = format!("master{}", self.starts);
        let (port, log) = (self.port.to_string(), format!("{name}.json"));
        let mut arguments = vec!["scene.igs", "-n", role, "-p", &port, "--key-file", "key", "-o", "a.png"];
        arguments.extend(["--log-json", &log, "-verbose", "-t", "1"]);
        arguments.extend(more);
        self.master = Some(self.bench.start_as(&name, &arguments));
        let said = format!("{name}.stderr");
        self.wait(&said, "at port ");
        let text = self.text(&said);
        let port = text.split("at port ").nth(1).and_then(|rest| rest.split_whitespace().next());
        self.port = port.and_then(|port| port.parse().ok()).unwrap_or_else(|| panic!("{text}"));
    }

    /// Goes on with the film of a master that is no more.
    pub fn resume_master(&mut self, role: &str) {
        self.start_master(role, &["-r", "a.igi"]);
    }

    /// Starts a slave with that seed, which finds the master at that port.
    pub fn slave(&self, seed: u64, port: u16) -> Running {
        self.start_slave(seed, &["-h", &format!("127.0.0.1:{port}")])
    }

    /// Starts a slave with that seed, which has to look for a master.
    #[cfg(target_os = "linux")]
    pub fn searching_slave(&self, seed: u64) -> Running {
        self.start_slave(seed, &[])
    }

    fn start_slave(&self, seed: u64, more: &[&str]) -> Running {
        let (name, log, seed) = (format!("slave{seed}"), format!("slave{seed}.json"), seed.to_string());
        let mut arguments = vec!["-n", "s", "--key-file", "key", "-seed", &seed, "-t", "1"];
        arguments.extend(["--log-json", &log, "-verbose"]);
        arguments.extend(more);
        self.bench.start_as(&name, &arguments)
    }

    /// What a process has said so far.
    pub fn text(&self, file: &str) -> String {
        std::fs::read_to_string(self.bench.path(file)).unwrap_or_default()
    }

    /// Waits until a file holds a text, at least so many times.
    pub fn wait_for_times(&self, file: &str, what: &str, times: usize) {
        let deadline = Instant::now() + PATIENCE;
        while self.text(file).matches(what).count() < times {
            assert!(
                Instant::now() < deadline,
                "{file} does not say {what:?} {times} times:\n{}",
                self.text(file)
            );
            std::thread::sleep(Duration::from_millis(10));
        }
    }

    /// Waits until a file holds a text.
    pub fn wait(&self, file: &str, what: &str) {
        self.wait_for_times(file, what, 1);
    }

    /// Waits until a slave has had so many more of its uploads acknowledged.
    pub fn wait_for_uploads(&self, seed: u64, more: usize) {
        let file = format!("slave{seed}.json");
        let before = self.text(&file).matches("\"event\":\"sent\"").count();
        self.wait_for_times(&file, "\"event\":\"sent\"", before + more);
    }

    /// Kills the master without warning.
    pub fn kill_master(&mut self) {
        let mut master = self.master.take().expect("there is one");
        kill(&mut master);
    }

    /// Asks the master to end in good order, and waits for that.
    pub fn end_master(&mut self) {
        let mut master = self.master.take().expect("there is one");
        interrupt(&master);
        assert_eq!(master.finish(), Some(0), "{}", self.text(&format!("master{}.stderr", self.starts)));
    }

    pub fn film(&self) -> SavedFilm {
        igi::read(&std::fs::read(self.bench.path("a.igi")).expect("the film")).expect("a sound film")
    }

    /// The logs of all masters and slaves.
    pub fn logs(&self) -> Vec<Log> {
        let names = self.bench.files();
        let is_log = |name: &&String| name.contains(".json");
        names.iter().filter(is_log).map(|name| Log(self.text(name))).collect()
    }
}

/// Kills a process without warning.
pub fn kill(running: &mut Running) {
    running.0.kill().expect("a child of ours");
    running.0.wait().expect("a child of ours");
}

/// A slave that is told to stop does so in good order.
pub fn leave(slave: &mut Running) {
    interrupt(slave);
    assert_eq!(slave.finish(), Some(0));
}

/// As Ctrl-C does.
pub fn interrupt(running: &Running) {
    signal(running, "-INT");
}

/// Sends a signal.
pub fn signal(running: &Running, signal: &str) {
    let sent =
        Command::new("kill").args([signal, &running.0.id().to_string()]).status().expect("the command kill");
    assert!(sent.success());
}
