//! One picture in every form in which a file may hold it.

use super::by_hand::{Container, Page, lzw};
use super::*;

/// Texels of the picture: not as many as a byte of packed bits or a tile has.
const COLUMNS: u32 = 5;
const ROWS: u32 = 3;
const TILE: u32 = 16;

const HORIZONTAL: u32 = 2;
const FLOATING_POINT: u32 = 3;

#[derive(Clone, Copy, Debug, PartialEq)]
enum Sample {
    Byte,
    Word,
    Half,
    Single,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Layout {
    Strips,
    Tiles,
    Planes,
}

#[derive(Clone, Copy, Debug)]
struct Kind {
    container: Container,
    sample: Sample,
    channels: u32,
    layout: Layout,
    /// Differences of samples, compressed by LZW: plain samples, not compressed, without.
    is_predicted: bool,
    is_white_zero: bool,
}

const PLAIN: Kind = Kind {
    container: Container { is_big_endian: false, is_big: false },
    sample: Sample::Byte,
    channels: 1,
    layout: Layout::Strips,
    is_predicted: false,
    is_white_zero: false,
};

impl Sample {
    fn bytes(self) -> usize {
        match self {
            Self::Byte => 1,
            Self::Word | Self::Half => 2,
            Self::Single => 4,
        }
    }

    fn is_float(self) -> bool {
        matches!(self, Self::Half | Self::Single)
    }

    /// The bits of the sample of a number.
    fn bits(self, i: u8) -> u32 {
        let i = u32::from(i);
        match self {
            Self::Byte => i,
            Self::Word => 259 * i,
            // From 2 to the power of -14 on.
            Self::Half => 1024 + 100 * i,
            Self::Single => (i as f32 / 3.0 - 20.0).to_bits(),
        }
    }
}

impl Kind {
    /// The samples of a row, those of a texel together.
    fn row(self, row: u32) -> Vec<u32> {
        let n = COLUMNS * self.channels;
        (row * n..(row + 1) * n).map(|i| self.sample.bits((i * 37 % 256) as u8)).collect()
    }

    /// What is to be read.
    fn pixels(self) -> Pixels {
        let bits: Vec<u32> = (0..ROWS).flat_map(|row| self.row(row)).collect();
        let is_inverse = self.is_white_zero;
        let whole = |most: u32| bits.iter().map(move |&v| if is_inverse { most - v } else { v });
        match self.sample {
            Sample::Byte => Pixels::U8(whole(0xFF).map(|v| v as u8).collect()),
            Sample::Word => Pixels::U16(whole(0xFFFF).map(|v| v as u16).collect()),
            // IEEE 754: an exponent of 5 bits that is biased by 15 becomes one of 8 biased by 127.
            Sample::Half => {
                Pixels::F32(bits.iter().map(|v| f32::from_bits((v << 13) + (112 << 23))).collect())
            }
            Sample::Single => {
                let values = bits.iter().map(|v| f32::from_bits(*v));
                Pixels::F32(values.map(|v| if is_inverse { 1.0 - v } else { v }).collect())
            }
        }
    }

    fn file(self) -> Vec<u8> {
        let mut page = Page::new(COLUMNS, ROWS, self.channels)
            .tag(Tag::BitsPerSample, 8 * self.sample.bytes() as u32)
            .tag(Tag::SampleFormat, if self.sample.is_float() { FLOAT } else { UNSIGNED }.into());
        if self.is_white_zero {
            page = page.tag(Tag::PhotometricInterpretation, WHITE_IS_ZERO.into());
        }
        if self.is_predicted {
            let predictor = if self.sample.is_float() { FLOATING_POINT } else { HORIZONTAL };
            page = page.tag(Tag::Compression, 5).tag(Tag::Predictor, predictor);
        }
        let all = self.channels as usize;
        let rows = || (0..ROWS).map(|row| self.row(row));
        match self.layout {
            // Two of two rows, of which the second has one.
            Layout::Strips => {
                page = page.tag(Tag::RowsPerStrip, 2);
                let rows: Vec<_> = rows().collect();
                rows.chunks(2).fold(page, |page, rows| page.chunk(&self.chunk(rows, all)))
            }
            Layout::Tiles => {
                let mut rows: Vec<_> = rows().collect();
                // What pads a tile is nothing that may be seen.
                rows.resize(TILE as usize, vec![]);
                for row in &mut rows {
                    row.resize(TILE as usize * all, self.sample.bits(99));
                }
                page.tiled(TILE).chunk(&self.chunk(&rows, all))
            }
            Layout::Planes => (0..all).fold(page.tag(Tag::PlanarConfiguration, 2), |page, channel| {
                let of_channel = |row: Vec<u32>| row.into_iter().skip(channel).step_by(all).collect();
                let rows: Vec<Vec<u32>> = rows().map(of_channel).collect();
                page.chunk(&self.chunk(&rows, 1))
            }),
        }
        .into_file(self.container)
    }

    /// A strip or tile of rows, of which texels have so many samples.
    fn chunk(self, rows: &[Vec<u32>], samples: usize) -> Vec<u8> {
        let bytes: Vec<u8> = rows.iter().flat_map(|row| self.encoded(row, samples)).collect();
        if self.is_predicted { lzw(&bytes) } else { bytes }
    }

