//! The first scattering event of a camera ray.

use super::flight::{Arrival, Flight};
use super::media::MediaMemory;
use super::path::Path;
use super::surface::{Surface, shade};
use super::vertex::Vertex;
use crate::sampler::{Block, PrimarySample};
use indigo_camera::CameraRay;
use indigo_geom::Ray;
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
    /// Depth along the viewing direction, metres.
    pub depth_m: Real,
    /// Numbers of the object and its material; none in a medium.
    pub surface: Option<[u32; 2]>,
}

/// Finds the event of a camera ray; `None` where the ray leaves the scene.
pub fn first_event(
    media: &mut MediaMemory,
    scene: &Scene,
    numbers: &mut impl PrimarySample,
    lambda: &SampledWavelengths,
    camera: &CameraRay,
) -> Option<FirstEvent> {
    let world = media.world(scene, lambda);
    let ray = Ray::new(camera.origin, camera.direction);
    let mut flight = Flight::new(ray.o, ray, scene.camera_media);
    let mut number = 0;
    let (vertex, surface) = loop {
        let arrival = flight.advance(&world, || numbers.block(Block::connect(number))[2]);
        let wo = -flight.ray.d;
        match &arrival {
            Arrival::Environment => return None,
            Arrival::Medium(p) => break (Vertex::in_medium(&world, *p, wo, flight.media), None),
            Arrival::Surface(at) => {
                let choice = numbers.block(Block::scatter(number))[3];
                match shade(&world, at, wo, &flight.media, choice) {
                    Surface::Scatters(vertex) => {
                        break (vertex, Some([at.object, scene.material_number_at(at)]));
                    }
                    Surface::Unseen(media) => {
                        flight.pass(&world, at, media);
                        number += 1;
                    }
                }
            }
        }
    };
    let mut path = Path::new(camera.ratio);
    path.arrive(&flight.passage, &vertex);
    let [u0, u1, u2, _] = numbers.block(Block::scatter(number));
    let albedo = vertex.sample([u0, u1, u2], Mode::Radiance).map_or(SampledSpectrum::ZERO, |next| {
        let ratio = path.ratio * next.pdf.ratio_to_hero();
        // Radiance that goes into a denser medium grows by the squared index: that is no reflectance.
        path.beta * next.weight * (vertex.compression(&world, next.wi) / ratio.mean())
    });
    // The camera is the origin of render space.
    let depth_m = vertex.point.p.dot(scene.camera.forwards());
    Some(FirstEvent { albedo, normal: vertex.normal(), depth_m, surface })
}
