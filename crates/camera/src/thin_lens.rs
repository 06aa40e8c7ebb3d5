//! A thin lens before a flat sensor.
//!
//! The lens centre is the camera's position; the sensor lies `lens_sensor_dist` behind it. A point
//! of the sensor is imaged to the plane of focus through the lens centre, and every ray from it
//! through the lens meets that image point. The horizontal angle of view is
//! 2 atan(sensor_width / (2 lens_sensor_dist)), whatever the focus. A lens that is shifted stands before another point of
//! the sensor than its middle, and looks the same way: the picture is another part of the same image, so that
//! densities and blur are those of the lens that is not shifted.

use indigo_math::{Mat3, Real, Vec2, Vec3, Vec3d};

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
    /// How far the lens is shifted from before the middle of the sensor: to the right, and up.
    pub lens_shift: [f64; 2],
    /// Whether the cos⁴ law of natural vignetting holds.
    pub vignetting: bool,
}

impl ThinLensParameters {
    /// Unit vectors to the right, up and forwards; `None` where `forwards` and `up` do not span a plane.
    pub(crate) fn axes(&self) -> Option<[Vec3d; 3]> {
        let forwards = self.forwards.try_normalized()?;
        let right = forwards.cross(self.up.try_normalized()?);
        // Below this sine the direction of `up` is lost in rounding.
        if right.length() < 1e-9 {
            return None;
        }
        let right = right.normalized();
        Some([right, right.cross(forwards), forwards])
    }

    /// Slopes, to the right and up, at which the middle of the film looks through the middle of the lens.
    fn middle(&self) -> [f64; 2] {
        self.lens_shift.map(|shift| shift / self.lens_sensor_dist)
    }

    /// The unit direction in which the middle of the film looks through the middle of the lens: `forwards`, unless the
    /// lens is shifted. `None` where `forwards` and `up` do not span a plane.
    pub fn middle_direction(&self) -> Option<Vec3d> {
        let ([right, up, forwards], [x, y]) = (self.axes()?, self.middle());
        (forwards + right * x + up * y).try_normalized()
    }
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
    /// Slopes, to the right and up, at which the middle of the film looks through the middle of the lens.
    middle: Vec2,
    /// Distance from the sensor to the lens over the diameter of the aperture.
    f_number: Real,
    sensor_size: Vec2,
    vignetting: bool,
}

/// A ray from the lens into the scene, without diffraction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LensRay {
    /// Point on the lens.
    pub origin: Vec3,
    /// Unit direction.
    pub direction: Vec3,
    /// What its radiance counts on the film: 1 on the axis, cos⁴ off it with vignetting.
    pub importance: Real,
}

/// Where on the film light arrives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FilmPosition {
    /// From (0, 0), top left, to (1, 1) on the film.
    pub position: Vec2,
    /// What its radiance counts there, as in [`LensRay`].
    pub importance: Real,
}

impl ThinLens {
    /// Radius of the aperture, metres.
    pub fn aperture_radius(&self) -> Real {
        self.aperture_radius
    }

    /// A lens from its parameters; `None` where `forwards` and `up` do not span a plane.
    pub fn new(p: &ThinLensParameters) -> Option<Self> {
        let ([right, up, forwards], [x, y]) = (p.axes()?, p.middle());
        Some(Self {
            position: p.position.cast(),
            right: right.cast(),
            up: up.cast(),
            forwards: forwards.cast(),
            aperture_radius: p.aperture_radius as Real,
            inverse_focus: (1.0 / p.focus_distance) as Real,
            tangents: Vec2::new(
                (p.sensor_width / p.lens_sensor_dist) as Real,
                (p.sensor_height / p.lens_sensor_dist) as Real,
            ),
            middle: Vec2::new(x as Real, y as Real),
            f_number: (0.5 * p.lens_sensor_dist / p.aperture_radius) as Real,
            sensor_size: Vec2::new(p.sensor_width as Real, p.sensor_height as Real),
            vignetting: p.vignetting,
        })
    }

