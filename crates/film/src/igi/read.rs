//! Reading a film, with nothing in the file believed.

use super::blocks::{BLOCK, Packed, Precision, Scratch};
use super::bytes::Bytes;
use super::foreign;
use super::{HASH, IMAGE, IgiError, MAGIC, MARK, MAX_LAYERS, PADDING, PARCEL_MARK, SECTION_VERSION, VERSION};
use crate::band::develop_layer;
use crate::record::{DevelopedFilm, FilmRecord, Run, SavedFilm};
use crate::{FilmSize, FilmState, Layer, LayerKind, LightMix, Totals, XyzImage};
use indigo_math::pages::{self, fresh};
use std::io::{self, Read};

/// Reads an Indigo image, of this program or another, from its bytes. Runs on the caller's rayon pool.
///
/// # Errors
/// See [`IgiError`]: no content of a file is taken on trust.
pub fn read(file: &[u8]) -> Result<SavedFilm, IgiError> {
    // A slice cannot fail to be read.
    IgiFile::load(file, file.len() as u64).map_err(|_| IgiError::NotIgi)?.film()
}

/// An Indigo image in memory, of this program or another, nothing of which has been believed or unpacked yet.
#[derive(Debug)]
pub struct IgiFile {
    /// The file; one with the mark without the image that it holds for other programs.
    bytes: Vec<u8>,
    /// What is known of a file with the mark up to that image's end.
    own: Option<Start>,
}

/// The hash up to some place of a file, and how much of an image came before.
#[derive(Debug)]
struct Start {
    hasher: blake3::Hasher,
    image: u64,
}

impl IgiFile {
    /// What is read at once and not kept: little enough for the processor's cache, much for a hash by many lanes.
    const BUFFER: usize = 1 << 17;

    /// Loads a file that is thought to have so many bytes.
    ///
    /// # Errors
    /// What the reader says.
    pub fn load(mut file: impl Read, length: u64) -> io::Result<Self> {
        let mut head = Vec::with_capacity(IMAGE);
        file.by_ref().take(IMAGE as u64).read_to_end(&mut head)?;
        let mut own = None;
        if let (true, Ok(size)) = (has_mark(&head), own_size(&head)) {
            let mut hasher = blake3::Hasher::new();
            hasher.update(&head);
            // Nobody here looks at it: what it holds follows in full. It is not even kept.
            let mut image = file.by_ref().take(size.internal_pixels() as u64 * 12);
            let mut buffer = vec![0; Self::BUFFER];
            loop {
                match image.read(&mut buffer) {
                    Ok(0) => break,
                    Ok(n) => {
                        hasher.update(&buffer[..n]);
                    }
                    Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                    Err(error) => return Err(error),
                }
            }
            own = Some(Start { image: hasher.count() - head.len() as u64, hasher });
        }
        let rest = length.saturating_sub(own.as_ref().map_or(0, |start| start.image));
        let mut bytes = pages::with_capacity(rest as usize);
        bytes.append(&mut head);
        file.read_to_end(&mut bytes)?;
        Ok(Self { bytes, own })
    }

    /// The film. Runs on the caller's rayon pool.
    ///
    /// # Errors
    /// See [`IgiError`].
    pub fn film(&self) -> Result<SavedFilm, IgiError> {
        match &self.own {
            Some(start) => self.checked(start, Content::unpack),
            None => read_without_mark(&self.bytes),
        }
    }

    /// The film developed: the same as developing [`Self::film`] with a mix of its lights, but its sums, three times as large as the image, are
    /// nowhere all at once. Runs on the caller's rayon pool.
    ///
    /// # Errors
    /// See [`IgiError`].
    pub fn develop(&self, mix: &LightMix) -> Result<DevelopedFilm, IgiError> {
        if let Some(start) = &self.own {
            return self.checked(start, |content| content.develop(mix));
        }
        let SavedFilm { film, record } = read_without_mark(&self.bytes)?;
        Ok(DevelopedFilm { image: film.develop_mixed(mix, |_| true), record, refused: film.refused })
    }

    /// Makes something of the content of a file with the mark while its hash is computed.
    fn checked<'a, T: Send>(
        &'a self,
        start: &Start,
        make: impl FnOnce(Content<'a>) -> Result<T, IgiError> + Send,
    ) -> Result<T, IgiError> {
        let section = u32::from_le_bytes(fixed(&self.bytes, PADDING + MARK.len())?);
        if section != SECTION_VERSION {
            return Err(IgiError::Section(section));
        }
        let split = self.bytes.len().checked_sub(HASH).filter(|&n| n >= IMAGE);
        let (content, hash) =
            split.map(|n| self.bytes.split_at(n)).ok_or(IgiError::Truncated("the image"))?;
        let read = || Content::read(content, start.image).and_then(make);
        let (found, made) = rayon::join(|| start.hasher.clone().update(&content[IMAGE..]).finalize(), read);
        if found.as_bytes() != hash {
            return Err(IgiError::Checksum);
        }
        made
    }
}

