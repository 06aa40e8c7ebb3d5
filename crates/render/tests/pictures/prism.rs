//! By how much a prism turns light of each wavelength, against Snell's law and Cauchy's equation.

use super::common::judge::{NITS_PER_UNIFORM, assert_near};
use super::common::shapes::{Mesh, mesh_light, model};
use super::common::text::{flat_camera, grey, medium, scene_file, settings, specular};
use super::common::{Measured, measure, scene};
use std::f64::consts::PI;

const A: f64 = 1.6;
/// µm².
const B: f64 = 0.0141;
/// The apex, and the angle to the normal at which the camera's axis meets the first face: about that of least
/// deviation.
const APEX: f64 = PI / 3.0;
const INCIDENCE: f64 = 0.98;
/// Half the angle under which the lamp is seen.
const HALF: f64 = 1.5e-3;
/// The lamp shines in a band this wide, nm, over which the deviation changes by far less than the lamp's width.
const BAND: f64 = 2.0;
const RADIANCE: f64 = 1e6;

fn index(nm: f64) -> f64 {
    A + B / (nm * nm * 1e-6)
}

/// Snell at both faces: incidence, refraction, incidence inside, refraction outside.
fn angles(n: f64) -> [f64; 4] {
    let first = (INCIDENCE.sin() / n).asin();
    let second = APEX - first;
    [INCIDENCE, first, second, (n * second.sin()).asin()]
}

fn deviation(n: f64) -> f64 {
    let [i, _, _, e] = angles(n);
    i + e - APEX
}

/// Transmittance of a face by the angles on both its sides.
fn transmittance(a: f64, b: f64) -> f64 {
    let s = (a - b).sin() / (a + b).sin();
    let p = (a - b).tan() / (a + b).tan();
    1.0 - 0.5 * (s * s + p * p)
}

/// A lamp of a narrow band far away, in a direction turned by so much from the camera's axis, seen through the prism.
fn seen(nm: f64, turned: f64, passes: u64) -> Measured {
    // The axis meets the middle of the first face, at the origin, along +x; light is turned to the base, towards +y.
    let face: f64 = INCIDENCE + PI / 2.0;
    let along = [face.cos(), face.sin()];
    let side = 0.5;
    let apex = along.map(|x| -x * side);
    // From the first face the second one is turned by the apex' angle.
    let (sin, cos) = APEX.sin_cos();
    let other = [
        apex[0] + 2.0 * side * (cos * along[0] + sin * along[1]),
        apex[1] + 2.0 * side * (-sin * along[0] + cos * along[1]),
    ];
    let near = along.map(|x| x * side);
    let ring = |z: f64| [near, other, apex].map(|p| [p[0], p[1], z]);
    let sides = [[0, 1, 2], [3, 5, 4], [0, 3, 4], [0, 4, 1], [1, 4, 5], [1, 5, 2], [2, 5, 3], [2, 3, 0]];
    let mut prism = Mesh { points: [ring(-0.5), ring(0.5)].concat(), triangles: sides.to_vec() };
    let volume: f64 = prism.triangles.iter().map(|t| t.map(|i| prism.points[i])).map(signed_volume).sum();
    if volume < 0.0 {
        prism = prism.inside_out();
    }
    let distance = 1e4;
    let (sin, cos) = turned.sin_cos();
    let at = |across: f64, z: f64| {
        let across = across * HALF * distance;
        [distance * cos - across * sin, distance * sin + across * cos, z * 0.02 * distance]
    };
    let lamp = Mesh::polygon(vec![at(-1.0, -1.0), at(-1.0, 1.0), at(1.0, 1.0), at(1.0, -1.0)]);
    let facing = signed_volume([lamp.points[0], lamp.points[1], lamp.points[2]]) < 0.0;
    let lamp = if facing { lamp } else { lamp.inside_out() };
    let band = format!(
        "<peak><peak_min>{}</peak_min><peak_width>{BAND}</peak_width><base_value>0</base_value>\
         <peak_value>{RADIANCE}</peak_value></peak>",
        nm - 0.5 * BAND
    );
    let scene = scene(&scene_file(&[
        settings(4, ""),
        flat_camera([-1.0, 0.0, 0.0], [1.0, 0.0, 0.0], 1e-5),
        grey("black", 0.0),
        medium("flint", 10, &format!("<basic><ior>{A}</ior><cauchy_b_coeff>{B}</cauchy_b_coeff></basic>")),
        specular("surface", "flint"),
        prism.text("prism", "surface"),
        model("prism"),
        lamp.text("lamp", "black"),
        mesh_light("lamp", &band, [0.0; 3], 1.0, ""),
    ]));
    measure(&scene, 16, passes)
}

fn signed_volume([a, b, c]: [[f64; 3]; 3]) -> f64 {
    a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0])
        + a[2] * (b[0] * c[1] - b[1] * c[0])
}

/// The closed form itself: 37.1808° is the least deviation of a prism of 60° and index 1.5.
#[test]
fn the_closed_form_has_its_known_value() {
    let least = 2.0 * (1.5 * (0.5 * APEX).sin()).asin() - APEX;
    assert!((least.to_degrees() - 37.1808).abs() < 1e-4);
}

#[test]
fn each_wavelength_is_turned_by_its_own_angle() {
    for nm in [460.0, 550.0, 640.0] {
        let n = index(nm);
        let [i, first, second, e] = angles(n);
        // Photometry of a narrow band, by the tabulated ȳ.
        let y_bar = match nm as u32 {
            460 => 0.06,
            550 => 0.994_950_1,
            _ => 0.175,
        };
        let seen_at = seen(nm, deviation(n), 3000);
        let through = transmittance(i, first) * transmittance(second, e);
        let expected = RADIANCE * NITS_PER_UNIFORM / 106.85692 * y_bar * BAND * through;
        assert_near(&format!("{nm} nm"), seen_at.luminance(), expected, 5e-3);
        // A lamp beside that place by three of its half widths, 0.26°, is not seen.
        for off in [-3.0, 3.0] {
            assert_eq!(seen(nm, deviation(n) + off * HALF, 300).luminance().mean(), 0.0, "{nm} nm, {off}");
        }
    }
    // Blue is turned further than red, by 4.6 degrees here.
    let spread = (deviation(index(460.0)) - deviation(index(640.0))).to_degrees();
    assert!(spread > 3.0 && spread < 6.0, "{spread}");
}
