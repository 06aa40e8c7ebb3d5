//! Reflection by a film so thin that light reflected above and below it interferes.

use indigo_math::Real;
use indigo_math::elementary::{exp, sin_cos_turns};
use num_complex::Complex;

/// Beyond so many turns single precision loses the phase, and fringes are finer than any picture shows: their mean takes their place.
const MOST_TURNS: Real = 1e4;

/// Reflectance for unpolarised light of a clear film on a metal, or on anything of the complex index `ground` = n + ik, at the
/// cosine `cos` in [0, 1] to the normal outside (Born & Wolf, "Principles of Optics", section 14.4.1: all reflections
/// within the film summed).
///
/// `film` and `ground` are over the index of what lies outside. `turns` is 2 n₀ d / λ for an index n₀ outside, a thickness d
/// and a wavelength λ in vacuum: twice the film's thickness in wavelengths outside.
#[inline]
pub fn reflectance(cos: Real, film: Real, ground: [Real; 2], turns: Real) -> Real {
    if turns > MOST_TURNS {
        return mean_reflectance(cos, film, ground);
    }
    averaged(cos, film, ground, |above, below, normal| summed(above, below, through(normal, turns)))
}

/// The mean of [`reflectance`] over the phases of a thick film.
#[inline]
pub fn mean_reflectance(cos: Real, film: Real, ground: [Real; 2]) -> Real {
    averaged(cos, film, ground, |above, below, normal| {
        // A wave that does not travel in the film does not reach the ground.
        if normal.im > 0.0 {
            return above.norm_sqr().min(1.0);
        }
        // Powers of all ways summed: a + (1 − a)² b / (1 − a b).
        let (a, b) = (above.norm_sqr().min(1.0), below.norm_sqr().min(1.0));
        if a * b < 1.0 { 1.0 - (1.0 - a) * (1.0 - b) / (1.0 - a * b) } else { 1.0 }
    })
}

/// The mean over both polarisations of what becomes of the amplitudes that the two boundaries reflect, and the normal component in
/// the film of the wave vector over that of vacuum times the index outside.
#[inline]
fn averaged(
    cos: Real,
    film: Real,
    [n, k]: [Real; 2],
    combine: impl Fn(Complex<Real>, Complex<Real>, Complex<Real>) -> Real,
) -> Real {
    let cos = cos.min(1.0);
    if cos <= 0.0 {
        return 1.0;
    }
    // Squared indices, of which the sine's square is taken so that none is lost near grazing.
    let squares = [Complex::from(1.0), Complex::from(film * film), Complex::new(n * n - k * k, 2.0 * n * k)];
    let within = (film - 1.0) * (film + 1.0) + cos * cos;
    let below = Complex::new((n - 1.0) * (n + 1.0) - k * k + cos * cos, 2.0 * n * k);
    let normal = [Complex::from(cos), root(Complex::from(within)), root(below)];
    let perpendicular = |a: usize, b: usize| quotient(normal[a], normal[b]);
    let parallel = |a: usize, b: usize| quotient(squares[b] * normal[a], squares[a] * normal[b]);
    0.5 * (combine(perpendicular(0, 1), perpendicular(1, 2), normal[1])
        + combine(parallel(0, 1), parallel(1, 2), normal[1]))
}

/// The power of all that comes back, from the amplitudes that the two boundaries reflect and that of a way down and up.
#[inline]
fn summed(above: Complex<Real>, below: Complex<Real>, way: Complex<Real>) -> Real {
    let back = below * way;
    quotient_of(above + back, above * back + 1.0).norm_sqr().min(1.0)
}

/// Fresnel's amplitude (a − b) / (a + b).
#[inline]
fn quotient(a: Complex<Real>, b: Complex<Real>) -> Complex<Real> {
    quotient_of(a - b, a + b)
}

/// A quotient; 0 where both vanish, which is where there is no boundary.
#[inline]
fn quotient_of(a: Complex<Real>, b: Complex<Real>) -> Complex<Real> {
    if b.norm_sqr() > 0.0 { a / b } else { Complex::from(0.0) }
}

/// What a way down and up does to an amplitude: exp(2πi `turns` `normal`). A wave that does not travel in the film fades.
#[inline]
fn through(normal: Complex<Real>, turns: Real) -> Complex<Real> {
    let (sin, cos) = sin_cos_turns(turns * normal.re);
    Complex::new(cos, sin) * exp(-std::f64::consts::TAU as Real * turns * normal.im)
}

