//! `env_map`: light from a picture of the surroundings.
//!
//! As seen from inside, the middle of a map of either layout lies towards +y, its right half towards +x
//! and its upper half towards +z; a picture is not mirrored.
//!
//! - *Latitude and longitude*: x runs over the azimuth, a full turn to the right, y over the angle from
//!   +z, a half turn downwards.
//! - *Angular map* (`spherical`): the distance from the middle, over half the width, is the angle from +y
//!   over π (P. Debevec's light probes, as HDR Shop writes them). What lies outside the circle is not used.
//!
//! Texels stand in the middle of their cells and values between them are bilinear. Directions are drawn
//! with a density that is constant over each cell, in proportion to the luminance that comes from it.

use super::Distant;
use indigo_decl::{Alternatives, Block, Field, Kind, Presence, Range};
use indigo_math::angle::atan2_turns;
use indigo_math::elementary::sin_cos_turns;
use indigo_math::grid_distribution::{GridDistribution, cell_means};
use indigo_math::warp::PI;
use indigo_math::{Float, Real, Vec2, Vec3};
use indigo_spectrum::rgb::RgbTable;
use indigo_spectrum::{SampledSpectrum, SampledWavelengths, Spectrum};

const GAIN: Field = Field::new(
    "gain",
    Kind::Real,
    Presence::Required,
    "Factor on the values of the map, which are spectral radiance once scaled.",
)
.range(Range::Above(0.0));

/// The declaration of `env_map`.
pub static BLOCK: Block = Block::new(
    "env_map",
    "Lights the scene with a high-dynamic-range picture of the surroundings, infinitely far away.",
    &[],
)
.with_alternatives(Alternatives::new("kind of environment map", &[&LATLONG, &SPHERICAL]))
.with_example(
    "<env_map>
    <spherical>
        <path>probes/kitchen_probe.float</path>
        <width>640</width>
        <gain>0.9</gain>
    </spherical>
</env_map>",
);

/// The declaration of `latlong`.
pub static LATLONG: Block = Block::new(
    "latlong",
    "A map in latitude and longitude: an EXR or Radiance HDR file. Its middle lies towards +y, its right \
     half towards +x, its top towards +z. Values of a Radiance file are divided by its EXPOSURE and COLORCORR, which \
     makes them radiance again. Colours are converted from the primaries that the file states (chromaticities of an \
     EXR, PRIMARIES of a Radiance file), and are those of Rec. 709 where it states none.",
    &[Field::new("path", Kind::Path, Presence::Required, "The file, relative to the scene file."), GAIN],
)
.with_aliases(&["lat_long"])
.with_example("<latlong><path>sky.exr</path><gain>700000</gain></latlong>");

/// The declaration of `spherical`.
pub static SPHERICAL: Block = Block::new(
    "spherical",
    "An angular map, as HDR Shop makes of a light probe: the distance from the middle, over half the width, \
     is the angle from +y over 180 degrees; right is +x, and the top +z. The .float file holds nothing but \
     three 32-bit floats (little-endian) for each pixel, from the upper left on.",
    &[
        Field::new("path", Kind::Path, Presence::Required, "The .float file, relative to the scene file."),
        Field::new("width", Kind::Int, Presence::Required, "Width of the map, which is also its height.")
            .unit("pixels")
            .range(Range::Above(0.0)),
        GAIN,
    ],
)
.with_example(
    "<spherical>
    <path>probes/kitchen_probe.float</path>
    <width>640</width>
    <gain>0.9</gain>
</spherical>",
);

/// How directions lie in a map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Layout {
    /// Latitude and longitude.
    LatLong,
    /// The same, the map turned about the z axis by a part of a full turn: to the left as seen from inside.
    Turned(Real),
    /// The angle from the middle in proportion to the distance.
    Angular,
}

impl Layout {
    /// The place of a unit direction in the map, from (0, 0), upper left, to (1, 1).
    #[inline]
    fn place(self, d: Vec3) -> Vec2 {
        match self {
            Self::LatLong => lat_long_place(d, 0.0),
            Self::Turned(turn) => lat_long_place(d, turn),
            Self::Angular => {
                let across = (d.x * d.x + d.z * d.z).sqrt();
                let r = 2.0 * atan2_turns(across, d.y);
                let (x, z) = if across > 0.0 { (d.x / across, d.z / across) } else { (1.0, 0.0) };
                Vec2::new(0.5 + 0.5 * r * x, 0.5 - 0.5 * r * z)
            }
        }
    }

