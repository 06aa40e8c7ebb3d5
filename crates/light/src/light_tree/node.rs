//! A node of the tree, and what its lamps may give a receiver.

use super::cluster::Cluster;
use crate::query::Receiver;
use indigo_math::{Real, Vec3};

/// How near a receiver may be to lamps somewhere in a box, over half of its diagonal. An eighth had the least variance of
/// powers of two, in a hall under 400 lamps.
const NEAREST: Real = 0.125;

/// Lamps' triangles in a box and the ball round it, with the lobe of their light.
#[derive(Clone, Copy, Debug)]
pub(super) struct Node {
    center: Vec3,
    /// Half of the box's sides, and of its diagonal.
    half: Vec3,
    radius: Real,
    axis: Vec3,
    /// Of the angle round the axis in which the normals lie.
    spread: Angle,
    /// Cosine of the angle to a normal beyond which no light goes.
    cos_reach: Real,
    /// Along the normals, over that of all lamps.
    pub intensity: Real,
    /// Number of the first slot.
    pub first: u32,
    /// The slot after the last.
    pub end: u32,
    /// The second part, where the first one is the node that follows; 0 for a leaf, which has no parts.
    pub second: u32,
}

/// An angle from 0 to π, by what is computed with.
#[derive(Clone, Copy, Debug)]
struct Angle {
    cos: Real,
    sin: Real,
}

impl Angle {
    const ZERO: Self = Self { cos: 1.0, sin: 0.0 };

    /// Of a cosine, which rounding may have led astray.
    #[inline]
    fn of_cos(cos: Real) -> Self {
        let cos = cos.clamp(-1.0, 1.0);
        Self { cos, sin: (1.0 - cos * cos).sqrt() }
    }

    /// This angle less another, and at least 0.
    #[inline]
    fn less(self, other: Self) -> Self {
        if self.cos >= other.cos {
            return Self::ZERO;
        }
        Self {
            cos: self.cos * other.cos + self.sin * other.sin,
            sin: self.sin * other.cos - self.cos * other.sin,
        }
    }
}

impl Node {
    /// A leaf of the slots from `first` to `end`, whose triangles are a cluster of all lamps of some intensity.
    pub fn new(cluster: &Cluster, all: f64, [first, end]: [usize; 2]) -> Self {
        let lobe = &cluster.lobe;
        let (sin, cos) = lobe.sin_cos_spread();
        Self {
            center: cluster.bounds.center().cast(),
            half: (cluster.bounds.size() * 0.5).cast(),
            radius: (0.5 * cluster.bounds.size().length()) as Real,
            axis: lobe.axis.cast(),
            spread: Angle { cos: cos as Real, sin: sin as Real },
            cos_reach: if lobe.reach > 0.0 { 0.0 } else { 1.0 },
            intensity: (cluster.intensity / all) as Real,
            first: first as u32,
            end: end as u32,
            second: 0,
        }
    }

    /// An estimate of the irradiance by the node's lamps, up to a factor that is the same for all nodes: 0 only where
    /// none of their light can arrive.
    ///
    /// Conty Estevez & Kulla 2018, equation 3: the intensity towards the receiver, by the least angle that the direction
    /// may have to any of the normals, times the receiver's cosine by the least angle to any point of the ball, over
    /// the squared distance. From inside the ball any direction may be any. In place of the squared distance to the
    /// middle stands the least distance to the box times the greatest: lamps that are spread evenly from a distance
    /// a to b have the mean ∫ dx / x² / (b − a) = 1 / ab.
    #[inline]
    pub fn importance(&self, to: &Receiver) -> Real {
        let way = to.p - self.center;
        let (distance2, radius2) = (way.length2(), self.radius * self.radius);
        let aside = way.abs();
        let least2 = (aside - self.half).max(Vec3::ZERO).length2() + NEAREST * NEAREST * radius2;
        let greatest2 = (aside + self.half).length2();
        let irradiance = self.intensity / (least2 * greatest2).sqrt();
        if distance2 <= radius2 {
            return irradiance;
        }
        let nearness = 1.0 / distance2.sqrt();
        let way = way * nearness;
        let sin = self.radius * nearness;
        // The ball as the receiver sees it, and so the receiver from any point of it.
        let ball = Angle { cos: (1.0 - sin * sin).max(0.0).sqrt(), sin };
        let leaving = Angle::of_cos(way.dot(self.axis)).less(self.spread).less(ball);
        if leaving.cos < self.cos_reach {
            return 0.0;
        }
        let arriving = match to.cos_arriving(-way) {
            Some(cos) => Angle::of_cos(cos).less(ball).cos.max(0.0),
            None => 1.0,
        };
        irradiance * leaving.cos * arriving
    }
}
