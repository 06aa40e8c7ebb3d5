//! What one worker has gathered since it last handed over: bricks of `f32` sums, made on first
//! touch, in no other thread's way.

use crate::{FilmFilter, FilmSize, LayerKind, Totals};
use indigo_math::Vec2;

/// Side of a brick in internal pixels.
pub(crate) const BRICK: usize = 64;
/// Pixels of a brick.
const BRICK_PIXELS: usize = BRICK * BRICK;
/// A contribution with a component beyond this is refused like an infinite one: the `f32` sums
/// hold 1e8 such samples without overflow.
const LARGEST: f32 = 1e30;

/// Contributions of one worker, one set of bricks for each layer of the film.
///
/// Sums are `f32`: hand over often enough (about once a second) that no pixel sums more than some
/// ten thousand samples here. [`clear`](Self::clear) keeps the bricks for the next round.
#[derive(Clone, Debug)]
pub struct FilmDelta {
    size: FilmSize,
    columns: usize,
    layers: Vec<DeltaLayer>,
    refused: u64,
}

/// The bricks of a layer, row by row, and what it counts as a whole.
#[derive(Clone, Debug)]
pub(crate) struct DeltaLayer {
    pub(crate) kind: LayerKind,
    pub(crate) bricks: Vec<Brick>,
    pub(crate) totals: Totals,
}

/// Sums (XYZ, alpha) and counts of 64 × 64 pixels; nothing is allocated before the first touch.
#[derive(Clone, Debug, Default)]
pub(crate) struct Brick {
    touched: bool,
    sums: Vec<[f32; 4]>,
    counts: Vec<f32>,
}

impl FilmDelta {
    /// An empty delta for a film of that size with layers of these kinds, in this order.
    pub fn new(size: FilmSize, kinds: impl IntoIterator<Item = LayerKind>) -> Self {
        let columns = (size.internal_width() as usize).div_ceil(BRICK);
        let rows = (size.internal_height() as usize).div_ceil(BRICK);
        let layers = kinds
            .into_iter()
            .map(|kind| DeltaLayer {
                kind,
                bricks: vec![Brick::default(); columns * rows],
                totals: Totals::default(),
            })
            .collect();
        Self { size, columns, layers, refused: 0 }
    }

    /// The size of the film that it belongs to.
    pub fn size(&self) -> FilmSize {
        self.size
    }

    /// Adds a camera sample to its internal pixel (`x`, `y`) of a per-pixel layer: `xyz` in cd/m²
    /// and `alpha`, both times the [`FilmSample`](crate::FilmSample)'s weight. Counts as one
    /// sample of the pixel and of the layer, unless it is refused (see [`refused`](Self::refused)).
    #[inline]
    pub fn add_sample(&mut self, layer: usize, x: u32, y: u32, xyz: [f32; 3], alpha: f32) {
        if !acceptable(xyz, alpha) {
            self.refused += 1;
            return;
        }
        let columns = self.columns;
        let layer = &mut self.layers[layer];
        debug_assert!(layer.kind == LayerKind::PerPixel, "camera samples belong to a per-pixel layer");
        let (brick, i) = layer.pixel(columns, x, y);
        add(&mut brick.sums[i], xyz, alpha, 1.0);
        brick.counts[i] += 1.0;
        layer.totals.n_samples += 1.0;
    }

    /// Spreads a contribution (`xyz` in cd/m², not divided by the density of film positions) at a
    /// film position (internal pixels, origin top left) over a per-screen layer. Positions outside
    /// the film touch nothing. Draws are counted by [`add_samples`](Self::add_samples), whether
    /// they led to a splat or not.
    #[inline]
    pub fn splat(&mut self, layer: usize, position: Vec2, xyz: [f32; 3], filter: &FilmFilter) {
        if !(acceptable(xyz, 0.0) && position.x.is_finite() && position.y.is_finite()) {
            self.refused += 1;
            return;
        }
        let columns = self.columns;
        let layer = &mut self.layers[layer];
        debug_assert!(layer.kind == LayerKind::PerScreen, "splats belong to a per-screen layer");
        let footprint = filter.footprint(position);
        let [x0, y0] = footprint.origin;
        let [nx, ny] = footprint.extent;
        for (y, row) in (y0..).zip(&footprint.rows[..ny]) {
            for (x, column) in (x0..).zip(&footprint.columns[..nx]) {
                let (brick, i) = layer.pixel(columns, x, y);
                add(&mut brick.sums[i], xyz, 0.0, row * column);
            }
        }
    }

    /// Counts `n` draws of a per-screen layer's technique: light paths, or mutations.
    pub fn add_samples(&mut self, layer: usize, n: u64) {
        let layer = &mut self.layers[layer];
        debug_assert!(layer.kind == LayerKind::PerScreen, "a per-pixel layer counts its own samples");
        layer.totals.n_samples += n as f64;
    }

