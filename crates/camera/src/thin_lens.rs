//! A thin lens before a flat sensor.
//!
//! The lens centre is the camera's position; the sensor lies `lens_sensor_dist` behind it. A point
//! of the sensor is imaged to the plane of focus through the lens centre, and every ray from it
//! through the lens meets that image point. The horizontal angle of view is
//! 2 atan(sensor_width / (2 lens_sensor_dist)), whatever the focus.

use indigo_math::warp::concentric_disk;
use indigo_math::{Real, Vec2, Vec3, Vec3d};

/// What a thin lens is made from; lengths in metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ThinLensParameters {
    /// Lens centre in render space.
    pub position: Vec3d,
    /// Viewing direction, of any length.
    pub forwards: Vec3d,
    /// Which way is up in the picture, of any length, not along `forwards`.
    pub up: Vec3d,
    /// Radius of the aperture.
    pub aperture_radius: f64,
    /// Distance of the plane of focus; may be infinite.
    pub focus_distance: f64,
    /// Width of the sensor.
    pub sensor_width: f64,
    /// Height of the sensor.
    pub sensor_height: f64,
    /// Distance from the sensor to the lens.
    pub lens_sensor_dist: f64,
    /// Whether the cos⁴ law of natural vignetting holds.
    pub vignetting: bool,
}

/// A camera that is a thin lens.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ThinLens {
    position: Vec3,
    right: Vec3,
    up: Vec3,
    forwards: Vec3,
    aperture_radius: Real,
    /// 1 / focus distance; 0 for a focus at infinity.
    inverse_focus: Real,
    /// Sensor size over lens-sensor distance.
    tangents: Vec2,
    vignetting: bool,
}

/// A ray that leaves the camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CameraRay {
    /// Point on the lens.
    pub origin: Vec3,
    /// Unit direction.
    pub direction: Vec3,
    /// What its radiance counts on the film: 1 on the axis, cos⁴ off it with vignetting.
    pub importance: Real,
}

impl ThinLens {
    /// A lens from its parameters; `None` where `forwards` and `up` do not span a plane.
    pub fn new(p: &ThinLensParameters) -> Option<Self> {
        let forwards = p.forwards.try_normalized()?;
        let up = p.up.try_normalized()?;
        let right = forwards.cross(up);
        // Below this sine the direction of `up` is lost in rounding.
        if right.length() < 1e-9 {
            return None;
        }
        let right = right.normalized();
        Some(Self {
            position: p.position.cast(),
            right: right.cast(),
            up: right.cross(forwards).cast(),
            forwards: forwards.cast(),
            aperture_radius: p.aperture_radius as Real,
            inverse_focus: (1.0 / p.focus_distance) as Real,
            tangents: Vec2::new(
                (p.sensor_width / p.lens_sensor_dist) as Real,
                (p.sensor_height / p.lens_sensor_dist) as Real,
            ),
            vignetting: p.vignetting,
        })
    }

    /// The ray of a film position and a point of the unit square on the lens.
    ///
    /// The film runs from (0, 0), top left, to (1, 1); positions a little outside are fine, as wide
    /// reconstruction filters ask for them.
    #[inline]
    pub fn ray(&self, film: Vec2, lens: Vec2) -> CameraRay {
        let x = (film.x - 0.5) * self.tangents.x;
        let y = (0.5 - film.y) * self.tangents.y;
        let chief = self.forwards + self.right * x + self.up * y;
        let on_disk = concentric_disk(lens) * self.aperture_radius;
        let offset = self.right * on_disk.x + self.up * on_disk.y;
        // Towards the image point `chief · focus`, from the lens point, both divided by focus.
        let direction = (chief - offset * self.inverse_focus).normalized();
        let importance = if self.vignetting {
            let cos2 = 1.0 / (1.0 + x * x + y * y);
            cos2 * cos2
        } else {
            1.0
        };
        CameraRay { origin: self.position + offset, direction, importance }
    }

    /// The viewing direction.
    pub fn forwards(&self) -> Vec3 {
        self.forwards
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parameters() -> ThinLensParameters {
        ThinLensParameters {
            position: Vec3d::new(1.0, 2.0, 3.0),
            forwards: Vec3d::new(0.0, 2.0, 0.0),
            up: Vec3d::new(0.0, 0.5, 3.0),
            aperture_radius: 0.01,
            focus_distance: 4.0,
            sensor_width: 0.036,
            sensor_height: 0.024,
            lens_sensor_dist: 0.02,
            vignetting: true,
        }
    }

    fn close(a: Vec3, b: Vec3) -> bool {
        (a - b).length() < 1e-5
    }

    #[test]
    fn looking_along_y_with_z_up_the_picture_has_x_to_the_right() {
        let lens = ThinLens::new(&parameters()).unwrap();
        let centre = Vec2::new(0.5, 0.5);
        assert!(close(lens.ray(centre, centre).direction, Vec3::new(0.0, 1.0, 0.0)));
        let right_edge = lens.ray(Vec2::new(1.0, 0.5), centre).direction;
        assert!(close(right_edge, Vec3::new(0.9, 1.0, 0.0).normalized()));
        let top = lens.ray(Vec2::new(0.5, 0.0), centre).direction;
        assert!(close(top, Vec3::new(0.0, 1.0, 0.6).normalized()));
    }

    #[test]
    fn all_rays_of_a_film_point_meet_in_the_plane_of_focus() {
        let lens = ThinLens::new(&parameters()).unwrap();
        let film = Vec2::new(0.8, 0.3);
        let image = Vec3::new(1.0, 2.0, 3.0) + Vec3::new(0.3 * 1.8, 1.0, 0.2 * 1.2) * 4.0;
        for i in 0..50 {
            let r = lens.ray(film, Vec2::new((i % 7) as Real / 7.0, (i / 7) as Real / 8.0));
            assert!((r.origin - Vec3::new(1.0, 2.0, 3.0)).length() <= 0.01001);
            let t = (image.y - r.origin.y) / r.direction.y;
            assert!(close(r.origin + r.direction * t, image));
        }
    }

    #[test]
    fn a_focus_at_infinity_makes_parallel_rays() {
        let p = ThinLensParameters { focus_distance: f64::INFINITY, ..parameters() };
        let lens = ThinLens::new(&p).unwrap();
        let a = lens.ray(Vec2::new(0.1, 0.9), Vec2::new(0.1, 0.2));
        let b = lens.ray(Vec2::new(0.1, 0.9), Vec2::new(0.9, 0.6));
        assert!(close(a.direction, b.direction) && !close(a.origin, b.origin));
    }

    #[test]
    fn vignetting_is_the_fourth_power_of_the_cosine() {
        let lens = ThinLens::new(&parameters()).unwrap();
        let corner = lens.ray(Vec2::new(0.0, 0.0), Vec2::new(0.5, 0.5));
        assert!((corner.importance - corner.direction.y.powi(4)).abs() < 1e-6);
        let flat = ThinLens::new(&ThinLensParameters { vignetting: false, ..parameters() }).unwrap();
        assert_eq!(flat.ray(Vec2::new(0.0, 0.0), Vec2::new(0.5, 0.5)).importance, 1.0);
    }

    #[test]
    fn up_along_forwards_is_refused() {
        assert!(
            ThinLens::new(&ThinLensParameters { up: Vec3d::new(0.0, -7.0, 0.0), ..parameters() }).is_none()
        );
        assert!(ThinLens::new(&ThinLensParameters { forwards: Vec3::ZERO, ..parameters() }).is_none());
    }
}
