//! Laws that every scattering model keeps, over all that are registered.
//!
//! Each kind of material takes part with the example of its own declaration and with the parameter
//! sets of [`EXAMPLES`]. Models are judged as integrators see them, through [`ShadingPoint`], from
//! several angles and under shading normals that lean.
//!
//! The chi-square tests share a false-alarm probability of 1e-4.

mod common;

use common::{Case, all_examples, cases, delta_examples, examples};
use indigo_math::{Real, Vec3};
use indigo_scatter::materials::KINDS;
use indigo_scatter::{Mode, ShadingPoint};
use indigo_spectrum::LANES;
use indigo_testkit::chi2::{Chi2, Domain};
use indigo_testkit::quadrature::sphere;
use indigo_testkit::rng::Rng;
use indigo_testkit::stats::Moments;
use indigo_testkit::ztest::welch;

/// Relative rounding of a handful of single-precision operations.
const ROUNDING: Real = 2e-5;

fn vec(d: [f64; 3]) -> Vec3 {
    Vec3::new(d[0] as Real, d[1] as Real, d[2] as Real)
}

fn array(d: Vec3) -> [f64; 3] {
    d.to_array().map(|x| x as f64)
}

fn random(rng: &mut Rng) -> [Real; 3] {
    [0; 3].map(|_| rng.uniform_f32() as Real)
}

/// A direction evenly over the sphere.
fn random_direction(rng: &mut Rng) -> Vec3 {
    let (z, phi) = (2.0 * rng.uniform() - 1.0, std::f64::consts::TAU * rng.uniform());
    let r = (1.0 - z * z).sqrt();
    vec([r * phi.cos(), r * phi.sin(), z])
}

/// Says that two values of a model are equal but for rounding, which its `sharpness` enlarges.
#[track_caller]
fn assert_close(what: &str, sharpness: Real, a: Real, b: Real) {
    let tolerance = ROUNDING * sharpness;
    assert!((a - b).abs() <= tolerance * a.abs().max(b.abs()) + 1e-7, "{what}: {a} and {b}");
}

/// A kind that is registered is under these laws or those of `delta.rs`; `blend` and `null_material` have no model.
#[test]
fn every_registered_kind_takes_part() {
    let names: Vec<&str> = examples().iter().chain(&delta_examples()).map(|e| e.kind).collect();
    for kind in KINDS {
        let has_model = !matches!(kind.name, "blend" | "null_material");
        assert_eq!(names.contains(&kind.name), has_model, "{}", kind.name);
    }
}

/// The cases whose lobes a quadrature over the sphere can find and sum up in passable time. The others are under
/// the other laws, and furnaces show their albedo.
fn broad_cases() -> Vec<Case> {
    cases().into_iter().filter(|case| case.sharpness < 50.0).collect()
}

#[test]
fn directions_follow_the_density() {
    let cases = broad_cases();
    for (seed, case) in cases.iter().enumerate() {
        let point = case.point();
        let test =
            Chi2 { samples: 20_000, seed: seed as u64, ..Chi2::new(Domain::Sphere).among(cases.len()) };
        let result = test.run(
            |rng| point.sample(random(rng), Mode::Radiance).map(|s| array(s.wi)),
            |wi| point.eval(vec(wi), Mode::Radiance).pdf.hero() as f64,
        );
        assert!(result.passed(), "{case}: {result}");
    }
}

#[test]
fn a_draw_says_what_evaluation_says() {
    for case in cases() {
        let point = case.point();
        let mut rng = Rng::new(7);
        for _ in 0..300 {
            for mode in [Mode::Radiance, Mode::Importance] {
                let Some(drawn) = point.sample(random(&mut rng), mode) else { continue };
                let evaluated = point.eval(drawn.wi, mode);
                for lane in 0..LANES {
                    let what = |name| format!("{case}, {mode:?}, {name}, lane {lane}");
                    let weight = evaluated.f_cos[lane] / evaluated.pdf.hero();
                    assert_close(&what("weight"), case.sharpness, drawn.weight[lane], weight);
                    assert_close(&what("pdf"), case.sharpness, drawn.pdf[lane], evaluated.pdf[lane]);
                    assert_close(
                        &what("reverse pdf"),
                        case.sharpness,
                        drawn.pdf_rev[lane],
                        evaluated.pdf_rev[lane],
                    );
                }
            }
        }
    }
}

