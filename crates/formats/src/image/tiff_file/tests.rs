use ::tiff::encoder::colortype::{
    CMYK8, ColorType, Gray8, Gray16, Gray32Float, GrayI16, RGB8, RGB16, RGB32, RGB32Float, RGB64Float, RGBA8,
    RGBA16, RGBA32Float, YCbCr8,
};
use ::tiff::encoder::{Compression, DeflateLevel, Predictor, TiffEncoder, TiffValue};
use ::tiff::tags::ExtraSamples;

use super::*;
use crate::image::decode as decode_any;

mod by_hand;
mod forms;

use by_hand::{Container, Page};

const WIDTH: u32 = 2;
const HEIGHT: u32 = 3;
const TEXELS: u32 = WIDTH * HEIGHT;

/// Samples that all differ.
fn samples(per_texel: u32) -> Vec<u8> {
    (0..TEXELS * per_texel).map(|i| 3 + 7 * i as u8).collect()
}

/// A page, with samples beside those of its colour.
fn page<C: ColorType>(values: &[C::Inner], extra: &[ExtraSamples], compression: Compression) -> Vec<u8>
where
    [C::Inner]: TiffValue,
{
    let mut bytes = Cursor::new(Vec::new());
    let mut encoder = TiffEncoder::new(&mut bytes).unwrap().with_compression(compression);
    let mut image = encoder.new_image::<C>(WIDTH, HEIGHT).unwrap();
    image.extra_samples(extra).unwrap();
    image.write_data(values).unwrap();
    bytes.into_inner()
}

fn plain<C: ColorType>(values: &[C::Inner]) -> Vec<u8>
where
    [C::Inner]: TiffValue,
{
    page::<C>(values, &[], Compression::Uncompressed)
}

fn read(file: &[u8]) -> Image {
    let image = decode_any("a.tif", file).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!((image.width, image.height), (WIDTH, HEIGHT));
    image
}

fn refusal(file: &[u8]) -> FormatError {
    decode_any("a.tif", file).unwrap_err()
}

/// The same file with another value of a tag that has one of sixteen bits.
fn with_tag(mut file: Vec<u8>, tag: Tag, value: u16) -> Vec<u8> {
    let [low, high] = tag.to_u16().to_le_bytes();
    let entry = [low, high, 3, 0, 1, 0, 0, 0];
    let at = file.windows(entry.len()).position(|bytes| bytes == entry).expect("the tag");
    file[at + entry.len()..][..2].copy_from_slice(&value.to_le_bytes());
    file
}

#[test]
fn grey_and_colour_of_all_widths() {
    for channels in [1, 3] {
        let bytes = samples(channels);
        let words: Vec<u16> = bytes.iter().map(|&v| u16::from(v) * 250).collect();
        // Beyond what fits into a picture of whole numbers.
        let floats: Vec<f32> = bytes.iter().map(|&v| f32::from(v) - 20.25).collect();
        let files = match channels {
            1 => [plain::<Gray8>(&bytes), plain::<Gray16>(&words), plain::<Gray32Float>(&floats)],
            _ => [plain::<RGB8>(&bytes), plain::<RGB16>(&words), plain::<RGB32Float>(&floats)],
        };
        let expected = [Pixels::U8(bytes), Pixels::U16(words), Pixels::F32(floats)];
        for (file, expected) in files.iter().zip(expected) {
            let image = read(file);
            assert_eq!((u32::from(image.channels), &image.pixels), (channels, &expected));
            assert!(image.notes.is_empty());
        }
    }
}

#[test]
fn compressed_files_hold_the_same() {
    for compression in
        [Compression::Lzw, Compression::Deflate(DeflateLevel::default()), Compression::Packbits]
    {
        let image = read(&page::<RGB8>(&samples(3), &[], compression));
        assert_eq!(image.pixels, Pixels::U8(samples(3)));
    }
}

