//! How much memory a render will surely need, and whether it is there.

use crate::session::SessionError;
use indigo_film::{FilmSize, LayerKind, MasterFilm};
use indigo_imaging::Diffraction;
use indigo_scene::Scene;
use indigo_transport::driver::Driver;
use std::path::{Path, PathBuf};

/// What developing a film holds for each internal pixel: XYZ and alpha in single precision, and whether there
/// is a sample.
const DEVELOPED_PIXEL: u64 = 4 * size_of::<f32>() as u64 + 1;

/// The least that rendering and saving takes: the sums of so many films of one kind, the copy of one that is saved,
/// that copy developed, and what diffracts it, if `is_diffracted`. What the workers hold comes on top, as far as they
/// touch it.
pub(crate) fn needed(
    size: FilmSize,
    kinds: impl IntoIterator<Item = LayerKind>,
    films: u64,
    is_diffracted: bool,
) -> u64 {
    let diffraction = if is_diffracted { Diffraction::bytes_needed(size) } else { 0 };
    let developed = DEVELOPED_PIXEL * size.internal_pixels() as u64;
    (films + 1) * MasterFilm::bytes_needed(size, kinds) + developed + diffraction
}

/// Whether a master has room for the film of a scene, a copy that it saves, and `beside` bytes more.
///
/// # Errors
/// [`SessionError::Memory`], with what it takes.
pub fn check_master(scene: &Scene, beside: u64) -> Result<(), SessionError> {
    let driver = Driver::new(scene, 0);
    let kinds = driver.layers().iter().map(|layer| layer.0);
    let size = scene.film.size;
    let needed = needed(size, kinds, 1, scene.picture.diffraction.is_some()) + beside;
    check(size, needed, available())
}

/// Better an answer at the start than an end in the midst of rendering.
pub(crate) fn check(size: FilmSize, needed: u64, available: Option<u64>) -> Result<(), SessionError> {
    match available {
        Some(available) if needed > available => Err(SessionError::Memory { size, needed, available }),
        _ => Ok(()),
    }
}

/// Bytes that the system can still give, where it says so: only Linux does, for itself and for the group of
/// processes that this one is in.
pub(crate) fn available() -> Option<u64> {
    let system = std::fs::read_to_string("/proc/meminfo").ok().and_then(|text| available_of(&text));
    [system, group_available()].into_iter().flatten().min()
}

/// What the group of this process, and every group round it, may still take.
fn group_available() -> Option<u64> {
    let groups = std::fs::read_to_string("/proc/self/cgroup").ok()?;
    let own = groups.lines().find_map(|line| line.strip_prefix("0::/"))?;
    let folder = Path::new("/sys/fs/cgroup").join(own);
    let number = |path: PathBuf| std::fs::read_to_string(path).ok()?.trim().parse::<u64>().ok();
    let left = |group: &Path| {
        // Without a limit it says `max`.
        let limit = number(group.join("memory.max"))?;
        Some(limit.saturating_sub(number(group.join("memory.current")).unwrap_or(0)))
    };
    folder.ancestors().take_while(|group| group.starts_with("/sys/fs/cgroup")).filter_map(left).min()
}

/// The line `MemAvailable:  123 kB`.
fn available_of(meminfo: &str) -> Option<u64> {
    let line = meminfo.lines().find_map(|line| line.strip_prefix("MemAvailable:"))?;
    let kib: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    kib.checked_mul(1024)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn memory_is_counted_in_bytes() {
        let size = FilmSize::new(100, 50, 2).expect("a size");
        // 20,000 internal pixels: sums of four doubles, a count, both twice, and what is developed.
        assert_eq!(needed(size, [LayerKind::PerPixel], 1, false), 20_000 * (2 * 40 + 17));
        assert_eq!(
            needed(size, [LayerKind::PerPixel, LayerKind::PerScreen], 1, false),
            20_000 * (2 * 72 + 17)
        );
        assert_eq!(needed(size, [LayerKind::PerPixel], 3, false), 20_000 * (4 * 40 + 17));
        // Of 5,000 output pixels. The spectra of three kernels over a period of twice the width and height, of which half
        // is kept, take 3 · 16 bytes and what falls outside 3 · 4; rows that kernels are made of 3 · 16, their sums 3 · 4;
        // means take 17. Periods are a little longer.
        let filter = needed(size, [LayerKind::PerPixel], 1, true) - 20_000 * (2 * 40 + 17);
        assert!((5_000 * 137..5_000 * 145).contains(&filter), "{filter}");
        assert_eq!(available_of("MemTotal: 9 kB\nMemAvailable:    2048 kB\n"), Some(2 << 20));
        assert_eq!(available_of("MemTotal: 9 kB\n"), None);
    }
}
