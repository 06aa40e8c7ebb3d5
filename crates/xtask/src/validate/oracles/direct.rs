//! Direct light on a matt floor against closed forms.

use std::f64::consts::PI;

use super::super::change::changed;
use super::super::check::{Check, TECHNIQUES, THREE};
use super::super::shapes::{Mesh, Point, mesh_light, model, sub};
use super::super::text::{background, grey, uniform};
use super::patch::{TANGENT, patch_mean, seen_from};
use super::{NITS_PER_UNIFORM, looking};

const GROUP: &str = "Direct light";
/// Albedo of the floor.
const ALBEDO: f64 = 0.5;
/// Spectral radiance of the lamps, W m^-3 sr^-1.
const RADIANCE: f64 = 5.0e7;

/// The lamp of the manual: 0.2 m by 0.2 m, 100 W at 17.5 lm/W.
fn manual_lamp() -> String {
    "<rectanglelight><pos>0 0 1.9</pos><width>0.2</width><height>0.2</height><spectrum><peak><peak_min>300</peak_min>\
     <peak_width>550</peak_width><base_value>0</base_value><peak_value>200</peak_value></peak></spectrum>\
     <efficacy_scale><power_drawn>100</power_drawn><overall_luminous_efficacy>17.5</overall_luminous_efficacy>\
     </efficacy_scale></rectanglelight>"
        .to_owned()
}

fn rectangle([x, y, above]: Point) -> String {
    let spectrum = uniform(RADIANCE);
    format!(
        "<rectanglelight><pos>0 0 {above}</pos><width>{x}</width><height>{y}</height><spectrum>{spectrum}</spectrum></rectanglelight>"
    )
}

/// No rotation.
const UPRIGHT: [f64; 9] = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];

/// A rectangle in a height above the floor, whose front looks down.
fn rectangle_mesh([x, y, above]: Point) -> Mesh {
    let corner = |[a, b]: [f64; 2]| [0.5 * a * x, 0.5 * b * y, above];
    Mesh::polygon([[1.0, 1.0], [1.0, -1.0], [-1.0, -1.0], [-1.0, 1.0]].map(corner).to_vec())
}

/// Where the manual's lamp hangs, and its luminance: P η / (π A).
const MANUAL: (Point, f64) = ([0.2, 0.2, 1.9], 13_926.057_5);

/// Looks at a point of the floor under lamps; expects the luminance of the mean illuminance (lx) of the patch that is seen.
fn floor(name: &str, about: &str, lamps: &str, target: Point, lux: impl Fn(Point) -> f64) -> Check {
    let eye = seen_from(target);
    // No larger than is seen from all targets: where a ray finds a triangle is rounded by its extent.
    let ground = Mesh::square(2.5, 0.0).text("ground", "floor") + &model("ground");
    let scene =
        looking(eye, sub(target, eye), TANGENT, "", &[grey("floor", ALBEDO), ground, lamps.to_owned()]);
    Check::new(GROUP, name, about, scene).is(ALBEDO / PI * patch_mean(target, lux), 0.0)
}

