//! Files that bring in other files.

use indigo_decl::{Block, Element, Field, Kind, Presence};

/// The declaration of `include`.
pub static INCLUDE: Block = Block::new(
    "include",
    "Brings in the elements of another file, in this place. The root of that file is `scenedata` or `scene`.",
    &[
        Field::new(
            "pathname",
            Kind::Path,
            Presence::Required,
            "The file, relative to the scene or else to the file that includes it: a scene file, a material (`.igm`), or a \
             packed one (`.pigm`).",
        ),
        Field::new(
            "offset_uids",
            Kind::Bool,
            Presence::Default("false"),
            "Whether the uids of that file are its own, so that nothing outside can be meant by them.",
        ),
    ],
)
.with_example("<include><pathname>materials.igs</pathname></include>");

/// Makes the uids among some elements, and all below them, those of one file: number `file`.
pub(crate) fn set_uids_apart(elements: &mut [Element], file: usize) {
    for element in elements {
        if (&*element.name == "uid" || element.name.ends_with("_uid")) && !element.text.value.is_empty() {
            element.text.value = format!("{} of file {file}", element.text.value).into();
        }
        set_uids_apart(&mut element.children, file);
    }
}
