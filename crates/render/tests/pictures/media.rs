//! What light does in media and at their surfaces, against closed forms.

use super::common::judge::{NITS_PER_UNIFORM, assert_is, assert_near};
use super::common::shapes::{Mesh, model};
use super::common::text::{
    ONE_PIXEL, background, basic, flat_camera, grey, henyey_greenstein, medium, scattering, scene_file,
    settings, specular, sphere, uniform,
};
use super::common::{MODES, Measured, luminance_in_mode, measure, scene};
use indigo_scene::Scene;

/// Spectral radiance of the surroundings, W m^-3 sr^-1.
pub const AROUND: f64 = 3.0e4;

/// Objects before a camera that sees a width of ±`tangent`, in light that is the same from everywhere.
pub fn in_uniform_light(pos: [f64; 3], tangent: f64, parts: &[String]) -> Scene {
    let head =
        [settings(16, ONE_PIXEL), flat_camera(pos, [0.0, 1.0, 0.0], tangent), background(&uniform(AROUND))];
    scene(&scene_file(&[head.as_slice(), parts].concat()))
}

fn assert_luminance(what: &str, measured: &Measured, over_surroundings: f64) {
    assert_within(what, measured, over_surroundings, 1e-3);
}

fn assert_within(what: &str, measured: &Measured, over_surroundings: f64, tolerance: f64) {
    assert_is(what, measured.luminance(), AROUND * NITS_PER_UNIFORM * over_surroundings, tolerance);
}

fn clear(name: &str, precedence: u32, ior: f64) -> String {
    medium(name, precedence, &basic(ior, &uniform(0.0), ""))
}

fn absorbing(name: &str, precedence: u32, ior: f64, absorption: f64) -> String {
    medium(name, precedence, &basic(ior, &uniform(absorption), ""))
}

/// A box from -`half` to `half` of which the front looks out.
fn cube(half: f64, material: &str) -> String {
    Mesh::cube(half).text("cube", material) + &model("cube")
}

/// What is lost at one surface is gained at another: clear glass in even light cannot be seen.
#[test]
fn clear_glass_in_even_light_is_invisible() {
    for (name, object) in [
        ("ball", sphere([0.0; 3], 1.0, "glass")),
        ("box", cube(0.7, "glass")),
        ("hollow ball", sphere([0.0; 3], 1.0, "glass") + &sphere([0.0; 3], 0.8, "hollow")),
    ] {
        let glass =
            [clear("g", 10, 1.5), specular("glass", "g"), clear("a", 20, 1.0), specular("hollow", "a")];
        let mut scene = in_uniform_light([0.0, -5.0, 0.0], 0.21, &[glass.concat(), object.clone()]);
        for mode in MODES {
            let measured = luminance_in_mode(&mut scene, mode, 16, 64);
            assert_is(&format!("{name}, {mode}"), &measured, AROUND * NITS_PER_UNIFORM, 1e-3);
        }
    }
}

/// Beer and Lambert: e^(-σd), behind surfaces that are not there since the indices are equal.
#[test]
fn absorption_falls_off_with_the_exponential_of_the_way() {
    let parts = [absorbing("m", 10, 1.0, 10.0), specular("surface", "m"), cube(0.05, "surface")];
    let scene = in_uniform_light([0.0, -5.0, 0.0], 0.001, &parts);
    assert_luminance("10/m over 0.1 m", &measure(&scene, 8, 64), (-1.0f64).exp());
}

