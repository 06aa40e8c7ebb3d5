//! Lamps that shine by a file: photometric distributions and pictures.

use std::f64::consts::PI;

use super::super::change::changed;
use super::super::check::{Check, PATH, TECHNIQUES};
use super::super::hung;
use super::super::shapes::{Mesh, Point, mesh_light, model, sub};
use super::super::text::{grey, sphere, uniform};
use super::patch::{TANGENT, patch_mean, seen_from};
use super::{NITS_PER_UNIFORM, integral, looking, strip};

const GROUP: &str = "Lamps by a file";
/// Albedo of what is lit.
const ALBEDO: f64 = 0.5;
/// Candelas of the lamp from straight ahead to aside, with straight lines between them.
const CANDELAS: &[(f64, f64)] = &[(0.0, 1000.0), (20.0, 1400.0), (45.0, 600.0), (70.0, 150.0), (90.0, 0.0)];

/// The lamp's file.
fn photometry() -> Vec<u8> {
    let list =
        |of: fn(&(f64, f64)) -> f64| CANDELAS.iter().map(|c| of(c).to_string()).collect::<Vec<_>>().join(" ");
    let count = CANDELAS.len();
    format!(
        "IESNA:LM-63-2002\n[TEST] none\n[TESTLAB] none\n[ISSUEDATE] 2026-01-01\n[MANUFAC] none\nTILT=NONE\n\
         1 -1 1 {count} 1 1 2 0 0 0\n1 1 1\n{}\n0\n{}\n",
        list(|c| c.0),
        list(|c| c.1)
    )
    .into_bytes()
}

/// The same lamp with other intensities round its axis: one factor at each quarter turn, from the x axis towards the y axis.
const ROUND: [f64; 5] = [1.0, 0.4, 0.7, 1.3, 1.0];

fn photometry_round() -> Vec<u8> {
    let even = String::from_utf8(photometry()).expect("it is text");
    let (head, candelas) = even.split_once("\n0\n").expect("one horizontal angle");
    let count = CANDELAS.len();
    let head = changed(head, &format!(" {count} 1 1 2"), &format!(" {count} {} 1 2", ROUND.len()));
    let column = |factor: f64| {
        let scaled: Vec<String> = candelas
            .split_whitespace()
            .map(|c| (factor * c.parse::<f64>().unwrap_or(0.0)).to_string())
            .collect();
        scaled.join(" ")
    };
    format!("{head}\n0 90 180 270 360\n{}\n", ROUND.map(column).join("\n")).into_bytes()
}

/// The factor towards a point, linear in the angle.
fn round([x, y]: [f64; 2]) -> f64 {
    let quarters = y.atan2(x).rem_euclid(2.0 * PI) / (0.5 * PI);
    let i = (quarters as usize).min(3);
    ROUND[i] + (ROUND[i + 1] - ROUND[i]) * (quarters - i as f64)
}

/// Candelas at an angle in degrees.
fn candelas(degrees: f64) -> f64 {
    let span = CANDELAS.windows(2).find(|w| degrees <= w[1].0);
    span.map_or(0.0, |w| w[0].1 + (w[1].1 - w[0].1) * (degrees - w[0].0) / (w[1].0 - w[0].0))
}

/// A lamp of 2 cm at a height, which looks down by the file.
fn lamp(height: f64) -> String {
    let profile = "<ies_profile><path>lamp.ies</path></ies_profile>";
    grey("lamp", 0.0)
        + &Mesh::square(0.01, 0.0).inside_out().text("lamp", "lamp")
        + &mesh_light("lamp", &uniform(1.0), [0.0, 0.0, height], 1.0, profile)
}

/// All of them.
pub fn checks() -> Vec<Check> {
    let mut checks = vec![flux()];
    checks.extend(fluxes());
    checks.extend([10.0, 33.0, 60.0].map(below));
    checks.extend([20.0, 130.0, 205.0, 300.0].map(around));
    checks.extend([[0.0, 0.0], [0.8, 0.0], [-0.6, 0.5]].map(picture));
    checks
}

