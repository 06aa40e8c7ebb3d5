//! Which way round pictures, surroundings, the sun and bumps are.

use super::super::check::{Check, PATH, Quantity, TECHNIQUES, Target};
use super::super::hung;
use super::super::shapes::{Mesh, Point, cross, dot, mesh_light, model, unit};
use super::super::text::{background, basic, grey, medium, uniform};
use super::glass::fresnel;
use super::{AROUND, AROUND_NITS, SIDE, looking, material, sky};

const GROUP: &str = "Which way round";

/// All of them.
pub fn checks() -> Vec<Check> {
    [vec![lamp(), poster(), tilted(), lit_by_map()], views(), bumps()].concat()
}

/// What the quarters of a picture have: upper left, upper right, lower left, lower right.
pub const QUARTERS: [f64; 4] = [1.0, 0.7, 0.4, 0.15];
const QUARTERS_FILE: &str = "quarters.exr";

/// Looks straight at a square on which that picture hangs, and sees nothing else.
fn hangs(name: &str, about: &str, scene: impl Fn(String) -> [String; 3]) -> Check {
    let square = hung::corners([0.0, 5.0, 0.0], [0.0, -1.0, 0.0], 1.0);
    let scene = looking([0.0; 3], [0.0, 1.0, 0.0], 0.2, "", &scene(hung::mesh("square", "m", square, 1.0)));
    let check =
        Check::new(GROUP, name, about, scene).unit(AROUND_NITS).by(TECHNIQUES).effort(64, 5e-3).quickly(32);
    let mut check = quarters(check);
    let side = SIDE as usize;
    // Without the pixels beside the edges, over which texels blend.
    let [first, second] = [[1, side / 2 - 1], [side / 2 + 1, side - 1]];
    for (what, [x0, x1], [y0, y1], value) in [
        ("upper left", first, first, QUARTERS[0]),
        ("upper right", second, first, QUARTERS[1]),
        ("lower left", first, second, QUARTERS[2]),
        ("lower right", second, second, QUARTERS[3]),
    ] {
        check = check.row(what, Quantity::Y, Some([x0, x1, y0, y1]), Target::Value(value, 0.0));
    }
    check
}

/// With the file of the picture.
pub fn quarters(mut check: Check) -> Check {
    const TEXELS: usize = 64;
    let value = |x: usize, y: usize| QUARTERS[2 * (2 * y / TEXELS) + 2 * x / TEXELS] as f32;
    check.files.push((QUARTERS_FILE.to_owned(), hung::picture([TEXELS; 2], value)));
    check
}

fn lamp() -> Check {
    let about = "A lamp with a picture that has v = 0 at its bottom and u = 0 at its left shows it as the file has it.";
    hangs("a lamp’s picture", about, |mesh| {
        let texture = format!("<texture><path>{QUARTERS_FILE}</path><exponent>1</exponent></texture>");
        [grey("m", 0.0), mesh, mesh_light("square", &uniform(AROUND), [0.0; 3], 1.0, &texture)]
    })
}

fn poster() -> Check {
    let about = "A picture as albedo in even light shows itself as the file has it.";
    hangs("a picture on a wall", about, |mesh| {
        let albedo =
            format!("<albedo_texture><path>{QUARTERS_FILE}</path><exponent>1</exponent></albedo_texture>");
        let matt = material("m", &format!("<diffuse>{albedo}</diffuse>"));
        [matt, mesh + &model("square"), background(&uniform(AROUND))]
    })
}

/// The sun on a sheet that leans in no plane of the axes.
fn tilted() -> Check {
    const ALBEDO: f64 = 0.5;
    let normal = [0.48, -0.36, 0.8];
    let sun = unit([0.3, -0.5, 0.8]);
    let light = format!(
        "<skylight><sundir>{} {} {}</sundir><turbidity>2</turbidity><extra_atmospheric>true</extra_atmospheric></skylight>",
        sun[0], sun[1], sun[2]
    );
    let right = unit(cross([0.0, 1.0, 0.0], normal));
    let up = cross(normal, right);
    let turn = [right[0], up[0], normal[0], right[1], up[1], normal[1], right[2], up[2], normal[2]];
    let sheet = Mesh::square(4.0, 0.0).placed(turn, 1.0, [0.0; 3]).text("sheet", "grey") + &model("sheet");
    let scene =
        looking(normal.map(|x| 5.0 * x), normal.map(|x| -x), 2e-3, "", &[grey("grey", ALBEDO), sheet, light]);
    let about = "ρ E cos θ / π for a sheet whose normal is (0.48, −0.36, 0.8), and the sun in space towards (0.3, −0.5, 0.8).";
    let value = ALBEDO / std::f64::consts::PI * sky::SUN_IN_SPACE * dot(normal, sun);
    Check::new(GROUP, "the sun on a leaning sheet", about, scene)
        .is(value, 0.0)
        .by(TECHNIQUES)
        .effort(64, 5e-3)
}

/// Surroundings of eight parts, by the signs of x, y and z: ⅛, and ⅛ more towards +x, ¼ towards +y, and ½ towards +z.
pub fn part([x, y, z]: [bool; 3]) -> f64 {
    0.125 * f64::from(1 + u8::from(x) + 2 * u8::from(y) + 4 * u8::from(z))
}

