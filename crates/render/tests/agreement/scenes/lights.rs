//! Every kind of light that is not the same everywhere or in all directions.

use super::{Written, background, block, build, common, encode, model, room, uniform, view, wall, written};

/// A room that is lit from the camera's side and, if `roofless`, from above.
fn open_room(is_roofless: bool) -> Vec<String> {
    let mut parts = room(["white"; 4]);
    if is_roofless {
        // A smaller ceiling leaves a gap all round.
        parts.retain(|p| !p.contains("ceiling"));
        parts.extend([wall([0.0, 0.0, -1.0], 1.0, 0.6).text("ceiling", "white"), model("ceiling")]);
    }
    parts
}

fn skylight(sundir: &str) -> Vec<String> {
    vec![format!("<skylight><sundir>{sundir}</sundir><turbidity>3</turbidity></skylight>")]
}

pub fn sun_and_sky() -> Written {
    build(&[common(view()), open_room(false), block("grey"), skylight("0.3 -1 0.7")])
}

/// An angular map of 8 by 8 texels with a bright one behind the camera, and its file.
fn map() -> (String, Vec<u8>) {
    let texel = |i: usize| match i {
        // At the rim, where -y is.
        20 => [3e5, 1e5, 2e4],
        _ => [1e3 * (i % 8) as f32, 2e3, 8e2 * (i / 8) as f32],
    };
    let bytes = (0..64).flat_map(texel).flat_map(f32::to_le_bytes).collect();
    let map =
        "<env_map><spherical><path>map.float</path><width>8</width><gain>2</gain></spherical></env_map>";
    (map.to_owned(), bytes)
}

/// The map, and a background that adds to it.
pub fn environment_map() -> Written {
    let (map, bytes) = map();
    let parts = [common(view()), open_room(true), block("white"), vec![map, background(&uniform(5e2))]];
    written(&parts.concat(), [("map.float", bytes)])
}

/// The sun without air: nothing but a disc, which shines into the corner between floor and wall.
pub fn sun_in_space() -> Written {
    let sun = "<skylight><sundir>0.3 -1 0.7</sundir><turbidity>3</turbidity><extra_atmospheric>true</extra_atmospheric></skylight>";
    build(&[common(view()), open_room(false), block("grey"), vec![sun.to_owned()]])
}

/// A square lamp with texture coordinates, whose middle is somewhere.
pub(super) fn square_lamp(name: &str, middle: [f64; 3], more: &str) -> Vec<String> {
    let [mx, my, z] = middle;
    let corner = |x: i32, y: i32| {
        let at = |v: i32| 0.4 * f64::from(v);
        let uv = |v: i32| f64::from((v + 1) / 2);
        format!("<vertex pos=\"{} {} {z}\" uv0=\"{} {}\"/>", mx + at(x), my + at(y), uv(x), uv(y))
    };
    let vertices: String = [(-1, -1), (-1, 1), (1, 1), (1, -1)].map(|(x, y)| corner(x, y)).concat();
    let set = "<expose_uv_set><index>0</index><name>default</name></expose_uv_set>";
    let triangles = "<tri>0 1 2</tri><tri>0 2 3</tri>";
    vec![
        format!(
            "<mesh><name>{name}</name><normal_smoothing>false</normal_smoothing><embedded>{set}{vertices}<triangle_set>\
             <material_name>black</material_name>{triangles}</triangle_set></embedded></mesh>"
        ),
        format!(
            "<meshlight><pos>0 0 0</pos><scale>1</scale><mesh_name>{name}</mesh_name><spectrum>{}</spectrum>{more}</meshlight>",
            uniform(1e5)
        ),
    ]
}

pub(super) const PROFILE: &str = "<ies_profile><path>lamp.ies</path></ies_profile>";

/// Intensity that depends on both angles, down to none along the ceiling.
pub fn photometric_lamp() -> Written {
    lit_by_profile(0.95, include_bytes!("../../../../../testscenes/ies/quadrant_bat.ies"))
}

/// One that shines upwards, too.
pub fn two_sided_photometric_lamp() -> Written {
    lit_by_profile(0.5, include_bytes!("../../../../../testscenes/ies/reject_vertical_0_180.ies"))
}

/// A room with a photometric lamp at some height.
fn lit_by_profile(z: f64, file: &[u8]) -> Written {
    let lamp = square_lamp("lamp", [0.0, 0.0, z], PROFILE);
    let parts = [common(view()), room(["white"; 4]), block("grey"), lamp];
    written(&parts.concat(), [("lamp.ies", file.to_vec())])
}

