//! The trees of a scene: the baked one, those of instanced meshes, and the upper one over both.

use crate::accel::{BuildError, BuildOptions, Stats, movement_of};
use crate::cache::load_or_build;
use crate::mesh::TriangleMesh;
use crate::movement::Movement;
use crate::object::Object;
use crate::soup::{Soup, bake};
use crate::store::TreeStore;
use crate::top::{TopItem, build_top, moving_box, open, sphere_box, transformed_box};
use crate::wide::{Block, Box3, Child, Node};
use indigo_math::pages::in_huge_pages;

/// What a leaf without triangles stands for.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Special {
    /// The object.
    pub object: u32,
    /// The root of its mesh's tree; nothing for a sphere.
    pub root: Child,
}

/// All trees behind each other.
pub(crate) struct Trees {
    /// Nodes of all trees, the upper one last.
    pub nodes: Vec<Node>,
    /// Triangles of all trees.
    pub blocks: Vec<Block>,
    /// Where rays begin; [`Child::NONE`] where there is no tree.
    pub root: Child,
    /// Box round the root.
    pub bounds: Box3,
    /// Instances and spheres, by the number in their leaf.
    pub specials: Vec<Special>,
    /// Objects that are planes.
    pub planes: Vec<u32>,
    /// Counts; those of shapes and meshes are left at 0.
    pub stats: Stats,
    /// For each mesh whether it has a tree of its own.
    pub is_instanced: Vec<bool>,
    /// First triangle of each baked object in the baked tree, ascending, and the object.
    baked: Vec<(u32, u32)>,
}

impl Trees {
    /// Builds or loads what the objects need.
    pub(crate) fn build(
        meshes: &[TriangleMesh],
        objects: &[Object],
        movements: &[(u32, Movement)],
        options: &BuildOptions,
        store: &dyn TreeStore,
    ) -> Result<Self, BuildError> {
        let plan = Plan::new(meshes, objects, movements, options);
        plan.check(meshes, objects)?;
        let mut forest = Forest { nodes: Vec::new(), blocks: Vec::new(), stats: Stats::default(), trees: 0 };
        let (soup, baked) = bake(meshes, objects, &plan.baked);
        let (mut root, mut bounds) = forest.add(&soup, options, store)?;
        drop(soup);
        let mut roots = vec![(Child::NONE, Box3::EMPTY); meshes.len()];
        for &mesh in &plan.instanced {
            roots[mesh as usize] = forest.add(&Soup::of(&meshes[mesh as usize]), options, store)?;
        }
        let (mut items, specials) = special_items(objects, movements, &plan, &roots);
        if !items.is_empty() {
            if root != Child::NONE {
                items.extend(open(root, bounds, &forest.nodes));
            }
            (root, bounds) = build_top(&items, &mut forest.nodes);
        }
        let is_one_tree = forest.trees == 1 && items.is_empty();
        let Forest { mut nodes, mut blocks, mut stats, .. } = forest;
        if !is_one_tree {
            // A builder's own arrays are in huge pages; those that grew are not.
            (nodes, blocks) = (in_huge_pages(&nodes), in_huge_pages(&blocks));
        }
        stats.tree_bytes = size_of_val(nodes.as_slice()) + size_of_val(blocks.as_slice());
        stats.instances = specials.iter().filter(|s| s.root != Child::NONE).count();
        let is_plane = |&i: &u32| matches!(objects[i as usize], Object::Plane { .. });
        Ok(Self {
            nodes,
            blocks,
            root,
            bounds,
            specials,
            planes: (0..objects.len() as u32).filter(is_plane).collect(),
            stats,
            is_instanced: plan.is_instanced,
            baked,
        })
    }

    /// The object and the triangle of its mesh that a triangle of the baked tree belongs to.
    #[inline]
    pub(crate) fn baked_owner(&self, triangle: u32) -> (u32, u32) {
        let behind = self.baked.partition_point(|&(first, _)| first <= triangle);
        let (first, object) = self.baked[behind - 1];
        (object, triangle - first)
    }
}

/// Trees behind each other while they are built.
struct Forest {
    nodes: Vec<Node>,
    blocks: Vec<Block>,
    stats: Stats,
    trees: usize,
}

