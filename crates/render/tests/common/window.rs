//! A room that light enters by one window, with and without a portal.

use super::shapes::{Mesh, Point, model};
use super::text::{ONE_PIXEL, background, camera, grey, scene_file, settings, uniform};

/// Side of the pictures.
pub const SIDE: u32 = 12;

/// The part of the wall at the left that is so far from the middle of the window, at most.
fn window(half_m: f64) -> [[f64; 2]; 2] {
    [3.0, 1.5].map(|middle| [middle - half_m, middle + half_m])
}

/// 4 m by 6 m by 2.6 m with a square window.
fn walls(half_window_m: f64) -> Mesh {
    let [[y0, y1], [z0, z1]] = window(half_window_m);
    let across = |x: f64, [y0, y1]: [f64; 2], [z0, z1]: [f64; 2]| -> [Point; 4] {
        [[x, y0, z0], [x, y1, z0], [x, y1, z1], [x, y0, z1]]
    };
    let level = |z: f64| -> [Point; 4] { [[-2.0, 0.0, z], [2.0, 0.0, z], [2.0, 6.0, z], [-2.0, 6.0, z]] };
    let end = |y: f64| -> [Point; 4] { [[-2.0, y, 0.0], [2.0, y, 0.0], [2.0, y, 2.6], [-2.0, y, 2.6]] };
    let faces = [
        level(0.0),
        level(2.6),
        end(0.0),
        end(6.0),
        across(2.0, [0.0, 6.0], [0.0, 2.6]),
        across(-2.0, [0.0, y0], [0.0, 2.6]),
        across(-2.0, [y1, 6.0], [0.0, 2.6]),
        across(-2.0, [y0, y1], [0.0, z0]),
        across(-2.0, [y0, y1], [z1, 2.6]),
    ];
    let mut mesh = Mesh { points: vec![], triangles: vec![] };
    for face in faces {
        let i = mesh.points.len();
        mesh.points.extend(face);
        mesh.triangles.extend([[i, i + 1, i + 2], [i, i + 2, i + 3]]);
    }
    mesh
}

/// A portal over the wall at the left, so far from the middle of the window.
fn portal(half_m: f64) -> String {
    let [[y0, y1], [z0, z1]] = window(half_m);
    let corners = vec![[-2.0, y0, z0], [-2.0, y1, z0], [-2.0, y1, z1], [-2.0, y0, z1]];
    let placed = model("window").replace("<model>", "<exit_portal>").replace("</model>", "</exit_portal>");
    Mesh::polygon(corners).text("window", "wall") + &placed
}

/// The scene of a room with a window and whatever else.
fn room_with(half_window_m: f64, settings: String, tangent: f64, more: String) -> String {
    scene_file(&[
        settings,
        camera([1.4, 0.4, 1.4], [-0.3, 1.0, -0.15], tangent, ""),
        grey("wall", 0.7),
        walls(half_window_m).text("walls", "wall"),
        model("walls"),
        background(&uniform(1e6)),
        more,
    ])
}

/// The room with a window of one square metre.
pub fn room(has_portal: bool) -> String {
    room_with(0.5, settings(SIDE, ""), 0.7, if has_portal { portal(0.5) } else { String::new() })
}

/// The room with a small window, which the camera does not see, and something 4000 km away, where single precision
/// counts in steps of 25 cm. The portal covers the window; where it `is_wide` the wall round it, too, and a
/// black wall stands 28 m before it, above its middle.
pub fn room_in_a_wide_scene(is_wide: bool) -> String {
    let far = |x: f64, y: f64| [2.8e6 + x, 2.8e6 + y, 0.0];
    let far = Mesh::polygon(vec![far(0.0, 0.0), far(9.0, 0.0), far(9.0, 9.0), far(0.0, 9.0)]);
    let mut things = vec![far.text("far", "wall"), model("far"), portal(if is_wide { 0.15 } else { 0.1 })];
    if is_wide {
        let before = |y: f64, z: f64| [-30.0, y, z];
        let (low, high) = (before(-100.0, 1.5), before(100.0, 90.0));
        let before = Mesh::polygon(vec![low, before(100.0, 1.5), high, before(-100.0, 90.0)]);
        things.extend([grey("black", 0.0), before.text("before", "black"), model("before")]);
    }
    room_with(0.1, settings(SIDE, ONE_PIXEL), 0.5, things.concat())
}