/// The same slantwise through a plate so large that rays leave its triangles by more than a hundredth of its thickness.
#[test]
fn the_way_through_a_wide_plate_is_not_shortened_by_rounding() {
    let (half, thickness, cos) = (300.0, 0.1, 0.5f64);
    let plate =
        Mesh::cube(1.0).placed([half, 0.0, 0.0, 0.0, half, 0.0, 0.0, 0.0, thickness / 2.0], 1.0, [0.0; 3]);
    let scene = scene(&scene_file(&[
        settings(8, ONE_PIXEL),
        flat_camera([0.0, 0.0, 2.0], [0.0, (1.0 - cos * cos).sqrt(), -cos], 1e-5),
        background(&uniform(AROUND)),
        absorbing("m", 10, 1.0, 10.0),
        specular("surface", "m"),
        plate.text("plate", "surface"),
        model("plate"),
    ]));
    let expected = (-10.0 * thickness / cos).exp();
    assert_luminance("10/m over 0.2 m", &measure(&scene, 16, 64), expected);
}

/// A plane-parallel plate seen straight on, with all reflections inside: R = ((η - 1)/(η + 1))², e = e^(-σd),
/// T = (1 - R)² e / (1 - R² e²); what is not let through is reflected or absorbed, and light comes from everywhere.
#[test]
fn a_plate_lets_through_what_all_its_reflections_leave() {
    for (ior, absorption, d, transmitted, reflected) in [
        (1.5, 0.0, 1.0, 0.923_076_923, 0.076_923_077),
        (1.5, 10.0, 0.1, 0.339_111_123, 0.044_990_080),
        (1.33, 5.0, 0.05, 0.748_052_302, 0.031_745_541),
    ] {
        let lamp = "<rectanglelight><pos>0 0 30</pos><width>60</width><height>60</height><spectrum>";
        let light = format!("{lamp}{}</spectrum></rectanglelight>", uniform(AROUND));
        let plate =
            Mesh::cube(1.0).placed([20.0, 0.0, 0.0, 0.0, 20.0, 0.0, 0.0, 0.0, d / 2.0], 1.0, [0.0; 3]);
        let of = |height: f64, down: f64| {
            let scene = scene(&scene_file(&[
                settings(8, ""),
                flat_camera([0.0, 0.0, height], [0.0, 0.0, down], 1e-3),
                absorbing("m", 10, ior, absorption),
                specular("surface", "m"),
                plate.text("plate", "surface"),
                model("plate"),
                light.clone(),
            ]));
            measure(&scene, 16, 400)
        };
        assert_luminance("through the plate", &of(-5.0, 1.0), transmitted);
        // Mirrored: the lamp lies behind the camera, and its back is black.
        assert_within("on the plate", &of(5.0, -1.0), reflected, 1.2e-2);
    }
}

/// An absorbing glass ball: for each ray R + (1 - R)² e / (1 - R e) with e = e^(-2 σ r cos t); the mean over
/// the middle 4 by 4 of 32 by 32 pixels by quadrature.
#[test]
fn an_absorbing_glass_ball_has_its_closed_form() {
    let parts = [absorbing("m", 10, 1.5, 1.0), specular("glass", "m"), sphere([0.0; 3], 1.0, "glass")];
    // The middle eighth of a field of 20 degrees.
    let scene = in_uniform_light([0.0, -5.0, 0.0], 10f64.to_radians().tan() / 8.0, &parts);
    assert_luminance("middle", &measure(&scene, 16, 800), 0.165_860);
}

/// A liquid that reaches into its glass, which displaces it there, ends where the glass ends.
#[test]
fn glass_displaces_the_liquid_that_overlaps_it() {
    let at = |y: f64, half: f64, name: &str, material: &str| {
        let m = Mesh::cube(1.0).placed([half, 0.0, 0.0, 0.0, half, 0.0, 0.0, 0.0, half], 1.0, [0.0, y, 0.0]);
        m.text(name, material) + &model(name)
    };
    let materials = specular("outside", "glass") + &specular("inside", "wine");
    // A box of glass from -0.5 to 0.5, and one of liquid from 0.1 to 0.7.
    let boxes = at(0.0, 0.5, "a", "outside") + &at(0.4, 0.3, "b", "inside");
    let seen = |glass: u32, wine: u32| {
        let media = absorbing("glass", glass, 1.5, 0.5) + &absorbing("wine", wine, 1.33, 3.0);
        let scene = in_uniform_light([0.0, -5.0, 0.0], 1e-3, &[media, materials.clone(), boxes.clone()]);
        measure(&scene, 16, 800)
    };
    // Straight through: three interfaces and two ways, with all reflections between them.
    let expected = layers(&[(1.0, 0.0), (1.5, 0.5), (1.33, 3.0 * 0.2), (1.0, 0.0)]);
    assert_luminance("glass before liquid", &seen(20, 10), expected);
    let expected = layers(&[(1.0, 0.0), (1.5, 0.5 * 0.6), (1.33, 3.0 * 0.6), (1.0, 0.0)]);
    assert_luminance("liquid before glass", &seen(10, 20), expected);
}

