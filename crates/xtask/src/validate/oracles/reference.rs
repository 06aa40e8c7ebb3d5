//! Scenes that Mitsuba 3.9.1 rendered once to less than a thousandth, 32 × 32 pixels with a box filter.

use super::super::check::{Check, Quantity, Renderer, TECHNIQUES, THREE, Target};
use super::super::shapes::{Mesh, Point, mesh_light, model, sub};
use super::super::statistics::Estimate;
use super::super::text::{
    ONE_PIXEL, background, basic, flat_camera, grey, henyey_greenstein, medium, scattering, scene_file,
    settings, specular, sphere, uniform,
};
use super::metal::constant_nk;
use super::{AROUND, AROUND_NITS, material};

const GROUP: &str = "Stored pictures of Mitsuba";
const SIDE: u32 = 32;
/// The middle 4 × 4 pixels.
const MIDDLE: [usize; 4] = [14, 18, 14, 18];

struct Stored {
    name: &'static str,
    about: &'static str,
    eye: Point,
    target: Point,
    /// Horizontal and vertical angle of the view.
    degrees: f64,
    /// Mean and its standard error, of the picture and of its middle; the error of an exact number is 0.
    mean: [(f64, f64); 2],
    /// Whether the middle is quiet enough to be judged.
    judges_middle: bool,
    samples: u32,
    parts: Vec<String>,
}

impl Stored {
    fn check(self) -> Check {
        let forwards = sub(self.target, self.eye);
        let tangent = (0.5 * self.degrees).to_radians().tan();
        let head = [settings(SIDE, ONE_PIXEL), flat_camera(self.eye, forwards, tangent)];
        let check =
            Check::new(GROUP, self.name, self.about, scene_file(&[head.to_vec(), self.parts].concat()));
        let target = |(mean, error): (f64, f64)| match error {
            0.0 => Target::Value(mean, 1e-6),
            // Enough passes that its error is known as well as of a normal distribution.
            _ => Target::Sampled(Estimate { count: 1000, mean, error }),
        };
        // The middle by Metropolis sampling, 7 % in the quick form, is then seen to 1.7 %.
        let fine = 5 * self.samples;
        let check = check.unit(AROUND_NITS).effort(self.samples, 1e-1).in_full(fine, 2e-2);
        let check = check.row("picture", Quantity::Y, None, target(self.mean[0]));
        if !self.judges_middle {
            return check;
        }
        check.row("middle", Quantity::Y, Some(MIDDLE), target(self.mean[1]))
    }
}

/// All of them.
pub fn checks() -> Vec<Check> {
    let fog = |ior: f64| {
        let inside = scattering(&uniform(2.0), &henyey_greenstein(0.6));
        medium("g", 10, &basic(ior, &uniform(0.5), &inside)) + &specular("m", "g")
    };
    let absorbing = medium("g", 10, &basic(1.5, &uniform(1.0), "")) + &specular("m", "g");
    let in_light = |name, about, mean, samples, medium: String| Stored {
        name,
        about,
        eye: [0.0, -5.0, 0.0],
        target: [0.0; 3],
        degrees: 20.0,
        mean,
        judges_middle: true,
        samples,
        parts: vec![medium, sphere([0.0; 3], 1.0, "m"), background(&uniform(AROUND))],
    };
    let fogs =
        "Extinction 2.5/m, albedo 0.8, Henyey and Greenstein with g = 0.6, in a ball of 1 m in even light.";
    let mut checks = vec![
        open_box().check().by(THREE).longer(Renderer::Metropolis, 4),
        caustic().check().by(&THREE[1..]).longer(Renderer::Metropolis, 2),
        in_light("ball of fog", fogs, [(0.563_103, 5e-5), (0.432_291, 3.93e-4)], 64, fog(1.0))
            .check()
            .by(TECHNIQUES),
        in_light("fog in glass", fogs, [(0.441_540, 5.9e-5), (0.367_953, 6.05e-4)], 128, fog(1.33))
            .check()
            .by(TECHNIQUES),
    ];
    let about = "R + (1 − R)² e / (1 − R e) for each ray, by quadrature of 2000 × 2000 rays.";
    checks.push(
        in_light("absorbing glass ball", about, [(0.274_927, 0.0), (0.165_860, 0.0)], 64, absorbing)
            .check()
            .by(TECHNIQUES),
    );
    checks.push(metal(in_light));
    checks
}

