//! Directional albedos of rough surfaces, tabulated while a scene is loaded, and the light that was lost
//! among facets, given back.

use indigo_math::warp::INV_PI;
use indigo_math::{Float, Real};
use indigo_spectrum::SampledSpectrum;

/// Nodes of a row: what it takes for 1e-4 at facets from the roughest to an exponent of 10,000.
const NODES: usize = 32;
/// What stands for an albedo of 1.
const STEPS: Real = 65_535.0;
/// Nodes and weights of Gauss's rule of eight points on [-1, 1], the positive half.
const GAUSS: [(f64, f64); 4] = [
    (0.183_434_642_495_649_8, 0.362_683_783_378_362),
    (0.525_532_409_916_329, 0.313_706_645_877_887_3),
    (0.796_666_477_413_626_7, 0.222_381_034_453_374_47),
    (0.960_289_856_497_536_2, 0.101_228_536_290_376_26),
];

/// The directional albedo E of a scattering function by the cosine μ of the view.
///
/// Between nodes, see [`Nodes`], the row is cubic (Catmull & Rom 1974).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AlbedoRow {
    /// In steps of 1 / 65535, a tenth of the row's own error: paths carry rows about with their models.
    albedo: [u16; NODES],
    nodes: Nodes,
    /// ∫ 2 μ E(μ) dμ: the share of even light from everywhere that is scattered.
    average: Real,
}

impl AlbedoRow {
    /// A row of a function of μ in [0, 1]; `scale` > 0 is the k of the nodes.
    pub fn new(scale: f64, albedo: impl Fn(f64) -> f64) -> Self {
        Self::on(Nodes::Grazing(Real::from_f64(scale)), albedo).with_average()
    }

    /// A row that is nowhere less than a function of μ that falls like a square root from a kink in (0, 1) on.
    pub fn above(kink: f64, albedo: impl Fn(f64) -> f64) -> Self {
        /// Places in a cell between two nodes.
        const PLACES: usize = 4;
        /// By far more than it takes: what a pass leaves is a few hundredths of what it found.
        const PASSES: usize = 30;
        let nodes = Nodes::Around(Real::from_f64(kink));
        let least: [(f64, f64); (NODES - 1) * PLACES + 1] = std::array::from_fn(|i| {
            let mu = nodes.cos(i as f64 / PLACES as f64);
            (mu, in_steps(albedo(mu)).ceil())
        });
        let mut row = Self::on(nodes, albedo);
        for _ in 0..PASSES {
            let mut is_above = true;
            for (i, (mu, least)) in least.iter().enumerate() {
                let lacks = least - in_steps(row.at(Real::from_f64(*mu)).to_f64());
                // A step is what rounding may take.
                if lacks > 1.0 {
                    is_above = false;
                    let cell = (i / PLACES).min(NODES - 2);
                    for node in &mut row.albedo[cell..cell + 2] {
                        *node = node.saturating_add(lacks.ceil() as u16);
                    }
                }
            }
            if is_above {
                break;
            }
        }
        row.with_average()
    }

    /// Without its average.
    fn on(nodes: Nodes, albedo: impl Fn(f64) -> f64) -> Self {
        let at = |i: usize| in_steps(albedo(nodes.cos(i as f64))).round() as u16;
        Self { albedo: std::array::from_fn(at), nodes, average: 0.0 }
    }

    /// With the interpolant's own mean, so that what `complement` gives back sums up exactly.
    fn with_average(self) -> Self {
        // μ = s² spreads the nodes.
        let mean = integral([0.0, 1.0], 32, |s| 4.0 * s * s * s * self.at(Real::from_f64(s * s)).to_f64());
        Self { average: Real::from_f64(mean), ..self }
    }

    /// A row between those of a list whose rows stand at equal steps of a parameter from 0 to 1.
    #[inline]
    pub fn between(rows: &[Self], parameter: Real) -> Self {
        let place = parameter * (rows.len() - 1) as Real;
        let low = (place as usize).min(rows.len() - 2);
        let mix = |a: Real, b: Real| a + (b - a) * (place - low as Real);
        let (a, b) = (&rows[low], &rows[low + 1]);
        Self {
            // Rounded: they are not negative.
            albedo: std::array::from_fn(|i| (mix(a.albedo[i].into(), b.albedo[i].into()) + 0.5) as u16),
            nodes: match (a.nodes, b.nodes) {
                (Nodes::Grazing(a), Nodes::Grazing(b)) => Nodes::Grazing(mix(a, b)),
                (nodes, _) => nodes,
            },
            average: mix(a.average, b.average),
        }
    }