/// Reads what [`write_parcel`](super::write_parcel) has written. Runs on the caller's rayon pool.
///
/// # Errors
/// See [`IgiError`]: what comes from another machine is believed as little as a file. Its memory is bounded by the size
/// of the film that it says it is, of which it must hold a part: see [`parcel_size`] for who wants no other.
pub fn read_parcel(parcel: &[u8]) -> Result<SavedFilm, IgiError> {
    let size = parcel_size(parcel)?;
    parcel_content(parcel, size)?.unpack()
}

/// The content of a parcel of that size, nothing of which has been unpacked yet.
pub(super) fn parcel_content(parcel: &[u8], size: FilmSize) -> Result<Content<'_>, IgiError> {
    let mut bytes = Bytes(parcel);
    bytes.take(PARCEL_HEADER, "the header")?;
    Content::read_section(bytes, size, Precision::Single)
}

/// Bytes before the film section of a parcel.
const PARCEL_HEADER: usize = PARCEL_MARK.len() + 4 * size_of::<u32>();

/// The size of the film that a parcel says it is.
///
/// # Errors
/// Where it is no parcel, or of another version.
pub fn parcel_size(parcel: &[u8]) -> Result<FilmSize, IgiError> {
    if !parcel.starts_with(&PARCEL_MARK) {
        return Err(IgiError::NotIgi);
    }
    let at = |n: usize| fixed(parcel, PARCEL_MARK.len() + n * size_of::<u32>()).map(u32::from_le_bytes);
    match at(0)? {
        SECTION_VERSION => internal_size(at(1)?, at(2)?, at(3)?),
        other => Err(IgiError::Section(other)),
    }
}

fn has_mark(file: &[u8]) -> bool {
    bytes_of_mark(file) == MARK.len()
}

/// Of a file of version 1, how many bytes are those of the mark where that would stand.
fn bytes_of_mark(file: &[u8]) -> usize {
    let numbers = [MAGIC, VERSION].map(u32::to_le_bytes);
    let place = file.get(PADDING..PADDING + MARK.len()).filter(|_| file.starts_with(numbers.as_flattened()));
    place.map_or(0, |found| found.iter().zip(&MARK).filter(|(found, expected)| found == expected).count())
}

/// Reads a file that has not the mark, or no size to go with it.
fn read_without_mark(file: &[u8]) -> Result<SavedFilm, IgiError> {
    if has_mark(file) {
        own_size(file)?;
    }
    // Half of a mark is no chance. The rest of it is damaged, which no hash tells: without a mark nobody looks for one.
    if (MARK.len() / 2..MARK.len()).contains(&bytes_of_mark(file)) {
        return Err(IgiError::Checksum);
    }
    let mut bytes = Bytes(file);
    let start = |b: &mut Bytes<'_>| Ok((b.u32("the first bytes")?, b.u32("the first bytes")?));
    let (magic, version) = start(&mut bytes).map_err(|_: IgiError| IgiError::NotIgi)?;
    match (magic, version) {
        (MAGIC, 1) => foreign::read_version_1(&mut bytes),
        (MAGIC, 7 | 8) => foreign::read_version_7(&mut bytes, version),
        (MAGIC, other) => Err(IgiError::Version(other)),
        _ => Err(IgiError::NotIgi),
    }
}

/// What a file with the mark holds, not unpacked yet.
pub(super) struct Content<'a> {
    pub size: FilmSize,
    pub record: FilmRecord,
    pub refused: u64,
    pub layers: Vec<PackedLayer<'a>>,
}

impl<'a> Content<'a> {
    /// Of a file without its image, which had so many bytes, and without the hash at its end, which nobody has looked at
    /// yet.
    fn read(content: &'a [u8], image: u64) -> Result<Self, IgiError> {
        let size = own_size(content)?;
        let mut bytes = Bytes(content);
        bytes.take(IMAGE, "the header")?;
        if image != size.internal_pixels() as u64 * 12 {
            return Err(IgiError::Truncated("the image"));
        }
        Self::read_section(bytes, size, Precision::Double)
    }