#[test]
fn an_alpha_is_dropped_and_told_where_it_is_not_opaque() {
    for (alpha, notes) in [(u8::MAX, vec![]), (254, vec![ALPHA])] {
        let with_alpha = |colours: &[u8], channels: usize| -> Vec<u8> {
            let texels = colours.chunks(channels).enumerate();
            texels.flat_map(|(i, texel)| [texel, &[if i == 3 { alpha } else { u8::MAX }]].concat()).collect()
        };
        let (grey, colour) = (with_alpha(&samples(1), 1), with_alpha(&samples(3), 3));
        let words = |bytes: &[u8]| -> Vec<u16> { bytes.iter().map(|&v| u16::from(v) * 257).collect() };
        let floats = |bytes: &[u8]| -> Vec<f32> { bytes.iter().map(|&v| f32::from(v) / 255.0).collect() };
        for kind in [ExtraSamples::AssociatedAlpha, ExtraSamples::UnassociatedAlpha] {
            let none = Compression::Uncompressed;
            for (file, expected) in [
                (page::<Gray8>(&grey, &[kind], none), Pixels::U8(samples(1))),
                (page::<Gray32Float>(&floats(&grey), &[kind], none), Pixels::F32(floats(&samples(1)))),
                (page::<RGB8>(&colour, &[kind], none), Pixels::U8(samples(3))),
                (page::<RGB16>(&words(&colour), &[kind], none), Pixels::U16(words(&samples(3)))),
                (page::<RGB32Float>(&floats(&colour), &[kind], none), Pixels::F32(floats(&samples(3)))),
                // A fourth sample of which nothing is said.
                (plain::<RGBA8>(&colour), Pixels::U8(samples(3))),
                (plain::<RGBA16>(&words(&colour)), Pixels::U16(words(&samples(3)))),
                (plain::<RGBA32Float>(&floats(&colour)), Pixels::F32(floats(&samples(3)))),
            ] {
                let image = read(&file);
                assert_eq!((image.pixels, image.notes), (expected, notes.clone()), "{kind:?}");
            }
        }
    }
}

/// What is no alpha is not taken for one: it is dropped whatever it is.
#[test]
fn samples_that_are_neither_colour_nor_alpha_are_dropped_and_told() {
    use ExtraSamples::{UnassociatedAlpha, Unspecified};
    let first = |per_texel: u32, channels: usize| {
        Pixels::U8(
            samples(per_texel)
                .chunks(per_texel as usize)
                .flat_map(|texel| texel[..channels].to_vec())
                .collect(),
        )
    };
    for (channels, extra, notes) in [
        (1, &[Unspecified][..], vec![FURTHER_SAMPLES]),
        (1, &[Unspecified; 3], vec![FURTHER_SAMPLES]),
        (3, &[Unspecified], vec![FURTHER_SAMPLES]),
        (3, &[Unspecified; 2], vec![FURTHER_SAMPLES]),
        (3, &[UnassociatedAlpha, Unspecified], vec![ALPHA, FURTHER_SAMPLES]),
    ] {
        let per_texel = channels as u32 + extra.len() as u32;
        let values = samples(per_texel);
        for compression in [Compression::Uncompressed, Compression::Lzw] {
            let file = match channels {
                1 => page::<Gray8>(&values, extra, compression),
                _ => page::<RGB8>(&values, extra, compression),
            };
            let image = read(&file);
            assert_eq!((image.pixels, &image.notes), (first(per_texel, channels), &notes), "{extra:?}");
        }
    }
}

/// The decoder would make nonsense of differences over samples that it leaves out.
#[test]
fn differences_are_added_up_or_refused() {
    let file = |extra: &[ExtraSamples]| {
        let mut bytes = Cursor::new(Vec::new());
        let encoder = TiffEncoder::new(&mut bytes).unwrap();
        let mut encoder = encoder.with_compression(Compression::Lzw).with_predictor(Predictor::Horizontal);
        let mut image = encoder.new_image::<RGB8>(WIDTH, HEIGHT).unwrap();
        image.extra_samples(extra).unwrap();
        image.write_data(&samples(3 + extra.len() as u32)).unwrap();
        bytes.into_inner()
    };
    assert_eq!(read(&file(&[])).pixels, Pixels::U8(samples(3)));
    let error = refusal(&file(&[ExtraSamples::Unspecified]));
    assert!(error.found.contains("predictor"), "{error}");
}

