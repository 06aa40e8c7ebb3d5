//! Ways to damage a file.

/// SplitMix64 (Steele, Lea and Flood, "Fast splittable pseudorandom number generators", OOPSLA 2014, Figure 15).
#[derive(Clone, Debug)]
pub struct Rng(u64);

impl Rng {
    /// A sequence fixed by `seed`.
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    /// A number below `n` (0 if `n` is 0).
    pub fn below(&mut self, n: usize) -> usize {
        (self.next() % n.max(1) as u64) as usize
    }
}

/// Numbers at which readers go wrong, as little-endian words.
const WORDS: [u32; 10] = [
    0,
    1,
    0x7FFF_FFFF,
    0x8000_0000,
    0xFFFF_FFFF,
    0xFFFF_FFFE,
    0x0001_0000,
    0x7FC0_0000, // not a number
    0x7F80_0000, // infinity
    0x0000_0001, // the smallest float
];

/// Texts at which readers go wrong.
const TEXTS: [&str; 16] = [
    "0",
    "-1",
    "-",
    "1e39",
    "1e-320",
    "nan",
    "inf",
    "4294967295",
    "18446744073709551616",
    "/",
    "\n",
    "\r",
    "\\\n",
    "<",
    ">",
    "\"",
];

/// The longest stretch that is moved, removed or repeated.
const STRETCH: usize = 64;

/// One to four damages of a file; `other` is a file to take pieces from.
pub fn damage(bytes: &[u8], other: &[u8], rng: &mut Rng) -> Vec<u8> {
    let mut out = bytes.to_vec();
    for _ in 0..=rng.below(4) {
        damage_once(&mut out, other, rng);
    }
    out
}

fn damage_once(out: &mut Vec<u8>, other: &[u8], rng: &mut Rng) {
    let at = rng.below(out.len());
    let stretch = rng.below((out.len() - at).min(STRETCH) + 1);
    match rng.below(10) {
        0 => out.truncate(at),
        1 => flip(out, at, 1 << rng.below(8)),
        2 => flip(out, at, rng.below(256) as u8),
        3 => overwrite(out, at, &WORDS[rng.below(WORDS.len())].to_le_bytes()),
        4 => overwrite(out, at, &WORDS[rng.below(WORDS.len())].to_be_bytes()),
        5 => drop(out.drain(at..at + stretch)),
        6 => {
            let repeated = out[at..at + stretch].repeat(1 + rng.below(5));
            out.splice(at..at, repeated);
        }
        7 => drop(out.splice(at..at + stretch, TEXTS[rng.below(TEXTS.len())].bytes())),
        8 => {
            let from = rng.below(other.len());
            let piece = &other[from..(from + stretch).min(other.len())];
            overwrite(out, at, piece);
        }
        _ => {
            let to = rng.below(out.len());
            let moved: Vec<u8> = out[at..at + stretch].to_vec();
            overwrite(out, to, &moved);
        }
    }
}

fn flip(out: &mut [u8], at: usize, bits: u8) {
    if let Some(byte) = out.get_mut(at) {
        *byte ^= bits;
    }
}

fn overwrite(out: &mut [u8], at: usize, with: &[u8]) {
    for (byte, new) in out.iter_mut().skip(at).zip(with) {
        *byte = *new;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn empty_files_can_be_damaged_too() {
        for case in 0..1000 {
            damage(&[], &[], &mut Rng::new(case));
            damage(b"x", &[], &mut Rng::new(case));
        }
    }
}
