//! Where light paths begin, and where they go from there.

use super::{Chosen, LightTable, NO_LAMP};
use crate::query::{Emission, EmissionPdf, EmitterPoint, Place, Source, SourceView};
use indigo_math::{Real, Vec3};
use indigo_spectrum::{SampledSpectrum, SampledWavelengths};

impl LightTable {
    /// Draws light that leaves a lamp or enters the scene: `u` as for [`sample`](Self::sample), `v`
    /// chooses a direction or a place. `None` where there is none to be had.
    #[inline]
    pub fn sample_emission(
        &self,
        u: [Real; 4],
        v: [Real; 2],
        lambda: &SampledWavelengths,
    ) -> Option<Emission> {
        self.emit(&self.sample_source(u)?, v, lambda)
    }

    /// The first half of [`sample_emission`](Self::sample_emission): where the light comes from.
    #[inline]
    pub fn sample_source(&self, u: [Real; 4]) -> Option<Source> {
        let at = [u[1], u[2]];
        match self.choose(self.share_of_emission, u)? {
            Chosen::Lamps(rest) => {
                let (i, _, rest) = self.by_power.sample(rest);
                let point = self.lamps[i].sample_point(rest, at)?;
                let pdf = self.pdf_sent(i, point.triangle, point.bary);
                let chance = self.chance_of_sending(i);
                Some(Source { place: Place::Lamp(i as u32, point), pdf, chance })
            }
            Chosen::Environment(rest) => {
                let environment = self.environment.as_ref()?;
                let (towards, rest) = environment.sample_source(rest, at)?;
                let chance = self.chance_of_environment();
                let pdf = chance * environment.pdf_source(towards);
                (pdf > 0.0).then_some(Source { place: Place::Environment(towards, rest), pdf, chance })
            }
        }
    }

    /// The second half: where the light goes; `None` where it does not get into the scene.
    #[inline]
    pub fn emit(&self, source: &Source, v: [Real; 2], lambda: &SampledWavelengths) -> Option<Emission> {
        match source.place {
            Place::Lamp(number, point) => self.leave(number, point, source.pdf, v, lambda),
            Place::Environment(towards, rest) => self.enter(towards, source.pdf, rest, v, lambda),
        }
    }

    #[inline]
    fn leave(
        &self,
        number: u32,
        mut point: EmitterPoint,
        first: Real,
        v: [Real; 2],
        lambda: &SampledWavelengths,
    ) -> Option<Emission> {
        let lamp = &self.lamps[number as usize];
        let direction = lamp.sample_direction(&point, v);
        let pdf = EmissionPdf { first, second: lamp.pdf_direction(point.triangle, point.n, direction) };
        if direction.dot(point.n) < 0.0 {
            point.n = -point.n;
        }
        (pdf.second > 0.0).then(|| Emission {
            origin: point.p,
            radiance: lamp.emitted(point.triangle, point.bary, direction, lambda),
            point: Some(point),
            direction,
            pdf,
            lamp: number,
        })
    }

    #[inline]
    fn enter(
        &self,
        towards: Vec3,
        first: Real,
        choice: f64,
        v: [Real; 2],
        lambda: &SampledWavelengths,
    ) -> Option<Emission> {
        let environment = self.environment.as_ref()?;
        let origin = environment.sample_entry(towards, choice, v)?;
        let pdf = EmissionPdf { first, second: environment.pdf_entry(towards, origin) };
        // A scene without extent gets no light: the density over its area has no value.
        (pdf.second > 0.0 && pdf.second.is_finite()).then(|| Emission {
            origin,
            point: None,
            direction: -towards,
            radiance: environment.radiance(towards, lambda),
            pdf,
            lamp: NO_LAMP,
        })
    }

    /// A source as it is seen from a point, whatever may be in the way; `None` where it does not shine there.
    #[inline]
    pub fn source_seen_from(&self, source: &Source, p: Vec3) -> Option<SourceView> {
        match source.place {
            Place::Lamp(number, mut point) => {
                let (wi, over_angle) = self.lamps[number as usize].turn_towards(p, &mut point)?;
                Some(SourceView { wi, point: Some(point), pdf: source.pdf * over_angle })
            }
            Place::Environment(wi, _) => Some(SourceView { wi, point: None, pdf: source.pdf }),
        }
    }

    /// The radiance that comes from there, W m^-3 sr^-1.
    #[inline]
    pub fn radiance_of(
        &self,
        source: &Source,
        seen: &SourceView,
        lambda: &SampledWavelengths,
    ) -> SampledSpectrum {
        match source.place {
            Place::Lamp(number, at) => {
                self.lamps[number as usize].emitted(at.triangle, at.bary, -seen.wi, lambda)
            }
            Place::Environment(towards, _) => {
                self.environment(towards, lambda).unwrap_or(SampledSpectrum::ZERO)
            }
        }
    }

    /// Probability that a light path begins on the lamp that an object is; 0 where it is none.
    #[inline]
    pub fn chance_of_object(&self, object: u32) -> Real {
        self.lamp(object).map_or(0.0, |(i, _)| self.chance_of_sending(i))
    }

    /// The same of the environment as a whole.
    #[inline]
    pub fn chance_of_environment(&self) -> Real {
        self.share_of_emission as Real
    }
}
