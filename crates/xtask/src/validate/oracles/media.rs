//! Light in media, against closed forms and quadrature.

use std::f64::consts::PI;

use super::super::change::changed;
use super::super::check::{Check, PATH, Quantity, TECHNIQUES, THREE, Target};
use super::super::shapes::{Mesh, mesh_light, model};
use super::super::text::{basic, grey, henyey_greenstein, medium, scattering, specular, sphere, uniform};
use super::colour::tristimulus;
use super::{AROUND, AROUND_NITS, NITS_PER_UNIFORM, SIDE, in_even_light, integral, looking};

const GROUP: &str = "Media";

/// A medium without surface, of coefficients in 1/m and a mean cosine.
fn fog(absorption: f64, coefficient: f64, g: f64) -> String {
    let phase = if g == 0.0 { "<uniform/>".to_owned() } else { henyey_greenstein(g) };
    medium("g", 10, &basic(1.0, &uniform(absorption), &scattering(&uniform(coefficient), &phase)))
        + &specular("m", "g")
}

/// All of them.
pub fn checks() -> Vec<Check> {
    [half_spaces(), vec![single_scattering(), lamp_in_fog(), coloured_cube()], slabs()].concat()
}

/// Albedo of one scattering, cosine of the direction; 1 − √(1 − ϖ) H(μ) (Chandrasekhar, Radiative Transfer, 1960, chapter
/// V), which a test computes anew; samples.
const HALF_SPACES: [(f64, f64, f64, u32); 4] = [
    (0.5, 1.0, 0.115_225_9, 640),
    (0.9, 1.0, 0.414_947_5, 384),
    (0.9, 0.5, 0.507_938_9, 256),
    (0.99, 1.0, 0.752_720_7, 128),
];

