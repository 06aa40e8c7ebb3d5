//! Building trees: a binary tree first, by one of two builders, then its collapse to eight children.
//!
//! `fast` is a binned SAH build down to small leaves: little memory, short time. `quality` builds
//! down to single triangles and then improves the tree by reinsertion.

mod binary;
mod binned;
mod collapse;
mod reinsert;

pub(crate) use binary::Prim;
pub(crate) use binned::split_all;
pub(crate) use collapse::{LeafMaker, collapse};

use crate::soup::Soup;
use crate::wide::{Block, Box3, Child, WideTree};
use rayon::prelude::*;

/// Levels of a tree of triangles; bounds what it asks of the traversal stack.
pub(crate) const TRIANGLE_DEPTH: u32 = 64;
/// Levels of the tree above it that holds instances and spheres.
pub(crate) const TOP_DEPTH: u32 = 27;

/// Which builder.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Builder {
    /// Short build, little memory.
    Fast,
    /// Fewer steps a ray.
    Quality,
}

/// A tree over triangles; returns also how many were left out since
/// they are not finite or have no area.
pub(crate) fn build_triangles(soup: &Soup, builder: Builder) -> (WideTree, usize) {
    let mut prims = triangle_prims(soup);
    let skipped = soup.triangles.len() - prims.len();
    if prims.is_empty() {
        return (WideTree::empty(), skipped);
    }
    let max_leaf = match builder {
        Builder::Fast => 4,
        Builder::Quality => 1,
    };
    let mut binary = split_all(&mut prims, max_leaf, TRIANGLE_DEPTH);
    if builder == Builder::Quality {
        // A tree that has become too deep is left as it was.
        binary = reinsert::improve(&binary, TRIANGLE_DEPTH).unwrap_or(binary);
    }
    let mut maker = BlockMaker { soup, blocks: Vec::new() };
    let mut nodes = Vec::new();
    let root = collapse(&binary, &prims, &mut maker, &mut nodes);
    let bounds = binary[0].bounds();
    (WideTree { nodes, blocks: maker.blocks, root, bounds }, skipped)
}

fn triangle_prims(soup: &Soup) -> Vec<Prim> {
    let prim = |id: u32| {
        let c = soup.corners(id);
        is_traceable(&c).then(|| Prim::new(&Box3::of(&c), id))
    };
    (0..soup.triangles.len() as u32).into_par_iter().filter_map(prim).collect()
}

/// Whether a triangle is finite and has an area.
fn is_traceable(c: &[[f32; 3]; 3]) -> bool {
    let v = c.map(|p| indigo_math::Vec3d::from(p.map(f64::from)));
    let area = (v[1] - v[0]).cross(v[2] - v[0]).length2();
    c.iter().flatten().all(|x| x.is_finite()) && area > 0.0
}

/// Makes leaves of triangle blocks.
struct BlockMaker<'a> {
    soup: &'a Soup<'a>,
    blocks: Vec<Block>,
}

impl LeafMaker for BlockMaker<'_> {
    const WIDTH: u32 = 8;
    const MAX_BLOCKS: u32 = crate::wide::MAX_LEAF_BLOCKS;

    fn make(&mut self, ids: &[u32]) -> Child {
        let first = self.blocks.len();
        for chunk in ids.chunks(8) {
            let mut block = Block::EMPTY;
            for (place, &id) in chunk.iter().enumerate() {
                block.set(place, &self.soup.corners(id), id);
            }
            self.blocks.push(block);
        }
        Child::leaf(first, (self.blocks.len() - first) as u32)
    }
}
