//! Every word that the window says, in one list, so that it can be read through at once. The list has four parts: here what is
//! always the same, in `sentences` what depends on what is shown, in `files` what is said of files, in `elements` what is said of
//! a scene's elements. No other module holds words
//! for people; what console and window both say is in `indigo_front`.

mod elements;
mod files;
mod sentences;

pub use elements::*;
pub use files::*;
pub use sentences::*;

/// Declares constants that are texts.
macro_rules! texts {
    ($($name:ident = $text:literal;)*) => { $(#[doc = $text] pub const $name: &str = $text;)* };
}

// The program.
texts! {
    PROGRAM = "Indigo";
    HELP = "The window takes the options of a render; everything else is done by indigo_console.\n\n";
    DEAF_DISPLAY = "the display named by DISPLAY or WAYLAND_DISPLAY cannot be opened: name one that can be, or render with indigo_console";
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
    THEME_SHORT = "Theme";
    THEME = "Switch between dark and light";
    KEYS = "Keys";
}

// The list of keys.
texts! {
    TABS_HINT = "Show Picture, Render, Scene, Queue or Network";
    START_OR_PAUSE = "Start, pause or continue";
    DARKER_BRIGHTER = "Half a stop darker, brighter";
    ZOOM_HINT = "Zoom in with + or =, out with −";
    GREY_KEY_HINT = "Take a grey point: something that should be grey";
    REGION_KEY_HINT = "Draw a region: only that part is rendered, from the start";
    CROSS_HINT = "Show or hide a cross that reads a pixel's values";
    PAN_KEY_HINT = "Close this list; put the cross away, and take no grey point or region";
    LAYOUT_HINT = "Compare side by side, split by a line, or not";
    LINE_HINT = "Move the line of a comparison";
    KEYS_HINT = "Show the keyboard shortcuts";
    STEP_HINT = "Move the cross by a pixel, or the picture";
    FAR_STEP_HINT = "Move the cross by ten pixels, or the picture by half";
    TAKE_HINT = "Take the grey point, or a corner of the region, at the cross";
    WHEEL = "Wheel";
    WHEEL_HINT = "Zoom at the pointer; the right button moves the line of a comparison";
    TAB_KEY = "Tab";
    TAB_HINT = "Go to the next control; arrows change it, Space or Enter presses it, Escape leaves it";
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
    NO_CURVE = "this file holds no response curves";
    WHITE_BALANCE = "White balance";
    WHITE = "White";
    PICK_GREY = "Pick a grey point";
    NO_GREY = "This point is too dark to have a colour";
    OPTICS = "Optics";
    LIGHT_GROUPS = "Lights";
    LIGHT_GROUPS_HINT = "How bright these lights are in the picture: 1 is as they were rendered";
    DIFFRACTION = "Aperture diffraction";
    NO_DIFFRACTION = "This scene has no diffraction, or it is part of the render already";
    BLOOM = "Bloom";
    BLOOM_WEIGHT = "Weight";
    BLOOM_RADIUS = "Radius";
    RESET = "Reset";
    RESET_HINT = "Back to the scene's settings; once more: back to yours";
    UNDO_RESET = "Undo reset";
}

// The render.
texts! {
    NOTHING_TO_RENDER = "No scene is open";
    HALT = "Halt at";
    HALT_SPP = "Samples per pixel";
    HALT_TIME = "Time";
    HALT_ERROR = "Relative error";
    HALT_ERROR_HINT = "Takes as much memory as two more films. Of a picture that is black so far no error is known";
    SECONDS = " s";
    PER_CENT = " %";
    MACHINE = "This machine";
    THREADS = "Threads";
    LIGHT_TRANSPORT = "Light transport";
    TECHNIQUE = "Technique";
    SAMPLING = "Sampling";
    APPLY_MODE = "Reload with this mode";
    APPLY_MODE_HINT = "Samples of different modes cannot be mixed, so the film starts over";
    DRAW_REGION = "Draw…";
    WHOLE_PICTURE = "Whole picture";
    CANCELLED = "Loading was cancelled";
    NOTHING_TO_SAVE = "There is nothing to save";
}

// The scene.
texts! {
    OVERVIEW = "Overview";
    SCENE = "Scene";
    FILE = "File";
    SIZE = "Size";
    SUPER_SAMPLING = "Supersampling";
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
    RAYS = "Rays of this run";
    THE_RENDER = "Render";
    OUTSIDE = "outside the region";
    TIME = "Time";
    TIME_LEFT = "Time left";
    ERROR = "Relative error";
    NO_ESTIMATE = "not estimated";
    UNKNOWN = "unknown";
    NOT_BEGUN = "Nothing has been rendered yet";
    MEMORY = "Memory";
    DEVELOPING = "Development time";
}

// The scene's file.
texts! {
    WRITE_SETTINGS = "Write to the scene file";
    WRITE_SETTINGS_HINT = "Save these settings in the scene file, keeping its comments and layout";
    NOTHING_TO_WRITE = "The scene file has these settings already";
    ELEMENTS = "Elements";
    READ_ELEMENTS = "Show the elements";
    READ_ELEMENTS_HINT = "Read them from the scene files, to change texts, numbers and colours";
    SAVE_CHANGES = "Save and reload";
    SAVE_CHANGES_HINT = "Write the changes to the scene files, keeping their comments and layout, and load the scene again";
    DISCARD = "Discard";
    LONG_TEXT = "too long to edit here";
    ADD_ELEMENT = "Add…";
    FLAG = "is given";
    COLOUR = "Colour";
    COLOUR_FACTOR = "Factor";
    COLOUR_FACTOR_HINT = "What the colour is multiplied by, for numbers beyond 1";
}

// The queue.
texts! {
    QUEUE = "Scenes to render one after another";
    QUEUE_HINT = "Each is rendered until its own halting condition is met, then saved.";
    QUEUE_HALT = "Otherwise halt at";
    QUEUE_HALT_UNIT = " spp";
    TURN_FAILED_HINT = "The log says why";
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
    PART_IS_FIXED = "To change this, stop the render first.";
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
    NO_ERROR_OF_MANY = "The relative error is not estimated when slaves render, so this halting condition has no effect";
    REGION_OF_MANY = "Slaves render what the scene file says, not a region drawn here: render the whole picture, or put render_region into the scene";
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
    HAS_ENDED = "ended";
}

// Log and findings.
texts! {
    LOG = "Log";
    NO_FINDINGS = "Nothing is wrong with the scene";
    BACK = "Back to the list";
    COPY = "Copy";
    COPY_HINT = "Copy this text";
}

// Questions, and files.
texts! {
    CLOSE_TEXT = "What should happen to the render when the window closes?";
    CLOSE_SAVE = "Save and close";
    CLOSE_DISCARD = "Close without saving";
    UNSAVED_HEAD = "Changes have not been saved";
    UNSAVED_SAVE = "Save";
    UNSAVED_DISCARD = "Discard";
    NO_DIALOG = "This desktop offers no dialog for files. Path:";
    PATH = "Path:";
    NO_PATH = "Type the path of a file";
    CHECKING = "Looking for it…";
    SCENES_AND_FILMS = "Scenes and films";
    SCENES = "Scenes";
    PICTURES = "Pictures";
}

// What fails, and what is to become of it.
texts! {
    FILM_HEAD = "The last render could not be saved";
    FILM_SAVE = "Save again";
    FILM_SAVE_AS = "Save elsewhere…";
    SAMPLES_HEAD = "Give up the picture so far?";
    SAMPLES_SAVE = "Save it first…";
    SAMPLES_DISCARD = "Give it up";
    REGION_OF_UNSAVED = "the last render could not be saved: save it again before another region is rendered";
    DEVELOPING_FAILED = "The picture cannot be developed by an error of the program, which is a bug: please report it";
    ESTIMATE_ERROR = "Estimate the error";
    ESTIMATE_ERROR_HINT = "Shows how far the picture still is from its end; takes as much memory as two more films";
    NO_ESTIMATE_OF_MANY = "the relative error is not estimated when slaves render";
    SAVING_FAILED = "Saving failed by an error of the program, which is a bug: please report it";
}
