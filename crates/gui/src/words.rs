//! Every word that the window says, in one list, so that it can be read through at once.

use crate::comparison::Layout;
use crate::controls::Mapper;
use crate::engine::Phase;
use crate::queue::Turn;
use crate::state::Tab;
use crate::work::Sampling;
use indigo_film::FilmSize;
use indigo_render::HaltReason;
use indigo_render::output::OneFile;
use std::path::Path;

/// Declares constants that are texts.
macro_rules! texts {
    ($($name:ident = $text:literal;)*) => { $(#[doc = $text] pub const $name: &str = $text;)* };
}

// The program.
texts! {
    PROGRAM = "Indigo";
    HELP = "The window takes the options of a render; what else they do is done by indigo_console.\n\n";
    NO_DISPLAY = "there is no display to open a window on: set DISPLAY or WAYLAND_DISPLAY, or render with indigo_console";
}

// The tool bar.
texts! {
    OPEN = "Open";
    OPEN_FILE = "Open a scene or film…";
    RELOAD = "Load the scene again";
    RECENT = "Opened lately";
    NONE = "none";
    SAVE = "Save";
    SAVE_NOW = "Save the render's files now";
    SAVE_PICTURE = "Save the picture (PNG) as…";
    SAVE_EXR = "Save luminances (EXR) as…";
    SAVE_FILM = "Save the film (IGI) as…";
    START = "Start";
    PAUSE = "Pause";
    RESUME = "Resume";
    GO_ON = "Go on";
    CANCEL = "Cancel";
    STOP = "Stop";
    STOP_HINT = "End the render and save its files; the film stays, so that it can go on";
    START_OR_PAUSE = "Start, pause, or go on";
    FIT = "Fit";
    FIT_HINT = "Show all of the picture";
    ONE_TO_ONE = "1:1";
    ONE_TO_ONE_HINT = "Show each pixel as one of the screen";
    PAN = "Move";
    PAN_HINT = "Drag to move the picture";
    GREY = "Grey point";
    GREY_HINT = "Click on something that should be grey";
    REGION = "Region";
    REGION_HINT = "Drag a rectangle: only this part is rendered, from the start";
    COMPARE = "Compare";
    COMPARE_WITH = "With a saved picture…";
    TAB_PICTURE = "Show how the picture is developed";
    TAB_RENDER = "Show how the scene is rendered";
    TAB_SCENE = "Show what the scene holds";
    TAB_QUEUE = "Show the queue";
    THEME_SHORT = "Theme";
    THEME = "Switch between dark and light";
    KEYS = "Keys";
    KEYS_HINT = "Show what keys do";
    WHEEL = "Wheel";
    WHEEL_HINT = "Zoom at the pointer; the middle button moves the picture, the right one the line of a comparison";
    TAB_KEY = "Tab";
    TAB_HINT = "Go to the next control; arrows change it, Space or Enter presses it";
    BRIGHTER = "Brighter by half a stop";
    DARKER = "Darker by half a stop";
}

// Development.
texts! {
    NOTHING_OPEN = "Nothing is open";
    HISTOGRAM_HINT = "How often each brightness is there, from black to white";
    TONE_MAPPING = "Tone mapping";
    MAPPER = "Method";
    SCALE = "Scale";
    PRE_SCALE = "Pre-scale";
    POST_SCALE = "Post-scale";
    BURN = "Burn";
    EV = "EV adjustment";
    EV_HINT = "Each step of 1 doubles the exposure";
    ISO = "Film ISO";
    RESPONSE = "Response";
    CURVE_HINT = "The response: brightness over irradiance, for red, green and blue";
    NO_CURVE = "these are no response curves";
    WHITE_BALANCE = "White balance";
    WHITE = "White";
    PICK_GREY = "Take a grey point";
    NO_GREY = "this point is too dark to have a colour";
    OPTICS = "Optics";
    DIFFRACTION = "Diffraction by the aperture";
    NO_DIFFRACTION = "This scene has no diffraction that is added after rendering";
    BLOOM = "Bloom";
    BLOOM_WEIGHT = "Weight";
    BLOOM_RADIUS = "Radius";
    RESET = "Reset";
    RESET_HINT = "Back to the settings of the scene";
}

// The render.
texts! {
    NOTHING_TO_RENDER = "No scene is open";
    HALT = "Halt";
    HALT_SPP = "at samples per pixel";
    HALT_TIME = "after a time";
    HALT_ERROR = "at a relative error";
    HALT_ERROR_HINT = "Takes the memory of two more films";
    MACHINE = "This machine";
    THREADS = "Threads";
    LIGHT_TRANSPORT = "Light transport";
    TECHNIQUE = "Paths";
    SAMPLING = "Sampling";
    APPLY_MODE = "Start again with these";
    APPLY_MODE_HINT = "Samples of different modes cannot be mixed, so the film begins anew";
    DRAW_REGION = "Draw…";
    WHOLE_PICTURE = "Whole picture";
    REGION_LATER = "the region cannot change while files are saved: try again in a moment";
    CANCELLED = "the scene is not waited for any more";
    NOTHING_TO_SAVE = "there is no render to save";
}

// The scene.
texts! {
    SCENE = "Scene";
    FILE = "File";
    SIZE = "Size";
    TRIANGLES = "Triangles";
    OBJECTS = "Objects";
    LIGHTS = "Lights";
    MATERIALS = "Materials";
    MEDIA = "Media";
    TEXTURES = "Textures";
    PROGRESS = "Progress";
    SAMPLES = "Samples";
    SPP = "Per pixel";
    RATE = "Rate";
    RAYS = "Rays";
    TIME = "Time";
    TIME_LEFT = "Time left";
    ERROR = "Relative error";
    NO_ESTIMATE = "not estimated";
    UNKNOWN = "unknown";
    NOT_BEGUN = "Nothing is rendered yet";
    MEMORY = "Memory";
    DEVELOPING = "Developing";
}

// The scene's file.
texts! {
    WRITE_SETTINGS = "Write into the scene";
    WRITE_SETTINGS_HINT = "Save these settings in the scene's file; its comments and layout stay";
    ELEMENTS = "Elements";
    READ_ELEMENTS = "Show the elements";
    READ_ELEMENTS_HINT = "Read them from the scene's files, to change numbers and colours";
    SAVE_CHANGES = "Save and start again";
    SAVE_CHANGES_HINT = "Write the changes to the scene's files, whose comments and layout stay, and load the scene again";
    DISCARD = "Discard";
    LONG_TEXT = "too long to be edited here";
}

// The queue.
texts! {
    QUEUE = "Scenes to render one after another";
    QUEUE_HINT = "Each is rendered until its own halting condition, and saved.";
    QUEUE_HALT = "Else halt at";
    QUEUE_HALT_HINT = "Samples per pixel for scenes that have no halting condition";
    QUEUE_START = "Start the queue";
    QUEUE_END = "End after this one";
    QUEUE_END_HINT = "The next scene does not begin by itself";
    ADD = "Add…";
    REMOVE = "×";
}

// Log and findings.
texts! {
    LOG = "Log";
    NO_FINDINGS = "Nothing is wrong with the scene.";
    BACK = "Back to the list";
}

// Closing and files.
texts! {
    CLOSE_HEAD = "A scene is being rendered";
    CLOSE_TEXT = "What is to become of the render when the window closes?";
    CLOSE_SAVE = "Save and close";
    CLOSE_DISCARD = "Close without saving";
    CLOSE_NOT = "Keep rendering";
    SCENES_AND_FILMS = "Scenes and films";
    SCENES = "Scenes";
    PICTURES = "Pictures";
}

/// An option of the console alone.
pub fn only_of_console(option: &str) -> String {
    format!("-{option} is an option of indigo_console: it needs no window")
}

/// There can be no window.
pub fn no_window(reason: &str) -> String {
    format!("no window can be opened: {reason}; render with indigo_console")
}

/// The title of the window.
pub fn title(path: &str) -> String {
    let name = Path::new(path).file_name().map_or(path.into(), |name| name.to_string_lossy());
    format!("{name} – {PROGRAM}")
}

/// A tab of the panel on the right.
pub fn tab(tab: Tab) -> &'static str {
    match tab {
        Tab::Picture => "Picture",
        Tab::Render => "Render",
        Tab::Scene => "Scene",
        Tab::Queue => "Queue",
    }
}

/// How two pictures are shown.
pub fn layout(layout: Layout) -> &'static str {
    match layout {
        Layout::Off => "Only the render",
        Layout::Side => "Side by side",
        Layout::Wipe => "Split by a line",
    }
}

