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
    TAB_NETWORK = "Show rendering on many machines";
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

// Rendering on many machines.
texts! {
    NETWORK = "Rendering on many machines";
    CONNECTION = "Connection";
    MASTER = "Master at";
    MASTER_HINT = "The master's machine, and its port if that is not 7777: lust or lust:7000";
    SEARCHED = "found in the local network";
    PORT = "Port";
    PORT_HINT = "Where slaves find this master; 0 takes any port that is free";
    KEY_FILE = "Key file";
    KEY_HINT = "All machines of a render share a key; without one only programs on this machine can take part";
    NO_KEY = "none: this machine only";
    CHOOSE = "Choose…";
    MAKE_KEY = "Make a key…";
    MAKE_KEY_HINT = "Write a new key to a file, to be copied to all machines of the render";
    KEY_NAME = "indigo.key";
    MASTER_NEEDS_SCENE = "Open a scene first";
    MASTER_AT_WORK = "Slaves are listed at the bottom.";
    SLAVE_AT_WORK = "This machine renders for a master, which has the picture.";
    NO_PAUSE_OF_MANY = "Slaves cannot be paused: stop the render, and go on with it later";
    NO_ERROR_OF_MANY = "the relative error is not estimated when slaves render: this halting condition has no effect";
    LOST_LAST_SAMPLES = "slaves that are gone had the last of the samples: go on with the film to have them all";
    REGION_OF_MANY = "slaves render what the scene's file says, not a region drawn here: render all of the picture, or put render_region into the scene";
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
    CLOSE_TEXT = "What is to become of the render when the window closes?";
    CLOSE_SAVE = "Save and close";
    CLOSE_DISCARD = "Close without saving";
    CLOSE_NOT = "Keep rendering";
    SCENES_AND_FILMS = "Scenes and films";
    SCENES = "Scenes";
    PICTURES = "Pictures";
}
