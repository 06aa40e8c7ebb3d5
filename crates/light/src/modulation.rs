//! Image maps on lamps: what multiplies the emission spectrum from point to point, and how points are
//! drawn by it.

use crate::map_mean;
use indigo_math::grid_distribution::{GridDistribution, cell_means};
use indigo_math::warp::uniform_triangle;
use indigo_math::{Float, Real, Vec2};
use indigo_spectrum::rgb::{Reflectance, RgbTable};
use indigo_spectrum::{SampledSpectrum, SampledWavelengths, Spectrum, observer};
use indigo_texture::Texture;

/// Cells of the grids of all of a lamp's triangles together: about 2 MB.
const CELLS: usize = 1 << 18;
/// Cells along a side of a triangle's grid, as far as there is room for them: at least, so that few large texels
/// are told apart, and at most; and texels that one spans at least.
const LEAST: usize = 32;
const MOST: usize = 256;
const TEXELS: f64 = 2.0;
/// Points of a cell along each side.
const POINTS: usize = 2;
/// The part of the draws that is even over the area, so that no point is left out between a cell's points.
const EVEN: f64 = 0.1;

/// An image map over the triangles of a lamp.
#[derive(Clone, Debug)]
pub(crate) struct Modulation {
    texture: Texture,
    table: &'static RgbTable,
    /// Texture coordinates of the corners of each triangle.
    uvs: Vec<[Vec2; 3]>,
    /// For each triangle how its points are drawn, over the square that maps to it evenly.
    points: Vec<GridDistribution>,
    /// For each triangle the mean luminance, cd/m².
    means: Vec<f64>,
    /// Luminance of the spectrum itself, cd/m².
    luminance: f64,
}

impl Modulation {
    /// A map over triangles with texture coordinates, on a spectrum (W m^-3 sr^-1).
    pub fn new(texture: Texture, uvs: &[[Vec2<f64>; 3]], spectrum: &Spectrum) -> Self {
        let table = RgbTable::get();
        let eye = Eye::new(spectrum, table);
        let most = ((CELLS / uvs.len().max(1)) as f64).sqrt() as usize;
        let mut grids: Vec<(usize, Vec<f64>)> = vec![];
        let size = texture.size();
        for uv in uvs {
            let n = cells(uv, size).clamp(LEAST, MOST).min(most.max(1));
            let luminance = |at: [f64; 2]| {
                let [x, y] = at.map(|v| v as Real);
                eye.luminance(texture.rgb(mix(uv, uniform_triangle(Vec2::new(x, y)))))
            };
            grids.push((n, cell_means([n, n], POINTS, luminance)));
        }
        let at = |[x, y]: [f64; 2]| {
            let uv = Vec2::new((x / f64::from(size[0])) as Real, (y / f64::from(size[1])) as Real);
            eye.luminance(texture.rgb(uv))
        };
        // A map may be finer than any grid. Where a triangle is a line or a point of it, the cells' mean is what there is.
        let of_cells = |(n, cells): &(usize, Vec<f64>)| cells.iter().sum::<f64>() / (n * n) as f64;
        let exact = map_mean::means(size, uvs, at);
        let means: Vec<f64> = exact
            .into_iter()
            .zip(&grids)
            .map(|(mean, grid)| mean.unwrap_or_else(|| of_cells(grid)))
            .collect();
        let overall = means.iter().sum::<f64>() / means.len().max(1) as f64;
        let points = grids
            .into_iter()
            .map(|(n, cells)| {
                let weights: Vec<f64> = cells.iter().map(|v| (1.0 - EVEN) * v + EVEN * overall).collect();
                GridDistribution::new(n, n, &weights)
            })
            .collect();
        let uvs = uvs.iter().map(|uv| uv.map(|v| Vec2::new(v.x as Real, v.y as Real))).collect();
        Self { texture, table, uvs, points, means, luminance: spectrum.luminance() }
    }

    /// Luminance (cd/m²) of the spectrum that the map was laid on.
    pub fn luminance(&self) -> f64 {
        self.luminance
    }

    /// Mean luminance (cd/m²) of a triangle.
    pub fn mean(&self, triangle: usize) -> f64 {
        self.means[triangle]
    }

    /// How much of its area's share of draws a triangle should get, over the mean: as its points.
    pub fn weight(&self, triangle: usize, overall: f64) -> f64 {
        (1.0 - EVEN) * self.means[triangle] + EVEN * overall
    }

    /// What multiplies the spectrum at a point.
    #[inline]
    pub fn factor(&self, triangle: u32, bary: (Real, Real), lambda: &SampledWavelengths) -> SampledSpectrum {
        let rgb = self.texture.rgb(mix(&self.uvs[triangle as usize], bary));
        let (reflectance, scale) = reflectance(self.table, rgb);
        reflectance.eval(lambda) * scale
    }

