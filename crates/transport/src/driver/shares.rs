//! A sample's light by the groups of lights that sent it.

use crate::technique::{End, Part, Record};
use indigo_light::{LightTable, Sender};
use indigo_math::{Real, Vec2, Vec3};
use indigo_spectrum::{SampledSpectrum, SampledWavelengths};

/// Light of one group.
#[derive(Clone, Copy, Debug)]
pub(super) struct Share {
    pub group: u16,
    pub part: Part,
    /// Its film position, from (0, 0) to (1, 1), where that is not the camera ray's.
    pub at: Option<Vec2>,
    /// Radiance, W m^-3 sr^-1, as it counts on the film.
    pub radiance: SampledSpectrum,
}

/// Looks at the contributions of one sample after another, and keeps those of the last one by their groups; hands on all that
/// it sees.
///
/// Groups are only how a sample's light is summed: what is traced, and with which densities and weights, is the
/// same with and without them.
pub(super) struct Shares<'a, R> {
    lights: &'a LightTable,
    others: &'a mut R,
    lambda: Option<SampledWavelengths>,
    found: &'a mut Vec<Share>,
}

impl<'a, R: Record> Shares<'a, R> {
    /// For the lights of a scene, and somebody else who looks on; with room that is used again and again.
    pub fn new(lights: &'a LightTable, others: &'a mut R, found: &'a mut Vec<Share>) -> Self {
        Self { lights, others, lambda: None, found }
    }

    /// What the last sample found.
    pub fn found(&self) -> &[Share] {
        self.found
    }
}

impl<R: Record> Record for Shares<'_, R> {
    fn begin(&mut self, position: Vec2, lambda: &SampledWavelengths) {
        self.found.clear();
        self.lambda = Some(*lambda);
        self.others.begin(position, lambda);
    }

    fn vertex(&mut self, from: End, p: Vec3, is_on_surface: bool) {
        self.others.vertex(from, p, is_on_surface);
    }

    fn contribution(
        &mut self,
        strategy: (u32, u32),
        at: Option<Vec2>,
        unweighted: SampledSpectrum,
        weight: Real,
        sender: Sender,
    ) {
        if R::LOOKS {
            self.others.contribution(strategy, at, unweighted, weight, sender);
        }
        let light = unweighted * weight;
        let Some(lambda) = self.lambda.as_ref().filter(|_| !light.is_black()) else { return };
        let part = Part::of(strategy, sender);
        let found = &mut *self.found;
        self.lights.share_out(sender, light, lambda, |group, radiance| {
            found.push(Share { group, part, at, radiance });
        });
    }
}