    /// Counts `n` draws of a chain that has found no light yet.
    pub fn add_idle(&mut self, layer: usize, n: u64) {
        self.layers[layer].totals.n_idle += n as f64;
    }

    /// Adds `count` estimates of the Metropolis brightness constant whose sum is `sum` (cd/m²).
    pub fn add_brightness(&mut self, layer: usize, sum: f64, count: u64) {
        if !sum.is_finite() {
            self.refused += 1;
            return;
        }
        let totals = &mut self.layers[layer].totals;
        totals.b_sum += sum;
        totals.b_count += count as f64;
    }

    /// Counts contributions that were refused before they got here.
    pub fn refuse(&mut self, n: u64) {
        self.refused += n;
    }

    /// Contributions refused at the door: not finite, or beyond 1e30. Each is a bug elsewhere that
    /// must not poison the film; it leaves no trace in sums or counts but this one.
    pub fn refused(&self) -> u64 {
        self.refused
    }

    /// Whether nothing has been added since it was made or cleared.
    pub fn is_empty(&self) -> bool {
        let untouched =
            |l: &DeltaLayer| l.totals == Totals::default() && !l.bricks.iter().any(Brick::touched);
        self.refused == 0 && self.layers.iter().all(untouched)
    }

    /// Forgets everything but keeps the memory of the bricks.
    pub fn clear(&mut self) {
        self.refused = 0;
        for layer in &mut self.layers {
            layer.totals = Totals::default();
            layer.bricks.iter_mut().filter(|b| b.touched).for_each(Brick::clear);
        }
    }

    /// Moves everything out, for a hand-over that must not copy, and leaves an empty delta.
    #[must_use]
    pub fn take(&mut self) -> Self {
        let empty = Self::new(self.size, self.layers.iter().map(|l| l.kind));
        std::mem::replace(self, empty)
    }

    /// Bytes that its bricks hold.
    pub fn memory_bytes(&self) -> usize {
        let brick = |b: &Brick| size_of_val(&*b.sums) + size_of_val(&*b.counts) + size_of::<Brick>();
        self.layers.iter().flat_map(|l| &l.bricks).map(brick).sum()
    }

    /// Its layers, in the film's order.
    pub(crate) fn layers(&self) -> &[DeltaLayer] {
        &self.layers
    }

    /// Whether it was made for a film of that size with layers of these kinds.
    pub(crate) fn fits(&self, size: FilmSize, kinds: impl Iterator<Item = LayerKind>) -> bool {
        self.size == size && self.layers.iter().map(|l| l.kind).eq(kinds)
    }

    /// The bricks of a layer that cover a band of rows.
    pub(crate) fn band(&self, layer: usize, band: usize) -> &[Brick] {
        &self.layers[layer].bricks[band * self.columns..(band + 1) * self.columns]
    }
}

impl DeltaLayer {
    /// The brick of a pixel, made ready, and the pixel's index in it.
    #[inline]
    fn pixel(&mut self, columns: usize, x: u32, y: u32) -> (&mut Brick, usize) {
        let (x, y) = (x as usize, y as usize);
        debug_assert!(x / BRICK < columns, "pixel outside the film");
        let brick = &mut self.bricks[(y / BRICK) * columns + x / BRICK];
        if !brick.touched {
            brick.touch(self.kind);
        }
        (brick, (y % BRICK) * BRICK + x % BRICK)
    }
}

impl Brick {
    pub(crate) fn touched(&self) -> bool {
        self.touched
    }

    pub(crate) fn sums_of_row(&self, row: usize) -> &[[f32; 4]] {
        &self.sums[row * BRICK..(row + 1) * BRICK]
    }

    pub(crate) fn counts_of_row(&self, row: usize) -> &[f32] {
        &self.counts[row * BRICK..(row + 1) * BRICK]
    }

    #[cold]
    fn touch(&mut self, kind: LayerKind) {
        // A cleared brick still has its memory, all zero.
        self.touched = true;
        self.sums.resize(BRICK_PIXELS, [0.0; 4]);
        self.counts.resize(kind.count_slots(BRICK_PIXELS), 0.0);
    }

    fn clear(&mut self) {
        self.touched = false;
        self.sums.fill([0.0; 4]);
        self.counts.fill(0.0);
    }
}

/// Whether a contribution is finite and of a size that sums can hold.
#[inline]
fn acceptable([x, y, z]: [f32; 3], alpha: f32) -> bool {
    // A comparison with NaN is false, so one test per component does it.
    x.abs() <= LARGEST && y.abs() <= LARGEST && z.abs() <= LARGEST && alpha.abs() <= LARGEST
}

#[inline]
fn add(sum: &mut [f32; 4], [x, y, z]: [f32; 3], alpha: f32, weight: f32) {
    sum[0] += x * weight;
    sum[1] += y * weight;
    sum[2] += z * weight;
    sum[3] += alpha * weight;
}
