//! Drawing light from the table of lights, and the densities of having done so.
//!
//! Statistical tests share a false-alarm probability of 1e-4; seeds are fixed.

use indigo_light::kinds::background::Background;
use indigo_light::kinds::env_map::{EnvMap, Layout};
use indigo_light::{AreaLight, EmitterHit, LightSample, LightTable, Portals, Receiver};
use indigo_math::{Real, Vec3, Vec3d};
use indigo_spectrum::{SampledWavelengths, Spectrum};
use indigo_testkit::chi2::{Chi2, Domain};
use indigo_testkit::quadrature::{hemisphere, sphere};
use indigo_testkit::rng::Rng;
use indigo_testkit::stats::Moments;
use indigo_testkit::ztest::{MeanTest, welch};

/// Where light is gathered: the origin of a surface that faces up.
const P: Vec3 = Vec3 { x: 0.0, y: 0.0, z: 0.0 };
const N: Vec3 = Vec3 { x: 0.0, y: 0.0, z: 1.0 };

/// An emitter that the tests know by heart: a square of some half side in the plane through `at`
/// across `-at`, showing its front to the origin.
struct Square {
    at: Vec3d,
    half: f64,
    radiance: f64,
    /// Unit axes in its plane, and its normal towards the origin.
    axes: [Vec3d; 3],
}

impl Square {
    fn new(at: [f64; 3], half: f64, radiance: f64) -> Self {
        let at = cast(at);
        let n = (-at).normalized();
        let u = n.cross(Vec3d::new(0.3, 0.9, 0.1)).normalized();
        Self { at, half, radiance, axes: [u, n.cross(u), n] }
    }

    fn corners(&self) -> [[Vec3d; 3]; 2] {
        let [u, v, _] = self.axes;
        let c = |x: f64, y: f64| self.at + u * (x * self.half) + v * (y * self.half);
        [[c(-1.0, -1.0), c(1.0, -1.0), c(1.0, 1.0)], [c(-1.0, -1.0), c(1.0, 1.0), c(-1.0, 1.0)]]
    }

    fn light(&self) -> AreaLight {
        AreaLight::new(Spectrum::uniform(self.radiance), &self.corners())
    }

    /// Where a direction from the origin meets it, as part of an object.
    fn meet(&self, d: Vec3d, object: u32) -> Option<EmitterHit> {
        let [u, v, n] = self.axes;
        let cos = -d.dot(n);
        if cos <= 0.0 {
            return None;
        }
        let t = -self.at.dot(n) / cos;
        let p = d * t - self.at;
        let inside = |x: f64| x.abs() <= self.half;
        let (x, y) = (p.dot(u) / self.half, p.dot(v) / self.half);
        // Corners (-1, -1), (1, -1), (1, 1) and (-1, -1), (1, 1), (-1, 1).
        let (triangle, bary) =
            if y < x { (0, (0.5 * (x - y), 0.5 * (y + 1.0))) } else { (1, (0.5 * (x + 1.0), 0.5 * (y - x))) };
        (inside(p.dot(u)) && inside(p.dot(v))).then(|| EmitterHit {
            object,
            triangle,
            bary: (bary.0 as Real, bary.1 as Real),
            p: (d * t).cast(),
            n: n.cast(),
        })
    }
}

/// A near square that fills much of the sky, a small bright one and one below the horizon.
fn squares() -> [Square; 3] {
    [
        Square::new([0.4, 0.3, 1.0], 0.8, 2.0),
        Square::new([-2.0, 1.0, 1.5], 0.4, 30.0),
        Square::new([1.0, -1.0, -2.0], 0.5, 5.0),
    ]
}

const SKY: f64 = 0.8;

fn table(with_sky: bool) -> LightTable {
    let lamps: Vec<AreaLight> = squares().iter().map(Square::light).collect();
    // As even as a background, but drawn.
    let sky = || EnvMap::new(Layout::LatLong, 32, 16, vec![[SKY as f32; 3]; 512]).into();
    // Objects: one that is no light, then the squares.
    let numbers = [None, Some(0), Some(1), Some(2)];
    LightTable::new(lamps, with_sky.then(sky).into_iter().collect(), numbers.into_iter(), (Vec3d::ZERO, 2.0))
}

/// The sky's radiance at the hero wavelength, the same from everywhere.
fn sky(table: &LightTable) -> f64 {
    table.environment(N, &wavelengths()).expect("a sky").hero() as f64
}

fn wavelengths() -> SampledWavelengths {
    SampledWavelengths::sample(0.4)
}

fn draw(table: &LightTable, rng: &mut Rng) -> Option<LightSample> {
    let u = [0; 4].map(|_| rng.uniform_f32() as Real);
    table.sample(&Receiver::facing(P, N), u, &wavelengths())
}

