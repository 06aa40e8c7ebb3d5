//! Indigo's .igmesh, versions 1 to 4, little-endian throughout.
//!
//! - A string is a 32-bit length and its bytes; a list is a 32-bit count and its rows.
//! - Header: magic, version, (version 4: compression, filtering), number of uv sets, list of material names, list of
//!   uv set names with their indices.
//! - Body: positions, normals (none, or one per position), (from version 3: uv layout), uv pairs, triangles (three
//!   position indices, three uv indices, material), (from version 2: quadrilaterals likewise).
//! - Compression (version 4): the body is one zstd frame after a 64-bit size, and indices are stored as differences.
//! - Layout 0 keeps the pairs of all sets for one uv index together, layout 1 keeps each set together.
//!
//! Quadrilaterals are cut in two. Uv sets without names are exposed as "default" (the first) and not at all (others).

use indigo_decl::mesh::MeshData;

use crate::bytes::Bytes;
use crate::error::FormatError;
use body::Body;

mod body;
mod unpack;

/// The number that every .igmesh file starts with.
pub const MAGIC: u32 = 5_456_751;
/// More sets than this are taken for damage: memory for a vertex grows with them.
const MAX_UV_SETS: u32 = 8;

/// What stands before the body.
struct Header {
    version: u32,
    compressed: bool,
    uv_sets: u32,
    materials: Vec<String>,
    uv_names: Vec<(String, u32)>,
}

/// Reads a mesh from the bytes of an .igmesh file.
///
/// # Errors
/// At the offset (of the file, or of its decompressed part) of a header that is not .igmesh's, of data that end early,
/// of indices out of range and of coordinates that are not finite; and for a compressed body that is damaged or grows
/// beyond reason.
pub fn read(bytes: &[u8]) -> Result<MeshData, FormatError> {
    let mut bytes = Bytes::new(bytes);
    let header = Header::read(&mut bytes)?;
    if header.compressed {
        let unpacked = unpack::body(&mut bytes)?;
        Body::new(&header).read(Bytes::placed(&unpacked, 0, crate::Position::Unpacked))
    } else {
        Body::new(&header).read(bytes)
    }
}

impl Header {
    fn read(bytes: &mut Bytes) -> Result<Self, FormatError> {
        number(bytes, "the number 5456751 that starts an .igmesh file", |n| n == MAGIC)?;
        let version = number(bytes, "an .igmesh version from 1 to 4", |n| (1..=4).contains(&n))?;
        let mut compressed = false;
        if version >= 4 {
            compressed = number(bytes, "compression 0 (none) or 1 (zstd)", |n| n <= 1)? == 1;
            number(bytes, "filtering 0 or 1", |n| n <= 1)?;
        }
        let uv_sets = number(bytes, "the number of uv sets (at most 8)", |n| n <= MAX_UV_SETS)?;
        let count = list(bytes, 4, "material names")?;
        let materials = (0..count).map(|_| string(bytes)).collect::<Result<_, _>>()?;
        let count = list(bytes, 8, "uv set names")?;
        let mut uv_names = Vec::with_capacity(count);
        for _ in 0..count {
            let name = string(bytes)?;
            let set = number(bytes, &format!("the index of a uv set, of which there are {uv_sets}"), |n| {
                n < uv_sets
            })?;
            uv_names.push((name, set));
        }
        Ok(Self { version, compressed, uv_sets, materials, uv_names })
    }
}

/// The next number, which must satisfy `valid`.
fn number(bytes: &mut Bytes, expected: &str, valid: impl Fn(u32) -> bool) -> Result<u32, FormatError> {
    let at = bytes.offset();
    let number = bytes.u32(expected)?;
    if valid(number) { Ok(number) } else { Err(bytes.error_at(at, expected, number.to_string())) }
}

/// The length of a list whose rows take `row_bytes` or more each.
fn list(bytes: &mut Bytes, row_bytes: usize, what: &str) -> Result<usize, FormatError> {
    let count = bytes.u32(&format!("the number of {what}"))?;
    bytes.promise(count as usize, row_bytes, what)
}

fn string(bytes: &mut Bytes) -> Result<String, FormatError> {
    let length = bytes.u32("the length of a name")?;
    Ok(crate::text::name(bytes.take(length as usize, "a name")?))
}

#[cfg(test)]
mod tests;
