//! Lamps as a scene gives them: photometric files and image maps, and (in `faults`) what is wrong with them.

mod faults;

use indigo_decl::{ResolveError, Resolved, Resolver};
use indigo_light::{LightTable, Receiver};
use indigo_math::{Real, Vec3, Vec3d};
use indigo_scene::{LoadOptions, Loaded, load};
use indigo_spectrum::{SampledWavelengths, observer};
use indigo_testkit::rng::Rng;
use indigo_testkit::stats::Moments;
use indigo_testkit::ztest::{MeanTest, welch};
use std::f64::consts::{PI, TAU};

/// A scene, and the lamps of the test scenes beside it.
struct Memory(String);

impl Resolver for Memory {
    fn read(&self, path: &str, _from: &str) -> Result<Resolved, ResolveError> {
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../testscenes/ies/");
        let bytes = match path {
            "scene.igs" => self.0.clone().into_bytes(),
            "half.bmp" => bmp([0, 255]),
            "grey.bmp" => bmp([153; 2]),
            "beside.ies" => lambert("TILT=NONE", "TILT=lamp.tlt"),
            "left_over.ies" => lambert("TILT=NONE", "TILT=NONE\n1"),
            _ => std::fs::read(format!("{folder}{path}"))
                .map_err(|_| ResolveError::NotFound { looked: vec![path.to_owned()] })?,
        };
        Ok(Resolved { path: path.to_owned(), bytes: bytes.into() })
    }
}

/// A file of the test scenes with something changed.
fn lambert(from: &str, to: &str) -> Vec<u8> {
    let file = include_str!("../../../../testscenes/ies/lambert_1000cd.ies");
    assert!(file.contains(from));
    file.replacen(from, to, 1).into_bytes()
}

/// Two grey texels side by side.
fn bmp([left, right]: [u8; 2]) -> Vec<u8> {
    let mut bytes = b"BM".to_vec();
    for word in [62_u32, 0, 54, 40, 2, 1] {
        bytes.extend(word.to_le_bytes());
    }
    bytes.extend([1, 0, 24, 0]);
    for word in [0_u32, 8, 0, 0, 0, 0] {
        bytes.extend(word.to_le_bytes());
    }
    bytes.extend([left, left, left, right, right, right, 0, 0]);
    bytes
}

/// A square of 20 cm by 20 cm 2 m over the camera, which shines down on it.
fn text(more: &str) -> String {
    let head = "<scene><renderer_settings><aperture_diffraction>false</aperture_diffraction><bidirectional>false</bidirectional><metropolis>false</metropolis></renderer_settings>
<tonemapping><linear><scale>1</scale></linear></tonemapping>
<camera><pos>0 0 0</pos><up>0 0 1</up><forwards>0 1 0</forwards><aperture_radius>0.001</aperture_radius><focus_distance>3</focus_distance><aspect_ratio>1.3333</aspect_ratio><sensor_width>0.036</sensor_width><lens_sensor_dist>0.02</lens_sensor_dist></camera>
<material><name>black</name><diffuse><albedo_spectrum><uniform><value>0</value></uniform></albedo_spectrum></diffuse></material>
<mesh><name>square</name><embedded><expose_uv_set><name>default</name><index>0</index></expose_uv_set><expose_uv_set><name>bright</name><index>1</index></expose_uv_set>";
    let corners = [[-1, -1], [-1, 1], [1, 1], [1, -1]];
    let vertices = corners
        .iter()
        .map(|[x, y]| {
            format!(
                "<vertex pos=\"{x} {y} 0\" uv0=\"{} {}\" uv1=\"0.5 0\"/>",
                f64::from(x + 1) / 2.0,
                f64::from(y + 1) / 2.0
            )
        })
        .collect::<Vec<String>>()
        .concat();
    format!(
        "{head}{vertices}<triangle_set><material_name>black</material_name><tri>0 1 2</tri><tri>0 2 3</tri></triangle_set></embedded></mesh>
<meshlight><pos>0 0 2</pos><scale>0.1</scale><mesh_name>square</mesh_name><spectrum><blackbody><temperature>3000</temperature><gain>1</gain></blackbody></spectrum>{more}</meshlight></scene>"
    )
}

/// The lamp under a linear transformation.
fn transformed(matrix: &str, more: &str) -> String {
    let rotation = format!("<scale>0.1</scale><rotation><matrix>{matrix}</matrix></rotation>");
    text(more).replace("<scale>0.1</scale>", &rotation)
}