/// The reverse density is the density of the same event seen from its other end.
#[test]
fn the_reverse_density_is_that_of_the_exchanged_directions() {
    for case in cases() {
        let mut rng = Rng::new(8);
        for _ in 0..500 {
            let wi = random_direction(&mut rng);
            let there = case.point().eval(wi, Mode::Radiance);
            let back = case.from(wi).eval(case.wo, Mode::Importance);
            for lane in 0..LANES {
                assert_close(
                    &format!("{case}, reverse"),
                    case.sharpness,
                    there.pdf_rev[lane],
                    back.pdf[lane],
                );
                assert_close(
                    &format!("{case}, forward"),
                    case.sharpness,
                    there.pdf[lane],
                    back.pdf_rev[lane],
                );
            }
        }
    }
}

/// Light that goes from `wi` to `wo` is the same whichever end the path was begun at: radiance over
/// the projected solid angle of one end is importance over that of the other (Veach 1997, section
/// 5.3.2), under any shading normal. Without a leaning normal this is Helmholtz reciprocity.
#[test]
fn both_modes_are_adjoint() {
    for case in cases() {
        let mut rng = Rng::new(9);
        let mut lit = 0;
        for _ in 0..2000 {
            let wi = random_direction(&mut rng);
            let there = case.point().eval(wi, Mode::Radiance).f_cos / wi.dot(case.n_g).abs();
            let back = case.from(wi).eval(case.wo, Mode::Importance).f_cos / case.wo.dot(case.n_g);
            lit += u32::from(!there.is_black());
            for lane in 0..LANES {
                assert_close(
                    &format!("{case}, wi {wi:?}, lane {lane}"),
                    case.sharpness,
                    there[lane],
                    back[lane],
                );
            }
        }
        assert!(lit > 0 || case.is_black, "{case} scatters nothing");
    }
}

/// What is scattered is no more than what arrives, and the mean weight of draws is just that.
#[test]
fn albedo_is_at_most_one_and_weights_average_to_it() {
    for case in broad_cases() {
        let point = case.point();
        let albedo =
            sphere(1e-4, |wi| case.power(vec(wi)) * point.eval(vec(wi), Mode::Radiance).f_cos.hero() as f64)
                .value;
        assert!(albedo <= 1.0 + 1e-4, "{case}: albedo {albedo}");
        let mut rng = Rng::new(10);
        // Where nothing is drawn nothing is scattered.
        let weights = Moments::of((0..40_000).map(|_| {
            let drawn = point.sample(random(&mut rng), Mode::Radiance);
            drawn.map_or(0.0, |s| case.power(s.wi) * s.weight.hero() as f64)
        }));
        // 1e-4 is what the quadrature and single precision leave; one alarm of 1e-4 among all cases.
        let test = welch(&weights, &Moments::exact(albedo), 1e-4).at(1e-6);
        assert!(test.passed(), "{case}: {test}");
    }
}

/// No light is scattered that is less than none, as fits of functions give along the surface.
#[test]
fn no_value_is_negative() {
    for case in cases() {
        let mut rng = Rng::new(11);
        for _ in 0..3000 {
            let flattened = |rng: &mut Rng| {
                let d = random_direction(rng);
                Vec3::new(d.x, d.y, d.z * rng.uniform_f32() as Real).normalized()
            };
            let (wo, wi) = (flattened(&mut rng), flattened(&mut rng));
            let e = case.from(wo).eval(wi, Mode::Radiance);
            let least = e.f_cos.min_lane().min(e.pdf.min_lane()).min(e.pdf_rev.min_lane());
            assert!(least >= 0.0, "{case}: {e:?} from {wi:?} to {wo:?}");
        }
    }
}

