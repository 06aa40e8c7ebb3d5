//! A room that light enters by one window, with and without a portal.

use super::shapes::{Mesh, Point, model};
use super::text::{background, camera, grey, scene_file, settings, uniform};

/// Side of the pictures.
pub const SIDE: u32 = 12;

/// 4 m by 6 m by 2.6 m with a window of one square metre in the wall at the left.
fn walls() -> Mesh {
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
        across(-2.0, [0.0, 2.5], [0.0, 2.6]),
        across(-2.0, [3.5, 6.0], [0.0, 2.6]),
        across(-2.0, [2.5, 3.5], [0.0, 1.0]),
        across(-2.0, [2.5, 3.5], [2.0, 2.6]),
    ];
    let mut mesh = Mesh { points: vec![], triangles: vec![] };
    for face in faces {
        let i = mesh.points.len();
        mesh.points.extend(face);
        mesh.triangles.extend([[i, i + 1, i + 2], [i, i + 2, i + 3]]);
    }
    mesh
}

/// The room's scene.
pub fn room(has_portal: bool) -> String {
    let (low, high) = (1.0, 2.0);
    let window = vec![[-2.0, 2.5, low], [-2.0, 3.5, low], [-2.0, 3.5, high], [-2.0, 2.5, high]];
    let portal = [
        Mesh::polygon(window).text("window", "wall"),
        model("window").replace("<model>", "<exit_portal>").replace("</model>", "</exit_portal>"),
    ];
    let portal = if has_portal { portal.concat() } else { String::new() };
    scene_file(&[
        settings(SIDE, ""),
        camera([1.4, 0.4, 1.4], [-0.3, 1.0, -0.15], 0.7, ""),
        grey("wall", 0.7),
        walls().text("walls", "wall"),
        model("walls"),
        background(&uniform(1e6)),
        portal,
    ])
}
