//! Squares on which pictures hang.

use super::encode;
use super::shapes::{Point, add, cross};

/// Corners of a square about a middle that looks along an axis: lower left, lower right, upper right and upper left, seen from its
/// front; of floors and ceilings with x to the right.
pub fn corners(middle: Point, towards: Point, half: f64) -> [Point; 4] {
    let right = if towards[0].abs() > 0.5 { [0.0, 1.0, 0.0] } else { [1.0, 0.0, 0.0] };
    let up = cross(towards, right);
    [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]
        .map(|[a, b]| add(middle, add(right.map(|x| x * a * half), up.map(|x| x * b * half))))
}

/// `<mesh>` of such corners, on which a picture is shown so many times along each side.
pub fn mesh(name: &str, material: &str, corners: [Point; 4], times: f64) -> String {
    let places = [[0.0, 0.0], [times, 0.0], [times, times], [0.0, times]];
    let vertices = corners
        .iter()
        .zip(places)
        .map(|([x, y, z], [s, t])| format!("<vertex pos=\"{x} {y} {z}\" uv0=\"{s} {t}\"/>"));
    format!(
        "<mesh><name>{name}</name><normal_smoothing>false</normal_smoothing><embedded><expose_uv_set><index>0</index>\
         <name>default</name></expose_uv_set>{}<triangle_set><material_name>{material}</material_name><tri>0 1 2</tri>\
         <tri>0 2 3</tri></triangle_set></embedded></mesh>",
        vertices.collect::<String>()
    )
}

/// A grey EXR file of columns and rows, whose values are given by column and by row from the top.
pub fn picture([width, height]: [usize; 2], value: impl Fn(usize, usize) -> f32 + Sync) -> Vec<u8> {
    encode::rgb([width, height], |i| [value(i % width, i / width); 3])
}
