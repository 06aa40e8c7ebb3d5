//! Where a path meets a surface: the only place of cosines, of η² and of corrections for shading normals.
//!
//! The geometric normal decides on which side a direction lies, so that no light leaks through a
//! surface however its shading normal leans; the shading normal gives the cosine. Light that
//! travels from a lamp sees the same BSDF through the adjoint, whose factor is
//! |ωo·ns| |ωi·ng| / (|ωo·ng| |ωi·ns|) (Veach 1997, section 5.3).
//!
//! Radiance that passes from index η_i to η_o is multiplied by (η_o/η_i)². Models are symmetric,
//! f_sym = f / (η_camera / η_light), where the ends are those of the path as a whole, so the one factor
//! η_camera / η_light turns them into the BSDF of either mode. For events of delta kind the density in
//! solid angle is not there to bring the rest: with T the transmittance and `f = T η_o/η_i` their weight
//! is T (η_o/η_i)² for radiance and T η_o/η_i · η_i/η_o = T for importance (Veach 1997, section 5.2).

use crate::materials::Leaf;
use crate::scatter::{Crossing, Scatter};
use indigo_math::{Frame, Real, Vec3};
use indigo_spectrum::{LanePdf, SampledSpectrum};

/// What a path carries: radiance from the camera's side, or importance from the lamp's side.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mode {
    /// The path began at the camera; `wi` leads towards the light.
    Radiance,
    /// The path began at a lamp; `wi` leads towards the camera.
    Importance,
}

/// A scattering model set up at a point of a surface, seen from `wo`.
#[derive(Clone, Copy, Debug)]
pub struct ShadingPoint {
    leaf: Leaf,
    /// Local frame round the shading normal, on `wo`'s side.
    frame: Frame,
    /// Unit geometric normal on `wo`'s side.
    n_g: Vec3,
    wo: Vec3,
}

/// The model's answer for a given direction.
#[derive(Clone, Copy, Debug)]
pub struct Evaluation {
    /// BSDF times cosine, all corrections in.
    pub f_cos: SampledSpectrum,
    /// Density (1/sr) with which `wi` would be drawn from `wo`.
    pub pdf: LanePdf,
    /// Density (1/sr) with which `wo` would be drawn from `wi`.
    pub pdf_rev: LanePdf,
}

impl Evaluation {
    const NOTHING: Self = Self { f_cos: SampledSpectrum::ZERO, pdf: LanePdf::ZERO, pdf_rev: LanePdf::ZERO };
}

/// A direction drawn from the model.
#[derive(Clone, Copy, Debug)]
pub struct Scattered {
    /// Unit direction, away from the surface.
    pub wi: Vec3,
    /// BSDF times cosine over the hero's density, all corrections in.
    pub weight: SampledSpectrum,
    /// Density (1/sr) of `wi`; where `is_delta`, its probability.
    pub pdf: LanePdf,
    /// Density (1/sr) with which `wo` would be drawn from `wi`; where `is_delta`, the probability.
    pub pdf_rev: LanePdf,
    /// Whether the direction was the only one of its kind, so that nothing else could have drawn it.
    pub is_delta: bool,
    /// Whether the path is now on the other side of the surface.
    pub is_transmitted: bool,
}

impl ShadingPoint {
    /// Sets a model up at a point with unit normals `n_g` and `n_s` (of one side) seen from `wo`.
    #[inline]
    pub fn new(leaf: Leaf, n_g: Vec3, n_s: Vec3, wo: Vec3) -> Self {
        let side = if wo.dot(n_g) < 0.0 { -1.0 } else { 1.0 };
        Self { leaf, frame: Frame::from_normal(n_s * side), n_g: n_g * side, wo }
    }

    /// The geometric normal on the side from which the surface is seen.
    #[inline]
    pub fn n_g(&self) -> Vec3 {
        self.n_g
    }

    /// The direction from which the surface is seen.
    #[inline]
    pub fn wo(&self) -> Vec3 {
        self.wo
    }

    /// Whether light can be scattered into directions that are given.
    #[inline]
    pub fn is_connectable(&self) -> bool {
        self.leaf.is_connectable()
    }

