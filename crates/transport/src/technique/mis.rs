//! Weights among the ways in which a path can be made, kept vertex by vertex.
//!
//! A path of n vertices can be made by joining s vertices of a light path and t = n − s of a camera
//! path, for every s. Strategy i has the density p_i = Π fwd_j (j < i) · Π rev_j (j ≥ i), where fwd_j
//! is the density with which vertex j is found from the light's side and rev_j that from the camera's.
//! All p_i / p_s follow from the quotients rev_j / fwd_j, whose running sums need constant work per
//! vertex and per connection (van Antwerpen 2011, "Recursive MIS Computation for Streaming BDPT on the
//! GPU"; Georgiev 2012, "Implementing Vertex Connection and Merging"). The same holds from the camera.
//!
//! Here every density is one per lane, as sampling may depend on the wavelength. All are kept over
//! the density of the *hero* of the strategy that made the prefix, the only number that is divided
//! by: it is positive, whatever the other lanes are. With m(x) = x^β, lanes l and
//! ρ_l = p_s,l / p_s,hero the weight of strategy s is
//!
//! w_s = Σ_l m(ρ_l) / Σ_l Σ_i m(p_i,l / p_s,hero),
//!
//! which sums to 1 over s for any path, and the contribution is f_l / p_s,hero · w_s / mean(ρ)
//! (Veach 1997, section 9.2; Wilkie et al. 2014, equation 12).
//!
//! A vertex where the path went on by an event of delta kind cannot be joined, so strategies that
//! would end there count nothing. The probability that stands for the delta's density is the
//! same from both sides of the quotient wherever both are divided, so it cancels as the delta does.
//! Where bump maps or smoothed normals move a delta away from where the surface itself would send it, light paths never
//! go that way: the density back is 0. So no strategy counts that would have the light's path pass there, and those
//! with the vertex on the camera's side share the weight among themselves.
//! Roulette is left out of all densities, for every strategy alike.
//!
//! What turns a density in solid angle, over squared distance, into that of a vertex is its *reach*: a
//! cosine on a surface (density over area), and in a medium the scattering coefficient (density over
//! volume). Both are multiplied by the probability with which the path gets there unscattered, the same in
//! both directions. These depend on the wavelength.

use indigo_math::Real;
use indigo_scatter::Scattered;
use indigo_spectrum::LanePdf;

/// The exponent of the heuristic: a power of 2 or, if 1, the balance heuristic.
const SQUARED: bool = true;

#[inline(always)]
fn m(x: LanePdf) -> LanePdf {
    if SQUARED { x * x } else { x }
}

#[inline(always)]
fn m1(x: Real) -> Real {
    if SQUARED { x * x } else { x }
}

/// What is known of the vertices up to one, k, of a subpath.
#[derive(Clone, Copy, Debug)]
pub(super) struct Prefix {
    /// R_k: density of the vertices up to k in each lane, over the hero's.
    pub ratio: LanePdf,
    /// The same up to k − 1, and what a different way of finding vertex k − 1 adds to it.
    pub before: LanePdf,
    /// 1 / the hero's density of vertex k.
    inverse_pdf: Real,
    /// The density with which k would find k − 1, but for that of its direction (1/sr), over the hero's of k. The
    /// distance between them cancels: it may be so small that its powers leave the scalar's range.
    returns: LanePdf,
    /// Strategies that end before k − 1, over this one.
    others: LanePdf,
    /// Whether the path went on from k − 1 by a direction that can be given.
    is_previous_connectable: bool,
}

/// A step on the way to the next vertex, whose place is not yet known.
#[derive(Clone, Copy, Debug)]
pub(super) struct Step {
    ratio: LanePdf,
    before: LanePdf,
    pdf: Real,
    others: LanePdf,
    /// Of the vertex that it leaves; 0 for the lens, which nothing finds.
    reach: LanePdf,
    is_connectable: bool,
    /// Whether it is one of parallel rays, whose density over area does not fall with distance.
    is_parallel: bool,
}

impl Step {
    /// From a point of the lens, by a direction of density `pdf` (1/sr). The lens cannot be met by
    /// chance, so no strategy ends before it. Every strategy draws the diffraction at the lens in the
    /// same way; `ratio` is its density in each lane, over the hero's. If the camera's rays are parallel, `pdf` is their
    /// density over area (1/m²).
    #[inline]
    pub fn from_camera(pdf: Real, ratio: LanePdf, is_parallel: bool) -> Self {
        Self {
            ratio,
            before: ratio,
            pdf,
            others: LanePdf::ZERO,
            reach: LanePdf::ZERO,
            is_connectable: true,
            is_parallel,
        }
    }

    /// From a lamp or the environment, whose first density is `first` and second `second`
    /// ([`EmissionPdf`](indigo_light::EmissionPdf)), under `cos` to its normal (1 for the environment).
    /// The camera's path can find it by itself.
    #[inline]
    pub fn from_light(first: Real, second: Real, cos: Real) -> Self {
        Self {
            ratio: LanePdf::ONE,
            before: LanePdf::ONE,
            pdf: second,
            others: LanePdf::splat(m1(1.0 / first)),
            reach: LanePdf::splat(cos),
            is_connectable: true,
            is_parallel: false,
        }
    }

