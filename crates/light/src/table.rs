//! All lights of a scene: choosing one, drawing light from it, and the density of having done so.
//!
//! Light leaves lamps by their power, and is drawn for a receiver by what each may give it ([`LightTree`]). The
//! environment's power grows with the scene's extent, and says nothing of what
//! gets to a receiver, least of all in a room: beside lamps it gets half of the draws, and half of the light paths
//! begin with it. So whichever of the two matters, it has half of the samples that it would have alone.

mod groups;
mod sources;

use crate::area::AreaLight;
use crate::environment::Environment;
use crate::kinds::DistantLight;
use crate::light_tree::LightTree;
use crate::portals::Portals;
use crate::query::{Emission, EmissionPdf, EmitterHit, LightSample, Receiver, Sender};
use indigo_math::distribution::{AliasTable, refined};
use indigo_math::{Float, Real, Vec3, Vec3d};
use indigo_spectrum::{LightSpectrum, SampledSpectrum, SampledWavelengths};

/// Lamps and the environment, with distributions to choose among them.
#[derive(Clone, Debug)]
pub struct LightTable {
    lamps: Vec<AreaLight>,
    environment: Option<Environment>,
    /// Over the lamps, for light that leaves one.
    by_power: AliasTable,
    /// Over their triangles, for receivers.
    for_receivers: LightTree,
    /// The environment's share of the light paths that begin, and of the draws for receivers; the rest is the lamps'.
    share_of_emission: f64,
    share_of_draws: f64,
    /// For each object of the scene the lamp that it is, or [`NO_LAMP`].
    of_object: Vec<u32>,
    /// For each distant light the group that it belongs to; all to group 0, where this is empty.
    distant_groups: Vec<u16>,
}

const NO_LAMP: u32 = u32::MAX;

/// Lamps whose spectra are looked at; those of more are most often the same.
const SPECTRA: usize = 256;

/// The most probable choices of a table, the most probable first.
fn strongest(table: &AliasTable) -> Vec<usize> {
    let mut order: Vec<usize> = (0..table.len()).collect();
    order.sort_by(|&a, &b| table.probability(b).total_cmp(&table.probability(a)));
    order.truncate(SPECTRA);
    order
}

/// What was chosen, with a fresh number in [0, 1).
enum Chosen {
    Lamps(f64),
    Environment(f64),
}

impl LightTable {
    /// From lamps and distant lights, the lamp that each object is, and the centre and radius in
    /// metres of a sphere round the scene.
    pub fn new(
        lamps: Vec<AreaLight>,
        distant: Vec<DistantLight>,
        object_lamps: impl Iterator<Item = Option<u32>>,
        sphere: (Vec3d, f64),
    ) -> Self {
        Self::with_portals(lamps, distant, object_lamps, sphere, None)
    }

    /// The same with portals through which the distant light comes in.
    pub fn with_portals(
        lamps: Vec<AreaLight>,
        distant: Vec<DistantLight>,
        object_lamps: impl Iterator<Item = Option<u32>>,
        sphere: (Vec3d, f64),
        portals: Option<Portals>,
    ) -> Self {
        let environment = (!distant.is_empty()).then(|| Environment::new(distant, sphere, portals));
        let powers: Vec<f64> = lamps.iter().map(AreaLight::weight).collect();
        // Lamps that are all black leave everything to the environment.
        let beside_lamps = if powers.iter().any(|&p| p > 0.0) { 0.5 } else { 1.0 };
        let lit = environment.as_ref().filter(|e| e.shines());
        let share = |has_part: bool| if has_part { beside_lamps } else { 0.0 };
        Self {
            by_power: AliasTable::new(&powers),
            for_receivers: LightTree::new(&lamps),
            share_of_emission: share(lit.is_some()),
            share_of_draws: share(lit.is_some_and(Environment::is_drawn)),
            of_object: object_lamps.map(|l| l.unwrap_or(NO_LAMP)).collect(),
            lamps,
            environment,
            distant_groups: vec![],
        }
    }

    /// How many lights there are.
    pub fn len(&self) -> usize {
        self.lamps.len() + self.environment.as_ref().map_or(0, |e| e.lights().len())
    }

