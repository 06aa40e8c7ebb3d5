//! Groups of lights, whose shares of a picture may be kept apart.

use super::LightTable;
use crate::kinds::Distant;
use crate::query::Sender;
use indigo_spectrum::{SampledSpectrum, SampledWavelengths};

impl LightTable {
    /// The table with its distant lights in groups, one for each; lamps know theirs
    /// ([`AreaLight::in_group`](crate::AreaLight::in_group)).
    #[must_use]
    pub fn with_distant_groups(mut self, groups: Vec<u16>) -> Self {
        self.distant_groups = groups;
        self
    }

    /// Who sends the light of an object; `None` where that is no lamp.
    #[inline]
    pub fn sender_of_object(&self, object: u32) -> Option<Sender> {
        self.lamp(object).map(|(i, _)| Sender::Lamp(i as u32))
    }

    /// Tells of light that some sender's became, be it scattered or not, which groups it is from: parts of it whose sum is
    /// the whole.
    ///
    /// A direction of the environment has the light of all that shines there, the sun's and the sky's. They are
    /// drawn together, and scattered by the same factors, so each has the share that it had where it was sent.
    pub fn share_out(
        &self,
        sender: Sender,
        light: SampledSpectrum,
        lambda: &SampledWavelengths,
        mut share: impl FnMut(u16, SampledSpectrum),
    ) {
        let towards = match sender {
            Sender::Lamp(number) => return share(self.lamps[number as usize].group(), light),
            Sender::Environment(towards) => towards,
        };
        let Some(environment) = &self.environment else { return };
        let first = self.distant_groups.first().copied().unwrap_or(0);
        if self.distant_groups.iter().all(|&group| group == first) {
            return share(first, light);
        }
        let whole = environment.radiance(towards, lambda);
        for (distant, &group) in environment.lights().iter().zip(&self.distant_groups) {
            let part = distant.radiance(towards, lambda);
            if !part.is_black() {
                let parts =
                    SampledSpectrum::from_fn(|i| if whole[i] > 0.0 { part[i] / whole[i] } else { 0.0 });
                share(group, light * parts);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kinds::background::Background;
    use indigo_math::{Real, Vec3, Vec3d};
    use indigo_spectrum::Spectrum;

    /// Light of the environment is shared out as its lights shine there; all of it is, and none twice.
    #[test]
    fn the_environment_is_shared_out_by_radiance() {
        let lights = [1.0, 3.0, 4.0].map(|value| Background(Spectrum::uniform(value)).into());
        let table = LightTable::new(vec![], lights.into(), std::iter::empty(), (Vec3d::ZERO, 1.0));
        let lambda = SampledWavelengths::sample(0.3);
        let shares = |groups: &[u16]| {
            let table = table.clone().with_distant_groups(groups.to_vec());
            let (towards, mut sums) = (Vec3::new(0.0, 0.0, 1.0), [0.0 as Real; 3]);
            let light = SampledSpectrum::splat(16.0);
            table.share_out(Sender::Environment(towards), light, &lambda, |group, share| {
                sums[usize::from(group)] += share.hero();
            });
            sums
        };
        assert_eq!(shares(&[0, 1, 2]), [2.0, 6.0, 8.0]);
        assert_eq!(shares(&[1, 0, 1]), [6.0, 10.0, 0.0]);
        assert_eq!(shares(&[2, 2, 2]), [0.0, 0.0, 16.0]);
        assert_eq!(shares(&[]), [16.0, 0.0, 0.0]);
    }
}