/// A rectangle lamp in place of the mesh.
fn rectangle(width: f64, height: f64, more: &str) -> String {
    let all = text("");
    let (before, _) = all.split_once("<material>").expect("the parts of a scene");
    format!(
        "{before}<rectanglelight><pos>0 0 2</pos><width>{width}</width><height>{height}</height><spectrum><blackbody><temperature>3000</temperature><gain>1</gain></blackbody></spectrum>{more}</rectanglelight></scene>"
    )
}

fn loaded(text: &str) -> Loaded {
    let resolver = Memory(text.to_owned());
    load("scene.igs", &LoadOptions::new(&resolver))
}

#[track_caller]
fn lights(more: &str) -> LightTable {
    lights_of(&text(more))
}

#[track_caller]
fn lights_of(text: &str) -> LightTable {
    let l = loaded(text);
    assert!(
        !l.sink.has_errors(),
        "{:?}",
        l.sink.diagnostics().iter().map(|d| &d.message).collect::<Vec<_>>()
    );
    l.scene.expect("a scene").lights
}

fn profile(file: &str) -> String {
    format!("<ies_profile><path>{file}</path></ies_profile>")
}

fn luminance(radiance: indigo_spectrum::SampledSpectrum, lambda: &SampledWavelengths) -> f64 {
    let y = observer::xyz_weights(lambda)[1];
    radiance.0.iter().zip(y).map(|(l, y)| (l * y) as f64).sum()
}

/// Illuminance at a point across its direction from the lamp, estimated by drawn light.
fn illuminance(lights: &LightTable, p: Vec3d, samples: u32, rng: &mut Rng) -> Moments {
    let to_lamp = (Vec3d::new(0.0, 0.0, 2.0) - p).normalized();
    let to = Receiver::all_round(p.cast());
    Moments::of((0..samples).map(|_| {
        let [a, b, c, f, w] = [0; 5].map(|_| rng.uniform_f32() as Real);
        let lambda = SampledWavelengths::sample(w);
        let Some(light) = lights.sample(&to, [a, b, c, f], &lambda) else { return 0.0 };
        let cos = light.wi.dot(to_lamp.cast::<Real>()) as f64;
        luminance(light.radiance, &lambda) * cos / light.pdf as f64
    }))
}

/// Batches, points or emissions in each, and wavelengths for each; their spread must tell 0.1 %.
const BATCHES: u32 = 48;
const BATCH: u32 = 8192;
const WAVELENGTHS: u32 = 4;

/// The means of batches: each takes a lattice of even numbers, moved by random ones, so that it has the right
/// expectation by itself (Cranley & Patterson 1976). The steps are those of Roberts (2018) for two dimensions.
fn batches(rng: &mut Rng, mut value: impl FnMut([f64; 2], [Real; 4], &SampledWavelengths) -> f64) -> Moments {
    const STEPS: [f64; 2] = [0.754_877_666_246_692_7, 0.569_840_290_998_053_2];
    Moments::of((0..BATCHES).map(|_| {
        let start = [0; 2].map(|_| rng.uniform());
        let mut sum = 0.0;
        for i in 0..BATCH {
            let lattice = std::array::from_fn(|k| (start[k] + f64::from(i) * STEPS[k]).fract());
            let (u, w) = ([0; 4].map(|_| rng.uniform_f32() as Real), rng.uniform());
            for k in 0..WAVELENGTHS {
                let even = (f64::from(k) + w) / f64::from(WAVELENGTHS);
                sum += value(lattice, u, &SampledWavelengths::sample(even as Real));
            }
        }
        sum / f64::from(BATCH * WAVELENGTHS)
    }))
}

/// Lumens that fall on a sphere of 10 m round the lamp, whatever its extent.
fn lumens(lights: &LightTable, rng: &mut Rng) -> Moments {
    let radius = 10.0;
    batches(rng, |[t, turn], u, lambda| {
        // Heights 2t² above the lowest point, more of them where narrow lamps shine: dz = 4t dt over a range of 2.
        let (z, turn, weight) = (2.0 * t * t - 1.0, turn * TAU, 2.0 * t);
        let r = (1.0 - z * z).sqrt();
        let outwards = Vec3d::new(r * turn.cos(), r * turn.sin(), z);
        let p = outwards * radius + Vec3d::new(0.0, 0.0, 2.0);
        let Some(light) = lights.sample(&Receiver::all_round(p.cast()), u, lambda) else { return 0.0 };
        let cos = -light.wi.dot(outwards.cast::<Real>()) as f64;
        luminance(light.radiance, lambda) * cos / light.pdf as f64 * weight * 4.0 * PI * radius * radius
    })
}

