//! The few vector operations that the generators need.

/// A point or direction.
pub type Vector = [f64; 3];

/// a + b.
pub fn add(a: Vector, b: Vector) -> Vector {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

/// a - b.
pub fn sub(a: Vector, b: Vector) -> Vector {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// k a.
pub fn scale(k: f64, a: Vector) -> Vector {
    [k * a[0], k * a[1], k * a[2]]
}

/// a · b.
pub fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// a × b.
pub fn cross(a: Vector, b: Vector) -> Vector {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// a / |a|, for a that is not 0.
pub fn normalize(a: Vector) -> Vector {
    scale(1.0 / dot(a, a).sqrt(), a)
}
