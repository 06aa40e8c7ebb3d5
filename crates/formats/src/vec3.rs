//! The little double-precision vector arithmetic that load-time decisions (areas, turns, normals) need.

/// A point or direction in double precision.
pub(crate) type Vec3 = [f64; 3];

pub(crate) fn to_f64(v: [f32; 3]) -> Vec3 {
    v.map(f64::from)
}

pub(crate) fn sub(a: Vec3, b: Vec3) -> Vec3 {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

pub(crate) fn dot(a: Vec3, b: Vec3) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(crate) fn cross(a: Vec3, b: Vec3) -> Vec3 {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// The unit vector along `v`, or none where it has no length or is not finite.
pub(crate) fn unit(v: Vec3) -> Option<[f32; 3]> {
    let length = dot(v, v).sqrt();
    (length.is_finite() && length > 0.0).then(|| v.map(|x| (x / length) as f32))
}
