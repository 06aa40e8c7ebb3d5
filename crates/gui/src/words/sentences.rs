//! What the window says of something.

use super::PROGRAM;
use crate::comparison::Layout;
use crate::controls::Mapper;
use crate::engine::Phase;
use crate::queue::Turn;
use crate::state::Tab;
use crate::work::Sampling;
use indigo_film::FilmSize;
use indigo_front::flags::Role;
use indigo_render::HaltReason;
use indigo_render::output::OneFile;
use std::path::Path;

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
        Tab::Network => "Network",
    }
}

/// How two pictures are shown.
pub fn layout(layout: Layout) -> &'static str {
    match layout {
        Layout::Off => "Render only",
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
    if bidirectional { "bidirectional path tracing" } else { "path tracing" }
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
        Phase::Empty => "Nothing is open".to_owned(),
        Phase::Loading => "Loading".to_owned(),
        Phase::Ready => "Ready".to_owned(),
        Phase::Rendering => "Rendering".to_owned(),
        Phase::Paused => "Paused".to_owned(),
        Phase::Ending => "Saving".to_owned(),
        Phase::Slave => "Rendering for a master".to_owned(),
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
        Phase::Loading => "The scene is loading",
        Phase::Rendering => "Waiting for the first samples",
        Phase::Slave => "The master has the picture",
        _ => "Nothing has been rendered yet",
    }
}

/// What a screen reader says of the picture.
pub fn picture_of(name: &str) -> String {
    format!("Picture: {name}")
}

/// How large the picture is shown.
pub fn view(is_fitting: bool) -> String {
    if is_fitting { "Point at the picture to read its values" } else { "F shows the whole picture" }
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
        None => "The whole picture is rendered".to_owned(),
    }
}

/// How far a scene of the queue is.
pub fn turn(turn: Turn) -> &'static str {
    match turn {
        Turn::Waiting => "waiting",
        Turn::Now => "rendering",
        Turn::Done => "done",
    }
}

/// Takes a scene out of the queue.
pub fn remove(name: &str) -> String {
    format!("Remove {name} from the queue")
}

/// The tab of what was found.
pub fn findings(n: usize) -> String {
    match n {
        0 => "Scene: no findings".to_owned(),
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
    format!("{path} cannot be rendered: see the findings below")
}

/// A film will be gone on with.
pub fn goes_on_with(path: &Path) -> String {
    format!("{} is a film of this scene: Start continues it", path.display())
}

/// A film of another scene.
pub fn only_looked_at(path: &Path, reason: &str) -> String {
    format!("{} can be viewed but not continued: {reason}", path.display())
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
    format!("{path} is packed: to change it, unpack it by indigo_console --unpack")
}

/// A scene that cannot be read.
pub fn unreadable(path: &str) -> String {
    format!("{path} cannot be read")
}

/// A file is another than the one that was read.
pub fn changed_elsewhere(path: &str) -> String {
    format!("{path} has changed since it was read: reload the scene first")
}

/// How many elements are to be changed.
pub fn changes(n: usize) -> String {
    if n == 0 { "No changes".to_owned() } else { indigo_front::messages::count(n, "change") }
}

/// Elements that are not listed.
pub fn more_elements(n: usize) -> String {
    format!("and {n} more")
}

/// A part in a render of many machines.
pub fn role(role: Option<Role>) -> &'static str {
    match role {
        None => "This machine alone",
        Some(Role::Master) => "Master",
        Some(Role::WorkingMaster) => "Working master",
        Some(Role::Slave) => "Slave",
    }
}

/// What that is.
pub fn role_hint(role: Option<Role>) -> &'static str {
    match role {
        None => "No other machine takes part",
        Some(Role::Master) => "Hands out the scene, and adds up what slaves render",
        Some(Role::WorkingMaster) => "The same, and renders as well",
        Some(Role::Slave) => "Renders the scene of a master, which has the picture",
    }
}

/// Starts a part.
pub fn start_as(role: Role) -> &'static str {
    match role {
        Role::Master => "Start as master",
        Role::WorkingMaster => "Start as working master",
        Role::Slave => "Start as slave",
    }
}

/// Something that is no host.
pub fn no_host(text: &str) -> String {
    format!(
        "{text} is not a machine: expected a name or address, with a port if need be, such as studio or studio:7000"
    )
}

/// A key was made.
pub fn key_made(path: &Path) -> String {
    format!(
        "Saved {}: copy it to all machines of the render by a way that nobody else can see",
        path.display()
    )
}

/// The end of a render of many machines.
pub fn waiting_for(slaves: &str) -> String {
    format!("Waiting for the last samples of {slaves}")
}

/// The tab of the slaves.
pub fn slaves(present: usize) -> String {
    format!("Slaves: {present}")
}

/// Time since something.
pub fn ago(clock: &str) -> String {
    format!("{clock} ago")
}

/// Strangers, mostly.
pub fn refused(connections: &str) -> String {
    format!("{connections} refused; the log says why")
}
