//! Sun and sky against tables that were computed from the same papers by other means (to 5 digits).

use indigo_light::Distant;
use indigo_light::kinds::sky::{Sky, SkyModel};
use indigo_light::kinds::sun::{self, Sun};
use indigo_light::sky::hosek::{self, HosekSky};
use indigo_light::sky::preetham::{self, PreethamSky};
use indigo_light::sky::space;
use indigo_math::{Real, Vec3, Vec3d};
use indigo_spectrum::SampledWavelengths;
use indigo_spectrum::observer::xyz_weights;
use indigo_testkit::quadrature::hemisphere;
use std::f64::consts::TAU;

/// Elevation in degrees, turbidity; zenith luminance (cd/m²), horizontal illuminance (lx), zenith x and y.
const HOSEK_SKY: [[f64; 6]; 8] = [
    [15.0, 2.0, 1267.6, 9408.1, 0.2372, 0.2532],
    [45.0, 2.0, 2161.4, 12468.0, 0.2354, 0.2385],
    [60.0, 2.0, 2657.4, 12705.0, 0.2394, 0.2406],
    [30.0, 3.0, 1913.4, 13525.0, 0.2410, 0.2499],
    [45.0, 3.0, 2465.3, 14651.0, 0.2435, 0.2487],
    [60.0, 3.0, 3340.8, 14915.0, 0.2523, 0.2576],
    [15.0, 5.0, 1631.4, 13762.0, 0.2569, 0.2745],
    [45.0, 5.0, 3507.4, 21699.0, 0.2637, 0.2735],
];

/// Elevation in degrees, turbidity; luminance of the disc (cd/m²), illuminance across (lx), x and y.
const HOSEK_SUN: [[f64; 6]; 7] = [
    [5.0, 2.0, 4.1209e8, 28304.0, 0.4640, 0.4273],
    [30.0, 2.0, 1.1616e9, 79785.0, 0.3582, 0.3678],
    [90.0, 2.0, 1.3324e9, 91514.0, 0.3422, 0.3531],
    [10.0, 3.0, 6.5948e8, 45295.0, 0.4113, 0.4052],
    [45.0, 3.0, 1.2292e9, 84422.0, 0.3490, 0.3593],
    [45.0, 5.0, 1.1346e9, 77924.0, 0.3493, 0.3589],
    [60.0, 5.0, 1.1984e9, 82312.0, 0.3451, 0.3551],
];

/// Zenith angle of the sun in degrees, turbidity; zenith luminance (kcd/m²), x, y, horizontal illuminance (lx).
const PREETHAM_SKY: [[f64; 6]; 8] = [
    [0.0, 2.0, 15.50067, 0.26674, 0.27720, 27371.4],
    [45.0, 2.0, 4.46964, 0.24095, 0.24372, 25164.4],
    [45.0, 3.0, 7.32036, 0.24568, 0.25148, 28911.1],
    [75.0, 3.0, 3.37206, 0.25601, 0.26866, 16900.8],
    [30.0, 4.0, 14.60561, 0.25606, 0.26443, 40210.8],
    [60.0, 5.0, 8.18713, 0.25866, 0.27247, 30944.4],
    [45.0, 6.0, 14.89333, 0.26145, 0.27545, 46968.4],
    [85.0, 6.0, 2.45704, 0.28557, 0.30752, 9265.21],
];

/// Zenith angle in degrees, turbidity; luminance of the disc (cd/m²), illuminance across (lx), x and y.
const PREETHAM_SUN: [[f64; 6]; 7] = [
    [0.0, 2.0, 1.4966e9, 1.0279e5, 0.3304, 0.3405],
    [45.0, 2.0, 1.3619e9, 93539.0, 0.3359, 0.3460],
    [45.0, 3.0, 1.1846e9, 81360.0, 0.3409, 0.3502],
    [60.0, 4.0, 8.0557e8, 55329.0, 0.3580, 0.3643],
    [75.0, 5.0, 2.5905e8, 17792.0, 0.4076, 0.3964],
    [30.0, 6.0, 9.1611e8, 62921.0, 0.3490, 0.3559],
    [85.0, 6.0, 3.7326e6, 256.37, 0.5484, 0.4101],
];

/// The sun in the south-east at an elevation in degrees.
fn towards(elevation: f64) -> Vec3d {
    let (s, c) = elevation.to_radians().sin_cos();
    Vec3d::new(0.6 * c, -0.8 * c, s)
}

