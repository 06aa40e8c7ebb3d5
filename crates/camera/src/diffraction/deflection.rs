//! Diffraction of rays: how far from its place on the sensor a path's light falls.
//!
//! An offset is drawn from the far field of the aperture for the path's hero wavelength, whatever the
//! point of the lens. Longer wavelengths are spread more, so each lane has a density of its own for the
//! same offset.

use super::far_field::{FarField, SECTORS, sector_of, turns};
use indigo_math::elementary::sin_cos_turns;
use indigo_math::{Real, Vec2};
use indigo_spectrum::{LanePdf, SampledWavelengths};

/// Stands for the number 0, whose offset would be infinite: half the step of a random number.
const LEAST: Real = 1.0 / (1u32 << 25) as Real;

/// How far from its place a path's light falls.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Offset {
    /// On the film, in its widths and heights.
    pub on_film: Vec2,
    /// Its density for each wavelength, over the hero's.
    pub ratio: LanePdf,
    /// The hero's, over the area of the film.
    pub density: Real,
}

impl Offset {
    /// Where nothing is deflected.
    pub const NONE: Self =
        Self { on_film: Vec2 { x: 0.0, y: 0.0 }, ratio: LanePdf::ONE, density: Real::INFINITY };
}

/// Draws offsets by the far field of an aperture.
#[derive(Clone, Debug)]
pub(crate) struct Deflection {
    /// Squares of the rings' radii, in cycles.
    squares: Vec<Real>,
    /// Part of the light that goes farther than each radius.
    beyond: Vec<Real>,
    /// For each ring, and at last for all that lies beyond: part of its light up to each sector's
    /// beginning, from 0 to 1.
    sectors: Vec<f32>,
    /// Density per square cycle in each ring's sectors, and at last its product with r³ beyond.
    density: Vec<f32>,
    /// Where sectors begin, in turns.
    turns: Vec<Real>,
    /// Widths and heights of the film in a cycle, per nm of wavelength.
    cycle: Vec2,
}

impl Deflection {
    /// From a far field; `cycle` is the size of a cycle on the film per nm of wavelength, in widths and
    /// heights of the film.
    pub fn new(field: &FarField, cycle: Vec2) -> Self {
        let rows = field.radii().len();
        let mut sectors = Vec::with_capacity(rows * (SECTORS + 1));
        for i in 0..rows {
            let power: f64 = field.ring_power(i).sum();
            let mut running = 0.0;
            sectors.push(0.0);
            sectors.extend(field.ring_power(i).map(|p| {
                running += p;
                (running / power) as f32
            }));
        }
        Self {
            squares: field.radii().iter().map(|r| (r * r) as Real).collect(),
            beyond: field.radii().iter().map(|&r| field.beyond(r) as Real).collect(),
            sectors,
            density: field.density().to_vec(),
            turns: (0..=SECTORS).map(|j| turns(j as f64) as Real).collect(),
            cycle,
        }
    }

    /// The offset for two numbers in [0, 1).
    #[inline]
    pub fn sample(&self, u: Vec2, lambda: &SampledWavelengths) -> Offset {
        let (f, pdf) = self.sample_cycles(u);
        let hero = lambda.lambda[0];
        let cycle = self.cycle * hero;
        // Film positions count downwards.
        let offset = Vec2::new(f.x * cycle.x, -f.y * cycle.y);
        let mut ratio = LanePdf::ONE;
        for lane in 1..lambda.lambda.len() {
            let scale = hero / lambda.lambda[lane];
            ratio[lane] = self.density(f * scale) * scale * scale / pdf;
        }
        Offset { on_film: offset, ratio, density: pdf / (cycle.x * cycle.y) }
    }

    /// A frequency in cycles, and its density per square cycle.
    #[inline]
    fn sample_cycles(&self, u: Vec2) -> (Vec2, Real) {
        let last = self.squares.len() - 1;
        // The far end has the small numbers, which single precision tells apart best.
        let out = u.x.max(LEAST);
        let i = self.beyond.partition_point(|&b| b > out).max(1) - 1;
        let square = if i == last {
            let r = self.beyond[last] / out;
            self.squares[last] * r * r
        } else {
            let t = (self.beyond[i] - out) / (self.beyond[i] - self.beyond[i + 1]);
            self.squares[i] + t * (self.squares[i + 1] - self.squares[i])
        };
        // Which half of the circle, and where in it.
        let (sign, v) = if u.y < 0.5 { (1.0, 2.0 * u.y) } else { (-1.0, 2.0 * u.y - 1.0) };
        let row = &self.sectors[i * (SECTORS + 1)..(i + 1) * (SECTORS + 1)];
        let j = row.partition_point(|&c| Real::from(c) <= v).clamp(1, SECTORS) - 1;
        let (lo, hi) = (Real::from(row[j]), Real::from(row[j + 1]));
        let (a, b) = (self.turns[j], self.turns[j + 1]);
        let (sin, cos) = sin_cos_turns(a + (b - a) * ((v - lo) / (hi - lo)));
        let r = square.sqrt() * sign;
        (Vec2::new(r * cos, r * sin), self.value(i, j, square))
    }

    /// Density per square cycle at a frequency.
    #[inline]
    fn density(&self, f: Vec2) -> Real {
        let square = f.x * f.x + f.y * f.y;
        let i = self.squares.partition_point(|&s| s <= square).max(1) - 1;
        let y = if f.x < 0.0 { -f.y } else { f.y };
        let place = sector_of(f.x.abs(), y);
        self.value(i, (place.max(0.0) as usize).min(SECTORS - 1), square)
    }

    #[inline]
    fn value(&self, i: usize, j: usize, square: Real) -> Real {
        let d = Real::from(self.density[i * SECTORS + j]);
        if i + 1 == self.squares.len() { d / (square * square.sqrt()) } else { d }
    }
}
