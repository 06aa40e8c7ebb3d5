//! Laws that every phase function keeps, over all that are registered, each with the example of its own
//! declaration and with its extremes.
//!
//! The chi-square tests share a false-alarm probability of 1e-4.

use indigo_decl::{Block, Field, Kind, Node, Presence, ResolveError, Resolved, Resolver, bind};
use indigo_diag::{Sink, SourceMap};
use indigo_igs::{Limits, read_document};
use indigo_math::{Real, Vec3};
use indigo_scatter::Phase;
use indigo_scatter::phase::{KINDS, Lobe, PHASE_FUNCTION, PhaseFunction};
use indigo_spectrum::SampledWavelengths;
use indigo_testkit::chi2::{Chi2, Domain};
use indigo_testkit::rng::Rng;

/// Beyond the examples of the declarations: nearly isotropic, strongly forwards and backwards, and coloured.
const EXAMPLES: &[&str] = &[
    "<henyey_greenstein><g_spectrum><uniform><value>0.01</value></uniform></g_spectrum></henyey_greenstein>",
    "<henyey_greenstein><g_spectrum><uniform><value>-0.8</value></uniform></g_spectrum></henyey_greenstein>",
    "<henyey_greenstein><g_spectrum><rgb><rgb>0.9 0.1 -0.5</rgb><gamma>1</gamma></rgb></g_spectrum></henyey_greenstein>",
];

/// A phase function in an element of its own.
static HOLDER: Block = Block::new(
    "holder",
    "",
    &[Field::new("phase_function", Kind::OneOf(&PHASE_FUNCTION), Presence::Required, "")],
);

struct Text(String);

impl Resolver for Text {
    fn read(&self, path: &str, _from: &str) -> Result<Resolved, ResolveError> {
        Ok(Resolved { path: path.to_owned(), bytes: self.0.as_bytes().into() })
    }
}

fn lobes() -> Vec<(&'static str, Lobe)> {
    let lambda = SampledWavelengths::sample(0.4);
    let texts = KINDS.iter().map(|block| block.example).chain(EXAMPLES.iter().copied());
    texts.map(|text| (text, build(text).at(&lambda))).collect()
}

fn build(text: &str) -> PhaseFunction {
    let mut sink = Sink::new();
    let file = Text(format!("<holder><phase_function>{text}</phase_function></holder>"));
    let root = read_document("p", &file, &mut SourceMap::default(), &mut sink, &Limits::default());
    let node: Node = bind(root.expect("readable text"), &HOLDER, &mut sink);
    let kind = node.node("phase_function").expect("a phase function");
    let built = PhaseFunction::build(kind, &mut sink).expect("a known kind");
    assert!(!sink.has_errors(), "{text}: {:?}", sink.diagnostics());
    built
}

fn vec(d: [f64; 3]) -> Vec3 {
    Vec3::new(d[0] as Real, d[1] as Real, d[2] as Real)
}

#[test]
fn directions_follow_the_density_which_integrates_to_one() {
    let lobes = lobes();
    let views = [[0.0, 0.0, 1.0], [0.6, 0.0, -0.8]];
    let count = lobes.len() * views.len();
    for (seed, (text, lobe)) in lobes.iter().enumerate() {
        for view in views {
            let wo = vec(view);
            // A density that does not integrate to one has too many or too few expected hits.
            let test = Chi2 { samples: 60_000, seed: seed as u64, ..Chi2::new(Domain::Sphere).among(count) };
            let result = test.run(
                |rng| {
                    let u = [0; 2].map(|_| rng.uniform_f32() as Real);
                    Some(lobe.sample(wo, u).to_array().map(|x| x as f64))
                },
                |wi| lobe.pdf(wo, vec(wi)).hero() as f64,
            );
            assert!(result.passed(), "{text} from {view:?}: {result}");
        }
    }
}

/// Each lane has the mean cosine of its own wavelength, whichever of them is the hero.
#[test]
fn each_wavelength_has_its_own_mean_cosine() {
    let kind = build(
        "<henyey_greenstein><g_spectrum><peak><peak_min>500</peak_min><peak_width>80</peak_width>\
         <base_value>-0.3</base_value><peak_value>0.8</peak_value></peak></g_spectrum></henyey_greenstein>",
    );
    let (wo, wi) = (Vec3::new(0.0, 0.0, 1.0), Vec3::new(0.6, 0.0, -0.8));
    let mut met = [false; 2];
    for i in 0..50 {
        let lambda = SampledWavelengths::sample((i as Real + 0.5) / 50.0);
        let pdf = kind.at(&lambda).pdf(wo, wi);
        for (lane, nm) in lambda.lambda.into_iter().enumerate() {
            let is_inside = (500.0..580.0).contains(&nm);
            let g: f64 = if is_inside { 0.8 } else { -0.3 };
            met[usize::from(is_inside)] = true;
            // The light goes on at a cosine of 0.8.
            let expected = (1.0 - g * g) / (4.0 * std::f64::consts::PI * (1.0 + g * g - 1.6 * g).powf(1.5));
            let p = pdf[lane] as f64;
            assert!((p / expected - 1.0).abs() < 1e-5, "lane {lane}, {nm} nm: {p} instead of {expected}");
        }
    }
    assert_eq!(met, [true; 2]);
}

/// Mean cosines beyond the limits are those of the limits.
#[test]
fn the_mean_cosine_is_clamped() {
    let n = Vec3::new(0.0, 0.0, 1.0);
    let of = |g: f64| {
        format!(
            "<henyey_greenstein><g_spectrum><uniform><value>{g}</value></uniform></g_spectrum></henyey_greenstein>"
        )
    };
    for (g, wi) in [(7.0, -n), (-7.0, n)] {
        let peak = build(&of(g)).at(&SampledWavelengths::sample(0.4)).pdf(n, wi).hero() as f64;
        // (1 - g²) / 4π (1 - |g|)³ at 0.99.
        let expected = (1.0 - 0.99 * 0.99) / (4.0 * std::f64::consts::PI * 1e-6);
        assert!((peak / expected - 1.0).abs() < 1e-4, "{g}: {peak} instead of {expected}");
    }
}

#[test]
fn a_phase_function_is_symmetric_positive_and_finite() {
    let mut rng = Rng::new(3);
    for (text, lobe) in lobes() {
        for _ in 0..1000 {
            let mut direction = || {
                let (z, phi) = (2.0 * rng.uniform() - 1.0, std::f64::consts::TAU * rng.uniform());
                let r = (1.0 - z * z).sqrt();
                vec([r * phi.cos(), r * phi.sin(), z])
            };
            let (a, b) = (direction(), direction());
            let there = lobe.pdf(a, b);
            assert_eq!(there, lobe.pdf(b, a), "{text}");
            assert!(there.is_finite() && there.min_lane() > 0.0, "{text}");
        }
        for sign in [1.0, -1.0] {
            let along = Vec3::new(0.0, 0.0, 1.0);
            let p = lobe.pdf(along, along * sign);
            assert!(p.is_finite() && p.min_lane() > 0.0, "{text}");
        }
    }
}