/// A tone mapping.
pub fn mapper(mapper: Mapper) -> &'static str {
    match mapper {
        Mapper::Linear => "Linear",
        Mapper::Reinhard => "Reinhard",
        Mapper::Camera => "Camera",
    }
}

/// A response by the name of its file.
pub fn response(name: &str) -> String {
    match Path::new(name).file_stem() {
        Some(stem) => stem.to_string_lossy().replace('_', " "),
        None => "display".to_owned(),
    }
}

/// A chromaticity.
pub fn chromaticity([x, y]: [f64; 2]) -> String {
    format!("x {x:.4}, y {y:.4}")
}

/// How paths are built.
pub fn technique(bidirectional: bool) -> &'static str {
    if bidirectional { "from both ends" } else { "from the camera" }
}

/// Who chooses paths.
pub fn sampling(sampling: Sampling) -> &'static str {
    match sampling {
        Sampling::Independent => "independent",
        Sampling::Metropolis => "Metropolis",
        Sampling::Hybrid => "hybrid",
    }
}

/// What the engine is at.
pub fn phase(phase: &Phase) -> String {
    match phase {
        Phase::Empty => "Nothing to render".to_owned(),
        Phase::Loading => "Loading".to_owned(),
        Phase::Ready => "Ready".to_owned(),
        Phase::Rendering => "Rendering".to_owned(),
        Phase::Paused => "Paused".to_owned(),
        Phase::Ending => "Saving".to_owned(),
        Phase::Halted(reason) => match reason {
            HaltReason::Samples => "Done: samples",
            HaltReason::Error => "Done: error",
            HaltReason::Time => "Done: time",
            HaltReason::Stopped => "Stopped",
            HaltReason::Failed(_) => "Failed",
        }
        .to_owned(),
    }
}

