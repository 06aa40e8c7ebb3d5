//! Pictures as large as a graphics card takes them.

use eframe::egui::{Color32, ColorImage, Rgba};
use rayon::prelude::*;
use std::sync::Arc;

/// A picture none of whose sides is longer than `longest`: itself if it is one, and otherwise the means, in linear light, over
/// squares of so many of its pixels that they fit.
pub fn to_fit(image: &Arc<ColorImage>, longest: usize) -> Arc<ColorImage> {
    let [width, height] = image.size;
    let factor = width.max(height).div_ceil(longest.max(1));
    if factor <= 1 {
        return Arc::clone(image);
    }
    let size = image.size.map(|side| side.div_ceil(factor));
    let rows = image.pixels.par_chunks(factor * width.max(1));
    let pixels = rows.flat_map_iter(|rows| {
        (0..size[0]).map(move |column| {
            let columns = column * factor..((column + 1) * factor).min(width);
            mean(rows.chunks(width).flat_map(|row| &row[columns.clone()]))
        })
    });
    Arc::new(ColorImage::new(size, pixels.collect()))
}

fn mean<'a>(pixels: impl Iterator<Item = &'a Color32>) -> Color32 {
    let (mut sum, mut count) = (Rgba::TRANSPARENT, 0.0);
    for pixel in pixels {
        sum = sum + Rgba::from(*pixel);
        count += 1.0;
    }
    Color32::from(sum * (1.0 / f32::max(count, 1.0)))
}

#[cfg(test)]
mod tests {
    #[test]
    fn what_fits_stays_as_it_is() {
        use super::*;
        let image = Arc::new(ColorImage::filled([4, 3], Color32::GRAY));
        assert!(Arc::ptr_eq(&to_fit(&image, 4), &image));
    }

    #[test]
    fn a_larger_picture_is_shown_by_means_of_its_light() {
        use super::*;
        // Columns of black and white, and a last one that has no partner.
        let columns = [Color32::BLACK, Color32::WHITE, Color32::BLACK, Color32::WHITE, Color32::RED];
        let image = Arc::new(ColorImage::new([5, 3], columns.repeat(3)));
        let small = to_fit(&image, 4);
        assert_eq!(small.size, [3, 2]);
        // Half of full light is code 188 by the sRGB curve.
        let row = [Color32::from_gray(188), Color32::from_gray(188), Color32::RED];
        assert_eq!(small.pixels, row.repeat(2));
        assert_eq!(to_fit(&image, 2).size, [2, 1]);
    }
}
