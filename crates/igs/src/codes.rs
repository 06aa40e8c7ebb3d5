//! The stable codes of diagnostics that come from reading a file.

/// A file that cannot be read.
pub const UNREADABLE: &str = "E0001";
/// A `<` that begins no tag.
pub const STRAY_LESS_THAN: &str = "E0002";
/// A `&` that begins no known entity.
pub const BAD_ENTITY: &str = "E0003";
/// A tag that is not formed as it must be.
pub const BAD_TAG: &str = "E0004";
/// The file ends before everything is closed.
pub const CUT_OFF: &str = "E0005";
/// A start tag and an end tag that do not belong together.
pub const MISMATCHED_TAGS: &str = "E0006";
/// A document type or an entity declaration.
pub const DOCTYPE: &str = "E0007";
/// No root element, or not the right one.
pub const WRONG_ROOT: &str = "E0008";
/// Something outside the root element.
pub const OUTSIDE_ROOT: &str = "E0009";
/// Files that include each other in a circle.
pub const INCLUDE_CYCLE: &str = "E0010";
/// More than [`Limits`](crate::Limits) allow.
pub const LIMIT: &str = "E0011";
/// A file in another encoding than UTF-8.
pub const ENCODING: &str = "E0012";
/// Bytes that are not UTF-8, read as Latin-1.
pub const NOT_UTF8: &str = "W0001";

/// A vertex without a position, or with something that is not a number.
pub const BAD_VERTEX: &str = "E0101";
/// A triangle that is not three indices.
pub const BAD_TRIANGLE: &str = "E0102";
/// A triangle that uses a vertex that is not there (yet).
pub const BAD_INDEX: &str = "E0103";
/// A set of triangles without a material.
pub const NO_MATERIAL: &str = "E0104";
/// A name for texture coordinates that are not there.
pub const BAD_UV_SET: &str = "E0105";
/// How many more errors an embedded mesh has than were listed.
pub const MORE_ERRORS: &str = "E0106";
/// Normals that had another length than 1 and were normalised.
pub const NOT_UNIT: &str = "W0011";
/// Vertices without a normal or without texture coordinates among others that have them.
pub const INCOMPLETE_VERTICES: &str = "W0012";
