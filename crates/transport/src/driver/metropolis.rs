//! Metropolis sampling in primary sample space (Kelemen et al. 2002).
//!
//! A number of Markov chains run side by side. A unit of work is a run of mutations of one chain; it
//! depends on the seed and on the chain's units before it, so any number of threads makes the same
//! picture. Each chain starts from one of its own independent seeds, drawn in proportion to their
//! targets (Veach 1997, section 11.3.1).
//!
//! Proposal and state are both splatted, with their chances to be the next state (Kelemen et al. 2002,
//! equation 12). The film's layer holds f / target; seeds and large mutations are independent samples
//! whose targets estimate the brightness constant b, which the layer keeps beside its sums and applies
//! when it is developed. A picture of few mutations is unbiased only in the limit of many seeds, as b is a
//! mean over all of them and the start is drawn from some: that error falls with the number of
//! chains times seeds.

use super::chain::{ChainSample, Mutation};
use super::region::Region;
use crate::sampler::{Block, PrimarySample};
use crate::technique::{Events, Tracer};
use indigo_film::{FilmDelta, FilmFilter};
use indigo_math::{Vec2, rng};
use indigo_scene::{MetropolisSettings, Scene};
use std::sync::{Mutex, PoisonError};

/// Chains; more than any machine has threads, so that they need not wait for each other.
pub(super) const CHAINS: u64 = 128;
/// Independent samples from which a chain's start is drawn.
const SEEDS: u64 = 1024;
/// Mutations of a unit.
pub(super) const MUTATIONS: u64 = 2048;

/// Metropolis sampling.
#[derive(Debug)]
pub struct Metropolis {
    /// The part of the film that chains wander over: what is rendered, and round it what the filter spreads into it.
    region: Region,
    filter: FilmFilter,
    seed: u64,
    /// The first unit of this start of the chains.
    first: u64,
    events: Events,
    settings: MetropolisSettings,
    /// The film's layers for direct and for indirect light, which may be the same.
    layers: [usize; 2],
    chains: Vec<Mutex<Chain>>,
}

/// A chain between units.
#[derive(Clone, Debug, Default)]
struct Chain {
    /// Units done.
    units: u64,
    sample: ChainSample,
    current: State,
    proposal: State,
    rejections: i64,
    /// Whether there is a state to mutate: not so where no seed found any light.
    is_started: bool,
}

/// What a primary sample puts on the film.
#[derive(Clone, Debug, Default)]
struct State {
    /// Position in internal pixels, colour in cd/m², and whether the light is indirect.
    splats: Vec<(Vec2, [f32; 3], bool)>,
    /// What the chain goes by: the sum of (X + Y + Z) / 3, which no colour can leave at 0.
    target: f64,
    /// How much it has counted so far.
    weight: f64,
}

impl Metropolis {
    /// For a scene, the seed of all its randomness and the first unit, the paths to render and the film's layers
    /// for them.
    pub(super) fn new(
        scene: &Scene,
        [seed, first]: [u64; 2],
        events: Events,
        settings: MetropolisSettings,
        layers: [usize; 2],
    ) -> Self {
        Self {
            region: Region::of(scene).grown(scene),
            filter: scene.film.filter.clone(),
            seed,
            first,
            events,
            settings,
            layers,
            chains: (0..CHAINS).map(|_| Mutex::default()).collect(),
        }
    }

    /// Which half a unit belongs to: that of its chain.
    pub(super) fn half_of(&self, unit: u64) -> usize {
        ((unit - self.first) % CHAINS % 2) as usize
    }

    /// Does a unit: adds its splats to `delta`, and says how many mutations they were.
    pub(super) fn render_unit(
        &self,
        scene: &Scene,
        unit: u64,
        tracer: &mut Tracer,
        delta: &mut FilmDelta,
    ) -> u64 {
        let begun = unit - self.first;
        let (number, turn) = (begun % CHAINS, begun / CHAINS);
        let key = rng::key(&[self.seed, number, self.first]);
        let mut run = Run { driver: self, scene, tracer, delta, key };
        loop {
            let mut chain = self.chains[number as usize].lock().unwrap_or_else(PoisonError::into_inner);
            if chain.units < turn {
                // Another thread has been slow with this chain's unit before.
                drop(chain);
                std::thread::yield_now();
                continue;
            }
            if turn == 0 {
                run.start(&mut chain);
            }
            let first = SEEDS + turn * MUTATIONS;
            for step in first..first + MUTATIONS {
                run.mutate(&mut chain, step);
                // Counted one by one, so that what a unit that fails leaves behind is counted rightly.
                run.count(1);
            }
            run.settle(&mut chain.current);
            chain.units += 1;
            return MUTATIONS;
        }
    }
}

/// A unit at work.
struct Run<'a> {
    driver: &'a Metropolis,
    scene: &'a Scene,
    tracer: &'a mut Tracer,
    delta: &'a mut FilmDelta,
    key: u64,
}

