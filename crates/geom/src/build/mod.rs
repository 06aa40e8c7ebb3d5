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
pub(crate) use collapse::{LeafMaker, Size, collapse};

use crate::soup::Soup;
use crate::stop::Stop;
use crate::wide::{Block, Box3, Child, WideTree};
use indigo_math::pages::with_capacity;
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
/// they are not finite or have no area. `None` where it was stopped.
pub(crate) fn build_triangles(soup: &Soup, builder: Builder, stop: &Stop) -> Option<(WideTree, usize)> {
    let mut prims = triangle_prims(soup);
    let skipped = soup.triangles.len() - prims.len();
    if prims.is_empty() {
        return Some((WideTree::empty(), skipped));
    }
    let max_leaf = match builder {
        Builder::Fast => 4,
        Builder::Quality => 1,
    };
    let mut binary = split_all(&mut prims, max_leaf, TRIANGLE_DEPTH, stop);
    if builder == Builder::Quality && !stop.is_set() {
        // A tree that has become too deep is left as it was.
        binary = reinsert::improve(&binary, TRIANGLE_DEPTH, stop).unwrap_or(binary);
    }
    if stop.is_set() {
        return None;
    }
    let (nodes, blocks, root) = collapse(&binary, &prims, &BlockMaker { soup }, Size::default());
    let bounds = binary[0].bounds();
    Some((WideTree { nodes, blocks, root, bounds }, skipped))
}

fn triangle_prims(soup: &Soup) -> Vec<Prim> {
    let prim = |id: u32| {
        let c = soup.corners(id);
        if is_traceable(&c) { Prim::new(&Box3::of(&c), id) } else { Prim::NONE }
    };
    let ids = 0..soup.triangles.len() as u32;
    let mut prims = with_capacity(ids.len());
    // In place; a parallel filter would have to collect everything twice.
    prims.par_extend(ids.into_par_iter().map(prim));
    prims.retain(|p| p.id() != Prim::NONE.id());
    prims
}

/// Whether a triangle is finite and has an area.
pub(crate) fn is_traceable(c: &[[f32; 3]; 3]) -> bool {
    let v = c.map(|p| indigo_math::Vec3d::from(p.map(f64::from)));
    let area = (v[1] - v[0]).cross(v[2] - v[0]).length2();
    c.iter().flatten().all(|x| x.is_finite()) && area > 0.0
}

/// Makes leaves of triangle blocks.
struct BlockMaker<'a> {
    soup: &'a Soup<'a>,
}

impl LeafMaker for BlockMaker<'_> {
    const WIDTH: u32 = 8;
    const MAX_BLOCKS: u32 = crate::wide::MAX_LEAF_BLOCKS;
    type Block = Block;
    const EMPTY: Block = Block::EMPTY;

    fn make(&self, ids: &[u32], blocks: &mut [Block], first: usize) -> Child {
        for (block, chunk) in blocks.iter_mut().zip(ids.chunks(8)) {
            for (place, &id) in chunk.iter().enumerate() {
                block.set(place, &self.soup.corners(id), id);
            }
        }
        Child::leaf(first, blocks.len() as u32)
    }
}
