//! Dispersion by Cauchy's equation, n = A + B/λ².

use super::super::change::changed;
use super::super::check::{Check, PATH};
use super::super::shapes::{Mesh, Point, add, dot, mesh_light, model, sub, unit};
use super::super::text::{background, grey, medium, specular};
use super::glass::fresnel;
use super::{AROUND, colour, looking};

const GROUP: &str = "Dispersion";
/// A, and B in µm²: of a glass, made stronger.
const INDEX: (f64, f64) = (1.5, 0.02);
/// Width of bands of light, nm.
const BAND_NM: f64 = 1.0;

fn index(nm: f64) -> f64 {
    INDEX.0 + INDEX.1 / (nm * 1e-3).powi(2)
}

fn glass(transparent: bool) -> String {
    let (a, b) = INDEX;
    let kind = format!("<basic><ior>{a}</ior><cauchy_b_coeff>{b}</cauchy_b_coeff></basic>");
    let surface = specular("m", "g");
    let surface = if transparent { surface } else { changed(&surface, ">true</tr", ">false</tr") };
    medium("g", 10, &kind) + &surface
}

/// Light of a band.
fn band(nm: f64) -> String {
    format!(
        "<peak><peak_min>{}</peak_min><peak_width>{BAND_NM}</peak_width><base_value>0</base_value><peak_value>{}</peak_value></peak>",
        nm - 0.5 * BAND_NM,
        1e3 * AROUND
    )
}

/// Luminance of that light, of which a share reaches the eye at each wavelength, in cd/m².
fn luminance(nm: f64, share: impl Fn(f64) -> f64) -> f64 {
    let radiance = 1e3 * AROUND * 1e-9;
    colour::tristimulus(nm - 0.5 * BAND_NM, nm + 0.5 * BAND_NM, |nm| radiance * share(nm))[1]
}

/// All of them.
pub fn checks() -> Vec<Check> {
    [450.0, 650.0].map(mirror).into_iter().chain([450.0, 550.0, 650.0].map(prism)).collect()
}

/// Glass that lets nothing through, seen along its normal.
fn mirror(nm: f64) -> Check {
    let sheet = Mesh::square(100.0, 0.0).text("sheet", "m") + &model("sheet");
    let parts = [glass(false), sheet, background(&band(nm))];
    let scene = looking([0.0, 0.0, 20.0], [0.0, 0.0, -1.0], 1e-4, "", &parts);
    let about =
        format!("((n − 1) / (n + 1))² with n = A + B/λ² = {:.5}, in a band of {BAND_NM} nm.", index(nm));
    Check::new(GROUP, format!("mirror of flint at {nm} nm"), about, scene)
        .unit(luminance(nm, |_| 1.0))
        .is(luminance(nm, |nm| fresnel(1.0, index(nm))) / luminance(nm, |_| 1.0), 0.0)
        .by(PATH)
        .effort(1024, 5e-3)
        .quickly(256)
}

/// Of the prism: its angle, and the distance of its first face, which looks at the camera.
const ANGLE: f64 = 30.0;
const NEAR: f64 = 1.0;
/// Distance of the lamp, and the edge that it has to its left: near the middle of the picture at 550 nm. Its right edge is
/// beside the picture, and left of where light goes that both faces have reflected first.
const FAR: f64 = 20.0;
const EDGE: f64 = 7.45;
const END: f64 = 11.0;
/// Half the width of the picture at distance 1.
const TANGENT: f64 = 0.05;

