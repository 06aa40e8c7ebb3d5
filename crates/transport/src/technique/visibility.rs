//! Rays between vertices: leaving a surface, and what lies between two points.

use super::media::{Passage, World, sides};
use super::vertex::Vertex;
use indigo_geom::{Ray, SurfacePoint, offset_origin, offset_target};
use indigo_light::{EmitterPoint, LightSample};
use indigo_math::{Real, Vec3};
use indigo_scatter::MediumStack;
use indigo_scene::Scene;

/// An end of a straight way.
#[derive(Clone, Copy, Debug)]
pub(super) struct Point {
    pub p: Vec3,
    p_error: Vec3,
    /// Normal of the surface that it lies on; zero in free space.
    n: Vec3,
}

impl Point {
    /// On a surface.
    #[inline]
    pub fn of_surface(at: &SurfacePoint) -> Self {
        Self { p: at.p, p_error: at.p_error, n: at.n_g }
    }

    /// On a lamp.
    #[inline]
    pub fn of_light(at: &EmitterPoint) -> Self {
        Self { p: at.p, p_error: at.p_error, n: at.n }
    }

    /// In free space.
    #[inline]
    pub fn free(p: Vec3) -> Self {
        Self { p, p_error: Vec3::ZERO, n: Vec3::ZERO }
    }

    /// Where a ray begins that leaves in a direction, clear of the surface's own error.
    #[inline]
    fn leave(&self, scene: &Scene, direction: Vec3) -> Vec3 {
        if self.n == Vec3::ZERO {
            return self.p;
        }
        offset_origin(self.p, self.p_error, self.n, direction, scene.nudge_m)
    }

    /// Where a ray ends that comes from the far end of a way back, clear of the surface's own error.
    #[inline]
    fn reach(&self, scene: &Scene, back: Vec3) -> Vec3 {
        if self.n == Vec3::ZERO {
            return self.p;
        }
        offset_target(self.p, self.p_error, self.n, back, scene.nudge_m)
    }

    /// Its place, where it is on a surface: rays leave it a little way off.
    #[inline]
    pub fn on_surface(&self) -> Option<Vec3> {
        (self.n != Vec3::ZERO).then_some(self.p)
    }

    /// Where on a ray of unit direction that leaves it the point is nearest.
    #[inline]
    pub fn behind(&self, ray: &Ray) -> Real {
        (self.p - ray.o).dot(ray.d)
    }

    /// The ray that leaves in a direction.
    #[inline]
    pub fn spawn(&self, world: &World, direction: Vec3) -> Ray {
        world.ray(self.leave(world.scene, direction), direction)
    }

    /// The ray that leaves in a direction through some media.
    ///
    /// Where they scatter it keeps no more than the point's own error from the surface, whatever the scene's nudge is: the
    /// nudge may be many mean free paths, and all that is scattered there would be so much deeper in the medium.
    #[inline]
    pub fn spawn_into(&self, world: &World, direction: Vec3, media: &MediumStack) -> Ray {
        let scatters = world.has_media() && !world.medium(media.current()).scattering.is_black();
        if scatters && self.n != Vec3::ZERO {
            return world.ray(offset_origin(self.p, self.p_error, self.n, direction, 0.0), direction);
        }
        self.spawn(world, direction)
    }
}

/// How far a point is in a unit direction from the plane of a surface, metres; `None` along the plane.
///
/// A ray leaves beside its vertex, by a distance δ along the normal, and meets a plane that leans by θ to it up to δ / cos θ
/// sooner or later than the same ray from the vertex would. That is counted, which is δ sin² θ / cos θ more in a plate than
/// the way from the place on the ray that is nearest to the vertex.
#[inline]
pub(super) fn plane_distance(from: Vec3, direction: Vec3, surface: &SurfacePoint) -> Option<Real> {
    let cos = direction.dot(surface.n_g);
    (cos != 0.0).then(|| ((surface.p - from).dot(surface.n_g) / cos).max(0.0))
}