    /// A row as the predictors of TIFF 6.0, section 14, and of Adobe's Technical Note 3 leave it.
    fn encoded(self, row: &[u32], samples: usize) -> Vec<u8> {
        let n = self.sample.bytes();
        let in_order = |values: &[u32]| -> Vec<u8> {
            values.iter().flat_map(|v| self.container.number((*v).into(), n)).collect()
        };
        let differences = |values: Vec<u32>| -> Vec<u32> {
            let before = |i: usize| i.checked_sub(samples).map_or(0, |i| values[i]);
            values.iter().enumerate().map(|(i, v)| v.wrapping_sub(before(i))).collect()
        };
        match (self.is_predicted, self.sample.is_float()) {
            (false, _) => in_order(row),
            (true, false) => in_order(&differences(row.to_vec())),
            // All highest bytes come first, in whatever order the file is, then those that follow.
            (true, true) => {
                let planes = (0..n).rev().flat_map(|byte| row.iter().map(move |v| v >> (8 * byte) & 0xFF));
                differences(planes.collect()).into_iter().map(|v| v as u8).collect()
            }
        }
    }
}

impl Page {
    fn into_file(self, container: Container) -> Vec<u8> {
        container.file(&[self])
    }
}

/// Every kind that can be.
fn kinds() -> Vec<Kind> {
    let mut kinds = vec![PLAIN];
    let mut vary = |with: &dyn Fn(Kind) -> Vec<Kind>| kinds = kinds.iter().copied().flat_map(with).collect();
    vary(&|kind| {
        [(false, false), (false, true), (true, false), (true, true)]
            .map(|(is_big_endian, is_big)| Kind { container: Container { is_big_endian, is_big }, ..kind })
            .to_vec()
    });
    vary(&|kind| {
        let samples = [Sample::Byte, Sample::Word, Sample::Half, Sample::Single];
        samples.map(|sample| Kind { sample, ..kind }).to_vec()
    });
    vary(&|kind| [1, 3].map(|channels| Kind { channels, ..kind }).to_vec());
    vary(&|kind| {
        [Layout::Strips, Layout::Tiles, Layout::Planes].map(|layout| Kind { layout, ..kind }).to_vec()
    });
    vary(&|kind| [false, true].map(|is_predicted| Kind { is_predicted, ..kind }).to_vec());
    vary(&|kind| [false, true].map(|is_white_zero| Kind { is_white_zero, ..kind }).to_vec());
    // Colours have no white of zeros, and of halves it is not read.
    kinds.retain(|kind| !kind.is_white_zero || kind.channels == 1 && kind.sample != Sample::Half);
    kinds
}

#[test]
fn every_form_holds_the_same() {
    for kind in kinds() {
        let image = decode_any("a.tif", &kind.file()).unwrap_or_else(|error| panic!("{kind:?}: {error}"));
        assert_eq!((image.width, image.height), (COLUMNS, ROWS));
        assert_eq!((u32::from(image.channels), image.pixels), (kind.channels, kind.pixels()), "{kind:?}");
        assert!(image.notes.is_empty(), "{kind:?}: {:?}", image.notes);
    }
    let kind = Kind { sample: Sample::Half, is_white_zero: true, ..PLAIN };
    assert!(refusal(&kind.file()).found.contains("of halves"));
}

/// What fuzzing begins with: a file of each part of the decoder. `INDIGO_BLESS=1` writes them anew.
#[test]
fn seeds_of_fuzzing_are_these() {
    let big_endian = Container { is_big_endian: true, is_big: false };
    let big = Container { is_big_endian: false, is_big: true };
    let fewer_bits =
        |bits: u32, rows: &[u8]| Page::new(COLUMNS, ROWS, 1).tag(Tag::BitsPerSample, bits).chunk(rows).file();
    let with_alpha = Page::new(2, 1, 4).tag(Tag::ExtraSamples, 2).chunk(&[1, 2, 3, 200, 4, 5, 6, 100]).file();
    let pages = Container::default().file(&[
        Page::new(2, 1, 1).chunk(&[7, 9]),
        Page::new(1, 1, 1).tag(Tag::NewSubfileType, REDUCED).chunk(&[8]),
        Page::new(1, 1, 1).tag(Tag::Orientation, 3).chunk(&[5]),
    ]);
    for (name, file) in [
        ("tiles", Kind { layout: Layout::Tiles, is_predicted: true, ..PLAIN }.file()),
        ("planes", Kind { layout: Layout::Planes, channels: 3, sample: Sample::Word, ..PLAIN }.file()),
        ("lzw_differences", Kind { is_predicted: true, channels: 3, sample: Sample::Word, ..PLAIN }.file()),
        ("lzw_differences_of_floats", Kind { is_predicted: true, sample: Sample::Single, ..PLAIN }.file()),
        ("halves", Kind { sample: Sample::Half, channels: 3, ..PLAIN }.file()),
        ("white_is_zero", Kind { is_white_zero: true, ..PLAIN }.file()),
        ("big_endian", Kind { container: big_endian, sample: Sample::Word, ..PLAIN }.file()),
        ("big", Kind { container: big, ..PLAIN }.file()),
        ("one_bit", fewer_bits(1, &[0b1010_1000, 0, 0b1111_1000])),
        ("four_bits", fewer_bits(4, &[0x12, 0x34, 0x50, 0x67, 0x89, 0xA0, 0xBC, 0xDE, 0xF0])),
        ("alpha", with_alpha),
        ("pages", pages),
    ] {
        assert!(decode_any("a.tif", &file).is_ok(), "{name}");
        let path = format!("{}/../../fuzz/seeds/picture/{name}.tif", env!("CARGO_MANIFEST_DIR"));
        if std::env::var_os("INDIGO_BLESS").is_some() {
            std::fs::write(&path, &file).unwrap();
        }
        assert!(std::fs::read(&path).is_ok_and(|kept| kept == file), "{path} is another");
    }
}