/// Light of the whole lamp.
fn flux() -> Check {
    let lumens =
        2.0 * PI * integral(0.0, 0.5 * PI, 90_000, |theta| candelas(theta.to_degrees()) * theta.sin());
    let mut check = in_white_ball("flux of a photometric lamp", lumens).effort(256, 1e-2).quickly(128);
    check.files.push(("lamp.ies".to_owned(), photometry()));
    check
}

/// Files of each symmetry, unit, tilt and step, by the lumens that their candelas add up to.
const FILES: &[(&str, &[u8])] = &[
    ("lambert_1000cd", include_bytes!("../../../../../testscenes/ies/lambert_1000cd.ies")),
    (
        "uniform_hemisphere_500cd",
        include_bytes!("../../../../../testscenes/ies/uniform_hemisphere_500cd.ies"),
    ),
    ("spot_cos8_2000cd", include_bytes!("../../../../../testscenes/ies/spot_cos8_2000cd.ies")),
    ("quadrant_bat", include_bytes!("../../../../../testscenes/ies/quadrant_bat.ies")),
    ("bilateral_0_180", include_bytes!("../../../../../testscenes/ies/bilateral_0_180.ies")),
    ("full_0_360", include_bytes!("../../../../../testscenes/ies/full_0_360.ies")),
    ("tilt_include", include_bytes!("../../../../../testscenes/ies/tilt_include.ies")),
    ("irregular_angles", include_bytes!("../../../../../testscenes/ies/irregular_angles.ies")),
];

fn fluxes() -> impl Iterator<Item = Check> {
    FILES.iter().map(|(name, file)| {
        let lumens = lumens(&String::from_utf8_lossy(file)).expect("a photometric file");
        let mut check = in_white_ball(&format!("flux of {name}.ies"), lumens).effort(64, 3e-2);
        check.files.push(("lamp.ies".to_owned(), file.to_vec()));
        check
    })
}

/// Lumens of a file of LM-63-2002: ∫ I sin θ dθ dφ of its candelas with straight lines between both angles, which each symmetry repeats.
fn lumens(file: &str) -> Option<f64> {
    let (_, after) = file.split_once("TILT=")?;
    let mut numbers = after.split_ascii_whitespace();
    let is_tilted = numbers.next()? == "INCLUDE";
    let mut numbers = numbers.map(|word| word.parse::<f64>().ok());
    let mut next = || numbers.next().flatten();
    if is_tilted {
        // The lamp stands as it should, where each factor is 1.
        let (_, pairs) = (next()?, next()? as usize);
        (0..2 * pairs).try_for_each(|_| next().map(drop))?;
    }
    let head: Vec<f64> = (0..13).map(|_| next()).collect::<Option<_>>()?;
    let factor = head[2] * head[10] * head[11];
    let mut list = |count: f64| (0..count as usize).map(|_| next()).collect::<Option<Vec<f64>>>();
    let (down, round) = (list(head[3])?, list(head[4])?);
    let rings = round.iter().map(|_| Some(ring(&down, &list(head[3])?))).collect::<Option<Vec<f64>>>()?;
    // Each part of the whole turn has the mean of those that the file tells of.
    let mean = match rings[..] {
        [one] => one,
        _ => {
            let parts = round
                .windows(2)
                .zip(rings.windows(2))
                .map(|(at, of)| 0.5 * (of[0] + of[1]) * (at[1] - at[0]));
            parts.sum::<f64>() / (round.last()? - round.first()?)
        }
    };
    Some(2.0 * PI * factor * mean)
}

/// ∫ I sin θ dθ of candelas at angles in degrees.
fn ring(degrees: &[f64], candelas: &[f64]) -> f64 {
    let spans = degrees.windows(2).zip(candelas.windows(2));
    spans
        .map(|(at, of)| {
            let [from, to] = [at[0].to_radians(), at[1].to_radians()];
            integral(from, to, 2000, |theta| {
                (of[0] + (of[1] - of[0]) * (theta - from) / (to - from)) * theta.sin()
            })
        })
        .sum()
}