    /// Barycentric coordinates of a point of a triangle.
    #[inline]
    pub fn sample(&self, triangle: usize, u: Vec2) -> (Real, Real) {
        uniform_triangle(self.points[triangle].sample([u.x, u.y]).0)
    }

    /// Density of [`sample`](Self::sample), over that of even points.
    #[inline]
    pub fn pdf(&self, triangle: u32, (b1, b2): (Real, Real)) -> Real {
        // The inverse of `uniform_triangle`.
        let at = if b2 > b1 { Vec2::new(2.0 * b1, b1 + b2) } else { Vec2::new(b1 + b2, 2.0 * b2) };
        self.points[triangle as usize].pdf(at)
    }
}

/// The reflectance of an RGB triple and a factor on it, where the triple goes beyond 1.
#[inline]
fn reflectance(table: &RgbTable, rgb: [Real; 3]) -> (Reflectance, Real) {
    let scale = rgb[0].max(rgb[1]).max(rgb[2]).max(1.0);
    (table.lookup(rgb.map(|v| v / scale)), scale)
}

#[inline]
fn mix<T: Float>([a, b, c]: &[Vec2<T>; 3], (b1, b2): (Real, Real)) -> Vec2 {
    let at = *a + (*b - *a) * T::from_f64(b1.to_f64()) + (*c - *a) * T::from_f64(b2.to_f64());
    Vec2::new(at.x.to_f64() as Real, at.y.to_f64() as Real)
}

/// Cells along a side of a triangle's grid, by the texels that its longest side spans.
fn cells([a, b, c]: &[Vec2<f64>; 3], [width, height]: [u32; 2]) -> usize {
    let texels = |p: Vec2<f64>, q: Vec2<f64>| {
        let (x, y) = ((q.x - p.x) * f64::from(width), (q.y - p.y) * f64::from(height));
        (x * x + y * y).sqrt()
    };
    (texels(*a, *b).max(texels(*b, *c)).max(texels(*c, *a)) / TEXELS).ceil() as usize
}

/// The luminance of a spectrum times a smooth one: the spectrum's own is shared out among bands, in each
/// of which the smooth one is taken at its middle.
struct Eye {
    table: &'static RgbTable,
    /// Luminance of each band, and of all, cd/m².
    bands: Vec<f64>,
    all: f64,
    /// The middles of the bands, as the paths' lanes.
    middles: Vec<SampledWavelengths>,
}

/// Width of a band, nm: reflectances of RGB triples bend over hundreds.
const BAND_NM: f64 = 10.0;
const FIRST_NM: f64 = 360.0;
const BANDS: usize = 47;

impl Eye {
    fn new(spectrum: &Spectrum, table: &'static RgbTable) -> Self {
        const STEPS: usize = 40;
        let band = |i: usize| {
            let at = |k: usize| FIRST_NM + BAND_NM * (i as f64 + (k as f64 + 0.5) / STEPS as f64);
            (0..STEPS).map(|k| spectrum.at(at(k)) * observer::cmf(at(k))[1]).sum::<f64>()
        };
        let raw: Vec<f64> = (0..BANDS).map(band).collect();
        let sum: f64 = raw.iter().sum();
        let all = spectrum.luminance();
        let scale = if sum > 0.0 { all / sum } else { 0.0 };
        let lanes = indigo_spectrum::LANES;
        let middle = |i: usize| (FIRST_NM + BAND_NM * (i.min(BANDS - 1) as f64 + 0.5)) as Real;
        let middles = (0..BANDS.div_ceil(lanes)).map(|group| {
            let mut lambda = SampledWavelengths::sample(0.0);
            lambda.lambda = std::array::from_fn(|lane| middle(group * lanes + lane));
            lambda
        });
        Self { table, bands: raw.iter().map(|v| v * scale).collect(), all, middles: middles.collect() }
    }

    /// The luminance (cd/m²) of the spectrum times what an RGB triple stands for.
    fn luminance(&self, rgb: [Real; 3]) -> f64 {
        let [r, g, b] = rgb;
        // Greys are flat, and many maps have no others.
        if r == g && g == b {
            return self.all * r.to_f64().max(0.0);
        }
        let (reflectance, scale) = reflectance(self.table, rgb);
        let mut sum = 0.0;
        for (lambda, bands) in self.middles.iter().zip(self.bands.chunks(indigo_spectrum::LANES)) {
            let values = reflectance.eval(lambda).0;
            sum += bands.iter().zip(values).map(|(band, v)| band * v.to_f64()).sum::<f64>();
        }
        sum * scale.to_f64()
    }
}
