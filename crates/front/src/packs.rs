//! Packed scenes, read and made.

use crate::flags::Arguments;
use crate::load::with_load_options;
use indigo_decl::Resolver as _;
use indigo_igs::pack::{PACK_ENDING, PackLimits, PackResolver};
use indigo_render::disk::{DiskResolver, read_limited};
use indigo_scene::load_contents;
use std::io::Cursor;
use std::path::Path;

/// Whether a file is a packed scene, by its name.
pub fn is_pack(path: &str) -> bool {
    Path::new(path).extension().is_some_and(|ending| ending.eq_ignore_ascii_case(PACK_ENDING))
}

/// Where the files of a packed scene come from.
///
/// # Errors
/// Why it is not read.
pub fn open<'a>(
    path: &'a str,
    disk: &'a DiskResolver,
    resources: &'a DiskResolver,
) -> Result<PackResolver<'a>, String> {
    let file = disk.read(path, "").map_err(|error| format!("cannot read {path}: {error}"))?;
    PackResolver::open(path, file.bytes, &PackLimits::default(), disk, resources)
        .map_err(|error| format!("{path}: {error}"))
}

/// A scene packed in memory, or the bytes of one that is packed already.
///
/// # Errors
/// Why it cannot be packed.
pub fn in_memory(scene: &str, arguments: &Arguments) -> Result<Vec<u8>, String> {
    if is_pack(scene) {
        return read_limited(Path::new(scene)).map_err(|error| format!("cannot read {scene}: {error}"));
    }
    let (packed, _) = with_load_options(scene, arguments, |options| {
        let loaded = load_contents(scene, options);
        let contents = loaded.contents.ok_or_else(|| format!("{scene} cannot be packed"))?;
        let mut bytes = Cursor::new(vec![]);
        let written = contents.pack(&mut bytes, &loaded.sources, options.resolver);
        written.map_err(|error| format!("{scene} cannot be packed: {error}"))?;
        Ok(bytes.into_inner())
    })?;
    packed
}