    /// The unit direction at a place of the map, and the solid angle (sr) by the map's area; `None`
    /// outside an angular map's circle, and where a point stands for no solid angle.
    #[inline]
    fn direction(self, at: Vec2) -> Option<(Vec3, Real)> {
        match self {
            Self::LatLong => lat_long_direction(at, 0.0),
            Self::Turned(turn) => lat_long_direction(at, turn),
            Self::Angular => {
                let (x, z) = (2.0 * at.x - 1.0, 1.0 - 2.0 * at.y);
                let r = (x * x + z * z).sqrt();
                let (sin, cos) = sin_cos_turns(0.5 * r);
                if r >= 1.0 || sin <= 0.0 {
                    return (r == 0.0).then(|| (Vec3::new(0.0, 1.0, 0.0), 4.0 * PI * PI));
                }
                Some((Vec3::new(sin * x / r, cos, sin * z / r), 4.0 * PI * sin / r))
            }
        }
    }
}

/// See [`Layout::place`].
#[inline]
fn lat_long_place(d: Vec3, turn: Real) -> Vec2 {
    let turned = atan2_turns(d.x, d.y) + 0.5 + turn;
    let from_top = 2.0 * atan2_turns((d.x * d.x + d.y * d.y).sqrt(), d.z);
    let across = turned - turned.floor();
    // What is just below 0 is rounded to 1.
    Vec2::new(if across >= 1.0 { 0.0 } else { across }, from_top)
}

/// See [`Layout::direction`].
#[inline]
fn lat_long_direction(at: Vec2, turn: Real) -> Option<(Vec3, Real)> {
    let (sin_x, cos_x) = sin_cos_turns(at.x - 0.5 - turn);
    let (sin_y, cos_y) = sin_cos_turns(0.5 * at.y);
    let stretch = 2.0 * PI * PI * sin_y;
    (stretch > 0.0).then(|| (Vec3::new(sin_y * sin_x, sin_y * cos_x, cos_y), stretch))
}

/// A picture of the surroundings.
#[derive(Clone, Debug)]
pub struct EnvMap {
    layout: Layout,
    width: usize,
    height: usize,
    /// Linear Rec. 709 emission, W m^-3 sr^-1, rows from the top.
    texels: Vec<[f32; 3]>,
    table: &'static RgbTable,
    directions: GridDistribution,
    total_luminance: f64,
}

impl EnvMap {
    /// From texels of linear Rec. 709 emission (W m^-3 sr^-1), rows from the top, none of them negative
    /// or not finite.
    ///
    /// # Panics
    /// If there are not `width · height` texels, or none.
    pub fn new(layout: Layout, width: usize, height: usize, mut texels: Vec<[f32; 3]>) -> Self {
        assert!(width > 0 && height > 0 && texels.len() == width * height, "a texel for each cell");
        if layout == Layout::Angular {
            fill_outside(width, height, &mut texels);
        }
        let luminances: Vec<f32> = texels.iter().map(|t| luminance(*t) as f32).collect();
        let light = |at| bilinear(width, height, at, |k| f64::from(luminances[k]));
        let weights = integrals(layout, [width, height], light);
        Self {
            total_luminance: weights.iter().sum::<f64>() * Spectrum::uniform(1.0).luminance(),
            directions: GridDistribution::new(width, height, &weights),
            table: RgbTable::get(),
            layout,
            width,
            height,
            texels,
        }
    }

    /// The same map with directions drawn evenly over the sphere, wherever its light comes from: what drawing by
    /// luminance is measured against.
    #[must_use]
    pub fn drawn_evenly(mut self) -> Self {
        let (width, height) = (self.width, self.height);
        let solid_angles = integrals(self.layout, [width, height], |_| 1.0);
        self.directions = GridDistribution::new(width, height, &solid_angles);
        self
    }

    /// The same map with all its light multiplied by a factor.
    #[must_use]
    pub fn scaled(self, factor: f64) -> Self {
        let texels = self.texels.iter().map(|t| t.map(|v| (f64::from(v) * factor) as f32)).collect();
        Self { texels, total_luminance: self.total_luminance * factor, ..self }
    }

    /// For the laws: coarse maps with bright, dark and coloured texels.
    pub(super) fn examples() -> Vec<Self> {
        let texel = |i: usize| {
            let k = (i * 37 + 4) % 11;
            if k < 3 { [0.0; 3] } else { [k as f32, 0.5 * k as f32 + 1.0, if k == 5 { 90.0 } else { 2.0 }] }
        };
        let map = |layout, w: usize, h: usize| Self::new(layout, w, h, (0..w * h).map(texel).collect());
        let evenly = map(Layout::LatLong, 6, 4).drawn_evenly();
        let turned = map(Layout::Turned(0.3), 8, 5);
        vec![
            map(Layout::LatLong, 8, 5),
            map(Layout::Angular, 7, 7),
            map(Layout::LatLong, 2, 1),
            evenly,
            turned,
        ]
    }