#[test]
fn grey_of_few_bits_is_spread_out() {
    // Rows of two texels, each of which begins with a byte.
    for (bits, rows, expected) in [
        (1, [0b1000_0000, 0b0100_0000, 0b1111_1111], [255, 0, 0, 255, 255, 255]),
        (2, [0b0001_0000, 0b1011_0000, 0], [0, 85, 170, 255, 0, 0]),
        (4, [0x0F, 0x18, 0x70], [0, 255, 17, 136, 119, 0]),
    ] {
        // A page of one byte a row, of which another width is told.
        let mut bytes = Cursor::new(Vec::new());
        TiffEncoder::new(&mut bytes).unwrap().write_image::<Gray8>(1, HEIGHT, &rows).unwrap();
        let file = with_tag(bytes.into_inner(), Tag::BitsPerSample, bits);
        let [low, high] = Tag::ImageWidth.to_u16().to_le_bytes();
        let mut file = file;
        let entry = [low, high, 4, 0, 1, 0, 0, 0];
        let at = file.windows(entry.len()).position(|bytes| bytes == entry).expect("a width");
        file[at + entry.len()] = WIDTH as u8;
        assert_eq!(read(&file).pixels, Pixels::U8(expected.to_vec()), "{bits} bits");
        let inverse = with_tag(file, Tag::PhotometricInterpretation, WHITE_IS_ZERO);
        assert_eq!(read(&inverse).pixels, Pixels::U8(expected.map(|v| 255 - v).to_vec()), "{bits} bits");
    }
}

#[test]
fn halves_become_floats() {
    // 1, -2, 0.5, 65504, infinity and the smallest.
    let halves = [0x3C00, 0xC000, 0x3800, 0x7BFF, 0x7C00, 1];
    let file = plain::<Gray16>(&halves);
    let file = with_tag(file, Tag::SampleFormat, FLOAT);
    let expected = [1.0, -2.0, 0.5, 65504.0, f32::INFINITY, 2.0_f32.powi(-24)];
    assert_eq!(read(&file).pixels, Pixels::F32(expected.to_vec()));
}

#[test]
fn the_first_of_several_pages_counts_and_that_is_told() {
    let page = |kind: u32| Page::new(WIDTH, HEIGHT, 1).tag(Tag::NewSubfileType, kind).chunk(&samples(1));
    // Nothing special, a mip map, one page of many, a mask, and a mask of a mip map.
    let [picture, reduced, one_of_many, mask, both] = [0, 1, 2, 4, 5].map(page);
    let unmarked = picture.clone().without(Tag::NewSubfileType);
    for (further, notes) in [
        (vec![], vec![]),
        (vec![unmarked], vec![PAGES]),
        (vec![picture.clone()], vec![PAGES]),
        (vec![one_of_many], vec![PAGES]),
        (vec![reduced.clone(), mask, both], vec![]),
        (vec![reduced.clone(), picture.clone()], vec![PAGES]),
        (vec![reduced.clone(); MOST_PAGES], vec![]),
        (vec![reduced.clone(); MOST_PAGES + 1], vec![PAGES]),
    ] {
        for is_big in [false, true] {
            let container = Container { is_big, ..Container::default() };
            let pages: Vec<Page> = [&picture].into_iter().chain(&further).cloned().collect();
            let file = container.file(&pages);
            let image = read(&file);
            assert_eq!((image.pixels, &image.notes), (Pixels::U8(samples(1)), &notes), "{}", further.len());
        }
    }
}

