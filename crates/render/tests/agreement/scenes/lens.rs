//! Lenses out of focus, apertures of every kind, and what they diffract; lamps that shine straight into them.

use super::super::shapes::{mesh_light, model};
use super::super::text::{background, camera, diffuse, null, uniform};
use super::lights::{MAP, PROFILE, picture, square_lamp};
use super::{Written, block, build, common, encode, lamp, room, wall, written};

/// A lens as wide as the room, focused before it, with natural vignetting, shifted by a seventh of the sensor to the right
/// and a tenth down.
pub fn thin_lens_out_of_focus() -> Written {
    let shift = "<lens_shift_right_distance>0.006</lens_shift_right_distance><lens_shift_up_distance>-0.0042</lens_shift_up_distance>";
    let lens = camera([0.0, -3.6, 0.0], [0.0, 1.0, 0.0], 0.42, shift)
        .replace("<aperture_radius>1e-5</aperture_radius>", "<aperture_radius>0.4</aperture_radius>")
        .replace("<focus_distance>1</focus_distance>", "<focus_distance>2.5</focus_distance>");
    build(&[common(lens), room(["white"; 4]), block("grey"), lamp(0.3, 1e5)])
}

/// Parallel rays that meet lamps, the room, and its environment through it.
pub fn orthographic_camera() -> Written {
    let parallel =
        "<camera_type>orthographic</camera_type><lens_shift_up_distance>0.2</lens_shift_up_distance>";
    let lens = camera([0.0, -3.6, 0.0], [0.0, 1.0, 0.0], 22.0, parallel);
    let small = vec![
        wall([0.0, -1.0, 0.0], -0.6, 0.1).text("small", "black"),
        mesh_light("small", &uniform(2e4), [-0.4, 0.0, -0.35], 1.0, ""),
    ];
    let sky = vec![background(&uniform(1e3))];
    build(&[common(lens), without_back(), block("grey"), lamp(0.3, 1e5), small, sky])
}

/// All directions, from amid the room; the lamp lies over the camera, where columns meet.
pub fn spherical_camera() -> Written {
    let lens = camera([0.1, -0.4, 0.1], [0.3, 1.0, 0.0], 1.0, "<camera_type>spherical</camera_type>");
    let sky = vec![background(&uniform(1e3))];
    build(&[common(lens), room(["white"; 4]), block("grey"), lamp(0.3, 1e5), sky])
}

/// Three blades, whose picture of what is out of focus no mode may turn over or stretch.
pub fn blades_out_of_focus() -> Written {
    let blades = "<aperture_shape><generated><num_blades>3</num_blades><start_angle>0.2</start_angle><blade_offset>0.25</blade_offset><blade_curvature_radius>0.7</blade_curvature_radius></generated></aperture_shape>";
    let lens = camera([0.0, -3.6, 0.0], [0.0, 1.0, 0.0], 0.42, blades)
        .replace("<aperture_radius>1e-5</aperture_radius>", "<aperture_radius>0.4</aperture_radius>")
        .replace("<focus_distance>1</focus_distance>", "<focus_distance>1.5</focus_distance>");
    build(&[common(lens), room(["white"; 4]), block("grey"), lamp(0.3, 1e5)])
}

/// A grey picture of the least size that an aperture image may have.
fn grey_picture(light: impl Fn(f64, f64) -> f64) -> Vec<u8> {
    let place = |i: usize| (i as f64 + 0.5) / 512.0;
    let codes: Vec<u8> =
        (0..512 * 512).map(|i| (255.0 * light(place(i % 512), place(i / 512))).round() as u8).collect();
    encode::grey(512, &codes)
}

/// An aperture like no mirror image of its own, grey in part.
pub fn image_out_of_focus() -> Written {
    let key = grey_picture(|x, y| match (x < 0.3, y < 0.4) {
        (true, _) => 1.0,
        (false, true) => 0.25 + 0.5 * x,
        (false, false) => 0.0,
    });
    let lens = camera(
        [0.0, -3.6, 0.0],
        [0.0, 1.0, 0.0],
        0.42,
        "<aperture_shape><image><path>key.png</path></image></aperture_shape>",
    )
    .replace("<aperture_radius>1e-5</aperture_radius>", "<aperture_radius>0.4</aperture_radius>")
    .replace("<focus_distance>1</focus_distance>", "<focus_distance>1.5</focus_distance>");
    let parts = [common(lens), room(["white"; 4]), block("grey"), lamp(0.3, 1e5)].concat();
    written(&parts, [("key.png", key)])
}

/// A pinhole that spreads light over pixels, more of it the longer its wavelength.
pub fn deflected_rays() -> Written {
    deflected("", [])
}

/// The same behind scratches, which spread it to the sides and aslant.
pub fn deflected_by_dust() -> Written {
    let dust = grey_picture(|x, y| if (x * 9.0 + y * 4.0).fract() < 0.3 { 0.0 } else { 0.9 });
    deflected("<obstacle_map>dust.png</obstacle_map>", [("dust.png", dust)])
}

