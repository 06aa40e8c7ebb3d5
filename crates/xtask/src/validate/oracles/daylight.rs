//! The models of sun and sky, written anew from the papers and the tables that their authors published: where the numbers of the
//! sky's checks come from.
//!
//! Directions are told by the cosine to the zenith and the angle to the sun; luminances are in cd/m².

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use super::super::shapes::{Point, dot, unit};
use super::colour::tristimulus;

/// Diameter of the sun's disc, degrees.
const SUN_DEGREES: f64 = 0.5358;
/// Wavelengths of Hosek and Wilkie's tables, nm.
const NODES: [f64; 2] = [360.0, 40.0];
const COUNT: usize = 10;

static SKY: &[u8] = include_bytes!("../../../../light/data/hosek_wilkie_2012_sky.f32");
static SUN: &[u8] = include_bytes!("../../../../light/data/hosek_wilkie_2013_sun.f32");
static LIMB: [[f64; 6]; COUNT] = include!("../../../../light/data/limb_darkening.in");
static PREETHAM_SUN: &[f64] = &include!("../../../../light/data/preetham_1999_sun.in");
static OZONE: &[[f64; 2]] = &include!("../../../../light/data/preetham_1999_k_o_ozone.in");
static GASES: &[[f64; 2]] = &include!("../../../../light/data/preetham_1999_k_g_mixed_gases.in");
static WATER: &[[f64; 2]] = &include!("../../../../light/data/preetham_1999_k_wa_water_vapour.in");

/// A sky: elevation of the sun in degrees, and turbidity.
#[derive(Clone, Copy)]
pub struct Sky {
    pub elevation: f64,
    pub turbidity: f64,
    pub is_hosek: bool,
}

impl Sky {
    /// Luminance from a direction, with the sun in another.
    pub fn luminance(self, direction: Point, sun: Point) -> f64 {
        let [direction, sun] = [direction, sun].map(unit);
        self.model()(direction[2], dot(direction, sun).clamp(-1.0, 1.0).acos())
    }

    /// Illuminance of level ground by the sky without the sun, over all directions: in rings of which the cosine is v², since towards the
    /// horizon luminance bends by the root of the cosine.
    pub fn illuminance(self, steps: u32) -> f64 {
        let luminance = self.model();
        let (up, level) = self.elevation.to_radians().sin_cos();
        super::integral(0.0, 1.0, steps, |v| {
            let cos = v * v;
            let sin = (1.0 - cos * cos).sqrt();
            8.0 * PI
                * v.powi(3)
                * super::integral(0.0, 0.5, steps, |turn| {
                    let along = sin * level * (TAU * turn).cos() + cos * up;
                    luminance(cos, along.clamp(-1.0, 1.0).acos())
                })
        })
    }

    fn model(self) -> Box<dyn Fn(f64, f64) -> f64> {
        if self.is_hosek { Box::new(self.hosek()) } else { Box::new(self.preetham()) }
    }

    /// Perez's formula with the coefficients of Preetham, Shirley and Smits 1999, appendix 2.
    fn preetham(self) -> impl Fn(f64, f64) -> f64 {
        let t = self.turbidity;
        let [a, b, c, d, e] = [
            0.178_72 * t - 1.463_03,
            -0.3554 * t + 0.427_49,
            -0.022_66 * t + 5.325_05,
            0.120_64 * t - 2.577_05,
            -0.066_96 * t + 0.370_27,
        ];
        let from_zenith = FRAC_PI_2 - self.elevation.to_radians();
        let chi = (4.0 / 9.0 - t / 120.0) * (PI - 2.0 * from_zenith);
        let zenith = 1e3 * ((4.0453 * t - 4.9710) * chi.tan() - 0.2155 * t + 2.4192);
        let perez = move |cos: f64, gamma: f64| {
            (1.0 + a * (b / cos.max(1e-3)).exp()) * (1.0 + c * (d * gamma).exp() + e * gamma.cos().powi(2))
        };
        let scale = zenith / perez(1.0, from_zenith);
        move |cos, gamma| scale * perez(cos, gamma)
    }

    /// Equation 8 of Hosek and Wilkie 2012 at each wavelength of the tables, straight between them and held beyond.
    fn hosek(self) -> impl Fn(f64, f64) -> f64 {
        let x = (self.elevation / 90.0).cbrt();
        let bernstein = [1.0, 5.0, 10.0, 10.0, 5.0, 1.0];
        let at = |turbidity: usize, node: usize, k: usize| {
            let control = |c: usize| number(SKY, (((turbidity - 1) * 6 + c) * COUNT + node) * 10 + k);
            let part = |c: usize| bernstein[c] * x.powi(c as i32) * (1.0 - x).powi(5 - c as i32);
            (0..6).map(|c| part(c) * control(c)).sum::<f64>()
        };
        let parameters: [[f64; 10]; COUNT] = std::array::from_fn(|node| {
            std::array::from_fn(|k| between(self.turbidity, |turbidity| at(turbidity, node, k)))
        });
        let luminances = node_luminances();
        move |cos: f64, gamma: f64| {
            let of = |[p0, p1, p2, p3, p4, p5, p6, p7, p8, r]: [f64; 10]| {
                let near = gamma.cos();
                let chi = (1.0 + near * near) / (1.0 + p8 * p8 - 2.0 * p8 * near).powf(1.5);
                let down = 1.0 + p0 * (p1 / (cos + 0.01)).exp();
                r * down * (p2 + p3 * (p4 * gamma).exp() + p5 * near * near + p6 * chi + p7 * cos.sqrt())
            };
            parameters.iter().zip(luminances).map(|(p, luminance)| luminance * of(*p)).sum()
        }
    }