/// The last page says that the first, itself or one beyond the end follows.
#[test]
fn a_chain_of_pages_may_loop_or_lead_nowhere() {
    let page = |kind: u32| Page::new(WIDTH, HEIGHT, 1).tag(Tag::NewSubfileType, kind).chunk(&samples(1));
    let file = Container::default().file(&[page(1), page(1)]);
    let start = |link: &[u8]| u32::from_le_bytes(link.try_into().unwrap());
    let first = start(&file[4..8]);
    let link = first as usize + 2 + 12 * usize::from(file[first as usize]);
    let second = start(&file[link..link + 4]);
    for next in [first, second, u32::MAX] {
        let mut file = file.clone();
        let end = file.len() - 4;
        file[end..].copy_from_slice(&next.to_le_bytes());
        let image = read(&file);
        assert_eq!((image.pixels, image.notes), (Pixels::U8(samples(1)), vec![PAGES]));
    }
}

/// Planes: all of one channel before the next, with an alpha behind them.
#[test]
fn planes_are_brought_together() {
    let page = Page::new(WIDTH, HEIGHT, 4).tag(Tag::ExtraSamples, 2).tag(Tag::PlanarConfiguration, 2);
    let planes = (0..4).map(|c| samples(4).into_iter().skip(c).step_by(4).collect::<Vec<_>>());
    let image = read(&planes.fold(page, |page, plane| page.chunk(&plane)).file());
    let colours = samples(4).chunks(4).flat_map(|texel| texel[..3].to_vec()).collect();
    assert_eq!((image.pixels, image.notes), (Pixels::U8(colours), vec![ALPHA]));
}

/// In the words of the format, whatever the decoder calls it.
#[test]
fn what_is_not_read_is_named() {
    let colour = || plain::<RGB8>(&samples(3));
    let grey = || plain::<Gray8>(&samples(1));
    for (file, found) in [
        (with_tag(grey(), Tag::PhotometricInterpretation, 3), "colours from a palette"),
        (plain::<CMYK8>(&samples(4)), "inks (CMYK)"),
        (plain::<YCbCr8>(&samples(3)), "luminance and differences of colour (YCbCr)"),
        (with_tag(colour(), Tag::PhotometricInterpretation, 9), "colours of L*a*b*"),
        (with_tag(colour(), Tag::Compression, 7), "compression by JPEG"),
        (with_tag(grey(), Tag::Compression, 50_000), "compression by Zstandard"),
        (plain::<RGB64Float>(&[0.5; 18]), "3 floating-point samples of 64 bits"),
        (plain::<RGB32>(&[7; 18]), "3 unsigned samples of 32 bits"),
        (plain::<GrayI16>(&[7; 6]), "1 signed or other samples of 16 bits"),
        (with_tag(grey(), Tag::BitsPerSample, 12), "1 unsigned samples of 12 bits"),
        (with_tag(grey(), Tag::PhotometricInterpretation, RGB), "1 samples a texel for red, green and blue"),
    ] {
        let error = refusal(&file);
        assert!(error.found == found && error.expected == EXPECTED, "{error}");
    }
}

/// Samples of 32 bits may be whole numbers: as those of single precision they would be nonsense. By the standard they are
/// where nothing is said.
#[test]
fn samples_are_whole_numbers_unless_a_file_says_otherwise() {
    let mut file = plain::<RGB32>(&[1 << 31; 18]);
    // Another tag in place of the one that says it, 339 of type 3.
    let entry = [83, 1, 3, 0];
    let at = file.windows(entry.len()).position(|bytes| bytes == entry).unwrap();
    file[at] += 1;
    let error = refusal(&file);
    assert_eq!(error.found, "3 unsigned samples of 32 bits");
}