/// All of them.
pub fn checks() -> Vec<Check> {
    let manual = "The manual's lamp: luminance P η / (π A) = 13 926.06 cd/m²; ";
    let (size, luminance) = MANUAL;
    let seen = looking([0.0; 3], [0.0, 0.0, 1.0], 0.02, "", &[manual_lamp()]);
    let under = |mesh: Mesh, luminance: f64| move |p: Point| luminance * mesh.irradiance(p, [0.0, 0.0, 1.0]);
    let under_manual = || under(rectangle_mesh(size), luminance);
    let mut checks = vec![
        Check::new(GROUP, "the manual's lamp itself", manual, seen).is(luminance, 1e-3),
        floor(
            "the manual's lamp, below",
            &format!("{manual}153.7376 lx below it."),
            &manual_lamp(),
            [0.0; 3],
            under_manual(),
        ),
        floor(
            "the manual's lamp, aside",
            &format!("{manual}63.9058 lx at (1, 1)."),
            &manual_lamp(),
            [1.0, 1.0, 0.0],
            under_manual(),
        ),
    ];
    let radiance = RADIANCE * NITS_PER_UNIFORM;
    for (i, (size, [x, y])) in
        [([1.0, 1.0, 1.0], [0.0, 0.0]), ([2.0, 1.0, 0.5], [0.3, 0.2]), ([2.0, 1.0, 0.5], [2.0, 0.0])]
            .into_iter()
            .enumerate()
    {
        let name = format!("rectangle {} × {} m, {} m above ({x}, {y})", size[0], size[1], size[2]);
        let about =
            "Lambert's ½ Σ θ (n · Γ) over the edges of a rectangle, mean over the patch that is seen.";
        let under = under(rectangle_mesh(size), radiance);
        let check = floor(&name, about, &rectangle(size), [x, y, 0.0], under);
        checks.push(if i == 0 { check.by(THREE) } else { by_techniques(check) });
    }
    for (radius, above, aside) in [(0.5, 1.0, 0.0), (0.5, 1.0, 0.5), (1.0, 1.0, 2.0)] {
        let disc = Mesh::disc(radius, 400);
        let place = [0.0, 0.0, above];
        let lamp = grey("lamp", 0.0)
            + &disc.text("disc", "lamp")
            + &mesh_light("disc", &uniform(RADIANCE), place, 1.0, "");
        let about =
            "Lambert's sum over the edges of a disc of 400 corners, mean over the patch that is seen.";
        checks.push(by_techniques(floor(
            &format!("disc, radius {radius} m, {aside} m aside"),
            about,
            &lamp,
            [0.0, aside, 0.0],
            under(disc.placed(UPRIGHT, 1.0, place), radiance),
        )));
    }
    let ball = Mesh::ball(3);
    let placed = ball.placed(UPRIGHT, 0.3, [0.3, -0.2, 1.5]);
    let lamp = grey("lamp", 0.0)
        + &ball.text("ball", "lamp")
        + &mesh_light("ball", &uniform(RADIANCE), [0.3, -0.2, 1.5], 0.3, "");
    let about = "Lambert's sum over the edges of each triangle that shows its front, mean over the patch that is seen.";
    let ball = floor("ball of 512 triangles", about, &lamp, [0.0; 3], under(placed, radiance));
    checks.push(by_techniques(ball.effort(1024, 1e-2)).quickly(64));
    let both = manual_lamp() + &changed(&manual_lamp(), "0 0 1.9", "1 1 1.9");
    let about = "Light adds up: 153.7376 lx + 63.9058 lx.";
    let under_both = |p: Point| under_manual()(p) + under_manual()(sub(p, [1.0, 1.0, 0.0]));
    checks.push(by_techniques(floor("two lamps", about, &both, [1.0, 1.0, 0.0], under_both)));
    checks.extend([[0.0, 0.0], [1.5, 0.4]].map(|target| by_techniques(portal(target))));
    checks.extend(swapped());
    checks
}

/// Half sides of a square of the floor and of one that stands 1.2 m beside it, and the height of the latter's middle.
const LYING: f64 = 0.5;
const STANDING: f64 = 0.3;
const MIDDLE: Point = [1.2, 0.1, 0.5];

