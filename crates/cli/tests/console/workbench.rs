//! A directory with a scene in it, and the program run there.

use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};

/// No run of these tests takes longer, even on a slow and busy machine.
pub const PATIENCE: Duration = Duration::from_mins(2);

/// An empty directory of its own for each test, removed at the end.
pub struct Workbench {
    pub directory: PathBuf,
    /// What programs are started by, if not by themselves.
    pub wrapper: Vec<String>,
}

impl Workbench {
    /// With `scene.igs`, made from settings.
    pub fn new(settings: &str) -> Self {
        static NUMBER: AtomicUsize = AtomicUsize::new(0);
        let name =
            format!("indigo-console-{}-{}", std::process::id(), NUMBER.fetch_add(1, Ordering::Relaxed));
        let directory = std::env::temp_dir().join(name);
        std::fs::create_dir_all(&directory).expect("a directory for the test's files");
        let bench = Self { directory, wrapper: vec![] };
        bench.write("scene.igs", &scene(settings));
        bench
    }

    /// The path of a file.
    pub fn path(&self, name: &str) -> PathBuf {
        self.directory.join(name)
    }

    pub fn write(&self, name: &str, text: &str) {
        std::fs::write(self.path(name), text).expect("the test's own directory");
    }

    /// Names of the files, sorted, without the cache, which is elsewhere for users.
    pub fn files(&self) -> Vec<String> {
        let mut names: Vec<String> = std::fs::read_dir(&self.directory)
            .expect("the test's own directory")
            .map(|e| e.expect("an entry").file_name().to_string_lossy().into_owned())
            .filter(|name| name != "cache")
            .collect();
        names.sort();
        names
    }

    fn command(&self, arguments: &[&str]) -> Command {
        let program = env!("CARGO_BIN_EXE_indigo_console");
        let mut command = match &self.wrapper[..] {
            [] => Command::new(program),
            [wrapper, rest @ ..] => {
                let mut command = Command::new(wrapper);
                command.args(rest).arg(program);
                command
            }
        };
        command
            .args(arguments)
            .current_dir(&self.directory)
            .env("INDIGO_CACHE", self.path("cache"))
            .env_remove("INDIGO_RESOURCES")
            .env_remove("INDIGO_KEY")
            .stdin(Stdio::null());
        command
    }

    /// Runs to the end.
    pub fn run(&self, arguments: &[&str]) -> Ran {
        Ran::from(self.command(arguments).output().expect("the program starts"))
    }

    /// Runs to the end with a variable of the environment set.
    pub fn run_with(&self, name: &str, value: &Path, arguments: &[&str]) -> Ran {
        Ran::from(self.command(arguments).env(name, value).output().expect("the program starts"))
    }

    /// Runs to the end, with standard output going to a file.
    #[cfg(target_os = "linux")]
    pub fn run_into(&self, arguments: &[&str], stdout: std::fs::File) -> Ran {
        let mut command = self.command(arguments);
        Ran::from(
            command
                .stdout(stdout)
                .stderr(Stdio::piped())
                .spawn()
                .and_then(Child::wait_with_output)
                .expect("the program starts"),
        )
    }

    /// Runs to the end with an address space of so many KiB.
    #[cfg(target_os = "linux")]
    pub fn run_in_memory(&self, kib: u64, arguments: &[&str]) -> Ran {
        let mut command = Command::new("sh");
        command
            .args([
                "-c",
                &format!("ulimit -v {kib}; exec \"$0\" \"$@\""),
                env!("CARGO_BIN_EXE_indigo_console"),
            ])
            .args(arguments)
            .current_dir(&self.directory)
            .env("INDIGO_CACHE", self.path("cache"))
            .stdin(Stdio::null());
        Ran::from(command.output().expect("a shell"))
    }

    /// Runs to the end with files limited to so many blocks of 512 bytes; a write beyond is an error, as on a
    /// full disk, not a signal.
    #[cfg(unix)]
    pub fn run_limited(&self, blocks: u64, arguments: &[&str]) -> Ran {
        let program = env!("CARGO_BIN_EXE_indigo_console");
        let mut command = self.command(&[]);
        let mut shell = Command::new("sh");
        shell.arg("-c").arg(format!("trap '' XFSZ; ulimit -f {blocks}; exec \"$0\" \"$@\"")).arg(program);
        shell.args(arguments).current_dir(&self.directory).stdin(Stdio::null());
        command.get_envs().for_each(|(name, value)| match value {
            Some(value) => drop(shell.env(name, value)),
            None => drop(shell.env_remove(name)),
        });
        command.stdin(Stdio::null());
        Ran::from(shell.output().expect("a shell starts"))
    }

