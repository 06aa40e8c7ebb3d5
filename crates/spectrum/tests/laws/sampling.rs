//! Sampled wavelengths, their density, and the weights of the film.

use indigo_math::Real;
use indigo_spectrum::{
    LANES, LightSpectrum, SampledSpectrum, SampledWavelengths, Spectrum, WavelengthSampler, observer,
};

use crate::{assert_near, largest_difference};

/// Mean of an estimator over all wavelength samples: the midpoints of 2^20 strata, 1024 to each
/// segment of constant density.
fn mean_over_samples(
    sampler: &WavelengthSampler,
    mut estimate: impl FnMut(&SampledWavelengths) -> [f64; 3],
) -> [f64; 3] {
    const STRATA: u32 = 1 << 20;
    let mut sum = [0.0; 3];
    for k in 0..STRATA {
        let sampled = sampler.sample((f64::from(k) + 0.5) as Real / STRATA as Real);
        let found = estimate(&sampled);
        (0..3).for_each(|c| sum[c] += found[c]);
    }
    sum.map(|v| v / f64::from(STRATA))
}

/// The observer's sampler, and those of light that is sodium's for the most part, of daylight, and of a line
/// thinner than the cells in which spectra are looked at.
fn samplers() -> Vec<WavelengthSampler> {
    let of_light = |spectrum: &Spectrum| {
        let mut light = LightSpectrum::default();
        light.add(1.0, |lambda| spectrum.eval(lambda));
        WavelengthSampler::of_light(&light)
    };
    vec![
        WavelengthSampler::visible().clone(),
        of_light(&sodium()),
        of_light(&Spectrum::illuminant("D65").unwrap()),
        of_light(&Spectrum::peak(500.05, 0.2, 0.0, 1.0)),
    ]
}

fn sodium() -> Spectrum {
    Spectrum::peak(580.0, 20.0, 0.02, 5.0)
}

#[test]
fn the_film_weights_give_unbiased_xyz() {
    let cases = [
        (Spectrum::uniform(1.0), 2e-6),
        (Spectrum::illuminant("F11").unwrap(), 2e-6),
        (Spectrum::blackbody(2856.0, 1.0), 2e-6),
        (Spectrum::rgb_emission([1.0, 0.1, 0.05]), 2e-6),
        // A stratum that an edge cuts counts whole or not at all.
        (Spectrum::peak(443.3, 20.0, 0.0, 1.0), 1e-4),
        (Spectrum::peak(700.0, 130.0, 0.0, 1.0), 2e-4),
    ];
    for sampler in samplers() {
        for (spectrum, bound) in &cases {
            let found = mean_over_samples(&sampler, |sampled| {
                let value = spectrum.eval(sampled);
                observer::xyz_weights(sampled)
                    .map(|w| (0..LANES).map(|i| w[i] as f64 * value[i] as f64).sum())
            });
            let expected = spectrum.xyz();
            let error = largest_difference(found, expected) / expected[0].max(expected[1]).max(expected[2]);
            assert!(error < *bound, "{spectrum:?}: {error:.1e}");
        }
    }
}

#[test]
fn integrals_by_the_density_are_unbiased() {
    let spectrum = Spectrum::rgb_reflectance([0.2, 0.5, 0.3]);
    for sampler in samplers() {
        let [found, range, _] = mean_over_samples(&sampler, |sampled| {
            let value = spectrum.eval(sampled) / SampledSpectrum(sampled.pdf);
            [value.mean() as f64, SampledSpectrum(sampled.pdf.map(|p| 1.0 / p)).mean() as f64, 0.0]
        });
        assert_near(found, spectrum.integral_nm(), 2e-6);
        assert_near(range, 470.0, 2e-6);
    }
}

/// Variance of a sample's XYZ over the squared sum of its means.
fn noise(sampler: &WavelengthSampler, spectrum: &Spectrum) -> f64 {
    let mean = spectrum.xyz();
    let squares = mean_over_samples(sampler, |sampled| {
        let value = spectrum.eval(sampled);
        let mut c = 0;
        observer::xyz_weights(sampled).map(|w| {
            let found: f64 = (0..LANES).map(|i| w[i] as f64 * value[i] as f64).sum();
            c += 1;
            (found - mean[c - 1]).powi(2)
        })
    });
    squares.iter().sum::<f64>() / mean.iter().sum::<f64>().powi(2)
}

