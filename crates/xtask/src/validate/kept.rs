//! Pictures that an interrupted run has left, for one that goes on with them (`--resume`).

use std::path::Path;

/// What becomes of the pictures of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Keep {
    /// They go as soon as they were read.
    Nothing,
    /// They stay until there is a report, so that an interrupted run can be gone on with.
    Pictures,
    /// The same, and those that are there are taken.
    Resume,
}

/// What pictures depend on, written beside them: of anything else they are not this run's.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stamp(u64);

impl Stamp {
    /// Of bytes, one after another.
    pub fn of<'a>(parts: impl IntoIterator<Item = &'a [u8]>) -> Self {
        // FNV-1a of 64 bits; each part ends with its length, so that none runs into the next.
        let mix = |hash: u64, byte: &u8| (hash ^ u64::from(*byte)).wrapping_mul(0x0000_0100_0000_01b3);
        Self(parts.into_iter().fold(0xcbf2_9ce4_8422_2325, |hash, part| {
            let hash = part.iter().fold(hash, mix);
            part.len().to_le_bytes().iter().fold(hash, mix)
        }))
    }

    /// Its bytes, as a part of another.
    pub fn bytes(self) -> [u8; 8] {
        self.0.to_le_bytes()
    }

    fn words(self) -> String {
        format!("{:016x}\n", self.0)
    }

    /// Whether a file beside pictures has it.
    pub fn is_in(self, path: &Path) -> bool {
        std::fs::read_to_string(path).is_ok_and(|there| there == self.words())
    }

    /// Writes it there, once no pictures of another are left.
    ///
    /// # Errors
    /// What could not be written.
    pub fn write(self, path: &Path) -> Result<(), String> {
        std::fs::write(path, self.words()).map_err(|error| format!("{}: {error}", path.display()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn other_parts_have_other_stamps() {
        let of = |parts: &[&str]| Stamp::of(parts.iter().map(|part| part.as_bytes()));
        assert_eq!(of(&["a", "b"]), of(&["a", "b"]));
        for other in [&["ab", ""][..], &["", "ab"], &["a"], &["b", "a"]] {
            assert_ne!(of(&["a", "b"]), of(other), "{other:?}");
        }
    }

    #[test]
    fn a_stamp_is_there_once_it_was_written() {
        let path = std::env::temp_dir().join(format!("indigo-stamp-{}", std::process::id()));
        let [first, second] = [Stamp::of([&b"one"[..]]), Stamp::of([&b"two"[..]])];
        let before = first.is_in(&path);
        let written = first.write(&path);
        let after = [first, second].map(|stamp| stamp.is_in(&path));
        drop(std::fs::remove_file(&path));
        assert_eq!((before, written, after), (false, Ok(()), [true, false]));
    }
}
