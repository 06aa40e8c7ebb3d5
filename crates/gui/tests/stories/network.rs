//! Renders of many machines: the window and the console on one of them, with a key as between many.

use super::screen::{Screen, keys, scratch};
use super::{LARGE, ask_to_close, noisy_box, wait_for_picture};
use indigo_film::igi;
use std::net::{Ipv4Addr, TcpListener};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::OnceLock;
use std::time::{Duration, Instant};

/// Longer than anything takes here, even on a busy machine.
const PATIENCE: Duration = Duration::from_mins(2);

/// The console of this build. It is another package's, so that cargo has to be asked for it; by a test of that package, so that
/// features are those of this build, and nothing is built twice.
fn console() -> &'static Path {
    static CONSOLE: OnceLock<PathBuf> = OnceLock::new();
    CONSOLE.get_or_init(|| {
        let window = Path::new(env!("CARGO_BIN_EXE_indigo"));
        let folder = window.parent().expect("a program is in a folder");
        let profile = match folder.file_name().and_then(|name| name.to_str()).expect("a profile's name") {
            "debug" => "test",
            profile => profile,
        };
        let build = ["test", "--workspace", "--no-run", "--test", "console", "--profile", profile];
        let mut cargo = Command::new(env!("CARGO"));
        // What cargo tells this test of its package is news to build scripts, which would run again, here and at the next build.
        for (name, _) in std::env::vars_os() {
            if ["CARGO_PKG_", "CARGO_MANIFEST_"].iter().any(|own| name.to_string_lossy().starts_with(own)) {
                cargo.env_remove(name);
            }
        }
        let built = cargo.args(build).current_dir(env!("CARGO_MANIFEST_DIR")).output().expect("cargo starts");
        assert!(built.status.success(), "{}", String::from_utf8_lossy(&built.stderr));
        folder.join(format!("indigo_console{}", std::env::consts::EXE_SUFFIX))
    })
}

/// A console that goes when the story ends.
struct Console(Child);

impl Console {
    /// Starts one that writes what it says to `said` in the folder.
    fn start(folder: &Path, arguments: &[&str]) -> Self {
        let said = std::fs::File::create(folder.join("said")).expect("a file for what it says");
        let child = Command::new(console())
            .args(arguments)
            .current_dir(folder)
            .env("INDIGO_CACHE", folder)
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .stderr(said)
            .spawn();
        Self(child.expect("the console starts"))
    }

    /// Waits until it has ended; whether it did well.
    fn wait(&mut self) -> bool {
        let start = Instant::now();
        while start.elapsed() < PATIENCE {
            if let Some(status) = self.0.try_wait().expect("a child of ours") {
                return status.success();
            }
            std::thread::sleep(Duration::from_millis(20));
        }
        panic!("the console does not end");
    }
}

impl Drop for Console {
    fn drop(&mut self) {
        // At worst it has ended already.
        drop(self.0.kill());
        drop(self.0.wait());
    }
}

fn said(folder: &Path) -> String {
    std::fs::read_to_string(folder.join("said")).unwrap_or_default()
}

fn make_key(folder: &Path) {
    let made = Command::new(console()).args(["--make-key", "key"]).current_dir(folder).output();
    assert!(made.expect("the console starts").status.success());
}

#[test]
fn a_window_gathers_what_a_slave_renders() {
    let folder = scratch("master");
    let scene = noisy_box(&folder);
    make_key(&folder);
    // Nobody else is likely to take it within the second that the window needs.
    let free = TcpListener::bind((Ipv4Addr::LOCALHOST, 0)).expect("a port");
    let port = free.local_addr().expect("an address").port().to_string();
    drop(free);
    let master = [&*scene, "-n", "m", "-p", &port, "--key-file", "key", "-o", "box.png"];
    let mut screen = Screen::start(&folder, LARGE, &master);
    let at = format!("127.0.0.1:{port}");
    let slave = ["-n", "s", "-h", &at, "--key-file", "key", "-t", "1", "-verbose"];
    let mut slave = Console::start(&folder, &slave);
    // All light is the slave's: a master alone renders nothing.
    wait_for_picture(&mut screen);
    screen.press(&[keys::CONTROL, u32::from(b'5')]);
    std::thread::sleep(Duration::from_secs(1));
    screen.see().keep("master");
    ask_to_close(&mut screen);
    screen.press(&[keys::SPACE]);
    assert!(screen.wait_for_end());
    let film = std::fs::read(folder.join("box.igi")).expect("a master always saves its film");
    let film = igi::read(&film).expect("a sound film");
    assert!(film.record.is_some_and(|record| record.samples > 0), "the slave's samples");
    let text = said(&folder);
    assert!(text.contains("Sent ") && text.contains("The master has ended the render"), "{text}");
    assert!(slave.0.try_wait().expect("a child of ours").is_none(), "a slave waits for the next master");
    std::fs::remove_dir_all(&folder).expect("the story's own files");
}

#[test]
fn a_window_renders_for_a_master() {
    let folder = scratch("slave");
    let scene = noisy_box(&folder);
    make_key(&folder);
    let master = [&*scene, "-n", "m", "-p", "0", "--key-file", "key", "-o", "box.png", "-haltspp", "8"];
    let mut master = Console::start(&folder, &master);
    let start = Instant::now();
    let port = loop {
        let text = said(&folder);
        let told = text.split("at port ").nth(1).and_then(|rest| rest.split_once('\n'));
        if let Some((port, _)) = told {
            break port.to_owned();
        }
        assert!(start.elapsed() < PATIENCE, "the master tells no port: {text}");
        std::thread::sleep(Duration::from_millis(20));
    };
    let at = format!("127.0.0.1:{port}");
    let mut screen = Screen::start(&folder, LARGE, &["-n", "s", "-h", &at, "--key-file", "key"]);
    assert!(master.wait(), "{}", said(&folder));
    assert!(folder.join("box.png").exists(), "the window rendered it");
    std::thread::sleep(Duration::from_secs(1));
    screen.press(&[keys::CONTROL, u32::from(b'5')]);
    screen.see().keep("slave");
    // Nothing is lost by closing: there is nothing to be asked.
    screen.ask_to_close();
    assert!(screen.wait_for_end());
    std::fs::remove_dir_all(&folder).expect("the story's own files");
}
