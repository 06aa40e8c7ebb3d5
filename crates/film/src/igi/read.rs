//! Reading a film, with nothing in the file believed.

use super::blocks::Packed;
use super::bytes::Bytes;
use super::foreign;
use super::{HASH, IMAGE, IgiError, MAGIC, MARK, MAX_LAYERS, PADDING, SECTION_VERSION, VERSION};
use crate::record::{FilmRecord, Run, SavedFilm};
use crate::{FilmSize, FilmState, Layer, LayerKind, Totals};
use indigo_math::pages::fresh;

/// Reads an Indigo image, of this program or another. Runs on the caller's rayon pool.
///
/// # Errors
/// See [`IgiError`]: no content of a file is taken on trust.
pub fn read(file: &[u8]) -> Result<SavedFilm, IgiError> {
    let mut bytes = Bytes(file);
    let start = |b: &mut Bytes<'_>| Ok((b.u32("the first bytes")?, b.u32("the first bytes")?));
    let (magic, version) = start(&mut bytes).map_err(|_: IgiError| IgiError::NotIgi)?;
    match (magic, version) {
        (MAGIC, VERSION) if file.get(PADDING..PADDING + MARK.len()) == Some(&MARK) => read_own(file),
        (MAGIC, 1) => foreign::read_version_1(&mut bytes),
        (MAGIC, 7 | 8) => foreign::read_version_7(&mut bytes, version),
        (MAGIC, other) => Err(IgiError::Version(other)),
        _ => Err(IgiError::NotIgi),
    }
}

/// Reads a file with the mark.
fn read_own(file: &[u8]) -> Result<SavedFilm, IgiError> {
    let section = u32::from_le_bytes(fixed(file, PADDING + MARK.len())?);
    if section != SECTION_VERSION {
        return Err(IgiError::Section(section));
    }
    let (content, hash) =
        file.len().checked_sub(HASH).map(|n| file.split_at(n)).ok_or(IgiError::Truncated("the header"))?;
    let (found, film) = rayon::join(|| blake3::hash(content), || read_content(content));
    if found.as_bytes() != hash {
        return Err(IgiError::Checksum);
    }
    film
}

/// Reads a file with the mark, without the hash at its end, which nobody has looked at yet.
fn read_content(content: &[u8]) -> Result<SavedFilm, IgiError> {
    let size = own_size(content)?;
    let mut bytes = Bytes(content);
    bytes.take(IMAGE, "the header")?;
    bytes.take(size.internal_pixels() * 12, "the image")?;
    let record = read_record(&mut bytes)?;
    let refused = bytes.u64("the record")?;
    let count = bytes.u32("the record")? as usize;
    if count > MAX_LAYERS {
        return Err(IgiError::Malformed("there are too many layers"));
    }
    let layers = (0..count).map(|_| read_layer(&mut bytes, size)).collect::<Result<_, _>>()?;
    if !bytes.0.is_empty() {
        return Err(IgiError::Malformed("something follows the last layer"));
    }
    Ok(SavedFilm { film: FilmState { size, layers, refused }, record: Some(record) })
}

/// The size that the header of version 1 tells.
fn own_size(file: &[u8]) -> Result<FilmSize, IgiError> {
    let at = |offset: usize| fixed(file, offset).map(u32::from_le_bytes);
    internal_size(at(16)?, at(20)?, at(24)?)
}

/// A film's size from its internal pixels.
pub(super) fn internal_size(width: u32, height: u32, super_sample: u32) -> Result<FilmSize, IgiError> {
    let factor = super_sample.max(1);
    if !width.is_multiple_of(factor) || !height.is_multiple_of(factor) {
        return Err(IgiError::Malformed("the super-sampling factor does not divide the size"));
    }
    Ok(FilmSize::new(width / factor, height / factor, factor)?)
}

fn fixed<const N: usize>(file: &[u8], offset: usize) -> Result<[u8; N], IgiError> {
    let found = file.get(offset..).and_then(|rest| rest.first_chunk());
    found.copied().ok_or(IgiError::Truncated("the header"))
}

fn read_record(bytes: &mut Bytes<'_>) -> Result<FilmRecord, IgiError> {
    const WHAT: &str = "the record";
    let (program, scene_path) = (bytes.text(WHAT)?, bytes.text(WHAT)?);
    let scene_hash = bytes.hash()?;
    let settings = bytes.count(8, WHAT)?;
    let settings =
        (0..settings).map(|_| Ok((bytes.text(WHAT)?, bytes.text(WHAT)?))).collect::<Result<_, IgiError>>()?;
    let runs = bytes.count(24, WHAT)?;
    let runs = (0..runs).map(|_| read_run(bytes)).collect::<Result<_, _>>()?;
    let (samples, elapsed_s) = (bytes.u64(WHAT)?, bytes.f64(WHAT)?);
    if !(elapsed_s.is_finite() && elapsed_s >= 0.0) {
        return Err(IgiError::Malformed("the time of rendering is no time"));
    }
    Ok(FilmRecord { program, scene_path, scene_hash, settings, runs, samples, elapsed_s })
}

fn read_run(bytes: &mut Bytes<'_>) -> Result<Run, IgiError> {
    const WHAT: &str = "the record";
    let run = Run { seed: bytes.u64(WHAT)?, first: bytes.u64(WHAT)?, end: bytes.u64(WHAT)? };
    if run.end < run.first { Err(IgiError::Malformed("a run ends before it begins")) } else { Ok(run) }
}

fn read_layer(bytes: &mut Bytes<'_>, size: FilmSize) -> Result<Layer, IgiError> {
    const WHAT: &str = "a layer";
    let kind = match bytes.u32(WHAT)? {
        0 => LayerKind::PerPixel,
        1 => LayerKind::PerScreen,
        _ => return Err(IgiError::Malformed("a layer is of no known kind")),
    };
    let name = bytes.text(WHAT)?;
    let [n_samples, n_idle, b_sum, b_count] =
        [bytes.f64(WHAT)?, bytes.f64(WHAT)?, bytes.f64(WHAT)?, bytes.f64(WHAT)?];
    let totals = Totals { n_samples, n_idle, b_sum, b_count };
    if ![n_samples, n_idle, b_sum, b_count].iter().all(|v| v.is_finite() && *v >= 0.0) {
        return Err(IgiError::Malformed("a number of samples is negative or not finite"));
    }
    let pixels = size.internal_pixels();
    // What is missing is noticed before room is made for it.
    let packed = Packed::take(bytes, 4 * pixels)?;
    let mut sums = fresh(vec![[0.0; 4]; pixels]);
    packed.unpack(sums.as_flattened_mut())?;
    let packed = Packed::take(bytes, kind.count_slots(pixels))?;
    let mut counts = fresh(vec![0.0; kind.count_slots(pixels)]);
    packed.unpack(&mut counts)?;
    if counts.iter().any(|&n| n < 0.0) {
        return Err(IgiError::Malformed("a pixel has a negative number of samples"));
    }
    Ok(Layer { kind, name, sums, counts, totals })
}
