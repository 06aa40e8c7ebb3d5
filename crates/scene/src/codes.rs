//! The stable codes of diagnostics that come from lowering a scene.

/// A switch that is on by default but that nothing renders yet.
pub const DEFAULT_NOT_RENDERED: &str = "W0301";
/// A name that is defined twice; the last definition counts.
pub const DUPLICATE_NAME: &str = "W0302";
/// Something about a mesh or picture file that its user should know.
pub const FILE_NOTE: &str = "W0303";
/// The sensor's aspect ratio is not the picture's.
pub const ASPECT_RATIO: &str = "W0304";
/// A scene without `tonemapping`.
pub const NO_TONEMAPPING: &str = "W0305";
/// A scene without light.
pub const NO_LIGHT: &str = "W0306";
/// A name that nothing defines.
pub const UNKNOWN_NAME: &str = "E0301";
/// A file that cannot be had.
pub const MISSING_FILE: &str = "E0302";
/// A file that cannot be understood.
pub const BAD_FILE: &str = "E0303";
/// A transformation that cannot be inverted, or directions that span no plane.
pub const SINGULAR: &str = "E0304";
/// A scene without a camera.
pub const NO_CAMERA: &str = "E0305";
/// Geometry that cannot be built.
pub const GEOMETRY: &str = "E0306";
/// A texture on a mesh without the texture coordinates that it asks for.
pub const NO_UV_SET: &str = "E0307";
/// A lamp whose power is given but that has no light to scale.
pub const NO_FLUX: &str = "E0308";
/// A name of a white that is not known.
pub const UNKNOWN_WHITE: &str = "E0309";
/// A picture or a region of impossible size.
pub const PICTURE_SIZE: &str = "E0310";
/// A plane where light is traced from both ends.
pub const PLANE_BIDIRECTIONAL: &str = "E0311";