/// The way from a vertex to the light that was drawn for it; `None` where something stands between.
#[inline]
pub(super) fn way_to_light(world: &World, from: &Vertex, light: &LightSample) -> Option<Passage> {
    match &light.point {
        None => {
            let media = from.media_towards(light.wi);
            let ray = from.point.spawn_into(world, light.wi, media);
            passage(world, &ray, 1.0, from.point.on_surface(), media)
        }
        Some(to) => way(world, from, light.wi, &Point::of_light(to)),
    }
}

/// The way from a point of the lens in direction `wi`, to a lamp or for ever; `None` where something stands between.
#[inline]
pub(super) fn way_from_lens(world: &World, origin: Vec3, wi: Vec3, to: Option<&Point>) -> Option<Passage> {
    let (from, ray) = (Point::free(origin), world.ray(origin, wi));
    let media = world.scene.camera_media_along(&ray);
    match to {
        None => passage(world, &ray, 1.0, None, &media),
        Some(to) => between(world, &from, &media, to),
    }
}

/// The way from a vertex to a point in direction `wi`; `None` where something stands between.
#[inline]
pub(super) fn way(world: &World, from: &Vertex, wi: Vec3, to: &Point) -> Option<Passage> {
    between(world, &from.point, from.media_towards(wi), to)
}

/// The way from a point with some media on the side of another to that; `None` where something stands between.
#[inline]
fn between(world: &World, from: &Point, media: &MediumStack, to: &Point) -> Option<Passage> {
    let along = to.p - from.p;
    let origin = from.leave(world.scene, along);
    let target = to.reach(world.scene, -along);
    // t = 1 is the target itself, which does not count.
    let ray = Ray { t_max: 1.0, ..world.ray(origin, target - origin) };
    // The ray leaves its ends a little way off; what it passes counts from the ends themselves.
    let length = if world.has_media() { along.length() } else { 0.0 };
    passage(world, &ray, length, None, media)
}

/// What light passes between the ray's ends, where a step of 1 along it is of some length in metres; `None`
/// where a surface stands between. A half-line may leave a point beside its origin, `from` which it counts.
#[inline]
fn passage(
    world: &World,
    ray: &Ray,
    length: Real,
    from: Option<Vec3>,
    media: &MediumStack,
) -> Option<Passage> {
    // Whether anything is in the way is found sooner than what comes first; but that would have to be found, too,
    // where it may be unseen.
    if world.scene.has_unseen_surfaces {
        return walk(world, *ray, length, from, *media);
    }
    (!world.is_occluded(ray)).then(|| world.passage(media, ray.t_max * length))
}

/// The same through all surfaces that are not to be seen.
fn walk(
    world: &World,
    mut ray: Ray,
    length: Real,
    mut from: Option<Vec3>,
    mut media: MediumStack,
) -> Option<Passage> {
    let scene = world.scene;
    let mut passed = 0.0;
    let mut sum = Passage::CLEAR;
    while let Some(hit) = world.intersect(&ray) {
        let at = scene.accel.surface(&ray, &hit);
        let (share, beyond) = unseen(world, &at, ray.d, &media);
        if share == 0.0 {
            return None;
        }
        let way = from.take().and_then(|from| plane_distance(from, ray.d, &at));
        sum = sum.then(world.passage(&media, way.unwrap_or((hit.t - passed) * length)));
        sum.transmittance *= share;
        (passed, media) = (hit.t, beyond);
        ray = ray.beyond(hit.t, at.p_error.length());
    }
    Some(sum.then(world.passage(&media, (ray.t_max - passed) * length)))
}

/// The share of light that passes a surface as if nothing were there, and the media beyond it.
fn unseen(world: &World, at: &SurfacePoint, direction: Vec3, media: &MediumStack) -> (Real, MediumStack) {
    let scene = world.scene;
    let material = scene.material_at(at);
    let medium = if world.has_media() { material.internal_medium() } else { None };
    let (above, below) = sides(medium, media, direction.dot(at.n_g) > 0.0);
    if medium.is_some() && above.current() == below.current() {
        return (1.0, below);
    }
    // The share is the mean over all choices.
    let context = scene.material_context(world.lambda, world.interface(&above, &below), 0.0);
    (material.unseen_share(&context, &|set| scene.accel.uv(at, set)), below)
}
