//! Sun, sky and lamps of measured distributions.

use std::f64::consts::PI;

use super::super::check::{Check, TECHNIQUES};
use super::super::shapes::{Mesh, Point, model, sub};
use super::super::text::grey;
use super::looking;

const GROUP: &str = "Sky and lamps";
const ALBEDO: f64 = 0.5;
/// Illuminance across sunlight in space by ASTM G173, whose whole nanometres run straight between them, under the
/// observer: lx, as a test computes it.
pub const SUN_IN_SPACE: f64 = 133_100.623_5;

/// Elevation of the sun in degrees, turbidity, model; illuminance (lx) of a level surface by the sky, by Gauss's rule over
/// all its directions, and across the sun's direction by its disc of 0.5358°. A test computes them anew from the published tables.
const DAYLIGHT: [(f64, f64, &str, f64, f64); 4] = [
    (30.0, 2.0, "hosek", 11_667.242_7, 79_789.079_6),
    (60.0, 5.0, "hosek", 22_376.321_1, 82_322.945_5),
    (30.0, 2.0, "preetham", 24_188.325_3, 81_941.703_1),
    (60.0, 6.0, "preetham", 56_074.296_5, 62_925.136_2),
];

/// Elevation, turbidity and model; a direction in words and numbers, and luminance from there (cd/m²).
type Seen = (f64, f64, &'static str, (&'static str, Point), f64);

/// Of the published tables, likewise. The sun stands aside of north and
/// east, so that no two directions are alike.
const SEEN: [Seen; 8] = [
    (30.0, 2.0, "hosek", ("the zenith", [0.0, 0.0, 1.0]), 1_760.361_2),
    (30.0, 2.0, "hosek", ("the east", [1.0, 0.0, 0.6]), 4_382.023_1),
    (30.0, 2.0, "hosek", ("the north", [0.0, 1.0, 0.6]), 3_463.328_7),
    (30.0, 2.0, "hosek", ("the west", [-1.0, 0.0, 0.6]), 3_343.273_7),
    (45.0, 4.0, "preetham", ("the zenith", [0.0, 0.0, 1.0]), 10_004.691_6),
    (45.0, 4.0, "preetham", ("the east", [1.0, 0.0, 0.6]), 12_738.287_5),
    (45.0, 4.0, "preetham", ("the north", [0.0, 1.0, 0.6]), 6_897.475_9),
    (45.0, 4.0, "preetham", ("the south", [0.0, -1.0, 0.6]), 16_180.917_4),
];

fn floor(name: String, about: &str, light: &str, lux: f64) -> Check {
    let eye = [3.0, 1.0, 1.2];
    let ground = Mesh::square(4.0, 0.0).text("ground", "ground") + &model("ground");
    let scene =
        looking(eye, sub([0.0; 3], eye), 2e-3, "", &[grey("ground", ALBEDO), ground, light.to_owned()]);
    Check::new(GROUP, name, about, scene)
        .is(ALBEDO * lux / PI, 0.0)
        .by(TECHNIQUES)
        .effort(32, 5e-3)
        .in_full(256, 5e-3)
}

/// `<skylight>` with the sun over (0.6, −0.8).
fn daylight(elevation: f64, turbidity: f64, kind: &str) -> String {
    let (s, c) = elevation.to_radians().sin_cos();
    let (x, y) = (0.6 * c, -0.8 * c);
    format!(
        "<skylight><sundir>{x} {y} {s}</sundir><turbidity>{turbidity}</turbidity><model>{kind}</model></skylight>"
    )
}

/// All of them.
pub fn checks() -> Vec<Check> {
    let mut checks = vec![];
    for (elevation, turbidity, kind, sky, sun) in DAYLIGHT {
        let name = format!("{kind}, sun {elevation}° high, turbidity {turbidity}");
        let about = "Illuminance by sky and sun, integrated from the model's formulae and tables.";
        let lux = sky + sun * elevation.to_radians().sin();
        checks.push(floor(name, about, &daylight(elevation, turbidity, kind), lux));
    }
    for (elevation, turbidity, kind, (words, direction), luminance) in SEEN {
        // So narrow that what bends is known at the middle.
        let scene = looking([0.0; 3], direction, 2e-4, "", &[daylight(elevation, turbidity, kind)]);
        let name = format!("{kind} towards {words}, sun {elevation}° high");
        let about = "Luminance of the sky in a direction, of the model's formula and tables.";
        let check = Check::new(GROUP, name, about, scene).is(luminance, 0.0).by(TECHNIQUES);
        checks.push(check.effort(64, 5e-3).quickly(16));
    }
    let light = "<skylight><sundir>0 3 4</sundir><turbidity>2</turbidity><extra_atmospheric>true</extra_atmospheric></skylight>";
    let about = "ASTM G173: 133.1 klx across the sun's direction.";
    checks.push(floor("sun in space".into(), about, light, 0.8 * SUN_IN_SPACE));
    checks
}

#[cfg(test)]
mod tests {
    use super::super::colour::tristimulus;
    use super::super::daylight::Sky;
    use super::*;

    /// From 360 nm, in nanometres.
    static SPACE: [f64; 471] = include!("../../../../light/data/astm_g173_extraterrestrial_1nm.in");

    #[test]
    fn sunlight_in_space_is_that_of_the_table() {
        let irradiance = |nm: f64| {
            let i = ((nm - 360.0) as usize).min(SPACE.len() - 2);
            SPACE[i] + (SPACE[i + 1] - SPACE[i]) * (nm - 360.0 - i as f64)
        };
        let computed = tristimulus(360.0, 830.0, irradiance)[1];
        assert!((computed / SUN_IN_SPACE - 1.0).abs() < 1e-7, "{computed}");
    }

    fn sky(elevation: f64, turbidity: f64, kind: &str) -> Sky {
        Sky { elevation, turbidity, is_hosek: kind == "hosek" }
    }

    /// The numbers above are those of the models' formulae and tables, computed here.
    #[test]
    fn luminances_are_those_of_the_models() {
        for (elevation, turbidity, kind, (words, direction), luminance) in SEEN {
            let (s, c) = elevation.to_radians().sin_cos();
            let computed = sky(elevation, turbidity, kind).luminance(direction, [0.6 * c, -0.8 * c, s]);
            assert!((computed / luminance - 1.0).abs() < 1e-6, "{kind} {words}: {computed} {luminance}");
        }
    }

    #[test]
    fn illuminances_are_those_of_the_models() {
        for (elevation, turbidity, kind, by_sky, by_sun) in DAYLIGHT {
            let computed = sky(elevation, turbidity, kind);
            // Rings of the sun's glow, and the horizon's bend, are seen to a hundred-thousandth.
            let [skylight, sun] = [computed.illuminance(800), computed.sun()];
            assert!((skylight / by_sky - 1.0).abs() < 1e-5, "{kind} {elevation}°: {skylight} {by_sky}");
            assert!((sun / by_sun - 1.0).abs() < 1e-6, "sun of {kind} {elevation}°: {sun} {by_sun}");
        }
    }
}
