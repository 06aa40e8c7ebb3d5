//! The stable codes of diagnostics that come from lowering a scene.

indigo_decl::codes! {
    /// A switch that is on by default but that nothing renders yet.
    DEFAULT_NOT_RENDERED = "W0301";
    /// A name that is defined twice; the last definition counts.
    DUPLICATE_NAME = "W0302";
    /// Something about a mesh or picture file that its user should know.
    FILE_NOTE = "W0303";
    /// The sensor's aspect ratio is not the picture's.
    ASPECT_RATIO = "W0304";
    /// A scene without `tonemapping`.
    NO_TONEMAPPING = "W0305";
    /// A scene without light.
    NO_LIGHT = "W0306";
    /// The normal of a plane is not of length 1.
    NOT_UNIT = "W0307";
    /// Texels of an environment map that cannot be light.
    BAD_TEXELS = "W0308";
    /// A turbidity beyond what the model of the sky knows.
    TURBIDITY = "W0309";
    /// A name that nothing defines.
    UNKNOWN_NAME = "E0301";
    /// A file that cannot be had.
    MISSING_FILE = "E0302";
    /// A file that cannot be understood.
    BAD_FILE = "E0303";
    /// A transformation that cannot be inverted, or directions that span no plane.
    SINGULAR = "E0304";
    /// A scene without a camera.
    NO_CAMERA = "E0305";
    /// Geometry that cannot be built.
    GEOMETRY = "E0306";
    /// A texture on a mesh without the texture coordinates that it asks for.
    NO_UV_SET = "E0307";
    /// A lamp whose power is given but that has no light to scale.
    NO_FLUX = "E0308";
    /// A name of a white that is not known.
    UNKNOWN_WHITE = "E0309";
    /// A picture or a region of impossible size.
    PICTURE_SIZE = "E0310";
    /// A plane where light is traced from both ends.
    PLANE_BIDIRECTIONAL = "E0311";
    /// More media than can be told apart.
    TOO_MANY_MEDIA = "E0320";
}
