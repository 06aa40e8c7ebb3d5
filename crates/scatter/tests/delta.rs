//! Laws that every scattering model of delta kind keeps, over all that are registered: those of `laws.rs`, with
//! probabilities in place of densities.

mod common;

use common::{Case, delta_cases, delta_examples, wavelengths};
use indigo_math::{Real, Vec3};
use indigo_scatter::{Mode, Scattered, ShadingPoint};
use indigo_spectrum::LANES;

/// Relative rounding of a handful of single-precision operations, near grazing angles and the critical one.
const ROUNDING: Real = 2e-4;
/// Draws at equal steps of the number that chooses the event, which is all that a draw depends on.
const STEPS: u32 = 1000;

fn draws(point: &ShadingPoint, mode: Mode) -> Vec<Scattered> {
    (0..STEPS)
        .map(|i| (i as Real + 0.5) / STEPS as Real)
        .filter_map(|u| point.sample([0.3, 0.6, u], mode))
        .inspect(|drawn| assert!(drawn.is_delta))
        .collect()
}

/// The events of a point: a draw of each.
fn events(point: &ShadingPoint, mode: Mode) -> Vec<Scattered> {
    let mut events = draws(point, mode);
    events.dedup_by_key(|drawn| drawn.is_transmitted);
    events
}

#[track_caller]
fn assert_close(what: &str, a: Real, b: Real) {
    assert!((a - b).abs() <= ROUNDING * a.abs().max(b.abs()) + 1e-6, "{what}: {a} and {b}");
}

#[test]
fn events_are_drawn_with_their_probabilities() {
    for case in delta_cases() {
        let draws = draws(&case.point(), Mode::Radiance);
        for event in events(&case.point(), Mode::Radiance) {
            let drawn = draws.iter().filter(|d| d.is_transmitted == event.is_transmitted).count();
            let share = drawn as Real / STEPS as Real;
            assert!((share - event.pdf.hero()).abs() < 1.5 / STEPS as Real, "{case}: {share}, {event:?}");
        }
    }
}

/// What is scattered is no more than what arrives, and all of it where light can go through.
#[test]
fn albedo_is_at_most_one() {
    for case in delta_cases() {
        let draws = draws(&case.point(), Mode::Radiance);
        let powers = draws.iter().map(|d| case.power(d.wi) * d.weight.hero() as f64);
        let albedo = powers.sum::<f64>() / f64::from(STEPS);
        assert!(albedo > 0.0 && albedo < 1.001, "{case}: albedo {albedo}");
        let is_lossless = !case.text.contains("<transparent>false");
        assert!(!is_lossless || albedo > 0.999, "{case}: albedo {albedo}");
    }
}

/// An event seen from its other end has the probability that was said to be the reverse, and carries the same light: by
/// the law of the connectable models, where dω η² |ω·ns| is the same at both ends of an event.
#[test]
fn events_have_their_adjoint() {
    let mut checked = 0;
    for case in delta_cases() {
        for there in events(&case.point(), Mode::Radiance) {
            // Where an end was moved to the right side of the surface it does not lead back.
            if there.pdf_rev.hero() == 0.0 {
                continue;
            }
            let back = events(&case.from(there.wi), Mode::Importance)
                .into_iter()
                .find(|back| (back.wi - case.wo).length() < 1e-3)
                .unwrap_or_else(|| panic!("{case}: {there:?} does not lead back"));
            checked += 1;
            let cosines = |d: Vec3| (d.dot(case.n_s).abs(), d.dot(case.n_g).abs());
            let ((s_i, g_i), (s_o, g_o)) = (cosines(there.wi), cosines(case.wo));
            let power = case.power(there.wi) as Real;
            for lane in 0..LANES {
                let what = |name: &str| format!("{case}, {name}, lane {lane}");
                assert_close(&what("pdf"), there.pdf[lane], back.pdf_rev[lane]);
                assert_close(&what("reverse pdf"), there.pdf_rev[lane], back.pdf[lane]);
                let radiance = there.weight[lane] * there.pdf.hero() * power * s_i * g_o;
                let importance = back.weight[lane] * back.pdf.hero() * s_o * g_i;
                assert_close(&what("light"), radiance, importance);
            }
        }
    }
    assert!(checked > 10, "only {checked} events");
}

/// What a mirrored ray carries in a lane depends on that lane's wavelength alone; a refracted one carries no lane that
/// would have gone another way.
#[test]
fn lanes_do_not_see_each_other() {
    const LAST: usize = LANES - 1;
    for example in delta_examples() {
        let lambda = wavelengths(0.3);
        let mut others = wavelengths(0.77);
        others.lambda[LAST] = lambda.lambda[LAST];
        others.pdf[LAST] = lambda.pdf[LAST];
        let up = Vec3::new(0.0, 0.0, 1.0);
        for wo in [up, Vec3::new(0.6, 0.0, 0.8), Vec3::new(0.0, 0.96, 0.28)] {
            let of = |lambda| {
                let point = ShadingPoint::new(example.leaf(lambda), up, up, wo);
                let carried = |e: Scattered| (e.is_transmitted, e.weight[LAST] * e.pdf.hero());
                events(&point, Mode::Radiance).into_iter().map(carried).collect::<Vec<_>>()
            };
            for ((_, a), (_, b)) in of(&lambda).into_iter().zip(of(&others)).filter(|(a, b)| a.0 == b.0) {
                assert_close(example.text, a, b);
            }
        }
    }
}

/// The law's own sanity: the cases have both kinds of event, and leaning normals.
#[test]
fn cases_reflect_and_transmit() {
    let cases: Vec<Case> = delta_cases();
    let has = |transmitted: bool| {
        cases.iter().any(|case| {
            case.tilt != 0.0
                && events(&case.point(), Mode::Radiance).iter().any(|e| e.is_transmitted == transmitted)
        })
    };
    assert!(has(true) && has(false));
}
