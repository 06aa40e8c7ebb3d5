//! Metropolis sampling in primary sample space (Kelemen et al. 2002).
//!
//! A number of Markov chains run side by side. A unit of work is a run of mutations of one chain; it
//! depends on the seed, on the [seeds](super::seeds) of all chains and on the chain's units before it, so any number of
//! threads makes the same picture.
//!
//! Proposal and state are both splatted, with their chances to be the next state (Kelemen et al. 2002,
//! equation 12). The film's layer holds f / target; seeds and large mutations are independent samples
//! whose targets estimate the brightness constant b, which the layer keeps beside its sums and applies
//! when it is developed. A picture of few mutations is unbiased only in the limit of many seeds, as b is a
//! mean over all of them and the starts are drawn among them.
//!
//! Where no seed found any light a chain looks on, by large mutations alone, and counts from the first that finds
//! some: what it has looked at before counts in b, and would count twice as mutations that show nothing.

use super::Layers;
use super::chain::{ChainSample, Mutation};
use super::region::Region;
use super::seeds::{self, Seeds};
use super::shares::{Share, Shares};
use crate::sampler::{Block, PrimarySample};
use crate::technique::{Events, Record, Tracer};
use indigo_film::{FilmDelta, FilmFilter};
use indigo_math::sobol::radical_inverse_2;
use indigo_math::{Vec2, rng};
use indigo_scene::{MetropolisSettings, Scene};
use std::sync::{Mutex, PoisonError};

/// Chains; more than any machine has threads, so that they need not wait for each other.
pub(super) const CHAINS: u64 = 128;
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
    /// The film's layers.
    layers: Layers,
    seeds: Seeds,
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

/// Splats that a state has room for from the beginning: those of nearly all light paths, so that lists hardly ever grow.
const ROOM: usize = 256;

/// What a primary sample puts on the film.
#[derive(Clone, Debug)]
struct State {
    /// Position in internal pixels, colour in cd/m², and the film's layer.
    splats: Vec<(Vec2, [f32; 3], usize)>,
    /// What the chain goes by: the sum of (X + Y + Z) / 3, which no colour can leave at 0.
    target: f64,
    /// How much it has counted so far.
    weight: f64,
    /// What was no colour.
    refused: u64,
}

impl Default for State {
    fn default() -> Self {
        Self { splats: Vec::with_capacity(ROOM), target: 0.0, weight: 0.0, refused: 0 }
    }
}

impl Metropolis {
    /// For a scene, the seed of all its randomness and the first unit, the paths to render and the film's layers
    /// for them.
    pub(super) fn new(
        scene: &Scene,
        [seed, first]: [u64; 2],
        events: Events,
        settings: MetropolisSettings,
        layers: Layers,
    ) -> Self {
        let region = Region::of(scene);
        Self {
            seeds: Seeds::new(CHAINS, region.pixels()),
            region: region.grown(scene),
            filter: scene.film.filter.clone(),
            seed,
            first,
            events,
            settings,
            layers,
            chains: (0..CHAINS).map(|_| Mutex::default()).collect(),
        }
    }

    /// Makes the two halves independent of each other.
    pub(super) fn halve(&mut self) {
        self.seeds.pools = 2;
    }

    /// Which half a unit belongs to: that of its chain.
    pub(super) fn half_of(&self, unit: u64) -> usize {
        ((unit - self.first) % CHAINS % 2) as usize
    }

    /// The first unit of the chain that one belongs to.
    pub(super) fn first_of_chain(&self, unit: u64) -> u64 {
        self.first + (unit - self.first) % CHAINS
    }

    /// Does a unit: adds its splats to `delta`, and says how many mutations they were.
    pub(super) fn render_unit(
        &self,
        scene: &Scene,
        unit: u64,
        tracer: &mut Tracer,
        delta: &mut FilmDelta,
        record: &mut impl Record,
    ) -> u64 {
        let begun = unit - self.first;
        let (number, turn) = (begun % CHAINS, begun / CHAINS);
        let mut run = Run { driver: self, scene, tracer, delta, found: vec![], key: self.key(number) };
        if turn == 0 && !run.find_seeds() {
            return 0;
        }
        while !self.seeds.is_cancelled() {
            let mut chain = self.chains[number as usize].lock().unwrap_or_else(PoisonError::into_inner);
            if chain.units < turn {
                // Another thread has been slow with this chain's unit before.
                drop(chain);
                std::thread::yield_now();
                continue;
            }
            if turn == 0 {
                run.start(&mut chain, number);
            }
            // Numbers that no seed has had.
            let first = self.seeds.per_block + turn * MUTATIONS;
            for step in first..first + MUTATIONS {
                run.mutate(&mut chain, step, record);
                // Counted one by one, so that what a unit that fails leaves behind is counted rightly.
                run.count(chain.is_started);
            }
            run.settle(&mut chain.current);
            chain.units += 1;
            return MUTATIONS;
        }
        0
    }

    /// Ends units that wait, at the start or for another thread: nothing more is wanted of the driver.
    pub(super) fn cancel(&self) {
        self.seeds.cancel();
    }

    /// Names all randomness of a chain, and of the seeds of the same number.
    fn key(&self, number: u64) -> u64 {
        rng::key(&[self.seed, number, self.first])
    }
}