impl Run<'_> {
    fn mutation(&self) -> Mutation {
        Mutation { max_change: self.driver.settings.max_change, key: self.key }
    }

    /// The layers, each once.
    fn each_layer(&mut self, act: impl Fn(&mut FilmDelta, usize)) {
        let [direct, indirect] = self.driver.layers;
        act(self.delta, direct);
        if indirect != direct {
            act(self.delta, indirect);
        }
    }

    /// Counts mutations.
    fn count(&mut self, n: u64) {
        self.each_layer(|delta, layer| delta.add_samples(layer, n));
    }

    /// Estimates of the brightness constant, which is that of all light.
    fn add_brightness(&mut self, sum: f64, count: u64) {
        self.each_layer(|delta, layer| delta.add_brightness(layer, sum, count));
    }

    /// Traces a proposal.
    fn trace(&mut self, chain: &mut Chain, step: u64, is_large: bool) {
        let mut numbers = chain.sample.propose(self.mutation(), step, is_large);
        let [u0, u1, ..] = numbers.block(Block::FILM);
        let region = &self.driver.region;
        let position = region.position([u0, u1]);
        let found = self.tracer.trace(self.scene, &mut numbers, position, self.driver.events, &mut ());
        let state = &mut chain.proposal;
        state.splats.clear();
        (state.target, state.weight) = (0.0, 0.0);
        // Film positions are uniform over the region, not over the film.
        let film = region.in_pixels(position);
        let mut add =
            |light, is_indirect| state.add(film, found.sensor.xyz(&(light * region.share())), is_indirect);
        if self.driver.layers[0] == self.driver.layers[1] {
            add(found.path.radiance(), false);
        } else {
            add(found.path.direct, false);
            add(found.path.indirect, true);
        }
        for splat in self.tracer.splats().iter().filter(|splat| region.holds(splat.position)) {
            let xyz = found.sensor.xyz(&splat.radiance);
            state.add(region.in_pixels(splat.position), xyz, splat.is_indirect);
        }
    }

    /// Draws the chain's start among independent seeds.
    fn start(&mut self, chain: &mut Chain) {
        let mut sum = 0.0;
        for step in 0..SEEDS {
            self.trace(chain, step, true);
            let target = chain.proposal.target;
            sum += target;
            // Each seed takes the place of those before it with its share of their sum.
            let u = rng::Rng::new(rng::key(&[self.key, step, 1])).next_f64();
            if target > 0.0 && u * sum < target {
                chain.accept();
                chain.is_started = true;
            }
        }
        self.add_brightness(sum, SEEDS);
    }

    fn mutate(&mut self, chain: &mut Chain, step: u64) {
        let settings = &self.driver.settings;
        let mut rng = rng::Rng::new(rng::key(&[self.key, step, 2]));
        let is_large = !chain.is_started || rng.next_f64() < settings.large_mutation_prob;
        self.trace(chain, step, is_large);
        let (proposed, current) = (chain.proposal.target, chain.current.target);
        if is_large {
            self.add_brightness(proposed, 1);
        }
        let chance = if chain.is_started {
            (proposed / current).min(1.0)
        } else {
            f64::from(u8::from(proposed > 0.0))
        };
        chain.proposal.weight = chance;
        chain.current.weight += 1.0 - chance;
        let is_stuck = chain.rejections >= settings.max_consecutive_rejections && proposed > 0.0;
        if rng.next_f64() < chance || is_stuck {
            self.settle(&mut chain.current);
            chain.accept();
            chain.is_started = true;
            chain.rejections = 0;
        } else {
            chain.rejections += 1;
            self.settle(&mut chain.proposal);
        }
    }

    /// Puts a state on the film with the weight that it has gathered.
    fn settle(&mut self, state: &mut State) {
        let weight = state.weight / state.target;
        state.weight = 0.0;
        if !(weight > 0.0 && weight.is_finite()) {
            return;
        }
        for &(position, xyz, is_indirect) in &state.splats {
            let xyz = xyz.map(|c| (f64::from(c) * weight) as f32);
            let layer = self.driver.layers[usize::from(is_indirect)];
            self.delta.splat(layer, position, xyz, &self.driver.filter);
        }
    }
}

impl Chain {
    /// The proposal becomes the state.
    fn accept(&mut self) {
        std::mem::swap(&mut self.current, &mut self.proposal);
        self.sample.accept();
    }
}

impl State {
    fn add(&mut self, position: Vec2, xyz: [f32; 3], is_indirect: bool) {
        let sum: f64 = xyz.iter().map(|c| f64::from(*c)).sum();
        if sum.is_finite() && sum > 0.0 {
            self.target += sum / 3.0;
            self.splats.push((position, xyz, is_indirect));
        }
    }
}
