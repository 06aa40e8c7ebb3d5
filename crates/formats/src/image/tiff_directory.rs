//! The directories of a TIFF file, looked through before a decoder is: that of `tiff` 0.11.3 takes memory for as many
//! values as a tag says that it has, however long the file.

/// The numbers of a file at some places, in its order of bytes.
struct Numbers<'a> {
    file: &'a [u8],
    is_little: bool,
}

impl Numbers<'_> {
    /// The number of so many bytes at a place, up to eight.
    fn at(&self, place: u64, bytes: usize) -> Option<u64> {
        let start = usize::try_from(place).ok()?;
        let bytes = self.file.get(start..start.checked_add(bytes)?)?;
        let fold = |number, byte: &u8| number << 8 | u64::from(*byte);
        Some(if self.is_little { bytes.iter().rev().fold(0, fold) } else { bytes.iter().fold(0, fold) })
    }
}

/// Widths of what a TIFF and a BigTIFF differ in.
struct Widths {
    /// Of the number of entries.
    entries: usize,
    /// Of an offset, and of how many values an entry has.
    offset: usize,
}

/// Whether no tag of the first so many directories has more values than the file has bytes: each takes one at least.
/// What does not look like directories is left to the decoder.
pub(super) fn is_held(file: &[u8], directories: usize) -> bool {
    let numbers = Numbers { file, is_little: file.starts_with(b"II") };
    let (widths, mut next) = match numbers.at(2, 2) {
        Some(42) => (Widths { entries: 2, offset: 4 }, numbers.at(4, 4)),
        Some(43) => (Widths { entries: 8, offset: 8 }, numbers.at(8, 8)),
        _ => return true,
    };
    for _ in 0..directories {
        let Some(place) = next.filter(|place| *place != 0) else { return true };
        let Some(entries) = numbers.at(place, widths.entries) else { return true };
        let entry = 4 + 2 * widths.offset as u64;
        let mut at = place + widths.entries as u64;
        for _ in 0..entries {
            // An entry has a tag and a type of two bytes each, and then how many values.
            let Some(values) = numbers.at(at.saturating_add(4), widths.offset) else { return true };
            if values > file.len() as u64 {
                return false;
            }
            at = at.saturating_add(entry);
        }
        next = numbers.at(at, widths.offset);
    }
    true
}

#[cfg(test)]
mod tests {
    use super::is_held;

    /// A file of a directory with one tag of so many values, in either order of bytes and both widths.
    fn files(values: u32) -> [Vec<u8>; 4] {
        [(true, false), (false, false), (true, true), (false, true)].map(|(is_little, is_big)| {
            let number = |value: u64, bytes: usize| {
                let all = value.to_le_bytes();
                let mut digits = all[..bytes].to_vec();
                if !is_little {
                    digits.reverse();
                }
                digits
            };
            let offset = if is_big { 8 } else { 4 };
            let mut file = if is_little { b"II".to_vec() } else { b"MM".to_vec() };
            if is_big {
                file.extend(
                    [number(43, 2), number(8, 2), number(0, 2), number(16, 8), number(1, 8)].concat(),
                );
            } else {
                file.extend([number(42, 2), number(8, 4), number(1, 2)].concat());
            }
            file.extend([number(284, 2), number(3, 2), number(values.into(), offset)].concat());
            file.extend([number(0, offset), number(0, offset)].concat());
            file
        })
    }

    #[test]
    fn no_tag_has_more_values_than_the_file_has_bytes() {
        for file in files(3) {
            assert!(is_held(&file, 1) && is_held(&file[..file.len() - 3], 1) && is_held(&file[..7], 1));
        }
        for file in files(5_898_241) {
            assert!(!is_held(&file, 1), "{file:?}");
            // Behind the directories that are looked at.
            assert!(is_held(&file, 0));
        }
    }

    /// Directories that lead round in a circle are looked at so often and no longer.
    #[test]
    fn a_round_of_directories_ends() {
        let mut file = files(3)[0].clone();
        let end = file.len() - 4;
        file[end] = 8;
        assert!(is_held(&file, 1000));
    }
}
