//! Writing packed scenes.

use super::read::{PackLimits, harm};
use super::{PREFIX, is_main, without_prefix};
use flate2::Compression;
use flate2::write::DeflateEncoder;
use std::collections::HashMap;
use std::io::{Error, ErrorKind, Seek, Write};
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, DateTime, System, ZipWriter};

/// The longest name that is kept of a file, in bytes.
const LONGEST_NAME: usize = 100;

/// Endings of files that are compressed already: to do it again takes time and saves nothing.
const COMPRESSED: [&str; 8] = ["png", "jpg", "jpeg", "exr", "tif", "tiff", "igmesh", "webp"];

/// The largest member, in bytes, that is written without the extension for large files: what does not become smaller
/// when it is compressed becomes somewhat larger.
const SMALL: usize = 0xFF00_0000;

/// From how many bytes on it is looked at whether a member becomes suspiciously small when it is compressed.
const LARGE: usize = 1 << 20;

/// Writes a packed scene, a file after the other; the scene comes last.
pub struct PackWriter<W: Write + Seek> {
    zip: ZipWriter<W>,
    /// Members written so far.
    members: usize,
    /// What whoever reads it allows.
    limits: PackLimits,
    /// Names by the hash of the content and the ending, by which some readers know a file's kind.
    names: HashMap<([u8; 32], String), String>,
}

impl<W: Write + Seek> PackWriter<W> {
    /// A pack to be written to `out`.
    pub fn new(out: W) -> Self {
        Self { zip: ZipWriter::new(out), members: 0, limits: PackLimits::default(), names: HashMap::new() }
    }

    /// Adds a file, of which only the last part of the path counts, unless there is one of the same content; its name
    /// in the archive.
    ///
    /// # Errors
    /// What the output says.
    pub fn add(&mut self, path: &str, content: &[u8]) -> std::io::Result<String> {
        let plain = plain_name(path);
        let ending = plain.rsplit_once('.').map_or("", |(_, ending)| ending).to_ascii_lowercase();
        let key = (*blake3::hash(content).as_bytes(), ending);
        if let Some(name) = self.names.get(&key) {
            return Ok(name.clone());
        }
        let name = format!("{PREFIX}{}_{plain}", self.names.len());
        self.member(&name, &key.1, content)?;
        self.names.insert(key, name.clone());
        Ok(name)
    }

    /// Writes the scene and the end of the archive; the number of files beside the scene.
    ///
    /// # Errors
    /// What the output says.
    pub fn finish(mut self, path: &str, scene: &[u8]) -> std::io::Result<usize> {
        let plain = plain_name(path);
        let stem = plain.rsplit_once('.').map_or(&*plain, |(stem, _)| stem);
        let name = format!("{stem}.igs");
        let is_sound = is_main(&name, ".igs") && harm(&name).is_none();
        self.member(if is_sound { &name } else { "scene.igs" }, "igs", scene)?;
        self.zip.finish()?.flush()?;
        Ok(self.names.len())
    }

    fn member(&mut self, name: &str, ending: &str, content: &[u8]) -> std::io::Result<()> {
        if self.members == self.limits.members || content.len() as u64 > self.limits.member_bytes {
            let why = format!("{name} is too large a file, or one too many, for a packed scene");
            return Err(Error::new(ErrorKind::FileTooLarge, why));
        }
        self.members += 1;
        // A map of one colour, say: compressed, it would be refused as made to fill a disk.
        let is_compressed = COMPRESSED.contains(&ending)
            || content.len() > LARGE && shrinks_more_than(self.limits.growth / 2, content);
        let method = if is_compressed { CompressionMethod::Stored } else { CompressionMethod::Deflated };
        let options = SimpleFileOptions::default()
            .compression_method(method)
            .last_modified_time(DateTime::default())
            .unix_permissions(0o644)
            .system(System::Unix)
            .large_file(content.len() > SMALL);
        self.zip.start_file(name, options)?;
        self.zip.write_all(content)
    }
}

/// Whether a content becomes so many times smaller when it is compressed.
fn shrinks_more_than(times: u64, content: &[u8]) -> bool {
    let mut encoder = DeflateEncoder::new(std::io::sink(), Compression::default());
    let compressed = encoder.write_all(content).map_or(u64::MAX, |()| encoder.total_out());
    content.len() as u64 / times > compressed
}

/// The last part of a path, in letters that every system and every encoding of a scene can write, without the prefix
/// of an earlier packing.
fn plain_name(path: &str) -> String {
    let last = path.rsplit(['/', '\\']).next().unwrap_or_default();
    let plain = |c: char| if c.is_ascii_alphanumeric() || matches!(c, '.' | '-' | '_') { c } else { '_' };
    let name: String = without_prefix(last).chars().map(plain).collect();
    let (stem, ending) = name.rsplit_once('.').map_or((&*name, ""), |(stem, ending)| (stem, ending));
    let room = LONGEST_NAME.saturating_sub(ending.len() + 1);
    // All characters are of one byte by now.
    let stem = stem.get(..room.min(stem.len())).unwrap_or_default();
    let name = match ending.get(..LONGEST_NAME.min(ending.len())) {
        Some(ending) if !ending.is_empty() => format!("{stem}.{ending}"),
        _ => stem.to_owned(),
    };
    // Not every system allows a point at the end.
    match name.trim_end_matches('.') {
        "" => "file".to_owned(),
        name => name.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_plain_and_short() {
        assert_eq!(plain_name("maps\\Holz böden/Eiche & Öl.JPG"), "Eiche____l.JPG");
        assert_eq!(plain_name("PACKED_0_PACKED_12_x.png"), "x.png");
        assert_eq!(plain_name("PACKED_x_y"), "PACKED_x_y");
        assert_eq!((plain_name("a/.."), plain_name("a...")), ("file".to_owned(), "a".to_owned()));
        let long = plain_name(&format!("{}.exr", "a".repeat(500)));
        assert!(long.len() <= LONGEST_NAME && long.strip_suffix(".exr").is_some(), "{long}");
    }
}
