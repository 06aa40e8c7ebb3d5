//! The camera of a picture, as its files tell it.

use crate::Metadata;
use indigo_camera::CameraKind;
use indigo_math::Vec3d;

/// What a picture's files say of the camera that took it; lengths in metres, places in the scene's world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CameraFacts {
    /// What kind of camera it is.
    pub kind: CameraKind,
    /// Centre of the lens.
    pub position: Vec3d,
    /// The direction of view, a unit vector.
    pub forwards: Vec3d,
    /// What is up in the picture: a unit vector at right angles to `forwards`.
    pub up: Vec3d,
    /// Width of the sensor.
    pub sensor_width: f64,
    /// Height of the sensor.
    pub sensor_height: f64,
    /// Radius of the aperture.
    pub aperture_radius: f64,
    /// Distance from the sensor to the lens.
    pub lens_sensor_dist: f64,
    /// How far the lens is shifted from before the middle of the sensor: to the right, and up.
    pub lens_shift: [f64; 2],
    /// Distance of the plane of focus, which may be infinite; `None` where nobody has found it yet.
    pub focus_distance: Option<f64>,
    /// How long the shutter is open, in seconds.
    pub exposure_duration: f64,
    /// ISO speed of the film, where the tone mapping has one.
    pub film_iso: Option<f64>,
}

/// A matrix as OpenEXR has it: it stands behind the row vector (x, y, z, 1) that it transforms.
pub(crate) type Matrix = [[f64; 4]; 4];

impl CameraFacts {
    fn right(&self) -> Vec3d {
        self.forwards.cross(self.up)
    }

    /// The focal length over the diameter of the aperture: of the thin lens that images the plane of focus on the sensor.
    /// `None` where that is not known, or there is no lens.
    pub(crate) fn f_number(&self) -> Option<f64> {
        if self.kind != CameraKind::ThinLens {
            return None;
        }
        let focal_length = 1.0 / (1.0 / self.lens_sensor_dist + 1.0 / self.focus_distance?);
        Some(focal_length / (2.0 * self.aperture_radius))
    }

    /// From the world to the camera, left-handed as OpenEXR has it: x to the right, y up and z forwards.
    pub(crate) fn world_to_camera(&self) -> Matrix {
        let axes = [self.right(), self.up, self.forwards];
        let mut matrix = [[0.0; 4]; 4];
        for (column, axis) in axes.iter().enumerate() {
            for (row, v) in axis.to_array().into_iter().enumerate() {
                matrix[row][column] = v;
            }
            matrix[3][column] = -self.position.dot(*axis);
        }
        matrix[3][3] = 1.0;
        matrix
    }

    /// From the world to the picture, from (0, 0) in its upper left corner to (1, 1), and one over the depth in metres, or
    /// the depth itself if rays are parallel. `None` where no matrix does that.
    pub(crate) fn world_to_ndc(&self) -> Option<Matrix> {
        let size = [self.sensor_width, self.sensor_height];
        let shift = [0, 1].map(|i| self.lens_shift[i] / size[i]);
        let projection = match self.kind {
            CameraKind::ThinLens => {
                let [x, y] = size.map(|size| self.lens_sensor_dist / size);
                let middle = [0.5 - shift[0], 0.5 + shift[1], 0.0, 1.0];
                [[x, 0.0, 0.0, 0.0], [0.0, -y, 0.0, 0.0], middle, [0.0, 0.0, 1.0, 0.0]]
            }
            CameraKind::Orthographic => {
                let [x, y] = size.map(f64::recip);
                let middle = [0.5 - shift[0], 0.5 + shift[1], 0.0, 1.0];
                [[x, 0.0, 0.0, 0.0], [0.0, -y, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], middle]
            }
            CameraKind::Spherical => return None,
        };
        let product = |row: [f64; 4], column: usize| (0..4).map(|i| row[i] * projection[i][column]).sum();
        Some(self.world_to_camera().map(|row| [0, 1, 2, 3].map(|column| product(row, column))))
    }

    /// Says the same in words, by the names that scenes use.
    pub fn describe(&self, metadata: &mut Metadata) {
        let vector = |v: Vec3d| format!("{} {} {}", v.x, v.y, v.z);
        metadata.set("camera_type", self.kind.name());
        metadata.set("camera_position", vector(self.position));
        metadata.set("camera_forwards", vector(self.forwards));
        metadata.set("camera_up", vector(self.up));
        metadata.set("sensor_width", self.sensor_width);
        metadata.set("sensor_height", self.sensor_height);
        metadata.set("aperture_radius", self.aperture_radius);
        metadata.set("lens_sensor_dist", self.lens_sensor_dist);
        if self.lens_shift != [0.0; 2] {
            metadata.set("lens_shift_right_distance", self.lens_shift[0]);
            metadata.set("lens_shift_up_distance", self.lens_shift[1]);
        }
        if let Some(distance) = self.focus_distance {
            metadata.set("focus_distance", distance);
        }
        metadata.set("exposure_duration", self.exposure_duration);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn camera() -> CameraFacts {
        CameraFacts {
            kind: CameraKind::ThinLens,
            position: Vec3d::new(1.0, 2.0, 3.0),
            forwards: Vec3d::new(0.0, 1.0, 0.0),
            up: Vec3d::new(0.0, 0.0, 1.0),
            sensor_width: 0.036,
            sensor_height: 0.024,
            aperture_radius: 0.0025,
            lens_sensor_dist: 0.02,
            lens_shift: [0.003, -0.006],
            focus_distance: Some(f64::INFINITY),
            exposure_duration: 0.01,
            film_iso: None,
        }
    }

    fn transformed(p: [f64; 3], matrix: Matrix) -> [f64; 4] {
        let p = [p[0], p[1], p[2], 1.0];
        [0, 1, 2, 3].map(|column: usize| (0..4).map(|row| p[row] * matrix[row][column]).sum())
    }

    #[test]
    fn points_of_the_world_are_where_the_picture_shows_them() {
        let camera = camera();
        // Five metres ahead, two to the right and one up.
        let p = [3.0, 7.0, 4.0];
        assert_eq!(transformed(p, camera.world_to_camera()), [2.0, 1.0, 5.0, 1.0]);
        let perspective =
            [0.5 + (2.0 / 5.0 * 0.02 - 0.003) / 0.036, 0.5 - (1.0 / 5.0 * 0.02 + 0.006) / 0.024, 1.0 / 5.0];
        let parallel = [0.5 + (2.0 - 0.003) / 0.036, 0.5 - (1.0 + 0.006) / 0.024, 5.0];
        for (kind, expected) in [(CameraKind::ThinLens, perspective), (CameraKind::Orthographic, parallel)] {
            let matrix = CameraFacts { kind, ..camera }.world_to_ndc().expect("a matrix");
            let [x, y, z, w] = transformed(p, matrix);
            for (got, expected) in [x, y, z].into_iter().zip(expected) {
                assert!((got / w - expected).abs() < 1e-9 * expected.abs(), "{got} {w} {expected}");
            }
        }
        assert_eq!(CameraFacts { kind: CameraKind::Spherical, ..camera }.world_to_ndc(), None);
    }

    /// By the lens equation: focused at twice its focal length a lens stands as far from the sensor.
    #[test]
    fn the_f_number_is_that_of_the_lens() {
        assert_eq!(camera().f_number(), Some(4.0));
        assert_eq!(CameraFacts { focus_distance: Some(0.02), ..camera() }.f_number(), Some(2.0));
        assert_eq!(CameraFacts { focus_distance: None, ..camera() }.f_number(), None);
    }
}
