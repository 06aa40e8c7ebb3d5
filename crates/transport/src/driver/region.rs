//! The part of the film that is rendered.

use indigo_film::FilmSize;
use indigo_math::{Real, Vec2};
use indigo_scene::Scene;

/// A rectangle of output pixels.
#[derive(Clone, Copy, Debug)]
pub(super) struct Region {
    /// The film.
    pub size: FilmSize,
    /// First and last (excluded) column, and the same of the rows.
    pub ends: [[u32; 2]; 2],
}

impl Region {
    pub fn of(scene: &Scene) -> Self {
        let size = scene.film.size;
        Self { size, ends: scene.film.region.unwrap_or([[0, size.width()], [0, size.height()]]) }
    }

    /// What splats must cover, so that each pixel of the region gets all of its light: positions as far beyond its
    /// edge as the splat filter reaches, in whole output pixels, and no farther than the film.
    pub fn grown(&self, scene: &Scene) -> Self {
        let reach = (scene.film.splat.radius() / f64::from(self.size.super_sample())).ceil() as u32;
        let sides = [self.size.width(), self.size.height()];
        let ends = [0, 1].map(|axis| {
            let [lo, hi] = self.ends[axis];
            [lo.saturating_sub(reach), hi.saturating_add(reach).min(sides[axis])]
        });
        Self { size: self.size, ends }
    }

    /// Whether it holds a film position, from (0, 0) to (1, 1).
    #[inline]
    pub fn holds(&self, p: Vec2) -> bool {
        let on = |axis: usize, side: u32, p: Real| {
            let [lo, hi] = self.ends[axis].map(|end| end as Real);
            (lo..=hi).contains(&(p * side as Real))
        };
        on(0, self.size.width(), p.x) && on(1, self.size.height(), p.y)
    }

    /// Number of output pixels.
    pub fn pixels(&self) -> u64 {
        let [x, y] = self.ends.map(|[lo, hi]| u64::from(hi - lo));
        x * y
    }

    /// Part of the film that it covers.
    pub fn share(&self) -> Real {
        self.pixels() as Real / self.size.pixels() as Real
    }

    /// The film position, from (0, 0) to (1, 1), of two numbers in [0, 1).
    pub fn position(&self, [u, v]: [Real; 2]) -> Vec2 {
        let on = |axis: usize, side: u32, u: Real| {
            let [lo, hi] = self.ends[axis].map(|end| end as Real);
            (lo + u * (hi - lo)) / side as Real
        };
        Vec2::new(on(0, self.size.width(), u), on(1, self.size.height(), v))
    }

    /// A film position, from (0, 0) to (1, 1), in internal pixels.
    #[inline]
    pub fn in_pixels(&self, p: Vec2) -> Vec2 {
        Vec2::new(p.x * self.size.internal_width() as Real, p.y * self.size.internal_height() as Real)
    }
}
