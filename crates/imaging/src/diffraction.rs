//! Diffraction by the camera's aperture as a filter on the picture.
//!
//! Each of X, Y and Z is convolved with the spread of white light (of equal energy) that the aperture
//! and its obstacles cause. Compared with the diffraction of rays that is inexact in one thing: light
//! that is not white has its own mixture of wavelengths under each of the three curves.
//!
//! The kernel of a pixel at the offset i is ∫ S(x) Λ(x - i) dx, with Λ the tent of two pixels' width along
//! both axes: what a pixel gathers of light that was even over another. So the filter is exact for
//! pictures that are even over each pixel, and leaves them as they are where light is not spread. Near the
//! middle the integral is a sum over points of S; farther away S itself, averaged across the ray from
//! the middle, on which alone it changes quickly.
//!
//! A super-sampled picture is convolved at the resolution of its output pixels, which takes a quarter of the
//! time and memory or less. With B the mean over an output pixel's internal pixels, K the kernel of output
//! pixels and w the part of the light that stays within its own internal pixel, the light of an internal pixel I
//! becomes w I + (K ∗ B I - w B I): what leaves its internal pixel is even over the output pixel where it
//! arrives. Its mean over an output pixel is K ∗ B I, as it should be; an even picture stays even; and since no part
//! of K is less than that of w δ, nothing becomes negative. Edges between internal pixels stay as sharp as w says, for
//! the tone mapping that follows at their resolution.

mod output_pixels;
mod spread;

pub(crate) use output_pixels::means;

use crate::Region;
use crate::convolution::{Plane, Room, Spectrum, Symmetry};
use crate::downsize::extent;
use crate::window::Window;
use indigo_camera::{FarField, Pupil};
use indigo_film::{FilmSize, XyzImage};
use rayon::prelude::*;
use spread::Spread;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

/// Pixels from the middle up to which the kernel is a sum over points.
const NEAR: i64 = 24;
/// Largest distance of those points in pixels.
const SPACING: f64 = 0.25;
/// Sizes of pictures whose kernels are held: that of a picture and that of a region of it, say.
const SIZES: usize = 2;

/// Diffraction by an aperture. Holds its kernels for the two sizes of pictures that it was last used for,
/// so keep it as long as there are pictures to develop.
#[derive(Debug)]
pub struct Diffraction {
    pupil: Pupil,
    cycle_per_nm: [f64; 2],
    /// Of the pupil; `None` in it where no light passes.
    field: OnceLock<Option<FarField>>,
    /// The one used last is the first.
    prepared: Mutex<Vec<Arc<Prepared>>>,
    /// What preparing took, for the picture that it was done for.
    room: Mutex<Room>,
}

/// The kernels for pictures of one size.
struct Prepared {
    plane: Plane,
    /// For X, Y and Z.
    spectra: [Spectrum; 3],
    /// The part of X, Y and Z that stays in its internal pixel, where output pixels have several; else 0.
    kept: [f32; 3],
    film: FilmSize,
}

impl std::fmt::Debug for Prepared {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "kernels for {} x {} pixels", self.plane.width, self.plane.height)
    }
}

impl Diffraction {
    /// Of a pupil on a film on which a cycle across the pupil's square has a size, in widths and
    /// heights of the film per nm of wavelength ([`indigo_camera::ThinLens::cycle_per_nm`]).
    pub fn new(pupil: Pupil, cycle_per_nm: [f64; 2]) -> Self {
        Self {
            pupil,
            cycle_per_nm,
            field: OnceLock::new(),
            prepared: Mutex::default(),
            room: Mutex::default(),
        }
    }

    /// Memory that the first picture of a film of a size takes besides the film and the picture, in bytes.
    pub fn bytes_needed(size: FilmSize) -> u64 {
        let means = size_of::<[f32; 4]>() as u64 + 1;
        Plane::new(size.width() as usize, size.height() as usize).bytes_needed(3)
            + means * size.pixels() as u64
    }

    /// Makes the kernels for a region of a film, in advance of its picture. Runs on the caller's rayon pool.
    pub(crate) fn prepare(&self, film: FilmSize, region: Region) {
        let [width, height] = extent(region);
        if width > 0 && height > 0 {
            let mut room = Room::default();
            self.prepared([width, height], film, &mut room);
            *self.room.lock().unwrap_or_else(PoisonError::into_inner) = room;
        }
    }

    /// Spreads the light of the internal pixels of a region.
    pub(crate) fn apply(&self, image: &mut XyzImage, region: Region) {
        let mut room = std::mem::take(&mut *self.room.lock().unwrap_or_else(PoisonError::into_inner));
        let Some(mut means) = output_pixels::means(image, region) else { return };
        let Some(prepared) = self.prepared(extent(region), image.size, &mut room) else { return };
        let Prepared { plane, spectra, kept, .. } = &*prepared;
        let window = Window::of(means.size, Region::whole(means.size));
        plane.convolve(&mut means, window, spectra.each_ref(), &mut room, |c, mean, spread| {
            spread - kept[c] * mean
        });
        output_pixels::add(image, region, *kept, &means);
    }