pub(super) const MAP: &str = "<texture><path>lamp.bmp</path><exponent>1</exponent><b>3</b></texture>";

/// Two by two texels, one of them bright.
pub(super) fn picture() -> Vec<u8> {
    let mut picture = b"BM".to_vec();
    for word in [70_u32, 0, 54, 40, 2, 2] {
        picture.extend(word.to_le_bytes());
    }
    picture.extend([1, 0, 24, 0]);
    for word in [0_u32, 16, 0, 0, 0, 0] {
        picture.extend(word.to_le_bytes());
    }
    picture.extend([0, 0, 0, 255, 120, 40, 0, 0, 20, 20, 200, 0, 0, 0, 0, 0]);
    picture
}

/// A lamp with a picture.
pub fn textured_lamp() -> Written {
    let lamp = square_lamp("lamp", [0.0, 0.0, 0.95], MAP);
    let parts = [common(view()), room(["white"; 4]), block("white"), lamp];
    written(&parts.concat(), [("lamp.bmp", picture())])
}

/// A low sun with its sky, a map, a lamp with a picture and a photometric one, which give the room about as much light
/// each: every kind in a single scene, so that each run has them.
pub fn all_lights_together() -> Written {
    let file = include_str!("../../../../../testscenes/ies/quadrant_bat.ies");
    // Ten times as bright.
    let bright = file.replacen("1 -1 1 ", "1 -1 10 ", 1);
    assert_ne!(bright, file);
    let (map, texels) = map();
    let parts = [
        common(view()),
        open_room(true),
        block("white"),
        square_lamp("lamp with a picture", [-0.5, 0.1, 0.95], MAP),
        square_lamp("photometric lamp", [0.5, 0.3, 0.7], PROFILE),
        vec![map],
        skylight("0.3 -1 0.05"),
    ];
    let files = [("map.float", texels), ("lamp.ies", bright.into_bytes()), ("lamp.bmp", picture())];
    written(&parts.concat(), files)
}

/// Portals over both openings of a roofless room.
fn portals() -> Vec<String> {
    let portal = |name: &str| {
        format!("<exit_portal><pos>0 0 0</pos><scale>1</scale><mesh_name>{name}</mesh_name></exit_portal>")
    };
    vec![
        wall([0.0, 1.0, 0.0], 1.0, 1.0).text("front", "white"),
        wall([0.0, 0.0, -1.0], 1.0, 1.0).text("gap", "white"),
        portal("front"),
        portal("gap"),
    ]
}

/// A room that light enters from the front and through a gap round its ceiling, by a portal over each.
pub fn portal_lit_room() -> Written {
    build(&[common(view()), open_room(true), block("white"), skylight("-0.4 -0.6 1"), portals()])
}

/// The same room under a map in latitude and longitude, which has a bright texel before the room and one above it.
pub fn map_through_portals() -> Written {
    let texel = |i: usize| match i {
        // Left of -y and 34° high, and 79° above +x.
        33 => [2e5, 1e5, 3e4],
        12 => [2e4, 1e5, 3e5],
        _ => [1e3, 2e2 * (i % 16) as f32, 2e3],
    };
    let map = encode::rgb([16, 8], texel);
    let light = "<env_map><latlong><path>map.exr</path><gain>1.5</gain></latlong></env_map>".to_owned();
    let parts = [common(view()), open_room(true), block("white"), vec![light], portals()];
    written(&parts.concat(), [("map.exr", map)])
}

/// A long lamp of so many lumens, and daylight after Preetham from the front, which gives less light.
pub fn rectangle_lamp_beside_a_hazy_sky() -> Written {
    let lamp = "<rectanglelight><pos>0.3 0.2 0.9</pos><width>1.2</width><height>0.2</height><spectrum><blackbody>\
         <temperature>2800</temperature><gain>1</gain></blackbody></spectrum><efficacy_scale><power_drawn>1000</power_drawn>\
         <overall_luminous_efficacy>150</overall_luminous_efficacy></efficacy_scale></rectanglelight>";
    let sky =
        "<skylight><sundir>0.3 -1 0.2</sundir><turbidity>6</turbidity><model>preetham</model></skylight>";
    let daylight = vec![lamp.to_owned(), sky.to_owned()];
    build(&[common(view()), open_room(false), block("grey"), daylight])
}