impl Forest {
    /// Adds the tree of some triangles; returns its root and box.
    fn add(
        &mut self,
        soup: &Soup,
        options: &BuildOptions,
        store: &dyn TreeStore,
    ) -> Result<(Child, Box3), BuildError> {
        let builder = options.builder_for(soup.triangles.len());
        let built = load_or_build(soup, builder, store, &options.stop);
        let (tree, skipped, loaded) = built.ok_or(BuildError::Stopped)?;
        self.stats.triangles += soup.triangles.len() - skipped;
        self.stats.skipped_triangles += skipped;
        self.stats.trees_loaded += usize::from(loaded);
        self.trees += 1;
        if self.nodes.is_empty() && self.blocks.is_empty() {
            (self.nodes, self.blocks) = (tree.nodes, tree.blocks);
            return Ok((tree.root, tree.bounds));
        }
        let (n, b) = (self.nodes.len(), self.blocks.len());
        let moved = |node: &Node| Node { children: node.children.map(|c| c.moved(n, b)), ..*node };
        self.nodes.extend(tree.nodes.iter().map(moved));
        self.blocks.extend(tree.blocks);
        Ok((tree.root.moved(n, b), tree.bounds))
    }
}

/// The instances and spheres as things of the upper tree, and by number.
fn special_items(
    objects: &[Object],
    movements: &[(u32, Movement)],
    plan: &Plan,
    roots: &[(Child, Box3)],
) -> (Vec<TopItem>, Vec<Special>) {
    let (mut items, mut specials) = (Vec::new(), Vec::new());
    for (i, object) in objects.iter().enumerate() {
        let (root, bounds) = match object {
            Object::Plane { .. } => continue,
            Object::Sphere { center, radius } => (Child::NONE, sphere_box(*center, *radius)),
            Object::Mesh { mesh, transform } => {
                let (root, bounds) = roots[*mesh as usize];
                if plan.is_baked(*mesh) || root == Child::NONE {
                    continue;
                }
                let bounds = match movement_of(movements, i as u32) {
                    None => transformed_box(&bounds, transform),
                    Some(movement) => moving_box(&bounds, movement),
                };
                (root, bounds)
            }
        };
        items.push(TopItem { bounds, child: Child::special(specials.len() as u32) });
        specials.push(Special { object: i as u32, root });
    }
    (items, specials)
}

/// Which meshes are baked and which are shared.
struct Plan {
    /// Objects to bake.
    baked: Vec<u32>,
    /// Meshes to build in their own space.
    instanced: Vec<u32>,
    is_instanced: Vec<bool>,
}

impl Plan {
    fn new(
        meshes: &[TriangleMesh],
        objects: &[Object],
        movements: &[(u32, Movement)],
        options: &BuildOptions,
    ) -> Self {
        let mut uses = vec![0usize; meshes.len()];
        let mesh_of =
            |o: &Object| if let Object::Mesh { mesh, .. } = o { Some(*mesh as usize) } else { None };
        objects.iter().filter_map(mesh_of).for_each(|m| uses[m] += 1);
        let mut is_instanced: Vec<bool> = meshes
            .iter()
            .zip(&uses)
            .map(|(m, &n)| n > 1 && m.triangles().len().saturating_mul(n) > options.bake_limit)
            .collect();
        // What moves has no one place to be baked at.
        let moving = movements.iter().filter_map(|(object, _)| mesh_of(&objects[*object as usize]));
        moving.for_each(|mesh| is_instanced[mesh] = true);
        let is_baked = |o: &Object| mesh_of(o).is_some_and(|m| !is_instanced[m]);
        Self {
            baked: (0..objects.len() as u32).filter(|&o| is_baked(&objects[o as usize])).collect(),
            instanced: (0..meshes.len() as u32).filter(|&m| is_instanced[m as usize]).collect(),
            is_instanced,
        }
    }

    /// All trees share one array of nodes and one of blocks, which are numbered in few bits.
    fn check(&self, meshes: &[TriangleMesh], objects: &[Object]) -> Result<(), BuildError> {
        let baked = self.baked.iter().filter_map(|&o| match objects[o as usize] {
            Object::Mesh { mesh, .. } => Some(mesh),
            _ => None,
        });
        let sizes = |m: u32| (meshes[m as usize].triangles().len(), meshes[m as usize].positions().len());
        let all = baked.chain(self.instanced.iter().copied()).map(sizes);
        let (triangles, vertices) = all.fold((0, 0), |(t, v), (dt, dv)| (t + dt, v + dv));
        let largest = TriangleMesh::MAX_TRIANGLES;
        let fits = triangles <= largest && u32::try_from(vertices).is_ok();
        if fits { Ok(()) } else { Err(BuildError::TooLarge(triangles.max(vertices))) }
    }

    fn is_baked(&self, mesh: u32) -> bool {
        !self.is_instanced[mesh as usize]
    }
}
