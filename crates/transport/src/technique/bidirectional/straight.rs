//! Light that shines straight into the lens: strategy (1, 1), and its weight beside (0, 2).
//!
//! The camera's ray meets a lamp by itself, (0, 2), or the point at which the light's path begins is joined to the lens,
//! (1, 1). The second is what finds small lamps out of focus, and the far reaches of diffraction.
//!
//! Densities alone would mislead the weights here, as a pixel has samples of its own. Let a part h of its rays see
//! the lamp, and let light paths reach it q times as densely as camera rays do. Of so many samples for a pixel, the
//! camera's have the relative variance (1 − h) / h, and those of light paths, which fall anywhere, 1 / (q h). The
//! variance of the sum is least where (0, 2) has the weight 1 / (1 + q (1 − h)): that of the balance heuristic with the
//! density of (1, 1) times 1 − h. So where all rays of a pixel see the lamp it has no noise, and light paths add none.
//!
//! That is for samples of their own in each pixel: a Markov chain has none, and there the weights are but sound. The power
//! heuristic, which all strategies share, keeps within 13 % of the least variance.
//!
//! Nobody knows h, but whatever stands for it, weights are right that both strategies make of the same numbers (Veach
//! 1997, section 9.2), the same whichever of the path's wavelengths is its hero: the densities of the two strategies have
//! not the same ratios between wavelengths where a medium scatters some more, so weights that depended on the hero would
//! not sum to one in the mean. Sharp, the lamp would cover the part S of the film, the density of the camera's direction over
//! that of drawing the light had its lamp been the only one. Light of a point spreads over the film with a density
//! of D: 1 / blur by the lens, that of the offset by diffraction, and no more than 1 / (area of a pixel). Then
//! h = min(1, S D), as if the lamp were even and nothing stood before it. An offset that stays within the lamp's image
//! leads from a pixel that sees the lamp to one that does, however rare it is: there diffraction does not count.

use super::Sample;
use crate::technique::mis::Weight;
use crate::technique::visibility::{Point, way_from_lens};
use crate::technique::{Part, Record, Splat};
use indigo_light::{Source, SourceView};
use indigo_math::{Real, Vec3};

/// What the weights go by of light that comes to the lens from a unit direction `wi`.
pub(super) struct Seen {
    pub wi: Vec3,
    /// How far off the light is, metres; infinite for the environment.
    pub distance: Real,
    /// Density (1/sr) with which light paths begin there, and the probability that they begin on its lamp.
    pub pdf: Real,
    pub chance: Real,
}

impl Seen {
    fn of(source: &Source, view: &SourceView, p: Vec3) -> Self {
        let distance = view.point.map_or(Real::INFINITY, |at| (at.p - p).length());
        Self { wi: view.wi, distance, pdf: view.pdf, chance: source.chance }
    }

    /// The density (1/sr) of strategy (1, 1), as far as weights are concerned.
    #[inline]
    pub fn counted_pdf(&self, sample: &Sample) -> Real {
        let Sample { world, camera, .. } = sample;
        let (lens, film) = (&world.scene.camera, &world.scene.film.size);
        let sharp = lens.pdf_direction(self.wi, self.distance, world.time) * self.chance / self.pdf;
        let pixels = film.internal_width() as Real * film.internal_height() as Real;
        let offset_density = if camera.offset_disc <= sharp { Real::INFINITY } else { camera.offset_density };
        let spread =
            lens.blur(self.wi, self.distance, world.time).max(1.0 / pixels).recip().min(offset_density);
        // Without density there is nothing to cover, and nothing to count.
        if sharp * spread < 1.0 { self.pdf * (1.0 - sharp * spread) } else { 0.0 }
    }
}

/// Strategy (1, 1): joins the source of the light's path to the lens.
pub(super) fn join_source<R: Record>(
    sample: &Sample,
    source: &Source,
    film_density: Real,
    record: &mut R,
) -> Option<Splat> {
    let Sample { world, camera, events } = sample;
    let scene = world.scene;
    if !events.holds(0) {
        return None;
    }
    let origin = match source.point() {
        Some(p) => sample.origin_towards(p),
        // The direction that was drawn is none of parallel rays.
        None if scene.camera.is_parallel() => return None,
        None => camera.origin,
    };
    let view = scene.lights.source_seen_from(source, origin)?;
    let film = sample.on_film(origin, view.wi)?;
    let seen = Seen::of(source, &view, origin);
    let counted = seen.counted_pdf(sample);
    if counted == 0.0 && !R::LOOKS {
        return None;
    }
    let light = scene.lights.radiance_of(source, &view, world.lambda);
    if light.is_black() {
        return None;
    }
    let to = view.point.as_ref().map(Point::of_light);
    let passage = way_from_lens(world, origin, view.wi, to.as_ref())?;
    let pdf = scene.camera.pdf_direction(view.wi, seen.distance, world.time);
    let weight = Weight::straight(camera.ratio, passage.free * (pdf * film_density), counted);
    let arrived = light.times(camera.ratio) * passage.transmittance;
    let value = arrived * (film.importance * pdf / view.pdf);
    let (strategy, sender) = ((1, 1), source.sender());
    record.contribution(strategy, Some(film.position), value / weight.mean_ratio, weight.weight, sender);
    let part = Part::of(strategy, sender);
    Some(Splat { position: film.position, radiance: value * weight.factor(), part })
}