    /// Whether there is no light.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Whether any light comes from them that can be seen.
    pub fn shine(&self) -> bool {
        self.lamps.iter().any(|lamp| lamp.flux() > 0.0)
            || self.environment.as_ref().is_some_and(Environment::shines)
    }

    /// What the light is made of: half of it the lamps', by their flux, and half the environment's.
    pub fn spectrum(&self) -> LightSpectrum {
        let mut spectrum = LightSpectrum::default();
        for i in strongest(&self.by_power) {
            let share = self.chance_of_sending(i).to_f64();
            spectrum.add(share, |lambda| self.lamps[i].radiance().eval(lambda));
        }
        if let Some(environment) = self.environment.as_ref().filter(|e| e.shines()) {
            environment.add_spectra(self.share_of_emission, &mut spectrum);
        }
        spectrum
    }

    /// The portals through which distant light comes in.
    pub fn portals(&self) -> Option<&Portals> {
        self.environment.as_ref()?.portals()
    }

    #[inline]
    fn lamp(&self, object: u32) -> Option<(usize, &AreaLight)> {
        let i = *self.of_object.get(object as usize)?;
        (i != NO_LAMP).then(|| (i as usize, &self.lamps[i as usize]))
    }

    /// Chooses between the lamps and the environment, which has some share; `None` where there is neither.
    #[inline]
    fn choose(&self, share: f64, u: [Real; 4]) -> Option<Chosen> {
        let u = refined(u[0], u[3]);
        if u < share {
            return Some(Chosen::Environment(u / share));
        }
        (!self.lamps.is_empty()).then(|| Chosen::Lamps((u - share) / (1.0 - share)))
    }

    /// Density over area (1/m²) with which [`sample`](Self::sample) draws a point of a lamp's triangle.
    #[inline]
    fn pdf_drawn(&self, lamp: usize, triangle: u32, bary: (Real, Real), to: &Receiver) -> Real {
        let probability = self.for_receivers.probability(lamp, triangle, to);
        self.lamps[lamp].pdf_point_of(triangle, bary, (1.0 - self.share_of_draws) * probability)
    }

    /// Probability that a light path begins on a lamp.
    #[inline]
    fn chance_of_sending(&self, lamp: usize) -> Real {
        (1.0 - self.share_of_emission) as Real * self.by_power.probability(lamp)
    }

    /// Density over area (1/m²) with which light leaves a point of a lamp's triangle.
    #[inline]
    fn pdf_sent(&self, lamp: usize, triangle: u32, bary: (Real, Real)) -> Real {
        self.chance_of_sending(lamp) * self.lamps[lamp].pdf_point(triangle, bary)
    }

    /// Draws light towards a receiver: `u` chooses a light, a point on it or a direction towards it (two
    /// numbers), and the choice's further digits ([`refined`]).
    #[inline]
    pub fn sample(&self, to: &Receiver, u: [Real; 4], lambda: &SampledWavelengths) -> Option<LightSample> {
        let at = [u[1], u[2]];
        let rest = match self.choose(self.share_of_draws, u)? {
            Chosen::Lamps(rest) => rest,
            Chosen::Environment(rest) => return self.sample_environment(to, rest, at, lambda),
        };
        let (drawn, probability) = self.for_receivers.sample(to, rest)?;
        let i = drawn.lamp as usize;
        let lamp = &self.lamps[i];
        let mut point = lamp.sample_point_of(drawn.triangle as usize, at);
        let front = point.n;
        let (wi, over_angle) = lamp.turn_towards(to.p, &mut point)?;
        let (triangle, bary) = (point.triangle, point.bary);
        let over_area = lamp.pdf_point_of(triangle, bary, (1.0 - self.share_of_draws) * probability);
        Some(LightSample {
            wi,
            radiance: lamp.emitted(triangle, bary, -wi, lambda),
            pdf: over_area * over_angle,
            pdf_emission: EmissionPdf {
                first: self.pdf_sent(i, triangle, bary),
                second: lamp.pdf_direction(triangle, front, -wi),
            },
            point: Some(point),
            sender: Sender::Lamp(drawn.lamp),
        })
    }

