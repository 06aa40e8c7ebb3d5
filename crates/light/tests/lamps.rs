//! Lamps of every kind against the integral that they stand for.
//!
//! A lamp is sampled in its own two ways, and by even points and directions that know nothing of its
//! densities; flux into cells of place and direction must agree. Seeds are fixed; all comparisons of a test
//! share a false-alarm probability of 1e-4.

use indigo_formats::image::{Image, Pixels};
use indigo_light::{AreaLight, EmitterHit, LightTable, Profile, Receiver};
use indigo_math::{Real, Vec2, Vec3, Vec3d};
use indigo_spectrum::{SampledWavelengths, Spectrum, observer};
use indigo_testkit::rng::Rng;
use indigo_testkit::stats::Moments;
use indigo_testkit::ztest::{MeanTest, welch};
use indigo_texture::{Curve, Texture};
use std::f64::consts::{PI, TAU};

/// A square of side 2 in the plane z = 1 that looks down.
const CORNERS: [[[f64; 3]; 3]; 2] = [
    [[-1.0, -1.0, 1.0], [1.0, 1.0, 1.0], [1.0, -1.0, 1.0]],
    [[-1.0, -1.0, 1.0], [-1.0, 1.0, 1.0], [1.0, 1.0, 1.0]],
];

fn corners() -> [[Vec3d; 3]; 2] {
    CORNERS.map(|t| t.map(Vec3d::from))
}

/// Texture coordinates from 0 to 1 over the square.
fn uvs() -> [[Vec2<f64>; 3]; 2] {
    CORNERS.map(|t| t.map(|p| Vec2::new(0.5 * (p[0] + 1.0), 0.5 * (p[1] + 1.0))))
}

/// 5 by 4 texels, most of them dark, some coloured and one beyond 1.
fn picture() -> Texture {
    let texel = |i: usize| match i {
        3 => [4.0, 0.5, 0.1],
        7 | 12 => [0.1, 0.3, 0.9],
        18 => [0.8, 0.8, 0.8],
        _ => [0.0, 0.01, 0.0],
    };
    let values: Vec<f32> = (0..20).flat_map(texel).collect();
    let image = Image {
        width: 5,
        height: 4,
        channels: 3,
        pixels: Pixels::F32(values),
        primaries: None,
        notes: vec![],
    };
    Texture::new(std::sync::Arc::new(image), Curve { exponent: 1.0, a: 0.0, b: 1.0, c: 0.0 }, 0)
}

/// Intensities that vary with both angles; `last` is 90 or 180.
fn profile(last: f64) -> Profile {
    let vertical: Vec<f64> = (0..=12).map(|i| last * f64::from(i) / 12.0).collect();
    let horizontal = [0.0, 60.0, 120.0, 200.0, 360.0];
    let candela: Vec<f64> = horizontal
        .iter()
        .flat_map(|h: &f64| {
            vertical.iter().map(move |v| 100.0 + 2.0 * v + 80.0 * (h % 360.0).to_radians().sin())
        })
        .collect();
    Profile::new(&vertical, &horizontal, &candela)
}

fn lamps() -> Vec<(&'static str, AreaLight)> {
    let plain = || AreaLight::new(Spectrum::uniform(3e4), &corners());
    let textured = || plain().with_texture(picture(), &uvs());
    let x = Vec3d::new(0.8, 0.6, 0.0);
    vec![
        ("plain", plain()),
        ("turned over", plain().turned_over()),
        ("textured", textured()),
        ("one-sided profile", plain().with_profile(profile(90.0), x).unwrap()),
        ("two-sided profile", plain().with_profile(profile(180.0), x).unwrap()),
        ("textured profile", textured().with_profile(profile(90.0), x).unwrap()),
    ]
}

fn table(lamp: &AreaLight) -> LightTable {
    LightTable::new(vec![lamp.clone()], vec![], [Some(0)].into_iter(), (Vec3d::ZERO, 2.0))
}

fn luminance(radiance: indigo_spectrum::SampledSpectrum, lambda: &SampledWavelengths) -> f64 {
    let y = observer::xyz_weights(lambda)[1];
    radiance.0.iter().zip(y).map(|(l, y)| (l * y) as f64).sum()
}