/// Lumens that the lamp sends out.
fn sent(lights: &LightTable, rng: &mut Rng) -> Moments {
    batches(rng, |[a, b], u, lambda| {
        let sent = lights.sample_emission(u, [a as Real, b as Real], lambda);
        sent.map_or(0.0, |s| luminance(s.throughput(), lambda))
    })
}

/// Lumens of each file by the integral of what it tabulates, and power times efficacy: to 0.1 %, on a sphere
/// round the lamp and by what it sends out. A deviation of 0.1 % is four standard errors; false-alarm probability
/// 1e-4 in all.
#[test]
fn lamps_have_their_lumens() {
    let efficacy = "<efficacy_scale><power_drawn>100</power_drawn><overall_luminous_efficacy>17.5</overall_luminous_efficacy></efficacy_scale>";
    let map = "<texture><path>half.bmp</path><exponent>1</exponent></texture>";
    let cases = [
        (profile("lambert_1000cd.ies"), 3141.09413),
        (profile("uniform_hemisphere_500cd.ies"), 3141.592654),
        (profile("spot_cos8_2000cd.ies"), 2020.78932),
        (profile("quadrant_bat.ies"), 2511.677934),
        (profile("bilateral_0_180.ies"), 2511.677934),
        (profile("full_0_360.ies"), 2511.677934),
        (profile("tilt_include.ies"), 3139.597418),
        (profile("irregular_angles.ies"), 3122.020384),
        (format!("{map}{}", profile("quadrant_bat.ies")), 2511.677934),
        (efficacy.to_owned(), 1750.0),
        (format!("{map}{efficacy}"), 1750.0),
    ];
    // Stretched, sheared and mirrored; rectangles of any aspect; and both spellings.
    let misspelt = efficacy.replace("efficacy", "efficiacy");
    assert!(misspelt.contains("<efficiacy_scale>") && misspelt.contains("<overall_luminous_efficiacy>"));
    let (sheared, mirrored) = ("3 0.5 0 0 0.4 0 0 0 1", "0 2 0 1.5 0 0 0 0 1");
    let shapes = [
        (transformed(sheared, efficacy), 1750.0),
        (transformed(sheared, &format!("{map}{efficacy}")), 1750.0),
        (transformed(sheared, &profile("quadrant_bat.ies")), 2511.677934),
        (transformed(mirrored, &misspelt), 1750.0),
        (transformed(mirrored, &profile("full_0_360.ies")), 2511.677934),
        (rectangle(0.2, 0.2, &misspelt), 1750.0),
        (rectangle(2.0, 0.05, efficacy), 1750.0),
        (rectangle(0.01, 1.5, efficacy), 1750.0),
    ];
    let cases: Vec<(String, f64)> =
        cases.map(|(more, lumens)| (text(&more), lumens)).into_iter().chain(shapes).collect();
    let level = 1e-4 / (2 * cases.len()) as f64;
    for (more, expected) in cases {
        let lights = lights_of(&more);
        let mut rng = Rng::new(31);
        for (what, found) in [("on a sphere", lumens(&lights, &mut rng)), ("sent", sent(&lights, &mut rng))] {
            let test: MeanTest = welch(&found, &Moments::exact(expected), 0.0).at(level);
            let error = found.std_error() / expected;
            assert!(test.passed() && error < 2.5e-4, "{more}, {what}: {test}, relative error {error:.1e}");
        }
    }
}

/// Candelas at ten directions, from the illuminance 20 m away: I = E d². Intensities are those that the files
/// tabulate: (800 + 400 cos 2φ) cos θ for the first, which is mirrored in both planes.
#[test]
fn a_lamp_has_the_candelas_of_its_file() {
    let lights = lights(&profile("quadrant_bat.ies"));
    let mut rng = Rng::new(32);
    for (theta, phi) in [
        (8.0, 20.0),
        (10.0, 0.0),
        (25.0, 0.0),
        (40.0, 90.0),
        (40.0, 180.0),
        (55.0, 45.0),
        (55.0, 135.0),
        (55.0, 225.0),
        (70.0, 315.0),
        (70.0, 270.0),
    ] {
        let (theta, phi): (f64, f64) = (theta, phi);
        let (s, c) = theta.to_radians().sin_cos();
        let (sp, cp) = phi.to_radians().sin_cos();
        // Down is the axis, and from above horizontal angles run counter-clockwise.
        let d = Vec3d::new(s * cp, s * sp, -c);
        let e = illuminance(&lights, d * 20.0 + Vec3d::new(0.0, 0.0, 2.0), 4000, &mut rng);
        let expected = quadrant_bat(theta, phi);
        let found = Moments::from_parts(e.count(), e.mean() * 400.0, e.variance() * 400.0 * 400.0);
        let test: MeanTest = welch(&found, &Moments::exact(expected), 2e-3 * expected).at(1e-5);
        assert!(test.passed() && test.std_error < 0.01 * expected, "{theta} {phi}: {test}");
    }
}

