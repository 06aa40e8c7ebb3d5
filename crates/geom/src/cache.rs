//! Built trees as bytes, and back with every number checked.
//!
//! Layout, little-endian: magic, format version, builder, counts, root, bounds, nodes, blocks, then
//! the BLAKE3 hash of all before it. The key names the triangles and the builder. The hash tells
//! damage; the checks after it keep a forged file from leading the kernel out of its arrays.

use crate::build::{Builder, TRIANGLE_DEPTH, build_triangles, is_traceable};
use crate::soup::Soup;
use crate::stop::Stop;
use crate::store::TreeStore;
use crate::wide::{Block, Box3, Child, Node, WideTree, stack_need};

const MAGIC: [u8; 8] = *b"IndiTree";
/// To be raised with every change to this layout, to a builder, or to what the kernel expects.
const VERSION: u32 = 2;
const HEADER: usize = 8 + 4 + 4 + 3 * 8 + 4 + 6 * 4;
const NODE: usize = (6 * 8 + 8) * 4;
const BLOCK: usize = (9 * 8 + 8) * 4;
const HASH: usize = 32;

/// A tree over the triangles, how many were left out, and whether it came from the store; `None` where that was stopped.
pub(crate) fn load_or_build(
    soup: &Soup,
    builder: Builder,
    store: &dyn TreeStore,
    stop: &Stop,
) -> Option<(WideTree, usize, bool)> {
    if !store.is_active() || soup.triangles.is_empty() {
        let (tree, skipped) = build_triangles(soup, builder, stop)?;
        return Some((tree, skipped, false));
    }
    let key = key(soup, builder);
    if let Some((tree, skipped)) = store.load(&key).and_then(|bytes| decode(&bytes, soup, builder)) {
        return Some((tree, skipped, true));
    }
    let (tree, skipped) = build_triangles(soup, builder, stop)?;
    store.store(&key, &encode(&tree, skipped, builder));
    Some((tree, skipped, false))
}

fn builder_number(builder: Builder) -> u32 {
    match builder {
        Builder::Fast => 0,
        Builder::Quality => 1,
    }
}

fn key(soup: &Soup, builder: Builder) -> [u8; 32] {
    let mut hasher = blake3::Hasher::new();
    hasher.update(&MAGIC).update(&VERSION.to_le_bytes()).update(&builder_number(builder).to_le_bytes());
    for count in [soup.positions.len(), soup.triangles.len()] {
        hasher.update(&(count as u64).to_le_bytes());
    }
    let mut bytes = Vec::with_capacity(12 * 1024);
    let mut feed = |words: &mut dyn Iterator<Item = [u8; 4]>| {
        bytes.clear();
        words.for_each(|w| bytes.extend_from_slice(&w));
        hasher.update(&bytes);
    };
    for part in soup.positions.chunks(1024) {
        feed(&mut part.iter().flatten().map(|x| x.to_le_bytes()));
    }
    for part in soup.triangles.chunks(1024) {
        feed(&mut part.iter().flatten().map(|x| x.to_le_bytes()));
    }
    *hasher.finalize().as_bytes()
}

fn encode(tree: &WideTree, skipped: usize, builder: Builder) -> Vec<u8> {
    let size = HEADER + tree.nodes.len() * NODE + tree.blocks.len() * BLOCK + HASH;
    let mut out = Vec::with_capacity(size);
    out.extend_from_slice(&MAGIC);
    out.extend_from_slice(&VERSION.to_le_bytes());
    out.extend_from_slice(&builder_number(builder).to_le_bytes());
    for count in [skipped, tree.nodes.len(), tree.blocks.len()] {
        out.extend_from_slice(&(count as u64).to_le_bytes());
    }
    out.extend_from_slice(&tree.root.0.to_le_bytes());
    put_floats(&mut out, tree.bounds.lo.iter().chain(&tree.bounds.hi));
    for node in &tree.nodes {
        put_floats(&mut out, node.bounds.iter().flatten());
        node.children.iter().for_each(|c| out.extend_from_slice(&c.0.to_le_bytes()));
    }
    for block in &tree.blocks {
        put_floats(&mut out, block.corners.iter().flatten().flatten());
        block.ids.iter().for_each(|id| out.extend_from_slice(&id.to_le_bytes()));
    }
    let hash = blake3::hash(&out);
    out.extend_from_slice(hash.as_bytes());
    out
}

fn put_floats<'a>(out: &mut Vec<u8>, values: impl Iterator<Item = &'a f32>) {
    values.for_each(|v| out.extend_from_slice(&v.to_le_bytes()));
}

/// Takes numbers off the front of a slice.
struct Reader<'a>(&'a [u8]);

impl Reader<'_> {
    fn take<const N: usize>(&mut self) -> Option<[u8; N]> {
        let (head, rest) = self.0.split_first_chunk()?;
        self.0 = rest;
        Some(*head)
    }

    fn word(&mut self) -> Option<u32> {
        Some(u32::from_le_bytes(self.take()?))
    }

    fn count(&mut self) -> Option<usize> {
        usize::try_from(u64::from_le_bytes(self.take()?)).ok()
    }

    fn words<const N: usize>(&mut self) -> Option<[u32; N]> {
        let mut out = [0; N];
        for w in &mut out {
            *w = self.word()?;
        }
        Some(out)
    }

    fn floats<const N: usize>(&mut self) -> Option<[f32; N]> {
        Some(self.words()?.map(f32::from_bits))
    }
}

