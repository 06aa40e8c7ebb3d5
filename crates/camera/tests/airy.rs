//! The far field of apertures against what theory says.

use indigo_camera::diffraction::far_field::{SECTORS, direction};
use indigo_camera::{Aperture, Blades, FarField, GreyImage, Pupil};

fn far_field(aperture: Aperture) -> FarField {
    Pupil::new(aperture, None).far_field().expect("an opening")
}

fn blades(count: i64, start_angle: f64, curvature: f64) -> Aperture {
    Aperture::generated(&Blades::new(count, start_angle, 0.3, curvature).expect("blades with an opening"))
}

/// Mean of P over all directions at a distance.
fn around(field: &FarField, r: f64) -> f64 {
    let (row, factor) = field.at_radius(r);
    let sum: f64 = row.iter().zip(field.sector_widths()).map(|(&d, width)| f64::from(d) * width).sum();
    sum * factor / std::f64::consts::PI
}

/// Radii of the dark rings are the zeros of J1 over π, and what lies within them is 1 - J0² there
/// (Born & Wolf, "Principles of Optics", section 8.5.2).
#[test]
fn a_circle_makes_the_airy_disc() {
    let field = far_field(Aperture::Circular);
    for (radius, within) in [(1.21967, 0.83778), (2.23313, 0.90990), (3.23832, 0.93756), (4.24106, 0.95222)] {
        // The least of a parabola through the middles of three rings: a sixteenth of a cycle apart, on a curve that has
        // a zero of second order there.
        let ring = (radius * 16.0) as i32;
        let value = |i: i32| around(&field, (f64::from(i) + 0.5) / 16.0);
        let darkest =
            (ring - 2..=ring + 2).min_by(|a, b| value(*a).total_cmp(&value(*b))).expect("five rings");
        let (a, b, c) = (value(darkest - 1), value(darkest), value(darkest + 1));
        let found = (f64::from(darkest) + 0.5 + 0.5 * (a - c) / (a - 2.0 * b + c)) / 16.0;
        assert!((found / radius - 1.0).abs() < 0.01, "dark at {found} instead of {radius}");
        let got = 1.0 - field.beyond(radius);
        assert!((got - within).abs() < 1e-3, "{got} within {radius} instead of {within}");
    }
    // P(0) is the part of the square that is open, and P falls as 1 - (π r)²/4 from there: the mean over
    // a ring from 0 to 1/16.
    let middle = std::f64::consts::FRAC_PI_4 * (1.0 - std::f64::consts::PI.powi(2) / 2048.0);
    assert!((around(&field, 0.0) / middle - 1.0).abs() < 5e-3, "{}", around(&field, 0.0));
}

/// Light farther than r from the middle: J0² + J1² of π r, whose mean falls as 2 / (π² r).
#[test]
fn a_circles_tail_falls_with_the_distance() {
    let field = far_field(Aperture::Circular);
    for r in [20.0, 60.0, 200.0, 500.0, 600.0, 1e4] {
        let exact = 2.0 / (std::f64::consts::PI.powi(2) * r);
        let got = field.beyond(r);
        assert!((got / exact - 1.0).abs() < 0.02, "{got} beyond {r} instead of {exact}");
    }
}

/// The transform of a square of side w is w² sinc²: checked on the axes and the diagonal.
#[test]
fn a_square_makes_a_product_of_slits() {
    let side = 512;
    let open = |i: usize| (64..448).contains(&i);
    let texels = (0..side * side).map(|i| f32::from(u8::from(open(i % side) && open(i / side)))).collect();
    let image = GreyImage { width: side, height: side, texels };
    let field = far_field(Aperture::image(&image).expect("not black"));
    let slit = |f: f64| {
        let x = std::f64::consts::PI * 0.75 * f;
        if x == 0.0 { 1.0 } else { (x.sin() / x).powi(2) }
    };
    // In the middles of rings.
    for sector in [SECTORS / 2, SECTORS * 3 / 4, SECTORS / 8] {
        let [x, y] = direction(sector as f64 + 0.5);
        for r in [0.03125, 0.53125, 1.03125, 2.03125, 2.53125] {
            let (row, _) = field.at_radius(r);
            let exact = 0.5625 * slit(r * x) * slit(r * y);
            let got = f64::from(row[sector]);
            assert!((got - exact).abs() < 0.02 * 0.5625, "{got} instead of {exact} at {r} along {x} {y}");
        }
    }
}