/// Light that comes straight out of a stack of layers, each an index and an optical depth, in surroundings that
/// shine from both sides: by adding layers from the back.
fn layers(stack: &[(f64, f64)]) -> f64 {
    let reflectance = |a: f64, b: f64| ((a - b) / (a + b)).powi(2);
    // Everything that is behind shows the radiance `back`, over η², and mirrors the share `mirrored`.
    let (mut shown, mut mirrored) = (1.0, 0.0);
    for pair in stack.windows(2).rev() {
        let ((front, _), (behind, depth)) = (pair[0], pair[1]);
        let r = reflectance(front, behind);
        let e = (-depth).exp();
        // Through the layer behind the interface, and back and forth between it and what follows.
        let (back, mirror) = (shown * e, mirrored * e * e);
        shown = (1.0 - r) * back / (1.0 - r * mirror);
        mirrored = r + (1.0 - r) * (1.0 - r) * mirror / (1.0 - r * mirror);
    }
    shown + mirrored
}

/// A medium of given coefficients (1/m) and mean cosine.
fn scatters(ior: f64, absorption: f64, coefficient: f64, g: f64) -> String {
    let phase = scattering(&uniform(coefficient), &henyey_greenstein(g));
    medium("m", 10, &basic(ior, &uniform(absorption), &phase)) + &specular("surface", "m")
}

/// Whatever scatters without absorbing cannot be seen in even light: by every technique and driver.
#[test]
fn a_scattering_ball_in_even_light_is_invisible() {
    for (what, ior) in [("fog", 1.0), ("glass", 1.3)] {
        let parts = [scatters(ior, 0.0, 0.5, 0.5), sphere([0.0; 3], 0.5, "surface")];
        let mut scene = in_uniform_light([0.0, -5.0, 0.0], 0.05, &parts);
        for mode in MODES {
            let measured = luminance_in_mode(&mut scene, mode, 16, if mode.metropolis { 768 } else { 320 });
            assert_is(&format!("{what}, {mode}"), &measured, AROUND * NITS_PER_UNIFORM, 1e-3);
        }
    }
}

/// Light that passes unseen surfaces is not moved: along an edge of a small cube of fog, where ways inside are as
/// short as one likes, none misses its way out.
#[test]
fn fog_is_not_dark_along_its_edges() {
    let (half, turned) = (0.01, 0.5f64.sqrt() * 0.01);
    let m = [turned, -turned, 0.0, turned, turned, 0.0, 0.0, 0.0, half];
    let edges = Mesh::cube(1.0).placed(m, 1.0, [0.0; 3]);
    let parts = [scatters(1.0, 0.0, 20.0, 0.0), edges.text("cube", "surface") + &model("cube")];
    // A millimetre round the edge on the right.
    let mut scene = in_uniform_light([2.0 * turned, -1.0, 0.0], 5e-4, &parts);
    for mode in MODES {
        let measured = luminance_in_mode(&mut scene, mode, 16, 64);
        assert_is(&mode.to_string(), &measured, AROUND * NITS_PER_UNIFORM, 1e-3);
    }
}

