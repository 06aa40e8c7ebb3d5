//! A screen with a window on it: keys, and what is seen.

use indigo_imaging::{Metadata, Picture, png};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};
use x11rb::connection::Connection as _;
use x11rb::protocol::xproto::{
    Atom, BUTTON_PRESS_EVENT, BUTTON_RELEASE_EVENT, ClientMessageEvent, ConnectionExt as _, EventMask,
    ImageFormat, InputFocus, KEY_PRESS_EVENT, KEY_RELEASE_EVENT, MOTION_NOTIFY_EVENT, Window as WindowId,
};
use x11rb::protocol::xtest::ConnectionExt as _;
use x11rb::rust_connection::RustConnection;

/// Longer than anything takes here, even on a busy machine without a graphics card.
const PATIENCE: Duration = Duration::from_mins(2);
/// Windows of other tests would lie on top.
static SCREEN: Mutex<()> = Mutex::new(());

/// Keys by their symbols (X11/keysymdef.h).
pub mod keys {
    pub const CONTROL: u32 = 0xffe3;
    pub const ESCAPE: u32 = 0xff1b;
    pub const RETURN: u32 = 0xff0d;
    pub const END: u32 = 0xff57;
    pub const TAB: u32 = 0xff09;
    pub const F2: u32 = 0xffbf;
    pub const BRACKET_LEFT: u32 = 0x5b;
    pub const BRACKET_RIGHT: u32 = 0x5d;
    pub const BACKSPACE: u32 = 0xff08;
    pub const SPACE: u32 = 0x20;
}

/// What is seen in a rectangle.
pub struct Seen {
    pub width: usize,
    pub height: usize,
    /// Red, green and blue.
    pub pixels: Vec<[u8; 3]>,
}

impl Seen {
    /// The mean of each channel over the middle of the picture's area, in display-linear light.
    pub fn light(&self) -> [f64; 3] {
        let mut sum = [0.0; 3];
        for pixel in &self.pixels {
            for (sum, &code) in sum.iter_mut().zip(pixel) {
                let value = f64::from(code) / 255.0;
                *sum += if value <= 0.04045 { value / 12.92 } else { ((value + 0.055) / 1.055).powf(2.4) };
            }
        }
        sum.map(|sum| sum / self.pixels.len() as f64)
    }

    /// Keeps it for people to look at.
    pub fn keep(&self, name: &str) {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../target/window");
        std::fs::create_dir_all(&folder).expect("a folder for pictures");
        let linear = |code: u8| {
            let value = f32::from(code) / 255.0;
            if value <= 0.04045 { value / 12.92 } else { ((value + 0.055) / 1.055).powf(2.4) }
        };
        let pixels = self.pixels.iter().map(|&[r, g, b]| [linear(r), linear(g), linear(b), 1.0]).collect();
        let picture = Picture { width: self.width as u32, height: self.height as u32, pixels };
        let format = png::Format { depth: png::Depth::Eight, dithered: false };
        let bytes = png::encode(&picture, &Metadata::default(), format).expect("a picture");
        std::fs::write(folder.join(format!("{name}.png")), bytes).expect("the picture is written");
    }
}

/// The program with its window.
pub struct Screen {
    connection: RustConnection,
    root: WindowId,
    window: WindowId,
    pub program: Child,
    size: [u16; 2],
    _alone: MutexGuard<'static, ()>,
}

/// A folder of a story's own, emptied.
pub fn scratch(name: &str) -> PathBuf {
    let folder = std::env::temp_dir().join(format!("indigo-window-{}-{name}", std::process::id()));
    drop(std::fs::remove_dir_all(&folder));
    std::fs::create_dir_all(&folder).expect("a folder for the story");
    folder
}

/// Connects to the display. One that nobody was left on begins anew, and refuses meanwhile.
fn connect() -> (RustConnection, usize) {
    const TRIES: u32 = 50;
    for _ in 1..TRIES {
        if let Ok(connected) = x11rb::connect(None) {
            return connected;
        }
        std::thread::sleep(Duration::from_millis(100));
    }
    x11rb::connect(None)
        .expect("the stories need a display: cargo xtask test provides one, or set DISPLAY, by Xvfb say")
}

