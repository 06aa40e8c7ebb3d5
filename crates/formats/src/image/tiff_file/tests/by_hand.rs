//! Files written by hand, as nobody's encoder writes them: in either order of bytes, with short or long offsets, of any tags.

use ::tiff::tags::Tag;
use std::collections::BTreeMap;

/// How a file writes its numbers.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Container {
    pub is_big_endian: bool,
    /// Offsets of 64 bits: BigTIFF.
    pub is_big: bool,
}

/// A page: its tags, of any numbers each, and its strips or tiles.
#[derive(Clone)]
pub(super) struct Page {
    tags: BTreeMap<u16, Vec<u32>>,
    chunks: Vec<Vec<u8>>,
}

impl Page {
    /// A page of samples of 8 bits, of grey or else of red, green and blue, in one strip unless further tags say otherwise.
    pub fn new(width: u32, height: u32, samples: u32) -> Self {
        let page = Self { tags: BTreeMap::new(), chunks: vec![] };
        page.tag(Tag::ImageWidth, width)
            .tag(Tag::ImageLength, height)
            .tag(Tag::BitsPerSample, 8)
            .tag(Tag::Compression, 1)
            .tag(Tag::PhotometricInterpretation, if samples < 3 { 1 } else { 2 })
            .tag(Tag::SamplesPerPixel, samples)
    }

    pub fn tag(mut self, tag: Tag, value: u32) -> Self {
        self.tags.insert(tag.to_u16(), vec![value]);
        self
    }

    pub fn without(mut self, tag: Tag) -> Self {
        self.tags.remove(&tag.to_u16());
        self
    }

    /// Tiles, of that many texels each way.
    pub fn tiled(self, side: u32) -> Self {
        self.tag(Tag::TileWidth, side).tag(Tag::TileLength, side)
    }

    /// Another strip or tile.
    pub fn chunk(mut self, bytes: &[u8]) -> Self {
        self.chunks.push(bytes.to_vec());
        self
    }

    /// A file of this page alone.
    pub fn file(self) -> Vec<u8> {
        Container::default().file(&[self])
    }
}

impl Container {
    /// The bytes of a number of so many of them.
    pub fn number(self, value: u64, bytes: usize) -> Vec<u8> {
        if self.is_big_endian {
            value.to_be_bytes()[8 - bytes..].to_vec()
        } else {
            value.to_le_bytes()[..bytes].to_vec()
        }
    }

    /// A file of some pages.
    pub fn file(self, pages: &[Page]) -> Vec<u8> {
        let mut file = if self.is_big_endian { b"MM".to_vec() } else { b"II".to_vec() };
        let header: &[u64] = if self.is_big { &[43, 8, 0] } else { &[42] };
        file.extend(header.iter().flat_map(|word| self.number(*word, 2)));
        // Where the place of the next directory is to be written.
        let mut link = file.len();
        file.extend(self.number(0, self.word()));
        for page in pages {
            let offsets: Vec<u32> = page.chunks.iter().map(|chunk| append(&mut file, chunk)).collect();
            let lengths = page.chunks.iter().map(|chunk| chunk.len() as u32).collect();
            let is_tiled = page.tags.contains_key(&Tag::TileWidth.to_u16());
            let mut tags = page.tags.clone();
            let [at, count] = if is_tiled {
                [Tag::TileOffsets, Tag::TileByteCounts]
            } else {
                [Tag::StripOffsets, Tag::StripByteCounts]
            };
            tags.insert(at.to_u16(), offsets);
            // A test may state a length of its own.
            tags.entry(count.to_u16()).or_insert(lengths);
            let directory = self.directory(&tags, &mut file);
            let start = append(&mut file, &directory);
            file.splice(link..link + self.word(), self.number(start.into(), self.word()));
            link = file.len() - self.word();
        }
        file
    }

    /// Bytes of an offset.
    fn word(self) -> usize {
        if self.is_big { 8 } else { 4 }
    }

    /// A directory, behind which there is none. Values that have no room in it are appended to the file.
    fn directory(self, tags: &BTreeMap<u16, Vec<u32>>, file: &mut Vec<u8>) -> Vec<u8> {
        let word = self.word();
        let mut directory = self.number(tags.len() as u64, if self.is_big { 8 } else { 2 });
        for (tag, values) in tags {
            // Of 16 bits where that is enough, or of 32.
            let (kind, bytes) = if values.iter().all(|value| *value <= 0xFFFF) { (3, 2) } else { (4, 4) };
            directory.extend(self.number((*tag).into(), 2));
            directory.extend(self.number(kind, 2));
            directory.extend(self.number(values.len() as u64, word));
            let mut value: Vec<u8> = values.iter().flat_map(|v| self.number((*v).into(), bytes)).collect();
            if value.len() > word {
                value = self.number(append(file, &value).into(), word);
            }
            value.resize(word, 0);
            directory.extend(value);
        }
        directory.extend(self.number(0, word));
        directory
    }
}

/// Appends to a file, and tells where.
fn append(file: &mut Vec<u8>, bytes: &[u8]) -> u32 {
    let start = file.len() as u32;
    file.extend(bytes);
    start
}

/// LZW that compresses nothing (TIFF 6.0, section 13): a code of its own for each byte, and a clear code before codes become
/// longer than 9 bits.
pub(super) fn lzw(bytes: &[u8]) -> Vec<u8> {
    const CLEAR: u16 = 256;
    const END: u16 = 257;
    let literals =
        |part: &[u8]| -> Vec<u16> { [CLEAR].into_iter().chain(part.iter().map(|b| u16::from(*b))).collect() };
    let codes = bytes.chunks(250).flat_map(literals).chain([END]);
    let bits: Vec<u8> = codes.flat_map(|code| (0..9).rev().map(move |i| (code >> i & 1) as u8)).collect();
    let byte = |bits: &[u8]| bits.iter().enumerate().fold(0, |byte, (i, bit)| byte | bit << (7 - i));
    bits.chunks(8).map(byte).collect()
}