fn hosek_sky(elevation: f64, turbidity: f64) -> Sky {
    let model = HosekSky::new(elevation.to_radians(), turbidity);
    Sky::new(towards(elevation), SkyModel::Hosek(Box::new(model)))
}

fn preetham_sky(elevation: f64, turbidity: f64) -> Sky {
    let model = PreethamSky::new(elevation.to_radians(), turbidity);
    Sky::new(towards(elevation), SkyModel::Preetham(Box::new(model)))
}

/// XYZ (cd/m²) from a direction: wavelengths at even steps of what draws them.
fn xyz(light: &impl Distant, d: Vec3d) -> [f64; 3] {
    let n = 4096;
    let mut sum = [0.0; 3];
    for i in 0..n {
        let lambda = SampledWavelengths::sample(((f64::from(i) + 0.5) / f64::from(n)) as Real);
        let radiance = light.radiance(d.cast(), &lambda);
        for (sum, weights) in sum.iter_mut().zip(xyz_weights(&lambda)) {
            *sum += radiance.0.iter().zip(weights).map(|(l, w)| (l * w) as f64).sum::<f64>() / f64::from(n);
        }
    }
    sum
}

fn chromaticity([x, y, z]: [f64; 3]) -> [f64; 2] {
    [x / (x + y + z), y / (x + y + z)]
}

#[track_caller]
fn assert_near(what: &str, found: f64, expected: f64, tolerance: f64) {
    assert!((found / expected - 1.0).abs() < tolerance, "{what}: {found} against {expected}");
}

/// Luminance by λ at a direction, and the illuminance of a level surface under the whole sky.
fn check_sky(what: &str, sky: &Sky, model: &SkyModel, sun: Vec3d, zenith: [f64; 3], illuminance: f64) {
    let up = Vec3d::new(0.0, 0.0, 1.0);
    let found = xyz(sky, up);
    assert_near(what, found[1], zenith[0], 5e-4);
    let [x, y] = chromaticity(found);
    assert!((x - zenith[1]).abs() < 3e-4 && (y - zenith[2]).abs() < 3e-4, "{what}: {x} {y}");
    let level = hemisphere(1.0, |d| d[2] * model.luminance(d[2], Vec3d::from(d).dot(sun)));
    assert_near(what, level.value, illuminance, 2e-3);
}

#[test]
fn hosek_and_wilkies_sky_is_that_of_the_table() {
    for [elevation, turbidity, zenith, illuminance, x, y] in HOSEK_SKY {
        let model = SkyModel::Hosek(Box::new(HosekSky::new(elevation.to_radians(), turbidity)));
        let what = format!("elevation {elevation}, turbidity {turbidity}");
        let sky = hosek_sky(elevation, turbidity);
        check_sky(&what, &sky, &model, towards(elevation), [zenith, x, y], illuminance);
    }
}

#[test]
fn preethams_sky_is_that_of_the_table() {
    for [angle, turbidity, zenith, x, y, illuminance] in PREETHAM_SKY {
        let elevation = 90.0 - angle;
        let model = SkyModel::Preetham(Box::new(PreethamSky::new(elevation.to_radians(), turbidity)));
        let what = format!("elevation {elevation}, turbidity {turbidity}");
        let sky = preetham_sky(elevation, turbidity);
        check_sky(&what, &sky, &model, towards(elevation), [1e3 * zenith, x, y], illuminance);
    }
}