    /// Illuminance across the sun's direction.
    pub fn sun(self) -> f64 {
        let solid_angle = PI * (0.5 * SUN_DEGREES).to_radians().sin().powi(2);
        solid_angle * if self.is_hosek { self.hosek_sun() } else { self.preetham_sun() }
    }

    /// Mean luminance of the disc by Hosek and Wilkie 2013: cubics of the elevation in segments, and darker towards the limb.
    fn hosek_sun(self) -> f64 {
        let elevation = self.elevation.to_radians();
        let segment = (45.0 * (elevation / FRAC_PI_2).cbrt()).floor().min(44.0);
        let beyond = elevation - FRAC_PI_2 * (segment / 45.0).powi(3);
        let radiance = |turbidity: usize, node: usize| {
            let first = (((turbidity - 1) * 45 + segment as usize) * COUNT + node) * 4;
            (0..4).map(|k| number(SUN, first + k) * beyond.powi(k as i32)).sum::<f64>()
        };
        // Σ u μ^j has over the disc the mean Σ 2 u / (j + 2).
        let limb = |node: usize| (0..6).map(|j| 2.0 * LIMB[node][j] / (j as f64 + 2.0)).sum::<f64>();
        // Both run straight between the tables' wavelengths.
        let disc: [f64; COUNT] =
            std::array::from_fn(|node| between(self.turbidity, |turbidity| radiance(turbidity, node)));
        let limb: [f64; COUNT] = std::array::from_fn(limb);
        tristimulus(360.0, 830.0, |nm| straight(&disc, nm) * straight(&limb, nm))[1]
    }

    /// Luminance of the disc by appendix 1 of Preetham, Shirley and Smits 1999, at the wavelengths of its table of the sun, straight between them
    /// and nothing beyond.
    fn preetham_sun(self) -> f64 {
        let degrees = 90.0 - self.elevation;
        let mass = 1.0 / (degrees.to_radians().cos() + 0.15 * (93.885 - degrees).powf(-1.253));
        let haze = 0.046_083_658_222_05 * self.turbidity - 0.045_860_259_285_22;
        let kept = |nm: f64| {
            let um = nm * 1e-3;
            let [ozone, gases, water] = [OZONE, GASES, WATER].map(|table| interpolated(table, nm));
            let depth = 0.008_735 * um.powf(-4.08) + haze * um.powf(-1.3) + 0.35 * ozone;
            let gases = 1.41 * gases * mass / (1.0 + 118.93 * gases * mass).powf(0.45);
            let wet = 0.2385 * water * 2.0 * mass;
            let water = wet / (1.0 + 20.07 * water * 2.0 * mass).powf(0.45);
            (-depth * mass - gases - water).exp()
        };
        let at = |i: usize| 380.0 + 10.0 * i as f64;
        let table: Vec<[f64; 2]> =
            PREETHAM_SUN.iter().enumerate().map(|(i, above)| [at(i), above * kept(at(i))]).collect();
        tristimulus(360.0, 830.0, |nm| interpolated(&table, nm))[1]
    }
}

/// A number of a table of `f32`.
fn number(bytes: &[u8], i: usize) -> f64 {
    let (numbers, _) = bytes.as_chunks::<4>();
    f64::from(f32::from_le_bytes(numbers[i]))
}

/// Straight between whole turbidities.
fn between(turbidity: f64, of: impl Fn(usize) -> f64) -> f64 {
    let below = (turbidity as usize).clamp(1, 9);
    of(below) + (of(below + 1) - of(below)) * (turbidity - below as f64)
}

/// Straight between the places of a table, and 0 beyond them.
fn interpolated(table: &[[f64; 2]], nm: f64) -> f64 {
    let span = table.windows(2).find(|pair| (pair[0][0]..=pair[1][0]).contains(&nm));
    span.map_or(0.0, |pair| {
        pair[0][1] + (pair[1][1] - pair[0][1]) * (nm - pair[0][0]) / (pair[1][0] - pair[0][0])
    })
}

/// A number at each wavelength of Hosek and Wilkie's tables, straight between them; the last is held.
fn straight(nodes: &[f64; COUNT], nm: f64) -> f64 {
    let place = ((nm - NODES[0]) / NODES[1]).min((COUNT - 1) as f64);
    let i = (place as usize).min(COUNT - 2);
    nodes[i] + (nodes[i + 1] - nodes[i]) * (place - i as f64)
}

/// Luminance (cd/m²) of 1 W m⁻² sr⁻¹ nm⁻¹ at each wavelength of the tables, straight to 0 at its neighbours; the last is held.
fn node_luminances() -> [f64; COUNT] {
    std::array::from_fn(|i| {
        let mut one = [0.0; COUNT];
        one[i] = 1.0;
        tristimulus(360.0, 830.0, |nm| straight(&one, nm))[1]
    })
}
