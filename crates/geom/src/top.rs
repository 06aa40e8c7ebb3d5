//! The tree above the trees: instances, spheres, and the baked tree opened into a few subtrees.

use crate::build::{LeafMaker, Prim, Size, TOP_DEPTH, collapse, split_all};
use crate::movement::Movement;
use crate::stop::Stop;
use crate::wide::{Box3, Child, Node};
use indigo_math::{Bounds3, Transform, Vec3d};

/// Into how many subtrees the baked tree is opened, so that what lies inside its box is not found
/// only after all of it.
const OPENED: usize = 64;

/// One thing that the upper tree holds.
pub(crate) struct TopItem {
    /// Box in render space.
    pub bounds: Box3,
    /// What to do there.
    pub child: Child,
}

struct Items<'a>(&'a [TopItem]);

impl LeafMaker for Items<'_> {
    const WIDTH: u32 = 1;
    const MAX_BLOCKS: u32 = 1;
    type Block = ();
    const EMPTY: () = ();
    fn make(&self, ids: &[u32], _blocks: &mut [()], _first: usize) -> Child {
        self.0[ids[0] as usize].child
    }
}

/// Builds the upper tree; its nodes go behind `nodes`. Returns its root and box.
pub(crate) fn build_top(items: &[TopItem], nodes: &mut Vec<Node>) -> (Child, Box3) {
    if items.is_empty() {
        return (Child::NONE, Box3::EMPTY);
    }
    let prim = |(i, item): (usize, &TopItem)| Prim::new(&item.bounds, i as u32);
    let mut prims: Vec<Prim> = items.iter().enumerate().map(prim).collect();
    let binary = split_all(&mut prims, 1, TOP_DEPTH, &Stop::default());
    let first = Size { nodes: nodes.len(), blocks: 0 };
    let (upper, _, root) = collapse(&binary, &prims, &Items(items), first);
    nodes.extend(upper);
    (root, binary[0].bounds())
}

/// Replaces a tree by subtrees of it, the largest opened first.
pub(crate) fn open(root: Child, bounds: Box3, nodes: &[Node]) -> Vec<TopItem> {
    let mut items = vec![TopItem { bounds, child: root }];
    while items.len() < OPENED {
        let inner = items.iter().enumerate().filter(|(_, item)| !item.child.is_leaf());
        let area = |item: &TopItem| item.bounds.half_area();
        let Some((largest, _)) = inner.max_by(|a, b| area(a.1).total_cmp(&area(b.1))) else { break };
        let node = &nodes[items.swap_remove(largest).child.0 as usize];
        for (place, &child) in node.children.iter().enumerate() {
            if child != Child::NONE {
                items.push(TopItem { bounds: node.child_bounds(place), child });
            }
        }
    }
    items
}

/// A box round the image of a box, a few roundings wider than need be.
pub(crate) fn transformed_box(bounds: &Box3, transform: &Transform) -> Box3 {
    let corner = |i: usize| {
        let pick = |axis: usize| if i >> axis & 1 == 0 { bounds.lo[axis] } else { bounds.hi[axis] };
        transform.point(Vec3d::new(pick(0).into(), pick(1).into(), pick(2).into()))
    };
    outward(&Bounds3::of_points((0..8).map(corner)))
}

/// The same wherever a moving thing comes.
pub(crate) fn moving_box(bounds: &Box3, movement: &Movement) -> Box3 {
    let corner = |p: [f32; 3]| Vec3d::from(p.map(f64::from));
    outward(&movement.bounds(&Bounds3 { lo: corner(bounds.lo), hi: corner(bounds.hi) }))
}

/// A box round a sphere.
pub(crate) fn sphere_box(center: Vec3d, radius: f64) -> Box3 {
    let r = Vec3d::splat(radius);
    outward(&Bounds3 { lo: center - r, hi: center + r })
}

/// To single precision, away from the inside. The margin covers the rounding of a ray that is taken into an instance's
/// own space, where its mesh lies about as far from the origin as it does here.
fn outward(b: &Bounds3<f64>) -> Box3 {
    let margin = |v: f64| v.abs() * 4.0 * f64::from(f32::EPSILON) + f64::from(f32::MIN_POSITIVE);
    Box3 {
        lo: b.lo.to_array().map(|v| (v - margin(v)) as f32),
        hi: b.hi.to_array().map(|v| (v + margin(v)) as f32),
    }
}