    /// The film section, of a file or a parcel.
    fn read_section(mut bytes: Bytes<'a>, size: FilmSize, precision: Precision) -> Result<Self, IgiError> {
        let record = read_record(&mut bytes)?;
        let refused = bytes.u64("the record")?;
        let count = bytes.u32("the record")? as usize;
        if count > MAX_LAYERS {
            return Err(IgiError::Malformed("there are too many layers"));
        }
        // What is missing is noticed before room is made for any of it.
        let layers =
            (0..count).map(|_| PackedLayer::read(&mut bytes, size, precision)).collect::<Result<_, _>>()?;
        if !bytes.0.is_empty() {
            return Err(IgiError::Malformed("something follows the last layer"));
        }
        Ok(Self { size, record, refused, layers })
    }

    fn unpack(self) -> Result<SavedFilm, IgiError> {
        let Self { size, record, refused, layers } = self;
        let layers = layers.into_iter().map(|layer| layer.unpack(size)).collect::<Result<_, _>>()?;
        Ok(SavedFilm { film: FilmState { size, layers, refused }, record: Some(record) })
    }

    fn develop(self, mix: &LightMix) -> Result<DevelopedFilm, IgiError> {
        let Self { size, record, refused, layers } = self;
        let gains: Vec<f64> = layers.iter().map(|layer| mix.gain(&layer.name)).collect();
        let counted = layers.iter().any(|layer| layer.kind == LayerKind::PerPixel);
        let image = XyzImage::from_chunks(size, counted, BLOCK, Room::default, |room, i, out, missing| {
            let mut mixed = layers.iter().zip(&gains);
            mixed.try_for_each(|(layer, gain)| layer.develop(*gain, size, i, room, (out, missing)))
        })?;
        Ok(DevelopedFilm { image, record: Some(record), refused })
    }
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

/// A layer whose sums and counts are still packed.
pub(super) struct PackedLayer<'a> {
    pub kind: LayerKind,
    pub name: String,
    pub totals: Totals,
    pub sums: Packed<'a>,
    pub counts: Packed<'a>,
}

/// What unpacking needs room for.
#[derive(Default)]
struct Room {
    scratch: Scratch,
    sums: Vec<[f64; 4]>,
    counts: Vec<f64>,
}

impl<'a> PackedLayer<'a> {
    fn read(bytes: &mut Bytes<'a>, size: FilmSize, precision: Precision) -> Result<Self, IgiError> {
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
        let sums = Packed::take(bytes, precision, 4 * pixels)?;
        let counts = Packed::take(bytes, Precision::Double, kind.count_slots(pixels))?;
        Ok(Self { kind, name, totals, sums, counts })
    }

    fn unpack(self, size: FilmSize) -> Result<Layer, IgiError> {
        let Self { kind, name, totals, sums: packed_sums, counts: packed_counts } = self;
        let pixels = size.internal_pixels();
        let mut sums = fresh(vec![[0.0; 4]; pixels]);
        packed_sums.unpack(sums.as_flattened_mut())?;
        let mut counts = fresh(vec![0.0; kind.count_slots(pixels)]);
        packed_counts.unpack(&mut counts)?;
        check_counts(&counts)?;
        Ok(Layer { kind, name, sums, counts, totals })
    }

    /// Adds the radiance of block `i` of pixels, as many as a block of counts has.
    fn develop(
        &self,
        gain: f64,
        size: FilmSize,
        i: usize,
        room: &mut Room,
        (out, missing): (&mut [[f32; 4]], &mut [bool]),
    ) -> Result<(), IgiError> {
        /// Blocks of sums to one of counts, and the pixels of each.
        const PARTS: usize = 4;
        const PART: usize = BLOCK / PARTS;
        let Room { scratch, sums, counts } = room;
        counts.resize(self.kind.count_slots(out.len()), 0.0);
        if !counts.is_empty() {
            self.counts.unpack_block(i, scratch, counts)?;
            check_counts(counts)?;
        }
        for (part, (out, missing)) in out.chunks_mut(PART).zip(missing.chunks_mut(PART)).enumerate() {
            sums.resize(out.len(), [0.0; 4]);
            self.sums.unpack_block(i * PARTS + part, scratch, sums.as_flattened_mut())?;
            let counts = counts.get(part * PART..).unwrap_or_default();
            let (is, rows) = ((self.kind, &self.totals), (&**sums, counts));
            develop_layer(is, gain, size.internal_pixels(), rows, out, missing);
        }
        Ok(())
    }
}

pub(super) fn check_counts(counts: &[f64]) -> Result<(), IgiError> {
    // Without an early end, so that it is done for many at a time.
    if counts.iter().fold(0, |any, n| any | u8::from(*n < 0.0)) > 0 {
        return Err(IgiError::Malformed("a pixel has a negative number of samples"));
    }
    Ok(())
}
