//! The stable codes of diagnostics, and those of binding a scene to its declarations.

/// A code of diagnostics, documented.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Code {
    /// The code: `E` for errors, `W` for warnings, and four digits that never change their meaning.
    pub code: &'static str,
    /// What it says, in a sentence.
    pub meaning: &'static str,
    /// A piece of a scene that has the fault; in brackets where it takes more than a piece to show.
    /// Empty where the meaning says it all.
    pub example: &'static str,
}

/// Declares the codes of a module: a constant for each, and the list `ALL` for the documentation.
///
/// ```
/// indigo_decl::codes! {
///     /// A bird that cannot fly.
///     FLIGHTLESS = "E9999", "<bird>ostrich</bird>";
/// }
/// assert_eq!((FLIGHTLESS, ALL[0].meaning), ("E9999", " A bird that cannot fly."));
/// ```
#[macro_export]
macro_rules! codes {
    ($($(#[doc = $doc:literal])+ $name:ident = $code:literal $(, $example:literal)?;)*) => {
        $($(#[doc = $doc])+ pub const $name: &str = $code;)*

        /// Every code of this module.
        pub static ALL: &[$crate::codes::Code] = &[$($crate::codes::Code {
            code: $code,
            meaning: concat!($($doc),+),
            example: concat!($($example)?),
        }),*];
    };
}

codes! {
    /// An element that the format does not know.
    UNKNOWN_ELEMENT = "W0101", "<sphere><center>0 0 1</center><radius>1</radius><material_nam>a</material_nam></sphere>";
    /// An element of a later version of the format.
    LATER_ELEMENT = "W0102", "<metadata>made by hand</metadata>";
    /// An element that was given twice, of which the last one counts, or that has no effect beside another one.
    DUPLICATE_ELEMENT = "W0103", "<rotation><matrix>1 0 0 0 1 0 0 0 1</matrix><matrix>1 0 0 0 1 0 0 0 1</matrix></rotation>";
    /// An element that still works but has a better successor.
    DEPRECATED_ELEMENT = "W0104", "<diffuse><colour>0.5 0.5 0.5</colour></diffuse>";
    /// An attribute that the format does not know.
    UNKNOWN_ATTRIBUTE = "W0105", "<plane colour=\"red\"></plane>";
    /// Text where only elements are expected.
    STRAY_TEXT = "W0106", "<background>blue</background>";
    /// A known element of old exporters that has no meaning any more.
    IGNORED_ELEMENT = "W0107", "<renderer_settings><strata_width>8</strata_width></renderer_settings>";
    /// A number that is likely to be meant in another unit.
    SUSPECT_UNIT = "W0108", "(a `regular_tabulated` whose wavelengths are in nanometres)";
    /// A required element is missing.
    MISSING_ELEMENT = "E0201", "<mesh><name>hand</name></mesh>";
    /// The text of an element is not of its type.
    WRONG_TYPE = "E0202", "<renderer_settings><width>wide</width></renderer_settings>";
    /// A number outside its range.
    OUT_OF_RANGE = "E0203", "<renderer_settings><width>-800</width></renderer_settings>";
    /// None, or more than one, of several alternatives.
    WRONG_ALTERNATIVE = "E0204", "<tonemapping><linear><scale>1</scale></linear><camera/></tonemapping>";
    /// A known element that this version cannot render yet.
    NOT_RENDERED = "E0205", "(an element of the reference that has no effect in this version)";
    /// Elements that are sound one by one, but not together.
    CONTRADICTION = "E0207", "(a blend of two specular materials)";
}