/// Where the picture will be.
pub fn in_empty_picture(phase: &Phase) -> &'static str {
    match phase {
        Phase::Empty => "Drop a scene here, or open one",
        Phase::Loading => "The scene is being loaded",
        Phase::Rendering => "The first samples are on their way",
        _ => "Nothing is rendered yet",
    }
}

/// What a screen reader says of the picture.
pub fn picture_of(name: &str) -> String {
    format!("Picture: {name}")
}

/// How large the picture is shown.
pub fn view(is_fitting: bool) -> String {
    if is_fitting { "Point at the picture to see its values" } else { "F shows all of the picture" }
        .to_owned()
}

/// Samples per pixel.
pub fn samples_per_pixel(n: f64) -> String {
    format!("{n:.1} spp")
}

/// A rate.
pub fn samples_per_second(scaled: &str) -> String {
    format!("{scaled} samples/s")
}

/// A time of rendering.
pub fn elapsed(clock: &str) -> String {
    format!("{clock} elapsed")
}

/// Time to go.
pub fn left(clock: &str) -> String {
    format!("{clock} left")
}

/// An estimated error.
pub fn error(fraction: f64) -> String {
    format!("error {}", percent(fraction))
}

/// A part of the whole.
pub fn percent(fraction: f64) -> String {
    format!("{:.2} %", 100.0 * fraction)
}

/// An amount of memory.
pub fn memory(bytes: u64) -> String {
    format!("{} MiB", bytes >> 20)
}

/// A luminance.
pub fn luminance(nits: f32) -> String {
    format!("{nits:>8.3} cd/m²")
}

/// An exposure.
pub fn exposure(lux_seconds: f64) -> String {
    format!("{lux_seconds:>9.3e} lux·s")
}

/// The size of a picture.
pub fn size(size: FilmSize) -> String {
    match size.super_sample() {
        1 => format!("{} × {}", size.width(), size.height()),
        n => format!("{} × {}, {n}² samples", size.width(), size.height()),
    }
}

/// What is rendered.
pub fn region(region: Option<[[u32; 2]; 2]>) -> String {
    match region {
        Some([[x1, y1], [x2, y2]]) => format!("Columns {x1} to {}, rows {y1} to {}", x2 - 1, y2 - 1),
        None => "All of the picture is rendered".to_owned(),
    }
}

/// How far a scene of the queue is.
pub fn turn(turn: Turn) -> &'static str {
    match turn {
        Turn::Waiting => "waits",
        Turn::Now => "now",
        Turn::Done => "done",
    }
}

/// Takes a scene out of the queue.
pub fn remove(name: &str) -> String {
    format!("Take {name} out of the queue")
}

/// The tab of what was found.
pub fn findings(n: usize) -> String {
    match n {
        0 => "Scene: nothing found".to_owned(),
        n => format!("Scene: {}", indigo_front::messages::count(n, "finding")),
    }
}

/// A place in a file.
pub fn place(name: &str, line: usize) -> String {
    format!("{name}, line {line}")
}

/// A scene was loaded.
pub fn loaded(path: &str, seconds: f64) -> String {
    format!("Loaded {path} in {seconds:.2} s")
}

/// A scene with errors.
pub fn not_rendered(path: &str) -> String {
    format!("{path} cannot be rendered; what is wrong stands under Scene")
}

/// A film will be gone on with.
pub fn goes_on_with(path: &Path) -> String {
    format!("{} is a film of this scene: Start goes on with it", path.display())
}

/// A film of another scene.
pub fn only_looked_at(path: &Path, reason: &str) -> String {
    format!("{} is only looked at: {reason}", path.display())
}

/// A path that is no text.
pub fn not_text(path: &Path) -> String {
    format!("{} is not Unicode text", path.display())
}

/// A file was written.
pub fn saved(path: &Path) -> String {
    format!("Saved {}", path.display())
}

/// The ending of a file.
pub fn ending(what: OneFile) -> &'static str {
    match what {
        OneFile::Picture => "png",
        OneFile::Luminances => "exr",
        OneFile::Film => "igi",
    }
}

/// A packed scene cannot be changed.
pub fn packed(path: &str) -> String {
    format!("{path} is packed: unpack it to change it, by indigo_console --unpack")
}

/// A scene that cannot be read.
pub fn unreadable(path: &str) -> String {
    format!("{path} cannot be read")
}

/// A file is another than the one that was read.
pub fn changed_elsewhere(path: &str) -> String {
    format!("{path} has changed since it was read: load the scene again first")
}

/// How many elements are to be changed.
pub fn changes(n: usize) -> String {
    if n == 0 { "No changes".to_owned() } else { indigo_front::messages::count(n, "change") }
}

/// Elements that are not listed.
pub fn more_elements(n: usize) -> String {
    format!("and {n} more")
}
