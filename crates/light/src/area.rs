//! Lamps made of triangles: mesh lights and rectangles.

use crate::query::EmitterPoint;
use indigo_math::distribution::AliasTable;
use indigo_math::warp::{cosine_hemisphere, cosine_hemisphere_pdf, uniform_triangle};
use indigo_math::{Frame, Real, Vec2, Vec3, Vec3d};
use indigo_spectrum::{SampledSpectrum, SampledWavelengths, Spectrum};

/// Triangles that all emit the same radiance from their front, evenly over area and direction.
#[derive(Clone, Debug)]
pub struct AreaLight {
    /// Radiance, W m^-3 sr^-1.
    pub radiance: Spectrum,
    triangles: Vec<EmitterTriangle>,
    by_area: AliasTable,
    area_m2: f64,
    pdf_area: Real,
}

#[derive(Clone, Copy, Debug)]
struct EmitterTriangle {
    corner: Vec3,
    edge1: Vec3,
    edge2: Vec3,
    normal: Vec3,
}

impl AreaLight {
    /// From corners in render space, counter-clockwise seen from the front, one for each triangle of
    /// the lamp's mesh.
    pub fn new(radiance: Spectrum, corners: &[[Vec3d; 3]]) -> Self {
        let area = |c: &[Vec3d; 3]| 0.5 * (c[1] - c[0]).cross(c[2] - c[0]).length();
        let areas: Vec<f64> = corners.iter().map(area).map(|a| if a.is_finite() { a } else { 0.0 }).collect();
        let triangles = corners
            .iter()
            .map(|c| {
                let (e1, e2) = (c[1] - c[0], c[2] - c[0]);
                let normal = e1.cross(e2).try_normalized().unwrap_or(Vec3::ZERO);
                EmitterTriangle {
                    corner: c[0].cast(),
                    edge1: e1.cast(),
                    edge2: e2.cast(),
                    normal: normal.cast(),
                }
            })
            .collect();
        let area_m2: f64 = areas.iter().sum();
        let pdf_area = (1.0 / area_m2) as Real;
        Self { radiance, triangles, by_area: AliasTable::new(&areas), area_m2, pdf_area }
    }

    /// Emitting area in m².
    pub fn area(&self) -> f64 {
        self.area_m2
    }

    /// Luminous flux in lm: π · area · luminance.
    pub fn flux(&self) -> f64 {
        std::f64::consts::PI * self.area_m2 * self.radiance.luminance()
    }

    /// Radiance that leaves a point of a triangle in a unit direction of its front.
    #[inline]
    pub(crate) fn emitted(
        &self,
        _triangle: u32,
        _bary: (Real, Real),
        _wo: Vec3,
        lambda: &SampledWavelengths,
    ) -> SampledSpectrum {
        self.radiance.eval(lambda)
    }

    /// A point, with density [`pdf_point`](Self::pdf_point); `None` where there is no area.
    #[inline]
    pub(crate) fn sample_point(&self, u: [Real; 3]) -> Option<EmitterPoint> {
        if self.area_m2 == 0.0 {
            return None;
        }
        let (i, _, _) = self.by_area.sample(u[0]);
        let t = &self.triangles[i];
        let (b1, b2) = uniform_triangle(Vec2::new(u[1], u[2]));
        let (a, b) = (t.edge1 * b1, t.edge2 * b2);
        // Two products and two sums, each rounded once, of magnitudes that the terms bound.
        let p_error = (t.corner.abs() + a.abs() + b.abs()) * (4.0 * Real::EPSILON);
        Some(EmitterPoint { p: t.corner + a + b, p_error, n: t.normal, triangle: i as u32, bary: (b1, b2) })
    }

    /// Density of [`sample_point`](Self::sample_point) over area (1/m²).
    #[inline]
    pub(crate) fn pdf_point(&self, _triangle: u32, _bary: (Real, Real)) -> Real {
        self.pdf_area
    }

    /// A direction in which light leaves a point, with density
    /// [`pdf_direction`](Self::pdf_direction).
    #[inline]
    pub(crate) fn sample_direction(at: &EmitterPoint, v: [Real; 2]) -> Vec3 {
        Frame::from_normal(at.n).to_world(cosine_hemisphere(v.into()))
    }

    /// Density (1/sr) of [`sample_direction`](Self::sample_direction) where the front's unit normal is `n`.
    #[inline]
    pub(crate) fn pdf_direction(n: Vec3, wo: Vec3) -> Real {
        cosine_hemisphere_pdf(wo.dot(n))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use indigo_math::rng::Rng;

    fn two_triangles() -> AreaLight {
        let v = |x: f64, y: f64, z: f64| Vec3d::new(x, y, z);
        // Areas 2 and 0.5, and one without area.
        AreaLight::new(
            Spectrum::uniform(3.0),
            &[
                [v(0.0, 0.0, 5.0), v(0.0, 1.0, 5.0), v(0.0, 2.0, 5.0)],
                [v(0.0, 0.0, 0.0), v(2.0, 0.0, 0.0), v(0.0, 2.0, 0.0)],
                [v(0.0, 0.0, 1.0), v(0.0, 1.0, 1.0), v(1.0, 0.0, 1.0)],
            ],
        )
    }

    /// False-alarm rate 1e-5: 4.4 standard errors.
    #[test]
    fn points_are_uniform_over_the_area_and_normals_follow_the_winding() {
        let light = two_triangles();
        assert!((light.area() - 2.5).abs() < 1e-12);
        assert!((light.pdf_point(1, (0.5, 0.5)) - 0.4).abs() < 1e-6);
        let mut rng = Rng::new(5);
        let n = 100_000;
        let (mut upper, mut x) = (0.0, 0.0);
        for _ in 0..n {
            let p = light.sample_point([rng.next_real(), rng.next_real(), rng.next_real()]).unwrap();
            let is_upper = p.p.z > 0.5;
            assert_eq!(p.n.z, if is_upper { -1.0 } else { 1.0 });
            assert_eq!(p.triangle, if is_upper { 2 } else { 1 });
            upper += f64::from(u8::from(is_upper));
            x += f64::from(u8::from(!is_upper)) * p.p.x as f64;
        }
        assert!((upper / f64::from(n) - 0.2).abs() < 4.4 * (0.16 / f64::from(n)).sqrt());
        assert!((x / (f64::from(n) - upper) - 2.0 / 3.0).abs() < 4.4 * 0.48 / (0.8 * f64::from(n)).sqrt());
    }

    #[test]
    fn flux_is_pi_times_area_times_luminance() {
        let light = two_triangles();
        let expected = std::f64::consts::PI * 2.5 * 3.0 * 7.298_348_81e-5;
        assert!((light.flux() / expected - 1.0).abs() < 1e-6);
    }

    #[test]
    fn no_area_no_point() {
        assert!(AreaLight::new(Spectrum::uniform(1.0), &[]).sample_point([0.5; 3]).is_none());
    }
}