fn cast(d: [f64; 3]) -> Vec3d {
    Vec3d::new(d[0], d[1], d[2])
}

/// Density of drawing a direction, by the functions that weigh directions found otherwise.
fn density(table: &LightTable, squares: &[Square], d: [f64; 3]) -> f64 {
    let d = cast(d);
    let of_squares: f64 = squares
        .iter()
        .enumerate()
        .filter_map(|(i, s)| {
            let hit = s.meet(d, 1 + i as u32)?;
            Some(table.pdf_object(&hit, &Receiver::facing(P, N)) as f64)
        })
        .sum();
    of_squares + table.pdf_environment(&Receiver::facing(P, N), d.cast()) as f64
}

/// The density of a direction is the sum over all lights that lie in it, whatever hides what.
#[test]
fn directions_follow_the_densities_of_the_lights() {
    let (table, squares) = (table(true), squares());
    let test = Chi2 { samples: 20_000, ..Chi2::new(Domain::Sphere) };
    let result = test.run(
        |rng| draw(&table, rng).map(|s| s.wi.to_array().map(|x| x as f64)),
        |d| density(&table, &squares, d),
    );
    assert!(result.passed(), "{result}");
}

#[test]
fn a_draw_reports_its_light_and_its_density() {
    let (table, squares) = (table(true), squares());
    let mut rng = Rng::new(4);
    for _ in 0..5000 {
        let Some(s) = draw(&table, &mut rng) else { continue };
        assert!((s.wi.length() - 1.0).abs() < 1e-5);
        let d: Vec3d = s.wi.cast();
        let Some(point) = s.point else {
            let expected = table.pdf_environment(&Receiver::facing(P, N), s.wi);
            assert!((s.pdf - expected).abs() <= 1e-5 * expected);
            assert!((s.radiance.hero() - sky(&table) as Real).abs() < 1e-4);
            continue;
        };
        let hit = squares
            .iter()
            .position(|q| (q.axes[2].cast() - point.n).length() < 1e-5)
            .expect("one of the squares");
        assert_eq!(s.radiance.hero(), squares[hit].radiance as Real);
        assert!((point.p.normalized() - s.wi).length() < 1e-5);
        let (object, triangle, bary) = (1 + hit as u32, point.triangle, point.bary);
        let met = squares[hit].meet(d, object).expect("the square that was drawn");
        assert_eq!(met.triangle, triangle);
        assert!((met.bary.0 - bary.0).abs() < 1e-4 && (met.bary.1 - bary.1).abs() < 1e-4);
        let hit = EmitterHit { object, triangle, bary, p: point.p, n: point.n };
        let expected = table.pdf_object(&hit, &Receiver::facing(P, N));
        assert!((s.pdf - expected).abs() <= 1e-4 * expected, "{} {expected}", s.pdf);
    }
}

/// Estimates of the irradiance from drawn lights against the integral over directions.
#[test]
fn drawn_light_estimates_the_irradiance() {
    let shown = squares();
    for with_sky in [false, true] {
        let table = table(with_sky);
        let integral: f64 = shown
            .iter()
            .map(|s| {
                let radiance = |d: [f64; 3]| s.meet(cast(d), 0).map_or(0.0, |_| s.radiance * d[2]);
                hemisphere(1e-3, radiance).value
            })
            .sum::<f64>()
            + if with_sky { std::f64::consts::PI * sky(&table) } else { 0.0 };
        let mut rng = Rng::new(5);
        // Light from below the horizon does not count.
        let estimates = Moments::of((0..400_000).map(|_| {
            draw(&table, &mut rng)
                .map_or(0.0, |s| s.radiance.hero() as f64 * (s.wi.z as f64).max(0.0) / s.pdf as f64)
        }));
        // The quadrature of squares' edges is good to a few parts in 10,000.
        let test: MeanTest = welch(&estimates, &Moments::exact(integral), 5e-4 * integral).at(3e-5);
        assert!(test.passed() && test.std_error < 3e-3 * integral, "with sky {with_sky}: {test}");
    }
}

