//! Drivers: which samples to take, in units of work that any thread can do and any run can replay.

mod chain;
mod independent;
mod metropolis;
mod region;
mod seeds;
mod shares;

use crate::technique::{DIRECT, Events, Part, PathSample, Record, Tracer};
use independent::Independent;
use indigo_film::{FilmDelta, LayerKind, LightMix, mix};
use indigo_scene::Scene;
use indigo_spectrum::SampledSpectrum;
use metropolis::{CHAINS, MUTATIONS, Metropolis};
use region::Region;

/// The driver of a scene.
#[derive(Debug)]
pub struct Driver {
    parts: Parts,
    layers: Vec<(LayerKind, String)>,
    pixels: u64,
    rendered: indigo_math::Real,
    is_bidirectional: bool,
}

#[derive(Debug)]
enum Parts {
    Independent(Box<Independent>),
    Metropolis(Box<Metropolis>),
    /// Direct light by the one and the rest by the other, in turns.
    Hybrid(Box<Independent>, Box<Metropolis>),
}

/// The film's layer of camera samples.
const CAMERA: &str = "camera";
/// The film's layer of light paths that met the lens.
const LIGHT: &str = "light";
/// The film's layer of mutations.
const METROPOLIS: &str = "metropolis";

/// The same of light that is scattered more than once, where a film keeps it apart.
const CAMERA_INDIRECT: &str = "camera indirect";
const LIGHT_INDIRECT: &str = "light indirect";
const METROPOLIS_INDIRECT: &str = "metropolis indirect";

/// The same of light that comes straight from the surroundings, where nothing stands before them.
const CAMERA_BACKGROUND: &str = "camera background";
const LIGHT_BACKGROUND: &str = "light background";
const METROPOLIS_BACKGROUND: &str = "metropolis background";

/// Whether a layer of a film holds light that is scattered more than once alone.
pub fn is_indirect(layer: &str) -> bool {
    [CAMERA_INDIRECT, LIGHT_INDIRECT, METROPOLIS_INDIRECT].contains(&mix::split(layer).0)
}

/// Whether a layer of a film holds light of the surroundings alone that nothing has scattered or hidden.
pub fn is_background(layer: &str) -> bool {
    [CAMERA_BACKGROUND, LIGHT_BACKGROUND, METROPOLIS_BACKGROUND].contains(&mix::split(layer).0)
}

/// The film's layers for the parts of light, some of which may be the same: for camera samples and mutations. Splats of
/// light paths go to the layer behind. Those of each group of lights come after those of the one before.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Layers {
    direct: usize,
    indirect: usize,
    background: usize,
    /// How many groups there are, and how many layers each has.
    groups: usize,
    per_group: usize,
}

impl Layers {
    /// All light in one layer.
    fn all_in(layer: usize) -> Self {
        Self { direct: layer, indirect: layer, background: layer, groups: 1, per_group: 0 }
    }

    /// That of a part of the first group's light.
    fn of(self, part: Part) -> usize {
        match part {
            Part::Background => self.background,
            Part::Direct => self.direct,
            Part::Indirect => self.indirect,
        }
    }

    /// That of a part of a group's light.
    fn of_group(self, part: Part, group: u16) -> usize {
        self.of(part) + usize::from(group) * self.per_group
    }

    /// A camera ray's light by the layers that differ, each once, that of direct light first.
    fn shares(self, path: &PathSample) -> impl Iterator<Item = (usize, SampledSpectrum)> {
        let Self { direct, indirect, background, .. } = self;
        let mut rest = path.direct;
        let mut apart = |layer, light| {
            if layer == direct {
                rest += light;
                return None;
            }
            Some((layer, light))
        };
        let others = [apart(background, path.background), apart(indirect, path.indirect)];
        std::iter::once((direct, rest)).chain(others.into_iter().flatten())
    }

    /// Whether the light of some lights is kept apart from that of others.
    fn are_grouped(self) -> bool {
        self.groups > 1
    }

    /// Those that differ, each once.
    fn each(self) -> impl Iterator<Item = usize> {
        let Self { direct, indirect, background, groups, per_group } = self;
        let others =
            [(indirect, indirect != direct), (background, ![direct, indirect].contains(&background))];
        let others = others.into_iter().filter(|(_, differs)| *differs).map(|(layer, _)| layer);
        let first = std::iter::once(direct).chain(others);
        first.flat_map(move |layer| (0..groups).map(move |group| layer + group * per_group))
    }
}

/// The layers of a film, as they are asked for.
struct Plan<'a> {
    layers: Vec<(LayerKind, String)>,
    mix: &'a LightMix,
}

impl Plan<'_> {
    /// Adds layers of these kinds and parts of the light, once for each group of lights.
    fn add(&mut self, parts: &[(LayerKind, &str)]) {
        if self.mix.0.is_empty() {
            self.layers.extend(parts.iter().map(|&(kind, part)| (kind, part.to_owned())));
        }
        for group in &self.mix.0 {
            let names = parts.iter().map(|&(kind, part)| (kind, mix::layer_of_group(part, &group.name)));
            self.layers.extend(names);
        }
    }

    /// Layers whose first group begins at those of `layers`.
    fn grouped(&self, layers: Layers, parts: usize) -> Layers {
        Layers { groups: self.mix.0.len().max(1), per_group: parts, ..layers }
    }
}