/// Before anything is allocated for what a file says of itself.
#[test]
fn what_is_cut_off_or_too_large_is_refused() {
    let whole = plain::<RGB8>(&samples(3));
    assert!(refusal(&whole[..whole.len() / 2]).expected.contains("TIFF"));
    let mut wide = whole.clone();
    let [low, high] = Tag::ImageWidth.to_u16().to_le_bytes();
    let entry = [low, high, 4, 0, 1, 0, 0, 0];
    let at = wide.windows(entry.len()).position(|bytes| bytes == entry).unwrap() + entry.len();
    for (side, expected) in [(40_000_u32, "1 to 32768 texels"), (30_000, "a whole TIFF file")] {
        wide[at..at + 4].copy_from_slice(&side.to_le_bytes());
        assert!(refusal(&wide).expected.contains(expected), "{}", refusal(&wide));
    }
}

#[test]
fn tiles_are_cut_to_the_picture() {
    let data: Vec<u8> = (0..256).flat_map(|i| [i as u8, 7, 9]).collect();
    let image = read(&Page::new(WIDTH, HEIGHT, 3).tiled(16).chunk(&data).file());
    let expected = [0, 1, 16, 17, 32, 33].map(|i| [i, 7, 9]).concat();
    assert_eq!(image.pixels, Pixels::U8(expected));
}

/// The decoder would write the padding of a tile over the texels beside it.
#[test]
fn tiles_with_further_samples_are_refused() {
    for samples in [4, 5] {
        let page = Page::new(WIDTH, HEIGHT, samples).tiled(16).tag(Tag::ExtraSamples, 0);
        let error = refusal(&page.chunk(&vec![3; 256 * samples as usize]).file());
        assert!(error.found.contains("neither colour nor alpha"), "{}", error.found);
    }
}

/// The decoder takes for an alpha what these tags do not.
#[test]
fn samples_that_the_tags_do_not_tell_of_are_refused() {
    let page = Page::new(WIDTH, HEIGHT, 5).tag(Tag::ExtraSamples, 0);
    let error = refusal(&page.chunk(&vec![3; 5 * TEXELS as usize]).file());
    assert!(error.found.contains("4 samples a texel of which its tags tell of 3"), "{}", error.found);
}

/// A row of a tile is held whole, however small the picture: such a file of 200 bytes asks for a petabyte.
#[test]
fn a_small_file_takes_little_memory() {
    let page = Page::new(WIDTH, HEIGHT, 65_535)
        .tag(Tag::PhotometricInterpretation, BLACK_IS_ZERO.into())
        .tag(Tag::BitsPerSample, 32)
        .tag(Tag::SampleFormat, FLOAT.into())
        .tag(Tag::Compression, 5)
        .tag(Tag::Predictor, 3)
        .tag(Tag::TileWidth, u32::MAX / 16 * 16)
        .tag(Tag::TileLength, 16);
    let error = refusal(&page.chunk(&[0; 16]).file());
    assert_eq!(error.found, cut_off().found);
}

#[test]
fn rows_in_another_order_are_told_of() {
    let page = || Page::new(WIDTH, HEIGHT, 1).chunk(&samples(1));
    assert_eq!(read(&page().file()).notes, [""; 0]);
    // 0 and 9 are none of the standard's.
    for orientation in 0..=9 {
        let image = read(&page().tag(Tag::Orientation, orientation).file());
        let is_turned = (2..=8).contains(&orientation);
        let notes = if is_turned { vec![ORIENTATION] } else { vec![] };
        assert_eq!((image.pixels, image.notes), (Pixels::U8(samples(1)), notes), "{orientation}");
    }
}

/// By the standard a page has to say what its samples are; the decoder holds it to that.
#[test]
fn samples_of_an_unknown_kind_are_refused() {
    let page = || Page::new(WIDTH, HEIGHT, 1).chunk(&samples(1));
    for page in
        [page().without(Tag::PhotometricInterpretation), page().tag(Tag::PhotometricInterpretation, 32_803)]
    {
        let error = refusal(&page.file());
        assert_eq!(
            (error.expected.as_str(), error.found.as_str()),
            (EXPECTED, "unknown photometric interpretation")
        );
    }
}