/// The file's table, linear in both angles, read here anew.
fn quadrant_bat(theta: f64, phi: f64) -> f64 {
    let file = include_str!("../../../../testscenes/ies/quadrant_bat.ies");
    let (_, numbers) = file.split_once("TILT=NONE").expect("a header");
    let v: Vec<f64> = numbers.split_whitespace().map(|w| w.parse().expect("a number")).collect();
    let (n, m) = (v[3] as usize, v[4] as usize);
    let (vertical, horizontal, candela) = (&v[13..13 + n], &v[13 + n..13 + n + m], &v[13 + n + m..]);
    let folded = if phi > 180.0 { 360.0 - phi } else { phi };
    let folded = if folded > 90.0 { 180.0 - folded } else { folded };
    let place = |list: &[f64], x: f64| {
        let i = (1..list.len() - 1).find(|&i| list[i] > x).unwrap_or(list.len() - 1) - 1;
        (i, (x - list[i]) / (list[i + 1] - list[i]))
    };
    let ((i, s), (j, t)) = (place(vertical, theta), place(horizontal, folded));
    let along = |j: usize| candela[j * n + i] * (1.0 - s) + candela[j * n + i + 1] * s;
    (along(j) * (1.0 - t) + along(j + 1) * t) * v[2] * v[10] * v[11]
}

/// The map's dark half does not shine, its bright half does, and its exponent, its factors and its uv set count.
#[test]
fn a_texture_modulates_the_lamp() {
    let map = |more: &str| format!("<texture><path>half.bmp</path>{more}</texture>");
    let sent = |more: &str| {
        let lights = lights(more);
        let mut rng = Rng::new(33);
        let mut sides = [0.0; 2];
        for _ in 0..40_000 {
            let [a, b, c, f, d, e, w] = [0; 7].map(|_| rng.uniform_f32() as Real);
            let lambda = SampledWavelengths::sample(w);
            if let Some(sent) = lights.sample_emission([a, b, c, f], [d, e], &lambda) {
                let p: Vec3 = sent.origin;
                sides[usize::from(p.x > 0.0)] += luminance(sent.throughput(), &lambda) / 4e4;
            }
        }
        sides
    };
    let ([plain, _], [dark, bright]) = (sent(""), sent(&map("<exponent>1</exponent>")));
    // Bilinear and wrapped round: dark at the left edge, bright in the middle, so both halves are ramps.
    assert!(
        (bright / plain - 0.5).abs() < 0.02 && (dark / plain - 0.5).abs() < 0.02,
        "{plain} {dark} {bright}"
    );
    let [_, doubled] = sent(&map("<exponent>1</exponent><b>2</b>"));
    assert!((doubled / bright - 2.0).abs() < 0.03, "{doubled} {bright}");
    let [_, lifted] = sent(&map("<exponent>1</exponent><b>0</b><c>0.25</c>"));
    assert!((lifted / plain - 0.25).abs() < 0.01, "{lifted} {plain}");
    let grey = |more: &str| sent(&format!("<texture><path>grey.bmp</path>{more}</texture>"))[1] / plain;
    let part =
        |more: &str, expected: f64| assert!((grey(more) - expected).abs() < 0.01, "{more}: {expected}");
    part("", 0.6f64.powf(2.2));
    part("<exponent>1</exponent>", 0.6);
    part("<exponent>1</exponent><a>2</a><b>0.1</b>", 2.0 * 0.36 + 0.06);
    // The second set lies on the bright texel altogether.
    let [left, right] = sent(&map("<uv_set>bright</uv_set>"));
    let whole = (left / plain, right / plain);
    assert!((whole.0 - 1.0).abs() < 0.02 && (whole.1 - 1.0).abs() < 0.02, "{whole:?}");
}