/// What a lamp sends to a white ball round it shines evenly from there after the first time.
fn in_white_ball(name: &str, lumens: f64) -> Check {
    let radius = 5.0f64;
    let area = 4.0 * PI * radius * radius;
    let luminance = ALBEDO / PI * lumens * ALBEDO / (area * (1.0 - ALBEDO));
    // The patch behind the lamp gets no light at first hand.
    let parts = [grey("wall", ALBEDO), sphere([0.0; 3], radius, "wall"), lamp(0.0)];
    let scene = looking([1.0, 0.0, 1.0], [-0.2, 0.1, 1.0], 0.1, "<max_depth>10000</max_depth>", &parts);
    let about = format!(
        "{lumens:.2} lm, the integral of the file's candelas over all directions, in a white ball of albedo ρ = {ALBEDO}: light \
         that has been reflected shines evenly, ρ² Φ / ((1 − ρ) π A), on a patch that the lamp does not light itself."
    );
    // The lamp takes 3·10⁻⁶ of what flies about.
    Check::new(GROUP, name, about, scene).is(luminance, 1e-5 * luminance).by(TECHNIQUES)
}

/// Height of the lamp above the floor, metres.
const HEIGHT: f64 = 2.0;

/// Illuminance of the floor by the lamp, times a factor.
fn lux([x, y, _]: Point, factor: f64) -> f64 {
    let way2 = x * x + y * y + HEIGHT * HEIGHT;
    let cosine = HEIGHT / way2.sqrt();
    factor * candelas(cosine.acos().to_degrees()) * cosine / way2
}

/// The floor two metres below, from where the lamp is seen at an angle.
fn below(degrees: f64) -> Check {
    let target = [HEIGHT * degrees.to_radians().tan(), 0.0, 0.0];
    let about = format!(
        "I cos θ / d² with {:.1} cd at {degrees}°, mean over the patch that is seen.",
        candelas(degrees)
    );
    let value = ALBEDO / PI * patch_mean(target, |p| lux(p, 1.0));
    let check =
        Check::new(GROUP, format!("photometric lamp at {degrees}°"), about, floor(&lamp(HEIGHT), target));
    // The lamp is 1 cm to each side: 3·10⁻⁵ of d², and no kink of the file lies within its angle.
    with_file(check.is(value, 3e-5 * value)).by(TECHNIQUES).effort(16, 5e-3).in_full(256, 5e-3)
}

/// The floor in another direction round the axis of a lamp whose intensities differ there.
fn around(degrees: f64) -> Check {
    let (s, c) = degrees.to_radians().sin_cos();
    let target = [1.2 * c, 1.2 * s, 0.0];
    let factor = |[x, y, _]: Point| round([x, y]);
    let about = format!(
        "Horizontal angles of a photometric file run from the x axis towards the y axis of the lamp, seen from above where it shines \
         down: at {degrees}° {:.2} of the candelas, linear between quarter turns.",
        factor(target)
    );
    let value = ALBEDO / PI * patch_mean(target, |p| lux(p, factor(p)));
    let name = format!("photometric lamp, {degrees}° round its axis");
    let mut check = Check::new(GROUP, name, about, floor(&lamp(HEIGHT), target));
    check.files.push(("lamp.ies".to_owned(), photometry_round()));
    check.is(value, 3e-5 * value).by(TECHNIQUES).effort(16, 5e-3).in_full(256, 5e-3)
}

fn with_file(mut check: Check) -> Check {
    check.files.push(("lamp.ies".to_owned(), photometry()));
    check
}

/// Looks at a point of a floor under a lamp.
fn floor(lamp: &str, target: Point) -> String {
    let eye = seen_from(target);
    let ground = Mesh::square(20.0, 0.0).text("ground", "floor") + &model("ground");
    looking(eye, sub(target, eye), TANGENT, "", &[grey("floor", ALBEDO), ground, lamp.to_owned()])
}

/// Spectral radiance of white in the picture, W m^-3 sr^-1.
const RADIANCE: f64 = 5.0e7;
/// What its other half has of that.
const DARKER: f64 = 0.25;
/// Texels along its side.
const TEXELS: usize = 256;

