//! Writing a film.

use super::blocks::{self, Precision};
use super::{IMAGE, MAGIC, MARK, PADDING, PARCEL_MARK, SECTION_VERSION, VERSION};
use crate::record::FilmRecord;
use crate::{FilmState, Layer, LayerKind};
use std::io::{self, Write};

/// Writes a film with its record. The memory that this takes does not grow with the film, but for the image
/// of version 1 that every file begins with: 16 bytes per internal pixel.
///
/// # Errors
/// Those of `out`.
pub fn write(out: &mut impl Write, film: &FilmState, record: &FilmRecord) -> io::Result<()> {
    let mut out = Hashing { out, hasher: blake3::Hasher::new() };
    write_image(&mut out, film, record)?;
    write_section(&mut out, film, record, Precision::Double)?;
    out.finish()
}

/// Writes a film for another machine to add to its own, once: the film section alone, with sums in single precision, as
/// all samples are gathered anyhow. That is a quarter of a file's bytes, or less. Counts stay exact.
///
/// # Errors
/// Those of `out`.
pub fn write_parcel(out: &mut impl Write, film: &FilmState, record: &FilmRecord) -> io::Result<()> {
    out.write_all(&PARCEL_MARK)?;
    let size = film.size;
    for v in [SECTION_VERSION, size.internal_width(), size.internal_height(), size.super_sample()] {
        out.write_all(&v.to_le_bytes())?;
    }
    write_section(out, film, record, Precision::Single)
}

/// The record and the layers.
fn write_section(
    out: &mut impl Write,
    film: &FilmState,
    record: &FilmRecord,
    precision: Precision,
) -> io::Result<()> {
    write_record(out, film, record)?;
    film.layers.iter().try_for_each(|layer| write_layer(out, layer, precision))
}

/// The part that is version 1.
fn write_image(out: &mut impl Write, film: &FilmState, record: &FilmRecord) -> io::Result<()> {
    let size = film.size;
    // More than the format's 31 bits can say is left to readers to work out.
    let length = i32::try_from(size.internal_pixels() * 12).unwrap_or(0);
    let mut header = Vec::with_capacity(IMAGE);
    header.extend(MAGIC.to_le_bytes());
    header.extend(VERSION.to_le_bytes());
    header.extend((record.samples as f64).to_le_bytes());
    for v in [size.internal_width(), size.internal_height(), size.super_sample(), 0] {
        header.extend(v.to_le_bytes());
    }
    header.extend(length.to_le_bytes());
    header.extend(0u32.to_le_bytes());
    debug_assert_eq!(header.len(), PADDING);
    header.extend(MARK);
    header.extend(SECTION_VERSION.to_le_bytes());
    header.resize(IMAGE, 0);
    out.write_all(&header)?;
    let scale = (record.samples as f64 / size.pixels() as f64) as f32;
    let mut row = Vec::with_capacity(size.internal_width() as usize * 12);
    for pixels in film.develop().pixels.chunks(size.internal_width() as usize) {
        row.clear();
        for v in pixels.iter().flat_map(|p| &p[..3]) {
            row.extend((v * scale).to_le_bytes());
        }
        out.write_all(&row)?;
    }
    Ok(())
}

fn write_record(out: &mut impl Write, film: &FilmState, record: &FilmRecord) -> io::Result<()> {
    write_text(out, &record.program)?;
    write_text(out, &record.scene_path)?;
    out.write_all(&record.scene_hash)?;
    write_count(out, record.settings.len())?;
    for (name, value) in &record.settings {
        write_text(out, name)?;
        write_text(out, value)?;
    }
    write_count(out, record.runs.len())?;
    for run in &record.runs {
        for v in [run.seed, run.first, run.end] {
            out.write_all(&v.to_le_bytes())?;
        }
    }
    out.write_all(&record.samples.to_le_bytes())?;
    out.write_all(&record.elapsed_s.to_le_bytes())?;
    out.write_all(&film.refused.to_le_bytes())?;
    write_count(out, film.layers.len())
}

fn write_layer(out: &mut impl Write, layer: &Layer, precision: Precision) -> io::Result<()> {
    let kind: u32 = match layer.kind {
        LayerKind::PerPixel => 0,
        LayerKind::PerScreen => 1,
    };
    out.write_all(&kind.to_le_bytes())?;
    write_text(out, &layer.name)?;
    let totals = &layer.totals;
    for v in [totals.n_samples, totals.n_idle, totals.b_sum, totals.b_count] {
        out.write_all(&v.to_le_bytes())?;
    }
    blocks::write(out, precision, layer.sums.as_flattened().iter().copied())?;
    blocks::write(out, Precision::Double, layer.counts.iter().copied())
}

fn write_text(out: &mut impl Write, text: &str) -> io::Result<()> {
    write_count(out, text.len())?;
    out.write_all(text.as_bytes())
}

fn write_count(out: &mut impl Write, n: usize) -> io::Result<()> {
    let n = u32::try_from(n).map_err(|_| io::Error::other("a text or list is too long for the file"))?;
    out.write_all(&n.to_le_bytes())
}

/// Hashes what passes through.
struct Hashing<'a, W> {
    out: &'a mut W,
    hasher: blake3::Hasher,
}

impl<W: Write> Hashing<'_, W> {
    /// Writes the hash of all that passed.
    fn finish(self) -> io::Result<()> {
        self.out.write_all(self.hasher.finalize().as_bytes())
    }
}

impl<W: Write> Write for Hashing<'_, W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let n = self.out.write(bytes)?;
        self.hasher.update(&bytes[..n]);
        Ok(n)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.out.flush()
    }
}