#[test]
fn suns_are_those_of_the_tables() {
    let check = |what: &str, sun: &Sun, [luminance, illuminance, x, y]: [f64; 4]| {
        // The tables interpolate the air's transmittance where the sun here interpolates the product.
        assert_near(what, sun.total_luminance(), illuminance, 3e-3);
        assert_near(what, sun.total_luminance() / Sun::solid_angle(sun::RADIUS), luminance, 3e-3);
        // The limb is redder than the middle: the mean over the disc, by its own sampling.
        let mut mean = [0.0; 3];
        for i in 0..64 {
            let u = [(i % 8) as Real / 8.0 + 0.06, (i / 8) as Real / 8.0 + 0.06];
            let d = sun.sample(Vec3::ZERO, u).expect("a direction");
            mean.iter_mut().zip(xyz(sun, d.cast())).for_each(|(mean, v)| *mean += v / 64.0);
        }
        let [found_x, found_y] = chromaticity(mean);
        assert!((found_x - x).abs() < 1e-3 && (found_y - y).abs() < 1e-3, "{what}: {found_x} {found_y}");
    };
    for [elevation, turbidity, luminance, illuminance, x, y] in HOSEK_SUN {
        let disc = hosek::sun(elevation.to_radians(), turbidity);
        let sun = Sun::new(towards(elevation), sun::RADIUS, disc);
        let what = format!("Hosek and Wilkie, elevation {elevation}, turbidity {turbidity}");
        check(&what, &sun, [luminance, illuminance, x, y]);
    }
    for [angle, turbidity, luminance, illuminance, x, y] in PREETHAM_SUN {
        let elevation = 90.0 - angle;
        let disc = preetham::sun(elevation.to_radians(), turbidity);
        let sun = Sun::new(towards(elevation), sun::RADIUS, disc);
        let what = format!("Preetham, elevation {elevation}, turbidity {turbidity}");
        check(&what, &sun, [luminance, illuminance, x, y]);
    }
}

/// ASTM G173: 133.1 klx at (0.3234, 0.3327).
#[test]
fn sunlight_in_space_is_the_standards() {
    let sun = Sun::new(towards(40.0), sun::RADIUS, space::sun(Sun::solid_angle(sun::RADIUS)));
    assert_near("illuminance", sun.total_luminance(), 1.331e5, 1e-3);
    let [x, y] = chromaticity(xyz(&sun, towards(40.0)));
    assert!((x - 0.3234).abs() < 3e-4 && (y - 0.3327).abs() < 3e-4, "{x} {y}");
}

/// Diameter, edge and darkening of the disc.
#[test]
fn the_sun_is_a_disc_of_its_true_size() {
    let middle = towards(35.0);
    let sun = Sun::new(middle, sun::RADIUS, hosek::sun(35f64.to_radians(), 2.0));
    let aside = middle.cross(Vec3d::new(0.0, 0.0, 1.0)).normalized();
    let at = |degrees: f64| {
        let (s, c) = degrees.to_radians().sin_cos();
        xyz(&sun, middle * c + aside * s)[1]
    };
    let bright = at(0.0);
    assert!(at(0.5 * 0.5358 - 0.001) > 0.2 * bright && at(0.5 * 0.5358 + 0.001) == 0.0);
    assert!(at(0.2) < 0.95 * bright && at(0.2) > 0.7 * bright);
}

/// Of a sun that sets, what is below the horizon neither shines nor is drawn: the solid angle that is left is that of
/// the disc without a segment, π R² − R² (acos x − x √(1 − x²)) at x = height / R, and the light that is drawn and the
/// total are those of it.
#[test]
fn the_horizon_cuts_the_sun() {
    let space = space::sun(Sun::solid_angle(sun::RADIUS));
    for (height, disc) in
        [(0.1, space.clone()), (0.02, space), (0.1, hosek::sun(0.002, 2.0)), (0.5, hosek::sun(0.01, 2.0))]
    {
        let (height, radius) = (f64::to_radians(height), sun::RADIUS);
        let low = towards(height.to_degrees());
        let is_even = disc.limb.is_none();
        let sun = Sun::new(low, radius, disc);
        let at = |z: f64| xyz(&sun, Vec3d::new(low.x, low.y, z).normalized())[1];
        assert!(at(-1e-4) == 0.0 && (at(1e-4) > 0.0) == (height < radius));
        let below = Vec3d::new(low.x, low.y, -1e-4).normalized().cast();
        assert_eq!(sun.pdf(Vec3::ZERO, below), 0.0);
        let n = 512;
        let (mut solid_angle, mut light) = (0.0, 0.0);
        for k in 0..n * n {
            let u = [k % n, k / n].map(|i| ((f64::from(i) + 0.5) / f64::from(n)) as Real);
            let d = sun.sample(Vec3::ZERO, u).expect("a direction");
            let pdf = sun.pdf(Vec3::ZERO, d) as f64;
            // Rounding may push what lies on the rim out of the disc.
            if pdf > 0.0 {
                assert!(d.z >= 0.0);
                solid_angle += 1.0 / pdf / f64::from(n * n);
                if k % 61 == 0 {
                    light += 61.0 * xyz_coarse(&sun, d) / pdf / f64::from(n * n);
                }
            }
        }
        let x = (height / radius).min(1.0);
        let segment = x.acos() - x * (1.0 - x * x).sqrt();
        let expected = radius * radius * (std::f64::consts::PI - segment);
        assert_near("solid angle", solid_angle, expected, 2e-3);
        assert_near("light", light, sun.total_luminance(), 1e-2);
        if is_even {
            assert_near("total", sun.total_luminance(), expected * xyz(&sun, low)[1], 1e-3);
        }
    }
}

