//! All that is infinitely far away: several lights whose radiances add.

use crate::kinds::{Distant, DistantLight};
use crate::portals::Portals;
use crate::query::{EmissionPdf, Receiver};
use indigo_math::distribution::AliasTable;
use indigo_math::sobol::radical_inverse_2;
use indigo_math::warp::{INV_PI, concentric_disk};
use indigo_math::{Float, Frame, Real, Vec3, Vec3d};
use indigo_spectrum::{LightSpectrum, SampledSpectrum, SampledWavelengths};

/// Directions whose light tells the spectrum of a light.
const DIRECTIONS: u32 = 64;

/// The surroundings of a scene.
///
/// A direction is drawn by one of the lights; its density is the mixture of all of theirs. Light enters
/// the scene through a disc as wide as the scene, across its direction. Receivers draw the lights that are to
/// be drawn alone ([`Distant::is_drawn`]). Where there are portals light enters through them, receivers draw
/// all lights, and a part of the draws is left to the portals: that of each light which it states
/// ([`Distant::portal_share`]).
///
/// Portals change what is drawn, not what there is: light that comes by another way is found by scattering
/// alone, and counts in full.
#[derive(Clone, Debug)]
pub(crate) struct Environment {
    lights: Vec<DistantLight>,
    /// Which light enters the scene.
    entering: AliasTable,
    /// Which light is drawn for a receiver; empty where none is.
    drawn: AliasTable,
    /// A sphere round everything that the environment can light.
    center: Vec3,
    radius: Real,
    portals: Option<Portals>,
    /// Probability that a draw for a receiver is left to the portals.
    portal_chance: Real,
}

impl Environment {
    /// Lights round a scene that lies within a sphere of some centre and radius in metres, and its portals.
    pub fn new(
        lights: Vec<DistantLight>,
        (center, radius_m): (Vec3d, f64),
        portals: Option<Portals>,
    ) -> Self {
        let totals: Vec<f64> = lights.iter().map(Distant::total_luminance).collect();
        let sum: f64 = totals.iter().sum();
        // Half by how much light each gives, half evenly: where the strongest, the sun above all, is
        // hidden, the others are all there is.
        let weight = |total: &f64| if sum > 0.0 { total / sum } else { 0.0 } + 1.0 / totals.len() as f64;
        let weights: Vec<f64> = totals.iter().map(weight).collect();
        let drawn = |(light, weight): (&DistantLight, &f64)| match &portals {
            None if !light.is_drawn() => 0.0,
            _ => *weight,
        };
        let drawn: Vec<f64> = lights.iter().zip(&weights).map(drawn).collect();
        let mut environment = Self {
            entering: AliasTable::new(&weights),
            drawn: if drawn.iter().any(|&w| w > 0.0) {
                AliasTable::new(&drawn)
            } else {
                AliasTable::default()
            },
            lights,
            center: center.cast(),
            radius: radius_m as Real,
            portals,
            portal_chance: 0.0,
        };
        let shares =
            (0..environment.drawn.len()).map(|i| environment.drawn.probability(i) * environment.share(i));
        environment.portal_chance = shares.sum();
        environment
    }

    /// The lights.
    pub fn lights(&self) -> &[DistantLight] {
        &self.lights
    }

    /// The portals.
    pub fn portals(&self) -> Option<&Portals> {
        self.portals.as_ref()
    }

    /// Whether there is any light.
    pub fn shines(&self) -> bool {
        self.lights.iter().any(|light| light.total_luminance() > 0.0)
    }

    /// Whether receivers draw any of its lights.
    pub fn is_drawn(&self) -> bool {
        !self.drawn.is_empty()
    }

    /// Radiance from a direction.
    #[inline]
    pub fn radiance(&self, towards: Vec3, lambda: &SampledWavelengths) -> SampledSpectrum {
        self.lights.iter().fold(SampledSpectrum::ZERO, |sum, light| sum + light.radiance(towards, lambda))
    }

