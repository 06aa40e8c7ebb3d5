//! `specular`: a perfectly smooth surface of a dielectric.
//!
//! All events are of delta kind. Reflection goes the same way at every wavelength, but with a probability
//! of its own at each. A refracted ray stands for the hero and for the lanes that have its index: the others
//! would have gone another way, so their density is 0 (Wilkie et al. 2014, section 4).

use super::fields::{
    BASE_EMISSION, BASE_EMISSION_PARAMETER, BUMP, BUMP_MAP, EMISSION, EMISSION_PARAMETER, EMISSION_TEXTURE,
    INTERNAL_MEDIUM_NAME, LATER, LAYER,
};
use super::{MaterialContext, MaterialResources, SurfaceKind};
use crate::fresnel::dielectric;
use crate::media::MediumId;
use crate::scatter::{Crossing, Delta, LocalSample, Scatter};
use indigo_decl::{Block, Field, Kind, Node, Presence};
use indigo_math::{Real, Vec2, Vec3};
use indigo_spectrum::{LanePdf, SampledSpectrum};

/// The declaration of `specular`.
pub static BLOCK: Block = Block::new(
    "specular",
    "A perfectly smooth surface of a dielectric, such as glass or water: it reflects like a mirror and \
     lets the rest of the light through, refracted.",
    &[
        INTERNAL_MEDIUM_NAME,
        Field::new(
            "transparent",
            Kind::Bool,
            Presence::Default("true"),
            "Whether light goes through. If not, only the reflected light is there.",
        ),
        BUMP_MAP,
        BASE_EMISSION,
        EMISSION,
        EMISSION_TEXTURE,
        LAYER,
    ],
)
.with_parameters(&[BASE_EMISSION_PARAMETER, EMISSION_PARAMETER, BUMP])
.with_later(LATER)
.with_example(
    "<specular>
    <transparent>true</transparent>
    <internal_medium_name>glass</internal_medium_name>
</specular>",
);

/// A smooth interface between its medium and another.
#[derive(Clone, Debug)]
pub struct Specular {
    medium: MediumId,
    is_transparent: bool,
}

impl Specular {
    /// From its element.
    pub fn build(node: &Node, resources: &mut dyn MaterialResources) -> Self {
        Self {
            medium: resources.medium(node, INTERNAL_MEDIUM_NAME.name),
            is_transparent: node.bool("transparent"),
        }
    }

    /// The model at a point.
    #[inline]
    pub fn leaf(&self, context: &MaterialContext, _uv: impl Fn(u32) -> Vec2) -> SpecularLeaf {
        SpecularLeaf { eta: context.interface.eta(), is_transparent: self.is_transparent }
    }
}

impl SurfaceKind for Specular {
    fn internal_medium(&self) -> Option<MediumId> {
        Some(self.medium)
    }

    fn may_transmit(&self) -> bool {
        self.is_transparent
    }
}

/// Reflection and refraction at an interface.
#[derive(Clone, Copy, Debug)]
pub struct SpecularLeaf {
    /// The index below over that above.
    eta: SampledSpectrum,
    is_transparent: bool,
}

impl SpecularLeaf {
    #[inline]
    fn reflected(&self, wo: Vec3, reflectance: SampledSpectrum) -> LocalSample {
        let probability = if self.is_transparent { LanePdf(reflectance.0) } else { LanePdf::ONE };
        let delta = Delta { factor: reflectance, probability, reverse: probability };
        LocalSample::delta(Vec3::new(-wo.x, -wo.y, wo.z), Crossing::Reflect, delta)
    }

    #[inline]
    fn refracted(&self, wo: Vec3, reflectance: SampledSpectrum, cos_transmitted: Real) -> LocalSample {
        let hero = self.eta.hero();
        let transmittance =
            SampledSpectrum::from_fn(
                |lane| {
                    if self.eta[lane] == hero { 1.0 - reflectance[lane] } else { 0.0 }
                },
            );
        let probability = LanePdf(transmittance.0);
        let wi = Vec3::new(-wo.x / hero, -wo.y / hero, -cos_transmitted).normalized();
        // Fresnel's equations are the same from both sides.
        let delta = Delta { factor: transmittance / hero, probability, reverse: probability };
        LocalSample::delta(wi, Crossing::Down, delta)
    }
}