/// A prism before a lamp with an edge, which each wavelength sees elsewhere.
fn prism(nm: f64) -> Check {
    let high = 2.0 * ANGLE.to_radians().tan();
    let ends = |z: f64| [[-1.0, NEAR, z], [1.0, NEAR, z], [1.0, NEAR + high, z]];
    let triangles = [[0, 2, 1], [3, 4, 5], [0, 1, 4], [0, 4, 3], [1, 2, 5], [1, 5, 4], [2, 0, 3], [2, 3, 5]];
    let prism = Mesh { points: [ends(-1.0), ends(1.0)].concat(), triangles: triangles.to_vec() };
    let lamp = Mesh::polygon(
        [[EDGE, -20.0], [END, -20.0], [END, 20.0], [EDGE, 20.0]].map(|[x, z]| [x, FAR, z]).to_vec(),
    );
    let parts = [
        glass(true) + &grey("lamp", 0.0),
        prism.text("prism", "m") + &model("prism"),
        lamp.text("lamp", "lamp") + &mesh_light("lamp", &band(nm), [0.0; 3], 1.0, ""),
    ];
    let scene = looking([0.0; 3], [0.0, 1.0, 0.0], TANGENT, "", &parts);
    let all = luminance(nm, |_| 1.0);
    let value = through_prism(index(nm));
    let about = format!(
        "Rays refracted by both faces of a prism of {ANGLE}°, n = {:.5}, to a lamp with an edge, each with Fresnel's transmittances: \
         by quadrature over the picture.",
        index(nm)
    );
    Check::new(GROUP, format!("prism at {nm} nm"), about, scene)
        .unit(all)
        .is(value, 0.0)
        .by(PATH)
        .effort(512, 1e-2)
}

/// The mean of a picture through the prism.
fn through_prism(n: f64) -> f64 {
    // Columns by the thousand: the edge, which is bent, runs through one of them in each row.
    const PLACES: [i32; 2] = [8_000, 128];
    let place = |i: i32, n: i32| TANGENT * (2.0 * (f64::from(i) + 0.5) / f64::from(n) - 1.0);
    let seen = |i: i32, j: i32| {
        let ray = unit([place(i, PLACES[0]), 1.0, place(j, PLACES[1])]);
        seen_through_prism(ray, n)
    };
    let sum: f64 = (0..PLACES[0]).flat_map(|i| (0..PLACES[1]).map(move |j| seen(i, j))).sum();
    sum / f64::from(PLACES[0] * PLACES[1])
}

fn seen_through_prism(ray: Point, n: f64) -> f64 {
    let (s, c) = ANGLE.to_radians().sin_cos();
    let entry = ray.map(|x| x * NEAR / ray[1]);
    let inside = refracted(ray, [0.0, 1.0, 0.0], 1.0 / n);
    // The second face passes (-1, NEAR), and looks up and to the left.
    let normal = [-s, c, 0.0];
    let way = dot(sub([-1.0, NEAR, 0.0], entry), normal) / dot(inside, normal);
    let exit = add(entry, inside.map(|x| x * way));
    let out = refracted(inside, normal, n);
    let lit = (EDGE..END).contains(&(exit[0] + out[0] * (FAR - exit[1]) / out[1]));
    f64::from(u8::from(lit)) * (1.0 - fresnel(ray[1], n)) * (1.0 - fresnel(dot(out, normal), n))
}

/// Snell's law: a unit direction that passes a surface whose normal it goes along, by the quotient of the indices before and
/// behind.
fn refracted(d: Point, normal: Point, quotient: f64) -> Point {
    let along = dot(d, normal);
    let behind = (1.0 - quotient * quotient * (1.0 - along * along)).sqrt();
    [0, 1, 2].map(|k| quotient * d[k] + (behind - quotient * along) * normal[k])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Straight through, the sines are in the proportion of the index, and the edge is in the picture at all wavelengths.
    #[test]
    fn prisms_bend_light() {
        let (s, c) = ANGLE.to_radians().sin_cos();
        let out = refracted([0.0, 1.0, 0.0], [-s, c, 0.0], 1.5);
        let sine = (1.0 - dot(out, [-s, c, 0.0]).powi(2)).sqrt();
        assert!((sine - 1.5 * s).abs() < 1e-12 && out[0] > 0.0);
        let shown = [450.0, 550.0, 650.0].map(|nm| through_prism(index(nm)));
        assert!(shown[0] > shown[1] + 0.1 && shown[1] > shown[2] + 0.05 && shown[2] > 0.1, "{shown:?}");
        assert!(shown[0] < 0.8, "{shown:?}");
    }
}
