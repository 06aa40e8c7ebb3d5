//! The stable codes of diagnostics that come from reading a file.

indigo_decl::codes! {
    /// A file that cannot be read.
    UNREADABLE = "E0001", "<include><pathname>nowhere.igs</pathname></include>";
    /// A `<` that begins no tag.
    STRAY_LESS_THAN = "E0002", "<material><name>a < b</name></material>";
    /// A `&` that begins no known entity.
    BAD_ENTITY = "E0003", "<material><name>salt & pepper</name></material>";
    /// A tag that is not formed as it must be.
    BAD_TAG = "E0004", "<renderer_settings><max depth>7</max depth></renderer_settings>";
    /// The file ends before everything is closed.
    CUT_OFF = "E0005", "<!-- a comment without an end";
    /// A start tag and an end tag that do not belong together.
    MISMATCHED_TAGS = "E0006", "<diffuse><colour>1 1 1</color></diffuse>";
    /// A document type or an entity declaration.
    DOCTYPE = "E0007", "<!DOCTYPE scene>";
    /// No root element, or not the right one.
    WRONG_ROOT = "E0008", "(a file whose root is neither `scene` nor `scenedata`)";
    /// Something outside the root element.
    OUTSIDE_ROOT = "E0009", "</scene><camera/>";
    /// Files that include each other in a circle.
    INCLUDE_CYCLE = "E0010", "<include><pathname>scene.igs</pathname></include>";
    /// A scene that is too large, too deeply nested, or has too many files.
    LIMIT = "E0011", "(elements within elements, more than 100 deep)";
    /// A file in another encoding than UTF-8, or no text at all.
    ENCODING = "E0012", "<?xml version=\"1.0\" encoding=\"utf-16\"?>";
    /// Bytes that are not UTF-8, read as Latin-1.
    NOT_UTF8 = "W0001", "(an ä written as the single byte E4)";

    /// A vertex without a position, or with something that is not a number.
    BAD_VERTEX = "E0101", "<mesh><embedded><vertex pos=\"0 0\"/></embedded></mesh>";
    /// A triangle that is not three indices.
    BAD_TRIANGLE = "E0102", "<mesh><embedded><triangle_set><material_name>a</material_name><tri>0 1</tri></triangle_set></embedded></mesh>";
    /// A triangle that uses a vertex that is not there, or not yet.
    BAD_INDEX = "E0103", "<mesh><embedded><triangle_set><material_name>a</material_name><tri>0 1 2</tri></triangle_set></embedded></mesh>";
    /// A set of triangles without a material.
    NO_MATERIAL = "E0104", "<mesh><embedded><triangle_set><tri>0 1 2</tri></triangle_set></embedded></mesh>";
    /// A name for texture coordinates that are not there, or have another one's name.
    BAD_UV_SET = "E0105", "<mesh><embedded><expose_uv_set><index>3</index><name>bump</name></expose_uv_set></embedded></mesh>";
    /// How many more errors an embedded mesh has than were listed.
    MORE_ERRORS = "E0106", "(more than 20 faults in one embedded mesh)";
    /// Normals that had another length than 1 and were normalised, or left out where they had none.
    NOT_UNIT = "W0011", "<mesh><embedded><vertex pos=\"0 0 0\" normal=\"0 0 2\"/></embedded></mesh>";
    /// Vertices without a normal or without texture coordinates among others that have them.
    INCOMPLETE_VERTICES = "W0012", "<mesh><embedded><vertex pos=\"0 0 0\" uv0=\"0 0\"/><vertex pos=\"1 0 0\"/></embedded></mesh>";
}
