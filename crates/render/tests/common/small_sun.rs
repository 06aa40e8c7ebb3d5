//! A block on a floor under an environment map with a small sun, whose directions are drawn by luminance or evenly.

use super::scene;
use super::shapes::{Mesh, model};
use super::text::{camera, grey, scene_file, settings};
use indigo_light::LightTable;
use indigo_light::kinds::env_map::{EnvMap, Layout};
use indigo_math::Vec3d;
use indigo_scene::Scene;

/// Side of the pictures.
pub const SIDE: u32 = 12;
/// Columns and rows of the map: a texel is 1.4° wide, some three times as wide as the sun.
const SIZE: [usize; 2] = [256, 128];
/// Column and row of the sun's texel: 24° above the horizon, right of +y and behind it.
const SUN: [usize; 2] = [210, 46];

/// A blue sky over dark ground and the sun, which sends the floor about as much light as the sky.
fn map() -> EnvMap {
    let texel = |i: usize| match [i % SIZE[0], i / SIZE[0]] {
        SUN => [1.2e7, 1e7, 8e6],
        [_, row] if row < SIZE[1] / 2 => [700.0, 1000.0, 1500.0],
        _ => [200.0; 3],
    };
    EnvMap::new(Layout::LatLong, SIZE[0], SIZE[1], (0..SIZE[0] * SIZE[1]).map(texel).collect())
}

/// The scene.
pub fn under_small_sun(is_drawn_by_luminance: bool) -> Scene {
    let mut scene = scene(&scene_file(&[
        settings(SIDE, ""),
        camera([0.0, -4.0, 2.0], [0.0, 1.0, -0.4], 0.35, ""),
        grey("white", 0.7),
        Mesh::square(3.0, -0.5).text("floor", "white"),
        model("floor"),
        Mesh::cube(0.5).text("block", "white"),
        model("block"),
    ]));
    let map = if is_drawn_by_luminance { map() } else { map().drawn_evenly() };
    // All of the scene is within 8 m of the camera, at the origin of render space.
    scene.lights = LightTable::new(vec![], vec![map.into()], std::iter::empty(), (Vec3d::ZERO, 8.0));
    scene
}
