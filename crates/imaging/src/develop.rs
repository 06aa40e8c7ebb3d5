//! Developing: the steps from film to picture in their order.

use crate::diffraction::means;
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
    develop_image(&on_sensor(film.develop_mixed(&settings.lights, |_| true), settings), settings)
}

/// The light that falls on the sensor: that of the film, diffracted by the camera's aperture if the
/// settings ask for it. Both pictures are made of it. Runs on the caller's rayon pool.
pub fn on_sensor(mut image: XyzImage, settings: &PictureSettings) -> XyzImage {
    if let Some(diffraction) = &settings.diffraction {
        let region = settings.rendered(image.size);
        diffraction.apply(&mut image, region);
    }
    image
}

/// The light on the sensor without super-sampling, as means over output pixels: a quarter of the work or less for a picture
/// that is developed again and again while somebody looks for the right settings. It differs from the picture of all internal
/// pixels where a bright edge crosses an output pixel. Runs on the caller's rayon pool.
pub fn preview_light(image: &XyzImage) -> Option<XyzImage> {
    means(image, Region::whole(image.size))
}

/// Makes the picture of the light on the sensor ([`on_sensor`]).
pub fn develop_image(image: &XyzImage, settings: &PictureSettings) -> Picture {
    let size = image.size;
    let region = settings.rendered(size);
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
    clamp_all(&mut pixels);
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
    let region = Region::or_whole(region, size);
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
        clamp_all(&mut picture.pixels);
    }
    picture
}

/// Coverage of output pixels by what camera rays meet, filtered as the light is; rows from top to bottom, 0 beyond the region.
/// For each internal pixel it is told what weights the splat filter gives to the rays that meet something, and to all. A filter
/// with negative lobes takes it a little below 0 and above 1 beside edges, just as it does the light: what is
/// laid over another picture by it stays right. Runs on the caller's rayon pool.
pub fn coverage(size: FilmSize, weights: &[[f32; 2]], filter: Filter, region: Option<Region>) -> Vec<f32> {
    let region = Region::or_whole(region, size);
    let window = Window::of(size, region);
    let pixels = downsize(size, region, filter, |y, out| {
        let row = weights.chunks_exact(size.internal_width() as usize).nth(window.top + y);
        let row = &row.unwrap_or_default()[window.left..][..window.width];
        out.iter_mut().zip(row).for_each(|(out, &[met, all])| *out = [met, all, 0.0, 0.0]);
    });
    // The ratio of both sums: what is all covered is so exactly, however few the rays.
    let part = |[met, all, ..]: [f32; 4]| if all > 0.0 { met / all } else { 0.0 };
    framed(size, region, pixels).into_iter().map(part).collect()
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
    for v in pixels.as_flattened_mut() {
        *v = if *v > 0.0 { v.min(1.0) } else { 0.0 };
    }
}

/// The same on the caller's rayon pool.
fn clamp_all(pixels: &mut [[f32; 4]]) {
    /// Enough to be worth a task.
    const TOGETHER: usize = 1 << 14;
    pixels.par_chunks_mut(TOGETHER).for_each(clamp);
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