fn random(rng: &mut Rng) -> [Real; 7] {
    [0; 7].map(|_| rng.uniform_f32() as Real)
}

/// Cells: two by two of the square, and up or down and four quarters of azimuth.
const CELLS: usize = 32;

fn cell(p: Vec3, d: Vec3) -> usize {
    let half = |v: Real| usize::from(v > 0.1);
    let quarter = ((d.y as f64).atan2(d.x as f64) / TAU * 4.0).rem_euclid(4.0) as usize;
    ((half(p.x) * 2 + half(p.y)) * 2 + usize::from(d.z > 0.0)) * 4 + quarter.min(3)
}

/// An even point of the square and an even direction, with what the lamp sends there: flux over density.
fn even(table: &LightTable, front: Real, rng: &mut Rng) -> (usize, f64) {
    let [x, y, z, phi, w, ..] = random(rng);
    let triangle = usize::from(y > x);
    let p = Vec3::new(2.0 * x - 1.0, 2.0 * y - 1.0, 1.0);
    let bary = if triangle == 0 { (y, x - y) } else { (y - x, x) };
    let z = (2.0 * z - 1.0) as f64;
    let (s, c) = (phi as f64 * TAU).sin_cos();
    let r = (1.0 - z * z).sqrt();
    let d: Vec3 = Vec3d::new(r * c, r * s, z).cast();
    let lambda = SampledWavelengths::sample(w);
    let radiance = table.emitted(&hit(triangle, bary, p, front), d, &lambda);
    let flux = radiance.map_or(0.0, |l| luminance(l, &lambda) * z.abs() * 4.0 * 4.0 * PI);
    (cell(p, d), flux)
}

/// Which way the square looks, as the geometry would tell.
fn front(name: &str) -> Real {
    if name == "turned over" { 1.0 } else { -1.0 }
}

fn hit(triangle: usize, bary: (Real, Real), p: Vec3, front: Real) -> EmitterHit {
    EmitterHit { object: 0, triangle: triangle as u32, bary, p, n: Vec3::new(0.0, 0.0, front) }
}

#[test]
fn light_is_sent_out_as_it_is_emitted() {
    let lamps = lamps();
    let level = 1e-4 / (lamps.len() * (CELLS + 1)) as f64;
    for (name, lamp) in &lamps {
        let table = table(lamp);
        let mut rng = Rng::new(20);
        let mut sums = [vec![Moments::default(); CELLS + 1], vec![Moments::default(); CELLS + 1]];
        let mut add = |which: usize, cell: Option<usize>, flux: f64| {
            (0..CELLS).for_each(|k| sums[which][k].add(if cell == Some(k) { flux } else { 0.0 }));
            sums[which][CELLS].add(flux);
        };
        for _ in 0..100_000 {
            let [a, b, c, f, d, e, w] = random(&mut rng);
            let lambda = SampledWavelengths::sample(w);
            match table.sample_emission([a, b, c, f], [d, e], &lambda) {
                Some(sent) => {
                    let point = sent.point.expect("a lamp");
                    assert!(sent.direction.dot(point.n) > 0.0);
                    add(0, Some(cell(point.p, sent.direction)), luminance(sent.throughput(), &lambda));
                }
                None => add(0, None, 0.0),
            }
        }
        for _ in 0..400_000 {
            let (cell, flux) = even(&table, front(name), &mut rng);
            add(1, Some(cell), flux);
        }
        for (k, (sent, even)) in sums[0].iter().zip(&sums[1]).enumerate() {
            let test: MeanTest = welch(sent, even, 1e-6 * lamp.flux()).at(level);
            assert!(test.passed(), "{name}, cell {k} of {CELLS}: {test}");
        }
        let stated: MeanTest =
            welch(&sums[0][CELLS], &Moments::exact(lamp.flux()), 2e-3 * lamp.flux()).at(level);
        assert!(stated.passed(), "{name}: the stated flux: {stated}");
    }
}