/// A mirroring ball of metal. Mitsuba's picture is known to 1e-6, of which the middle is all but exact.
fn metal(in_light: impl Fn(&'static str, &'static str, [(f64, f64); 2], u32, String) -> Stored) -> Check {
    let kind = "<phong><nk_data>metal.nk</nk_data><exponent>1e12</exponent></phong>";
    let about = "A smooth ball of metal, n = 0.4241, k = 2.4721, in even light.";
    let mean = [(0.809_084, 1e-6), (0.791_580, 5e-7)];
    let mut check =
        in_light("smooth metal ball", about, mean, 64, material("m", kind)).check().by(TECHNIQUES);
    check.files.push(("metal.nk".to_owned(), constant_nk(0.4241, 2.4721)));
    check
}

/// A box open at the front, with a lamp below its ceiling.
fn open_box() -> Stored {
    let quad = |points: [Point; 4], name: &str, material: &str| {
        Mesh::polygon(points.to_vec()).text(name, material) + &model(name)
    };
    let (a, b) = (-1.0, 1.0);
    let lamp = Mesh::square(0.25, 0.0).inside_out().text("lamp", "black");
    let parts = vec![
        grey("half", 0.5) + &grey("bright", 0.7) + &grey("black", 0.0),
        quad([[a, a, 0.0], [b, a, 0.0], [b, b, 0.0], [a, b, 0.0]], "floor", "half"),
        quad([[a, a, 2.0], [a, b, 2.0], [b, b, 2.0], [b, a, 2.0]], "ceiling", "half"),
        quad([[a, a, 0.0], [a, b, 0.0], [a, b, 2.0], [a, a, 2.0]], "left", "bright"),
        quad([[b, a, 0.0], [b, a, 2.0], [b, b, 2.0], [b, b, 0.0]], "right", "bright"),
        quad([[a, b, 0.0], [b, b, 0.0], [b, b, 2.0], [a, b, 2.0]], "back", "bright"),
        lamp + &mesh_light("lamp", &uniform(10.0 * AROUND), [0.0, 0.0, 1.99], 1.0, ""),
    ];
    Stored {
        name: "open box",
        about: "Floor and ceiling of albedo 0.5, other walls 0.7, a lamp of 0.5 m × 0.5 m and radiance 10.",
        eye: [0.0, -4.0, 1.0],
        target: [0.0, 0.0, 1.0],
        degrees: 36.0,
        mean: [(0.223_427, 6.3e-5), (0.205_877, 8.4e-5)],
        judges_middle: true,
        samples: 32,
        parts,
    }
}

/// A glass ball between a lamp and the floor.
fn caustic() -> Stored {
    let glass = medium("g", 10, &basic(1.5, &uniform(0.0), "")) + &specular("m", "g");
    let parts = vec![
        grey("half", 0.5) + &grey("black", 0.0) + &glass,
        Mesh::square(2.0, 0.0).text("floor", "half") + &model("floor"),
        sphere([0.0, 0.0, 0.8], 0.5, "m"),
        Mesh::disc(0.3, 2000).text("lamp", "black")
            + &mesh_light("lamp", &uniform(50.0 * AROUND), [0.0, 0.0, 3.0], 1.0, ""),
    ];
    Stored {
        name: "caustic",
        about: "A glass ball, n = 1.5, between a lamp of radiance 50 and a matt floor.",
        eye: [0.0, -5.0, 2.5],
        target: [0.0, 0.0, 0.3],
        degrees: 30.0,
        mean: [(0.110_569, 6.1e-5), (0.051_045, 7.34e-4)],
        // Light that passes glass twice after the floor: rare and bright, in Mitsuba's picture too.
        judges_middle: false,
        samples: 48,
        parts,
    }
}
