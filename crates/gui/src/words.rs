//! Every word that the window says, in one list, so that it can be read through at once: here what is always the same, in
//! `sentences` what depends on something.

mod sentences;

pub use sentences::*;

/// Declares constants that are texts.
macro_rules! texts {
    ($($name:ident = $text:literal;)*) => { $(#[doc = $text] pub const $name: &str = $text;)* };
}

// The program.
texts! {
    PROGRAM = "Indigo";
    HELP = "The window takes the options of a render; what else they do is done by indigo_console.\n\n";
    DEAF_DISPLAY = "the display that DISPLAY or WAYLAND_DISPLAY names cannot be opened: name one that can be, or render with indigo_console";
    NO_DISPLAY = "there is no display to open a window on: set DISPLAY or WAYLAND_DISPLAY, or render with indigo_console";
}

// The tool bar.
texts! {
    OPEN = "Open";
    OPEN_FILE = "Open a scene or film…";
    RELOAD = "Reload the scene";
    RECENT = "Recent files";
    NONE = "none";
    SAVE = "Save";
    SAVE_NOW = "Save all files of the render now";
    SAVE_PICTURE = "Save picture as PNG…";
    SAVE_EXR = "Save luminances as EXR…";
    SAVE_FILM = "Save film as IGI…";
    START = "Start";
    PAUSE = "Pause";
    RESUME = "Resume";
    GO_ON = "Continue";
    CANCEL = "Cancel";
    STOP = "Stop";
    STOP_HINT = "End the render and save its files; the film is kept, so that it can be continued";
    START_OR_PAUSE = "Start, pause or continue";
    FIT = "Fit";
    FIT_HINT = "Show the whole picture";
    ONE_TO_ONE = "1:1";
    ONE_TO_ONE_HINT = "Show one pixel of the picture per pixel of the screen";
    PAN = "Pan";
    PAN_HINT = "Drag to move the picture";
    GREY = "Grey point";
    GREY_HINT = "Click something that should be grey";
    REGION = "Region";
    REGION_HINT = "Drag a rectangle: only that part is rendered, from the start";
    COMPARE = "Compare";
    COMPARE_WITH = "With a saved picture…";
    TAB_PICTURE = "Show how the picture is developed";
    TAB_RENDER = "Show how the scene is rendered";
    TAB_SCENE = "Show what the scene contains";
    TAB_QUEUE = "Show the queue";
    TAB_NETWORK = "Show network rendering";
    THEME_SHORT = "Theme";
    THEME = "Switch between dark and light";
    KEYS = "Keys";
    KEYS_HINT = "Show the keyboard shortcuts";
    WHEEL = "Wheel";
    WHEEL_HINT = "Zoom at the pointer; the middle button pans, the right one moves the line of a comparison";
    TAB_KEY = "Tab";
    TAB_HINT = "Go to the next control; arrow keys change it, Space or Enter presses it";
    BRIGHTER = "Half a stop brighter";
    DARKER = "Half a stop darker";
}

// Development.
texts! {
    NOTHING_OPEN = "Nothing is open";
    HISTOGRAM_HINT = "How many pixels have each brightness, from black to white";
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
    CURVE_HINT = "The response: brightness against exposure, for red, green and blue";
    NO_CURVE = "these are not response curves";
    WHITE_BALANCE = "White balance";
    WHITE = "White";
    PICK_GREY = "Pick a grey point";
    NO_GREY = "this point is too dark to have a colour";
    OPTICS = "Optics";
    DIFFRACTION = "Aperture diffraction";
    NO_DIFFRACTION = "This scene has no diffraction that is added after rendering";
    BLOOM = "Bloom";
    BLOOM_WEIGHT = "Weight";
    BLOOM_RADIUS = "Radius";
    RESET = "Reset";
    RESET_HINT = "Back to the scene's settings";
}

// The render.
texts! {
    NOTHING_TO_RENDER = "No scene is open";
    HALT = "Halt";
    HALT_SPP = "at samples per pixel";
    HALT_TIME = "after a time";
    HALT_ERROR = "at a relative error";
    HALT_ERROR_HINT = "Needs the memory of two more films";
    MACHINE = "This machine";
    THREADS = "Threads";
    LIGHT_TRANSPORT = "Light transport";
    TECHNIQUE = "Technique";
    SAMPLING = "Sampling";
    APPLY_MODE = "Restart with this mode";
    APPLY_MODE_HINT = "Samples of different modes cannot be mixed, so the film starts over";
    DRAW_REGION = "Draw…";
    WHOLE_PICTURE = "Whole picture";
    CANCELLED = "Loading was cancelled";
    NOTHING_TO_SAVE = "there is nothing to save";
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
    NOT_BEGUN = "Nothing has been rendered yet";
    MEMORY = "Memory";
    DEVELOPING = "Development";
}

// The scene's file.
texts! {
    WRITE_SETTINGS = "Write to the scene file";
    WRITE_SETTINGS_HINT = "Save these settings in the scene file, keeping its comments and layout";
    ELEMENTS = "Elements";
    READ_ELEMENTS = "Show the elements";
    READ_ELEMENTS_HINT = "Read them from the scene files, to change texts, numbers and colours";
    SAVE_CHANGES = "Save and restart";
    SAVE_CHANGES_HINT = "Write the changes to the scene files, keeping their comments and layout, and load the scene again";
    DISCARD = "Discard";
    LONG_TEXT = "too long to edit here";
}

// The queue.
texts! {
    QUEUE = "Scenes to render one after another";
    QUEUE_HINT = "Each is rendered until its own halting condition is met, and saved.";
    QUEUE_HALT = "Otherwise halt at";
    QUEUE_HALT_HINT = "Samples per pixel for scenes without a halting condition";
    QUEUE_START = "Start the queue";
    QUEUE_END = "Stop after this scene";
    QUEUE_END_HINT = "The next scene is not started";
    ADD = "Add…";
    REMOVE = "×";
}

// Rendering on many machines.
texts! {
    NETWORK = "Network rendering";
    CONNECTION = "Connection";
    MASTER = "Host";
    MASTER_HINT = "The master's machine, with its port unless that is 7777: studio or studio:7000";
    SEARCHED = "found on the local network";
    PORT = "Port";
    PORT_HINT = "Where slaves reach this master; 0 takes any free port";
    KEY_FILE = "Key file";
    KEY_HINT = "All machines of a render share a key; without one, only programs on this machine can take part";
    NO_KEY = "none: this machine only";
    CHOOSE = "Choose…";
    MAKE_KEY = "New key…";
    MAKE_KEY_HINT = "Write a new key to a file, to be copied to all machines of the render";
    KEY_NAME = "indigo.key";
    MASTER_NEEDS_SCENE = "Open a scene first";
    MASTER_AT_WORK = "The slaves are listed at the bottom.";
    SLAVE_AT_WORK = "This machine renders for a master, which has the picture.";
    NO_PAUSE_OF_MANY = "Slaves cannot be paused: stop the render, and continue it later";
    NO_ERROR_OF_MANY = "the relative error is not estimated when slaves render, so this halting condition has no effect";
    REGION_OF_MANY = "slaves render what the scene file says, not a region drawn here: render the whole picture, or put render_region into the scene";
    NO_SLAVES = "No slaves have joined yet.";
    SLAVE_MACHINE = "Machine";
    SLAVE_ADDRESS = "Address";
    SLAVE_STATE = "State";
    SLAVE_RATE = "Samples/s";
    SLAVE_UPLOADS = "Uploads";
    SLAVE_LAST = "Last upload";
    SLAVE_ERRORS = "Errors";
    THIS_MACHINE = "this machine";
    RENDERS = "rendering";
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
    CLOSE_TEXT = "What should happen to the render when the window closes?";
    CLOSE_SAVE = "Save and close";
    CLOSE_DISCARD = "Close without saving";
    CLOSE_NOT = "Keep rendering";
    SCENES_AND_FILMS = "Scenes and films";
    SCENES = "Scenes";
    PICTURES = "Pictures";
}