/// Light scattered once in a ball of fog, seen along its diameter, by quadrature over the way and over all
/// directions, each of which leaves the ball after a way of its own.
#[test]
fn single_scattering_has_its_closed_form() {
    let (absorption, coefficient, g, radius) = (0.4, 1.1, 0.6, 0.5);
    let parts = [scatters(1.0, absorption, coefficient, g), sphere([0.0; 3], radius, "surface")];
    let mut scene = in_uniform_light([0.0, -5.0, 0.0], 1e-3, &parts);
    scene.transport.max_depth = 1;
    let extinction = absorption + coefficient;
    // At x along the diameter, light that goes on at cosine mu to the view comes from a way s through the ball.
    let scattered = |x: f64| {
        let lit = |mu: f64| {
            let s = -x * mu + (radius * radius - x * x * (1.0 - mu * mu)).sqrt();
            let phase = 0.5 * (1.0 - g * g) / (1.0 + g * g - 2.0 * g * mu).powf(1.5);
            phase * (-extinction * s).exp()
        };
        coefficient * (-extinction * (x + radius)).exp() * integral(-1.0, 1.0, lit)
    };
    let expected = (-2.0 * extinction * radius).exp() + integral(-radius, radius, scattered);
    for mode in MODES {
        let measured = luminance_in_mode(&mut scene, mode, 16, if mode.metropolis { 128 } else { 96 });
        assert_is(&mode.to_string(), &measured, AROUND * NITS_PER_UNIFORM * expected, 6e-3);
    }
}

/// Simpson's rule.
fn integral(a: f64, b: f64, f: impl Fn(f64) -> f64) -> f64 {
    let n = 400;
    let h = (b - a) / f64::from(n);
    let weight = |i: i32| if i == 0 || i == n { 1.0 } else { f64::from(2 + 2 * (i % 2)) };
    (0..=n).map(|i| weight(i) * f(a + f64::from(i) * h)).sum::<f64>() * h / 3.0
}

/// The reference's ball of fog with all orders of scattering, rendered by another program to 1e-3.
#[test]
fn a_ball_of_fog_is_as_bright_as_another_program_has_it() {
    let parts = [scatters(1.0, 0.5, 2.0, 0.6), sphere([0.0; 3], 1.0, "surface")];
    // The middle eighth of a field of 20 degrees.
    let mut scene = in_uniform_light([0.0, -5.0, 0.0], 10f64.to_radians().tan() / 8.0, &parts);
    let measured = luminance_in_mode(&mut scene, MODES[0], 16, 256);
    assert_near("middle", &measured, AROUND * NITS_PER_UNIFORM * 0.432_291, 4e-3);
}

/// A half-space of isotropic scattering: by reciprocity, seen under even light it shows its plane albedo
/// (Chandrasekhar 1950, "Radiative Transfer", section 38; H functions by iteration). Forty mean free paths stand
/// for infinity: e^-40 of the light gets through.
#[test]
fn a_half_space_shows_its_plane_albedo() {
    let albedo = 0.9;
    let phase = scattering(&uniform(albedo * 100.0), "<uniform/>");
    let slab = Mesh::cube(1.0).placed([20.0, 0.0, 0.0, 0.0, 0.2, 0.0, 0.0, 0.0, 20.0], 1.0, [0.0, 0.2, 0.0]);
    let parts = [
        medium("m", 10, &basic(1.0, &uniform((1.0 - albedo) * 100.0), &phase)),
        specular("surface", "m"),
        slab.text("slab", "surface"),
        model("slab"),
    ];
    let mut scene = in_uniform_light([0.0, -1.0, 0.0], 1e-3, &parts);
    let measured = luminance_in_mode(&mut scene, MODES[0], 16, 256);
    assert_is("along the normal", &measured, AROUND * NITS_PER_UNIFORM * 0.414_947_5, 5e-3);
}