/// A lamp of one line is seen by nearly every sample; other light beside it is no noisier than the lamp was;
/// daylight and flat light change next to nothing.
#[test]
fn light_that_a_sampler_knows_is_less_noisy() {
    let [plain, sodium_light, daylight, line] = samplers().try_into().expect("four samplers");
    let (lamp, day) = (sodium(), Spectrum::illuminant("D65").unwrap());
    assert!(noise(&sodium_light, &lamp) < 0.1 * noise(&plain, &lamp));
    // Of 300 lanes one would meet it.
    let thin = Spectrum::peak(500.05, 0.2, 0.0, 1.0);
    assert!(noise(&line, &thin) < 0.01 * noise(&plain, &thin));
    assert!(noise(&daylight, &day) < 1.1 * noise(&plain, &day));
    assert!(noise(&sodium_light, &day) < noise(&plain, &lamp));
    let mut flat = LightSpectrum::default();
    flat.add(1.0, |_| SampledSpectrum([3.0; LANES]));
    let flat = WavelengthSampler::of_light(&flat);
    let mut dark = LightSpectrum::default();
    dark.add(1.0, |_| SampledSpectrum::ZERO);
    let dark = WavelengthSampler::of_light(&dark);
    for k in 0..100 {
        let u = (k as Real + 0.5) / 100.0;
        for sampler in [&flat, &dark] {
            let (a, b) = (sampler.sample(u).lambda[0], plain.sample(u).lambda[0]);
            assert!((a - b).abs() < 0.1, "{a} and {b} nm");
        }
    }
}

#[test]
fn companions_lie_equal_quantiles_apart() {
    for k in 0..64 {
        let u = k as Real / 64.0;
        let sampled = SampledWavelengths::sample(u);
        for lane in 0..LANES {
            let shifted = (u + lane as Real / LANES as Real).fract();
            let hero = SampledWavelengths::sample(shifted);
            assert_eq!((sampled.lambda[lane], sampled.pdf[lane]), (hero.lambda[0], hero.pdf[0]));
        }
    }
}

#[test]
fn the_density_covers_the_visible_range_and_sums_to_one() {
    const STEPS: u32 = 470_000;
    for sampler in samplers() {
        let mut integral = 0.0;
        for k in 0..STEPS {
            let density = sampler.density((360.0 + (f64::from(k) + 0.5) * 1e-3) as Real);
            // A tenth of the samples is spread evenly; a segment may straddle a change of the density.
            assert!(density as f64 > 0.08 / 470.0, "density {density} at step {k}");
            integral += density as f64 * 1e-3;
        }
        // A line's segments are thinner than the steps.
        assert_near(integral, 1.0, 1e-2);
        assert_eq!(sampler.density(359.9), 0.0);
        assert_eq!(sampler.density(830.1), 0.0);
        let ends = [0.0, 1.0 - Real::EPSILON / 2.0].map(|u| sampler.sample(u).lambda[0]);
        assert!(ends[0] == 360.0 && ends[1] > 829.9 && ends[1] <= 830.0, "{ends:?}");
    }
}

/// Chi-square of each lane over 47 bins of 10 nm. A fixed sequence; for a random one the chance
/// that any of the lanes fails would be about 1e-4.
#[test]
fn sampled_wavelengths_follow_the_density() {
    const BINS: usize = 47;
    const SAMPLES: usize = 200_000;
    let expected: Vec<f64> = (0..BINS)
        .map(|bin| {
            let start = 360.0 + 10.0 * bin as f64;
            (0..2000)
                .map(|k| {
                    WavelengthSampler::visible().density((start + (f64::from(k) + 0.5) * 5e-3) as Real) as f64
                        * 5e-3
                })
                .sum::<f64>()
                * SAMPLES as f64
        })
        .collect();
    let mut counts = vec![[0_u32; BINS]; LANES];
    let mut state = 1_u64;
    for _ in 0..SAMPLES {
        // Knuth's multiplicative generator (MMIX); the top 24 bits.
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        let sampled = SampledWavelengths::sample((state >> 40) as Real / (1_u64 << 24) as Real);
        for (lane, lambda) in sampled.lambda.into_iter().enumerate() {
            counts[lane][(((lambda - 360.0) / 10.0) as usize).min(BINS - 1)] += 1;
        }
    }
    for (lane, bins) in counts.iter().enumerate() {
        let chi2: f64 = bins.iter().zip(&expected).map(|(&n, e)| (f64::from(n) - e).powi(2) / e).sum();
        // The 1 - 1e-4/8 quantile of chi-square with 46 degrees of freedom, by Wilson & Hilferty 1931 (z = 4.21).
        let freedom = (BINS - 1) as f64;
        let limit = freedom * (1.0 - 2.0 / (9.0 * freedom) + 4.21 * (2.0 / (9.0 * freedom)).sqrt()).powi(3);
        assert!(chi2 < limit, "lane {lane}: {chi2:.1} against {limit:.1}");
    }
}
