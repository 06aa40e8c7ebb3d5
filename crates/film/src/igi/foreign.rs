//! Indigo images of other programs, as far as their layout is known. All of them hold XYZ sums, which are
//! divided by the samples per output pixel, or radiance itself where the number of samples is 0 or 1.

use super::bytes::Bytes;
use super::read::internal_size;
use super::{IMAGE, IgiError, MAX_LAYERS};
use crate::record::SavedFilm;
use crate::{FilmSize, FilmState, LayerKind};

/// Output pixels round the picture that versions 7 and 8 hold besides.
const MARGIN: u32 = 4;
/// Mark of the only section that versions 7 and 8 are known to have.
const LAYERS: u32 = 100;

/// Version 1, from behind its number.
pub(super) fn read_version_1(bytes: &mut Bytes<'_>) -> Result<SavedFilm, IgiError> {
    const WHAT: &str = "the header";
    let samples = bytes.f64(WHAT)?;
    let (width, height, factor) = (bytes.u32(WHAT)?, bytes.u32(WHAT)?, bytes.u32(WHAT)?);
    let (is_packed, length, colours) = (bytes.u32(WHAT)?, bytes.u32(WHAT)?, bytes.u32(WHAT)?);
    if is_packed != 0 {
        return Err(IgiError::Malformed("compressed images of version 1 cannot be read"));
    }
    if colours != 0 {
        return Err(IgiError::Malformed("the image is not in XYZ"));
    }
    let size = internal_size(width, height, factor)?;
    // What 31 bits cannot say is left at 0.
    if length != 0 && length as usize != size.internal_pixels() * 12 {
        return Err(IgiError::Malformed("the length of the image is not that of its width and height"));
    }
    bytes.take(IMAGE - super::PADDING, WHAT)?;
    let mut film = empty(size, samples, bytes.0.len() / 12)?;
    add_image(&mut film, bytes, size.internal_width(), [0, 0])?;
    Ok(SavedFilm { film, record: None })
}

/// Versions 7 and 8, from behind their number.
pub(super) fn read_version_7(bytes: &mut Bytes<'_>, version: u32) -> Result<SavedFilm, IgiError> {
    const WHAT: &str = "the header";
    let samples = bytes.f64(WHAT)?;
    let size = FilmSize::new(bytes.u32(WHAT)?, bytes.u32(WHAT)?, bytes.u32(WHAT)?)?;
    let _seconds = bytes.f64(WHAT)?;
    let _zero = bytes.u32(WHAT)?;
    let _scene = bytes.foreign_text("the scene's path")?;
    if version >= 8 {
        bytes.foreign_text("the scene's settings")?;
    }
    let mut film = empty(size, samples, bytes.0.len() / 12)?;
    let sections = bytes.u32(WHAT)?;
    for _ in 0..sections {
        if bytes.u32("a section")? != LAYERS {
            return Err(IgiError::Malformed("a section is of no known kind"));
        }
        bytes.foreign_text("a section")?;
        let layers = bytes.u32("a section")? as usize;
        if layers > MAX_LAYERS {
            return Err(IgiError::Malformed("there are too many layers"));
        }
        for _ in 0..layers {
            add_layer(&mut film, bytes)?;
        }
    }
    Ok(SavedFilm { film, record: None })
}

/// A layer of versions 7 and 8: light that adds to that of the others, with a margin.
fn add_layer(film: &mut FilmState, bytes: &mut Bytes<'_>) -> Result<(), IgiError> {
    const WHAT: &str = "a layer";
    bytes.foreign_text(WHAT)?;
    let _one = bytes.u32(WHAT)?;
    let (width, height) = (bytes.u32(WHAT)?, bytes.u32(WHAT)?);
    let (size, margin) = (film.size, MARGIN * film.size.super_sample());
    let expected = [size.internal_width() + 2 * margin, size.internal_height() + 2 * margin];
    if [width, height] != expected {
        return Err(IgiError::Malformed("a layer's size is not that of the picture with its margin"));
    }
    add_image(film, bytes, width, [margin, margin])?;
    let below = u64::from(width) * u64::from(margin) * 12;
    bytes.take(usize::try_from(below).map_err(|_| IgiError::Truncated(WHAT))?, WHAT)?;
    Ok(())
}

/// A film without light whose sums are divided by the samples per output pixel. `available` is the number of
/// pixels that the file can hold, at least as many as it must.
fn empty(size: FilmSize, samples: f64, available: usize) -> Result<FilmState, IgiError> {
    // Programs count samples by 64 bits; the bound keeps light from vanishing by a damaged number.
    if !(0.0..=u64::MAX as f64).contains(&samples) {
        return Err(IgiError::Malformed("the number of samples is no count"));
    }
    if available < size.internal_pixels() {
        return Err(IgiError::Truncated("the image"));
    }
    let per_pixel = if samples > 1.0 { samples / size.pixels() as f64 } else { 1.0 };
    let mut film = FilmState::new(size, &[(LayerKind::PerScreen, "foreign")]);
    film.layers[0].totals.n_samples = per_pixel * size.internal_pixels() as f64;
    Ok(film)
}

/// Adds rows of XYZ that are `width` pixels long, the picture's pixels beginning at a column and row of it.
fn add_image(
    film: &mut FilmState,
    bytes: &mut Bytes<'_>,
    width: u32,
    [x, y]: [u32; 2],
) -> Result<(), IgiError> {
    let wanted = film.size.internal_width() as usize;
    let row_bytes = width as usize * 12;
    for _ in 0..y {
        bytes.take(row_bytes, "the image")?;
    }
    for sums in film.layers[0].sums.chunks_exact_mut(wanted) {
        let row = bytes.take(row_bytes, "the image")?;
        let (pixels, _) = row[x as usize * 12..].as_chunks::<12>();
        for (sum, pixel) in sums.iter_mut().zip(pixels) {
            let (components, _) = pixel.as_chunks::<4>();
            let xyz: [f32; 3] = std::array::from_fn(|i| f32::from_le_bytes(components[i]));
            if xyz.iter().all(|v| v.is_finite()) {
                sum.iter_mut().zip(xyz).for_each(|(s, v)| *s += f64::from(v));
            } else {
                film.refused += 1;
            }
        }
    }
    Ok(())
}
