//! Lamps made of triangles: mesh lights and rectangles.

use crate::light_tree::Lobe;
use crate::modulation::Modulation;
use crate::profile::Profile;
use crate::query::EmitterPoint;
use indigo_math::distribution::AliasTable;
use indigo_math::warp::{cosine_hemisphere, cosine_hemisphere_pdf, uniform_triangle};
use indigo_math::{Float, Frame, Real, Vec2, Vec3, Vec3d};
use indigo_spectrum::{SampledSpectrum, SampledWavelengths, Spectrum};
use indigo_texture::Texture;
use std::f64::consts::PI;

/// Triangles that emit from their front: the same radiance everywhere and in all directions, unless an
/// image map modulates it over the surface or a profile over directions.
#[derive(Clone, Debug)]
pub struct AreaLight {
    /// Radiance, W m^-3 sr^-1; with a profile that of a mean luminance of 1 cd/m².
    radiance: Spectrum,
    triangles: Vec<EmitterTriangle>,
    /// Over the triangles, by their flux.
    choice: AliasTable,
    /// For each triangle its probability over its area, 1/m².
    density: Vec<Real>,
    modulation: Option<Modulation>,
    photometry: Option<Photometry>,
    /// The triangles' areas, m², and their sum.
    areas: Vec<f64>,
    area_m2: f64,
    /// The group of lights that it belongs to.
    group: u16,
    /// How much more often it is drawn than by its light alone.
    attention: f64,
}

#[derive(Clone, Copy, Debug)]
struct EmitterTriangle {
    corner: Vec3,
    edge1: Vec3,
    edge2: Vec3,
    normal: Vec3,
    /// How far beside the triangle a ray may find it, for each axis.
    test_error: Vec3,
}

