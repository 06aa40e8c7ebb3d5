//! The geometry of a scene and the two questions asked of it.

use crate::build::Builder;
use crate::mesh::TriangleMesh;
use crate::movement::Movement;
use crate::object::Object;
use crate::ray::{Hit, Ray};
use crate::shapes::{hit_plane, hit_sphere};
use crate::stop::Stop;
use crate::store::TreeStore;
use crate::traverse::{Kernel, NoSpecials, Portable, RawHit, Specials, View};
use crate::trees::Trees;
use crate::wide::Child;
use indigo_math::{Bounds3, Float, Real, Transform, Vec3, Vec3d};
use std::marker::PhantomData;

/// How to build an [`Accel`].
#[derive(Clone, Debug)]
pub struct BuildOptions {
    /// Trees of more triangles than this get the fast, low-memory builder (`bih_tri_threshold`).
    pub fast_threshold: usize,
    /// A mesh used several times is still baked into the common tree where its uses hold no more
    /// triangles than this together.
    pub bake_limit: usize,
    /// Which kernel traces.
    pub kernel: KernelChoice,
    /// Ends building early, with [`BuildError::Stopped`].
    pub stop: Stop,
}

impl Default for BuildOptions {
    fn default() -> Self {
        Self {
            fast_threshold: 1_100_000,
            bake_limit: 20_000,
            kernel: KernelChoice::Fastest,
            stop: Stop::default(),
        }
    }
}

impl BuildOptions {
    pub(crate) fn builder_for(&self, triangles: usize) -> Builder {
        if triangles > self.fast_threshold { Builder::Fast } else { Builder::Quality }
    }
}

/// Which kernel traces; all give the same hits.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum KernelChoice {
    /// The fastest that this processor can run.
    #[default]
    Fastest,
    /// The one without intrinsics.
    Portable,
}

/// Why a scene's geometry cannot be built.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum BuildError {
    /// An object names a mesh that is not there.
    #[error("object {object} uses mesh {mesh}, but there are {meshes}")]
    NoSuchMesh {
        /// The object.
        object: usize,
        /// The mesh it names.
        mesh: u32,
        /// How many there are.
        meshes: usize,
    },
    /// A radius is not above 0, a normal is 0, or a number is not finite.
    #[error("object {0} has a number without a meaning: radius, centre, normal or position")]
    Unsound(usize),
    /// More than [`TriangleMesh::MAX_TRIANGLES`] triangles in all trees, as many objects, or 2^32 vertices.
    #[error("a scene of {0} triangles, vertices or objects is too large")]
    TooLarge(usize),
    /// The trees are not wanted any more.
    #[error("building was stopped")]
    Stopped,
}

/// What an [`Accel`] holds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Stats {
    /// Triangles in all trees; a mesh that is instanced counts once.
    pub triangles: usize,
    /// Triangles left out since they are not finite or have no area.
    pub skipped_triangles: usize,
    /// Meshes placed by reference to a shared tree.
    pub instances: usize,
    /// Spheres and planes.
    pub shapes: usize,
    /// Bytes of nodes and leaves.
    pub tree_bytes: usize,
    /// Bytes of the meshes' own arrays.
    pub mesh_bytes: usize,
    /// Trees taken from the store instead of being built.
    pub trees_loaded: usize,
}

/// All geometry of a scene, ready to be traced. Immutable, and shared by all threads.
pub struct Accel {
    pub(crate) meshes: Vec<TriangleMesh>,
    pub(crate) objects: Vec<Object>,
    /// How objects move that do, by number.
    movements: Vec<(u32, Movement)>,
    trees: Trees,
    kernel: ChosenKernel,
}

/// The kernel, once the processor has been asked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum ChosenKernel {
    #[cfg(target_arch = "x86_64")]
    Avx2,
    Portable,
}

impl ChosenKernel {
    fn new(choice: KernelChoice) -> Self {
        #[cfg(target_arch = "x86_64")]
        {
            let single = size_of::<Real>() == size_of::<f32>();
            if choice == KernelChoice::Fastest && single && crate::traverse::Avx2::is_available() {
                return Self::Avx2;
            }
        }
        let _ = choice;
        Self::Portable
    }
}

impl Accel {
    /// Builds the trees of a scene, in the caller's rayon pool.
    ///
    /// A mesh used once is baked into one tree in render space; a mesh used often is built once in
    /// its own space and instanced. Trees found in `store` are checked and used, others are built
    /// and handed to it.
    pub fn build(
        meshes: Vec<TriangleMesh>,
        objects: Vec<Object>,
        options: &BuildOptions,
        store: &dyn TreeStore,
    ) -> Result<Self, BuildError> {
        Self::build_moving(meshes, objects, vec![], options, store)
    }

