//! Normals from smoothing groups.

use super::object::{Face, Object};
use crate::vec3::{Vec3, cross, dot, sub, to_f64, unit};

/// Different sets of smoothing groups that may meet at one vertex. Real objects have a few; the limit keeps the time
/// linear for files made to annoy.
const MAX_SETS: usize = 64;

/// The faces at one vertex that have the same set of groups, summed.
struct Set {
    vertex: u16,
    groups: u32,
    /// Sum of the faces' normals, each weighted by the face's angle at the vertex.
    normal: Vec3,
}

/// The normal at each corner of each face, and how many corners are flat only because too many sets meet there.
///
/// A corner's normal sums those of all faces at its vertex which share a smoothing group with its face, weighted by
/// their angles there (G. Thürmer, C. A. Wüthrich, "Computing vertex normals from polygonal facets", J. Graphics Tools
/// 3(1), 1998), so that it does not depend on how a quadrilateral was cut.
pub(super) fn corner_normals(object: &Object) -> (Vec<[[f32; 3]; 3]>, usize) {
    let sets = sets_by_vertex(object);
    let at_vertex = |vertex: u16| {
        let start = sets.partition_point(|set| set.vertex < vertex);
        let end = sets.partition_point(|set| set.vertex <= vertex);
        sets.get(start..end).unwrap_or_default()
    };
    let mut unsmoothed = 0;
    let normals = object.faces.iter().map(|face| {
        let flat = unit(face_normal(object, face)).unwrap_or([0.0, 0.0, 1.0]);
        face.corners.map(|vertex| {
            let sets = at_vertex(vertex);
            if face.smoothing == 0 {
                return flat;
            }
            if sets.len() > MAX_SETS {
                unsmoothed += 1;
                return flat;
            }
            let mut sum = [0.0; 3];
            for set in sets.iter().filter(|set| set.groups & face.smoothing != 0) {
                sum = add(sum, set.normal);
            }
            unit(sum).unwrap_or(flat)
        })
    });
    (normals.collect(), unsmoothed)
}

/// All sets, ordered by vertex.
fn sets_by_vertex(object: &Object) -> Vec<Set> {
    let smooth = object.faces.iter().filter(|face| face.smoothing != 0);
    let mut sets: Vec<Set> = smooth
        .flat_map(|face| {
            let weighted = weighted_normals(object, face);
            let corner = |(vertex, normal)| Set { vertex, groups: face.smoothing, normal };
            face.corners.into_iter().zip(weighted).map(corner)
        })
        .collect();
    // Stable, so that sums do not depend on anything but the file.
    sets.sort_by_key(|set| (set.vertex, set.groups));
    sets.dedup_by(|next, set| {
        let same = (next.vertex, next.groups) == (set.vertex, set.groups);
        if same {
            set.normal = add(set.normal, next.normal);
        }
        same
    });
    sets
}

/// The face's unit normal times its angle, at each corner; zeros for a face of no area.
fn weighted_normals(object: &Object, face: &Face) -> [Vec3; 3] {
    let [a, b, c] = points(object, face);
    let Some(normal) = unit(face_normal(object, face)) else {
        return [[0.0; 3]; 3];
    };
    let at = |p: Vec3, q: Vec3, r: Vec3| to_f64(normal).map(|x| x * angle(sub(q, p), sub(r, p)));
    [at(a, b, c), at(b, c, a), at(c, a, b)]
}

fn angle(u: Vec3, v: Vec3) -> f64 {
    let w = cross(u, v);
    dot(w, w).sqrt().atan2(dot(u, v))
}

fn face_normal(object: &Object, face: &Face) -> Vec3 {
    let [a, b, c] = points(object, face);
    cross(sub(b, a), sub(c, a))
}

fn points(object: &Object, face: &Face) -> [Vec3; 3] {
    face.corners.map(|i| to_f64(object.positions.get(usize::from(i)).copied().unwrap_or_default()))
}

fn add(a: Vec3, b: Vec3) -> Vec3 {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}
