//! Error measures between images, block means, and difference maps.

use std::io::{self, Write};

use crate::png;
use crate::zgrid::ShapeError;

/// An image of `f64` samples: rows from the top, pixels from the left, channels interleaved.
#[derive(Clone, Debug, PartialEq)]
pub struct Image {
    width: usize,
    height: usize,
    channels: usize,
    data: Vec<f64>,
}

impl Image {
    /// An image over `data`, whose length must be width x height x channels and not 0.
    pub fn new(width: usize, height: usize, channels: usize, data: Vec<f64>) -> Result<Self, ShapeError> {
        let expected = width.checked_mul(height).and_then(|n| n.checked_mul(channels));
        if expected != Some(data.len()) || data.is_empty() {
            return Err(ShapeError::new(format!(
                "{} numbers are no image of {width} x {height} x {channels}",
                data.len()
            )));
        }
        Ok(Self { width, height, channels, data })
    }

    /// The same from the single precision of a film or a file.
    pub fn from_f32(width: usize, height: usize, channels: usize, data: &[f32]) -> Result<Self, ShapeError> {
        Self::new(width, height, channels, data.iter().map(|&x| f64::from(x)).collect())
    }

    /// Width in pixels.
    pub fn width(&self) -> usize {
        self.width
    }

    /// Height in pixels.
    pub fn height(&self) -> usize {
        self.height
    }

    /// All samples.
    pub fn data(&self) -> &[f64] {
        &self.data
    }

    /// The channels of one pixel.
    pub fn pixel(&self, x: usize, y: usize) -> &[f64] {
        let start = (y * self.width + x) * self.channels;
        &self.data[start..start + self.channels]
    }

    /// The mean of each channel.
    pub fn mean(&self) -> Vec<f64> {
        let pixels = (self.width * self.height) as f64;
        (0..self.channels)
            .map(|c| self.data.iter().skip(c).step_by(self.channels).sum::<f64>() / pixels)
            .collect()
    }

    /// The image of means over blocks of `size` x `size` pixels (smaller at the right and bottom).
    #[must_use]
    pub fn block_means(&self, size: usize) -> Self {
        let size = size.max(1);
        let (width, height) = (self.width.div_ceil(size), self.height.div_ceil(size));
        let mut sums = vec![0.0; width * height * self.channels];
        let mut counts = vec![0u32; width * height];
        for y in 0..self.height {
            for x in 0..self.width {
                let block = y / size * width + x / size;
                counts[block] += 1;
                for (sum, value) in sums[block * self.channels..].iter_mut().zip(self.pixel(x, y)) {
                    *sum += value;
                }
            }
        }
        for (i, sum) in sums.iter_mut().enumerate() {
            *sum /= f64::from(counts[i / self.channels]);
        }
        Self { width, height, channels: self.channels, data: sums }
    }

    /// Mean of (x - r)² / (r² + ε), the relative error of Rousselle et al. (2011, eq. 6).
    ///
    /// ε is `dark` times the mean of r², so that the measure does not depend on the unit; 0.01 is usual.
    pub fn rel_mse(&self, reference: &Self, dark: f64) -> Result<f64, ShapeError> {
        self.same_shape(reference)?;
        let n = self.data.len() as f64;
        let epsilon = dark * reference.data.iter().map(|r| r * r).sum::<f64>() / n;
        let pairs = self.data.iter().zip(&reference.data);
        Ok(pairs.map(|(x, r)| relative_square(*x, *r, epsilon)).sum::<f64>() / n)
    }

    /// Mean of (x - r)².
    pub fn mse(&self, reference: &Self) -> Result<f64, ShapeError> {
        self.same_shape(reference)?;
        let pairs = self.data.iter().zip(&reference.data);
        Ok(pairs.map(|(x, r)| (x - r) * (x - r)).sum::<f64>() / self.data.len() as f64)
    }

    fn same_shape(&self, other: &Self) -> Result<(), ShapeError> {
        let shape = |image: &Self| (image.width, image.height, image.channels);
        if shape(self) == shape(other) {
            return Ok(());
        }
        Err(ShapeError::new(format!("images of shapes {:?} and {:?}", shape(self), shape(other))))
    }
}

/// (x - r)² / (r² + ε), and 0 where both images are black.
fn relative_square(x: f64, r: f64, epsilon: f64) -> f64 {
    let square = (x - r) * (x - r);
    if square == 0.0 { 0.0 } else { square / (r * r + epsilon) }
}

