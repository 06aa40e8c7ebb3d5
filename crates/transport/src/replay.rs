//! A single sample of a render, told in words, for whoever looks for an error in it.
//!
//! A sample is named by the seed, its unit and its number in that: the samples of a tile row by row, or the mutations of
//! a unit of a chain. A chain is followed from its start.

use crate::driver::Driver;
use crate::technique::{End, Record};
use indigo_film::{FilmState, Sensor};
use indigo_light::Sender;
use indigo_math::{Float, Real, Vec2, Vec3};
use indigo_scene::Scene;
use indigo_spectrum::{SampledSpectrum, SampledWavelengths};
use std::fmt;

/// What a sample did.
#[derive(Clone, Debug)]
pub struct Replay {
    unit: u64,
    /// Its number in the unit.
    index: u64,
    /// Samples that have begun: in the end all of the unit.
    begun: u64,
    /// Whether they are mutations of a chain.
    is_chain: bool,
    position: Vec2,
    lambda: Option<SampledWavelengths>,
    vertices: Vec<(End, Vec3, bool)>,
    contributions: Vec<Contribution>,
}

/// Light that a sample found.
#[derive(Clone, Copy, Debug)]
pub struct Contribution {
    /// Vertices of the light's path and of the camera's.
    pub strategy: (u32, u32),
    /// Its film position, where that is not the camera ray's.
    pub at: Option<Vec2>,
    /// X, Y and Z, cd/m², as if there were no other strategy.
    pub xyz: [f32; 3],
    /// Its weight among them.
    pub weight: Real,
    /// W m^-3 sr^-1.
    spectrum: SampledSpectrum,
}

impl Contribution {
    /// X, Y and Z as they count, cd/m².
    pub fn weighted_xyz(&self) -> [f32; 3] {
        self.xyz.map(|v| v * self.weight.to_f64() as f32)
    }
}

/// The sample `index` of a unit of a scene's render from a seed.
///
/// # Errors
/// How many samples the unit has, where that is fewer.
pub fn replay(scene: &Scene, seed: u64, unit: u64, index: u64) -> Result<Replay, u64> {
    let driver = Driver::new(scene, seed);
    let mut tracer = driver.tracer();
    let mut delta = FilmState::new(scene.film.size, driver.layers()).delta();
    for before in driver.units_before(unit) {
        driver.render_unit(scene, before, &mut tracer, &mut delta);
    }
    let mut replay = Replay {
        unit,
        index,
        begun: 0,
        is_chain: driver.is_chain(unit),
        position: Vec2::new(0.0, 0.0),
        lambda: None,
        vertices: vec![],
        contributions: vec![],
    };
    driver.render_unit_recorded(scene, unit, &mut tracer, &mut delta, &mut replay);
    if replay.begun > index { Ok(replay) } else { Err(replay.begun) }
}

impl Replay {
    /// Where on the film its camera ray comes from, from (0, 0), top left, to (1, 1).
    pub fn position(&self) -> Vec2 {
        self.position
    }

    /// What it found. Filters, and what a render makes of film positions' density, are not in it.
    pub fn contributions(&self) -> &[Contribution] {
        &self.contributions
    }

    fn is_wanted(&self) -> bool {
        self.begun == self.index + 1
    }
}

impl Record for Replay {
    fn begin(&mut self, position: Vec2, lambda: &SampledWavelengths) {
        self.begun += 1;
        if self.is_wanted() {
            self.position = position;
            self.lambda = Some(*lambda);
        }
    }

    fn vertex(&mut self, from: End, p: Vec3, is_on_surface: bool) {
        if self.is_wanted() {
            self.vertices.push((from, p, is_on_surface));
        }
    }

    fn contribution(
        &mut self,
        strategy: (u32, u32),
        at: Option<Vec2>,
        unweighted: SampledSpectrum,
        weight: Real,
        _: Sender,
    ) {
        if self.is_wanted()
            && let Some(lambda) = &self.lambda
        {
            let xyz = Sensor::new(lambda).xyz(&unweighted);
            self.contributions.push(Contribution { strategy, at, xyz, weight, spectrum: unweighted });
        }
    }
}

impl fmt::Display for Replay {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let kind = if self.is_chain { "mutations of a chain" } else { "low-discrepancy samples" };
        writeln!(f, "sample {} of unit {}, which has {} {kind}", self.index, self.unit, self.begun)?;
        writeln!(f, "film position {} {}", self.position.x, self.position.y)?;
        if let Some(lambda) = &self.lambda {
            writeln!(f, "wavelengths {:?} nm", lambda.lambda)?;
        }
        for &(from, p, is_on_surface) in &self.vertices {
            let end = if from == End::Camera { "camera" } else { "light" };
            let kind = if is_on_surface { "surface" } else { "medium" };
            writeln!(f, "vertex from the {end}: {} {} {} m from the camera, {kind}", p.x, p.y, p.z)?;
        }
        for c in &self.contributions {
            let (s, t) = c.strategy;
            write!(
                f,
                "strategy ({s}, {t}): weight {}, XYZ {:?} cd/m2, lanes {:?}",
                c.weight, c.xyz, c.spectrum.0
            )?;
            match c.at {
                Some(at) => writeln!(f, ", at {} {}", at.x, at.y)?,
                None => writeln!(f)?,
            }
        }
        let weighted = |i: usize| self.contributions.iter().map(|c| c.weighted_xyz()[i]).sum::<f32>();
        writeln!(f, "sum of all, weighted: XYZ {} {} {} cd/m2", weighted(0), weighted(1), weighted(2))
    }
}