    /// The ray of a film position through a point of the lens, in radii of the aperture to the right
    /// and up as the camera looks.
    ///
    /// The film runs from (0, 0), top left, to (1, 1); positions outside are fine, as wide
    /// reconstruction filters and diffraction ask for them.
    #[inline]
    pub fn ray(&self, film: Vec2, lens: Vec2) -> LensRay {
        let x = (film.x - 0.5) * self.tangents.x + self.middle.x;
        let y = (0.5 - film.y) * self.tangents.y + self.middle.y;
        let chief = self.forwards + self.right * x + self.up * y;
        let on_lens = lens * self.aperture_radius;
        let offset = self.right * on_lens.x + self.up * on_lens.y;
        // Towards the image point `chief · focus`, from the lens point, both divided by focus.
        let direction = (chief - offset * self.inverse_focus).normalized();
        LensRay { origin: self.position + offset, direction, importance: self.importance(x, y) }
    }

    /// The film position that sees along a direction from a point of the lens: the inverse of
    /// [`ray`](Self::ray). `None` where the direction leads backwards; the position may lie beside the film.
    #[inline]
    pub fn film_position(&self, origin: Vec3, direction: Vec3) -> Option<FilmPosition> {
        let along = direction.dot(self.forwards);
        if along <= 0.0 {
            return None;
        }
        let offset = origin - self.position;
        let on_axis = |axis: Vec3| direction.dot(axis) / along + offset.dot(axis) * self.inverse_focus;
        let (x, y) = (on_axis(self.right), on_axis(self.up));
        let from_middle = Vec2::new(x - self.middle.x, y - self.middle.y);
        let position =
            Vec2::new(0.5 + from_middle.x / self.tangents.x, 0.5 - from_middle.y / self.tangents.y);
        Some(FilmPosition { position, importance: self.importance(x, y) })
    }

    /// Density (1/sr) of the unit directions that [`ray`](Self::ray) gives from any one point of the
    /// lens when film positions are uniform over the film; positive beside the film, too.
    ///
    /// Positions spread evenly over the plane of focus, F² tx ty to the film; a patch of that plane is
    /// seen under cos³/F² of its area, so that F drops out.
    #[inline]
    pub fn pdf_direction(&self, direction: Vec3) -> Real {
        let cos = direction.dot(self.forwards);
        if cos <= 0.0 { 0.0 } else { 1.0 / (self.tangents.x * self.tangents.y * cos * cos * cos) }
    }

    /// What part of the film the image of a square metre of the lens covers that a point in a direction at some distance,
    /// metres, makes: a lens point at x sends its light to x (1/focus − 1/depth) over the film's tangents, beside where
    /// the middle of the lens does.
    #[inline]
    pub fn blur(&self, direction: Vec3, distance: Real) -> Real {
        let defocus = self.inverse_focus - 1.0 / (distance * direction.dot(self.forwards));
        defocus * defocus / (self.tangents.x * self.tangents.y)
    }

    /// What part of the film a disc covers whose radius is a way on the film, in its widths and heights.
    #[inline]
    pub fn disc(&self, way: Vec2) -> Real {
        let aspect = self.tangents.x / self.tangents.y;
        (std::f64::consts::PI as Real) * (way.x * way.x * aspect + way.y * way.y / aspect)
    }

    /// What radiance along the chief ray of slopes x and y counts on the film.
    #[inline]
    fn importance(&self, x: Real, y: Real) -> Real {
        if !self.vignetting {
            return 1.0;
        }
        let cos2 = 1.0 / (1.0 + x * x + y * y);
        cos2 * cos2
    }

    /// How far apart on the film two fringes lie whose light comes from the two sides of the aperture's
    /// square, in widths and heights of the film per nm of wavelength: λ s / 2a.
    pub fn cycle_per_nm(&self) -> Vec2 {
        let cycle_m = 1e-9 * self.f_number;
        Vec2::new(cycle_m / self.sensor_size.x, cycle_m / self.sensor_size.y)
    }

    /// The viewing direction.
    pub fn forwards(&self) -> Vec3 {
        self.forwards
    }

    /// How deep in the picture a point lies, metres.
    pub(crate) fn depth(&self, p: Vec3) -> Real {
        (p - self.position).dot(self.forwards)
    }

    /// The same turned about the origin, and then moved.
    pub(crate) fn moved(&self, turn: Mat3<Real>, by: Vec3) -> Self {
        Self {
            position: turn * self.position + by,
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
            lens_shift: [0.0; 2],
            vignetting: true,
        }
    }