/// An even background is left to scattering: receivers draw lamps alone, but for portals. It still enters the
/// scene.
#[test]
fn a_background_is_drawn_through_portals_alone() {
    let to = Receiver::facing(P, N);
    let corner = |x: f64, y: f64| Vec3d::new(x, y, 1.0);
    // Its front looks down, into the interior.
    let opening = [[corner(-1.0, -1.0), corner(-1.0, 1.0), corner(1.0, -1.0)]];
    let surroundings = |portals, lamps| {
        let sky = vec![Background(Spectrum::uniform(SKY)).into()];
        LightTable::with_portals(lamps, sky, [Some(0)].into_iter(), (Vec3d::ZERO, 2.0), portals)
    };
    let alone = surroundings(None, vec![]);
    assert!(alone.sample(&to, [0.5; 4], &wavelengths()).is_none() && alone.pdf_environment(&to, N) == 0.0);
    assert!(alone.sample_emission([0.5; 4], [0.5; 2], &wavelengths()).is_some());
    assert!(alone.pdf_emission_environment(N, P).first > 0.0);
    let beside_a_lamp = surroundings(None, vec![squares()[1].light()]);
    assert_eq!(beside_a_lamp.pdf_environment(&to, N), 0.0);
    let mut rng = Rng::new(6);
    for sample in (0..100).filter_map(|_| draw(&beside_a_lamp, &mut rng)) {
        // It is always the lamp, whose light leaves it less often than the sky's enters.
        let at = sample.point.expect("the lamp");
        let hit = EmitterHit { object: 0, triangle: at.triangle, bary: at.bary, p: at.p, n: at.n };
        assert!((sample.pdf / beside_a_lamp.pdf_object(&hit, &to) - 1.0).abs() < 1e-4);
        let emission = beside_a_lamp.pdf_emission_object(&hit, -sample.wi);
        assert!((sample.pdf_emission.first / emission.first - 1.0).abs() < 1e-5);
        assert!(emission.first < 0.9 * sample.pdf * -sample.wi.dot(at.n) / (at.p - P).length2());
    }
    let open = surroundings(Portals::new(&opening), vec![]);
    assert!(open.pdf_environment(&to, Vec3::new(-0.1, -0.1, 1.0).normalized()) > 0.0);
    assert!((0..100).any(|_| draw(&open, &mut rng).is_some()));
}

/// Light that enters a wide scene by a small portal is not lost where single precision misses the portal from afar:
/// half of all directions lead into the interior, each of them enters, and its line as the scene sees it passes the
/// opening: within some roundings of numbers up to 2, where one of 1e6 is 0.06.
#[test]
fn light_enters_by_a_small_portal_of_a_wide_scene() {
    let corner = |x: f64, y: f64| Vec3d::new(x, y, 1.0);
    let opening = [[corner(-0.1, -0.1), corner(-0.1, 0.1), corner(0.1, -0.1)]];
    let sky = vec![Background(Spectrum::uniform(SKY)).into()];
    let none = [None].into_iter();
    let table = LightTable::with_portals(vec![], sky, none, (Vec3d::ZERO, 1e6), Portals::new(&opening));
    let mut rng = Rng::new(8);
    let n = 20_000;
    let mut entered = 0;
    for _ in 0..n {
        let [a, b, c, d, e, f] = [0; 6].map(|_| rng.uniform_f32() as Real);
        let Some(sent) = table.sample_emission([a, b, c, d], [e, f], &wavelengths()) else { continue };
        entered += 1;
        let (o, d) = (sent.origin.cast::<f64>(), sent.direction.cast::<f64>());
        let at = o + d * ((1.0 - o.z) / d.z);
        let outside = (-0.1 - at.x).max(-0.1 - at.y).max(at.x + at.y);
        assert!(outside * d.z.abs() < 2e-6, "{at:?}");
    }
    // Within 5 standard deviations.
    assert!((f64::from(entered) / f64::from(n) - 0.5).abs() < 2.5 / f64::from(n).sqrt());
}

/// However wide the scene and however dark or bright the sky: neither lamps nor sky starve beside the other.
#[test]
fn lamps_and_environment_share_the_draws() {
    let to = Receiver::facing(P, N);
    for (radius, value) in [(1.0, 1e-6), (1e5, 1e-6), (1.0, 1e6), (1e5, 1e6), (1e5, 0.0)] {
        let sky = EnvMap::new(Layout::LatLong, 2, 1, vec![[value; 3]; 2]).into();
        let lamp = squares()[1].light();
        let table = LightTable::new(vec![lamp], vec![sky], [Some(0)].into_iter(), (Vec3d::ZERO, radius));
        let mut rng = Rng::new(7);
        let mut lamps = [0; 2];
        for _ in 0..1000 {
            let [a, b, c, d, e, f] = [0; 6].map(|_| rng.uniform_f32() as Real);
            let drawn = table.sample(&to, [a, b, c, d], &wavelengths());
            lamps[0] += u32::from(drawn.is_some_and(|s| s.point.is_some()));
            let sent = table.sample_emission([a, b, c, d], [e, f], &wavelengths());
            lamps[1] += u32::from(sent.is_some_and(|s| s.point.is_some()));
        }
        // Half of 1000, within 5 standard deviations, or all beside what is black; no draw of the lamp is in vain.
        let (expected, within) = if value > 0.0 { (500, 80) } else { (1000, 1) };
        assert!(lamps.iter().all(|n| n.abs_diff(expected) < within), "{radius} m, {value}: {lamps:?}");
    }
}