    /// The next vertex at squared distance `distance2`, which has a `reach` towards this one, and is got to
    /// unscattered with the probabilities `free`.
    #[inline]
    pub fn arrive(&self, distance2: Real, reach: LanePdf, free: LanePdf) -> Prefix {
        let distance2 = if self.is_parallel { 1.0 } else { distance2 };
        self.prefix(distance2, reach * free, self.reach * free)
    }

    /// The next vertex is a direction of the environment.
    #[inline]
    pub fn arrive_at_environment(&self, free: LanePdf) -> Prefix {
        self.prefix(1.0, free, self.reach * free)
    }

    /// The next vertex is met by light of the environment.
    #[inline]
    pub fn arrive_from_environment(&self, reach: LanePdf, free: LanePdf) -> Prefix {
        self.prefix(1.0, reach * free, free)
    }

    /// Factors of the densities with which the next vertex is found from here, and this one from there, both
    /// over the squared distance.
    #[inline]
    fn prefix(&self, distance2: Real, there: LanePdf, back: LanePdf) -> Prefix {
        let inverse = 1.0 / (self.pdf * there.hero());
        Prefix {
            ratio: self.ratio * there.ratio_to_hero(),
            before: self.before,
            inverse_pdf: distance2 * inverse,
            returns: back * inverse,
            others: self.others,
            is_previous_connectable: self.is_connectable,
        }
    }
}

impl Prefix {
    /// Goes on from the vertex, which has a `reach` towards it, by a drawn direction.
    #[inline]
    pub fn step(&self, drawn: &Scattered, reach: LanePdf) -> Step {
        let is_connectable = !drawn.is_delta;
        let mut others = m(drawn.pdf_rev * self.returns) * self.others;
        if is_connectable && self.is_previous_connectable {
            others += m(self.before * self.inverse_pdf);
        }
        Step {
            ratio: self.ratio * drawn.pdf.ratio_to_hero(),
            before: self.ratio,
            pdf: drawn.pdf.hero(),
            others,
            reach,
            is_connectable,
            is_parallel: false,
        }
    }

    /// Strategies that end before this vertex, over the one that ends here: `found` is the density
    /// with which the other side finds this vertex (in the measure of its own), and `found_previous`
    /// (1/sr) that with which this vertex then finds the one before.
    #[inline]
    pub fn others(&self, found: LanePdf, found_previous: LanePdf) -> LanePdf {
        self.joined(found) + m(found * (found_previous * self.returns)) * self.others
    }

    /// The same for a camera path that ends on a light, which light sampling finds with density
    /// `drawn`, and light paths with `first` and then `second` ([`EmissionPdf`](indigo_light::EmissionPdf)).
    #[inline]
    pub fn others_at_light(&self, drawn: Real, first: Real, second: Real) -> LanePdf {
        self.joined(LanePdf::splat(drawn)) + m(self.returns * (second * first)) * self.others
    }

    /// The same where the path has come straight from the lens.
    #[inline]
    pub fn others_at_seen_light(&self, drawn: Real) -> LanePdf {
        self.joined(LanePdf::splat(drawn))
    }

    /// The strategy that joins vertex k − 1 to this one, which it finds with density `found`.
    #[inline]
    fn joined(&self, found: LanePdf) -> LanePdf {
        if self.is_previous_connectable { m(self.before * (found * self.inverse_pdf)) } else { LanePdf::ZERO }
    }
}

/// The weight over the mean of ρ, by which f over the hero's density becomes a contribution.
#[derive(Clone, Copy, Debug)]
pub(super) struct Weight {
    /// w_s.
    pub weight: Real,
    /// mean(ρ).
    pub mean_ratio: Real,
}

impl Weight {
    /// From ρ and the sum of all other strategies over this one.
    #[inline]
    pub fn new(ratio: LanePdf, others: LanePdf) -> Self {
        let own = m(ratio).sum();
        Self { weight: own / (own + others.sum()), mean_ratio: ratio.mean() }
    }

    /// For light that was drawn and shines straight into the lens: `met` is the density (1/sr) with which the camera's ray
    /// would have met it, and `drawn` that of drawing it, or what counts of that.
    #[inline]
    pub fn straight(ratio: LanePdf, met: LanePdf, drawn: Real) -> Self {
        if drawn > 0.0 {
            Self::new(ratio, m(ratio * (met / drawn)))
        } else {
            Self { weight: 0.0, mean_ratio: ratio.mean() }
        }
    }

    /// For light that was drawn towards the end of a camera path: `met` is the density with which the
    /// path would have met it over that of drawing it, and `emitted` the same of its emission.
    #[inline]
    pub fn drawn_light(ratio: LanePdf, met: LanePdf, others_camera: LanePdf, emitted: Real) -> Self {
        Self::new(ratio, m(ratio * met) + others_camera * m1(emitted))
    }

    /// For a joint of two subpaths with the sums of their other strategies.
    #[inline]
    pub fn joint(a: LanePdf, others_a: LanePdf, b: LanePdf, others_b: LanePdf) -> Self {
        Self::new(a * b, others_a * m(b) + others_b * m(a))
    }

    /// Factor of f over the hero's density.
    #[inline]
    pub fn factor(self) -> Real {
        self.weight / self.mean_ratio
    }
}

#[cfg(test)]
mod tests;