/// Glass that is not transparent mirrors what it reflects, ((η - 1) / (η + 1))² along the normal, and no more.
#[test]
fn what_is_not_transparent_only_reflects() {
    let opaque = specular("mirror", "m").replace("<transparent>true", "<transparent>false");
    let parts = [clear("m", 10, 1.5), opaque, sphere([0.0; 3], 1.0, "mirror")];
    let scene = in_uniform_light([0.0, -5.0, 0.0], 1e-3, &parts);
    assert_luminance("mirror", &measure(&scene, 8, 64), 0.04);
    // Where nothing is said, light goes through.
    let unsaid = specular("ball", "m").replace("<transparent>true</transparent>", "");
    let parts = [clear("m", 10, 1.5), unsaid, sphere([0.0; 3], 1.0, "ball")];
    let scene = in_uniform_light([0.0, -5.0, 0.0], 1e-3, &parts);
    assert_luminance("ball", &measure(&scene, 8, 64), 1.0);
}

/// A medium whose precedence is not given has 10: one of 9 that it holds is displaced, and one of 11 displaces it.
#[test]
fn the_precedence_of_a_medium_is_ten_where_it_is_not_given() {
    for (precedence, absorbed_m) in [(9, 2.0), (11, 1.0)] {
        let unsaid = absorbing("m", 10, 1.0, 0.5).replace("<precedence>10</precedence>", "");
        let surfaces = specular("outer", "m") + &specular("inner", "hole");
        let balls = sphere([0.0; 3], 1.0, "outer") + &sphere([0.0; 3], 0.5, "inner");
        let parts = [unsaid, clear("hole", precedence, 1.0), surfaces, balls];
        let scene = in_uniform_light([0.0, -5.0, 0.0], 1e-3, &parts);
        let expected = (-0.5f64 * absorbed_m).exp();
        assert_luminance(&format!("a hole of {precedence}"), &measure(&scene, 8, 64), expected);
    }
}

/// A white tile under a coat, in a ball of water with the camera: nothing is lost, and radiance in water is its index
/// squared times that in air.
#[test]
fn a_glazed_white_tile_under_water_is_not_to_be_told_from_the_water() {
    let glaze = format!(
        "<material><name>glaze</name><phong><ior>1.5</ior><exponent>100</exponent>\
         <diffuse_albedo_spectrum>{}</diffuse_albedo_spectrum></phong></material>",
        uniform(1.0)
    );
    let tile = Mesh::cube(0.3).text("cube", "glaze") + &model("cube");
    let water = clear("w", 10, 1.333) + &specular("surface", "w");
    let parts = [glaze, water, tile, sphere([0.0; 3], 5.0, "surface")];
    let mut scene = in_uniform_light([0.0, -2.0, 0.0], 0.05, &parts);
    for mode in &MODES[..2] {
        let measured = luminance_in_mode(&mut scene, *mode, 16, 96);
        let expected = AROUND * NITS_PER_UNIFORM * 1.333 * 1.333;
        assert_near(&mode.to_string(), &measured, expected, 1.5e-3);
    }
}

/// A coat throws light back to its ground by its index over that of the medium outside: one of water's own index is not
/// there under water.
#[test]
fn a_coat_of_water_is_not_there_under_water() {
    let glaze = format!(
        "{}<material><name>glaze</name><coating><substrate_material_name>ground</substrate_material_name><ior>1.333</ior>\
         </coating></material>",
        grey("ground", 0.5)
    );
    let tile = Mesh::cube(0.3).text("cube", "glaze") + &model("cube");
    let water = clear("w", 10, 1.333) + &specular("surface", "w");
    let parts = [glaze, water, tile, sphere([0.0; 3], 5.0, "surface")];
    let mut scene = in_uniform_light([0.0, -2.0, 0.0], 0.05, &parts);
    for mode in &MODES[..2] {
        let measured = luminance_in_mode(&mut scene, *mode, 16, 96);
        // The ball's surface reflects R of what leaves its middle back to it: I = n² L (1 − R) + R I / 2.
        let r = (0.333f64 / 2.333).powi(2);
        let expected = 0.5 * AROUND * NITS_PER_UNIFORM * 1.333 * 1.333 * (1.0 - r) / (1.0 - 0.5 * r);
        assert_near(&mode.to_string(), &measured, expected, 3e-3);
    }
}

