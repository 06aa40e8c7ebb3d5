//! Even light from everywhere, and rooms that shine evenly: a test of every cosine, density and weight.

use super::super::check::{Check, Quantity, Renderer, TECHNIQUES, THREE, Target};
use super::super::shapes::{Mesh, mesh_light, model};
use super::super::text::{
    basic, grey, henyey_greenstein, medium, null, scattering, specular, sphere, uniform,
};
use super::{AROUND, AROUND_NITS, in_even_light, looking, material};

const GROUP: &str = "Furnaces";

/// All of them.
pub fn checks() -> Vec<Check> {
    [albedos(), whites(), bodies(), rooms()].concat()
}

/// A sheet of a material "m" that stands at an angle to the look, in even light.
pub fn sheet_in_even_light(degrees: f64, parts: &[String]) -> String {
    // So narrow a look has one angle.
    in_even_light([0.0, -5.0, 0.0], 1e-3, &[parts, &[sheet(degrees)]].concat())
}

fn furnace(name: &str, about: &str, parts: &[String], value: f64) -> Check {
    // A narrow look at an upright sheet or into a ball 5 m away.
    Check::new(GROUP, name, about, in_even_light([0.0, -5.0, 0.0], 0.05, parts))
        .unit(AROUND_NITS)
        .is(value, 0.0)
        .flat()
}

/// A sheet of a material "m" that looks at the camera, turned by an angle.
fn sheet(degrees: f64) -> String {
    let (s, c) = degrees.to_radians().sin_cos();
    // Up becomes towards the camera and aside.
    let turn = [c, 0.0, s, s, 0.0, -c, 0.0, 1.0, 0.0];
    Mesh::square(50.0, 0.0).placed(turn, 1.0, [0.0; 3]).text("sheet", "m") + &model("sheet")
}

fn albedos() -> Vec<Check> {
    let about = "An object that no ray leaves twice shows its albedo in even light.";
    let albedo = |value: f64| format!("<albedo_spectrum>{}</albedo_spectrum>", uniform(value));
    let ball = sphere([0.0; 3], 1.0, "m");
    let blend = "<blend><blend_factor>0.3</blend_factor><a_name>a</a_name><b_name>b</b_name></blend>";
    let transmitter = format!("<diffuse_transmitter>{}</diffuse_transmitter>", albedo(0.6));
    vec![
        furnace("diffuse ball", about, &[grey("m", 0.35), ball.clone()], 0.35),
        furnace("diffuse sheet at 70°", about, &[grey("m", 0.8), sheet(70.0)], 0.8),
        furnace("diffuse transmitter", about, &[material("m", &transmitter), sheet(30.0)], 0.6),
        furnace(
            "blend",
            "Linear in its parts: 0.7 · 0.8 + 0.3 · 0.2.",
            &[grey("a", 0.8), grey("b", 0.2), material("m", blend), ball],
            0.7 * 0.8 + 0.3 * 0.2,
        )
        .longer(Renderer::Metropolis, 4),
        furnace(
            "thin sheet",
            "Of each side’s light 0.6 is scattered back by the front’s material, of albedo 0.7, and 0.5 of the rest comes through from the \
             other side: 0.6 · 0.7 + 0.4 · 0.5.",
            &[grey("front", 0.7), grey("back", 0.1), thin_sheet(0.6, 0.5), sheet(40.0)],
            0.6 * 0.7 + 0.4 * 0.5,
        )
        .by(TECHNIQUES)
        .effort(16, 5e-3),
    ]
}

/// A material "m" of which a part of the light is scattered back, and some of the rest let through.
fn thin_sheet(back: f64, through: f64) -> String {
    let kind = format!(
        "<front_material_name>front</front_material_name><back_material_name>back</back_material_name><r_f>{back}</r_f>\
         <transmittance_spectrum>{}</transmittance_spectrum>",
        uniform(through)
    );
    material("m", &format!("<double_sided_thin>{kind}</double_sided_thin>"))
}

