//! A region of a picture is the crop of the whole, up to its edge, in every mode and through wide filters.

use super::common::judge::assert_same;
use super::common::text::{flat_camera, grey, scene_file, settings, uniform};
use super::common::{film, scene};
use indigo_film::FilmState;
use indigo_scene::Scene;
use indigo_testkit::stats::Moments;

/// Columns and rows, last excluded.
const REGION: [[usize; 2]; 2] = [[9, 25], [13, 23]];
const SIDE: usize = 32;

/// A wall under a lamp: light everywhere, also beyond the region's edge.
fn wall(filter: &str, modes: &str, more: &str) -> Scene {
    scene(&scene_file(&[
        settings(SIDE as u32, &format!("<splat_filter>{filter}</splat_filter>{modes}{more}")),
        flat_camera([0.0, -4.0, 0.0], [0.0, 1.0, 0.0], 0.5),
        grey("grey", 0.6),
        "<sphere><center>0 40 0</center><radius>38</radius><material_name>grey</material_name></sphere>"
            .to_owned(),
        format!(
            "<rectanglelight><pos>0 -1 4</pos><width>4</width><height>4</height><spectrum>{}</spectrum></rectanglelight>",
            uniform(1e5)
        ),
    ]))
}

/// Mean luminance of the outermost pixels of the region.
fn edge(film: &FilmState) -> f64 {
    let image = film.develop();
    let [columns, rows] = REGION;
    let (mut sum, mut count) = (0.0, 0.0);
    for y in rows[0]..rows[1] {
        for x in columns[0]..columns[1] {
            if [columns[0], columns[1] - 1].contains(&x) || [rows[0], rows[1] - 1].contains(&y) {
                sum += f64::from(image.pixels[y * SIDE + x][1]);
                count += 1.0;
            }
        }
    }
    sum / count
}

fn edges(scene: &Scene, passes: u64) -> Moments {
    Moments::of((0..6).map(|seed| edge(&film(scene, seed, passes))))
}

/// Splats from beyond the edge belong to the pixels inside: to leave them out takes a sixth of the light from the edge
/// through the Mitchell-Netravali filter, some fifty standard errors.
#[test]
fn a_region_has_the_light_of_the_whole_up_to_its_edge() {
    let region = "<render_region><x1>9</x1><y1>13</y1><x2>25</x2><y2>23</y2></render_region>";
    let mode = |bidirectional: bool, metropolis: bool, hybrid: bool| {
        format!(
            "<bidirectional>{bidirectional}</bidirectional><metropolis>{metropolis}</metropolis><hybrid>{hybrid}</hybrid>"
        )
    };
    for filter in ["<gaussian/>", "<mn_cubic><blur>0.6</blur><ring>0.2</ring></mn_cubic>"] {
        let expected = edges(&wall(filter, &mode(false, false, false), ""), 64);
        for (name, modes) in [
            ("path", mode(false, false, false)),
            ("bidirectional", mode(true, false, false)),
            ("path by Metropolis", mode(false, true, false)),
            ("bidirectional by Metropolis", mode(true, true, false)),
            ("hybrid", mode(true, true, true)),
        ] {
            let part = edges(&wall(filter, &modes, region), 64);
            assert_same(&format!("{filter}, {name}"), &part, &expected);
        }
    }
}
