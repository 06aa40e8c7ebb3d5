//! Trees kept between runs: used when sound, rebuilt when not.

mod common;

use common::{Random, bumpy_sphere, place, ray};
use indigo_geom::{Accel, BuildError, BuildOptions, Hit, Stop, TreeStore, TriangleMesh};
use indigo_math::{Transform, Vec3d};
use std::collections::HashMap;
use std::sync::Mutex;

#[derive(Default)]
struct Memory(Mutex<HashMap<[u8; 32], Vec<u8>>>);

impl TreeStore for Memory {
    fn load(&self, key: &[u8; 32]) -> Option<Vec<u8>> {
        self.0.lock().unwrap().get(key).cloned()
    }
    fn store(&self, key: &[u8; 32], bytes: &[u8]) {
        self.0.lock().unwrap().insert(*key, bytes.to_vec());
    }
}

/// A mesh in its place, with several instances of another besides.
fn build(meshes: &[TriangleMesh], options: &BuildOptions, store: &Memory) -> Accel {
    let at = |x| Transform::translation(Vec3d::new(x, 0.0, 0.0));
    let objects = vec![place(0, Transform::IDENTITY), place(1, at(3.0)), place(1, at(-3.0))];
    Accel::build(meshes.to_vec(), objects, options, store).unwrap()
}

fn hits(accel: &Accel) -> Vec<Option<Hit>> {
    let mut random = Random(8);
    (0..2000).map(|_| accel.intersect(&ray(random.in_box(4.0), random.direction()))).collect()
}

fn meshes() -> Vec<TriangleMesh> {
    vec![bumpy_sphere(24), bumpy_sphere(17)]
}

fn options() -> BuildOptions {
    BuildOptions { bake_limit: 0, ..BuildOptions::default() }
}

#[test]
fn a_kept_tree_gives_the_same_hits() {
    for fast_threshold in [0, usize::MAX] {
        let (store, options) = (Memory::default(), BuildOptions { fast_threshold, ..options() });
        let first = build(&meshes(), &options, &store);
        let second = build(&meshes(), &options, &store);
        assert_eq!((first.stats().trees_loaded, second.stats().trees_loaded), (0, 2));
        assert_eq!(first.stats().tree_bytes, second.stats().tree_bytes);
        assert_eq!(hits(&first), hits(&second));
    }
}

#[test]
fn other_triangles_or_another_builder_make_another_tree() {
    let store = Memory::default();
    build(&meshes(), &options(), &store);
    let fast = BuildOptions { fast_threshold: 0, ..options() };
    assert_eq!(build(&meshes(), &fast, &store).stats().trees_loaded, 0);
    let other = vec![bumpy_sphere(24), bumpy_sphere(18)];
    assert_eq!(build(&other, &options(), &store).stats().trees_loaded, 1);
}

/// Changes bytes; on demand also makes the hash right again, as a forger would.
fn damage(bytes: &mut Vec<u8>, kind: usize, random: &mut Random) {
    let at = random.index(bytes.len() - 32);
    match kind % 5 {
        0 => bytes.truncate(random.index(bytes.len())),
        1 => bytes[at] ^= 1 << random.index(8),
        2 => bytes.extend_from_slice(&[0; 7]),
        _ => {
            // Header, a child, or anything else: any word becomes small, huge or shifted.
            let at = if kind % 5 == 3 { random.index(72) } else { at };
            let value = [0, 1, u32::MAX, 0x8000_0000, 0x8800_0000, random.bits() as u32][random.index(6)];
            let end = bytes.len() - 32;
            let at = (at & !3).min(end - 4);
            bytes[at..at + 4].copy_from_slice(&value.to_le_bytes());
        }
    }
    if kind % 5 >= 3 {
        let end = bytes.len() - 32;
        let hash = blake3::hash(&bytes[..end]);
        bytes[end..].copy_from_slice(hash.as_bytes());
    }
}

#[test]
fn damaged_and_forged_trees_are_rebuilt() {
    let store = Memory::default();
    let expected = hits(&build(&meshes(), &options(), &store));
    let sound = store.0.lock().unwrap().clone();
    let mut random = Random(77);
    let mut rejected = 0;
    for kind in 0..300 {
        let mut broken = sound.clone();
        let mut changed = false;
        for (key, bytes) in &mut broken {
            damage(bytes, kind, &mut random);
            changed |= *bytes != sound[key];
        }
        let store = Memory(Mutex::new(broken));
        let accel = build(&meshes(), &options(), &store);
        rejected += 2 - accel.stats().trees_loaded;
        // A changed box that still holds its children is no fault; the hits are right either way.
        assert_eq!(hits(&accel), expected, "kind {kind}, changed {changed}");
        if accel.stats().trees_loaded == 0 {
            assert_eq!(*store.0.lock().unwrap(), sound, "rebuilt trees replace damaged ones");
        }
    }
    assert!(rejected > 500, "only {rejected} of 600 were rejected");
}

#[test]
fn empty_and_foreign_bytes_are_no_tree() {
    let store = Memory::default();
    let expected = hits(&build(&meshes(), &options(), &store));
    for foreign in [Vec::new(), vec![0; 31], vec![0; 4096], b"IndiTree".to_vec()] {
        store.0.lock().unwrap().values_mut().for_each(|v| *v = foreign.clone());
        let accel = build(&meshes(), &options(), &store);
        assert_eq!(accel.stats().trees_loaded, 0);
        assert_eq!(hits(&accel), expected);
    }
}

/// Asks for the end when the first tree is looked for.
#[derive(Default)]
struct Impatient(Stop, Memory);

impl TreeStore for Impatient {
    fn load(&self, key: &[u8; 32]) -> Option<Vec<u8>> {
        self.0.set();
        self.1.load(key)
    }
    fn store(&self, key: &[u8; 32], bytes: &[u8]) {
        self.1.store(key, bytes);
    }
}

#[test]
fn building_ends_when_it_is_stopped_and_keeps_nothing() {
    for fast_threshold in [0, usize::MAX] {
        let store = Impatient::default();
        let options = BuildOptions { fast_threshold, stop: store.0.clone(), ..options() };
        let objects = vec![place(0, Transform::IDENTITY)];
        // More triangles than one thread splits alone.
        let built = Accel::build(vec![bumpy_sphere(100)], objects, &options, &store);
        assert_eq!(built.err(), Some(BuildError::Stopped));
        assert!(store.1.0.lock().unwrap().is_empty(), "half a tree");
    }
}