    /// E(μ).
    #[inline]
    pub fn at(&self, cos: Real) -> Real {
        let place = self.nodes.place(cos.max(0.0));
        let cell = (place as usize).min(NODES - 2);
        let x = place - cell as Real;
        let v = |i: usize| Real::from(self.albedo[i]);
        let (a, b) = (v(cell), v(cell + 1));
        // At the ends the slope is that of the parabola through the last three nodes.
        let slope_a = if cell == 0 { 2.0 * b - 1.5 * a - 0.5 * v(2) } else { 0.5 * (b - v(cell - 1)) };
        let slope_b =
            if cell + 2 == NODES { 1.5 * b - 2.0 * a + 0.5 * v(cell - 1) } else { 0.5 * (v(cell + 2) - a) };
        let rise = b - a;
        let value = a + x
            * (slope_a + x * (3.0 * rise - 2.0 * slope_a - slope_b + x * (slope_a + slope_b - 2.0 * rise)));
        (value / STEPS).clamp(0.0, 1.0)
    }

    /// ∫ 2 μ E(μ) dμ.
    #[inline]
    pub fn average(&self) -> Real {
        self.average
    }

    /// What is not scattered from two directions together, as a function that is symmetric and whose albedo
    /// is 1 − E: (1 − E(μo)) (1 − E(μi)) / (π (1 − Ē)) (Kelemen & Szirmay-Kalos 2001; Kulla & Conty 2017).
    #[inline]
    pub fn complement(&self, cos_o: Real, cos_i: Real) -> Real {
        complement(self.at(cos_o), self.at(cos_i), self.average)
    }
}

/// An albedo in steps.
fn in_steps(albedo: f64) -> f64 {
    albedo.clamp(0.0, 1.0) * STEPS.to_f64()
}

/// Where the nodes of a row lie; places among them are numbers from 0 to `NODES` - 1.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Nodes {
    /// Evenly in t = s (1 + k) / (s + k) with s = √μ and this k: dense at grazing angles, where the albedo of rough surfaces
    /// rises like μ ln μ and that of smooth ones changes within cosines of about k².
    Grazing(Real),
    /// Evenly in the square root of the distance from a μ, on either side: beside a kink, like that of the angle of total
    /// reflection, to which a reflectance goes like such a root.
    Around(Real),
}

/// The node at a kink, and the cells beyond.
const KINK: Real = 10.0;
const BEYOND: Real = (NODES - 1) as Real - KINK;

impl Nodes {
    /// The place of a μ of at least 0.
    #[inline]
    fn place(self, cos: Real) -> Real {
        match self {
            Self::Grazing(k) => {
                let root = cos.sqrt();
                root * (1.0 + k) / (root + k) * (NODES - 1) as Real
            }
            Self::Around(kink) if cos > kink => KINK + BEYOND * ((cos - kink) / (1.0 - kink)).sqrt(),
            Self::Around(kink) => KINK * (1.0 - (1.0 - cos / kink).sqrt()),
        }
    }

    /// The μ of a place.
    fn cos(self, place: f64) -> f64 {
        match self {
            Self::Grazing(k) => {
                let (t, k) = (place / (NODES - 1) as f64, k.to_f64());
                (t * k / (1.0 + k - t)).powi(2)
            }
            Self::Around(kink) => {
                let (from, kink) = (place - KINK.to_f64(), kink.to_f64());
                if from > 0.0 {
                    kink + (1.0 - kink) * (from / BEYOND.to_f64()).powi(2)
                } else {
                    kink * (1.0 - (from / KINK.to_f64()).powi(2))
                }
            }
        }
    }
}

/// A row for each lane, of two.
#[derive(Clone, Copy, Debug)]
pub struct LaneRows {
    low: AlbedoRow,
    high: AlbedoRow,
    mix: Mix,
}

/// What lanes have of two rows.
#[derive(Clone, Copy, Debug)]
enum Mix {
    /// The first is that of all lanes.
    First,
    /// The share of the second.
    Linear(SampledSpectrum),
    /// The greater of both, in all lanes.
    Greater,
}

