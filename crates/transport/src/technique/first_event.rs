//! The first scattering event of a camera ray.

use super::flight::{Blocks, Flight};
use super::media::WorldMemory;
use super::path::Path;
use super::visibility::Point;
use crate::sampler::PrimarySample;
use indigo_camera::CameraRay;
use indigo_math::{Real, Vec3};
use indigo_scatter::Mode;
use indigo_scene::Scene;
use indigo_spectrum::{SampledSpectrum, SampledWavelengths};

/// What a camera ray is first scattered by; surfaces that are not to be seen are passed.
#[derive(Clone, Copy, Debug)]
pub struct FirstEvent {
    /// An estimate of the radiance that it would scatter into the ray if radiance 1 came from everywhere: the albedo,
    /// and what media before it leave of that.
    pub albedo: SampledSpectrum,
    /// Unit shading normal on the side that is seen; none in a medium.
    pub normal: Option<Vec3>,
    /// Depth in the picture, metres: see [`Camera::depth`](indigo_camera::Camera::depth).
    pub depth_m: Real,
    /// Numbers of the object and its material; none in a medium.
    pub surface: Option<[u32; 2]>,
}

/// Finds the event of a camera ray; `None` where the ray leaves the scene.
pub fn first_event(
    memory: &mut WorldMemory,
    scene: &Scene,
    numbers: &mut impl PrimarySample,
    lambda: &SampledWavelengths,
    camera: &CameraRay,
) -> Option<FirstEvent> {
    let world = memory.world(scene, lambda, camera.time);
    let ray = world.ray(camera.origin, camera.direction);
    let mut flight = Flight::new(&Point::free(ray.o), ray, scene.camera_media_along(&ray));
    let mut number = 0;
    // The last surface that was met: where the event is on one, the one on which it is.
    let mut met = None;
    let arrival = flight.fly_to_vertex(&world, numbers, Blocks::Camera, &mut number, |_, at, _| {
        met = Some([at.object, scene.material_number_at(at)]);
    });
    let (vertex, [u0, u1, u2, _]) = arrival?;
    let surface = met.filter(|_| vertex.normal().is_some());
    let mut path = Path::new(camera.ratio);
    path.arrive(&flight, &vertex);
    let albedo = vertex.sample([u0, u1, u2], Mode::Radiance).map_or(SampledSpectrum::ZERO, |next| {
        let ratio = path.ratio * next.pdf.ratio_to_hero();
        // Radiance that goes into a denser medium grows by the squared index: that is no reflectance.
        path.beta * next.weight * (vertex.compression(&world, next.wi) / ratio.mean())
    });
    let depth_m = scene.camera.depth(vertex.point.p, camera.time);
    Some(FirstEvent { albedo, normal: vertex.normal(), depth_m, surface })
}