/// The square root in the first quadrant of a number above the real axis or on it: waves fade on their way down.
#[inline]
fn root(z: Complex<Real>) -> Complex<Real> {
    let length = z.norm_sqr().sqrt();
    // The larger part first: the other is exact by their product then.
    if z.re > 0.0 {
        let re = (0.5 * (length + z.re)).sqrt();
        Complex::new(re, 0.5 * z.im / re)
    } else {
        let im = (0.5 * (length - z.re)).sqrt();
        Complex::new(if im > 0.0 { 0.5 * z.im / im } else { 0.0 }, im)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fresnel::{conductor, dielectric};

    const COSINES: [Real; 6] = [1.0, 0.9, 0.6, 0.3, 0.1, 0.01];

    #[track_caller]
    fn assert_near(a: Real, b: Real, tolerance: Real) {
        assert!((a - b).abs() < tolerance, "{a} and {b}");
    }

    #[test]
    fn a_film_of_no_thickness_is_not_there() {
        for cos in COSINES {
            for film in [1.0, 1.5, 2.4] {
                assert_near(reflectance(cos, film, [0.2, 3.4], 0.0), conductor(cos, 0.2, 3.4), 2e-5);
                assert_near(reflectance(cos, film, [1.5, 0.0], 0.0), dielectric(cos, 1.5).reflectance, 2e-5);
            }
        }
    }

    #[test]
    fn a_film_like_what_lies_above_or_below_is_not_there() {
        for cos in COSINES {
            for turns in [0.1, 0.7, 3.2] {
                assert_near(reflectance(cos, 1.0, [0.2, 3.4], turns), conductor(cos, 0.2, 3.4), 2e-5);
                assert_near(reflectance(cos, 1.5, [1.5, 0.0], turns), dielectric(cos, 1.5).reflectance, 2e-5);
            }
        }
    }

    /// A quarter of a wave thick a film n₁ on n₂ reflects ((n₂ − n₁²) / (n₂ + n₁²))² along the normal; half a wave thick it is
    /// not seen (Born & Wolf, section 1.6.4, equations 65 and 66).
    #[test]
    fn quarters_and_halves_of_a_wave() {
        for (film, ground) in [(1.38, 1.52), (2.4, 1.5), (1.225, 1.5)] {
            let quarter: Real = (ground - film * film) / (ground + film * film);
            assert_near(reflectance(1.0, film, [ground, 0.0], 0.5 / film), quarter * quarter, 1e-6);
            let bare = (ground - 1.0) / (ground + 1.0);
            assert_near(reflectance(1.0, film, [ground, 0.0], 1.0 / film), bare * bare, 1e-6);
        }
    }

    /// The mean is that over the phase, which one more turn along the normal makes go round once.
    #[test]
    fn the_mean_of_thick_films_is_that_over_the_phase() {
        for (cos, film) in [(1.0, 1.5), (0.5, 1.5), (0.2, 2.4), (0.9, 1.01)] {
            for ground in [[2.7, 3.8], [0.2, 3.4], [1.5, 0.0]] {
                let normal = ((film - 1.0) * (film + 1.0) + cos * cos as Real).sqrt();
                let steps: u16 = 2000;
                let at = |i: u16| (5.0 + Real::from(i) / Real::from(steps)) / normal;
                let sum: Real = (0..steps).map(|i| reflectance(cos, film, ground, at(i))).sum();
                assert_near(mean_reflectance(cos, film, ground), sum / Real::from(steps), 2e-4);
                assert_near(reflectance(cos, film, ground, 1e30), sum / Real::from(steps), 2e-4);
            }
        }
    }

    #[test]
    fn grazing_light_is_reflected_and_nothing_is_no_number() {
        assert!(reflectance(1e-4, 1.0, [0.2, 3.4], 0.7) > 0.99);
        for cos in [0.0, 1e-30, 1e-4, 0.5, 1.0] {
            for film in [1.0, 1.5, 1e3] {
                for ground in [[1.0, 0.0], [0.2, 3.4], [1e3, 1e3], [0.0, 0.0]] {
                    for turns in [0.0, 1e-30, 0.3, 1e4, 1e30, Real::INFINITY] {
                        let r = reflectance(cos, film, ground, turns);
                        assert!((0.0..=1.0).contains(&r), "{cos} {film} {ground:?} {turns}: {r}");
                    }
                }
            }
        }
    }

    /// Beyond the angle of total reflection of a rarer film, light tunnels to what lies below: all is reflected only if the film is thick.
    #[test]
    fn light_tunnels_through_a_rare_film() {
        // 60° outside, towards a film of 1/1.5: the angle of total reflection is 41.8°.
        let [thick, thin] = [20.0, 0.1].map(|turns| reflectance(0.5, 1.0 / 1.5, [1.0, 0.0], turns));
        assert_near(thick, 1.0, 1e-6);
        assert!((0.01..0.9).contains(&thin), "{thin}");
    }

    /// Against the characteristic matrix of the film (Born & Wolf, section 1.6.2), in double precision.
    #[test]
    fn the_sum_is_that_of_the_characteristic_matrix() {
        type C = Complex<f64>;
        let by_matrix = |cos: f64, film: f64, ground: C, turns: f64| {
            let sin2 = 1.0 - cos * cos;
            let squares = [C::from(1.0), C::from(film * film), ground * ground];
            let normal = squares.map(|s| (s - sin2).sqrt());
            let phase = normal[1] * (std::f64::consts::PI * turns);
            let of = |[outside, within, below]: [C; 3]| {
                let (c, s) = (phase.cos(), C::i() * phase.sin());
                let (electric, magnetic) = (c - s / within * below, c * below - s * within);
                let back = (outside * electric - magnetic) / (outside * electric + magnetic);
                back.norm_sqr()
            };
            let perpendicular = of(normal);
            let parallel = of([0, 1, 2].map(|i| squares[i] / normal[i]));
            0.5 * (perpendicular + parallel)
        };
        for cos in [1.0, 0.8, 0.5, 0.2, 0.05] {
            for film in [1.33, 1.5, 2.4] {
                for ground in [C::new(0.2, 3.4), C::new(2.7, 3.8), C::new(1.5, 0.0)] {
                    for turns in [0.05, 0.4, 1.3, 6.0] {
                        let expected = by_matrix(cos, film, ground, turns);
                        let ours = reflectance(
                            cos as Real,
                            film as Real,
                            [ground.re as Real, ground.im as Real],
                            turns as Real,
                        );
                        assert_near(ours, expected as Real, 5e-5);
                    }
                }
            }
        }
    }
}