/// The value in a lane depends on that lane's wavelength alone.
#[test]
fn lanes_do_not_see_each_other() {
    for example in examples() {
        let lambda = common::wavelengths(0.3);
        let mut others = common::wavelengths(0.77);
        others.lambda[LANES - 1] = lambda.lambda[LANES - 1];
        others.pdf[LANES - 1] = lambda.pdf[LANES - 1];
        let (a, b) = (example.leaf(&lambda), example.leaf(&others));
        let mut rng = Rng::new(12);
        for _ in 0..200 {
            let (wo, wi) = (random_direction(&mut rng), random_direction(&mut rng));
            let n = Vec3::new(0.0, 0.0, 1.0);
            let evaluate = |leaf| ShadingPoint::new(leaf, n, n, wo).eval(wi, Mode::Radiance);
            let (a, b) = (evaluate(a), evaluate(b));
            let last = LANES - 1;
            assert_eq!(a.f_cos[last], b.f_cos[last], "{}", example.kind);
            assert_eq!(a.pdf[last], b.pdf[last], "{}", example.kind);
        }
    }
}

/// Directions in the plane, along the normal, and opposite ones: whatever comes out is a number, and
/// none is negative.
#[test]
fn degenerate_directions_give_numbers() {
    let n = Vec3::new(0.0, 0.0, 1.0);
    let tiny = 1e-20 as Real;
    let directions = [
        n,
        -n,
        Vec3::new(1.0, 0.0, 0.0),
        Vec3::new(-1.0, 0.0, tiny),
        Vec3::new(0.0, 1.0, -tiny),
        Vec3::new(0.6, 0.0, 0.8),
        Vec3::new(0.0, -1.0, 1e-4),
    ];
    let normals = [n, Vec3::new(0.6, 0.0, 0.8), Vec3::new(0.0, -1.0, 1e-6).normalized()];
    let corners: [[Real; 3]; 4] = [[0.0; 3], [0.999_999_94; 3], [0.5, 0.0, 0.999_999_94], [0.0, 0.5, 0.5]];
    for example in all_examples() {
        let leaf = example.leaf(&common::wavelengths(0.5));
        for (wo, n_s) in directions.iter().flat_map(|d| normals.map(|n_s| (*d, n_s))) {
            let point = ShadingPoint::new(leaf, n, n_s, wo);
            for mode in [Mode::Radiance, Mode::Importance] {
                for wi in directions {
                    let e = point.eval(wi, mode);
                    let finite = e.f_cos.is_finite() && e.pdf.is_finite() && e.pdf_rev.is_finite();
                    let positive =
                        e.f_cos.min_lane() >= 0.0 && e.pdf.min_lane() >= 0.0 && e.pdf_rev.min_lane() >= 0.0;
                    assert!(finite && positive, "{}: {wo:?} {wi:?} {n_s:?} {e:?}", example.kind);
                }
                for s in corners.iter().filter_map(|u| point.sample(*u, mode)) {
                    let sound = s.weight.is_finite() && s.weight.min_lane() >= 0.0 && s.pdf.hero() > 0.0;
                    let unit = (s.wi.length() - 1.0).abs() < 1e-5;
                    assert!(sound && unit && s.pdf.is_finite(), "{}: {wo:?} {n_s:?} {s:?}", example.kind);
                }
            }
        }
    }
}

/// The plain diffuse model has the albedo of its spectrum from everywhere.
#[test]
fn diffuse_scatters_its_albedo() {
    let grey =
        examples().into_iter().find(|e| e.text.contains("<value>0.37</value>")).expect("among the examples");
    for case in cases().iter().filter(|c: &&Case| c.kind == grey.kind && c.text == grey.text && c.tilt == 0.0)
    {
        let point = case.point();
        let albedo = sphere(1e-5, |wi| point.eval(vec(wi), Mode::Radiance).f_cos.hero() as f64).value;
        assert!((albedo - 0.37).abs() < 1e-4, "{case}: {albedo}");
    }
}
