//! A camera that sees all directions from one point: columns of the film are angles round `up`, rows those above the horizon.
//!
//! The middle of the film looks forwards, its sides backwards, its upper edge up. A patch of film sees cos θ of what the
//! same patch sees at the horizon, for an angle θ above that.

use crate::{FilmPosition, LensRay, ThinLensParameters};
use indigo_math::angle::atan2_turns;
use indigo_math::elementary::sin_cos_turns;
use indigo_math::{Mat3, Real, Vec2, Vec3};

/// Solid angle of the whole film, were all of it as at the horizon: 2π round it, by π.
const HORIZON: Real = (2.0 * std::f64::consts::PI * std::f64::consts::PI) as Real;

/// A camera that sees all directions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spherical {
    position: Vec3,
    right: Vec3,
    up: Vec3,
    forwards: Vec3,
}

impl Spherical {
    /// With the place and directions of some parameters; `None` where `forwards` and `up` do not span a plane.
    pub fn new(p: &ThinLensParameters) -> Option<Self> {
        let [right, up, forwards] = p.axes()?;
        Some(Self {
            position: p.position.cast(),
            right: right.cast(),
            up: up.cast(),
            forwards: forwards.cast(),
        })
    }

    /// The ray of a film position from (0, 0), top left, to (1, 1).
    #[inline]
    pub fn ray(&self, film: Vec2) -> LensRay {
        let (sin_phi, cos_phi) = sin_cos_turns(film.x - 0.5);
        let (sin_theta, cos_theta) = sin_cos_turns(0.5 * (0.5 - film.y));
        let level = self.forwards * cos_phi + self.right * sin_phi;
        let direction = (level * cos_theta + self.up * sin_theta).normalized();
        LensRay { origin: self.position, direction, importance: 1.0 }
    }

    /// The cosine of a direction's angle above the horizon.
    #[inline]
    fn level(&self, direction: Vec3) -> Real {
        let (x, y) = (direction.dot(self.right), direction.dot(self.forwards));
        (x * x + y * y).sqrt()
    }

    /// The film position that sees along a direction; `None` straight up and down, where a whole edge of the film does.
    #[inline]
    pub fn film_position(&self, direction: Vec3) -> Option<FilmPosition> {
        let level = self.level(direction);
        if level <= 0.0 {
            return None;
        }
        let turns = |y: Real, x: Real| {
            let turns = atan2_turns(y, x);
            if turns > 0.5 { turns - 1.0 } else { turns }
        };
        let round = turns(direction.dot(self.right), direction.dot(self.forwards));
        let above = turns(direction.dot(self.up), level);
        Some(FilmPosition { position: Vec2::new(0.5 + round, 0.5 - 2.0 * above), importance: 1.0 })
    }

    /// Density (1/sr) of unit directions for film positions that are uniform over the film; infinite straight up and down.
    #[inline]
    pub fn pdf_direction(&self, direction: Vec3) -> Real {
        1.0 / (HORIZON * self.level(direction))
    }

    /// The direction in which the middle of the film looks.
    pub fn forwards(&self) -> Vec3 {
        self.forwards
    }

    /// How deep in the picture a point lies, metres.
    pub(crate) fn depth(&self, p: Vec3) -> Real {
        (p - self.position).length()
    }

    /// The same turned about the origin, and then moved.
    pub(crate) fn moved(&self, turn: Mat3<Real>, by: Vec3) -> Self {
        Self {
            position: turn * self.position + by,
            right: turn * self.right,
            up: turn * self.up,
            forwards: turn * self.forwards,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use indigo_math::Vec3d;

    fn camera() -> Spherical {
        Spherical::new(&ThinLensParameters {
            position: Vec3d::new(1.0, 2.0, 3.0),
            forwards: Vec3d::new(0.0, 2.0, 0.0),
            up: Vec3d::new(0.0, 0.5, 3.0),
            aperture_radius: 0.01,
            focus_distance: 4.0,
            sensor_width: 4.0,
            sensor_height: 2.0,
            lens_sensor_dist: 0.02,
            lens_shift: [0.0; 2],
            vignetting: true,
        })
        .expect("a camera that looks somewhere")
    }

    #[test]
    fn the_middle_looks_forwards_and_a_quarter_to_the_right_looks_right() {
        for (film, direction) in [
            ([0.5, 0.5], [0.0, 1.0, 0.0]),
            ([0.75, 0.5], [1.0, 0.0, 0.0]),
            ([0.0, 0.5], [0.0, -1.0, 0.0]),
            ([0.3, 0.0], [0.0, 0.0, 1.0]),
            ([0.5, 0.75], [0.0, 0.5f64.sqrt(), -0.5f64.sqrt()]),
        ] {
            let ray = camera().ray(Vec2::new(film[0] as Real, film[1] as Real));
            let expected: Vec3 = Vec3d::from(direction).cast();
            assert!((ray.direction - expected).length() < 1e-6, "{film:?}: {ray:?}");
            assert_eq!(ray.origin, Vec3::new(1.0, 2.0, 3.0));
        }
    }

    #[test]
    fn a_rays_film_position_is_the_one_that_it_came_from() {
        for i in 0..100 {
            let u = |k: u32| (((i * k) % 101) as Real + 0.5) / 101.0;
            let film = Vec2::new(u(37), 0.01 + 0.98 * u(59));
            let found = camera().film_position(camera().ray(film).direction).expect("not straight up");
            // The nearer to the poles, the less a turn round them is told by rounded directions.
            assert!((found.position.x - film.x).abs() + (found.position.y - film.y).abs() < 1e-5, "{film:?}");
        }
        assert!(camera().film_position(Vec3::new(0.0, 0.0, 1.0)).is_none());
    }
}