/// A camera whose lens lies exactly on the surface of a medium sees out of it and into it.
#[test]
fn a_camera_on_an_interface_knows_on_which_side_each_ray_leaves() {
    let ball = sphere([0.0; 3], 0.5, "surface");
    for (ior, y, expected) in [(1.0, 0.5, 1.0), (1.0, -0.5, (-3.0f64).exp()), (1.5, 0.5, 1.0)] {
        let parts = [absorbing("m", 10, ior, 3.0), specular("surface", "m"), ball.clone()];
        for bidirectional in [false, true] {
            let mut scene = in_uniform_light([0.0, y, 0.0], 1e-3, &parts);
            scene.transport.bidirectional = bidirectional;
            assert_luminance(&format!("{ior} from {y}"), &measure(&scene, 8, 64), expected);
        }
    }
}

/// What no modeller should make: surfaces that are open, inside out, twice at one place, or nested too deep. A
/// surface has its medium at its back, from wherever it is met; so nothing is lost, and clear media stay unseen.
#[test]
fn faulty_meshes_of_clear_media_make_no_light_and_lose_none() {
    let inside_out = Mesh::ball(2).inside_out().text("cube", "glass") + &model("cube");
    let twice = sphere([0.0; 3], 0.7, "glass") + &sphere([0.0; 3], 0.7, "glass");
    let deep: String = (1..12).map(|i| sphere([0.0; 3], 0.08 * f64::from(i), &format!("m{i}"))).collect();
    let deep_media: String = (1..12)
        .map(|i| {
            clear(&format!("d{i}"), 10 + i, 1.0 + 0.05 * f64::from(i))
                + &specular(&format!("m{i}"), &format!("d{i}"))
        })
        .collect();
    for (what, object) in [("inside out", inside_out), ("twice", twice), ("deep", deep)] {
        let parts = [clear("g", 10, 1.5) + &specular("glass", "g") + &deep_media, object];
        let mut scene = in_uniform_light([0.0, -5.0, 0.0], 0.21, &parts);
        for mode in MODES {
            let measured = luminance_in_mode(&mut scene, mode, 16, 64);
            assert_is(&format!("{what}, {mode}"), &measured, AROUND * NITS_PER_UNIFORM, 1e-3);
        }
    }
}

/// The same of media that absorb and scatter: a picture of numbers, in every mode, none of it brighter than even light
/// can be; that it is finite is checked where films are made.
#[test]
fn faulty_meshes_of_dense_media_have_a_finite_picture() {
    let open = Mesh { triangles: Mesh::cube(0.7).triangles[2..].to_vec(), ..Mesh::cube(0.7) };
    let inside_out = Mesh::cube(0.7).inside_out();
    let sheet = Mesh::square(0.7, 0.0);
    let objects = [("open", open), ("inside out", inside_out), ("a sheet", sheet)];
    for (what, mesh) in objects {
        for ior in [1.0, 1.4] {
            let parts = [scatters(ior, 0.5, 5.0, 0.7), mesh.text("m", "surface"), model("m")];
            for (place, pos) in [("outside", [0.0, -5.0, 0.0]), ("inside", [0.0, -0.2, 0.1])] {
                let mut scene = in_uniform_light(pos, 0.3, &parts);
                for mode in MODES {
                    let measured = luminance_in_mode(&mut scene, mode, 2, 4);
                    let share = measured.mean() / (AROUND * NITS_PER_UNIFORM);
                    // The index of the medium in which the camera may be taken to be: squared.
                    assert!((0.0..ior * ior * 1.1).contains(&share), "{what}, {place}, {mode}: {share}");
                }
            }
        }
    }
}