/// Writes signed numbers, in row order, as a PNG: red where positive, blue where negative, white at 0,
/// full colour from `full_scale` on, green where not finite. `zoom` pixels a side show each number.
///
/// The caller owns the sink; nothing is opened here.
pub fn write_signed_map(
    values: &[f64],
    columns: usize,
    full_scale: f64,
    zoom: usize,
    sink: &mut dyn Write,
) -> io::Result<()> {
    let zoom = zoom.max(1);
    let rows: Vec<Vec<u8>> = values
        .chunks(columns.max(1))
        .map(|row| row.iter().flat_map(|&v| [signed_colour(v / full_scale)].repeat(zoom)).flatten().collect())
        .collect();
    let stretched: Vec<&[u8]> = rows.iter().flat_map(|row| vec![row.as_slice(); zoom]).collect();
    png::write_rgb(columns.max(1) * zoom, &stretched, sink)
}

fn signed_colour(x: f64) -> [u8; 3] {
    if !x.is_finite() {
        return [0, 255, 0];
    }
    let fade = (255.0 * (1.0 - x.abs().min(1.0))).round() as u8;
    if x > 0.0 { [255, fade, fade] } else { [fade, fade, 255] }
}

/// Writes the relative difference (a - b) / (|b| + mean |b| / 10), averaged over the channels, as a
/// signed map ([`write_signed_map`]) with full colour at `full_scale`.
pub fn write_difference_map(a: &Image, b: &Image, full_scale: f64, sink: &mut dyn Write) -> io::Result<()> {
    a.same_shape(b).map_err(|error| io::Error::new(io::ErrorKind::InvalidInput, error))?;
    let floor = 0.1 * b.data.iter().map(|x| x.abs()).sum::<f64>() / b.data.len() as f64;
    let channels = a.channels as f64;
    let relative = |(a, b): (&f64, &f64)| if a == b { 0.0 } else { (a - b) / (b.abs() + floor) };
    let pixels = a.data.chunks(a.channels).zip(b.data.chunks(a.channels));
    let map: Vec<f64> = pixels.map(|(a, b)| a.iter().zip(b).map(relative).sum::<f64>() / channels).collect();
    write_signed_map(&map, a.width, full_scale, 1, sink)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ramp(width: usize, height: usize) -> Image {
        Image::new(width, height, 1, (0..width * height).map(|i| i as f64).collect()).unwrap()
    }

    #[test]
    fn shapes_are_checked() {
        assert!(Image::new(2, 2, 3, vec![0.0; 11]).is_err());
        assert!(Image::new(0, 2, 3, vec![]).is_err());
        assert!(Image::new(usize::MAX, 2, 1, vec![0.0; 4]).is_err());
        assert!(ramp(2, 3).mse(&ramp(3, 2)).is_err());
    }

    #[test]
    fn means_per_channel() {
        let image = Image::new(2, 1, 3, vec![1.0, 2.0, 3.0, 3.0, 6.0, 9.0]).unwrap();
        assert_eq!(image.mean(), vec![2.0, 4.0, 6.0]);
        assert_eq!(image.pixel(1, 0), &[3.0, 6.0, 9.0]);
    }

    #[test]
    fn block_means_at_full_and_cut_blocks() {
        let blocks = ramp(3, 3).block_means(2);
        assert_eq!((blocks.width(), blocks.height()), (2, 2));
        assert_eq!(blocks.data(), &[2.0, 3.5, 6.5, 8.0]);
    }

    #[test]
    fn relative_error_does_not_depend_on_the_unit() {
        let reference = ramp(4, 4);
        let scaled = |k: f64, image: &Image| {
            Image::new(4, 4, 1, image.data().iter().map(|x| k * x).collect()).unwrap()
        };
        let other = scaled(1.1, &reference);
        let error = other.rel_mse(&reference, 0.01).unwrap();
        let error_scaled = scaled(1000.0, &other).rel_mse(&scaled(1000.0, &reference), 0.01).unwrap();
        assert!((error - error_scaled).abs() < 1e-12);
        // Without the dark term each pixel but the black one has 0.1².
        assert!((other.rel_mse(&reference, 0.0).unwrap() - 0.01 * 15.0 / 16.0).abs() < 1e-12);
        assert_eq!(reference.mse(&reference).unwrap(), 0.0);
    }

    #[test]
    fn colours_of_the_difference_map() {
        assert_eq!(signed_colour(0.0), [255, 255, 255]);
        assert_eq!(signed_colour(2.0), [255, 0, 0]);
        assert_eq!(signed_colour(-1.0), [0, 0, 255]);
        assert_eq!(signed_colour(f64::NAN), [0, 255, 0]);
    }

    #[test]
    fn a_map_is_a_png_of_the_right_size() {
        let mut file = Vec::new();
        write_difference_map(&ramp(5, 4), &ramp(5, 4), 0.1, &mut file).unwrap();
        assert_eq!(&file[..8], b"\x89PNG\r\n\x1a\n");
        assert_eq!(&file[16..24], &[0, 0, 0, 5, 0, 0, 0, 4]);
        assert!(write_difference_map(&ramp(5, 4), &ramp(4, 5), 0.1, &mut file).is_err());
    }
}