    /// Adds the lights' spectra, each a mean over directions, with a share of all light for them together.
    pub fn add_spectra(&self, share: f64, spectrum: &mut LightSpectrum) {
        let sum: f64 = self.lights.iter().map(Distant::total_luminance).sum();
        for light in &self.lights {
            let directions: Vec<(Vec3, Real)> = (0..DIRECTIONS)
                .filter_map(|i| {
                    let at = [(i as Real + 0.5) / DIRECTIONS as Real, radical_inverse_2(i) as Real];
                    let towards = light.sample(Vec3::ZERO, at)?;
                    let pdf = light.pdf(Vec3::ZERO, towards);
                    (pdf > 0.0).then_some((towards, pdf))
                })
                .collect();
            spectrum.add(share * light.total_luminance() / sum, |lambda| {
                directions
                    .iter()
                    .fold(SampledSpectrum::ZERO, |sum, &(d, pdf)| sum + light.radiance(d, lambda) / pdf)
            });
        }
    }

    /// The part of a light's draws that is left to the portals.
    #[inline]
    fn share(&self, light: usize) -> Real {
        if self.portals.is_some() { self.lights[light].portal_share() } else { 0.0 }
    }

    /// A direction of light for a receiver, where there is light that is drawn.
    #[inline]
    pub fn sample(&self, to: &Receiver, choice: f64, at: [Real; 2]) -> Option<Vec3> {
        let (i, _, rest) = self.drawn.sample(choice);
        let share = self.share(i).to_f64();
        match &self.portals {
            Some(portals) if rest < share => portals.sample_direction(to.p, rest / share, at),
            _ => self.lights[i].sample(to.n, at),
        }
    }

    /// Density (1/sr) of [`sample`](Self::sample).
    #[inline]
    pub fn pdf(&self, to: &Receiver, towards: Vec3) -> Real {
        let own = |i: usize| {
            let part = self.drawn.probability(i) * (1.0 - self.share(i));
            if part > 0.0 { part * self.lights[i].pdf(to.n, towards) } else { 0.0 }
        };
        let through = self.portals.as_ref().map_or(0.0, |portals| {
            if self.portal_chance > 0.0 {
                self.portal_chance * portals.pdf_direction(to.p, towards)
            } else {
                0.0
            }
        });
        (0..self.drawn.len()).map(own).sum::<Real>() + through
    }

    /// A direction towards light that enters the scene, and a fresh number in [0, 1).
    #[inline]
    pub fn sample_source(&self, choice: f64, at: [Real; 2]) -> Option<(Vec3, f64)> {
        let (i, _, rest) = self.entering.sample(choice);
        Some((self.lights[i].sample(Vec3::ZERO, at)?, rest))
    }

    /// A point on the way of light from a direction: beyond the scene, or before a portal and so near it that
    /// rounding does not make the way miss it. Things may stand before that.
    #[inline]
    pub fn sample_entry(&self, towards: Vec3, choice: f64, v: [Real; 2]) -> Option<Vec3> {
        let Some(portals) = &self.portals else {
            let disk = concentric_disk(v.into()) * self.radius;
            let place = Frame::from_normal(towards).to_world(Vec3::new(disk.x, disk.y, self.radius));
            return Some(self.center + place);
        };
        let portal = portals.sample_point(choice, v);
        // What comes from the interior does not enter.
        if towards.dot(portal.n) >= 0.0 {
            return None;
        }
        // By the magnitude of the numbers that the point was made of: surfaces in the portal's plane are met for
        // sure, and rounding is what it was.
        Some(portal.p + towards * portal.magnitude)
    }

    /// Densities of [`sample_source`](Self::sample_source) and [`sample_entry`](Self::sample_entry) for light from a
    /// direction through a point.
    #[inline]
    pub fn pdf_emission(&self, towards: Vec3, through: Vec3) -> EmissionPdf {
        EmissionPdf { first: self.pdf_source(towards), second: self.pdf_entry(towards, through) }
    }

    /// Density (1/m²), across a direction, with which light from there enters along the line through a point.
    #[inline]
    pub fn pdf_entry(&self, towards: Vec3, through: Vec3) -> Real {
        match &self.portals {
            None => INV_PI / (self.radius * self.radius),
            Some(portals) => portals.pdf_line(through, towards),
        }
    }

    /// Density (1/sr) of [`sample_source`](Self::sample_source).
    #[inline]
    pub fn pdf_source(&self, towards: Vec3) -> Real {
        let part = |(i, light): (usize, &DistantLight)| {
            self.entering.probability(i) * light.pdf(Vec3::ZERO, towards)
        };
        self.lights.iter().enumerate().map(part).sum()
    }
}
