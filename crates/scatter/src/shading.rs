//! Where a path meets a surface: the only place of cosines, of η² and of corrections for shading normals.
//!
//! **Shading normals.** The geometric normal decides on which side a direction lies, so that no light
//! leaks through a surface; the shading normal gives the cosine. Three rules make of a model f that
//! knows the shading normal alone a BSDF that loses no light however far that normal leans. Let c be the
//! direction towards the camera, l that towards the light, and l* a direction on the wrong side that l stands for:
//!
//! 1. A camera below the shading normal's horizon, but before the surface, is taken to be as far above
//!    that horizon: c becomes ĉ.
//! 2. What f scatters to the wrong side of the surface leaves on the right side: the light has met the flank of a
//!    neighbouring bump (as in Schüssler et al. 2017, "Microfacet-based Normal Mapping for Robust Monte Carlo Path
//!    Tracing"). A lobe is mirrored at the surface, as by their tangential facet; what a matt surface scatters is spread
//!    over the whole right side ([`WrongSide`]). So light counts from l and from l*, whose solid angle is J times that of
//!    l: K(c, l) = f(ĉ, l) ⟨l·ns⟩ + J f(ĉ, l*) ⟨l*·ns⟩, where ⟨⟩ is the cosine on the right side, else 0.
//! 3. Light that travels from a lamp sees the same K through its adjoint, K |c·ng| / |l·ng| (Veach 1997, section 5.3).
//!
//! The integral of K over l is f's own albedo, whatever ns is: nothing darkens at edges, nothing is made.
//!
//! **Refraction.** Radiance that passes from index η_i to η_o is multiplied by (η_o/η_i)². Models are
//! symmetric, f_sym = f / (η_camera / η_light), where the ends are those of the path as a whole, so the one
//! factor η_camera / η_light turns them into the BSDF of either mode. For events of delta kind the density in
//! solid angle is not there to bring the rest: with T the transmittance and `factor = T η_o/η_i` their weight
//! is T (η_o/η_i)² for radiance and T η_o/η_i · η_i/η_o = T for importance (Veach 1997, section 5.2).

