//! What else a camera does: diffraction, parallel rays, all directions at once, and a shutter that is open while something moves.

use std::f64::consts::{FRAC_PI_2, PI};

use super::super::change::{changed, with_lens};
use super::super::check::{Check, PATH, Quantity, TECHNIQUES, Target};
use super::super::hung;
use super::super::shapes::{Mesh, mesh_light, model};
use super::super::text::{ONE_PIXEL, background, flat_camera, grey, scene_file, settings, uniform};
use super::colour::tristimulus;
use super::orientation::{QUARTERS, map, part, quarters, surroundings};
use super::{AROUND, AROUND_NITS, NITS_PER_UNIFORM, SIDE, integral, looking, material};

const GROUP: &str = "Camera";

/// All of them.
pub fn checks() -> Vec<Check> {
    vec![diffracted_edge(), parallel(), all_around(), moving()]
}

/// Radius of the aperture, distance from there to the sensor, and width of a pixel, in metres.
const APERTURE: f64 = 1e-4;
const SENSOR: f64 = 0.05;
const PIXEL: f64 = 8e-5;

/// The edge of a wide lamp in focus, by rays that are diffracted by a circle.
fn diffracted_edge() -> Check {
    const FAR: f64 = 10.0;
    let tangent = 0.5 * f64::from(SIDE) * PIXEL / SENSOR;
    let wide = Mesh::polygon(
        [[0.0, -30.0], [30.0, -30.0], [30.0, 30.0], [0.0, 30.0]].map(|[x, z]| [x, FAR, z]).to_vec(),
    );
    let lamp = wide.text("lamp", "black") + &mesh_light("lamp", &uniform(AROUND), [0.0; 3], 1.0, "");
    let scene = looking([0.0; 3], [0.0, 1.0, 0.0], tangent, "", &[grey("black", 0.0), lamp]);
    let by_rays = "<aperture_diffraction>true</aperture_diffraction><post_process_diffraction>false</post_process_diffraction>";
    let scene = changed(
        &with_lens(&scene, APERTURE, FAR),
        "<aperture_diffraction>false</aperture_diffraction>",
        by_rays,
    );
    let about = "An edge as an aperture of radius a blurs it whose image has the transfer function of Airy’s disc, \
                 T(ν) = 2/π (acos ν − ν √(1 − ν²)) with ν = f λ s / 2a (Born and Wolf, section 9.5.2): ½ + 1/π ∫ T sin(2π f x) df / f, mean over \
                 columns, of all wavelengths under the observer. The first dark ring is 2.1 columns from the middle at 550 nm.";
    let mut check =
        Check::new(GROUP, "edge blurred by diffraction", about, scene).unit(AROUND_NITS).by(TECHNIQUES);
    let side = SIDE as usize;
    for column in 5..11 {
        let value = Target::Value(diffracted(column as f64 - 0.5 * f64::from(SIDE)), 0.0);
        let what = format!("column {} from the edge", column as i32 - side as i32 / 2);
        check = check.row(&what, Quantity::Y, Some([column, column + 1, 0, side]), value);
    }
    // Of the lamp, the noise is in columns that it hardly reaches.
    check.effort(512, 7e-2)
}

/// The mean over a column that begins so many pixels right of the edge, over that of the lamp.
fn diffracted(left: f64) -> f64 {
    let at = |nm: f64| {
        // Places along the edge's normal in units of λ s / 2a, where frequencies end at 1.
        let unit = nm * 1e-9 * SENSOR / (2.0 * APERTURE);
        let [x0, x1] = [left, left + 1.0].map(|x| x * PIXEL / unit);
        // With ν = cos t the transfer function is 2/π (t − sin t cos t).
        0.5 + integral(0.0, FRAC_PI_2, 2000, |t: f64| {
            let (sin, nu) = t.sin_cos();
            let transfer = 2.0 / PI * (t - sin * nu);
            let turn = 2.0 * PI * nu;
            // ∫ sin(2π ν x) dx over the column, over its width.
            let mean = ((turn * x0).cos() - (turn * x1).cos()) / (turn * (x1 - x0));
            transfer * mean / nu / PI * sin
        })
    };
    // Smooth in the wavelength: straight between steps of 10 nm.
    let table: Vec<f64> = (0..=47).map(|i| at(360.0 + 10.0 * f64::from(i))).collect();
    let share = |nm: f64| {
        let place = (nm - 360.0) / 10.0;
        let i = (place as usize).min(46);
        table[i] + (table[i + 1] - table[i]) * (place - i as f64)
    };
    tristimulus(360.0, 830.0, |nm| 1e-9 * share(nm))[1] / NITS_PER_UNIFORM
}

/// A camera of another type: `more` has its elements.
fn typed(kind: &str, width: f64, aspect: f64) -> String {
    let camera = flat_camera([0.0; 3], [0.0, 1.0, 0.0], 10.0 * width);
    let camera = changed(&camera, "<camera>", &format!("<camera><camera_type>{kind}</camera_type>"));
    changed(&camera, "<aspect_ratio>1<", &format!("<aspect_ratio>{aspect}<"))
}

