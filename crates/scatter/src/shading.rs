//! Where a path meets a surface: the only place of cosines and of corrections for shading normals.
//!
//! The geometric normal decides on which side a direction lies, so that no light leaks through a
//! surface however its shading normal leans; the shading normal gives the cosine. Light that
//! travels from a lamp sees the same BSDF through the adjoint, whose factor is
//! |ωo·ns| |ωi·ng| / (|ωo·ng| |ωi·ns|) (Veach 1997, section 5.3).

use crate::materials::Leaf;
use crate::scatter::Scatter;
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

/// A direction drawn from the model.
#[derive(Clone, Copy, Debug)]
pub struct Scattered {
    /// Unit direction, away from the surface.
    pub wi: Vec3,
    /// BSDF times cosine over the hero's density, all corrections in.
    pub weight: SampledSpectrum,
    /// Density (1/sr) of `wi`.
    pub pdf: LanePdf,
    /// Density (1/sr) with which `wo` would be drawn from `wi`.
    pub pdf_rev: LanePdf,
}

impl ShadingPoint {
    /// Sets a model up at a point with unit normals `n_g` and `n_s` (of one side) seen from `wo`.
    #[inline]
    pub fn new(leaf: Leaf, n_g: Vec3, n_s: Vec3, wo: Vec3) -> Self {
        let side = if wo.dot(n_g) < 0.0 { -1.0 } else { 1.0 };
        Self { leaf, frame: Frame::from_normal(n_s * side), n_g: n_g * side, wo }
    }

    /// The geometric normal on the side from which the surface is seen.
    pub fn n_g(&self) -> Vec3 {
        self.n_g
    }

    /// BSDF, cosine and both densities for a direction.
    #[inline]
    pub fn eval(&self, wi: Vec3, mode: Mode) -> Evaluation {
        let (o, i) = (self.frame.to_local(self.wo), self.frame.to_local(wi));
        if wi.dot(self.n_g) <= 0.0 {
            return Evaluation { f_cos: SampledSpectrum::ZERO, pdf: LanePdf::ZERO, pdf_rev: LanePdf::ZERO };
        }
        Evaluation {
            f_cos: self.leaf.f(o, i) * self.cosine(o, i, wi, mode),
            pdf: self.leaf.pdf(o, i),
            pdf_rev: self.leaf.pdf(i, o),
        }
    }

    /// Draws a direction; `None` where the light is absorbed.
    #[inline]
    pub fn sample(&self, u: [Real; 3], mode: Mode) -> Option<Scattered> {
        let o = self.frame.to_local(self.wo);
        let s = self.leaf.sample(o, u)?;
        let wi = self.frame.to_world(s.wi);
        // A direction that the shading normal allows but the geometry does not: absorbed.
        if wi.dot(self.n_g) <= 0.0 || s.pdf.hero() <= 0.0 {
            return None;
        }
        let weight = s.f * (self.cosine(o, s.wi, wi, mode) / s.pdf.hero());
        Some(Scattered { wi, weight, pdf: s.pdf, pdf_rev: self.leaf.pdf(s.wi, o) })
    }

    /// The cosine that belongs to `f` in this mode, with the adjoint of the shading normal: 0 where the
    /// light's direction, `wi` or `wo` by mode, lies below the horizon of the shading normal.
    #[inline]
    fn cosine(&self, o: Vec3, i: Vec3, wi: Vec3, mode: Mode) -> Real {
        match mode {
            Mode::Radiance => i.z.max(0.0),
            Mode::Importance => {
                let geometric = self.wo.dot(self.n_g).abs();
                if geometric == 0.0 { 0.0 } else { o.z.max(0.0) * wi.dot(self.n_g).abs() / geometric }
            }
        }
    }
}