    /// The same where some of the objects, all of them meshes, move: `movements` tells of each its number and how, and the
    /// object's own place is that at time 0.
    pub fn build_moving(
        meshes: Vec<TriangleMesh>,
        mut objects: Vec<Object>,
        mut movements: Vec<(u32, Movement)>,
        options: &BuildOptions,
        store: &dyn TreeStore,
    ) -> Result<Self, BuildError> {
        check(&meshes, &objects)?;
        movements.sort_by_key(|(object, _)| *object);
        movements.dedup_by_key(|(object, _)| *object);
        check_movements(&movements, &objects)?;
        objects.iter_mut().for_each(Object::normalize);
        let trees = Trees::build(&meshes, &objects, &movements, options, store)?;
        Ok(Self { meshes, objects, movements, trees, kernel: ChosenKernel::new(options.kernel) })
    }

    /// How an object moves, if it does.
    #[inline]
    pub fn movement(&self, object: u32) -> Option<&Movement> {
        movement_of(&self.movements, object)
    }

    /// The first hit of a ray, if there is one.
    #[inline]
    pub fn intersect(&self, ray: &Ray) -> Option<Hit> {
        match self.kernel {
            #[cfg(target_arch = "x86_64")]
            ChosenKernel::Avx2 => self.closest::<crate::traverse::Avx2>(ray),
            ChosenKernel::Portable => self.closest::<Portable<Real>>(ray),
        }
    }

    /// Whether a ray hits anything.
    #[inline]
    pub fn occluded(&self, ray: &Ray) -> bool {
        match self.kernel {
            #[cfg(target_arch = "x86_64")]
            ChosenKernel::Avx2 => self.any::<crate::traverse::Avx2>(ray),
            ChosenKernel::Portable => self.any::<Portable<Real>>(ray),
        }
    }

    /// The box round everything but planes, which have none.
    pub fn bounds(&self) -> Bounds3 {
        let b = self.trees.bounds;
        let to_vec = |p: [f32; 3]| Vec3::<f32>::from(p).cast();
        Bounds3 { lo: to_vec(b.lo), hi: to_vec(b.hi) }
    }

    /// Counts and sizes.
    pub fn stats(&self) -> Stats {
        let mesh_bytes = self.meshes.iter().map(TriangleMesh::bytes).sum();
        let shapes = self.objects.iter().filter(|o| !matches!(o, Object::Mesh { .. })).count();
        Stats { shapes, mesh_bytes, ..self.trees.stats }
    }

    /// The objects, by id. Planes have unit normals here.
    pub fn objects(&self) -> &[Object] {
        &self.objects
    }

    /// The meshes, by id.
    pub fn meshes(&self) -> &[TriangleMesh] {
        &self.meshes
    }

    /// A box round an object in render space, wherever it comes; planes have no end.
    pub fn object_bounds(&self, object: u32) -> Bounds3<f64> {
        match &self.objects[object as usize] {
            Object::Mesh { mesh, .. } if self.movement(object).is_some() => {
                let points = self.meshes[*mesh as usize].positions();
                let own = Bounds3::of_points(points.iter().map(|p| Vec3d::from(p.map(f64::from))));
                let movement = self.movement(object).filter(|_| !own.is_empty());
                movement.map_or(own, |movement| movement.bounds(&own))
            }
            Object::Mesh { mesh, transform } => {
                let points = self.meshes[*mesh as usize].positions();
                Bounds3::of_points(points.iter().map(|p| transform.point(Vec3d::from(p.map(f64::from)))))
            }
            Object::Sphere { center, radius } => {
                let r = Vec3d::splat(*radius);
                Bounds3 { lo: *center - r, hi: *center + r }
            }
            Object::Plane { .. } => {
                Bounds3 { lo: Vec3d::splat(f64::NEG_INFINITY), hi: Vec3d::splat(f64::INFINITY) }
            }
        }
    }

    /// Whether a mesh's objects are part of the baked tree.
    pub(crate) fn is_baked(&self, mesh: u32) -> bool {
        !self.trees.is_instanced[mesh as usize]
    }

