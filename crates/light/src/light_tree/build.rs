//! Building the tree, from the root down, by the surface area orientation heuristic.
// tidy: load-time mathematics

use super::cluster::Cluster;
use super::node::Node;
use super::{LightTree, NONE, Slot};
use crate::area::AreaLight;
use indigo_math::{Bounds3, Vec3d};

/// Triangles of one lamp that are drawn by flux alone: most lamps are of two, side by side.
const LEAF: usize = 2;
/// Bins along an axis between which a node may be split: more tell hardly better ones.
const BINS: usize = 12;

/// A triangle that shines.
struct Item {
    lamp: u32,
    triangle: u32,
    flux: f64,
    cluster: Cluster,
    middle: Vec3d,
}

/// A tree over the triangles of lamps.
pub(super) fn build(lamps: &[AreaLight]) -> LightTree {
    let mut items: Vec<Item> = vec![];
    let mut tree = LightTree::default();
    for (lamp, light) in lamps.iter().enumerate() {
        tree.offsets.push(tree.slot_of.len() as u32);
        tree.slot_of.resize(tree.slot_of.len() + light.len(), NONE);
        let flux = light.weight();
        items.extend((0..light.len()).filter_map(|i| item(light, flux, [lamp, i])));
    }
    let Some(all) = union(&items) else { return tree };
    add(&mut tree.nodes, &mut items, 0, &all, all.intensity);
    for leaf in tree.nodes.iter().filter(|node| node.second == 0) {
        let range = leaf.first as usize..leaf.end as usize;
        let flux: f64 = items[range.clone()].iter().map(|i| i.flux).sum();
        for i in range {
            let Item { lamp, triangle, .. } = items[i];
            tree.slot_of[(tree.offsets[lamp as usize] + triangle) as usize] = i as u32;
            tree.slots.push(Slot { lamp, triangle, part: items[i].flux / flux });
        }
    }
    tree
}

/// A triangle of a lamp of some flux with what is needed of it, if it shines.
fn item(light: &AreaLight, flux: f64, [lamp, triangle]: [usize; 2]) -> Option<Item> {
    let flux = flux * light.share(triangle);
    let lobe = light.lobe(triangle);
    let intensity = flux * lobe.intensity_of_flux();
    let bounds = Bounds3::of_points(light.corners(triangle));
    // What has no normal has hardly an area.
    let shines = intensity.is_finite() && intensity > 0.0 && lobe.axis != Vec3d::ZERO;
    shines.then(|| Item {
        lamp: lamp as u32,
        triangle: triangle as u32,
        flux,
        middle: bounds.center(),
        cluster: Cluster { bounds, lobe, intensity },
    })
}

fn union(items: &[Item]) -> Option<Cluster> {
    items.iter().map(|i| i.cluster).reduce(Cluster::union)
}

/// Adds the nodes of a run of items, which it puts into its own order: a cluster of all lamps of some intensity.
fn add(nodes: &mut Vec<Node>, items: &mut [Item], first: usize, cluster: &Cluster, all: f64) {
    let at = nodes.len();
    nodes.push(Node::new(cluster, all, [first, first + items.len()]));
    let is_one_lamp = items.iter().all(|i| i.lamp == items[0].lamp);
    if items.len() == 1 || is_one_lamp && items.len() <= LEAF {
        return;
    }
    let n = split(items);
    let (left, right) = items.split_at_mut(n);
    if let (Some(of_left), Some(of_right)) = (union(left), union(right)) {
        add(nodes, left, first, &of_left, all);
        nodes[at].second = nodes.len() as u32;
        add(nodes, right, first + n, &of_right, all);
    }
}

/// Puts items into two parts, neither of which is empty, and tells where the second one begins.
fn split(items: &mut [Item]) -> usize {
    let middles = Bounds3::of_points(items.iter().map(|i| i.middle));
    let size = middles.size().to_array();
    let longest = size.iter().copied().fold(0.0, f64::max);
    let bin = |item: &Item, axis: usize| {
        let part = (item.middle[axis] - middles.lo[axis]) / size[axis];
        ((part * BINS as f64) as usize).min(BINS - 1)
    };
    let mut best: Option<(f64, usize, usize)> = None;
    for axis in (0..3).filter(|&axis| size[axis] > 0.0) {
        let mut bins: [Option<Cluster>; BINS] = [None; BINS];
        for item in &*items {
            let sum = &mut bins[bin(item, axis)];
            *sum = Some(sum.map_or(item.cluster, |s| s.union(item.cluster)));
        }
        // Thin slices across the longest side are better than they look (Conty Estevez & Kulla 2018, section 4.4).
        let slender = longest / size[axis];
        for (border, cost) in costs(&bins) {
            if best.is_none_or(|(least, ..)| cost * slender < least) {
                best = Some((cost * slender, axis, border));
            }
        }
    }
    // All at one place: by halves.
    let Some((_, axis, border)) = best else { return items.len() / 2 };
    let mut n = 0;
    for i in 0..items.len() {
        if bin(&items[i], axis) < border {
            items.swap(i, n);
            n += 1;
        }
    }
    n
}

/// The cost of a split before each bin, where there are items on both sides.
fn costs(bins: &[Option<Cluster>; BINS]) -> impl Iterator<Item = (usize, f64)> {
    let add = |sum: Option<Cluster>, bin: Option<Cluster>| match (sum, bin) {
        (Some(a), Some(b)) => Some(a.union(b)),
        (a, b) => a.or(b),
    };
    let mut left = [0.0; BINS];
    let mut right = [0.0; BINS];
    let (mut below, mut above): (Option<Cluster>, Option<Cluster>) = (None, None);
    for i in 1..BINS {
        below = add(below, bins[i - 1]);
        left[i] = below.map_or(f64::NAN, |c| c.cost());
        above = add(above, bins[BINS - i]);
        right[BINS - i] = above.map_or(f64::NAN, |c| c.cost());
    }
    (1..BINS).map(move |i| (i, left[i] + right[i])).filter(|(_, cost)| !cost.is_nan())
}