    /// The kernels for so many columns and rows of output pixels of a film; `None` where no light passes the pupil.
    fn prepared(
        &self,
        [width, height]: [usize; 2],
        film: FilmSize,
        room: &mut Room,
    ) -> Option<Arc<Prepared>> {
        let mut guard = self.prepared.lock().unwrap_or_else(PoisonError::into_inner);
        let serves = |p: &Arc<Prepared>| (p.plane.width, p.plane.height, p.film) == (width, height, film);
        if let Some(i) = guard.iter().position(serves) {
            guard[..=i].rotate_right(1);
        } else {
            let field = self.field.get_or_init(|| self.pupil.far_field()).as_ref()?;
            let plane = Plane::new(width, height);
            let cycle_per_nm = self.cycle_per_nm;
            let cycle = |[width, height]: [u32; 2]| {
                [cycle_per_nm[0] * f64::from(width), cycle_per_nm[1] * f64::from(height)]
            };
            let kernel = Kernel::new(field, [width, height], cycle([film.width(), film.height()]));
            let kept = match film.super_sample() {
                1 => [0.0; 3],
                _ => kernel.kept(cycle([film.internal_width(), film.internal_height()])),
            };
            let symmetry = if field.is_round() { Symmetry::Mirror } else { Symmetry::Opposite };
            let spectra = plane.spectra(symmetry, room, |x, y| kernel.at(x, y));
            guard.insert(0, Arc::new(Prepared { plane, spectra, kept, film }));
            guard.truncate(SIZES);
        }
        guard.first().map(Arc::clone)
    }
}

/// The kernels of X, Y and Z.
struct Kernel {
    spread: Spread,
    /// Size of a cycle in pixels per nm.
    cycle: [f64; 2],
    /// The pixels round the middle, row after row.
    near: Vec<[f64; 3]>,
}

impl Kernel {
    /// For pictures of a size on a film on which a cycle has a size in pixels per nm.
    fn new(field: &FarField, [width, height]: [usize; 2], cycle: [f64; 2]) -> Self {
        let reach = (width as f64 / cycle[0]).hypot(height as f64 / cycle[1]);
        let mut spread = Spread::new(field, reach);
        let near = near(&spread, cycle, NEAR);
        // Across the ray from the middle a pixel is as wide as its tent. Nearer offsets are not looked up.
        let nearest = NEAR as f64 / cycle[0].max(cycle[1]);
        let first = spread.ring_at(nearest).saturating_sub(1);
        spread.smooth(first, |[x, y]| {
            let pixels = ((x * cycle[0]).powi(2) + (y * cycle[1]).powi(2)).sqrt();
            1.0 / pixels.max(NEAR as f64)
        });
        Self { spread, cycle, near }
    }

    /// The part of the light of even pixels that stays within them, a cycle being of some size in them.
    fn kept(&self, cycle: [f64; 2]) -> [f32; 3] {
        near(&self.spread, cycle, 0)[0].map(|v| v as f32)
    }

    /// The kernels' values at an offset in pixels, columns to the right and rows down.
    fn at(&self, x: i64, y: i64) -> [f64; 3] {
        if x.abs().max(y.abs()) <= NEAR {
            return self.near[near_index(x, y, NEAR)];
        }
        let [cx, cy] = self.cycle;
        // Frequencies count upwards.
        let offset = [x as f64 / cx, -y as f64 / cy];
        self.spread.at(offset).map(|v| v / (cx * cy))
    }
}

/// Where the pixel at an offset stands among those up to `side` pixels from the middle.
fn near_index(x: i64, y: i64, side: i64) -> usize {
    ((y + side) * (2 * side + 1) + x + side) as usize
}

/// Sums points of the spread into the pixels up to `side` pixels from the middle.
fn near(spread: &Spread, cycle: [f64; 2], side: i64) -> Vec<[f64; 3]> {
    /// Rings that are summed by themselves: the order of the sums, and so their rounding, is always the same.
    const TOGETHER: usize = 16;
    // Tents reach one pixel beyond, squares to their corners.
    let reach = (side + 1) as f64;
    let farthest = reach * (1.0 / cycle[0]).hypot(1.0 / cycle[1]);
    let sectors = spread.sectors(cycle, reach);
    let end = spread.ring_at(farthest) + 1;
    let blank = || vec![[0.0; 3]; near_index(side, side, side) + 1];
    let parts: Vec<_> = (0..end.div_ceil(TOGETHER))
        .into_par_iter()
        .map(|i| {
            let mut part = blank();
            let rings = i * TOGETHER..end.min((i + 1) * TOGETHER);
            spread.for_each_point(rings, &sectors, SPACING, |[x, y], share| {
                add_tent(&mut part, side, [x * cycle[0], y * cycle[1]], share);
            });
            part
        })
        .collect();
    let mut half = blank();
    for part in parts {
        half.as_flattened_mut().iter_mut().zip(part.as_flattened()).for_each(|(sum, v)| *sum += v);
    }
    // The opposite offset has the same density.
    let opposite = half.iter().rev();
    half.iter().zip(opposite).map(|(a, b)| std::array::from_fn(|c| 0.5 * (a[c] + b[c]))).collect()
}

/// Adds a point's share to the four pixels round it, by how near they are; offsets upwards.
fn add_tent(near: &mut [[f64; 3]], side: i64, [x, y]: [f64; 2], share: [f64; 3]) {
    let (i, j) = (x.floor(), y.floor());
    let (s, t) = (x - i, y - j);
    for (dx, dy, weight) in
        [(0, 0, (1.0 - s) * (1.0 - t)), (1, 0, s * (1.0 - t)), (0, 1, (1.0 - s) * t), (1, 1, s * t)]
    {
        let (x, y) = (i as i64 + dx, -(j as i64 + dy));
        if x.abs().max(y.abs()) <= side {
            let pixel = &mut near[near_index(x, y, side)];
            pixel.iter_mut().zip(share).for_each(|(v, share)| *v += weight * share);
        }
    }
}

#[cfg(test)]
mod tests;