    /// Linear Rec. 709 emission from a unit direction.
    #[inline]
    fn rgb(&self, towards: Vec3) -> [Real; 3] {
        let at = self.layout.place(towards);
        std::array::from_fn(|c| {
            bilinear(self.width, self.height, at, |k| f64::from(self.texels[k][c])) as Real
        })
    }
}

impl Distant for EnvMap {
    #[inline]
    fn radiance(&self, towards: Vec3, lambda: &SampledWavelengths) -> SampledSpectrum {
        self.table.lookup_emission(self.rgb(towards)).eval(lambda)
    }

    #[inline]
    fn sample(&self, _n: Vec3, u: [Real; 2]) -> Option<Vec3> {
        let (at, _) = self.directions.sample(u);
        Some(self.layout.direction(at)?.0)
    }

    #[inline]
    fn pdf(&self, _n: Vec3, towards: Vec3) -> Real {
        let at = self.layout.place(towards);
        self.layout.direction(at).map_or(0.0, |(_, stretch)| self.directions.pdf(at) / stretch)
    }

    fn total_luminance(&self) -> f64 {
        self.total_luminance
    }

    fn is_drawn(&self) -> bool {
        true
    }

    #[inline]
    fn portal_share(&self) -> Real {
        0.5
    }
}

/// Relative luminance of linear Rec. 709.
fn luminance([r, g, b]: [f32; 3]) -> f64 {
    0.2126 * f64::from(r) + 0.7152 * f64::from(g) + 0.0722 * f64::from(b)
}

/// Between the four texels round a place. Left and right edges meet, as they do in longitude; in an angular
/// map they touch the circle in one point, which is the same direction.
#[inline]
fn bilinear(width: usize, height: usize, at: Vec2, texel: impl Fn(usize) -> f64) -> f64 {
    let (x, y) = (at.x.to_f64() * width as f64 - 0.5, at.y.to_f64() * height as f64 - 0.5);
    let (fx, fy) = (x - x.floor(), y - y.floor());
    let column = |x: f64| (x as isize).rem_euclid(width as isize) as usize;
    let row = |y: f64| (y.max(0.0) as usize).min(height - 1);
    let (x0, x1) = (column(x.floor()), column(x.floor() + 1.0));
    let (y0, y1) = (row(y.floor()) * width, row(y.floor() + 1.0) * width);
    let upper = texel(y0 + x0) * (1.0 - fx) + texel(y0 + x1) * fx;
    let lower = texel(y1 + x0) * (1.0 - fx) + texel(y1 + x1) * fx;
    upper * (1.0 - fy) + lower * fy
}

/// Integrals of a function of the place over the solid angle of each cell of a map, row by row, by the midpoint rule.
/// There is a point in each quarter of a cell at least, so that a texel that shines anywhere in it counts.
fn integrals(layout: Layout, [width, height]: [usize; 2], f: impl Fn(Vec2) -> f64) -> Vec<f64> {
    /// Points over a whole map's width and height, if its cells are fewer.
    const POINTS: usize = 256;
    let points = POINTS.div_ceil(width.min(height)).max(2);
    let mut cells = cell_means([width, height], points, |[x, y]| {
        let place = Vec2::new(x as Real, y as Real);
        layout.direction(place).map_or(0.0, |(_, stretch)| f(place) * stretch.to_f64())
    });
    for mean in &mut cells {
        *mean /= (width * height) as f64;
    }
    cells
}

