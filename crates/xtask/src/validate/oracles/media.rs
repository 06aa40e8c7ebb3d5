//! Light in media, against closed forms and quadrature.

use super::super::check::{Check, PATH, TECHNIQUES, THREE};
use super::super::shapes::{Mesh, model};
use super::super::text::{basic, henyey_greenstein, medium, scattering, specular, sphere, uniform};
use super::{AROUND_NITS, SIDE, in_even_light, integral};

const GROUP: &str = "Media";

/// A medium without surface, of coefficients in 1/m and a mean cosine.
fn fog(absorption: f64, coefficient: f64, g: f64) -> String {
    let phase = if g == 0.0 { "<uniform/>".to_owned() } else { henyey_greenstein(g) };
    medium("g", 10, &basic(1.0, &uniform(absorption), &scattering(&uniform(coefficient), &phase)))
        + &specular("m", "g")
}

/// All of them.
pub fn checks() -> Vec<Check> {
    [half_spaces(), vec![single_scattering()]].concat()
}

/// A half space that scatters evenly, in even light: what it shows in a direction is, by reciprocity, the flux that it
/// reflects of a beam from there.
fn half_spaces() -> Vec<Check> {
    let about = "A half space of fog in even light shows its plane albedo, of Chandrasekhar's H function by quadrature (seven digits). \
                 It is 40 mean free paths deep here, and as wide that its sides are not seen.";
    let mut checks = vec![];
    for (albedo, cosine, value, samples) in [
        (0.5, 1.0, 0.115_225_9, 512),
        (0.9, 1.0, 0.414_947_5, 256),
        (0.9, 0.5, 0.507_938_9, 256),
        (0.99, 1.0, 0.752_720_7, 128),
    ] {
        let slab = Mesh::cube(1.0).placed(
            [2000.0, 0.0, 0.0, 0.0, 20.0, 0.0, 0.0, 0.0, 2000.0],
            1.0,
            [0.0, 20.0, 0.0],
        );
        let parts = [fog(1.0 - albedo, albedo, 0.0), slab.text("slab", "m") + &model("slab")];
        let sine = (1.0f64 - cosine * cosine).sqrt();
        let pos = [-5.0 * sine, -5.0 * cosine, 0.0];
        let scene = in_even_light(pos, 1e-3, &parts);
        let straight = "<forwards>0 1 0</forwards>";
        let scene = scene.replace(straight, &format!("<forwards>{sine} {cosine} 0</forwards>"));
        let name = format!("half space, albedo {albedo}, cosine {cosine}");
        let check = Check::new(GROUP, name, about, scene).unit(AROUND_NITS);
        let renderers = if albedo == 0.9 && cosine == 1.0 { TECHNIQUES } else { PATH };
        checks.push(check.is(value, 1e-6 * value).by(renderers).effort(samples, 1e-2));
    }
    checks
}

/// Light scattered once in a ball of fog, seen along its diameter, by quadrature over the way and over all
/// directions, each of which leaves the ball after a way of its own.
fn single_scattering() -> Check {
    let (absorption, coefficient, g, radius) = (0.4, 1.1, 0.6, 0.5);
    let extinction = absorption + coefficient;
    let scattered = |x: f64| {
        let lit = |mu: f64| {
            let s = -x * mu + (radius * radius - x * x * (1.0 - mu * mu)).sqrt();
            let phase = 0.5 * (1.0 - g * g) / f64::powf(1.0 + g * g - 2.0 * g * mu, 1.5);
            phase * (-extinction * s).exp()
        };
        coefficient * (-extinction * (x + radius)).exp() * integral(-1.0, 1.0, 2000, lit)
    };
    let value = (-extinction * 2.0 * radius).exp() + integral(-radius, radius, 2000, scattered);
    let parts = [fog(absorption, coefficient, g), sphere([0.0; 3], radius, "m")];
    let deep = in_even_light([0.0, -5.0, 0.0], 1e-3, &parts);
    let settings = format!("<width>{SIDE}</width>");
    let scene = deep.replace(&settings, &format!("{settings}<max_depth>1</max_depth>"));
    let about = "Paths of at most one scattering event along the diameter of a ball, Henyey and Greenstein with g = 0.6: quadrature.";
    // The way bends away from the diameter by less than this over the patch.
    Check::new(GROUP, "scattered once", about, scene)
        .unit(AROUND_NITS)
        .is(value, 1e-5)
        .by(THREE)
        .effort(512, 1e-2)
}
