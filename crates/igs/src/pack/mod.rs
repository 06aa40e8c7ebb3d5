//! Packed scenes (`.pigs`): a scene and every file that it needs, in one zip archive.
//!
//! The scene stands in the archive under its own name. Each file that it names lies beside it as
//! `PACKED_<n>_<name>`, and the scene's paths are rewritten to these names: so an unpacked scene renders as it is, in
//! any folder. Files of equal content are stored once. The bytes of an archive depend on nothing but what is in it:
//! members come in the order in which the scene names them, and all are of 1 January 1980.
//!
//! What is read may come from anybody. [`Pack::open`] refuses whatever could do harm: names that lead out of the
//! archive, links, members that share their bytes, and archives that would become far larger than they are.

mod material;
mod read;
mod resolve;
mod write;

pub use material::MaterialPacks;
pub use read::{Pack, PackError, PackLimits};
pub use resolve::PackResolver;
pub use write::PackWriter;

/// The ending of packed scenes.
pub const PACK_ENDING: &str = "pigs";

/// What the names of the files begin with that a packed scene names, followed by a number and `_`.
const PREFIX: &str = "PACKED_";

/// A name without the prefix that an earlier packing has given it.
fn without_prefix(name: &str) -> &str {
    let rest = name.strip_prefix(PREFIX).and_then(|rest| rest.split_once('_'));
    match rest {
        Some((number, name)) if !number.is_empty() && number.bytes().all(|b| b.is_ascii_digit()) => {
            without_prefix(name)
        }
        _ => name,
    }
}

/// Whether an archive's member is a file of an ending that no other file of the archive names.
fn is_main(name: &str, ending: &str) -> bool {
    !name.contains('/') && name.to_ascii_lowercase().ends_with(ending) && without_prefix(name) == name
}