/// Materials that absorb nothing cannot be told from their surroundings.
fn whites() -> Vec<Check> {
    let about = "What absorbs nothing cannot be told from its surroundings.";
    let metal = |n: f64| {
        let kind = format!(
            "<exponent>{n}</exponent><specular_reflectivity_spectrum>{}</specular_reflectivity_spectrum>",
            uniform(1.0)
        );
        material("m", &format!("<phong>{kind}</phong>"))
    };
    let clay = format!(
        "<oren_nayar><sigma>0.9</sigma><albedo_spectrum>{}</albedo_spectrum></oren_nayar>",
        uniform(1.0)
    );
    let coat = format!(
        "<phong><ior>1.6</ior><exponent>40</exponent><diffuse_albedo_spectrum>{}</diffuse_albedo_spectrum></phong>",
        uniform(1.0)
    );
    let frosted = "<glossy_transparent><internal_medium_name>g</internal_medium_name><exponent>100</exponent></glossy_transparent>";
    let mut checks = vec![
        furnace("nothing", about, &[null("m"), sheet(40.0)], 1.0),
        furnace("white clay at 70°", about, &[material("m", &clay), sheet(70.0)], 1.0)
            .by(TECHNIQUES)
            .effort(128, 5e-3),
        furnace("white coat at 70°", about, &[material("m", &coat), sheet(70.0)], 1.0)
            .by(TECHNIQUES)
            .effort(128, 5e-3),
    ];
    for (n, degrees) in [(20.0, 0.0), (300.0, 45.0), (1e12, 45.0)] {
        let parts = [metal(n), sheet(degrees)];
        checks.push(
            furnace(&format!("white metal, exponent {n} at {degrees}°"), about, &parts, 1.0).by(TECHNIQUES),
        );
    }
    let parts =
        [medium("g", 10, &basic(1.5, &uniform(0.0), "")), material("m", frosted), sphere([0.0; 3], 1.0, "m")];
    let bound = "Facets lose what they would scatter twice: no brighter than its surroundings.";
    let mut frosted = furnace("frosted glass", bound, &parts, 1.0).by(TECHNIQUES);
    frosted.rows[0].target = Target::AtMost(1.0);
    frosted = frosted.effort(64, 5e-3).in_full(256, 5e-3);
    checks.push(frosted);
    checks
}

fn bodies() -> Vec<Check> {
    let about = "Nothing is absorbed: what is lost on one way is gained on another.";
    let glass =
        |ior: f64, inside: &str| medium("g", 10, &basic(ior, &uniform(0.0), inside)) + &specular("m", "g");
    let scatters = |g: f64| scattering(&uniform(0.5), &henyey_greenstein(g));
    let hollow = medium("a", 20, &basic(1.0, &uniform(0.0), "")) + &specular("hollow", "a");
    let ball = sphere([0.0; 3], 1.0, "m");
    let cube = Mesh::cube(0.7).text("cube", "m") + &model("cube");
    let at = |name: &str, parts: &[String]| {
        let scene = in_even_light([0.0, -5.0, 0.0], 0.21, parts);
        Check::new(GROUP, name, about, scene).unit(AROUND_NITS).is(1.0, 0.0).flat().effort(64, 5e-3)
    };
    vec![
        at("clear glass ball", &[glass(1.5, ""), ball.clone()]),
        at("clear glass cube", &[glass(1.5, ""), cube]),
        at("hollow glass ball", &[glass(1.5, ""), hollow, ball.clone() + &sphere([0.0; 3], 0.8, "hollow")]),
        at("ball of fog", &[glass(1.0, &scatters(0.7)), ball.clone()]).effort(256, 5e-3),
        at("ball of milky glass", &[glass(1.3, &scatters(-0.5)), ball]).effort(256, 5e-3),
    ]
}

/// A closed room whose walls all emit E and reflect ρ has the radiance E/(1-ρ) everywhere, whatever its shape.
fn rooms() -> Vec<Check> {
    let room = |mesh: &Mesh, albedo: f64| {
        let parts = [
            grey("wall", albedo),
            mesh.clone().inside_out().text("room", "wall"),
            mesh_light("room", &uniform(AROUND), [0.0; 3], 1.0, ""),
        ];
        looking([0.13, -0.21, 0.08], [0.3, 1.0, -0.2], 1.0, "<max_depth>10000</max_depth>", &parts)
    };
    let about = "All walls emit E and reflect ρ: E / (1 − ρ) in every direction, whatever the shape.";
    let mut checks = vec![];
    for (name, mesh, albedo, chains) in [
        ("ball, albedo 0.5", Mesh::ball(2), 0.5f64, 2),
        ("cube, albedo 0.8", Mesh::cube(1.0), 0.8, 3),
        ("ball, albedo 0.9", Mesh::ball(2), 0.9, 3),
    ] {
        let check =
            Check::new(GROUP, format!("shining {name}"), about, room(&mesh, albedo)).unit(AROUND_NITS).flat();
        let value = Target::Value(1.0 / (1.0 - albedo), 0.0);
        let check = check.by(THREE).row("", Quantity::Y, None, value).effort(32, 2e-2);
        checks.push(check.longer(Renderer::Metropolis, chains));
    }
    checks
}
