//! Techniques: from a primary sample to light.

pub mod bidirectional;
pub mod first_event;
mod flight;
pub(crate) mod media;
mod mis;
pub mod path;
mod surface;
mod tracer;
mod vertex;
mod visibility;

pub use tracer::{Found, Tracer};

use indigo_light::Sender;
use indigo_math::{Real, Vec2, Vec3};
use indigo_spectrum::{SampledSpectrum, SampledWavelengths};

/// Which paths count, by their number of scattering events between camera and light.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Events {
    /// The least number.
    pub least: u32,
    /// The largest number.
    pub most: u32,
}

impl Events {
    /// All paths of at most so many events.
    pub const fn up_to(most: u32) -> Self {
        Self { least: 0, most }
    }

    /// Whether paths of `n` events count.
    #[inline]
    pub fn holds(self, n: u32) -> bool {
        (self.least..=self.most).contains(&n)
    }
}

/// Light that arrives along a camera ray.
#[derive(Clone, Copy, Debug)]
pub struct PathSample {
    /// Radiance, W m^-3 sr^-1, as it counts on the film, straight from the surroundings.
    pub background: SampledSpectrum,
    /// The same of other light that was scattered at most once.
    pub direct: SampledSpectrum,
    /// The same of what was scattered more often.
    pub indirect: SampledSpectrum,
    /// 1 where the ray meets a visible surface, 0 where it leaves the scene.
    pub alpha: Real,
}

impl PathSample {
    /// All of it.
    #[inline]
    pub fn radiance(&self) -> SampledSpectrum {
        self.direct + self.background + self.indirect
    }
}

/// The most scattering events of direct light.
pub const DIRECT: u32 = 1;

/// Light that arrives somewhere on the film.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Splat {
    /// From (0, 0), top left, to (1, 1).
    pub position: Vec2,
    /// Radiance, W m^-3 sr^-1, as it counts on the film, over the density of film positions.
    pub radiance: SampledSpectrum,
    /// What part of the light it is.
    pub part: Part,
}

/// The parts of light that a film may keep apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// Straight from the surroundings, where nothing stands before them.
    Background,
    /// From a lamp, or scattered once.
    Direct,
    /// Scattered more than once.
    Indirect,
}

impl Part {
    /// Of light that was scattered so many times, more than none.
    pub fn scattered(events: u32) -> Self {
        if events > DIRECT { Self::Indirect } else { Self::Direct }
    }

    /// Of light that a strategy (s, t) found: its path has s + t − 2 vertices between light and lens.
    pub fn of((s, t): (u32, u32), sender: Sender) -> Self {
        match (s + t, sender) {
            (2, Sender::Environment(_)) => Self::Background,
            (vertices, _) => Self::scattered(vertices - 2),
        }
    }
}

/// The ends of a path.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// The lens.
    Camera,
    /// A lamp, or the environment.
    Light,
}

/// Somebody who looks at the single contributions of a sample.
pub trait Record {
    /// Whether anybody does: what has no weight is left out otherwise.
    const LOOKS: bool = true;

    /// A sample begins: where on the film its camera ray comes from, from (0, 0), top left, to (1, 1), and the wavelengths.
    fn begin(&mut self, _position: Vec2, _lambda: &SampledWavelengths) {}

    /// A path from one end comes to a point at which it is scattered, render space, on a surface or in a medium.
    fn vertex(&mut self, _from: End, _p: Vec3, _is_on_surface: bool) {}

    /// A contribution of strategy (s, t) at a film position of its own or at the camera ray's: its
    /// value as if there were no other strategy, and the weight that it got; and who sent the light.
    fn contribution(
        &mut self,
        strategy: (u32, u32),
        at: Option<Vec2>,
        unweighted: SampledSpectrum,
        weight: Real,
        sender: Sender,
    );
}

/// Nobody looks.
impl Record for () {
    const LOOKS: bool = false;

    #[inline(always)]
    fn contribution(&mut self, _: (u32, u32), _: Option<Vec2>, _: SampledSpectrum, _: Real, _: Sender) {}
}
