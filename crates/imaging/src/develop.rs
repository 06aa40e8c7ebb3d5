//! Developing: the steps from film to picture in their order.

use crate::downsize::{downsize, extent};
use crate::tonemap::ToneMapper;
use crate::white_balance::plain_rgb;
use crate::window::Window;
use crate::{LinearImage, Picture, PictureSettings, Region, watermark};
use indigo_film::{FilmError, FilmSize, FilmState, Filter, XyzImage};
use indigo_spectrum::adaptation;
use rayon::prelude::*;

/// Makes the picture of a film. Runs on the caller's rayon pool.
pub fn develop(film: &FilmState, settings: &PictureSettings) -> Picture {
    develop_image(&on_sensor(film.develop(), settings), settings)
}

/// The light that falls on the sensor: that of the film, diffracted by the camera's aperture if the
/// settings ask for it. Both pictures are made of it. Runs on the caller's rayon pool.
pub fn on_sensor(mut image: XyzImage, settings: &PictureSettings) -> XyzImage {
    if let Some(diffraction) = &settings.diffraction {
        let region = region(image.size, settings.region);
        diffraction.apply(&mut image, region);
    }
    image
}

/// The part of a picture that is rendered.
fn region(size: FilmSize, region: Option<Region>) -> Region {
    region.unwrap_or_else(|| Region::whole(size)).within(size)
}

/// Makes the picture of the light on the sensor ([`on_sensor`]).
pub fn develop_image(image: &XyzImage, settings: &PictureSettings) -> Picture {
    let size = image.size;
    let region = region(size, settings.region);
    let mut glowing;
    let image = match settings.bloom {
        Some(bloom) if !settings.foreground_alpha => {
            glowing = image.clone();
            bloom.apply(&mut glowing, region);
            &glowing
        }
        _ => image,
    };
    let window = Window::of(size, region);
    let mut pixels = if settings.foreground_alpha {
        downsize(size, region, settings.downsize, |y, out| coverage_row(window.row(image, y), out))
    } else {
        let mapper = ToneMapper::new(settings, window.rows(image));
        downsize(size, region, settings.downsize, |y, out| {
            mapper.map_row(window.row(image, y), out);
            clamp(out);
        })
    };
    clamp(&mut pixels);
    let pixels = framed(size, region, pixels);
    let mut picture = Picture { width: size.width(), height: size.height(), pixels };
    if settings.watermark {
        watermark::draw(&mut picture);
    }
    picture
}

/// Makes the linear picture of the light on the sensor ([`on_sensor`]): Rec. 709 in cd/m², without white balance and exposure.
/// `filter` must pass [`Filter::check`]. Runs on the caller's rayon pool.
pub fn untonemapped(image: &XyzImage, filter: Filter, region: Option<Region>) -> LinearImage {
    let size = image.size;
    let region = self::region(size, region);
    let window = Window::of(size, region);
    // The matrix is linear like the filter: apply it to the few pixels that are left.
    let mut pixels = downsize(size, region, filter, |y, out| out.copy_from_slice(window.row(image, y)));
    let matrix = plain_rgb();
    pixels.par_iter_mut().for_each(|pixel| {
        let [r, g, b] = matrix.apply(pixel);
        *pixel = [r, g, b, pixel[3]];
    });
    LinearImage { width: size.width(), height: size.height(), pixels: framed(size, region, pixels) }
}

/// Makes the linear picture that settings ask for: that of [`untonemapped`], or coverage by the foreground as grey.
pub fn linear_picture(image: &XyzImage, settings: &PictureSettings) -> LinearImage {
    let mut picture = untonemapped(image, settings.downsize, settings.region);
    if settings.foreground_alpha {
        picture.pixels.par_iter_mut().for_each(|pixel| *pixel = [pixel[3]; 4]);
        // A filter with negative lobes overshoots.
        clamp(&mut picture.pixels);
    }
    picture
}

/// The light on the sensor that a linear picture shows, without super-sampling. Errors: it has no pixels, or too many.
pub fn from_linear(image: &LinearImage) -> Result<XyzImage, FilmError> {
    let size = FilmSize::new(image.width, image.height, 1)?;
    let pixels = image.pixels.par_iter().map(|&[r, g, b, alpha]| {
        let [x, y, z] = adaptation::xyz_of_rgb([r, g, b].map(f64::from)).map(|v| v as f32);
        [x, y, z, alpha]
    });
    Ok(XyzImage { size, pixels: pixels.collect(), missing: vec![false; size.pixels()] })
}

/// Coverage by the foreground as grey.
fn coverage_row(from: &[[f32; 4]], to: &mut [[f32; 4]]) {
    for (pixel, out) in from.iter().zip(to) {
        *out = [pixel[3]; 4];
    }
}

/// Brings all components into [0, 1]; a NaN (of sums beyond all bounds) becomes 0.
fn clamp(pixels: &mut [[f32; 4]]) {
    for v in pixels.iter_mut().flatten() {
        *v = if *v > 0.0 { v.min(1.0) } else { 0.0 };
    }
}

/// A region's pixels in a frame of the picture's full size, black where nothing was rendered.
fn framed(size: FilmSize, region: Region, pixels: Vec<[f32; 4]>) -> Vec<[f32; 4]> {
    if region == Region::whole(size) {
        return pixels;
    }
    let mut frame = vec![[0.0; 4]; size.pixels()];
    let ([width, _], [x1, y1]) = (extent(region), region.start());
    let rows = frame.chunks_exact_mut(size.width() as usize).skip(y1 as usize);
    for (to, from) in rows.zip(pixels.chunks_exact(width.max(1))) {
        to[x1 as usize..x1 as usize + width].copy_from_slice(from);
    }
    frame
}