impl LaneRows {
    /// Between two rows, by each lane's share of the second.
    #[inline]
    pub fn between(low: AlbedoRow, high: AlbedoRow, mix: SampledSpectrum) -> Self {
        Self { low, high, mix: if mix.is_black() { Mix::First } else { Mix::Linear(mix) } }
    }

    /// Not below two rows, nor what lies between.
    #[inline]
    pub fn above(low: AlbedoRow, high: AlbedoRow) -> Self {
        Self { low, high, mix: Mix::Greater }
    }

    /// E(μ).
    #[inline]
    pub fn at(&self, cos: Real) -> SampledSpectrum {
        self.mixed(|row| row.at(cos))
    }

    /// ∫ 2 μ E(μ) dμ.
    #[inline]
    pub fn average(&self) -> SampledSpectrum {
        self.mixed(AlbedoRow::average)
    }

    /// See [`AlbedoRow::complement`].
    #[inline]
    pub fn complement(&self, cos_o: Real, cos_i: Real) -> SampledSpectrum {
        if let Mix::First = self.mix {
            return SampledSpectrum::splat(self.low.complement(cos_o, cos_i));
        }
        let (o, i, average) = (self.at(cos_o), self.at(cos_i), self.average());
        SampledSpectrum::from_fn(|lane| complement(o[lane], i[lane], average[lane]))
    }

    /// What is linear in the rows. (The greater of two averages is no more than the average of the greater, so that the
    /// complement still has at most the albedo that is missing.)
    #[inline]
    fn mixed(&self, of: impl Fn(&AlbedoRow) -> Real) -> SampledSpectrum {
        let low = of(&self.low);
        match self.mix {
            Mix::First => SampledSpectrum::splat(low),
            Mix::Linear(mix) => {
                let rise = of(&self.high) - low;
                mix.map(|share| low + rise * share)
            }
            Mix::Greater => SampledSpectrum::splat(low.max(of(&self.high))),
        }
    }
}

/// (1 - E(μo)) (1 - E(μi)) / (π (1 - Ē)); nothing where nothing is lost.
#[inline]
fn complement(albedo_o: Real, albedo_i: Real, average: Real) -> Real {
    let lost = 1.0 - average;
    if lost <= 0.0 { 0.0 } else { (1.0 - albedo_o) * (1.0 - albedo_i) * (INV_PI / lost) }
}

/// ∫ f over `[lo, hi]` in so many pieces, by Gauss's rule of eight points.
pub fn integral([lo, hi]: [f64; 2], pieces: usize, f: impl Fn(f64) -> f64) -> f64 {
    let half = 0.5 * (hi - lo) / pieces as f64;
    let middle = |piece: usize| lo + half * (2 * piece + 1) as f64;
    let piece = |m: f64| GAUSS.iter().map(|&(x, w)| w * (f(m - half * x) + f(m + half * x))).sum::<f64>();
    (0..pieces).map(|i| piece(middle(i)) * half).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_follow_smooth_functions() {
        for scale in [1.0, 0.1, 0.01] {
            let f = |mu: f64| 1.0 - 0.5 * (scale / (mu + scale)).powi(2);
            let row = AlbedoRow::new(scale.sqrt(), f);
            for i in 0..=1000 {
                let mu = f64::from(i) / 1000.0;
                assert!(
                    (row.at(mu as Real) as f64 - f(mu)).abs() < 2e-4,
                    "{scale} {mu}: {}",
                    row.at(mu as Real)
                );
            }
        }
    }

    #[test]
    fn the_complement_has_the_albedo_that_is_missing() {
        let row = AlbedoRow::new(0.3, |mu| 0.4 + 0.5 * mu);
        for mu_o in [0.0, 0.3, 1.0] {
            let albedo = integral([0.0, 1.0], 64, |mu| {
                2.0 * std::f64::consts::PI * mu * row.complement(mu_o, mu as Real) as f64
            });
            assert!((albedo - (1.0 - row.at(mu_o)) as f64).abs() < 1e-5, "{mu_o}: {albedo}");
        }
        assert_eq!(AlbedoRow::new(1.0, |_| 1.0).complement(0.5, 0.5), 0.0);
    }

    #[test]
    fn quadrature_is_exact_for_polynomials() {
        assert!((integral([0.0, 2.0], 1, |x| x.powi(15)) - 4096.0).abs() < 1e-8);
    }
}