impl Screen {
    /// Starts the program in a folder, with a window of a size, and waits for the window.
    pub fn start(folder: &Path, size: [u16; 2], arguments: &[&str]) -> Self {
        let alone = SCREEN.lock().unwrap_or_else(PoisonError::into_inner);
        let (connection, number) = connect();
        let root = connection.setup().roots[number].root;
        let program = Command::new(env!("CARGO_BIN_EXE_indigo"))
            .args(arguments)
            .current_dir(folder)
            .env("HOME", folder)
            .env("XDG_DATA_HOME", folder)
            .env("INDIGO_CACHE", folder)
            // Nothing of a desktop that may be there: no dialogs for files, by a portal or a program.
            .env("DBUS_SESSION_BUS_ADDRESS", "unix:path=/nowhere")
            .env("PATH", folder)
            .env_remove("WAYLAND_DISPLAY")
            .stdin(Stdio::null())
            .spawn()
            .expect("the program starts");
        let mut screen = Self { connection, root, window: 0, program, size, _alone: alone };
        screen.window = screen.wait_for("a window", |screen| screen.find());
        screen.connection.set_input_focus(InputFocus::PARENT, screen.window, x11rb::CURRENT_TIME).unwrap();
        screen.resize();
        screen
    }

    fn resize(&self) {
        use x11rb::protocol::xproto::ConfigureWindowAux;
        let [width, height] = self.size.map(u32::from);
        let wanted = ConfigureWindowAux::new().x(0).y(0).width(width).height(height);
        self.connection.configure_window(self.window, &wanted).unwrap();
        self.connection.flush().unwrap();
    }

    /// The program's window, once it is seen.
    fn find(&self) -> Option<WindowId> {
        use x11rb::protocol::xproto::MapState;
        let children = self.connection.query_tree(self.root).unwrap().reply().unwrap().children;
        children.into_iter().find(|&window| {
            let attributes = self.connection.get_window_attributes(window).unwrap().reply();
            let geometry = self.connection.get_geometry(window).unwrap().reply();
            attributes.is_ok_and(|a| a.map_state == MapState::VIEWABLE)
                && geometry.is_ok_and(|g| g.width > 300)
        })
    }

    /// Waits until something is there.
    pub fn wait_for<T>(&mut self, what: &str, mut find: impl FnMut(&mut Self) -> Option<T>) -> T {
        let start = Instant::now();
        loop {
            if let Some(found) = find(self) {
                return found;
            }
            if let Ok(Some(status)) = self.program.try_wait() {
                panic!("the program ended with {status} before there was {what}");
            }
            assert!(start.elapsed() < PATIENCE, "there is no {what}");
            std::thread::sleep(Duration::from_millis(100));
        }
    }

    /// Presses keys together, and lets them go.
    pub fn press(&self, symbols: &[u32]) {
        let codes: Vec<u8> = symbols.iter().map(|&symbol| self.code(symbol)).collect();
        for &code in &codes {
            self.fake(KEY_PRESS_EVENT, code, [0, 0]);
        }
        for &code in codes.iter().rev() {
            self.fake(KEY_RELEASE_EVENT, code, [0, 0]);
        }
        // A frame for each, so that two presses of a key are two.
        std::thread::sleep(Duration::from_millis(150));
    }

    /// Puts the pointer somewhere.
    pub fn point(&self, at: [i16; 2]) {
        self.fake(MOTION_NOTIFY_EVENT, 0, at);
        std::thread::sleep(Duration::from_millis(150));
    }

    /// Clicks somewhere.
    pub fn click(&self, at: [i16; 2]) {
        self.point(at);
        self.fake(BUTTON_PRESS_EVENT, 1, [0, 0]);
        self.fake(BUTTON_RELEASE_EVENT, 1, [0, 0]);
    }