/// What the emission states of its densities is what the functions for a met point say.
#[test]
fn emission_states_its_densities() {
    for (name, lamp) in &lamps() {
        let table = table(lamp);
        let front = front(name);
        let mut rng = Rng::new(21);
        for _ in 0..3000 {
            let [a, b, c, f, d, e, w] = random(&mut rng);
            let lambda = SampledWavelengths::sample(w);
            let Some(sent) = table.sample_emission([a, b, c, f], [d, e], &lambda) else { continue };
            let at = sent.point.expect("a lamp");
            let met = hit(at.triangle as usize, at.bary, at.p, front);
            let pdf = table.pdf_emission_object(&met, sent.direction);
            assert!((pdf.first / sent.pdf.first - 1.0).abs() < 1e-4, "{name}");
            assert!((pdf.second / sent.pdf.second - 1.0).abs() < 1e-3, "{name}");
            let light = table.emitted(&met, sent.direction, &lambda).expect("light");
            let off = (light - sent.radiance).0.iter().fold(0.0, |m: Real, v| m.max(v.abs()));
            assert!(off <= 1e-3 * sent.radiance.max_lane(), "{name}: {light:?} {:?}", sent.radiance);
        }
    }
}

/// Light drawn towards points all round, against even points of the lamp.
#[test]
fn drawn_light_estimates_the_irradiance() {
    let receivers = [
        Receiver::all_round(Vec3::new(0.3, 0.2, 0.0)),
        Receiver::facing(Vec3::new(-2.0, 1.0, 0.5), Vec3::new(0.8, 0.0, 0.6)),
        Receiver::all_round(Vec3::new(0.5, -3.0, 2.5)),
    ];
    let lamps = lamps();
    let level = 1e-4 / (lamps.len() * receivers.len()) as f64;
    for (name, lamp) in &lamps {
        let table = table(lamp);
        let front = front(name);
        for to in &receivers {
            let mut rng = Rng::new(22);
            let drawn = Moments::of((0..60_000).map(|_| {
                let [a, b, c, f, w, ..] = random(&mut rng);
                let lambda = SampledWavelengths::sample(w);
                let Some(light) = table.sample(to, [a, b, c, f], &lambda) else { return 0.0 };
                let at = light.point.expect("a lamp");
                let met = hit(at.triangle as usize, at.bary, at.p, front);
                let stated = table.pdf_object(&met, to);
                assert!((stated / light.pdf - 1.0).abs() < 1e-3, "{name}: {stated} {}", light.pdf);
                assert!(light.wi.dot(at.n) < 0.0);
                luminance(light.radiance, &lambda) / light.pdf as f64
            }));
            let even = Moments::of((0..240_000).map(|_| {
                let [x, y, w, ..] = random(&mut rng);
                let lambda = SampledWavelengths::sample(w);
                let triangle = usize::from(y > x);
                let p = Vec3::new(2.0 * x - 1.0, 2.0 * y - 1.0, 1.0);
                let bary = if triangle == 0 { (y, x - y) } else { (y - x, x) };
                let way = to.p - p;
                let d = way.normalized();
                let light = table.emitted(&hit(triangle, bary, p, front), d, &lambda);
                let geometry = (4.0 * d.z.abs() / way.length2()) as f64;
                light.map_or(0.0, |l| luminance(l, &lambda) * geometry)
            }));
            let test: MeanTest = welch(&drawn, &even, 1e-6 * even.mean().abs()).at(level);
            assert!(test.passed(), "{name}, {to:?}: {test}");
        }
    }
}

/// The flux on a box is that of the lamp, whatever its texture: to a thousandth.
#[test]
fn a_textured_lamp_can_be_scaled_to_a_flux() {
    let lamp = AreaLight::new(Spectrum::blackbody(2700.0, 1.0), &corners())
        .with_texture(picture(), &uvs())
        .with_flux(1750.0)
        .unwrap();
    let table = table(&lamp);
    let mut rng = Rng::new(23);
    let sent = Moments::of((0..400_000).map(|_| {
        let [a, b, c, f, d, e, w] = random(&mut rng);
        let lambda = SampledWavelengths::sample(w);
        let sent = table.sample_emission([a, b, c, f], [d, e], &lambda);
        sent.map_or(0.0, |s| luminance(s.throughput(), &lambda))
    }));
    let test: MeanTest = welch(&sent, &Moments::exact(1750.0), 1e-3 * 1750.0).at(1e-4);
    assert!(test.passed() && test.std_error < 2e-3 * 1750.0, "{test}");
}

