//! Which reader a mesh file needs.

use indigo_decl::mesh::MeshData;

use crate::error::{FormatError, Position};
use crate::{igmesh, obj, ply, three_ds};

/// The kinds of mesh file that can be read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MeshFormat {
    /// Wavefront .obj.
    Obj,
    /// Stanford .ply.
    Ply,
    /// Autodesk 3D Studio .3ds.
    ThreeDs,
    /// Indigo's .igmesh.
    Igmesh,
}

impl MeshFormat {
    /// Every kind with its file name extension.
    pub const ALL: [(Self, &'static str); 4] =
        [(Self::Obj, "obj"), (Self::Ply, "ply"), (Self::ThreeDs, "3ds"), (Self::Igmesh, "igmesh")];

    /// The kind that a file name's extension says, in whatever case.
    pub fn from_name(file_name: &str) -> Option<Self> {
        let (_, extension) = file_name.rsplit_once('.')?;
        Self::ALL
            .into_iter()
            .find(|(_, known)| extension.eq_ignore_ascii_case(known))
            .map(|(format, _)| format)
    }

    /// The kind that the content looks like.
    pub fn from_content(bytes: &[u8]) -> Option<Self> {
        match bytes {
            [b'p', b'l', b'y', b'\n' | b'\r', ..] => Some(Self::Ply),
            [b'M', b'M', a, b, c, d, ..] if u32::from_le_bytes([*a, *b, *c, *d]) as usize <= bytes.len() => {
                Some(Self::ThreeDs)
            }
            _ if bytes.starts_with(&igmesh::MAGIC.to_le_bytes()) => Some(Self::Igmesh),
            _ => looks_like_obj(bytes).then_some(Self::Obj),
        }
    }

    /// Reads a file of this kind.
    ///
    /// # Errors
    /// As the kind's own `read`.
    pub fn read(self, bytes: &[u8]) -> Result<MeshData, FormatError> {
        match self {
            Self::Obj => obj::read(bytes),
            Self::Ply => ply::read(bytes),
            Self::ThreeDs => three_ds::read(bytes),
            Self::Igmesh => igmesh::read(bytes),
        }
    }
}

/// Reads a mesh file of the kind that its name's extension says, or else its content.
///
/// # Errors
/// Where the kind cannot be told, with a list of the known ones; else as the kind's own `read`.
pub fn read_mesh(file_name: &str, bytes: &[u8]) -> Result<MeshData, FormatError> {
    let Some(format) = MeshFormat::from_name(file_name).or_else(|| MeshFormat::from_content(bytes)) else {
        let known = MeshFormat::ALL.map(|(_, extension)| format!(".{extension}")).join(", ");
        return Err(FormatError::new(
            Position::Byte(0),
            format!("a mesh file of a known type ({known})"),
            format!("'{file_name}', whose name and content are of none of them"),
        ));
    };
    format.read(bytes)
}

/// Whether the first line that is neither blank nor a comment starts with one of the format's commonest words.
fn looks_like_obj(bytes: &[u8]) -> bool {
    let words: [&[u8]; 9] = [b"v", b"vt", b"vn", b"f", b"o", b"g", b"s", b"mtllib", b"usemtl"];
    bytes
        .split(|&byte| byte == b'\n' || byte == b'\r')
        .map(<[u8]>::trim_ascii)
        .find(|line| !line.is_empty() && !line.starts_with(b"#"))
        .and_then(|line| line.split(u8::is_ascii_whitespace).next())
        .is_some_and(|word| words.contains(&word))
}

#[cfg(test)]
mod tests {
    use super::*;

    const OBJ: &[u8] = b"# a triangle\n\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\nf 1 2 3\n";

    #[test]
    fn the_extension_decides_in_any_case() {
        assert_eq!(MeshFormat::from_name("a.b/CUBE.OBJ"), Some(MeshFormat::Obj));
        assert_eq!(MeshFormat::from_name("x.3DS"), Some(MeshFormat::ThreeDs));
        assert_eq!(MeshFormat::from_name("obj"), None);
        assert!(read_mesh("model.ply", OBJ).is_err(), "content does not overrule a known extension");
    }

    #[test]
    fn the_content_decides_where_the_extension_is_unknown() {
        assert_eq!(read_mesh("model.mesh", OBJ).map(|mesh| mesh.triangles), Ok(vec![[0, 1, 2]]));
        assert_eq!(MeshFormat::from_content(b"ply\nformat ascii 1.0\n"), Some(MeshFormat::Ply));
        assert_eq!(MeshFormat::from_content(b"MM\x06\0\0\0"), Some(MeshFormat::ThreeDs));
        assert_eq!(MeshFormat::from_content(&5_456_751_u32.to_le_bytes()), Some(MeshFormat::Igmesh));
    }

    #[test]
    fn an_unknown_type_is_told_with_the_known_ones() {
        let error = read_mesh("model.fbx", b"Kaydara FBX").unwrap_err().to_string();
        assert!(error.contains(".obj, .ply, .3ds, .igmesh") && error.contains("model.fbx"), "{error}");
    }
}