impl Driver {
    /// What the scene's settings ask for, with the seed of all randomness.
    pub fn new(scene: &Scene, seed: u64) -> Self {
        Self::going_on(scene, seed, 0)
    }

    /// A driver whose units begin at `first`, for a film that holds those before it. Independent samples go
    /// on with their sequence, as if they had never paused. Markov chains start afresh, with randomness
    /// that no chain of an earlier start has used.
    pub fn going_on(scene: &Scene, seed: u64, first: u64) -> Self {
        let transport = &scene.transport;
        let most = transport.max_depth;
        let is_apart = scene.output.layers_exr;
        // Of what is direct anyhow nothing is kept apart.
        let is_split = is_apart && most > DIRECT;
        let mut plan = Plan { layers: vec![], mix: &scene.picture.lights };
        let parts = match transport.metropolis {
            Some(settings) if !transport.hybrid => {
                let layers = mutations(&mut plan, is_split, is_apart);
                let driver = Metropolis::new(scene, [seed, first], Events::up_to(most), settings, layers);
                Parts::Metropolis(Box::new(driver))
            }
            _ => {
                // Of a hybrid indirect light is the other driver's.
                let own =
                    samples(&mut plan, is_split && !transport.hybrid, is_apart, transport.bidirectional);
                let independent = |events| Box::new(Independent::new(scene, seed, events, own));
                match transport.metropolis {
                    Some(settings) if most > DIRECT => {
                        let rest = Events { least: DIRECT + 1, most };
                        let layer = plan.grouped(Layers::all_in(plan.layers.len()), 1);
                        plan.add(&[(LayerKind::PerScreen, METROPOLIS_INDIRECT)]);
                        let indirect = Metropolis::new(scene, [seed, first / 2], rest, settings, layer);
                        Parts::Hybrid(independent(Events::up_to(DIRECT)), Box::new(indirect))
                    }
                    _ => Parts::Independent(independent(Events::up_to(most))),
                }
            }
        };
        let layers = plan.layers;
        let region = Region::of(scene);
        let drawn = if matches!(parts, Parts::Metropolis(_)) { region.grown(scene) } else { region };
        Self {
            parts,
            layers,
            pixels: region.size.pixels() as u64,
            rendered: drawn.share(),
            is_bidirectional: transport.bidirectional,
        }
    }

    /// The same with its units in two halves whose samples are independent of each other, so that their
    /// difference tells how far the picture may be off. Independent samples form a low-discrepancy sequence
    /// in each half then, not across them.
    pub fn in_halves(mut self) -> Self {
        match &mut self.parts {
            Parts::Independent(driver) => driver.is_halved = true,
            Parts::Metropolis(driver) => driver.halve(),
            Parts::Hybrid(direct, indirect) => {
                direct.is_halved = true;
                indirect.halve();
            }
        }
        self
    }

    /// Which half a unit belongs to, 0 or 1.
    pub fn half_of(&self, unit: u64) -> usize {
        match &self.parts {
            Parts::Independent(driver) => driver.half_of(unit),
            Parts::Metropolis(driver) => driver.half_of(unit),
            Parts::Hybrid(direct, _) if unit.is_multiple_of(2) => direct.half_of(unit / 2),
            Parts::Hybrid(_, indirect) => indirect.half_of(unit / 2),
        }
    }

    /// The layers of the film that it fills.
    pub fn layers(&self) -> &[(LayerKind, String)] {
        &self.layers
    }

    /// Output pixels of the whole picture, by which samples per pixel are counted.
    pub fn pixels(&self) -> u64 {
        self.pixels
    }

    /// How many threads can be at work at once; more would wait for each other.
    pub fn most_workers(&self) -> usize {
        match &self.parts {
            Parts::Independent(_) => usize::MAX,
            Parts::Metropolis(_) => CHAINS as usize,
            // Every other unit is a chain's.
            Parts::Hybrid(..) => 2 * CHAINS as usize,
        }
    }

    /// The technique with its memory, one for each thread.
    pub fn tracer(&self) -> Tracer {
        Tracer::new(self.is_bidirectional, self.rendered)
    }

    /// The least number of units with so many samples per pixel of the whole picture, or more.
    pub fn units(&self, samples_per_pixel: u64) -> u64 {
        self.units_of(u128::from(self.pixels) * u128::from(samples_per_pixel), 0)
    }

