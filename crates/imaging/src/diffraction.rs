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

mod spread;

use crate::Region;
use crate::convolution::{Plane, Spectrum, Window};
use indigo_camera::{FarField, Pupil};
use indigo_film::XyzImage;
use rayon::prelude::*;
use spread::Spread;
use std::sync::{Arc, Mutex, PoisonError};

/// Pixels from the middle up to which the kernel is a sum over points.
const NEAR: i64 = 24;
/// Distance of those points in pixels.
const SPACING: f64 = 0.25;

/// Diffraction by an aperture. Holds its kernel for the size of the pictures that it was last used for,
/// so keep it as long as there are pictures to develop.
#[derive(Debug)]
pub struct Diffraction {
    pupil: Pupil,
    cycle_per_nm: [f64; 2],
    prepared: Mutex<Option<Arc<Prepared>>>,
}

/// The kernels for pictures of one size.
struct Prepared {
    plane: Plane,
    /// For X, Y and Z.
    spectra: [Spectrum; 3],
    film: [u32; 2],
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
        Self { pupil, cycle_per_nm, prepared: Mutex::new(None) }
    }

    /// Spreads the light of the internal pixels of a region.
    pub(crate) fn apply(&self, image: &mut XyzImage, region: Region) {
        let film = [image.size.internal_width(), image.size.internal_height()];
        let Some(window) = Window::of(image.size, region) else { return };
        let Some(prepared) = self.prepared(window, film) else { return };
        for (c, spectrum) in prepared.spectra.iter().enumerate() {
            window.convolve(image, c, (&prepared.plane, spectrum), |_, spread| spread);
        }
    }

    /// The kernels for a window of a film of some internal size; `None` where no light passes the pupil.
    fn prepared(&self, window: Window, film: [u32; 2]) -> Option<Arc<Prepared>> {
        let mut guard = self.prepared.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(ready) = guard.as_ref()
            && (ready.plane.width, ready.plane.height, ready.film) == (window.width, window.height, film)
        {
            return Some(Arc::clone(ready));
        }
        let plane = Plane::new(window.width, window.height);
        let cycle = [0, 1].map(|i| self.cycle_per_nm[i] * f64::from(film[i]));
        let kernels = kernels(&self.pupil.far_field()?, &plane, cycle);
        let spectra = kernels.map(|k| plane.spectrum(&k));
        let ready = Arc::new(Prepared { plane, spectra, film });
        *guard = Some(Arc::clone(&ready));
        Some(ready)
    }
}

/// Kernels of X, Y and Z over a plane on which a cycle has a size in pixels per nm.
fn kernels(field: &FarField, plane: &Plane, cycle: [f64; 2]) -> [Vec<f64>; 3] {
    let reach = (plane.width as f64 / cycle[0]).hypot(plane.height as f64 / cycle[1]);
    let spread = Spread::new(field, reach);
    let mut kernel = Kernel::new(plane);
    kernel.add_near(&spread, cycle);
    kernel.add_far(&spread, cycle);
    kernel.values
}

/// Kernels of X, Y and Z under construction, over a whole period, their middle at (0, 0).
struct Kernel<'a> {
    plane: &'a Plane,
    values: [Vec<f64>; 3],
}

impl<'a> Kernel<'a> {
    fn new(plane: &'a Plane) -> Self {
        let zeros = || vec![0.0; plane.columns * plane.rows];
        Self { plane, values: [zeros(), zeros(), zeros()] }
    }

    /// Where an offset stands in memory; `None` if it leads out of any picture.
    fn index(&self, x: i64, y: i64) -> Option<usize> {
        let wrapped = |v: i64, n: usize, len: usize| {
            (v.unsigned_abs() < len as u64).then(|| v.rem_euclid(n as i64) as usize)
        };
        let x = wrapped(x, self.plane.columns, self.plane.width)?;
        Some(wrapped(y, self.plane.rows, self.plane.height)? * self.plane.columns + x)
    }

    /// Sums points of the spread into the pixels round the middle.
    fn add_near(&mut self, spread: &Spread, cycle: [f64; 2]) {
        let pixel = 1.0 / cycle[0].max(cycle[1]);
        // Tents reach one pixel beyond, squares to their corners.
        let farthest = (NEAR + 1) as f64 * std::f64::consts::SQRT_2 / cycle[0].min(cycle[1]);
        spread.for_each_point(farthest, SPACING * pixel, |[x, y], share| {
            let (x, y) = (x * cycle[0], y * cycle[1]);
            for sign in [1.0, -1.0] {
                self.add_tent(sign * x, sign * y, share);
            }
        });
    }

    fn add_tent(&mut self, x: f64, y: f64, share: [f64; 3]) {
        let (i, j) = (x.floor(), y.floor());
        let (s, t) = (x - i, y - j);
        for (dx, dy, weight) in
            [(0, 0, (1.0 - s) * (1.0 - t)), (1, 0, s * (1.0 - t)), (0, 1, (1.0 - s) * t), (1, 1, s * t)]
        {
            // Frequencies and offsets count upwards, rows downwards.
            let (x, y) = (i as i64 + dx, -(j as i64 + dy));
            if x.abs().max(y.abs()) > NEAR {
                continue;
            }
            if let Some(at) = self.index(x, y) {
                self.values.iter_mut().zip(share).for_each(|(v, share)| v[at] += weight * share);
            }
        }
    }

    /// Fills the pixels farther away.
    fn add_far(&mut self, spread: &Spread, cycle: [f64; 2]) {
        let plane = self.plane;
        let (width, height) = (plane.width as i64, plane.height as i64);
        let area = 1.0 / (cycle[0] * cycle[1]);
        // Half a plane; the other half is its mirror image.
        let rows: Vec<Vec<[f64; 3]>> = (0..height)
            .into_par_iter()
            .map(|y| {
                let value = |x: i64| {
                    if x.abs().max(y) <= NEAR || (y == 0 && x < 0) {
                        return [0.0; 3];
                    }
                    let offset = [x as f64 / cycle[0], -y as f64 / cycle[1]];
                    let radius = (x as f64).hypot(y as f64);
                    spread.at(offset, 1.0 / radius).map(|v| v * area)
                };
                (1 - width..width).map(value).collect()
            })
            .collect();
        for (y, row) in (0..height).zip(&rows) {
            for (x, value) in (1 - width..width).zip(row) {
                let places = [self.index(x, y), self.index(-x, -y)];
                for at in places.into_iter().flatten().filter(|_| value[1] > 0.0) {
                    self.values.iter_mut().zip(value).for_each(|(k, &v)| k[at] = v);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests;