/// Luminance (cd/m²) from a direction, of few wavelengths.
fn xyz_coarse(light: &impl Distant, d: Vec3) -> f64 {
    let n = 32;
    let at = |i: u32| {
        let lambda = SampledWavelengths::sample(((f64::from(i) + 0.5) / f64::from(n)) as Real);
        let radiance = light.radiance(d, &lambda);
        radiance.0.iter().zip(xyz_weights(&lambda)[1]).map(|(l, w)| (l * w) as f64).sum::<f64>()
    };
    (0..n).map(at).sum::<f64>() / f64::from(n)
}

/// However low the sun, no part of the sky is negative, green, or without a number.
#[test]
fn low_suns_are_neither_negative_nor_green() {
    for elevation in [0.0, 2.0, 5.0, 10.0, 20.0] {
        for turbidity in [1.0, 2.0, 3.0, 6.0] {
            for (model, sky) in
                [("hosek", hosek_sky(elevation, turbidity)), ("preetham", preetham_sky(elevation, turbidity))]
            {
                assert!(sky.total_luminance() > 0.0);
                for i in 0..96 {
                    let (height, turn) =
                        (0.02 + 0.98 * f64::from(i % 8) / 8.0, f64::from(i / 8) * TAU / 12.0);
                    let r = (1.0 - height * height).sqrt();
                    let d = Vec3d::new(r * turn.cos(), r * turn.sin(), height);
                    let lambda = SampledWavelengths::sample((f64::from(i) / 96.0) as Real);
                    let radiance = sky.radiance(d.cast(), &lambda);
                    assert!(radiance.is_finite() && radiance.min_lane() >= 0.0);
                    let [cx, cy, cz] = xyz(&sky, d);
                    let rgb = [
                        3.2406 * cx - 1.5372 * cy - 0.4986 * cz,
                        -0.9689 * cx + 1.8758 * cy + 0.0415 * cz,
                        0.0557 * cx - 0.2040 * cy + 1.0570 * cz,
                    ];
                    let green = rgb[1] / rgb[0].max(rgb[2]);
                    // Between the blue above and the orange below both models pass a pale yellow that leans to green.
                    // By another program, from the papers and on a grid of 120 by 90, most in the clearest air
                    // under a sun 10° high: 1.207; no sky that is computed rightly has more.
                    assert!(
                        green < 1.21,
                        "{model}, elevation {elevation}, turbidity {turbidity}: {rgb:?} at {d:?}"
                    );
                }
            }
        }
    }
}

/// The sky is brightest at the sun, and the same on both sides of it.
#[test]
fn the_sky_is_symmetric_about_the_sun() {
    for sky in [hosek_sky(40.0, 3.0), preetham_sky(40.0, 3.0)] {
        let sun = towards(40.0);
        let lambda = SampledWavelengths::sample(0.3);
        let across = sun.cross(Vec3d::new(0.0, 0.0, 1.0)).normalized();
        let brightest = sky.radiance(sun.cast(), &lambda).hero();
        for i in 1..30 {
            let a = 0.1 * f64::from(i);
            let (s, c) = a.sin_cos();
            let mirror = |side: f64| -> Vec3 {
                let flat = Vec3d::new(sun.x, sun.y, 0.0).normalized();
                (flat * (c * 0.8) + across * (s * side * 0.8) + Vec3d::new(0.0, 0.0, 0.6)).cast()
            };
            let (left, right) = (sky.radiance(mirror(1.0), &lambda), sky.radiance(mirror(-1.0), &lambda));
            assert!((left.hero() / right.hero() - 1.0).abs() < 1e-4, "{i}: {left:?} {right:?}");
            // Within 6° the gradient towards the horizon wins over the glow.
            assert!(i == 1 || left.hero() < brightest, "{i}: {left:?} {brightest}");
        }
    }
}
