//! Means over output pixels, and light that is added to all internal pixels of one.

use crate::Region;
use crate::window::Window;
use indigo_film::{FilmSize, XyzImage};
use indigo_math::pages::fresh;
use rayon::prelude::*;

/// The means of X, Y and Z over the output pixels of a region, as a picture of its size; `None` where it is empty.
pub(crate) fn means(image: &XyzImage, region: Region) -> Option<XyzImage> {
    let window = Window::of(image.size, region);
    let factor = image.size.super_sample() as usize;
    let (width, height) = (window.width / factor, window.height / factor);
    let size = FilmSize::new(width as u32, height as u32, 1).ok()?;
    let scale = 1.0 / (factor * factor) as f32;
    let mut pixels = fresh(vec![[0.0; 4]; width * height]);
    pixels.par_chunks_exact_mut(width).enumerate().for_each(|(y, means)| {
        for y in y * factor..(y + 1) * factor {
            for (mean, block) in means.iter_mut().zip(window.row(image, y).chunks_exact(factor)) {
                for pixel in block {
                    mean.iter_mut().zip(pixel).for_each(|(m, v)| *m += v);
                }
            }
        }
        means.as_flattened_mut().iter_mut().for_each(|m| *m *= scale);
    });
    Some(XyzImage { size, missing: vec![false; pixels.len()], pixels })
}

/// Leaves a part of X, Y and Z of the region's internal pixels, and adds to them what is there for their output pixel.
pub(super) fn add(image: &mut XyzImage, region: Region, kept: [f32; 3], light: &XyzImage) {
    let window = Window::of(image.size, region);
    let factor = image.size.super_sample() as usize;
    let all = Window::of(light.size, Region::whole(light.size));
    window.rows_mut(image).enumerate().for_each(|(y, row)| {
        for (block, light) in row.chunks_exact_mut(factor).zip(all.row(light, y / factor)) {
            for pixel in block {
                for c in 0..3 {
                    pixel[c] = kept[c] * pixel[c] + light[c];
                }
            }
        }
    });
}