    /// Starts, with what it says going to files.
    pub fn start(&self, arguments: &[&str]) -> Running {
        self.start_into(["stdout", "stderr"], arguments)
    }

    /// The same with files that begin with a name.
    pub fn start_as(&self, name: &str, arguments: &[&str]) -> Running {
        self.start_into([&format!("{name}.stdout"), &format!("{name}.stderr")], arguments)
    }

    fn start_into(&self, [stdout, stderr]: [&str; 2], arguments: &[&str]) -> Running {
        let file = |name: &str| std::fs::File::create(self.path(name)).expect("the test's own directory");
        let child = self
            .command(arguments)
            .stdout(file(stdout))
            .stderr(file(stderr))
            .spawn()
            .expect("the program starts");
        Running(child)
    }
}

impl Drop for Workbench {
    fn drop(&mut self) {
        drop(std::fs::remove_dir_all(&self.directory));
    }
}

/// A run that has ended.
#[derive(Debug)]
pub struct Ran {
    pub status: Option<i32>,
    pub stdout: String,
    pub stderr: String,
}

impl From<Output> for Ran {
    fn from(output: Output) -> Self {
        let text = |bytes: Vec<u8>| String::from_utf8(bytes).expect("what it says is text");
        Self { status: output.status.code(), stdout: text(output.stdout), stderr: text(output.stderr) }
    }
}

/// A program on its way; killed if the test ends first.
pub struct Running(pub Child);

impl Running {
    /// The exit status, once it has ended by itself.
    pub fn finish(&mut self) -> Option<i32> {
        let deadline = Instant::now() + PATIENCE;
        loop {
            if let Some(status) = self.0.try_wait().expect("a child of ours") {
                return status.code();
            }
            assert!(Instant::now() < deadline, "the program hangs");
            std::thread::sleep(Duration::from_millis(5));
        }
    }

    /// Waits until a file is there.
    pub fn wait_for(&mut self, file: &Path) {
        self.wait_until(&file.display().to_string(), || file.exists());
    }

    /// Waits until it writes a file, under a name for the time being.
    pub fn wait_for_save(&mut self, bench: &Workbench, name: &str) {
        let start = format!("{name}.{}.", self.0.id());
        self.wait_until(&start, || bench.files().iter().any(|file| file.starts_with(&start)));
    }

    fn wait_until(&mut self, what: &str, is_there: impl Fn() -> bool) {
        let deadline = Instant::now() + PATIENCE;
        while !is_there() {
            assert!(self.0.try_wait().expect("a child of ours").is_none(), "the program ended early");
            assert!(Instant::now() < deadline, "{what} does not appear");
            std::thread::sleep(Duration::from_millis(2));
        }
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        // It may have ended already.
        drop(self.0.kill());
        drop(self.0.wait());
    }
}

/// A grey sphere in uniform light, 40 by 30 pixels unless the settings say otherwise.
pub fn scene(settings: &str) -> String {
    let size = if settings.contains("<width>") { "" } else { "<width>40</width><height>30</height>" };
    format!(
        "<scene>
<renderer_settings>{size}{settings}
    <metropolis>false</metropolis><bidirectional>false</bidirectional>
    <aperture_diffraction>false</aperture_diffraction>
</renderer_settings>
<camera><pos>0 0 0</pos><up>0 0 1</up><forwards>0 1 0</forwards><aperture_radius>0.01</aperture_radius>
    <focus_distance>4</focus_distance><aspect_ratio>1.333333</aspect_ratio><sensor_width>0.036</sensor_width>
    <lens_sensor_dist>0.03</lens_sensor_dist></camera>
<material><name>grey</name><diffuse><albedo_spectrum><uniform><value>0.5</value></uniform></albedo_spectrum></diffuse></material>
<sphere><center>0 4 0</center><radius>1</radius><material_name>grey</material_name></sphere>
<background><spectrum><uniform><value>1e5</value></uniform></spectrum></background>
<tonemapping><reinhard><pre_scale>4</pre_scale><post_scale>1</post_scale><burn>6</burn></reinhard></tonemapping>
</scene>
"
    )
}

/// Says that a file is a whole picture of some size.
#[track_caller]
pub fn assert_picture(path: &Path, width: u32, height: u32) {
    let bytes = std::fs::read(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    let image = indigo_formats::image::decode(&path.to_string_lossy(), &bytes)
        .unwrap_or_else(|e| panic!("{}, {} bytes: {e:?}", path.display(), bytes.len()));
    assert_eq!((image.width, image.height), (width, height));
}