/// A profile, and how it lies on each triangle.
#[derive(Clone, Debug)]
struct Photometry {
    profile: Profile,
    frames: Vec<Frame>,
    inverse_area: Real,
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
                    test_error: Vec3::ZERO,
                }
            })
            .collect();
        let mut light = Self {
            radiance,
            triangles,
            choice: AliasTable::default(),
            density: vec![],
            modulation: None,
            photometry: None,
            area_m2: areas.iter().sum(),
            group: 0,
            attention: 1.0,
            areas,
        };
        light.choose_by(|_| 1.0);
        light
    }

    /// The lamp that shines from the other side of its triangles.
    #[must_use]
    pub fn turned_over(mut self) -> Self {
        self.triangles.iter_mut().for_each(|t| t.normal = -t.normal);
        self
    }

    /// The lamp with a bound, for each of its triangles and each axis, of how far beside it a ray may find it. Without that
    /// points are told as surely as they are drawn, and rays to them may meet the lamp itself.
    #[must_use]
    pub fn with_test_errors(mut self, error: impl Fn(u32) -> Vec3) -> Self {
        (0..).zip(&mut self.triangles).for_each(|(i, t)| t.test_error = error(i));
        self
    }

    /// The lamp with an image map that multiplies its spectrum, laid on by texture coordinates of each
    /// triangle's corners.
    #[must_use]
    pub fn with_texture(mut self, texture: Texture, uvs: &[[Vec2<f64>; 3]]) -> Self {
        let modulation = Modulation::new(texture, uvs, &self.radiance);
        let sum: f64 = self.areas.iter().enumerate().map(|(i, area)| area * modulation.mean(i)).sum();
        let overall = sum / self.area_m2;
        self.choose_by(|i| modulation.weight(i, overall));
        self.modulation = Some(modulation);
        self
    }

    /// The lamp with its spectrum scaled to a luminous flux in lm; `None` where it has no light to scale, or no
    /// area. A profile has a flux of its own.
    #[must_use]
    pub fn with_flux(mut self, flux_lm: f64) -> Option<Self> {
        let scale = flux_lm / self.flux();
        self.radiance = self.radiance.scaled(scale);
        (scale.is_finite() && self.area_m2 > 0.0).then_some(self)
    }

    /// The lamp with its spectrum multiplied by another.
    #[must_use]
    pub fn times(mut self, factor: &Spectrum) -> Self {
        self.radiance = self.radiance.times(factor);
        self
    }

    /// The lamp in a group of lights; 0 without this.
    #[must_use]
    pub fn in_group(mut self, group: u16) -> Self {
        self.group = group;
        self
    }

    /// The lamp that is drawn so many times as often as others of the same flux: it may be brighter or darker in the
    /// picture. That changes noise, and no mean.
    #[must_use]
    pub fn with_attention(mut self, attention: f64) -> Self {
        self.attention = attention;
        self
    }

    /// The flux by which it is drawn.
    pub(crate) fn weight(&self) -> f64 {
        self.flux() * self.attention
    }

    /// The group of lights that it belongs to.
    #[inline]
    pub fn group(&self) -> u16 {
        self.group
    }

    /// The lamp with the directions and the flux of a profile, whose horizontal angles count from the `x_axis`
    /// of the mesh, in render space; `None` where it has no light to scale, or no area.
    #[must_use]
    pub fn with_profile(mut self, profile: Profile, x_axis: Vec3d) -> Option<Self> {
        let scale = 1.0 / self.mean_luminance();
        self.radiance = self.radiance.scaled(scale);
        let frames = self.triangles.iter().map(|t| horizontal_frame(t.normal, x_axis.cast())).collect();
        let inverse_area = (1.0 / self.area_m2) as Real;
        self.photometry = Some(Photometry { profile, frames, inverse_area });
        (scale.is_finite() && self.area_m2 > 0.0).then_some(self)
    }

    /// Sets how triangles are chosen: by area times a weight.
    fn choose_by(&mut self, weight: impl Fn(usize) -> f64) {
        let weights: Vec<f64> = self.areas.iter().enumerate().map(|(i, area)| area * weight(i)).collect();
        let sum: f64 = weights.iter().sum();
        self.choice = AliasTable::new(&weights);
        // Where all weights are 0 the table is even. What has no area is not drawn; should a ray meet it all the same
        // (trees judge areas in single precision), its density is 0.
        let share = |w: f64| if sum > 0.0 { w / sum } else { 1.0 / weights.len() as f64 };
        self.density = weights
            .iter()
            .zip(&self.areas)
            .map(|(&w, &area)| if area > 0.0 { (share(w) / area) as Real } else { 0.0 })
            .collect();
    }

    /// Radiance without map and profile, W m^-3 sr^-1.
    pub fn radiance(&self) -> &Spectrum {
        &self.radiance
    }

    /// Emitting area in m².
    pub fn area(&self) -> f64 {
        self.area_m2
    }

    /// How many triangles there are.
    pub(crate) fn len(&self) -> usize {
        self.triangles.len()
    }

    /// A triangle's share of the flux, of which a texture leaves a part to dark ones, too.
    pub(crate) fn share(&self, triangle: usize) -> f64 {
        self.choice.probability(triangle).to_f64()
    }

    /// Corners of a triangle.
    pub(crate) fn corners(&self, triangle: usize) -> [Vec3d; 3] {
        let t = &self.triangles[triangle];
        [t.corner, t.corner + t.edge1, t.corner + t.edge2].map(Vec3::cast)
    }

    /// Directions in which light leaves a triangle.
    pub(crate) fn lobe(&self, triangle: usize) -> Lobe {
        let normal = self.triangles[triangle].normal.cast();
        match &self.photometry {
            None => Lobe::lambertian(normal),
            Some(p) => Lobe::even(normal, p.profile.widest_angle()),
        }
    }

    /// Luminous flux in lm: π · area · luminance, or that of the profile.
    pub fn flux(&self) -> f64 {
        self.photometry
            .as_ref()
            .map_or_else(|| PI * self.area_m2 * self.mean_luminance(), |p| p.profile.flux())
    }

    /// Luminance (cd/m²) without the profile, mean over the area.
    fn mean_luminance(&self) -> f64 {
        let Some(modulation) = &self.modulation else { return self.radiance.luminance() };
        let sum: f64 = self.areas.iter().enumerate().map(|(i, area)| area * modulation.mean(i)).sum();
        // The map's means are those of the spectrum that it was laid on.
        sum / self.area_m2 * (self.radiance.luminance() / modulation.luminance())
    }

    /// Whether light leaves the back, too.
    #[inline]
    pub(crate) fn is_two_sided(&self) -> bool {
        self.photometry.as_ref().is_some_and(|p| p.profile.is_two_sided())
    }

    /// Radiance that leaves a point of a triangle in a unit direction.
    #[inline]
    pub(crate) fn emitted(
        &self,
        triangle: u32,
        bary: (Real, Real),
        wo: Vec3,
        lambda: &SampledWavelengths,
    ) -> SampledSpectrum {
        let mut radiance = self.radiance.eval(lambda);
        if let Some(modulation) = &self.modulation {
            radiance *= modulation.factor(triangle, bary, lambda);
        }
        if let Some(photometry) = &self.photometry {
            // Each part of the area sends its share of the intensity: L = I / (A |cos|).
            let local = photometry.frames[triangle as usize].to_local(wo);
            if local.z == 0.0 {
                return SampledSpectrum::ZERO;
            }
            radiance *= photometry.profile.intensity(local) * photometry.inverse_area / local.z.abs();
        }
        radiance
    }

    /// A point, with density [`pdf_point`](Self::pdf_point); `None` where there is no area.
    #[inline]
    pub(crate) fn sample_point(&self, choice: f64, at: [Real; 2]) -> Option<EmitterPoint> {
        if self.area_m2 == 0.0 {
            return None;
        }
        Some(self.sample_point_of(self.choice.sample(choice).0, at))
    }

    /// A point of a triangle, with density [`pdf_point_of`](Self::pdf_point_of) if the triangle is certain.
    #[inline]
    pub(crate) fn sample_point_of(&self, triangle: usize, at: [Real; 2]) -> EmitterPoint {
        let t = &self.triangles[triangle];
        let v = Vec2::from(at);
        let bary = self.modulation.as_ref().map_or_else(|| uniform_triangle(v), |m| m.sample(triangle, v));
        let (a, b) = (t.edge1 * bary.0, t.edge2 * bary.1);
        // Two products and two sums, each rounded once, of magnitudes that the terms bound.
        let p_error = (t.corner.abs() + a.abs() + b.abs()) * (4.0 * Real::EPSILON) + t.test_error;
        EmitterPoint { p: t.corner + a + b, p_error, n: t.normal, triangle: triangle as u32, bary }
    }

    /// Turns a point, whose normal is that of the front, to the side from which `p` is lit. Gives the direction from `p`,
    /// and by what a density over area is multiplied to be one in solid angle; `None` where no light goes there.
    #[inline]
    pub(crate) fn turn_towards(&self, p: Vec3, point: &mut EmitterPoint) -> Option<(Vec3, Real)> {
        let way = point.p - p;
        let distance2 = way.length2();
        let wi = way / distance2.sqrt();
        if -wi.dot(point.n) < 0.0 && self.is_two_sided() {
            point.n = -point.n;
        }
        let cos = -wi.dot(point.n);
        (cos > 0.0 && distance2 > 0.0).then(|| (wi, distance2 / cos))
    }

    /// Density of [`sample_point`](Self::sample_point) over area (1/m²).
    #[inline]
    pub(crate) fn pdf_point(&self, triangle: u32, bary: (Real, Real)) -> Real {
        self.modulated(self.density[triangle as usize], triangle, bary)
    }

    /// Density over area (1/m²) of a point of a triangle that is drawn with some probability.
    #[inline]
    pub(crate) fn pdf_point_of(&self, triangle: u32, bary: (Real, Real), probability: f64) -> Real {
        let area = self.areas[triangle as usize];
        let even = if area > 0.0 { (probability / area) as Real } else { 0.0 };
        self.modulated(even, triangle, bary)
    }

    #[inline]
    fn modulated(&self, density: Real, triangle: u32, bary: (Real, Real)) -> Real {
        self.modulation.as_ref().map_or(density, |m| density * m.pdf(triangle, bary))
    }

    /// A direction in which light leaves a point, with density [`pdf_direction`](Self::pdf_direction).
    #[inline]
    pub(crate) fn sample_direction(&self, at: &EmitterPoint, v: [Real; 2]) -> Vec3 {
        match &self.photometry {
            None => Frame::from_normal(at.n).to_world(cosine_hemisphere(v.into())),
            Some(p) => p.frames[at.triangle as usize].to_world(p.profile.sample(v)),
        }
    }

    /// Density (1/sr) of [`sample_direction`](Self::sample_direction) from a triangle whose front has the
    /// unit normal `n`.
    #[inline]
    pub(crate) fn pdf_direction(&self, triangle: u32, n: Vec3, wo: Vec3) -> Real {
        match &self.photometry {
            None => cosine_hemisphere_pdf(wo.dot(n)),
            Some(p) => p.profile.pdf(p.frames[triangle as usize].to_local(wo)),
        }
    }
}

/// The frame of a profile on a triangle: z along the normal, x as near as can be to the mesh's, and y so that
/// angles from x to y run counter-clockwise seen from behind the lamp.
fn horizontal_frame(normal: Vec3, x_axis: Vec3) -> Frame {
    let x = (x_axis - normal * normal.dot(x_axis)).try_normalized();
    let x = x.unwrap_or_else(|| Frame::from_normal(normal).s);
    Frame { s: x, t: x.cross(normal), n: normal }
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
            let p = light.sample_point(rng.next_real().to_f64(), [rng.next_real(), rng.next_real()]).unwrap();
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
    fn lumens_on_the_box_are_lumens_of_the_lamp() {
        let light = two_triangles().with_flux(1750.0).unwrap();
        assert!((light.flux() / 1750.0 - 1.0).abs() < 1e-9);
        assert!(AreaLight::new(Spectrum::BLACK, &[]).with_flux(1.0).is_none());
    }

    #[test]
    fn no_area_no_point() {
        assert!(AreaLight::new(Spectrum::uniform(1.0), &[]).sample_point(0.5, [0.5; 2]).is_none());
    }
}
