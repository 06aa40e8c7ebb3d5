//! What a surface keeps for each index of refraction that may lie outside of it.

use crate::media::Medium;
use indigo_math::Real;
use indigo_spectrum::SampledSpectrum;

/// The ends of the visible range, nm.
const VISIBLE: [Real; 2] = [360.0, 830.0];

/// The indices of refraction that surfaces of a scene may be met from, ascending: that of air, and the least and the
/// largest of each medium.
pub fn indices(media: &[Medium]) -> Vec<Real> {
    let mut indices: Vec<Real> = media.iter().flat_map(|m| VISIBLE.map(|nm| m.ior.at(nm))).collect();
    indices.push(1.0);
    indices.sort_by(Real::total_cmp);
    indices.dedup();
    indices
}

/// A quantity tabulated for the [`indices`] of a scene. In between, where dispersive media lie, it is linear: their
/// range is narrow.
#[derive(Clone, Debug)]
pub struct ByIndex<T>(Vec<(Real, T)>);

impl<T> ByIndex<T> {
    /// For some indices, at least one and ascending.
    pub fn new(indices: &[Real], make: impl Fn(Real) -> T) -> Self {
        Self(indices.iter().map(|&index| (index, make(index))).collect())
    }

    /// Two entries that hold the indices of all lanes between them, and how near each is to the second, from 0 to 1.
    #[inline]
    pub fn around(&self, indices: SampledSpectrum) -> (&T, &T, SampledSpectrum) {
        let (least, most) = (indices.min_lane(), indices.max_lane());
        let low = self.0.iter().rposition(|e| e.0 <= least).unwrap_or(0);
        let high = self.0.iter().position(|e| e.0 >= most).unwrap_or(self.0.len() - 1);
        let ((from, low), (to, high)) = (&self.0[low], &self.0[high]);
        let mix = if to > from {
            indices.map(|index| ((index - from) / (to - from)).clamp(0.0, 1.0))
        } else {
            SampledSpectrum::ZERO
        };
        (low, high, mix)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::media::Cauchy;
    use indigo_spectrum::SampledWavelengths;

    #[test]
    fn every_lane_is_between_the_entries_of_its_medium() {
        let water = Cauchy { a: 1.324, b: 0.003 };
        let media = [Medium::AIR, Medium::clear(water), Medium::clear(Cauchy::constant(1.5))];
        let indices = indices(&media);
        assert_eq!(indices.len(), 4, "{indices:?}");
        let table = ByIndex::new(&indices, |index| index);
        for i in 0..100 {
            let lambda = SampledWavelengths::sample(i as Real / 100.0);
            for ior in [Cauchy::constant(1.0), water, Cauchy::constant(1.5)] {
                let of_lanes = ior.eval(&lambda);
                let (low, high, mix) = table.around(of_lanes);
                let found = mix.map(|m| low + (high - low) * m);
                assert!((found - of_lanes).map(Real::abs).max_lane() < 1e-6, "{of_lanes:?} and {found:?}");
                // Nothing is mixed where there is no dispersion.
                assert!(ior.b > 0.0 || (low == high && mix.is_black()));
            }
        }
    }
}