/// The tree in some bytes and the number of triangles left out, if they hold a sound tree of just
/// these triangles.
fn decode(bytes: &[u8], soup: &Soup, builder: Builder) -> Option<(WideTree, usize)> {
    let (content, hash) = bytes.split_last_chunk::<HASH>()?;
    if blake3::hash(content).as_bytes() != hash {
        return None;
    }
    let mut r = Reader(content);
    let header_fits = r.take()? == MAGIC && r.word()? == VERSION && r.word()? == builder_number(builder);
    let (skipped, nodes, blocks) = (r.count()?, r.count()?, r.count()?);
    let root = Child(r.word()?);
    let bounds = Box3 { lo: r.floats()?, hi: r.floats()? };
    let size = nodes.checked_mul(NODE)?.checked_add(blocks.checked_mul(BLOCK)?)?;
    if !header_fits || r.0.len() != size {
        return None;
    }
    let mut tree =
        WideTree { nodes: Vec::with_capacity(nodes), blocks: Vec::with_capacity(blocks), root, bounds };
    for _ in 0..nodes {
        let node = Node { bounds: rows(&mut r)?, children: r.words()?.map(Child), unused: [0; 8] };
        tree.nodes.push(node);
    }
    for _ in 0..blocks {
        let corners = [rows(&mut r)?, rows(&mut r)?, rows(&mut r)?];
        tree.blocks.push(Block { corners, ids: r.words()? });
    }
    (is_sound(&tree, skipped, soup)).then_some((tree, skipped))
}

fn rows<const N: usize>(r: &mut Reader) -> Option<[[f32; 8]; N]> {
    let mut out = [[0.0; 8]; N];
    for row in &mut out {
        *row = r.floats()?;
    }
    Some(out)
}

/// Whether every child and leaf lies inside the arrays, each node is reached once and only from one
/// before it, the stack suffices, and the leaves hold each triangle with its right corners and
/// inside the boxes above it.
fn is_sound(tree: &WideTree, skipped: usize, soup: &Soup) -> bool {
    let Some(expected) = soup.triangles.len().checked_sub(skipped) else { return false };
    if expected == 0 {
        return tree.nodes.is_empty() && tree.blocks.is_empty() && tree.root == Child::NONE;
    }
    let mut check = Check {
        tree,
        soup,
        node_seen: vec![false; tree.nodes.len()],
        block_seen: vec![false; tree.blocks.len()],
        triangle_seen: vec![false; soup.triangles.len()],
    };
    if !check.child(tree.root, &tree.bounds, None) {
        return false;
    }
    for (i, node) in tree.nodes.iter().enumerate() {
        for (place, &child) in node.children.iter().enumerate() {
            let bounds = node.child_bounds(place);
            let sound = if child == Child::NONE {
                bounds == Box3::EMPTY
            } else {
                check.child(child, &bounds, Some(i))
            };
            if !sound {
                return false;
            }
        }
    }
    let all = |seen: &[bool]| seen.iter().all(|s| *s);
    let triangles = check.triangle_seen.iter().filter(|s| **s).count();
    // What is left out may only be what a builder leaves out.
    let left_out = (0..).zip(&check.triangle_seen).filter(|(_, seen)| !**seen);
    all(&check.node_seen)
        && all(&check.block_seen)
        && triangles == expected
        && left_out.into_iter().all(|(id, _)| !is_traceable(&soup.corners(id)))
        && stack_need(&tree.nodes, tree.root) <= 7 * TRIANGLE_DEPTH as usize
}

struct Check<'a> {
    tree: &'a WideTree,
    soup: &'a Soup<'a>,
    node_seen: Vec<bool>,
    block_seen: Vec<bool>,
    triangle_seen: Vec<bool>,
}

impl Check<'_> {
    fn child(&mut self, child: Child, bounds: &Box3, parent: Option<usize>) -> bool {
        if child.is_leaf() {
            return self.leaf(child, bounds);
        }
        let index = child.0 as usize;
        let Some(node) = self.tree.nodes.get(index) else { return false };
        let fresh = !std::mem::replace(&mut self.node_seen[index], true);
        let present = (0..8).filter(|&place| node.children[place] != Child::NONE);
        let fits = |place: usize| bounds.holds(&node.child_bounds(place));
        fresh && parent.is_none_or(|p| index > p) && present.clone().count() > 0 && present.clone().all(fits)
    }

    fn leaf(&mut self, leaf: Child, bounds: &Box3) -> bool {
        let first = leaf.first() as usize;
        let range = first..first + leaf.blocks() as usize;
        if range.is_empty() || range.end > self.tree.blocks.len() {
            return false;
        }
        range.into_iter().all(|i| {
            let fresh = !std::mem::replace(&mut self.block_seen[i], true);
            let block = &self.tree.blocks[i];
            fresh && (0..8).all(|place| self.triangle(block, place, bounds))
        })
    }

    fn triangle(&mut self, block: &Block, place: usize, bounds: &Box3) -> bool {
        let corners = block.corners.map(|c| c.map(|row| row[place]));
        let id = block.ids[place];
        if id == Block::UNUSED {
            return corners == [[0.0; 3]; 3];
        }
        let Some(seen) = self.triangle_seen.get_mut(id as usize) else { return false };
        let fresh = !std::mem::replace(seen, true);
        fresh && corners == self.soup.corners(id) && bounds.holds(&Box3::of(&corners))
    }
}