/// Directions, in turns of a half circle, in which most light goes far.
fn streaks(field: &FarField) -> Vec<f64> {
    let (row, _) = field.at_radius(1e5);
    let mean = row.iter().sum::<f32>() / SECTORS as f32;
    let mut found: Vec<(f64, f64)> = vec![];
    for (j, &d) in row.iter().enumerate().filter(|(_, d)| **d > 10.0 * mean) {
        let [x, y] = direction(j as f64 + 0.5);
        let angle = y.atan2(x) / std::f64::consts::PI;
        match found.last_mut() {
            Some((sum, weight)) if (angle - *sum / *weight).abs() < 0.02 => {
                *sum += angle * f64::from(d);
                *weight += f64::from(d);
            }
            _ => found.push((angle * f64::from(d), f64::from(d))),
        }
    }
    found.into_iter().map(|(sum, weight)| sum / weight).collect()
}

/// n straight blades send light at right angles to their edges, to both sides: 2n streaks if n is
/// odd, and n if it is even, since then they fall together. Over half a circle that is n and n/2.
#[test]
fn streaks_stand_across_the_blades() {
    for (n, start) in [(5i64, 0.3), (6, 0.1), (7, 0.2), (8, 0.05)] {
        let found = streaks(&far_field(blades(n, start, 1e6)));
        let distinct = if n % 2 == 0 { n / 2 } else { n } as usize;
        assert_eq!(found.len(), distinct, "{n} blades: {found:?}");
        let step = 1.0 / distinct as f64;
        for angle in found {
            let off = (angle - start / std::f64::consts::PI) / step;
            assert!((off - off.round()).abs() * step < 1e-3, "{n} blades: a streak at {angle}");
        }
    }
}

/// Curved blades spread each streak over the angles of their edges.
#[test]
fn curved_blades_make_broad_streaks() {
    let brightest = |curvature| {
        let field = far_field(blades(6, 0.1, curvature));
        field.at_radius(1e5).0.iter().copied().fold(0.0, f32::max)
    };
    let [straight, curved, circle] = [1e6, 1.0, 0.3].map(brightest);
    assert!(straight > 10.0 * curved && curved > 2.0 * circle, "{straight} {curved} {circle}");
}

/// Twice the opening in the same square: half the pattern.
#[test]
fn a_larger_opening_spreads_less() {
    let circle = |offset: f64| {
        let blades = Blades::new(6, 0.0, offset, offset).expect("a circle");
        far_field(Aperture::generated(&blades))
    };
    let (small, large) = (circle(0.25), circle(0.5));
    for r in [1.0, 2.0, 5.0, 40.0, 100.0] {
        let (a, b) = (small.beyond(2.0 * r), large.beyond(r));
        assert!((a / b - 1.0).abs() < 0.03, "{r}: {a} {b}");
    }
}

#[test]
fn obstacles_change_the_far_field_and_can_block_it() {
    let clear = far_field(Aperture::Circular);
    let grey =
        |f: &dyn Fn(usize) -> f32| GreyImage { width: 64, height: 16, texels: (0..64 * 16).map(f).collect() };
    let hair = grey(&|i| if i % 64 == 30 { 0.0 } else { 1.0 });
    let scratched = Pupil::new(Aperture::Circular, Some(hair)).far_field().expect("an opening");
    // A vertical hair sends light to both sides.
    let aside = |field: &FarField| field.at_radius(100.0).0[SECTORS / 2];
    assert!(aside(&scratched) > 5.0 * aside(&clear), "{} {}", aside(&scratched), aside(&clear));
    assert!(Pupil::new(Aperture::Circular, Some(grey(&|_| 0.0))).far_field().is_none());
    let half = Pupil::new(Aperture::Circular, Some(grey(&|_| 0.5))).far_field().expect("grey");
    assert!((half.beyond(3.0) / clear.beyond(3.0) - 1.0).abs() < 1e-3);
}