/// A picture that hangs before parallel rays, twice as wide as it is.
fn parallel() -> Check {
    let square = hung::mesh("square", "m", hung::corners([0.0, 5.0, 0.0], [0.0, -1.0, 0.0], 1.0), 1.0);
    let albedo = "<albedo_texture><path>quarters.exr</path><exponent>1</exponent></albedo_texture>";
    let parts = [
        settings(SIDE, ONE_PIXEL),
        typed("orthographic", 4.0, 1.0),
        material("m", &format!("<diffuse>{albedo}</diffuse>")),
        square + &model("square"),
        background(&uniform(AROUND)),
    ];
    let about = "Parallel rays see as many metres as the sensor is wide, 4, of which a picture of 2 m has the middle; even light beside it.";
    let check = Check::new(GROUP, "orthographic", about, scene_file(&parts))
        .unit(AROUND_NITS)
        .by(PATH)
        .effort(64, 5e-3);
    let [first, second] = [[5, 7], [9, 11]];
    let areas = [[first, first], [second, first], [first, second], [second, second]];
    let names = ["upper left", "upper right", "lower left", "lower right"];
    let mut check = quarters(check);
    for ((what, [[x0, x1], [y0, y1]]), value) in names.iter().zip(areas).zip(QUARTERS) {
        check = check.row(what, Quantity::Y, Some([x0, x1, y0, y1]), Target::Value(value, 0.0));
    }
    for (what, area) in [("left of it", [0, 4, 0, 16]), ("above it", [0, 16, 0, 4])] {
        check = check.row(what, Quantity::Y, Some(area), Target::Value(1.0, 0.0));
    }
    check
}

/// Eight parts of the surroundings, each an eighth of the picture.
fn all_around() -> Check {
    let about = "All directions in columns round the axis and rows from the zenith to the nadir, ahead in the middle: eight parts of the \
                 surroundings, which differ by their signs of x, y and z.";
    let wide = changed(&settings(SIDE, ONE_PIXEL), "<width>16<", "<width>32<");
    let scene = scene_file(&[wide, typed("spherical", 1.0, 2.0), map()]);
    let mut check = surroundings(Check::new(GROUP, "spherical", about, scene));
    // Without the pixels beside the edges, where texels blend.
    for (column, is_ahead_right) in
        [(0, [false, false]), (8, [true, false]), (16, [true, true]), (24, [false, true])]
    {
        for (row, above, words) in [(0, true, "above"), (8, false, "below")] {
            let [ahead, right] = is_ahead_right;
            let side = if right { "right" } else { "left" };
            let what = format!("{} to the {side}, {words}", if ahead { "ahead" } else { "behind" });
            let area = [column + 1, column + 7, row + 1, row + 7];
            check =
                check.row(&what, Quantity::Y, Some(area), Target::Value(part([right, ahead, above]), 0.0));
        }
    }
    check.unit(AROUND_NITS).by(PATH).effort(32, 5e-3)
}

/// A black sheet whose edge crosses the middle of the picture while the shutter is open.
fn moving() -> Check {
    const TANGENT: f64 = 0.1;
    const DISTANCE: f64 = 5.0;
    // From a quarter of the picture to three quarters.
    let [from, to] = [-0.5, 0.5].map(|x| x * TANGENT * DISTANCE);
    let sheet = Mesh::polygon(
        [[-50.0, -50.0], [0.0, -50.0], [0.0, 50.0], [-50.0, 50.0]].map(|[x, z]| [x, 0.0, z]).to_vec(),
    );
    let frame =
        |time: u32, x: f64| format!("<keyframe><time>{time}</time><pos>{x} {DISTANCE} 0</pos></keyframe>");
    let moved = format!("<model>{}{}<mesh_name>sheet</mesh_name></model>", frame(0, from), frame(1, to));
    let parts = [grey("black", 0.0), sheet.text("sheet", "black") + &moved, background(&uniform(AROUND))];
    let scene = looking([0.0; 3], [0.0, 1.0, 0.0], TANGENT, "", &parts);
    let about = "A black sheet comes from the left, its edge from a quarter of the picture to three quarters while the shutter is open: even \
                 light is seen for as long as the edge has not come by, a share that rises evenly between them.";
    let mut check = Check::new(GROUP, "an edge that moves", about, scene).unit(AROUND_NITS).by(TECHNIQUES);
    let side = SIDE as usize;
    for column in [1, 5, 8, 11, 14] {
        let share = ((column as f64 + 0.5) / f64::from(SIDE) * 2.0 - 0.5).clamp(0.0, 1.0);
        let what = format!("column {column}");
        check = check.row(&what, Quantity::Y, Some([column, column + 1, 0, side]), Target::Value(share, 0.0));
    }
    check.effort(320, 3e-2)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What an edge shines to one side it lacks on the other, nothing is lost far from it, and Airy's disc is as wide as said.
    #[test]
    fn edges_are_even() {
        for left in [0.0, 1.0, 3.0] {
            assert!((diffracted(left) + diffracted(-left - 1.0) - 1.0).abs() < 1e-6);
        }
        assert!(diffracted(0.0) > 0.6 && diffracted(60.0) > 0.99);
        let first_dark_ring = 1.219_67 * 550e-9 * SENSOR / (2.0 * APERTURE);
        assert!((first_dark_ring / PIXEL - 2.096).abs() < 1e-3);
    }
}