/// A square lamp of two metres whose picture is white on one half and grey on the other, one metre above a floor.
fn picture([x, y]: [f64; 2]) -> Check {
    let square = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(|[a, b]| [a, b, 0.0]);
    let texture = "<texture><path>halves.exr</path><exponent>1</exponent></texture>";
    // Seen from below, where it shines.
    let mesh = changed(
        &hung::mesh("lamp", "lamp", square, 1.0),
        "<tri>0 1 2</tri><tri>0 2 3</tri>",
        "<tri>0 2 1</tri><tri>0 3 2</tri>",
    );
    let lamp =
        grey("lamp", 0.0) + &mesh + &mesh_light("lamp", &uniform(RADIANCE), [0.0, 0.0, 1.0], 1.0, texture);
    // Texels stand at whole multiples of their distance, from the left edge on, and blend with their neighbours, round the
    // edge too.
    let texel = |i: usize| if i % TEXELS < TEXELS / 2 { 1.0 } else { DARKER };
    let shade = |p: f64| {
        let at = 0.5 * (p + 1.0) * TEXELS as f64;
        let (i, beyond) = (at as usize, at.fract());
        texel(i) * (1.0 - beyond) + texel(i + 1) * beyond
    };
    let lux = |[x, y, _]: Point| {
        // A strip of the lamp at a distance whose square is a, 1 m above.
        let of_strip = |p: f64| {
            let a = 1.0 + (p - x) * (p - x);
            shade(p) * (strip(a, 1.0 - y) - strip(a, -1.0 - y))
        };
        integral(-1.0, 1.0, 20_000, of_strip)
    };
    let target = [x, y, 0.0];
    let value = ALBEDO / PI * RADIANCE * NITS_PER_UNIFORM * patch_mean(target, lux);
    let about = format!(
        "A square lamp of 2 m, 1 m above a floor, whose picture is 1 on the left half and {DARKER} on the right: ∫ L h² / d⁴ dA, \
         texels blending into their neighbours."
    );
    let scene = floor(&lamp, target);
    let name = format!("lamp with a picture, above ({x}, {y})");
    let mut check = Check::new(GROUP, name, about, scene).is(value, 0.0).effort(32, 1e-2);
    let value = |x: usize, _: usize| if x < TEXELS / 2 { 1.0 } else { DARKER as f32 };
    check.files.push(("halves.exr".to_owned(), hung::picture([TEXELS; 2], value)));
    check.by(if y == 0.0 { TECHNIQUES } else { PATH })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Closed forms of what the files sample are within what straight lines make of them: of 2.5 degrees for Lambert's cosine, π I, and
    /// none for an even hemisphere, 2π I.
    #[test]
    fn files_have_their_lumens() {
        let of = |name: &str| {
            let (_, file) = FILES.iter().find(|(file, _)| *file == name).expect("a file");
            lumens(&String::from_utf8_lossy(file)).expect("lumens")
        };
        assert!((of("uniform_hemisphere_500cd") / (1000.0 * PI) - 1.0).abs() < 1e-6);
        for (name, lumens) in [
            ("lambert_1000cd", 1000.0 * PI),
            ("quadrant_bat", 800.0 * PI),
            ("bilateral_0_180", 800.0 * PI),
            ("full_0_360", 800.0 * PI),
            ("tilt_include", 1000.0 * PI),
        ] {
            assert!((of(name) / lumens - 1.0).abs() < 1e-3, "{name}: {}", of(name));
        }
        // 2π I / 9 of cos⁸, which bends most between its angles.
        assert!((of("spot_cos8_2000cd") / (2.0 * PI * 2000.0 * 1.44 / 9.0) - 1.0).abs() < 1e-2);
    }

    #[test]
    fn rings_of_straight_lines_are_exact() {
        // ∫ θ sin θ dθ from 0 to a right angle is 1.
        assert!((ring(&[0.0, 90.0], &[0.0, 0.5 * PI]) - 1.0).abs() < 1e-6);
    }
}
