//! Damaged and random files: an error with a position, or a sound mesh; never a panic, never memory out of proportion.
//!
//! Memory is measured by an allocator that counts, per thread, what is held. Readers may hold 64 bytes for each byte of
//! a file at their peak, and 1 MiB besides; a compressed .igmesh may also use a decompression window of 8 MiB and
//! what it unpacks to.

use common::{check_answer, samples};
use indigo_formats::MeshFormat;
use indigo_fuzz::{Rng, damage};
use indigo_testkit::allocation::{Counting, peak_of};
use proptest::prelude::*;

mod common;

const PER_BYTE: usize = 64;
const ALLOWANCE: usize = 1 << 20;
const WINDOW: usize = 12 << 20;

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// Reads and checks the answer and the memory that it took.
fn read_within_bounds(kind: MeshFormat, bytes: &[u8]) -> bool {
    let (answer, peak) = peak_of(|| kind.read(bytes));
    let compressed = kind == MeshFormat::Igmesh && bytes.get(4..12) == Some(&[4, 0, 0, 0, 1, 0, 0, 0]);
    let allowed = PER_BYTE * bytes.len() + ALLOWANCE + if compressed { WINDOW } else { 0 };
    assert!(peak <= allowed, "{peak} bytes for a file of {} bytes: {answer:?}", bytes.len());
    check_answer(kind, &answer, bytes);
    answer.is_ok()
}

#[test]
fn sound_samples_are_read() {
    for (kind, label, bytes) in samples() {
        assert!(read_within_bounds(kind, &bytes), "{label}: {:?}", kind.read(&bytes));
    }
}

#[test]
fn two_hundred_damaged_files_of_each_kind() {
    for (i, (kind, label, bytes)) in samples().into_iter().enumerate() {
        let mut rng = Rng::new(i as u64);
        let mut refused = 0;
        for _ in 0..200 {
            refused += usize::from(!read_within_bounds(kind, &damage(&bytes, &bytes, &mut rng)));
        }
        assert!(refused > 20, "{label}: only {refused} of 200 were refused");
    }
}

#[test]
fn every_truncation() {
    for (kind, _, bytes) in samples() {
        for n in 0..bytes.len() {
            read_within_bounds(kind, &bytes[..n]);
        }
    }
}

#[test]
fn special_words_written_all_over() {
    for (kind, _, bytes) in samples() {
        for value in
            [0, 1, 0x7FFF_FFFF, 0x8000_0000, 0xFFFF_FFFF_u32, f32::NAN.to_bits(), f32::INFINITY.to_bits()]
        {
            // Every place of the small files, about a thousand of the large ones.
            for at in (0..bytes.len().saturating_sub(3)).step_by(1 + bytes.len() / 1000) {
                let mut damaged = bytes.clone();
                damaged[at..at + 4].copy_from_slice(&value.to_le_bytes());
                read_within_bounds(kind, &damaged);
            }
        }
    }
}

/// Files whose bytes each cost as much memory as the format allows.
#[test]
fn files_made_to_swell() {
    let corners = "1 2 3 ".repeat(40_000);
    let obj = format!("v 0 0 0\nv 1 0 0\nv 0 1 0\nf {corners}\n");
    assert!(read_within_bounds(MeshFormat::Obj, obj.as_bytes()));
    let mixed: Vec<String> = (0..20_000).map(|i| format!("v {i} 0 0\nf 1 2 -1")).collect();
    let mixed = mixed.join("\n");
    let obj = format!("v 0 1 0\nv 1 0 1\nvn 0 0 1\nf 1//1 2//1 1//1\n{mixed}");
    assert!(read_within_bounds(MeshFormat::Obj, obj.as_bytes()));
    let bytes = 100_000_u32;
    let mut ply =
        b"ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty char x\nproperty char y\n\
        property char z\nelement face 1\nproperty list uint uchar vertex_indices\nend_header\n"
            .to_vec();
    ply.extend([0, 0, 0, 1, 0, 0, 0, 1, 0]);
    ply.extend(bytes.to_le_bytes());
    ply.extend((0..bytes).map(|i| (i % 3) as u8));
    assert!(read_within_bounds(MeshFormat::Ply, &ply));
}

const KINDS: [MeshFormat; 4] = [MeshFormat::Obj, MeshFormat::Ply, MeshFormat::ThreeDs, MeshFormat::Igmesh];

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(500) })]

    #[test]
    fn random_bytes(bytes in proptest::collection::vec(any::<u8>(), 0..400)) {
        for kind in KINDS {
            read_within_bounds(kind, &bytes);
        }
    }

    #[test]
    fn random_words_of_the_text_formats(words in proptest::collection::vec(0..24_usize, 0..120)) {
        const WORDS: [&str; 24] = [
            "v ", "vt ", "vn ", "f ", "usemtl ", "\n", "\n", "\r\n", "\\\n", " ", "1", "2", "-1", "0.5", "/", "//",
            "nan ", "1e40 ", "# ", "3 ", "1 ", "0 ", "99999999999 ", "\u{fe}",
        ];
        let text: String = words.iter().map(|&word| WORDS[word]).collect();
        let prefix = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
        read_within_bounds(MeshFormat::Obj, format!("{prefix}{text}\nf 1 2 3\n").as_bytes());
        let header = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
            element face 2\nproperty list int int vertex_indices\nend_header\n0 0 0 1 0 0 0 1 0\n";
        read_within_bounds(MeshFormat::Ply, format!("{header}{text}").as_bytes());
    }

    #[test]
    fn random_damage(sample in 0..9_usize, seed: u64) {
        let (kind, _, bytes) = &samples()[sample];
        read_within_bounds(*kind, &damage(bytes, bytes, &mut Rng::new(seed)));
    }
}