use crate::materials::Leaf;
use crate::scatter::{Crossing, Delta, LocalSample, Scatter};
use crate::wrong_side::WrongSide;
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
    /// For a matt surface whose shading normal leans.
    wrong_side: Option<WrongSide>,
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
        let (n_g, n_s) = (n_g * side, n_s * side);
        let wrong_side = if n_s != n_g && leaf.is_matt() { WrongSide::new(n_g, n_s) } else { None };
        Self { leaf, frame: Frame::from_normal(n_s), n_g, wo, wrong_side }
    }

    /// The geometric normal on the side from which the surface is seen.
    #[inline]
    pub fn n_g(&self) -> Vec3 {
        self.n_g
    }

    /// The shading normal on the side from which the surface is seen.
    #[inline]
    pub fn n_s(&self) -> Vec3 {
        self.frame.n
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

    /// Whether light from the other side can be scattered to this one, but by events of delta kind.
    #[inline]
    pub fn lets_through(&self) -> bool {
        self.leaf.lets_through()
    }

    /// BSDF, cosine and both densities for a direction.
    #[inline]
    pub fn eval(&self, wi: Vec3, mode: Mode) -> Evaluation {
        let side = wi.dot(self.n_g);
        // Along the surface, or no number: nothing.
        if side == 0.0 || side.is_nan() {
            return Evaluation::NOTHING;
        }
        let (crossing, sign) = if side > 0.0 { (Crossing::Reflect, 1.0) } else { (Crossing::Down, -1.0) };
        let (o, i) = (self.frame.to_local(self.wo), self.frame.to_local(wi));
        let (seen_o, seen_i) = (raised(o, 1.0), raised(i, sign));
        let (mut k, mut pdf, mut pdf_rev) = (SampledSpectrum::ZERO, LanePdf::ZERO, LanePdf::ZERO);
        for (l, density) in self.stands_for(wi, i, sign).into_iter().flatten() {
            pdf += self.leaf.pdf(seen_o, l, crossing) * density;
            if mode == Mode::Radiance {
                k += self.leaf.f(seen_o, l, crossing) * (l.z * sign * density);
            }
        }
        // The same from the other end.
        for (l, density) in self.stands_for(self.wo, o, 1.0).into_iter().flatten() {
            pdf_rev += self.leaf.pdf(seen_i, l, crossing.reversed()) * density;
            if mode == Mode::Importance {
                k += self.leaf.f(l, seen_i, crossing) * (l.z * density);
            }
        }
        let f_cos = self.corrected(k, crossing, mode) * self.adjoint(wi, mode);
        Evaluation { f_cos, pdf, pdf_rev }
    }

    /// Draws a direction; `None` where the light is absorbed.
    #[inline]
    pub fn sample(&self, u: [Real; 3], mode: Mode) -> Option<Scattered> {
        let o = self.frame.to_local(self.wo);
        let drawn = self.leaf.sample(raised(o, 1.0), u)?;
        let is_transmitted = drawn.crossing != Crossing::Reflect;
        let mut wi = self.frame.to_world(drawn.wi);
        let side = wi.dot(self.n_g);
        let is_mirrored = if is_transmitted { side > 0.0 } else { side < 0.0 };
        if is_mirrored {
            wi = match &self.wrong_side {
                Some(map) if is_transmitted => -map.right(-wi),
                Some(map) => map.right(wi),
                None => wi - self.n_g * (2.0 * side),
            };
        }
        if let Some(delta) = drawn.delta {
            return self.delta(&drawn, &delta, wi, mode, is_mirrored || o.z < 0.0);
        }
        let Evaluation { f_cos, pdf, pdf_rev } = self.eval(wi, mode);
        (pdf.hero() > 0.0).then(|| Scattered {
            wi,
            weight: f_cos / pdf.hero(),
            pdf,
            pdf_rev,
            is_delta: false,
            is_transmitted,
        })
    }

    /// An event of delta kind. Where one of its ends was moved, it does not lead back the same way: so it is
    /// drawn from the camera's side alone, and its reverse cannot happen.
    #[inline]
    fn delta(
        &self,
        drawn: &LocalSample,
        delta: &Delta,
        wi: Vec3,
        mode: Mode,
        is_moved: bool,
    ) -> Option<Scattered> {
        if delta.probability.hero() <= 0.0
            || wi.dot(self.n_g) == 0.0
            || (is_moved && mode == Mode::Importance)
        {
            return None;
        }
        // The cosine of the light cancels against the delta's own; in the adjoint, that of the camera.
        let cosine = match mode {
            Mode::Radiance => 1.0,
            Mode::Importance => self.frame.to_local(self.wo).z * self.adjoint(wi, mode) / drawn.wi.z.abs(),
        };
        let factor = self.corrected(delta.factor, drawn.crossing, mode) * cosine;
        Some(Scattered {
            wi,
            weight: factor / delta.probability.hero(),
            pdf: delta.probability,
            pdf_rev: if is_moved { LanePdf::ZERO } else { delta.reverse },
            is_delta: true,
            is_transmitted: drawn.crossing != Crossing::Reflect,
        })
    }

    /// The directions that one on the right side, above (`sign` 1) or below (-1), stands for by rule 2, as far as the
    /// model scatters there: itself, `local` in the frame, and one on the wrong side; and J of each.
    #[inline]
    fn stands_for(&self, direction: Vec3, local: Vec3, sign: Real) -> [Option<(Vec3, Real)>; 2] {
        let image = if let Some(map) = &self.wrong_side {
            let (image, density) = map.image(direction * sign);
            Some((self.frame.to_local(image) * sign, density))
        } else if self.frame.n != self.n_g {
            Some((local - self.frame.to_local(self.n_g) * (2.0 * direction.dot(self.n_g)), 1.0))
        } else {
            // Both normals are one, and there is no wrong side.
            None
        };
        [Some((local, 1.0)), image].map(|l| l.filter(|(l, _)| l.z * sign > 0.0))
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

    /// Rule 3: what turns K into BSDF times cosine in a mode.
    #[inline]
    fn adjoint(&self, wi: Vec3, mode: Mode) -> Real {
        match mode {
            Mode::Radiance => 1.0,
            Mode::Importance => {
                let light = self.wo.dot(self.n_g).abs();
                if light == 0.0 { 0.0 } else { wi.dot(self.n_g).abs() / light }
            }
        }
    }
}

/// Rule 1: a local direction on a side (1: above, -1: below), as far from the horizon as it was.
#[inline]
fn raised(d: Vec3, side: Real) -> Vec3 {
    Vec3::new(d.x, d.y, d.z.abs() * side)
}