/// A square of side 2 in so many columns and rows of two triangles each, with its texture coordinates.
fn quilt(n: u32) -> (Vec<[Vec3d; 3]>, Vec<[Vec2<f64>; 3]>) {
    let corner = |k: u32| f64::from(k) / f64::from(n);
    let faces = (0..n * n).flat_map(|i| {
        let [u0, u1, v0, v1] = [i % n, i % n + 1, i / n, i / n + 1].map(corner);
        [[[u0, v0], [u1, v1], [u1, v0]], [[u0, v0], [u0, v1], [u1, v1]]]
    });
    let faces: Vec<[[f64; 2]; 3]> = faces.collect();
    let place = |[u, v]: [f64; 2]| Vec3d::new(2.0 * u - 1.0, 2.0 * v - 1.0, 1.0);
    (faces.iter().map(|f| f.map(place)).collect(), faces.iter().map(|f| f.map(Vec2::from)).collect())
}

/// Maps finer than the grids that draw points: stripes, and a matrix of diodes, have the flux of their texels' mean;
/// the matrix also in very many repeats, and on 100,000 triangles that see more than all of it each.
#[test]
fn fine_textures_have_the_flux_of_their_texels() {
    const SIDE: usize = 1024;
    const DIODES: &str = "every eighth texel each way";
    type IsLit = fn(usize, usize) -> bool;
    let patterns: [(&str, IsLit, f64); 4] = [
        ("every fourth column", |x, _| x % 4 == 0, 0.25),
        ("the columns beside them", |x, _| x % 4 == 1, 0.25),
        (DIODES, |x, y| x % 8 == 0 && y % 8 == 0, 1.0 / 64.0),
        ("one row", |_, y| y == 300, 1.0 / 1024.0),
    ];
    for (name, is_lit, part) in patterns {
        let texels = (0..SIDE * SIDE).map(|i| if is_lit(i % SIDE, i / SIDE) { 255 } else { 0 }).collect();
        let image = Image {
            width: 1024,
            height: 1024,
            channels: 1,
            pixels: Pixels::U8(texels),
            primaries: None,
            notes: vec![],
        };
        let texture = Texture::new(std::sync::Arc::new(image), Curve::IDENTITY, 0);
        let mut cases = vec![(1, 1.0), (32, 1.0)];
        if name == DIODES {
            cases.extend([(1, 20_000.3), (224, 224.0 * 1.3)]);
        }
        for (n, repeats) in cases {
            let (corners, uvs) = quilt(n);
            let uvs: Vec<_> = uvs.iter().map(|t| t.map(|p| p * repeats)).collect();
            let plain = AreaLight::new(Spectrum::blackbody(2700.0, 1.0), &corners);
            let flux = plain.flux();
            let found = plain.with_texture(texture.clone(), &uvs).flux() / flux;
            assert!(
                (found / part - 1.0).abs() < 1e-4,
                "{name}, {n} columns, {repeats} repeats: {found} instead of {part}"
            );
        }
    }
}

/// Points follow the texture: hardly any fall on the dark part.
#[test]
fn points_follow_the_texture() {
    let lamp = AreaLight::new(Spectrum::uniform(1.0), &corners()).with_texture(picture(), &uvs());
    let table = table(&lamp);
    let mut rng = Rng::new(24);
    let mut weights = Moments::default();
    let mut evenly = Moments::default();
    for _ in 0..20_000 {
        let [a, b, c, f, d, e, w] = random(&mut rng);
        let sent = table.sample_emission([a, b, c, f], [d, e], &SampledWavelengths::sample(w));
        weights.add(sent.map_or(0.0, |s| s.throughput().mean() as f64));
        evenly.add(even(&table, -1.0, &mut rng).1);
    }
    let relative = |m: &Moments| m.variance() / (m.mean() * m.mean());
    assert!(relative(&weights) < 0.2 * relative(&evenly), "{} {}", relative(&weights), relative(&evenly));
}
