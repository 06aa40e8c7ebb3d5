//! How much a JPEG's decoder keeps of the whole picture, told by the header (ITU-T T.81, annex B).
//!
//! A picture whose components come one after the other, or in passes that refine it, is kept as coefficients until the
//! last of them. `zune-jpeg` 0.5.15 then holds, for each component, two bytes for each of its samples, and where the
//! first scan has one component, as many samples for each texel as its two sampling factors multiply to.

/// Bytes of a coefficient.
const COEFFICIENT: u64 = 2;
/// Of four components with factors of four each way, which are the largest.
const MOST: u64 = COEFFICIENT * 4 * 16;

/// Bytes of coefficients that are held for each texel: 0 where all of a sequential picture comes at once, and the most
/// that there could be where the header is not understood.
pub(super) fn coefficient_bytes(file: &[u8]) -> u64 {
    held(file).unwrap_or(MOST)
}

fn held(file: &[u8]) -> Option<u64> {
    let mut rest = file.strip_prefix(&[0xFF, 0xD8])?;
    let mut frame = None;
    loop {
        let [0xFF, marker, high, low, ..] = *rest else { return None };
        let length = usize::from(u16::from_be_bytes([high, low]));
        let segment = rest.get(4..2 + length)?;
        match marker {
            // Huffman tables, extensions and arithmetic conditioning have numbers among those of frames.
            0xC4 | 0xC8 | 0xCC => {}
            0xC0..=0xCF if frame.is_none() => frame = Some(Frame::read(marker, segment)?),
            // A second frame.
            0xC0..=0xCF => return None,
            0xDA => {
                let frame = frame?;
                let comes_at_once = !frame.is_progressive && *segment.first()? == frame.components;
                return Some(if comes_at_once { 0 } else { COEFFICIENT * frame.samples });
            }
            _ => {}
        }
        rest = rest.get(2 + length..)?;
    }
}

/// Whether the file goes on to the mark of its end, after which anything may follow.
pub(super) fn has_end(file: &[u8]) -> bool {
    // Marks are told from numbers of a scan, where 0xFF is followed by 0 or by the number of a restart; and what comes
    // before a scan is passed over by its length, since it may hold a small JPEG of its own.
    let mut rest = file.get(2..).unwrap_or_default();
    while let [first, following @ ..] = rest {
        rest = match (first, following) {
            (0xFF, [0xD9, ..]) => return true,
            (0xFF, [0x00 | 0x01 | 0xD0..=0xD8, after @ ..]) => after,
            (0xFF, [marker, high, low, ..]) if *marker != 0xFF => {
                following.get(1 + usize::from(u16::from_be_bytes([*high, *low]))..).unwrap_or_default()
            }
            _ => following,
        };
    }
    false
}

struct Frame {
    is_progressive: bool,
    components: u8,
    /// The products of the sampling factors, summed over components.
    samples: u64,
}

impl Frame {
    /// From a segment: precision, two sides of two bytes, and three bytes for each component.
    fn read(marker: u8, segment: &[u8]) -> Option<Self> {
        let components = *segment.get(5)?;
        let factors = segment.get(6..6 + 3 * usize::from(components))?.as_chunks::<3>().0;
        let samples = factors.iter().map(|[_, by, _]| u64::from(by >> 4) * u64::from(by & 15)).sum();
        Some(Self { is_progressive: marker == 0xC2, components, samples })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A header of a frame with sampling factors, and of a scan of some of its components.
    fn header(frame: u8, factors: &[u8], scan: u8) -> Vec<u8> {
        let segment = |marker: u8, content: &[u8]| {
            let length = (content.len() as u16 + 2).to_be_bytes();
            [&[0xFF, marker], length.as_slice(), content].concat()
        };
        let components: Vec<u8> = factors.iter().flat_map(|&by| [0, by, 0]).collect();
        let sides = [8, 0, 16, 0, 16, factors.len() as u8];
        let comment = segment(0xFE, b"\xFF\xDA");
        let frame = segment(frame, &[&sides, components.as_slice()].concat());
        [vec![0xFF, 0xD8], comment, segment(0xC4, &[0; 9]), frame, segment(0xDA, &[scan, 0, 0])].concat()
    }

    #[test]
    fn coefficients_are_kept_of_what_comes_bit_by_bit() {
        for (frame, factors, scan, expected) in [
            (0xC0, [0x11; 3].as_slice(), 3, 0),
            (0xC1, &[0x22, 0x11, 0x11], 3, 0),
            (0xC0, &[0x11; 3], 1, 6),
            (0xC2, &[0x22, 0x11, 0x11], 3, 12),
            (0xC2, &[0x11], 1, 2),
            (0xC2, &[0x44; 4], 1, MOST),
        ] {
            assert_eq!(
                coefficient_bytes(&header(frame, factors, scan)),
                expected,
                "{frame:x} {factors:x?} {scan}"
            );
        }
    }

    /// A thumbnail's end is none, and neither are numbers of a scan.
    #[test]
    fn the_end_is_that_of_the_picture() {
        let head = [&[0xFF, 0xD8, 0xFF, 0xE1, 0, 4, 0xFF, 0xD9], &header(0xC0, &[0x11; 3], 3)[2..]].concat();
        let scan = [0x12, 0xFF, 0x00, 0xD9, 0xFF, 0xD3, 0x55, 0xFF, 0xFF];
        let sound = [head.as_slice(), &scan, &[0xD9, 7]].concat();
        assert!(has_end(&sound));
        for end in 0..sound.len() - 2 {
            assert!(!has_end(&sound[..end]), "{end}");
        }
    }

    #[test]
    fn what_is_not_understood_counts_most() {
        let sound = header(0xC0, &[0x11; 3], 3);
        for end in 0..sound.len() - 2 {
            assert_eq!(coefficient_bytes(&sound[..end]), MOST, "{end}");
        }
        let twice = [&sound[..sound.len() - 7], &header(0xC0, &[0x11], 1)[2..]].concat();
        assert_eq!(coefficient_bytes(&twice), MOST);
    }
}