impl Scatter for SpecularLeaf {
    #[inline]
    fn f(&self, _wo: Vec3, _wi: Vec3, _crossing: Crossing) -> SampledSpectrum {
        SampledSpectrum::ZERO
    }

    #[inline]
    fn pdf(&self, _wo: Vec3, _wi: Vec3, _crossing: Crossing) -> LanePdf {
        LanePdf::ZERO
    }

    #[inline]
    fn sample(&self, wo: Vec3, u: [Real; 3]) -> Option<LocalSample> {
        let reflectance = self.eta.map(|eta| dielectric(wo.z, eta).reflectance);
        let hero = dielectric(wo.z, self.eta.hero());
        if self.is_transparent && u[2] >= hero.reflectance {
            return Some(self.refracted(wo, reflectance, hero.cos_transmitted));
        }
        Some(self.reflected(wo, reflectance))
    }

    #[inline]
    fn eta(&self) -> SampledSpectrum {
        self.eta
    }

    #[inline]
    fn is_connectable(&self) -> bool {
        false
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::media::Cauchy;
    use indigo_spectrum::{LANES, SampledWavelengths};

    fn wavelengths(hero_nm: Real) -> SampledWavelengths {
        let mut lambda = SampledWavelengths::sample(0.3);
        lambda.lambda[0] = hero_nm;
        lambda
    }

    /// The least deviation of a prism of 60 degrees, where light passes it symmetrically: 2 asin(n / 2) - 60.
    #[test]
    fn a_prism_deviates_each_wavelength_by_its_own_index() {
        let glass = Cauchy { a: 1.5, b: 0.01 };
        for (nm, index) in [(400.0, 1.5625), (550.0, 1.533_058), (700.0, 1.520_408)] {
            let leaf = SpecularLeaf { eta: glass.eval(&wavelengths(nm)), is_transparent: true };
            let incidence = (index / 2.0f64).asin();
            let wo = Vec3::new(incidence.sin() as Real, 0.0, incidence.cos() as Real);
            let drawn = leaf.sample(wo, [0.5, 0.5, 0.999]).expect("light");
            assert_eq!(drawn.crossing, Crossing::Down);
            // Inside it goes at 30 degrees to the normal, as half the prism's angle demands.
            let inside = (-drawn.wi.x as f64).atan2(-drawn.wi.z as f64);
            assert!((inside.to_degrees() - 30.0).abs() < 1e-4, "{nm}: {}", inside.to_degrees());
            let delta = drawn.delta.expect("an event of delta kind");
            for lane in 1..LANES {
                assert_eq!((delta.probability[lane], delta.factor[lane]), (0.0, 0.0));
            }
        }
    }

    #[test]
    fn reflection_keeps_every_lane_and_needs_no_transparency() {
        let eta = Cauchy { a: 1.5, b: 0.01 }.eval(&wavelengths(400.0));
        let wo = Vec3::new(0.6, 0.0, 0.8);
        for is_transparent in [true, false] {
            let drawn = SpecularLeaf { eta, is_transparent }.sample(wo, [0.5, 0.5, 0.0]).expect("light");
            let delta = drawn.delta.expect("an event of delta kind");
            assert_eq!(drawn.wi, Vec3::new(-0.6, 0.0, 0.8));
            for lane in 0..LANES {
                let reflectance = dielectric(0.8, eta[lane]).reflectance;
                assert_eq!(delta.factor[lane], reflectance);
                assert_eq!(delta.probability[lane], if is_transparent { reflectance } else { 1.0 });
            }
        }
        let opaque = SpecularLeaf { eta, is_transparent: false };
        let drawn = opaque.sample(wo, [0.5, 0.5, 0.999]).expect("light");
        assert_eq!(drawn.crossing, Crossing::Reflect);
    }
}