pub fn surroundings(mut check: Check) -> Check {
    const SIZE: [usize; 2] = [512, 256];
    let value = |column: usize, row: usize| {
        let quarter = 4 * column / SIZE[0];
        part([quarter > 1, quarter == 1 || quarter == 2, 2 * row < SIZE[1]]) as f32
    };
    check.files.push(("parts.exr".to_owned(), hung::picture(SIZE, value)));
    check
}

/// `<env_map>`.
pub fn map() -> String {
    format!("<env_map><latlong><path>parts.exr</path><gain>{AROUND}</gain></latlong></env_map>")
}

fn views() -> Vec<Check> {
    let about = "A map in latitude and longitude has +y in its middle, +x to the right of that and +z above: eight parts of eight luminances.";
    let view = |(words, direction): (&str, Point)| {
        let scene = looking([0.0; 3], direction, 0.1, "", &[map()]);
        let check = Check::new(GROUP, format!("surroundings {words}"), about, scene);
        surroundings(check)
            .unit(AROUND_NITS)
            .is(part(direction.map(|v| v > 0.0)), 0.0)
            .by(PATH)
            .effort(64, 5e-3)
            .quickly(8)
    };
    [
        ("ahead to the right, above", [1.0, 1.0, 0.8]),
        ("ahead to the left, above", [-1.0, 1.0, 0.8]),
        ("behind to the right, above", [1.0, -1.0, 0.8]),
        ("ahead to the right, below", [1.0, 1.0, -0.8]),
    ]
    .map(view)
    .to_vec()
}

/// A wall that looks towards +x has four of the parts before it, each with a quarter of the irradiance.
fn lit_by_map() -> Check {
    const ALBEDO: f64 = 0.5;
    let square = hung::corners([0.0; 3], [1.0, 0.0, 0.0], 4.0);
    let wall = Mesh::polygon(square.to_vec()).text("wall", "grey") + &model("wall");
    let scene = looking([5.0, 0.0, 0.0], [-1.0, 0.0, 0.0], 2e-3, "", &[grey("grey", ALBEDO), wall, map()]);
    let parts = [[true, true], [true, false], [false, true], [false, false]].map(|[y, z]| part([true, y, z]));
    let about = "The mean of the four parts towards +x, times the albedo. Where parts blend into those behind the wall light is aslant by \
                 half a texel: 10⁻⁵ of it.";
    let value = ALBEDO * 0.25 * parts.iter().sum::<f64>();
    let check = Check::new(GROUP, "a wall lit by surroundings", about, scene).unit(AROUND_NITS);
    surroundings(check).is(value, 2e-5 * value).by(TECHNIQUES).effort(64, 5e-3).quickly(16)
}

/// Glass that lets nothing through, raised by heights with one slope, seen at 60°: its reflectance tells the angle to the bent
/// normal.
fn bumps() -> Vec<Check> {
    const SLOPE: f64 = 10.0;
    const TEXELS: usize = 16;
    const HALF: f64 = 2.0;
    let (s, c) = 60f64.to_radians().sin_cos();
    let ramp: fn(usize, usize) -> f32 = |i, _| i as f32 / TEXELS as f32;
    let rows: fn(usize, usize) -> f32 = |_, j| (TEXELS - 1 - j) as f32 / TEXELS as f32;
    let [right, up]: [Point; 2] = [[s, 0.0, c], [0.0, -s, c]];
    [("rising to the right, seen from there", right, ramp, 60.0 + SLOPE), ("rising upwards, seen from below", up, rows, 60.0 - SLOPE)]
        .map(|(name, towards, height, degrees)| {
            let gain = 2.0 * HALF * SLOPE.to_radians().tan();
            let bump = format!("<bump_map><path>slope.exr</path><exponent>1</exponent><b>{gain}</b></bump_map>");
            let kind = format!(
                "<specular><transparent>false</transparent><internal_medium_name>g</internal_medium_name>{bump}</specular>"
            );
            let square = hung::mesh("square", "m", hung::corners([0.0; 3], [0.0, 0.0, 1.0], HALF), 1.0);
            let glass = medium("g", 10, &basic(1.5, &uniform(0.0), "")) + &material("m", &kind);
            let eye = towards.map(|x| 20.0 * x);
            let parts = [glass, square + &model("square"), background(&uniform(AROUND))];
            let scene = looking(eye, towards.map(|x| -x), 1e-4, "", &parts);
            let about = format!("White stands higher than black: Fresnel's reflectance at {degrees}°, n = 1.5, of a slope of {SLOPE}° under a look at 60°.");
            let value = fresnel(f64::to_radians(degrees).cos(), 1.5);
            let mut check = Check::new(GROUP, format!("bump {name}"), about, scene).unit(AROUND_NITS);
            check.files.push(("slope.exr".to_owned(), hung::picture([TEXELS; 2], height)));
            check.is(value, 0.0).by(PATH).effort(64, 5e-3)
        })
        .to_vec()
}