    /// BSDF, cosine and both densities for a direction.
    #[inline]
    pub fn eval(&self, wi: Vec3, mode: Mode) -> Evaluation {
        let side = wi.dot(self.n_g);
        // Along the surface, or no number: nothing.
        if side == 0.0 || side.is_nan() {
            return Evaluation::NOTHING;
        }
        let crossing = if side > 0.0 { Crossing::Reflect } else { Crossing::Down };
        let (o, i) = (self.frame.to_local(self.wo), self.frame.to_local(wi));
        let f = self.leaf.f(o, i, crossing);
        if f.is_black() {
            return Evaluation {
                f_cos: f,
                pdf: self.leaf.pdf(o, i, crossing),
                pdf_rev: self.leaf.pdf(i, o, crossing.reversed()),
            };
        }
        Evaluation {
            f_cos: self.corrected(f, crossing, mode) * self.cosine(o, i, wi, crossing, mode),
            pdf: self.leaf.pdf(o, i, crossing),
            pdf_rev: self.leaf.pdf(i, o, crossing.reversed()),
        }
    }

    /// Draws a direction; `None` where the light is absorbed.
    #[inline]
    pub fn sample(&self, u: [Real; 3], mode: Mode) -> Option<Scattered> {
        let o = self.frame.to_local(self.wo);
        let s = self.leaf.sample(o, u)?;
        let wi = self.frame.to_world(s.wi);
        let is_transmitted = s.crossing != Crossing::Reflect;
        let side = wi.dot(self.n_g);
        // A direction that the shading normal allows but the geometry does not: absorbed.
        let is_where_it_should = if is_transmitted { side < 0.0 } else { side > 0.0 };
        if !is_where_it_should || s.pdf.hero() <= 0.0 {
            return None;
        }
        let (cosine, pdf_rev) = match s.delta {
            None => {
                let pdf_rev = self.leaf.pdf(s.wi, o, s.crossing.reversed());
                (self.cosine(o, s.wi, wi, s.crossing, mode), pdf_rev)
            }
            Some(pdf_rev) => (self.delta_cosine(o, s.wi, wi, mode), pdf_rev),
        };
        let weight = self.corrected(s.f, s.crossing, mode) * (cosine / s.pdf.hero());
        Some(Scattered { wi, weight, pdf: s.pdf, pdf_rev, is_delta: s.delta.is_some(), is_transmitted })
    }

    /// The symmetric model's value as the BSDF of the path's own mode: times η_camera / η_light.
    #[inline]
    fn corrected(&self, f: SampledSpectrum, crossing: Crossing, mode: Mode) -> SampledSpectrum {
        match (crossing, mode) {
            (Crossing::Reflect, _) => f,
            // `wo` lies above: towards the camera for radiance, towards the light for importance.
            (_, Mode::Radiance) => f / self.leaf.eta(),
            (_, Mode::Importance) => f * self.leaf.eta(),
        }
    }

    /// The cosine that belongs to `f` in this mode, with the adjoint of the shading normal: 0 where the
    /// light's direction, `wi` or `wo` by mode, lies on the wrong side of the shading normal.
    #[inline]
    fn cosine(&self, o: Vec3, i: Vec3, wi: Vec3, crossing: Crossing, mode: Mode) -> Real {
        match mode {
            Mode::Radiance => (if crossing == Crossing::Reflect { i.z } else { -i.z }).max(0.0),
            Mode::Importance => {
                let geometric = self.wo.dot(self.n_g).abs();
                if geometric == 0.0 { 0.0 } else { o.z.max(0.0) * wi.dot(self.n_g).abs() / geometric }
            }
        }
    }

    /// The same over |cos| of the drawn direction, for events of delta kind.
    #[inline]
    fn delta_cosine(&self, o: Vec3, i: Vec3, wi: Vec3, mode: Mode) -> Real {
        match mode {
            Mode::Radiance => 1.0,
            Mode::Importance => {
                let ends = self.wo.dot(self.n_g).abs() * i.z.abs();
                if ends == 0.0 { 0.0 } else { o.z.max(0.0) * wi.dot(self.n_g).abs() / ends }
            }
        }
    }
}