fn deflected<const N: usize>(more: &str, files: [(&'static str, Vec<u8>); N]) -> Written {
    let [red, blue] =
        ["0.8 0.1 0.1", "0.1 0.1 0.8"].map(|c| format!("<rgb><rgb>{c}</rgb><gamma>2.2</gamma></rgb>"));
    let paint = vec![diffuse("red", &red), diffuse("blue", &blue)];
    let parts = [paint, room(["white", "red", "blue", "white"]), block("grey"), lamp(0.3, 1e5)].concat();
    deflecting(|camera| camera, more, files, parts)
}

/// A scene whose camera, with `more` in it and changed by `change`, deflects rays.
fn deflecting<const N: usize>(
    change: impl Fn(String) -> String,
    more: &str,
    files: [(&'static str, Vec<u8>); N],
    parts: Vec<String>,
) -> Written {
    let mut all = common(change(camera([0.0, -3.6, 0.0], [0.0, 1.0, 0.0], 0.42, more)));
    all[0] = all[0].replace(
        "<aperture_diffraction>false</aperture_diffraction>",
        "<aperture_diffraction>true</aperture_diffraction><post_process_diffraction>false</post_process_diffraction>",
    );
    all.extend(parts);
    written(&all, files)
}

/// A map in latitude and longitude that is dim but for a texel of 3°, at azimuth 4° and elevation 7° before the camera.
fn map_with_a_spot() -> (String, Vec<u8>) {
    let texel = |i: usize| if i == 29 * 128 + 65 { [4e5, 2e5, 1e5] } else { [1e3, 2e3, 3e3] };
    let bytes = encode::rgb([128, 64], texel);
    let light = "<env_map><latlong><path>spot.exr</path><gain>1</gain></latlong></env_map>";
    (light.to_owned(), bytes)
}

/// A lens that is focused before the room, and makes everything in it a disc.
fn wide_lens() -> String {
    camera([0.0, -3.6, 0.0], [0.0, 1.0, 0.0], 0.42, "")
        .replace("<aperture_radius>1e-5</aperture_radius>", "<aperture_radius>0.2</aperture_radius>")
        .replace("<focus_distance>1</focus_distance>", "<focus_distance>1.5</focus_distance>")
}

/// A room without a back wall.
fn without_back() -> Vec<String> {
    let mut parts = room(["grey"; 4]);
    parts.retain(|p| !p.contains("back"));
    parts
}

/// Lamps of each kind and a spot of the sky that shine straight into a lens out of focus, one of them through a pane that
/// is not there, and partly behind a block.
pub fn lamps_out_of_focus() -> Written {
    let (map, spot) = map_with_a_spot();
    let file = include_str!("../../../../../testscenes/ies/reject_vertical_0_180.ies");
    let dim = file.replacen("1 -1 1 ", "1 -1 0.02 ", 1);
    assert_ne!(dim, file);
    let small = vec![
        wall([0.0, -1.0, 0.0], -0.6, 0.03).text("small", "black"),
        mesh_light("small", &uniform(4e6), [-0.4, 0.0, -0.35], 1.0, ""),
        null("nothing"),
        wall([0.0, -1.0, 0.0], 0.3, 0.6).text("pane", "nothing"),
        model("pane"),
    ];
    let parts = [
        common(wide_lens()),
        without_back(),
        block("grey"),
        square_lamp("photometric lamp", [-0.4, 0.2, 0.4], PROFILE),
        square_lamp("lamp with a picture", [0.4, 0.2, 0.5], MAP),
        small,
        vec![map],
    ];
    let files = [("spot.exr", spot), ("lamp.ies", dim.into_bytes()), ("lamp.bmp", picture())];
    written(&parts.concat(), files)
}

/// A spot of the sky, seen out of focus through a portal.
pub fn spot_out_of_focus_through_a_portal() -> Written {
    let (map, spot) = map_with_a_spot();
    let portal = vec![
        wall([0.0, -1.0, 0.0], 1.0, 1.0).text("opening", "white"),
        "<exit_portal><pos>0 0 0</pos><scale>1</scale><mesh_name>opening</mesh_name></exit_portal>"
            .to_owned(),
    ];
    let parts = [common(wide_lens()), without_back(), block("grey"), vec![map], portal];
    written(&parts.concat(), [("spot.exr", spot)])
}

/// A lamp that shines straight into a pinhole of three blades, so small that they spread its light over the picture.
pub fn lamp_deflected_straight() -> Written {
    let blades = "<aperture_shape><generated><num_blades>3</num_blades><start_angle>0.2</start_angle><blade_offset>0.25</blade_offset><blade_curvature_radius>50</blade_curvature_radius></generated></aperture_shape>";
    let lamp = vec![
        wall([0.0, -1.0, 0.0], -0.6, 0.3).text("lamp", "black"),
        mesh_light("lamp", &uniform(3e4), [0.2, 0.0, 0.3], 1.0, ""),
    ];
    let lens = |text: String| text.replace("<aperture_radius>1e-5<", "<aperture_radius>2e-6<");
    let room = room(["white", "grey", "grey", "white"]);
    deflecting(lens, blades, [], [room, lamp].concat())
}

/// A lamp out of focus in thin fog that fills all, so that wavelengths have densities of their own.
pub fn lamp_out_of_focus_in_fog() -> Written {
    let lamp = vec![
        wall([0.0, -1.0, 0.0], -0.6, 0.05).text("lamp", "black"),
        mesh_light("lamp", &uniform(2e6), [-0.2, 0.0, 0.2], 1.0, ""),
    ];
    build(&[common(wide_lens()), room(["grey"; 4]), super::media::thin_fog_everywhere(), lamp])
}
