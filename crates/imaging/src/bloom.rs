//! Bloom: a blurred copy of the picture that is added to it. Deprecated in scenes, since diffraction
//! computes what it imitates.

use crate::Region;
use crate::convolution::{Plane, Room, Symmetry};
use crate::window::Window;
use indigo_film::XyzImage;

/// A glow round bright spots.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bloom {
    /// How much of the blurred picture is added: 0 none, 1 as much again as there was.
    pub weight: f64,
    /// Standard deviation of the blur, as a part of the longer side of the picture.
    pub radius: f64,
}

impl Bloom {
    /// Adds the glow to the internal pixels of a region.
    pub(crate) fn apply(&self, image: &mut XyzImage, region: Region) {
        let window = Window::of(image.size, region);
        if window.is_empty() {
            return;
        }
        let longer = image.size.internal_width().max(image.size.internal_height());
        let plane = Plane::new(window.width, window.height);
        let sigma = self.radius * f64::from(longer);
        let (columns, rows) = (profile(plane.columns, sigma), profile(plane.rows, sigma));
        let mut room = Room::default();
        let [spectrum] = plane.spectra(Symmetry::Mirror, &mut room, |x, y| {
            [columns[x.unsigned_abs() as usize] * rows[y.unsigned_abs() as usize]]
        });
        let weight = self.weight as f32;
        plane
            .convolve(image, window, [&spectrum; 3], &mut room, |_, sharp, blurred| sharp + weight * blurred);
    }
}

/// A normal distribution over a period of pixels, its middle at 0; all of it there where sigma is 0.
fn profile(period: usize, sigma: f64) -> Vec<f64> {
    let value = |i: usize| {
        let x = i.min(period - i) as f64;
        if i == 0 { 1.0 } else { (-0.5 * (x / sigma).powi(2)).exp() }
    };
    let values: Vec<f64> = (0..period).map(value).collect();
    let sum: f64 = values.iter().sum();
    values.iter().map(|v| v / sum).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use indigo_film::FilmSize;

    fn lamp(side: u32) -> XyzImage {
        let size = FilmSize::new(side, side, 1).unwrap();
        let mut pixels = vec![[0.0; 4]; size.pixels()];
        pixels[(side * side / 2 + side / 2) as usize] = [1.0, 2.0, 3.0, 0.5];
        XyzImage { size, missing: vec![false; pixels.len()], pixels }
    }

    #[test]
    fn a_lamp_gets_a_glow_of_the_weight_and_the_radius() {
        let side = 128;
        let mut image = lamp(side);
        let whole = Region::whole(image.size);
        Bloom { weight: 0.25, radius: 0.05 }.apply(&mut image, whole);
        let (mut sum, mut square) = (0.0, 0.0);
        for (i, p) in image.pixels.iter().enumerate() {
            let x = (i % side as usize) as f64 - 64.0;
            sum += f64::from(p[1]);
            square += x * x * f64::from(p[1]);
            assert!((p[2] - 1.5 * p[1]).abs() < 1e-5 && (p[3] == 0.5 || p[3] == 0.0));
        }
        assert!((sum - 2.5).abs() < 1e-3, "{sum}");
        let sigma = (square / 0.5).sqrt();
        assert!((sigma / (0.05 * 128.0) - 1.0).abs() < 1e-2, "{sigma}");
    }

    #[test]
    fn a_glow_of_no_radius_or_no_weight_is_none() {
        let mut image = lamp(16);
        let whole = Region::whole(image.size);
        Bloom { weight: 0.0, radius: 0.2 }.apply(&mut image, whole);
        assert!(image.pixels.iter().zip(&lamp(16).pixels).all(|(a, b)| (a[1] - b[1]).abs() < 1e-6));
        Bloom { weight: 1.0, radius: 0.0 }.apply(&mut image, whole);
        assert!(image.pixels.iter().zip(&lamp(16).pixels).all(|(a, b)| (a[1] - 2.0 * b[1]).abs() < 1e-6));
    }
}