/// A unit at work.
struct Run<'a> {
    driver: &'a Metropolis,
    scene: &'a Scene,
    tracer: &'a mut Tracer,
    delta: &'a mut FilmDelta,
    /// Room for what a sample finds, where groups of lights are kept apart.
    found: Vec<Share>,
    key: u64,
}

impl Run<'_> {
    /// The layers, each once.
    fn each_layer(&mut self, act: impl Fn(&mut FilmDelta, usize)) {
        self.driver.layers.each().for_each(|layer| act(self.delta, layer));
    }

    /// Counts a mutation, of a chain with a state or of one that has found no light yet.
    fn count(&mut self, is_started: bool) {
        self.each_layer(
            |delta, layer| if is_started { delta.add_samples(layer, 1) } else { delta.add_idle(layer, 1) },
        );
    }

    /// Estimates of the brightness constant, which is that of all light.
    fn add_brightness(&mut self, sum: f64, count: u64) {
        self.each_layer(|delta, layer| delta.add_brightness(layer, sum, count));
    }

    /// Traces a proposal with the randomness that a key and a step name, and says how many contributions were refused
    /// since they are no colours.
    fn trace(
        &mut self,
        chain: &mut Chain,
        [key, step]: [u64; 2],
        is_large: bool,
        record: &mut impl Record,
    ) -> u64 {
        let mutation = Mutation { max_change: self.driver.settings.max_change, key };
        let mut numbers = chain.sample.propose(mutation, step, is_large);
        let [u0, u1, ..] = numbers.block(Block::FILM);
        let driver = self.driver;
        let (region, layers) = (&driver.region, driver.layers);
        let position = region.position([u0, u1]);
        let state = &mut chain.proposal;
        state.splats.clear();
        (state.target, state.weight, state.refused) = (0.0, 0.0, 0);
        // Film positions are uniform over the region, not over the film.
        let film = region.in_pixels(position);
        if layers.are_grouped() {
            let mut shares = Shares::new(&self.scene.lights, record, &mut self.found);
            let found = self.tracer.trace(self.scene, &mut numbers, position, driver.events, &mut shares);
            for share in shares.found() {
                let layer = layers.of_group(share.part, share.group);
                match share.at {
                    None => state.add(film, found.sensor.xyz(&(share.radiance * region.share())), layer),
                    Some(at) if region.holds(at) => {
                        state.add(region.in_pixels(at), found.sensor.xyz(&share.radiance), layer);
                    }
                    Some(_) => {}
                }
            }
            return state.refused;
        }
        let found = self.tracer.trace(self.scene, &mut numbers, position, driver.events, record);
        for (layer, light) in layers.shares(&found.path) {
            state.add(film, found.sensor.xyz(&(light * region.share())), layer);
        }
        for splat in self.tracer.splats().iter().filter(|splat| region.holds(splat.position)) {
            let xyz = found.sensor.xyz(&splat.radiance);
            state.add(region.in_pixels(splat.position), xyz, layers.of(splat.part));
        }
        state.refused
    }

    /// Traces the seeds that are missing, beside all other threads.
    fn find_seeds(&mut self) -> bool {
        let driver = self.driver;
        let mut scratch = Chain::default();
        driver.seeds.complete(|number| {
            let key = driver.key(number as u64);
            let mut block = seeds::Block { targets: vec![], refused: 0 };
            for step in 0..driver.seeds.per_block {
                block.refused += self.trace(&mut scratch, [key, step], true, &mut ());
                block.targets.push(scratch.proposal.target);
            }
            block
        })
    }

    /// Draws the chain's start among the seeds of its pool.
    fn start(&mut self, chain: &mut Chain, number: u64) {
        let driver = self.driver;
        let (pools, pool) = (driver.seeds.pools, number as usize % driver.seeds.pools);
        if number < pools as u64 {
            for block in driver.seeds.pool(pool) {
                self.add_brightness(block.sum(), driver.seeds.per_block);
                self.delta.refuse(block.refused);
            }
        }
        // One random number for all chains of a pool and a place of its own for each: each start is drawn as if it were
        // the only one, and any few of them are spread evenly (systematic sampling, in the order of van der Corput).
        let shift = rng::Rng::new(rng::key(&[driver.seed, driver.first, pool as u64, 1])).next_f64();
        let place = radical_inverse_2(number as u32 / pools as u32);
        if let Some((block, step)) = driver.seeds.draw(pool, (shift + place).fract()) {
            self.trace(chain, [driver.key(block as u64), step], true, &mut ());
            chain.accept();
            chain.is_started = true;
        }
    }

    fn mutate(&mut self, chain: &mut Chain, step: u64, record: &mut impl Record) {
        let settings = &self.driver.settings;
        let mut rng = rng::Rng::new(rng::key(&[self.key, step, 2]));
        let is_large = !chain.is_started || rng.next_f64() < settings.large_mutation_prob;
        let refused = self.trace(chain, [self.key, step], is_large, record);
        self.delta.refuse(refused);
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
        for &(position, xyz, layer) in &state.splats {
            let xyz = xyz.map(|c| (f64::from(c) * weight) as f32);
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
    fn add(&mut self, position: Vec2, xyz: [f32; 3], layer: usize) {
        let sum: f64 = xyz.iter().map(|c| f64::from(*c)).sum();
        if !(sum.is_finite() && sum >= 0.0) {
            self.refused += 1;
        } else if sum > 0.0 {
            self.target += sum / 3.0;
            self.splats.push((position, xyz, layer));
        }
    }
}