/// Light of one square on another, and of that on the first: the same flux.
fn swapped() -> [Check; 2] {
    let flux = flux_between();
    let about = format!(
        "Two squares at right angles send each other the same flux, {flux:.6} m² L (reciprocity), ∫∫ cos θ cos θ′ / d² dA dA′ by quadrature: the mean of the other, which is all that is seen, is ρ / π of that by its own area."
    );
    let lying =
        [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(|[x, y]| [LYING * x, LYING * y, 0.0]);
    let standing = [[-1.0, -1.0], [-1.0, 1.0], [1.0, 1.0], [1.0, -1.0]]
        .map(|[y, z]| [MIDDLE[0], MIDDLE[1] + STANDING * y, MIDDLE[2] + STANDING * z]);
    // From 4 m before the middle, so that all of the square fills the picture.
    let seen = [([0.0, 0.0, 4.0], LYING), ([MIDDLE[0] - 4.0, MIDDLE[1], MIDDLE[2]], STANDING)];
    let corners = [lying, standing];
    [0, 1].map(|lit| {
        let (eye, half) = seen[lit];
        let forwards = if lit == 0 { [0.0, 0.0, -1.0] } else { [1.0, 0.0, 0.0] };
        let [lit_square, lamp] =
            [corners[lit], corners[1 - lit]].map(|points| Mesh::polygon(points.to_vec()));
        let parts = [
            grey("lamp", 0.0) + &grey("matt", ALBEDO),
            lit_square.text("lit", "matt") + &model("lit"),
            lamp.text("shining", "lamp") + &mesh_light("shining", &uniform(RADIANCE), [0.0; 3], 1.0, ""),
        ];
        let scene = looking(eye, forwards, half / 4.0, "", &parts);
        let value = ALBEDO / PI * flux / (4.0 * half * half) * RADIANCE * NITS_PER_UNIFORM;
        let name = ["a standing lamp above a lying square", "the same with lamp and square swapped"][lit];
        Check::new(GROUP, name, &about, scene).is(value, 1e-6 * value).by(TECHNIQUES).effort(64, 5e-3)
    })
}

/// ∫∫ cos θ cos θ′ / d² dA dA′ of the two squares, by midpoints of two widths, whose errors are as their squares (Richardson).
fn flux_between() -> f64 {
    (4.0 * flux_by_midpoints(48) - flux_by_midpoints(24)) / 3.0
}

fn flux_by_midpoints(places: i32) -> f64 {
    let at = || (0..places).map(|i| 2.0 * (f64::from(i) + 0.5) / f64::from(places) - 1.0);
    let pairs = || at().flat_map(|a| at().map(move |b| [a, b]));
    let cells = (2.0 * LYING / f64::from(places)).powi(2) * (2.0 * STANDING / f64::from(places)).powi(2);
    let between = |[x, y]: [f64; 2], [v, z]: [f64; 2]| {
        let d =
            sub([MIDDLE[0], MIDDLE[1] + STANDING * v, MIDDLE[2] + STANDING * z], [LYING * x, LYING * y, 0.0]);
        let square = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
        d[2] * d[0] / (square * square)
    };
    pairs().map(|on_floor| pairs().map(|on_wall| between(on_floor, on_wall)).sum::<f64>()).sum::<f64>()
        * cells
}

/// Without Metropolis sampling, which gains nothing from more shapes of the same lamp, and with fewer samples in the quick form.
fn by_techniques(check: Check) -> Check {
    let mut check = check.by(TECHNIQUES);
    check.quick.samples /= 2;
    check
}

/// A black room of which the ceiling has an opening, covered by a portal, under even light.
fn portal(target: [f64; 2]) -> Check {
    const SIZE: Point = [2.0, 1.0, 2.0];
    const HALF: f64 = 6.0;
    let [x, y, up] = SIZE;
    let square =
        |name: &str, corners: [Point; 4]| Mesh::polygon(corners.to_vec()).text(name, "black") + &model(name);
    let level =
        |[x0, x1]: [f64; 2], [y0, y1]: [f64; 2]| [[x0, y0, up], [x0, y1, up], [x1, y1, up], [x1, y0, up]];
    let upright =
        |[ax, ay]: [f64; 2], [bx, by]: [f64; 2]| [[ax, ay, 0.0], [bx, by, 0.0], [bx, by, up], [ax, ay, up]];
    let (a, b, h) = (0.5 * x, 0.5 * y, HALF);
    let parts = [
        grey("black", 0.0),
        square("left", level([-h, -a], [-h, h])),
        square("right", level([a, h], [-h, h])),
        square("before", level([-a, a], [-h, -b])),
        square("behind", level([-a, a], [b, h])),
        square("west", upright([-h, -h], [-h, h])),
        square("east", upright([h, -h], [h, h])),
        square("south", upright([-h, -h], [h, -h])),
        square("north", upright([-h, h], [h, h])),
        rectangle_mesh(SIZE).text("opening", "black"),
        "<exit_portal><pos>0 0 0</pos><scale>1</scale><mesh_name>opening</mesh_name></exit_portal>"
            .to_owned(),
        background(&uniform(RADIANCE)),
    ];
    let [x, y] = target;
    let about = "Even light through a portal in the ceiling of a black room: Lambert's ½ Σ θ (n · Γ) over the edges of the opening.";
    let name = format!("exit portal, floor at ({x}, {y})");
    let lux = |p: Point| RADIANCE * NITS_PER_UNIFORM * rectangle_mesh(SIZE).irradiance(p, [0.0, 0.0, 1.0]);
    floor(&name, about, &parts.concat(), [x, y, 0.0], lux)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Configuration factors in closed form: of a parallel rectangle, corner by corner, and of a disc,
    /// π/2 (1 − (h² + d² − r²) / √((h² + d² + r²)² − 4 r² d²)), of which a polygon leaves out 4·10⁻⁵.
    #[test]
    fn sums_over_edges_are_configuration_factors() {
        for (size, [x, y], factor) in [
            ([1.0, 1.0, 1.0], [0.0, 0.0], 0.752_274_688),
            ([2.0, 1.0, 0.5], [0.3, 0.2], 1.930_985_953),
            ([2.0, 1.0, 0.5], [2.0, 0.0], 0.056_117_802),
        ] {
            let summed = rectangle_mesh(size).irradiance([x, y, 0.0], [0.0, 0.0, 1.0]);
            assert!((summed / factor - 1.0).abs() < 1e-8, "{summed}, {factor}");
        }
        for (radius, aside, factor) in
            [(0.5, 0.0, 0.628_318_531), (0.5, 0.5, 0.460_075_592), (1.0, 2.0, 0.165_833_381)]
        {
            let disc = Mesh::disc(radius, 400).placed(UPRIGHT, 1.0, [0.0, 0.0, 1.0]);
            let summed = disc.irradiance([0.0, aside, 0.0], [0.0, 0.0, 1.0]);
            assert!((summed / factor - 1.0).abs() < 6e-5, "{summed}, {factor}");
        }
        let (size, luminance) = MANUAL;
        for (at, lux) in [([0.0; 3], 153.737_6), ([1.0, 1.0, 0.0], 63.905_8)] {
            let summed = luminance * rectangle_mesh(size).irradiance(at, [0.0, 0.0, 1.0]);
            assert!((summed / lux - 1.0).abs() < 1e-6, "{summed}, {lux}");
        }
    }
}
