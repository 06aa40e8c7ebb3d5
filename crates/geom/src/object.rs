//! The objects of a scene.

use indigo_math::{Transform, Vec3d};

/// One object; its id is its index in the list given to [`Accel::build`](crate::Accel::build).
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Object {
    /// A mesh somewhere in the scene.
    Mesh {
        /// Index in the list of meshes.
        mesh: u32,
        /// Object to render space.
        transform: Transform,
    },
    /// A sphere; its normals point outwards.
    Sphere {
        /// Centre in render space, metres.
        center: Vec3d,
        /// Radius in metres, above 0.
        radius: f64,
    },
    /// An infinite plane: the points p with `normal · p = dist`. Its front is where the normal points.
    Plane {
        /// Normal of any length but 0.
        normal: Vec3d,
        /// Distance from the origin along the normal, in lengths of the normal.
        dist: f64,
        /// From the point of the plane that is nearest to this one its texture coordinates count.
        uv_origin: Vec3d,
    },
}

impl Object {
    /// Whether the numbers have a meaning (finite, radius above 0, normal not 0), and those of a
    /// transformation and its inverse fit into single precision.
    pub(crate) fn is_sound(&self) -> bool {
        match *self {
            Self::Mesh { transform, .. } => {
                let origin = transform.inverse_point(Vec3d::ZERO);
                let axes = [Vec3d::new(1.0, 0.0, 0.0), Vec3d::new(0.0, 1.0, 0.0), Vec3d::new(0.0, 0.0, 1.0)];
                let images = axes.map(|a| [transform.vector(a), transform.inverse_vector(a)]);
                // Rays are taken into the mesh's own space in single precision.
                let fits = |v: &Vec3d| v.abs().max_component() <= f64::from(f32::MAX);
                images.iter().flatten().chain([&transform.origin(), &origin]).all(fits)
            }
            Self::Sphere { center, radius } => center.is_finite() && radius > 0.0 && radius.is_finite(),
            Self::Plane { normal, dist, uv_origin } => {
                normal.try_normalized().is_some() && dist.is_finite() && uv_origin.is_finite()
            }
        }
    }

    /// Gives a plane a unit normal.
    pub(crate) fn normalize(&mut self) {
        if let Self::Plane { normal, dist, .. } = self {
            // Scale first, as `try_normalized` does, so that extreme lengths keep their digits.
            let largest = normal.abs().max_component();
            let scaled = *normal / largest;
            *dist = *dist / largest / scaled.length();
            *normal = scaled.normalized();
        }
    }
}