/// A half space that scatters evenly, in even light: what it shows in a direction is, by reciprocity, the flux that it
/// reflects of a beam from there.
fn half_spaces() -> Vec<Check> {
    let about = "A half space of fog in even light shows its plane albedo, of Chandrasekhar's H function by quadrature (seven digits). \
                 It is 100 mean free paths deep here, so that less than a millionth comes through it, and as wide that its sides are not seen.";
    let mut checks = vec![];
    for (albedo, cosine, value, samples) in HALF_SPACES {
        let slab = Mesh::cube(1.0).placed(
            [2000.0, 0.0, 0.0, 0.0, 50.0, 0.0, 0.0, 0.0, 2000.0],
            1.0,
            [0.0, 50.0, 0.0],
        );
        let parts = [fog(1.0 - albedo, albedo, 0.0), slab.text("slab", "m") + &model("slab")];
        let sine = (1.0f64 - cosine * cosine).sqrt();
        let pos = [-5.0 * sine, -5.0 * cosine, 0.0];
        let scene = in_even_light(pos, 1e-3, &parts);
        let straight = "<forwards>0 1 0</forwards>";
        let scene = changed(&scene, straight, &format!("<forwards>{sine} {cosine} 0</forwards>"));
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
    let scene = changed(&deep, &settings, &format!("{settings}<max_depth>1</max_depth>"));
    let about = "Paths of at most one scattering event along the diameter of a ball, Henyey and Greenstein with g = 0.6: quadrature.";
    // The way bends away from the diameter by less than this over the patch.
    Check::new(GROUP, "scattered once", about, scene)
        .unit(AROUND_NITS)
        .is(value, 1e-5)
        .by(THREE)
        .effort(512, 1e-2)
}

/// A small ball of a lamp in fog that fills all, seen by a ray that passes half a metre beside it: light scattered once, by quadrature over
/// that ray. Towards each point of it the lamp has the intensity of its own triangles that show their front.
fn lamp_in_fog() -> Check {
    const RADIUS: f64 = 2e-3;
    const RADIANCE: f64 = 1.0e10;
    let (absorption, coefficient, beside, before, end) = (0.1, 0.2, 0.5, 2.0, 20.0);
    let extinction = absorption + coefficient;
    let lamp = Mesh::ball(2).placed([1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0], RADIUS, [0.0; 3]);
    let scattered = |t: f64| {
        let way = f64::hypot(beside, t);
        let lit = lamp.irradiance([0.0, t, beside], [0.0, -t / way, -beside / way]);
        coefficient / (4.0 * PI) * lit * (-extinction * (t + before + way)).exp()
    };
    let value = RADIANCE * NITS_PER_UNIFORM * integral(-before, end, 20_000, scattered);
    let parts = [
        fog(absorption, coefficient, 0.0) + &grey("lamp", 0.0),
        sphere([0.0, 0.0, 0.0], end, "m"),
        lamp.text("lamp", "lamp") + &mesh_light("lamp", &uniform(RADIANCE), [0.0; 3], 1.0, ""),
    ];
    let seen = looking([0.0, -before, beside], [0.0, 1.0, 0.0], 1e-4, "<max_depth>1</max_depth>", &parts);
    let about = "∫ σ_s / 4π · E(t) e^(−σ_t (t − t₀ + d(t))) dt along a ray, with the illuminance E by a lamp of 2 mm at the distance d(t), half a metre \
                 at least; paths of one scattering event.";
    Check::new(GROUP, "a small lamp in fog", about, seen)
        .is(value, 1e-6 * value)
        .by(TECHNIQUES)
        .effort(256, 2e-2)
}

/// A cube that absorbs each wavelength differently, behind surfaces that are not there.
fn coloured_cube() -> Check {
    // 1/m at 360 to 830 nm in equal steps, straight between.
    const ABSORPTION: [f64; 6] = [40.0, 2.0, 25.0, 1.0, 12.0, 12.0];
    const SIDE_M: f64 = 0.1;
    let list = ABSORPTION.map(|a| a.to_string()).join(" ");
    let spectrum = format!(
        "<regular_tabulated><start_wavelength>360e-9</start_wavelength><end_wavelength>830e-9</end_wavelength>\
         <num_values>{}</num_values><values>{list}</values></regular_tabulated>",
        ABSORPTION.len()
    );
    let absorption = |nm: f64| {
        let place = (nm - 360.0) / 94.0;
        let i = (place as usize).min(ABSORPTION.len() - 2);
        ABSORPTION[i] + (ABSORPTION[i + 1] - ABSORPTION[i]) * (place - i as f64)
    };
    let cube = Mesh::cube(0.5 * SIDE_M).text("cube", "m") + &model("cube");
    let glass = medium("g", 10, &basic(1.0, &spectrum, "")) + &specular("m", "g");
    let scene = in_even_light([0.0, -5.0, 0.0], 1e-3, &[glass, cube]);
    let [x, y, z] = tristimulus(360.0, 830.0, |nm| AROUND * 1e-9 * (-absorption(nm) * SIDE_M).exp());
    let about = "Beer and Lambert at each wavelength, exp(−σ(λ) d), under the observer by quadrature. Light of all wavelengths goes one way.";
    let check =
        Check::new(GROUP, "coloured cube", about, scene).unit(AROUND_NITS).by(TECHNIQUES).effort(256, 5e-3);
    // Ways aslant are longer by at most a millionth.
    let exactly = |value: f64| Target::Value(value, 2e-6 * value);
    check
        .row("luminance", Quantity::Y, None, exactly(y / AROUND_NITS))
        .row("x / y", Quantity::XOverY, None, exactly(x / y))
        .row("z / y", Quantity::ZOverY, None, exactly(z / y))
}

/// Thickness of the slab, metres.
const THICK: f64 = 0.1;
/// Height of the lamp over the slab, metres: over a thickness its light changes by 2·10⁻⁶.
const HIGH: f64 = 1e5;
/// Spectral radiance of the lamp, W m^-3 sr^-1, and its side in metres, of which light differs in direction by a thousandth.
const LAMP: (f64, f64) = (1.0e11, 100.0);

/// A slab of fog without surface in parallel light, seen from both sides: light that is scattered once, in closed form
/// (Chandrasekhar, Radiative Transfer, 1960, section 7).
fn slabs() -> Vec<Check> {
    let mut checks = vec![];
    for (lit, seen, depth, albedo) in
        [(1.0, 1.0, 0.1, 1.0), (1.0, 0.5, 1.0, 0.8), (0.5, 0.8, 2.0, 0.5), (0.8, 0.8, 1.0, 0.9f64)]
    {
        for (behind, words) in [(false, "lit side"), (true, "far side")] {
            if behind && lit == 1.0 && seen == 1.0 {
                // There the lamp itself would be seen.
                continue;
            }
            let value = if behind { transmitted(lit, seen, depth) } else { reflected(lit, seen, depth) };
            let about = "A slab of fog in parallel light, scattered once: ϖ/4π μ₀/(μ₀ ± μ) times what is left of the light on both ways.";
            let name = format!("slab of depth {depth}, lit at cosine {lit}, {words} at {seen}");
            let check = Check::new(GROUP, name, about, slab(lit, seen, depth, albedo, behind));
            let unit = LAMP.0 * NITS_PER_UNIFORM * (LAMP.1 / HIGH).powi(2);
            let value = albedo / (4.0 * PI) * value;
            checks.push(
                check.unit(unit).is(value, 2e-6 * value).by(TECHNIQUES).effort(64, 1e-2).in_full(512, 1e-2),
            );
        }
    }
    checks
}

fn reflected(lit: f64, seen: f64, depth: f64) -> f64 {
    lit / (lit + seen) * (1.0 - (-depth * (1.0 / lit + 1.0 / seen)).exp())
}

fn transmitted(lit: f64, seen: f64, depth: f64) -> f64 {
    if lit == seen {
        return depth / seen * (-depth / seen).exp();
    }
    lit / (lit - seen) * ((-depth / lit).exp() - (-depth / seen).exp())
}

/// The slab lies aslant under a lamp right above, and is seen across the plane of the light.
fn slab(lit: f64, seen: f64, depth: f64, albedo: f64, behind: bool) -> String {
    let (c, s) = (lit, (1.0 - lit * lit).sqrt());
    let turn = [c, 0.0, s, 0.0, 1.0, 0.0, -s, 0.0, c];
    let flat = Mesh::cube(1.0).placed([20.0, 0.0, 0.0, 0.0, 20.0, 0.0, 0.0, 0.0, 0.5 * THICK], 1.0, [0.0; 3]);
    let mesh = flat.placed(turn, 1.0, [0.0; 3]);
    let side = if behind { -1.0 } else { 1.0 };
    let aside = (1.0 - seen * seen).sqrt();
    let eye = [side * s * seen * 3.0, aside * 3.0, side * c * seen * 3.0];
    let extinction = depth / THICK;
    let spectrum = uniform(LAMP.0);
    let lamp = format!(
        "<rectanglelight><pos>0 0 {HIGH}</pos><width>{w}</width><height>{w}</height><spectrum>{spectrum}</spectrum></rectanglelight>",
        w = LAMP.1
    );
    let parts = [
        fog(extinction * (1.0 - albedo), extinction * albedo, 0.0),
        mesh.text("slab", "m") + &model("slab"),
        lamp,
    ];
    looking(eye, eye.map(|x| -x), 1e-3, "<max_depth>1</max_depth>", &parts)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Chandrasekhar's equation of H in the form that converges fast (chapter V there): 1 / H(μ) = √(1 − ϖ) + ϖ/2 ∫ ν H(ν) / (μ + ν) dν.
    fn plane_albedo(albedo: f64, cosine: f64) -> f64 {
        const STEPS: usize = 1000;
        // By squares of even steps, since H bends like μ ln μ at 0.
        let nodes: Vec<[f64; 2]> = (0..STEPS)
            .map(|i| (i as f64 + 0.5) / STEPS as f64)
            .map(|v| [v * v, 2.0 * v / STEPS as f64])
            .collect();
        let root = (1.0 - albedo).sqrt();
        let h = |h: &[f64], mu: f64| {
            let parts = nodes.iter().zip(h).map(|([nu, width], h)| width * nu * h / (mu + nu));
            1.0 / (root + 0.5 * albedo * parts.sum::<f64>())
        };
        let mut table = vec![1.0; STEPS];
        for _ in 0..60 {
            table = nodes.iter().map(|[mu, _]| h(&table, *mu)).collect();
        }
        1.0 - root * h(&table, cosine)
    }

    #[test]
    fn half_spaces_show_what_chandrasekhars_equation_says() {
        for (albedo, cosine, value, _) in HALF_SPACES {
            let computed = plane_albedo(albedo, cosine);
            assert!((computed / value - 1.0).abs() < 1e-6, "{albedo} {cosine}: {computed} {value}");
        }
    }
}
