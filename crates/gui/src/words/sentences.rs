//! What the window says of something that is shown: the second part of its list of words.

use super::elements::capital;
use super::{PER_CENT, PROGRAM, UNKNOWN};
use crate::comparison::Layout;
use crate::controls::Mapper;
use crate::engine::Phase;
use crate::queue::Turn;
use crate::state::Tab;
use crate::work::Sampling;
use indigo_film::FilmSize;
use indigo_front::flags::Role;
use indigo_render::HaltReason;
use std::path::Path;
use std::time::Duration;

/// Of a group of lights whose brightness a scene file cannot tell.
pub fn no_gain(name: &str) -> String {
    format!(
        "the brightness of {name} is not written: its <layer_scale> has no gain; give it as <rgb>, <xyz>, <blackbody> or <uniform>"
    )
}

/// What a group of lights is.
pub fn light_group(name: &str) -> String {
    format!("Whether the lights of {name} are on; the film keeps their light apart")
}

/// A name as far as there is room for it in front of a control.
pub fn short(name: &str) -> String {
    const MOST: usize = 14;
    if name.chars().count() <= MOST {
        return name.to_owned();
    }
    name.chars().take(MOST - 1).chain(['…']).collect()
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
    match Path::new(name).file_stem().map(|stem| stem.to_string_lossy()) {
        Some(stem) => match &*stem {
            "dslr_s_curve" => "DSLR, S curve".to_owned(),
            "gamma2.2" => "Gamma 2.2".to_owned(),
            "rec709" => "Rec. 709".to_owned(),
            "srgb" => "sRGB".to_owned(),
            other => capital(&other.replace('_', " ")),
        },
        None => "Display".to_owned(),
    }
}

/// A chromaticity.
pub fn chromaticity([x, y]: [f64; 2]) -> String {
    format!("x {x:.4}, y {y:.4}")
}

/// How paths are built.
pub fn technique(bidirectional: bool) -> &'static str {
    if bidirectional { "Bidirectional" } else { "Path tracing" }
}

/// Who chooses paths.
pub fn sampling(sampling: Sampling) -> &'static str {
    match sampling {
        Sampling::Independent => "Independent",
        Sampling::Metropolis => "Metropolis",
        Sampling::Hybrid => "Hybrid",
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
            HaltReason::Samples => "Done: samples reached",
            HaltReason::Error => "Done: error reached",
            HaltReason::Time => "Done: time is up",
            HaltReason::Stopped => "Stopped",
            HaltReason::Failed(_) => "Failed",
        }
        .to_owned(),
    }
}

/// What the engine is at, where something may be open that cannot be rendered, or is being loaded.
pub fn status(phase: &Phase, open: Option<&str>, wanted: Option<&str>) -> String {
    match (phase, open, wanted) {
        (Phase::Empty, Some(_), _) => "A film alone".to_owned(),
        (Phase::Loading, _, Some(path)) => loading(path),
        _ => self::phase(phase),
    }
}

/// A scene that is being loaded.
pub fn loading(path: &str) -> String {
    format!("Loading {}", name(path))
}

/// Loads another scene than the open one once more.
pub fn reload(path: &str) -> String {
    format!("Try {} again", name(path))
}

fn name(path: &str) -> String {
    Path::new(path).file_name().map_or_else(|| path.to_owned(), |name| name.to_string_lossy().into_owned())
}

/// What is asked before a render is closed: its head, and the answer by which it stays open.
pub fn closing(phase: &Phase) -> [&'static str; 2] {
    match phase {
        Phase::Paused => ["A render is paused", "Keep it open"],
        _ => ["A scene is being rendered", "Keep rendering"],
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
pub fn zoom(zoom: f32) -> String {
    let percent = f64::from(zoom) * 100.0;
    if percent < 10.0 { format!("{percent:.1} %") } else { format!("{percent:.0} %") }
}

/// What stands below a picture where no pixel is pointed at.
pub fn view(is_fitting: bool) -> &'static str {
    if is_fitting { "Point at the picture to read its values" } else { "F shows the whole picture" }
}

/// Samples per pixel.
pub fn samples_per_pixel(n: f64) -> String {
    format!("{n:.1} spp")
}

/// A rate.
pub fn samples_per_second(scaled: &str) -> String {
    format!("{scaled} samples/s")
}

/// A rate of anything, where its name stands in front.
pub fn per_second(scaled: &str) -> String {
    format!("{scaled}/s")
}

/// A time of rendering.
pub fn elapsed(clock: &str) -> String {
    format!("{clock} elapsed")
}

/// Time to go.
pub fn left(clock: &str) -> String {
    format!("{clock} left")
}

/// Why no time is left to be told.
pub fn no_time_left(phase: &Phase) -> &'static str {
    match phase {
        Phase::Paused => "paused",
        Phase::Halted(_) => "none",
        _ => UNKNOWN,
    }
}

/// An estimated error.
pub fn error(fraction: f64) -> String {
    format!("error {}", percent(fraction))
}

/// A part of the whole.
pub fn percent(fraction: f64) -> String {
    format!("{:.2}{PER_CENT}", 100.0 * fraction)
}

/// How much is done.
pub fn whole_percent(fraction: f64) -> String {
    format!("{:.0}{PER_CENT}", 100.0 * fraction)
}

/// A short time.
pub fn milliseconds(time: Duration) -> String {
    format!("{:.0} ms", time.as_secs_f64() * 1e3)
}

/// An amount of memory.
pub fn memory(bytes: u64) -> String {
    format!("{} MiB", bytes >> 20)
}

/// Column and row of a pixel.
pub fn pixel([x, y]: [u32; 2]) -> String {
    format!("{x}, {y}")
}

/// The code of a pixel as it is shown.
pub fn code([r, g, b]: [u8; 3]) -> String {
    format!("RGB {r:>3} {g:>3} {b:>3}")
}

/// What a screen reader says of the pixel at the cross.
pub fn at_cross([x, y]: [u32; 2], [r, g, b]: [u8; 3], nits: f32) -> String {
    format!("Pixel {x}, {y}: RGB {r} {g} {b}, {nits:.3} cd/m²")
}

/// The light of a pixel.
pub fn xyz([x, y, z]: [f32; 3]) -> String {
    format!("XYZ {x:>8.3} {y:>8.3} {z:>8.3}")
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
    format!("{} × {}", size.width(), size.height())
}

/// How many samples are kept for each of its pixels.
pub fn super_sampling(factor: u32) -> String {
    format!("{factor} × {factor}")
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
        Turn::Failed => "failed",
    }
}

/// Scenes that were put into the queue.
pub fn queued(n: usize) -> String {
    format!("Put {} into the queue", indigo_front::messages::count(n, "scene"))
}

/// Takes a scene out of the queue.
pub fn remove(name: &str) -> String {
    format!("Remove {name} from the queue")
}

/// The tab of what was found, in a scene if one is open.
pub fn findings(n: usize, is_open: bool) -> String {
    match (n, is_open) {
        (0, false) => "Findings".to_owned(),
        (0, true) => "No findings".to_owned(),
        (n, _) => indigo_front::messages::count(n, "finding"),
    }
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
        Some(Role::WorkingMaster) => "A master that renders as well",
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
pub fn refused(connections: u64) -> String {
    let connections = indigo_front::messages::count(connections as usize, "connection");
    format!("{connections} refused; the log says why")
}
