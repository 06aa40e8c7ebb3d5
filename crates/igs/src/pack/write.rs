//! Writing packed scenes.

use super::{PREFIX, is_main, without_prefix};
use std::collections::HashMap;
use std::io::{Seek, Write};
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, DateTime, ZipWriter};

/// The longest name that is kept of a file, in bytes.
const LONGEST_NAME: usize = 100;

/// Endings of files that are compressed already: to do it again takes time and saves nothing.
const COMPRESSED: [&str; 8] = ["png", "jpg", "jpeg", "exr", "tif", "tiff", "igmesh", "webp"];

/// The largest member that an archive without the extension for large files holds.
const SMALL: usize = u32::MAX as usize;

/// Writes a packed scene, a file after the other; the scene comes last.
pub struct PackWriter<W: Write + Seek> {
    zip: ZipWriter<W>,
    /// Names by the hash of the content and the ending, by which some readers know a file's kind.
    names: HashMap<([u8; 32], String), String>,
}

impl<W: Write + Seek> PackWriter<W> {
    /// A pack to be written to `out`.
    pub fn new(out: W) -> Self {
        Self { zip: ZipWriter::new(out), names: HashMap::new() }
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
        let stem = plain.strip_suffix(".igs").unwrap_or(&plain);
        let name = format!("{stem}.igs");
        self.member(if is_main(&name) { &name } else { "scene.igs" }, "igs", scene)?;
        self.zip.finish()?.flush()?;
        Ok(self.names.len())
    }

    fn member(&mut self, name: &str, ending: &str, content: &[u8]) -> std::io::Result<()> {
        let is_compressed = COMPRESSED.contains(&ending);
        let method = if is_compressed { CompressionMethod::Stored } else { CompressionMethod::Deflated };
        let options = SimpleFileOptions::default()
            .compression_method(method)
            .last_modified_time(DateTime::default())
            .unix_permissions(0o644)
            .large_file(content.len() > SMALL);
        self.zip.start_file(name, options)?;
        self.zip.write_all(content)
    }
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
    match ending.get(..LONGEST_NAME.min(ending.len())) {
        Some(ending) if !ending.is_empty() => format!("{stem}.{ending}"),
        _ => stem.to_owned(),
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
        assert_eq!(plain_name("a/.."), "..");
        let long = plain_name(&format!("{}.exr", "a".repeat(500)));
        assert!(long.len() <= LONGEST_NAME && long.strip_suffix(".exr").is_some(), "{long}");
    }
}