/// A square's share of the light that is sent out is its share of the power: π · area · radiance.
#[test]
fn light_leaves_by_power() {
    let table = table(false);
    let power = squares().map(|s| 4.0 * s.half * s.half * s.radiance);
    let total: f64 = power.iter().sum();
    for (i, (s, p)) in squares().iter().zip(power).enumerate() {
        let hit = EmitterHit { object: 1 + i as u32, triangle: 0, bary: (0.2, 0.2), p: P, n: N };
        let over_area = table.pdf_emission_object(&hit, N).first as f64;
        let expected = p / total / (4.0 * s.half * s.half);
        assert!((over_area / expected - 1.0).abs() < 1e-5, "light {i}: {over_area} {expected}");
    }
}

#[test]
fn what_is_no_light_has_no_density_and_no_light() {
    let lambda = wavelengths();
    let none = || LightTable::new(vec![], vec![], [None].into_iter(), (Vec3d::ZERO, 1.0));
    let to = Receiver::facing(P, N);
    for table in [table(false), none()] {
        let hit = EmitterHit { object: 0, triangle: 0, bary: (0.2, 0.2), p: N, n: -N };
        assert!(table.emitted(&hit, -N, &lambda).is_none());
        assert_eq!(table.pdf_object(&hit, &to), 0.0);
        assert!(table.environment(N, &lambda).is_none());
        assert_eq!(table.pdf_environment(&to, N), 0.0);
    }
    assert!(none().sample(&to, [0.5; 4], &lambda).is_none());
}

/// A table whose lights are all black chooses among them all the same, and never reports a number
/// that is none; a point on the light itself gets no light from it.
#[test]
fn degenerate_lights_give_numbers() {
    let black = Square::new([0.0, 0.0, 1.0], 1.0, 0.0);
    let touching = Square::new([0.0, 0.0, 1e-20], 1.0, 1.0);
    for square in [black, touching] {
        let table = LightTable::new(vec![square.light()], vec![], [Some(0)].into_iter(), (Vec3d::ZERO, 0.0));
        let mut rng = Rng::new(6);
        for _ in 0..1000 {
            if let Some(s) = draw(&table, &mut rng) {
                assert!(s.pdf > 0.0 && s.pdf.is_finite() && s.wi.is_finite(), "{s:?}");
            }
        }
    }
}

/// The densities over all directions sum to one.
#[test]
fn the_density_is_one() {
    let (table, squares) = (table(true), squares());
    let integral = sphere(1e-4, |d| density(&table, &squares, d));
    assert!((integral.value - 1.0).abs() < 2e-3, "{integral:?}");
}

/// Light sent out by lamps and environment, and light drawn from a point where it passes: the
/// densities of the one are what the functions of the other say.
#[test]
fn emission_states_its_densities() {
    let (table, shown) = (table(true), squares());
    let mut rng = Rng::new(10);
    let (mut lamps, mut skies) = (0, 0);
    for _ in 0..5000 {
        let u = [0; 4].map(|_| rng.uniform_f32() as Real);
        let v = [0; 2].map(|_| rng.uniform_f32() as Real);
        let Some(e) = table.sample_emission(u, v, &wavelengths()) else { continue };
        assert!(e.throughput().is_finite() && e.throughput().min_lane() >= 0.0);
        let pdf = if let Some(at) = e.point {
            lamps += 1;
            let object = shown.iter().position(|q| (q.axes[2].cast() - at.n).length() < 1e-5);
            let object = 1 + object.expect("one of the squares") as u32;
            let hit = EmitterHit { object, triangle: at.triangle, bary: at.bary, p: at.p, n: at.n };
            assert_eq!(table.emitted(&hit, e.direction, &wavelengths()), Some(e.radiance));
            table.pdf_emission_object(&hit, e.direction)
        } else {
            skies += 1;
            assert_eq!(table.environment(-e.direction, &wavelengths()), Some(e.radiance));
            table.pdf_emission_environment(-e.direction, e.origin + e.direction)
        };
        assert!((pdf.first - e.pdf.first).abs() <= 1e-5 * pdf.first, "{pdf:?} {:?}", e.pdf);
        assert!((pdf.second - e.pdf.second).abs() <= 1e-4 * pdf.second, "{pdf:?} {:?}", e.pdf);
    }
    assert!(lamps > 100 && skies > 100);
}
