//! A writer, for generated scenes.

use indigo_decl::mesh::MeshData;

/// The mesh as a binary little-endian .ply: positions, normals if there are any, the first uv set if there is one, and
/// triangles. Materials are left out: the format has no place for their names.
pub fn write_binary(mesh: &MeshData) -> Vec<u8> {
    let uvs = mesh.uv_sets.first();
    let has_normals = !mesh.normals.is_empty();
    let mut out = header(mesh, has_normals, uvs.is_some());
    out.reserve(mesh.positions.len() * 32 + mesh.triangles.len() * 13);
    let mut put = |values: &[f32]| {
        for value in values {
            out.extend_from_slice(&value.to_le_bytes());
        }
    };
    for (i, position) in mesh.positions.iter().enumerate() {
        put(position);
        if has_normals {
            put(&mesh.normals.get(i).copied().unwrap_or_default());
        }
        if let Some(uvs) = uvs {
            put(&uvs.get(i).copied().unwrap_or_default());
        }
    }
    for triangle in &mesh.triangles {
        out.push(3);
        for index in triangle {
            out.extend_from_slice(&index.to_le_bytes());
        }
    }
    out
}

fn header(mesh: &MeshData, normals: bool, uvs: bool) -> Vec<u8> {
    let mut names = vec!["x", "y", "z"];
    if normals {
        names.extend(["nx", "ny", "nz"]);
    }
    if uvs {
        names.extend(["u", "v"]);
    }
    let properties: Vec<String> = names.iter().map(|name| format!("property float {name}")).collect();
    let properties = properties.join("\n");
    format!(
        "ply\nformat binary_little_endian 1.0\nelement vertex {}\n{properties}\nelement face {}\n\
         property list uchar uint vertex_indices\nend_header\n",
        mesh.positions.len(),
        mesh.triangles.len(),
    )
    .into_bytes()
}
