//! The stable codes of diagnostics that come from binding a scene to its declarations.

/// An element that the format does not know.
pub const UNKNOWN_ELEMENT: &str = "W0101";
/// An element of a later version of the format.
pub const LATER_ELEMENT: &str = "W0102";
/// An element that was given twice; the last one counts.
pub const DUPLICATE_ELEMENT: &str = "W0103";
/// An element that still works but has a better successor.
pub const DEPRECATED_ELEMENT: &str = "W0104";
/// An attribute that the format does not know.
pub const UNKNOWN_ATTRIBUTE: &str = "W0105";
/// Text where only elements are expected.
pub const STRAY_TEXT: &str = "W0106";
/// A known element of old exporters that has no meaning any more.
pub const IGNORED_ELEMENT: &str = "W0107";
/// A required element is missing.
pub const MISSING_ELEMENT: &str = "E0201";
/// The text of an element is not of its type.
pub const WRONG_TYPE: &str = "E0202";
/// A number outside its range.
pub const OUT_OF_RANGE: &str = "E0203";
/// None, or more than one, of several alternatives.
pub const WRONG_ALTERNATIVE: &str = "E0204";
/// A known element that this version cannot render yet.
pub const NOT_RENDERED: &str = "E0205";
/// A choice of a later version of the format, for which nothing can stand in.
pub const LATER_ALTERNATIVE: &str = "E0206";