/// Texels outside an angular map's circle become what the circle's edge is before them, since the
/// values just inside are mixed with them.
fn fill_outside(width: usize, height: usize, texels: &mut [[f32; 3]]) {
    let size = [width as f64, height as f64];
    for i in 0..texels.len() {
        let p = [(i % width) as f64, (i / width) as f64];
        let from_middle: [f64; 2] = std::array::from_fn(|k| (p[k] + 0.5) / size[k] * 2.0 - 1.0);
        let r = from_middle[0].hypot(from_middle[1]);
        // A whole texel from the circle's edge, so that the texel's own middle is inside.
        let inner = 1.0 - 2.0 / width.min(height) as f64;
        if r > 1.0 && inner > 0.0 {
            let [x, y] = std::array::from_fn(|k| {
                let place = f64::midpoint(from_middle[k] / r * inner, 1.0) * size[k];
                (place as usize).min(size[k] as usize - 1)
            });
            texels[i] = texels[y * width + x];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const AXES: [(Vec3, [f64; 2], [f64; 2]); 5] = [
        // Direction, its place by latitude and longitude, its place in an angular map.
        (Vec3 { x: 0.0, y: 1.0, z: 0.0 }, [0.5, 0.5], [0.5, 0.5]),
        (Vec3 { x: 1.0, y: 0.0, z: 0.0 }, [0.75, 0.5], [0.75, 0.5]),
        (Vec3 { x: -1.0, y: 0.0, z: 0.0 }, [0.25, 0.5], [0.25, 0.5]),
        (Vec3 { x: 0.0, y: 0.8, z: 0.6 }, [0.5, 0.295_167_235], [0.5, 0.397_583_618]),
        (Vec3 { x: 0.0, y: 0.8, z: -0.6 }, [0.5, 0.704_832_765], [0.5, 0.602_416_382]),
    ];

    #[test]
    fn directions_lie_where_the_documentation_says() {
        for (d, lat_long, angular) in AXES {
            for (layout, place) in [(Layout::LatLong, lat_long), (Layout::Angular, angular)] {
                let at = layout.place(d);
                assert!((at.x as f64 - place[0]).abs() < 1e-6 && (at.y as f64 - place[1]).abs() < 1e-6);
                let (back, _) = layout.direction(at).unwrap();
                assert!((back - d).length() < 1e-6, "{layout:?} {d:?} {back:?}");
            }
        }
    }

    #[test]
    fn a_map_that_is_turned_to_the_left_shows_what_was_ahead_there() {
        let (ahead, left) = (Vec3::new(0.0, 1.0, 0.0), Vec3::new(-1.0, 0.0, 0.0));
        let (level, turned) = (Layout::LatLong, Layout::Turned(0.25));
        let difference = turned.place(left) - level.place(ahead);
        assert!(difference.x.abs().max(difference.y.abs()) < 1e-6);
        for d in [left, Vec3::new(0.6, -0.48, 0.64)] {
            let (back, _) = turned.direction(turned.place(d)).unwrap();
            assert!((back - d).length() < 1e-6, "{back:?}");
        }
    }

    #[test]
    fn a_marked_texel_shines_from_its_direction_alone() {
        for layout in [Layout::LatLong, Layout::Angular] {
            let (w, h) = (32, 32);
            let (column, row) = (20, 12);
            let mut texels = vec![[0.0; 3]; w * h];
            texels[row * w + column] = [5.0, 6.0, 7.0];
            let map = EnvMap::new(layout, w, h, texels);
            let middle = Vec2::new((column as Real + 0.5) / 32.0, (row as Real + 0.5) / 32.0);
            let (d, _) = layout.direction(middle).unwrap();
            assert!(d.x > 0.0 && d.z > 0.0, "right of the middle and above it");
            assert!(map.rgb(d).iter().zip([5.0, 6.0, 7.0]).all(|(a, b): (&Real, Real)| (a - b).abs() < 1e-3));
            assert_eq!(map.rgb(-d), [0.0; 3]);
            let mirrored = Vec3::new(-d.x, d.y, d.z);
            assert_eq!(map.rgb(mirrored), [0.0; 3]);
        }
    }

    #[test]
    fn an_even_map_is_even() {
        for layout in [Layout::LatLong, Layout::Angular] {
            let map = EnvMap::new(layout, 16, 16, vec![[2.0; 3]; 256]);
            let exact = 4.0 * std::f64::consts::PI * Spectrum::uniform(2.0).luminance();
            let relative = map.total_luminance / exact;
            // Both midpoint sums are over 256 by 256 points, some of them on the circle's rim.
            assert!((relative - 1.0).abs() < 1e-3, "{layout:?} {relative}");
            for i in 0..100 {
                let (s, c) = sin_cos_turns(i as Real * 0.0137);
                assert!((map.rgb(Vec3::new(s * 0.6, c, s * 0.8))[1] - 2.0).abs() < 1e-5);
            }
        }
    }

    /// What lies outside the circle of an angular map is no part of the surroundings.
    #[test]
    fn the_corners_of_an_angular_map_do_not_shine() {
        let (w, h) = (24, 24);
        let texels = (0..w * h)
            .map(|i| {
                let (x, y) = ((i % w) as f64 + 0.5 - 12.0, (i / w) as f64 + 0.5 - 12.0);
                if x.hypot(y) > 12.0 { [1e6; 3] } else { [1.0; 3] }
            })
            .collect();
        let map = EnvMap::new(Layout::Angular, w, h, texels);
        for i in 0..200 {
            let (s, c) = sin_cos_turns(i as Real / 200.0);
            assert!((map.rgb(Vec3::new(s * 0.02, -0.9998, c * 0.02))[1] - 1.0).abs() < 1e-5);
        }
    }
}