    #[inline(always)]
    fn view(&self) -> View<'_> {
        View { nodes: &self.trees.nodes, blocks: &self.trees.blocks }
    }

    #[inline(always)]
    fn closest<K: Kernel>(&self, ray: &Ray) -> Option<Hit> {
        if !ray.is_sound() {
            return None;
        }
        let mut hit = RawHit::none(K::Scalar::from_f64(ray.t_max.to_f64()));
        let mut found = self.walk::<K, false>(ray, &mut hit);
        for &object in &self.trees.planes {
            found |= self.test_plane(object, ray, &mut hit);
        }
        found.then(|| self.named(&hit))
    }

    #[inline(always)]
    fn any<K: Kernel>(&self, ray: &Ray) -> bool {
        if !ray.is_sound() {
            return false;
        }
        let mut hit = RawHit::none(K::Scalar::from_f64(ray.t_max.to_f64()));
        self.trees.planes.iter().any(|&object| self.test_plane(object, ray, &mut hit))
            || self.walk::<K, true>(ray, &mut hit)
    }

    #[inline(always)]
    fn walk<K: Kernel, const ANY: bool>(&self, ray: &Ray, hit: &mut RawHit<K::Scalar>) -> bool {
        if self.trees.root == Child::NONE {
            false
        } else if self.trees.specials.is_empty() {
            K::walk::<ANY, _>(self.view(), self.trees.root, ray, hit, &NoSpecials)
        } else {
            let specials = SceneSpecials::<K> { accel: self, ray, kernel: PhantomData };
            K::walk::<ANY, _>(self.view(), self.trees.root, ray, hit, &specials)
        }
    }

    fn test_plane<T: Float>(&self, object: u32, ray: &Ray, hit: &mut RawHit<T>) -> bool {
        let Object::Plane { normal, dist, .. } = self.objects[object as usize] else { return false };
        let t = hit_plane(ray, normal, dist, Real::from_f64(hit.t.to_f64()));
        set_shape_hit(hit, t, object)
    }

    /// The hit with the object's and mesh's own numbers.
    #[inline]
    fn named<T: Float>(&self, hit: &RawHit<T>) -> Hit {
        let real = |v: T| Real::from_f64(v.to_f64());
        let (object, primitive) = if hit.object == RawHit::<T>::BAKED {
            self.trees.baked_owner(hit.id)
        } else {
            (hit.object, hit.id)
        };
        Hit { t: real(hit.t), u: real(hit.u), v: real(hit.v), object, primitive }
    }
}

fn check(meshes: &[TriangleMesh], objects: &[Object]) -> Result<(), BuildError> {
    if objects.len() > TriangleMesh::MAX_TRIANGLES {
        return Err(BuildError::TooLarge(objects.len()));
    }
    for (i, object) in objects.iter().enumerate() {
        if !object.is_sound() {
            return Err(BuildError::Unsound(i));
        }
        if let Object::Mesh { mesh, .. } = *object
            && mesh as usize >= meshes.len()
        {
            return Err(BuildError::NoSuchMesh { object: i, mesh, meshes: meshes.len() });
        }
    }
    Ok(())
}

/// Only meshes move, and what single precision does not hold is refused at each of their turns.
fn check_movements(movements: &[(u32, Movement)], objects: &[Object]) -> Result<(), BuildError> {
    for (object, movement) in movements {
        let Some(Object::Mesh { mesh, .. }) = objects.get(*object as usize) else {
            return Err(BuildError::Unsound(*object as usize));
        };
        let at = |transform| Object::Mesh { mesh: *mesh, transform };
        if !movement.places().all(|place| at(place).is_sound()) {
            return Err(BuildError::Unsound(*object as usize));
        }
    }
    Ok(())
}

/// The movement of an object in a list in order of their numbers.
#[inline]
pub(crate) fn movement_of(movements: &[(u32, Movement)], object: u32) -> Option<&Movement> {
    if movements.is_empty() {
        return None;
    }
    movements.binary_search_by_key(&object, |(object, _)| *object).ok().map(|i| &movements[i].1)
}

fn set_shape_hit<T: Float>(hit: &mut RawHit<T>, t: Option<Real>, object: u32) -> bool {
    if let Some(t) = t {
        *hit = RawHit { object, id: 0, ..RawHit::none(T::from_f64(t.to_f64())) };
    }
    t.is_some()
}

/// Instances and spheres met while walking the upper tree.
struct SceneSpecials<'a, K> {
    accel: &'a Accel,
    ray: &'a Ray,
    kernel: PhantomData<K>,
}

impl<K: Kernel> Specials<K::Scalar> for SceneSpecials<'_, K> {
    const PRESENT: bool = true;

    #[inline(never)]
    fn test<const ANY: bool>(&self, number: u32, hit: &mut RawHit<K::Scalar>) -> bool {
        let Some(special) = self.accel.trees.specials.get(number as usize) else { return false };
        match &self.accel.objects[special.object as usize] {
            Object::Mesh { transform, .. } => {
                let ray = match self.accel.movement(special.object) {
                    None => instance_ray(self.ray, transform),
                    Some(movement) => instance_ray(self.ray, &movement.at(self.ray.time)),
                };
                // The kernel's promises hold for sound rays only, and the image of one need not be.
                if !ray.is_sound() {
                    return false;
                }
                let mut inner = RawHit::none(hit.t);
                let view = self.accel.view();
                let found = K::walk::<ANY, _>(view, special.root, &ray, &mut inner, &NoSpecials);
                if found {
                    *hit = RawHit { object: special.object, ..inner };
                }
                found
            }
            Object::Sphere { center, radius } => {
                let t_max = Real::from_f64(hit.t.to_f64());
                set_shape_hit(hit, hit_sphere(self.ray, *center, *radius, t_max), special.object)
            }
            // Planes are not in the tree.
            Object::Plane { .. } => false,
        }
    }
}

/// The ray in an instance's own space, with the same parameter.
fn instance_ray(ray: &Ray, transform: &Transform) -> Ray {
    Ray {
        o: transform.inverse_point(ray.o.cast::<f64>()).cast(),
        d: transform.inverse_vector(ray.d.cast::<f64>()).cast(),
        ..*ray
    }
}
