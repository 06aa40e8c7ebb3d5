//! Sun, sky and lamps of measured distributions.

use std::f64::consts::PI;

use super::super::check::{Check, TECHNIQUES};
use super::super::shapes::{Mesh, model, sub};
use super::super::text::grey;
use super::looking;

const GROUP: &str = "Sky and lamps";
const ALBEDO: f64 = 0.5;

/// Elevation of the sun in degrees, turbidity, model; illuminance (lx) of a level surface by the sky and across the sun's
/// direction by the sun, by the models' published tables in another program, to 5 digits.
const DAYLIGHT: [(f64, f64, &str, f64, f64); 4] = [
    (30.0, 2.0, "hosek", 11_667.0, 79_785.0),
    (60.0, 5.0, "hosek", 22_375.0, 82_312.0),
    (30.0, 2.0, "preetham", 24_188.4, 81_928.0),
    (60.0, 6.0, "preetham", 56_074.4, 62_921.0),
];

/// Elevation, turbidity and model; luminance of the zenith (cd/m²), likewise.
const ZENITH: [(f64, f64, &str, f64); 2] = [(30.0, 2.0, "hosek", 1760.3), (45.0, 4.0, "preetham", 10_004.69)];

fn floor(name: String, about: &str, light: &str, lux: f64, relative: f64) -> Check {
    let eye = [3.0, 1.0, 1.2];
    let ground = Mesh::square(4.0, 0.0).text("ground", "ground") + &model("ground");
    let scene =
        looking(eye, sub([0.0; 3], eye), 2e-3, "", &[grey("ground", ALBEDO), ground, light.to_owned()]);
    let value = ALBEDO * lux / PI;
    Check::new(GROUP, name, about, scene).is(value, relative * value).by(TECHNIQUES)
}

/// All of them.
pub fn checks() -> Vec<Check> {
    let mut checks = vec![];
    for (elevation, turbidity, kind, sky, sun) in DAYLIGHT {
        let (s, c) = f64::to_radians(elevation).sin_cos();
        let light = format!(
            "<skylight><sundir>{} {} {s}</sundir><turbidity>{turbidity}</turbidity><model>{kind}</model></skylight>",
            0.6 * c,
            -0.8 * c
        );
        let name = format!("{kind}, sun {elevation}° high, turbidity {turbidity}");
        let about = "Illuminance by sky and sun, integrated from the model's tables by another program to five digits.";
        checks.push(floor(name, about, &light, sky + sun * s, 1e-3));
    }
    for (elevation, turbidity, kind, luminance) in ZENITH {
        let (s, c) = f64::to_radians(elevation).sin_cos();
        let light = format!(
            "<skylight><sundir>{c} 0 {s}</sundir><turbidity>{turbidity}</turbidity><model>{kind}</model></skylight>"
        );
        let scene = looking([0.0; 3], [0.0, 0.0, 1.0], 2e-3, "", &[light]);
        let name = format!("zenith, {kind}, sun {elevation}° high");
        let about = "Luminance of the zenith, of the model's formula by another program to five digits.";
        checks.push(Check::new(GROUP, name, about, scene).is(luminance, 5e-4 * luminance).by(TECHNIQUES));
    }
    let light = "<skylight><sundir>0 3 4</sundir><turbidity>2</turbidity><extra_atmospheric>true</extra_atmospheric></skylight>";
    checks.push(floor(
        "sun in space".into(),
        "ASTM G173: 133.1 klx across the sun's direction.",
        light,
        0.8 * 1.331e5,
        5e-4,
    ));
    checks
}