    /// Moves the pointer from one place to another with its first button held.
    pub fn drag(&self, from: [i16; 2], to: [i16; 2]) {
        // Each takes a frame of its own, also on a busy machine: what comes at once is a click.
        let frame = || std::thread::sleep(Duration::from_millis(500));
        self.point(from);
        frame();
        self.fake(BUTTON_PRESS_EVENT, 1, [0, 0]);
        frame();
        self.point([i16::midpoint(from[0], to[0]), i16::midpoint(from[1], to[1])]);
        frame();
        self.point(to);
        frame();
        self.fake(BUTTON_RELEASE_EVENT, 1, [0, 0]);
    }

    fn fake(&self, kind: u8, detail: u8, [x, y]: [i16; 2]) {
        self.connection.xtest_fake_input(kind, detail, 0, self.root, x, y, 0).unwrap().check().unwrap();
    }

    /// The key of a symbol.
    fn code(&self, symbol: u32) -> u8 {
        let setup = self.connection.setup();
        let (first, last) = (setup.min_keycode, setup.max_keycode);
        let mapping = self.connection.get_keyboard_mapping(first, last - first + 1).unwrap().reply().unwrap();
        let per_key = usize::from(mapping.keysyms_per_keycode);
        let key = mapping.keysyms.chunks(per_key).position(|symbols| symbols[0] == symbol);
        first + key.unwrap_or_else(|| panic!("the keyboard has no {symbol:#x}")) as u8
    }

    /// The whole window.
    pub fn see(&self) -> Seen {
        self.see_part([0, 0], self.size)
    }

    /// One pixel of it.
    pub fn see_at(&self, [x, y]: [u16; 2]) -> [u8; 3] {
        self.see_part([x as i16, y as i16], [1, 1]).pixels[0]
    }

    /// A square in the middle of the area of the picture, less than the picture that fits there.
    pub fn see_picture(&self) -> Seen {
        // What the panels leave: see the constants of the theme.
        let (side, above, below) = (324, 40, 30 + 152 + 30);
        let [x, y] = [(self.size[0] - side) / 2, above + (self.size[1] - above - below) / 2];
        self.see_part([x as i16 - 50, y as i16 - 50], [100, 100])
    }

    fn see_part(&self, [x, y]: [i16; 2], [width, height]: [u16; 2]) -> Seen {
        let image = self
            .connection
            .get_image(ImageFormat::Z_PIXMAP, self.root, x, y, width, height, u32::MAX)
            .unwrap()
            .reply()
            .expect("the screen is as large as the window");
        // Blue, green, red and nothing, as little-endian screens of 24 bits have it.
        let pixels = image.data.chunks_exact(4).map(|p| [p[2], p[1], p[0]]).collect();
        Seen { width: width.into(), height: height.into(), pixels }
    }

    /// Asks the window to close, as a click on its cross does.
    pub fn ask_to_close(&self) {
        let atom = |name: &str| -> Atom {
            self.connection.intern_atom(false, name.as_bytes()).unwrap().reply().unwrap().atom
        };
        let data = [atom("WM_DELETE_WINDOW"), x11rb::CURRENT_TIME, 0, 0, 0];
        let event = ClientMessageEvent::new(32, self.window, atom("WM_PROTOCOLS"), data);
        self.connection.send_event(false, self.window, EventMask::NO_EVENT, event).unwrap();
        self.connection.flush().unwrap();
    }

    /// Whether the program has ended well.
    pub fn has_ended_well(&mut self) -> Option<bool> {
        self.program.try_wait().unwrap().map(|status| status.success())
    }

    /// Waits until the program has ended; whether it did well.
    pub fn wait_for_end(&mut self) -> bool {
        let start = Instant::now();
        while start.elapsed() < PATIENCE {
            if let Some(ended) = self.has_ended_well() {
                return ended;
            }
            std::thread::sleep(Duration::from_millis(50));
        }
        panic!("the program does not end");
    }
}

impl Drop for Screen {
    fn drop(&mut self) {
        // At worst it has ended already.
        drop(self.program.kill());
        drop(self.program.wait());
    }
}
