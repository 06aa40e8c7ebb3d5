//! A camera without perspective: its rays are parallel and leave a rectangle, the sensor, at right angles.
//!
//! Every point before the sensor is seen by one ray, which begins at its foot on it. So the light of the scene falls on the
//! film where it stands, at any distance with the same density over the area across the rays: one over that of the sensor.

use crate::{FilmPosition, LensRay, ThinLensParameters};
use indigo_math::{Mat3, Real, Vec2, Vec3};

/// A camera of parallel rays.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Orthographic {
    /// The middle of the sensor.
    middle: Vec3,
    right: Vec3,
    up: Vec3,
    forwards: Vec3,
    size: Vec2,
}

impl Orthographic {
    /// With the place, directions and sensor of some parameters, which a shift of the lens moves sideways; `None` where
    /// `forwards` and `up` do not span a plane.
    pub fn new(p: &ThinLensParameters) -> Option<Self> {
        let ([right, up, forwards], [x, y]) = (p.axes()?, p.lens_shift);
        Some(Self {
            middle: (p.position + right * x + up * y).cast(),
            right: right.cast(),
            up: up.cast(),
            forwards: forwards.cast(),
            size: Vec2::new(p.sensor_width as Real, p.sensor_height as Real),
        })
    }

    /// The ray of a film position from (0, 0), top left, to (1, 1).
    #[inline]
    pub fn ray(&self, film: Vec2) -> LensRay {
        let across = self.right * ((film.x - 0.5) * self.size.x) + self.up * ((0.5 - film.y) * self.size.y);
        LensRay { origin: self.middle + across, direction: self.forwards, importance: 1.0 }
    }

    /// Where the ray begins that passes through a point.
    #[inline]
    pub fn foot(&self, p: Vec3) -> Vec3 {
        p - self.forwards * (p - self.middle).dot(self.forwards)
    }

    /// The film position whose ray begins at a point of the sensor's plane; `None` for light that comes from behind. It
    /// may lie beside the film.
    #[inline]
    pub fn film_position(&self, origin: Vec3, direction: Vec3) -> Option<FilmPosition> {
        if direction.dot(self.forwards) <= 0.0 {
            return None;
        }
        let from_middle = origin - self.middle;
        let (x, y) = (from_middle.dot(self.right), from_middle.dot(self.up));
        let position = Vec2::new(0.5 + x / self.size.x, 0.5 - y / self.size.y);
        Some(FilmPosition { position, importance: 1.0 })
    }

    /// Density (1/m²) across the rays of where they pass for film positions that are uniform over the film.
    #[inline]
    pub fn density(&self) -> Real {
        1.0 / (self.size.x * self.size.y)
    }

    /// The viewing direction.
    pub fn forwards(&self) -> Vec3 {
        self.forwards
    }

    /// How deep in the picture a point lies, metres.
    pub(crate) fn depth(&self, p: Vec3) -> Real {
        (p - self.middle).dot(self.forwards)
    }

    /// The same turned about the origin, and then moved.
    pub(crate) fn moved(&self, turn: Mat3<Real>, by: Vec3) -> Self {
        Self {
            middle: turn * self.middle + by,
            right: turn * self.right,
            up: turn * self.up,
            forwards: turn * self.forwards,
            ..*self
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use indigo_math::Vec3d;

    fn camera() -> Orthographic {
        Orthographic::new(&ThinLensParameters {
            position: Vec3d::new(1.0, 2.0, 3.0),
            forwards: Vec3d::new(0.0, 2.0, 0.0),
            up: Vec3d::new(0.0, 0.5, 3.0),
            aperture_radius: 0.01,
            focus_distance: 4.0,
            sensor_width: 4.0,
            sensor_height: 2.0,
            lens_sensor_dist: 0.02,
            lens_shift: [0.5, 0.25],
            vignetting: true,
        })
        .expect("a camera that looks somewhere")
    }

    fn close(a: Vec3, b: Vec3) -> bool {
        (a - b).length() < 1e-5
    }

    #[test]
    fn rays_are_parallel_and_begin_on_the_sensor() {
        for (film, from) in [
            (Vec2::new(0.5, 0.5), Vec3::new(1.5, 2.0, 3.25)),
            (Vec2::new(0.0, 0.0), Vec3::new(-0.5, 2.0, 4.25)),
            (Vec2::new(1.0, 0.5), Vec3::new(3.5, 2.0, 3.25)),
        ] {
            let ray = camera().ray(film);
            assert!(close(ray.origin, from), "{ray:?}");
            assert!(close(ray.direction, Vec3::new(0.0, 1.0, 0.0)) && ray.importance == 1.0);
        }
    }

    #[test]
    fn what_a_ray_passes_is_seen_where_it_came_from() {
        let camera = camera();
        for i in 0..100 {
            let u = |k: u32| ((i * k) % 101) as Real / 101.0;
            let film = Vec2::new(1.2 * u(37) - 0.1, 1.2 * u(59) - 0.1);
            let ray = camera.ray(film);
            let seen = ray.origin + ray.direction * (10.0 * u(17));
            let origin = camera.foot(seen);
            let found = camera.film_position(origin, ray.direction).expect("it lies before the sensor");
            assert!((found.position.x - film.x).abs() + (found.position.y - film.y).abs() < 1e-5);
            assert!(camera.film_position(origin, -ray.direction).is_none());
        }
    }

    /// The area of a patch of film by the density, and by its corners.
    #[test]
    fn the_density_of_rays_is_one_over_the_area_of_the_film() {
        let camera = camera();
        let at = |x: Real, y: Real| camera.ray(Vec2::new(x, y)).origin;
        let area = (at(0.75, 0.5) - at(0.5, 0.5)).cross(at(0.5, 0.75) - at(0.5, 0.5)).length();
        assert!((camera.density() * area * 16.0 - 1.0).abs() < 1e-5);
    }
}