    /// The least number of units from `first` on with so many samples, or more.
    ///
    /// Independent samples come in whole passes over what is rendered, and a pass over a whole picture is one
    /// sample per pixel exactly; mutations come in units of `MUTATIONS`.
    pub fn units_of(&self, samples: u128, first: u64) -> u64 {
        let units = match &self.parts {
            Parts::Independent(driver) => {
                samples.div_ceil(u128::from(driver.pixels())) * u128::from(driver.units_per_pass())
            }
            Parts::Metropolis(_) => samples.div_ceil(u128::from(MUTATIONS)),
            Parts::Hybrid(direct, _) => {
                // As many units as a pass and its mutations have are such a round, wherever they begin.
                let round = 2 * direct.units_per_pass();
                let samples_of_round = direct.pixels() + direct.units_per_pass() * MUTATIONS;
                let rounds = samples / u128::from(samples_of_round);
                let mut left = samples % u128::from(samples_of_round);
                let mut more = 0;
                while left > 0 {
                    let unit = first.saturating_add(more);
                    let taken = if unit.is_multiple_of(2) { direct.samples_of(unit / 2) } else { MUTATIONS };
                    left = left.saturating_sub(u128::from(taken));
                    more += 1;
                }
                rounds * u128::from(round) + u128::from(more)
            }
        };
        u64::try_from(units).unwrap_or(u64::MAX)
    }

    /// Ends units that wait for other threads, as nothing more is wanted: those return without samples, and so do all
    /// later ones of chains.
    pub fn cancel(&self) {
        match &self.parts {
            Parts::Independent(_) => {}
            Parts::Metropolis(driver) | Parts::Hybrid(_, driver) => driver.cancel(),
        }
    }

    /// Does a unit: adds its samples to `delta`, a film of [`layers`](Self::layers), and says how many
    /// they were.
    pub fn render_unit(&self, scene: &Scene, unit: u64, tracer: &mut Tracer, delta: &mut FilmDelta) -> u64 {
        self.render_unit_recorded(scene, unit, tracer, delta, &mut ())
    }

    /// The same under somebody's eyes, who sees the unit's samples one after another.
    pub fn render_unit_recorded(
        &self,
        scene: &Scene,
        unit: u64,
        tracer: &mut Tracer,
        delta: &mut FilmDelta,
        record: &mut impl Record,
    ) -> u64 {
        match &self.parts {
            Parts::Independent(driver) => driver.render_unit(scene, unit, tracer, delta, record),
            Parts::Metropolis(driver) => driver.render_unit(scene, unit, tracer, delta, record),
            Parts::Hybrid(direct, indirect) => {
                if unit.is_multiple_of(2) {
                    direct.render_unit(scene, unit / 2, tracer, delta, record)
                } else {
                    indirect.render_unit(scene, unit / 2, tracer, delta, record)
                }
            }
        }
    }

    /// Whether a unit is part of a Markov chain, and not of independent samples.
    pub fn is_chain(&self, unit: u64) -> bool {
        match &self.parts {
            Parts::Independent(_) => false,
            Parts::Metropolis(_) => true,
            Parts::Hybrid(..) => !unit.is_multiple_of(2),
        }
    }

    /// The units on which the samples of one depend, in the order in which they are to be done: those of its chain, if
    /// it is one's.
    pub fn units_before(&self, unit: u64) -> impl Iterator<Item = u64> {
        let (first, step) = match &self.parts {
            Parts::Metropolis(driver) => (driver.first_of_chain(unit), CHAINS),
            Parts::Hybrid(_, driver) if !unit.is_multiple_of(2) => {
                (2 * driver.first_of_chain(unit / 2) + 1, 2 * CHAINS)
            }
            _ => (unit, 1),
        };
        (first..unit).step_by(step as usize)
    }
}

/// Plans the layers of Metropolis sampling.
fn mutations(plan: &mut Plan, is_split: bool, is_apart: bool) -> Layers {
    let mut layers = Layers::all_in(plan.layers.len());
    let mut parts = vec![(LayerKind::PerScreen, METROPOLIS)];
    if is_split {
        layers.indirect = layers.direct + parts.len();
        parts.push((LayerKind::PerScreen, METROPOLIS_INDIRECT));
    }
    if is_apart {
        layers.background = layers.direct + parts.len();
        parts.push((LayerKind::PerScreen, METROPOLIS_BACKGROUND));
    }
    plan.add(&parts);
    plan.grouped(layers, parts.len())
}

/// Plans the layers of independent samples, whose light paths, if there are any, have one behind each.
fn samples(plan: &mut Plan, is_split: bool, is_apart: bool, has_light_paths: bool) -> Layers {
    let mut layers = Layers::all_in(plan.layers.len());
    let mut parts = vec![];
    let add = |parts: &mut Vec<_>, [camera, light]: [&'static str; 2]| {
        parts.push((LayerKind::PerPixel, camera));
        parts.extend(has_light_paths.then_some((LayerKind::PerScreen, light)));
    };
    add(&mut parts, [CAMERA, LIGHT]);
    if is_split {
        layers.indirect = layers.direct + parts.len();
        add(&mut parts, [CAMERA_INDIRECT, LIGHT_INDIRECT]);
    }
    if is_apart {
        layers.background = layers.direct + parts.len();
        add(&mut parts, [CAMERA_BACKGROUND, LIGHT_BACKGROUND]);
    }
    plan.add(&parts);
    plan.grouped(layers, parts.len())
}
