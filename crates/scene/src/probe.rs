//! Which media a point lies in, found by looking at all surfaces in a direction.

use crate::scene::Scene;
use indigo_geom::Ray;
use indigo_math::{Real, Vec3};
use indigo_scatter::{MediumId, MediumStack};

/// Media that one probe can tell apart. A point lies in few; what else the ray crosses is entered and
/// left again.
const MEDIA: usize = 32;

/// Directions of probes: five that no scene is likely to be built along.
const DIRECTIONS: [[Real; 3]; 5] = [
    [0.5411, 0.2973, 0.7867],
    [-0.4663, 0.7351, 0.4921],
    [-0.3187, -0.8291, 0.4593],
    [0.8123, -0.3469, -0.4691],
    [0.1931, 0.5557, -0.8086],
];

impl Scene {
    /// The media at a point and time by a probe in a direction: those that the ray leaves more often than it enters.
    pub fn media_towards(&self, p: Vec3, direction: Vec3, time: Real) -> MediumStack {
        if self.media.is_empty() {
            return MediumStack::AIR;
        }
        let mut left = [(MediumId::AIR, 0i32); MEDIA];
        let mut ray = Ray { time, ..Ray::new(p, direction) };
        while let Some(hit) = self.accel.intersect(&ray) {
            let at = self.accel.surface(&ray, &hit);
            if let Some(medium) = self.material_at(&at).internal_medium() {
                let known = |e: &&mut (MediumId, i32)| e.0 == medium || e.0 == MediumId::AIR;
                if let Some(entry) = left.iter_mut().find(known) {
                    entry.0 = medium;
                    entry.1 += if direction.dot(at.n_g) > 0.0 { 1 } else { -1 };
                }
            }
            ray = ray.beyond(hit.t, at.p_error.length());
        }
        let mut stack = MediumStack::AIR;
        for (medium, times) in left {
            for _ in 0..times {
                stack = stack.entered(medium);
            }
        }
        stack
    }

    /// The media at a point, when the shutter opens, by most of several probes, so that a leak in one direction does no harm.
    pub fn media_at(&self, p: Vec3) -> MediumStack {
        let found = DIRECTIONS.map(|d| self.media_towards(p, Vec3::from(d), 0.0));
        let votes = |stack: &&MediumStack| found.iter().filter(|other| other == stack).count();
        // The first of those with the most votes.
        found.iter().rev().max_by_key(votes).copied().unwrap_or(MediumStack::AIR)
    }

    /// The media in which a camera ray begins.
    #[inline]
    pub fn camera_media_along(&self, ray: &Ray) -> MediumStack {
        if self.camera_meets_interface {
            self.media_towards(ray.o, ray.d, ray.time)
        } else {
            self.camera_media
        }
    }

    /// Whether the surface of a medium passes the camera within twice its aperture: probes lean by less than
    /// 60 degrees towards any plane, so that one of them meets what passes within the aperture itself.
    ///
    /// Rays that begin all over a sensor may begin anywhere.
    fn is_interface_near_camera(&self) -> bool {
        let reach = 2.0 * self.camera.reach().max(self.nudge_m);
        if reach.is_infinite() {
            return true;
        }
        DIRECTIONS.iter().any(|&d| {
            let d = Vec3::from(d);
            let mut ray = Ray { t_max: 2.0 * reach, ..Ray::new(d * -reach, d) };
            while let Some(hit) = self.accel.intersect(&ray) {
                let at = self.accel.surface(&ray, &hit);
                if self.material_at(&at).internal_medium().is_some() {
                    return true;
                }
                ray = ray.beyond(hit.t, at.p_error.length());
            }
            false
        })
    }

    /// The media at a time round a point `p` of lamp number `lamp`, from which light leaves in a direction.
    #[inline]
    pub fn media_at_lamp(&self, lamp: u32, p: Vec3, direction: Vec3, time: Real) -> MediumStack {
        match self.lamp_media.get(lamp as usize) {
            Some(Some(everywhere)) => *everywhere,
            Some(None) => self.media_towards(p, direction, time),
            None => MediumStack::AIR,
        }
    }

    /// Finds where paths begin: once the rest of the scene is complete.
    pub(crate) fn find_starting_media(&mut self, lamps: &[Option<u32>]) {
        if self.media.is_empty() {
            return;
        }
        self.camera_media = self.media_at(Vec3::ZERO);
        let objects = 0..self.accel.objects().len() as u32;
        let moves = |i: u32| self.accel.movement(i).is_some() && self.is_interface(i);
        self.camera_meets_interface =
            self.camera.moves() || objects.clone().any(moves) || self.is_interface_near_camera();
        let bounds = |i: u32| self.accel.object_bounds(i);
        let interfaces: Vec<_> = objects.clone().filter(|&i| self.is_interface(i)).map(bounds).collect();
        let mut media = vec![Some(MediumStack::AIR); self.lights.len()];
        for (object, lamp) in objects.zip(lamps) {
            let Some(lamp) = *lamp else { continue };
            let own = bounds(object);
            // Far from all interfaces, one point tells for all of the lamp, and it lies in air.
            if interfaces.iter().any(|i| i.overlaps(&own)) {
                media[lamp as usize] = None;
            }
        }
        self.lamp_media = media;
    }

    fn is_interface(&self, object: u32) -> bool {
        let first = self.first_slot[object as usize] as usize;
        let end = self.first_slot.get(object as usize + 1).map_or(self.slots.len(), |&s| s as usize);
        self.slots[first..end].iter().any(|&m| self.materials[m as usize].internal_medium().is_some())
    }
}