    /// Far beyond what a lens can do, so that what forgets it is seen.
    const SHIFT: [f64; 2] = [0.01, -0.03];

    fn close(a: Vec3, b: Vec3) -> bool {
        (a - b).length() < 1e-5
    }

    #[test]
    fn looking_along_y_with_z_up_the_picture_has_x_to_the_right() {
        let lens = ThinLens::new(&parameters()).unwrap();
        let (middle, centre) = (Vec2::new(0.5, 0.5), Vec2::new(0.0, 0.0));
        assert!(close(lens.ray(middle, centre).direction, Vec3::new(0.0, 1.0, 0.0)));
        let right_edge = lens.ray(Vec2::new(1.0, 0.5), centre).direction;
        assert!(close(right_edge, Vec3::new(0.9, 1.0, 0.0).normalized()));
        let top = lens.ray(Vec2::new(0.5, 0.0), centre).direction;
        assert!(close(top, Vec3::new(0.0, 1.0, 0.6).normalized()));
    }

    /// Raised by 1 cm, the lens stands 1 cm above the middle of the sensor and 2 cm before it.
    #[test]
    fn a_shifted_lens_sees_the_way_that_it_is_shifted() {
        let [right, up] = SHIFT;
        let p = ThinLensParameters { lens_shift: SHIFT, ..parameters() };
        let lens = ThinLens::new(&p).unwrap();
        let centre = Vec2::new(0.0, 0.0);
        let (x, y) = ((right / 0.02) as Real, (up / 0.02) as Real);
        for (film, slopes) in [
            (Vec2::new(0.5, 0.5), (x, y)),
            (Vec2::new(1.0, 0.0), (0.9 + x, 0.6 + y)),
            // Behind the middle of the lens there is no shift.
            (Vec2::new(0.5 - x / 1.8, 0.5 + y / 1.2), (0.0, 0.0)),
        ] {
            let ray = lens.ray(film, centre);
            let chief = Vec3::new(slopes.0, 1.0, slopes.1);
            assert!(close(ray.direction, chief.normalized()), "{ray:?}");
            // Vignetting goes by the angle to the lens's axis.
            assert!((ray.importance - chief.length2().powi(-2)).abs() < 1e-6, "{ray:?}");
        }
        let middle = p.middle_direction().unwrap();
        assert!(close(middle.cast(), Vec3::new(x, 1.0, y).normalized()));
        assert!(close(parameters().middle_direction().unwrap().cast(), Vec3::new(0.0, 1.0, 0.0)));
    }

    #[test]
    fn all_rays_of_a_film_point_meet_in_the_plane_of_focus() {
        let lens = ThinLens::new(&parameters()).unwrap();
        let film = Vec2::new(0.8, 0.3);
        let image = Vec3::new(1.0, 2.0, 3.0) + Vec3::new(0.3 * 1.8, 1.0, 0.2 * 1.2) * 4.0;
        for i in 0..50 {
            let r = lens.ray(film, Vec2::new((i % 7) as Real / 7.0 - 0.5, (i / 7) as Real / 8.0));
            let (right, up) = ((i % 7) as Real / 7.0 - 0.5, (i / 7) as Real / 8.0);
            assert!(close(r.origin, Vec3::new(1.0 + 0.01 * right, 2.0, 3.0 + 0.01 * up)));
            let t = (image.y - r.origin.y) / r.direction.y;
            assert!(close(r.origin + r.direction * t, image));
        }
    }

    #[test]
    fn a_focus_at_infinity_makes_parallel_rays() {
        let p = ThinLensParameters { focus_distance: f64::INFINITY, ..parameters() };
        let lens = ThinLens::new(&p).unwrap();
        let a = lens.ray(Vec2::new(0.1, 0.9), Vec2::new(-0.8, -0.6));
        let b = lens.ray(Vec2::new(0.1, 0.9), Vec2::new(0.8, 0.2));
        assert!(close(a.direction, b.direction) && !close(a.origin, b.origin));
    }

    #[test]
    fn vignetting_is_the_fourth_power_of_the_cosine() {
        let lens = ThinLens::new(&parameters()).unwrap();
        let corner = lens.ray(Vec2::new(0.0, 0.0), Vec2::new(0.0, 0.0));
        assert!((corner.importance - corner.direction.y.powi(4)).abs() < 1e-6);
        let flat = ThinLens::new(&ThinLensParameters { vignetting: false, ..parameters() }).unwrap();
        assert_eq!(flat.ray(Vec2::new(0.0, 0.0), Vec2::new(0.0, 0.0)).importance, 1.0);
    }