    #[inline]
    fn sample_environment(
        &self,
        to: &Receiver,
        choice: f64,
        at: [Real; 2],
        lambda: &SampledWavelengths,
    ) -> Option<LightSample> {
        let environment = self.environment.as_ref()?;
        let wi = environment.sample(to, choice, at)?;
        let pdf = self.pdf_environment(to, wi);
        (pdf > 0.0).then(|| LightSample {
            wi,
            point: None,
            radiance: environment.radiance(wi, lambda),
            pdf,
            pdf_emission: self.pdf_emission_environment(wi, to.p),
            sender: Sender::Environment(wi),
        })
    }

    /// Radiance that a point of an object emits in a unit direction, if it is a lamp that shines there.
    #[inline]
    pub fn emitted(
        &self,
        hit: &EmitterHit,
        wo: Vec3,
        lambda: &SampledWavelengths,
    ) -> Option<SampledSpectrum> {
        let (_, lamp) = self.lamp(hit.object)?;
        (wo.dot(hit.n) > 0.0 || lamp.is_two_sided()).then(|| lamp.emitted(hit.triangle, hit.bary, wo, lambda))
    }

    /// Density (1/sr) with which [`sample`](Self::sample) draws a point of an object for a receiver
    /// that it shows a side that shines.
    #[inline]
    pub fn pdf_object(&self, hit: &EmitterHit, to: &Receiver) -> Real {
        let Some((i, lamp)) = self.lamp(hit.object) else { return 0.0 };
        let way = to.p - hit.p;
        let distance2 = way.length2();
        let seen = way.dot(hit.n) / distance2.sqrt();
        let cos = if lamp.is_two_sided() { seen.abs() } else { seen };
        // Edge-on, or at the point itself, it is not drawn.
        if cos.is_nan() || cos <= 0.0 {
            return 0.0;
        }
        self.pdf_drawn(i, hit.triangle, hit.bary, to) * distance2 / cos
    }

    /// Densities with which [`sample_emission`](Self::sample_emission) draws light that leaves a point
    /// of an object in a unit direction; 0 where it is no lamp.
    #[inline]
    pub fn pdf_emission_object(&self, hit: &EmitterHit, wo: Vec3) -> EmissionPdf {
        let Some((i, lamp)) = self.lamp(hit.object) else { return EmissionPdf::NEVER };
        EmissionPdf {
            first: self.pdf_sent(i, hit.triangle, hit.bary),
            second: lamp.pdf_direction(hit.triangle, hit.n, wo),
        }
    }

    /// Radiance of the environment in a unit direction towards it, if there is one.
    #[inline]
    pub fn environment(&self, towards: Vec3, lambda: &SampledWavelengths) -> Option<SampledSpectrum> {
        Some(self.environment.as_ref()?.radiance(towards, lambda))
    }

    /// Density (1/sr) with which [`sample`](Self::sample) draws a direction of the environment.
    #[inline]
    pub fn pdf_environment(&self, to: &Receiver, wi: Vec3) -> Real {
        match &self.environment {
            Some(environment) if self.share_of_draws > 0.0 => {
                self.share_of_draws as Real * environment.pdf(to, wi)
            }
            _ => 0.0,
        }
    }

    /// Densities with which [`sample_emission`](Self::sample_emission) draws light from a direction of
    /// the environment through a point.
    #[inline]
    pub fn pdf_emission_environment(&self, towards: Vec3, through: Vec3) -> EmissionPdf {
        let Some(environment) = &self.environment else { return EmissionPdf::NEVER };
        let pdf = environment.pdf_emission(towards, through);
        EmissionPdf { first: self.share_of_emission as Real * pdf.first, ..pdf }
    }

    /// Density, in the measure of `pdf.first`, with which [`sample`](Self::sample) draws the point or
    /// direction of an emission for a receiver.
    #[inline]
    pub fn pdf_sample_of(&self, emission: &Emission, to: &Receiver) -> Real {
        let Some(point) = &emission.point else { return self.pdf_environment(to, -emission.direction) };
        self.pdf_drawn(emission.lamp as usize, point.triangle, point.bary, to)
    }
}