    #[test]
    fn a_rays_film_position_is_the_one_that_it_came_from() {
        for focus_distance in [4.0, 0.3, f64::INFINITY] {
            let p = ThinLensParameters {
                focus_distance,
                aperture_radius: 0.05,
                lens_shift: SHIFT,
                ..parameters()
            };
            let lens = ThinLens::new(&p).unwrap();
            for i in 0..100 {
                let u = |k: u32| ((i * k) % 101) as Real / 101.0;
                let film = Vec2::new(1.2 * u(37) - 0.1, 1.2 * u(59) - 0.1);
                let ray = lens.ray(film, Vec2::new(2.0 * u(17) - 1.0, 2.0 * u(71) - 1.0));
                let found = lens.film_position(ray.origin, ray.direction).unwrap();
                assert!((found.position.x - film.x).abs() + (found.position.y - film.y).abs() < 1e-5);
                assert!((found.importance - ray.importance).abs() < 1e-5);
                assert!(lens.film_position(ray.origin, -ray.direction).is_none());
            }
        }
    }

    /// The solid angle of a small patch of film, by the density and by its corners.
    #[test]
    fn the_density_of_directions_is_one_over_the_solid_angle_of_the_film() {
        let p = ThinLensParameters {
            aperture_radius: 0.3,
            focus_distance: 0.7,
            lens_shift: SHIFT,
            ..parameters()
        };
        let lens = ThinLens::new(&p).unwrap();
        for (x, y) in [(0.5, 0.5), (0.05, 0.9), (0.99, 0.3)] {
            let at = |dx: f64, dy: f64| {
                let film = Vec2::new((x + dx) as Real, (y + dy) as Real);
                let d = lens.ray(film, Vec2::new(0.8, -0.6)).direction;
                d.cast::<f64>()
            };
            let h = 0.01;
            let solid_angle =
                (at(h, 0.0) - at(-h, 0.0)).cross(at(0.0, h) - at(0.0, -h)).length() / (4.0 * h * h);
            let density = f64::from(lens.pdf_direction(at(0.0, 0.0).cast()));
            assert!((density * solid_angle - 1.0).abs() < 2e-3, "{}", density * solid_angle);
        }
        assert_eq!(lens.pdf_direction(-lens.forwards()), 0.0);
    }

    /// The image of a quarter of the lens, by where the light of its corners falls.
    #[test]
    fn blur_is_the_area_of_the_image_of_the_lens() {
        let p = ThinLensParameters {
            aperture_radius: 0.1,
            focus_distance: 2.0,
            lens_shift: SHIFT,
            ..parameters()
        };
        let lens = ThinLens::new(&p).unwrap();
        for to in [Vec3d::new(0.7, 5.0, -0.4), Vec3d::new(-0.2, 0.8, 0.1), Vec3d::new(0.3, 2.0, 0.0)] {
            let falls = |x: Real, z: Real| {
                let origin = lens.position + Vec3::new(x, 0.0, z);
                let direction = (lens.position + to.cast() - origin).normalized();
                lens.film_position(origin, direction).unwrap().position
            };
            let (side, middle) = (0.1, falls(0.0, 0.0));
            let (right, up) = (falls(side, 0.0) - middle, falls(0.0, side) - middle);
            let expected = (right.x * up.y - right.y * up.x).abs();
            let blur = lens.blur(to.normalized().cast(), to.length() as Real) * side * side;
            assert!((blur - expected).abs() < 1e-4 * expected.max(1e-3), "{to:?}: {blur} {expected}");
        }
        assert!((lens.blur(lens.forwards, Real::INFINITY) / (0.25 / (1.8 * 1.2)) - 1.0).abs() < 1e-5);
    }

    #[test]
    fn up_along_forwards_is_refused() {
        assert!(
            ThinLens::new(&ThinLensParameters { up: Vec3d::new(0.0, -7.0, 0.0), ..parameters() }).is_none()
        );
        assert!(ThinLens::new(&ThinLensParameters { forwards: Vec3::ZERO, ..parameters() }).is_none());
    }
}
