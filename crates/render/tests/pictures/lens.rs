//! The lens: focus, the shape of the aperture, what it diffracts, and bloom.

use super::common::judge::{NITS_PER_UNIFORM, assert_is, assert_near, assert_same};
use super::common::shapes::{Mesh, mesh_light, model};
use super::common::text::{background, flat_camera, grey, null, scene_file, settings, uniform};
use super::common::{film, scene, scene_with};
use indigo_film::XyzImage;
use indigo_imaging::{Picture, develop, on_sensor, png};
use indigo_math::{Real, Vec2};
use indigo_scene::Scene;
use indigo_testkit::stats::Moments;
use std::f64::consts::PI;

/// Side of the pictures.
const SIDE: usize = 32;
/// First and last (excluded) column and row of the lamp in them.
const LAMP: [usize; 2] = [12, 20];

/// A square lamp over the camera that covers whole pixels; `more` goes into the camera.
fn lamp_text(diffraction: &str, more: &str) -> String {
    let set = settings(SIDE as u32, "<splat_filter><box/></splat_filter>")
        .replace("<aperture_diffraction>false</aperture_diffraction>", diffraction);
    // 32 pixels see 2 m at a distance of 1: half as many as the lamp is wide.
    let half = 3.0 * (LAMP[1] - LAMP[0]) as f64 / SIDE as f64;
    let camera =
        flat_camera([0.0, 0.0, -3.0], [0.0, 0.0, 1.0], 1.0).replace("</camera>", &format!("{more}</camera>"));
    scene_file(&[
        set,
        camera,
        format!(
            "<rectanglelight><pos>0 0 0</pos><width>{w}</width><height>{w}</height><spectrum>{s}</spectrum></rectanglelight>",
            w = 2.0 * half,
            s = uniform(1e5)
        ),
    ])
}

fn diffraction(is_filter: bool) -> String {
    format!(
        "<aperture_diffraction>true</aperture_diffraction><post_process_diffraction>{is_filter}</post_process_diffraction>"
    )
}

fn shape(inner: &str) -> String {
    format!("<aperture_shape>{inner}</aperture_shape>")
}

fn blades(count: u32) -> String {
    shape(&format!(
        "<generated><num_blades>{count}</num_blades><start_angle>0.3</start_angle><blade_offset>0.25</blade_offset><blade_curvature_radius>50</blade_curvature_radius></generated>"
    ))
}

/// The light on the sensor.
fn sensor(scene: &Scene, seed: u64, passes: u64) -> XyzImage {
    on_sensor(film(scene, seed, passes).develop(), &scene.picture)
}

/// Mean of a component over columns and rows.
fn mean(image: &XyzImage, component: usize, [columns, rows]: [[usize; 2]; 2]) -> f64 {
    let pixels = (rows[0]..rows[1]).flat_map(|y| (columns[0]..columns[1]).map(move |x| y * SIDE + x));
    Moments::of(pixels.map(|i| f64::from(image.pixels[i][component]))).mean()
}

/// The filter on the picture and the deflection of rays are one diffraction: on the lamp, at its edges, and
/// beside it to both sides, above and below, for X, Y and Z. The filter makes up for light that leaves the
/// picture, the rays do not need to; that is less than 1 % here.
#[test]
fn the_filter_and_the_rays_agree() {
    let [filter, rays] = [true, false].map(|f| scene(&lamp_text(&diffraction(f), &blades(3))));
    let sharp = scene(&lamp_text("<aperture_diffraction>false</aperture_diffraction>", &blades(3)));
    let [lo, hi] = LAMP;
    let regions = [
        ("middle", [[lo + 2, hi - 2], [lo + 2, hi - 2]], 0.03),
        ("inside the edge", [[hi - 1, hi], [lo, hi]], 0.03),
        ("beside", [[hi, hi + 1], [lo, hi]], 0.03),
        ("farther beside", [[hi + 1, hi + 4], [lo, hi]], 0.05),
        ("above", [[lo, hi], [lo - 1, lo]], 0.03),
        ("farther above", [[lo, hi], [lo - 4, lo - 1]], 0.05),
    ];
    let batches = |scene: &Scene, n: u64, passes: u64| -> Vec<XyzImage> {
        (0..n).map(|seed| sensor(scene, 100 + seed, passes)).collect()
    };
    // A pattern looks the same from both sides.
    let both = |image: &XyzImage, c: usize, region: [[usize; 2]; 2]| {
        let opposite = region.map(|[lo, hi]| [SIDE - hi, SIDE - lo]);
        0.5 * (mean(image, c, region) + mean(image, c, opposite))
    };
    let (filtered, deflected) = (batches(&filter, 2, 64), batches(&rays, 32, 256));
    let plain = sensor(&sharp, 1, 64);
    for (name, region, tolerance) in regions {
        for c in 0..3 {
            let expected = Moments::of(filtered.iter().map(|i| both(i, c, region))).mean();
            let got = Moments::of(deflected.iter().map(|i| both(i, c, region)));
            assert_near(&format!("{name}, {c}"), &got, expected, tolerance);
            // There is something to see: without diffraction the lamp ends at its edge.
            let without = both(&plain, c, region);
            assert!((expected / without - 1.0).abs() > 0.02, "{name}, {c}: {expected} {without}");
        }
    }
}

/// Coverage is not diffracted: the same whether light is deflected, filtered or neither, pixel by pixel.
#[test]
fn coverage_is_of_things_and_not_of_light() {
    let wide = "<aperture_diffraction>true</aperture_diffraction><post_process_diffraction>false</post_process_diffraction>";
    let off = "<aperture_diffraction>false</aperture_diffraction>";
    for bidirectional in ["false", "true"] {
        let [sharp, filtered, deflected] = [off, &*diffraction(true), wide].map(|diffraction| {
            let text = lamp_text(diffraction, "");
            let at = text.find("<bidirectional>").expect("the setting");
            let end = at + text[at..].find("</bidirectional>").expect("its end");
            let text = format!("{}<bidirectional>{bidirectional}{}", &text[..at], &text[end..]);
            sensor(&scene(&text), 7, 4)
        });
        assert!(sharp.pixels != filtered.pixels && sharp.pixels != deflected.pixels);
        let coverage = |image: &XyzImage| image.pixels.iter().map(|p| p[3]).collect::<Vec<_>>();
        assert!(coverage(&sharp) == coverage(&filtered), "{bidirectional}");
        assert!(coverage(&sharp) == coverage(&deflected), "{bidirectional}");
        let covered: f32 = coverage(&sharp).iter().sum();
        assert_eq!(covered as usize, (LAMP[1] - LAMP[0]).pow(2), "what the lamp covers");
    }
}

/// A lens that is shifted by whole pixels of the sensor moves the picture by as many, to the left and down where the lens
/// goes to the right and up, whichever end light is traced from.
#[test]
fn a_shifted_lens_moves_the_picture() {
    const RIGHT: usize = 5;
    const UP: usize = 2;
    let shift = |name: &str, pixels: usize| {
        let metres = 0.1 * pixels as f64 / SIDE as f64;
        format!("<lens_shift_{name}_distance>{metres}</lens_shift_{name}_distance>")
    };
    let sharp = "<aperture_diffraction>false</aperture_diffraction>";
    let text = lamp_text(sharp, &(shift("right", RIGHT) + &shift("up", UP)));
    let [lo, hi] = LAMP;
    let (columns, rows) = ([lo - RIGHT, hi - RIGHT], [lo + UP, hi + UP]);
    let lit = ((hi - lo) * (hi - lo)) as f64 / (SIDE * SIDE) as f64;
    for bidirectional in [false, true] {
        let mut scene = scene(&text);
        scene.transport.bidirectional = bidirectional;
        let images: Vec<_> = (0..16).map(|seed| sensor(&scene, 40 + seed, 32)).collect();
        let inside = Moments::of(images.iter().map(|i| mean(i, 1, [columns, rows])));
        let all = Moments::of(images.iter().map(|i| mean(i, 1, [[0, SIDE]; 2])));
        // 1e-3 of a pixel's width, the blur of the lens and the rounding of positions, may lie across the lamp's edge.
        let what = format!("bidirectional {bidirectional}");
        assert_near(&format!("{what}: the lamp"), &inside, 1e5 * NITS_PER_UNIFORM, 5e-3);
        assert_near(&format!("{what}: the picture"), &all, lit * 1e5 * NITS_PER_UNIFORM, 5e-3);
    }
}

/// The picture of a camera of some type whose `sensor_width` is 2, before a lamp of 1.5 m, from some distance: the lamp's
/// luminance in columns and rows, and the part of the film that it covers.
fn expect_without_lens(kind: &str, distance: f64, inside: [[usize; 2]; 2], covered: f64, more: &str) {
    let camera = flat_camera([0.0, 0.0, -distance], [0.0, 0.0, 1.0], 20.0)
        .replace("</camera>", &format!("<camera_type>{kind}</camera_type>{more}</camera>"));
    let text = scene_file(&[
        settings(SIDE as u32, "<splat_filter><box/></splat_filter>"),
        camera,
        format!(
            "<rectanglelight><pos>0 0 0</pos><width>1.5</width><height>1.5</height><spectrum>{}</spectrum></rectanglelight>",
            uniform(1e5)
        ),
    ]);
    for bidirectional in [false, true] {
        let mut scene = scene(&text);
        scene.transport.bidirectional = bidirectional;
        let images: Vec<_> = (0..8).map(|seed| sensor(&scene, 70 + seed, 32)).collect();
        let lamp = Moments::of(images.iter().map(|i| mean(i, 1, inside)));
        let all = Moments::of(images.iter().map(|i| mean(i, 1, [[0, SIDE]; 2])));
        let what = format!("{kind} from {distance} m, bidirectional {bidirectional}");
        assert_near(&format!("{what}: the lamp"), &lamp, 1e5 * NITS_PER_UNIFORM, 5e-3);
        assert_near(&format!("{what}: the picture"), &all, covered * 1e5 * NITS_PER_UNIFORM, 5e-3);
    }
}

/// 1.5 m of 2 are 24 of 32 columns, from anywhere; a shift of an eighth of a metre is of two pixels.
#[test]
fn parallel_rays_show_things_in_their_size() {
    let covered = 0.75 * 0.75;
    for distance in [0.5, 40.0] {
        expect_without_lens("orthographic", distance, [[4, 28]; 2], covered, "");
    }
    let shift = "<lens_shift_right_distance>0.125</lens_shift_right_distance><lens_shift_up_distance>0.0625</lens_shift_up_distance>";
    expect_without_lens("orthographic", 1.0, [[2, 26], [5, 29]], covered, shift);
}

/// At an angle φ from straight ahead a lamp that reaches a metres up and to the sides at a distance d is seen up to
/// atan(a cos φ / d).
#[test]
fn a_spherical_camera_shows_things_by_their_angles() {
    let (half, distance) = (0.75, 0.5);
    let side = f64::atan2(half, distance);
    let steps = 1000;
    let height = |i: u32| {
        2.0 * (half / distance * (side * (f64::from(2 * i + 1) / f64::from(steps) - 1.0)).cos()).atan()
    };
    let covered = (0..steps).map(height).sum::<f64>() / f64::from(steps) * 2.0 * side / (2.0 * PI * PI);
    // 56° and, at the least, 39° of 90: here are 45° and 34°.
    expect_without_lens("spherical", distance, [[12, 20], [10, 22]], covered, "");
}

/// Before an even background a black square a quarter of the picture wide moves across by another quarter, seen by parallel rays:
/// columns that it enters and leaves see it for the part of the time that it covers them. The same from a camera that moves the
/// other way.
#[test]
fn what_moves_leaves_a_streak() {
    let key =
        |time: f64, x: f64, z: f64| format!("<keyframe><time>{time}</time><pos>{x} 0 {z}</pos></keyframe>");
    let moving = |x: f64| key(0.0, 0.0, 0.0) + &key(2.0, x, 0.0);
    let camera = |keys: &str| {
        flat_camera([0.0, 0.0, -2.0], [0.0, 0.0, 1.0], 20.0)
            .replace("<pos>0 0 -2</pos>", keys)
            .replace("</camera>", "<camera_type>orthographic</camera_type></camera>")
    };
    let still = "<pos>0 0 0</pos>";
    let text = |camera_keys: &str, keys: &str| {
        scene_file(&[
            settings(SIDE as u32, "<splat_filter><box/></splat_filter>"),
            camera(camera_keys),
            background(&uniform(1e5)),
            grey("black", 0.0),
            Mesh::square(0.25, 0.0).text("square", "black"),
            model("square").replace(still, keys),
        ])
    };
    let back = key(0.0, 0.0, -2.0) + &key(2.0, -1.0, -2.0);
    // Half of the way of two units of time. The right of the picture is where x is negative.
    let scenes =
        [("the square", text("<pos>0 0 -2</pos>", &moving(1.0))), ("the camera", text(&back, still))];
    for (what, text) in scenes {
        for bidirectional in [false, true] {
            let mut scene = scene(&text);
            scene.transport.bidirectional = bidirectional;
            let images: Vec<_> = (0..16).map(|seed| sensor(&scene, 90 + seed, 256)).collect();
            // Columns of 1/16 unit: the square lies over 12 to 19 and ends over 4 to 11, so that eight see its edges pass.
            for column in [4, 6, 9, 14, 16, 19] {
                let passed = if column < 12 { column as f64 - 4.0 + 0.5 } else { 19.5 - column as f64 } / 8.0;
                let light = Moments::of(images.iter().map(|i| mean(i, 1, [[column, column + 1], [12, 20]])));
                let expected = (1.0 - passed) * 1e5 * NITS_PER_UNIFORM;
                let what = format!("{what}, bidirectional {bidirectional}, column {column}");
                assert_near(&what, &light, expected, 0.04);
            }
        }
    }
}

/// A lamp of a centimetre out of focus, before a lens of 20 cm: each point of the disc sees it through
/// A / (4 m / focus − 1)² of the lens, of π r². Light paths make an even disc of it, of which camera rays, one in 10,000 of
/// which meets the lamp, show specks: with light paths the deviation of a pixel is 6 % here, without 100 % and more.
#[test]
fn a_small_lamp_out_of_focus_is_an_even_disc() {
    let camera = flat_camera([0.0, 0.0, -4.0], [0.0, 0.0, 1.0], 0.3)
        .replace("<aperture_radius>1e-5</aperture_radius>", "<aperture_radius>0.2</aperture_radius>");
    let half = 0.005;
    let mut scene = scene(&scene_file(&[
        settings(SIDE as u32, "<splat_filter><box/></splat_filter>"),
        camera,
        grey("black", 0.0),
        Mesh::square(half, 0.0).inside_out().text("lamp", "black"),
        mesh_light("lamp", &uniform(1e9), [0.0; 3], 1.0, ""),
    ]));
    scene.transport.bidirectional = true;
    let share = (2.0 * half).powi(2) / 9.0 / (PI * 0.2f64.powi(2));
    let expected = 1e9 * NITS_PER_UNIFORM * share;
    // The disc has a radius of 8 pixels.
    let is_inside = |i: &usize| {
        let [x, y] = [i % SIDE, i / SIDE].map(|c| c as f64 + 0.5 - 0.5 * SIDE as f64);
        x.hypot(y) < 7.0
    };
    let disc = |seed| {
        let picture = film(&scene, 200 + seed, 64).develop();
        Moments::of((0..SIDE * SIDE).filter(is_inside).map(|i| f64::from(picture.pixels[i][1])))
    };
    let discs: Vec<Moments> = (0..8_u64).map(disc).collect();
    assert_is("the disc", &Moments::of(discs.iter().map(Moments::mean)), expected, 1e-2);
    for disc in &discs {
        let deviation = disc.variance().sqrt() / expected;
        assert!(deviation < 0.1, "pixels deviate by {deviation}");
    }
}

/// What blades spread of a small lamp is found by light paths; of camera rays, few are deflected onto it.
#[test]
fn streaks_of_small_lamps_are_smooth() {
    let width = |m: f64| format!("<width>{m}</width><height>{m}</height><spectrum>");
    let radius = |m: f64| format!("<aperture_radius>{m:e}</aperture_radius>");
    let text = lamp_text(&diffraction(false), &blades(3));
    let small = text.replace(&width(1.5), &width(0.3)).replace(&radius(1e-5), &radius(3e-6));
    let mut scene = scene(&small);
    let deviation = |is_bidirectional| {
        scene.transport.bidirectional = is_bidirectional;
        let pictures: Vec<XyzImage> = (0..8).map(|seed| film(&scene, 300 + seed, 64).develop()).collect();
        let far = (0..SIDE * SIDE).filter(|i| i / SIDE < SIDE / 3);
        let pixels = far.map(|i| Moments::of(pictures.iter().map(|p| f64::from(p.pixels[i][1]))));
        let sums = pixels.fold([0.0; 2], |[v, m], pixel| [v + pixel.variance(), m + pixel.mean()]);
        sums[0].sqrt() / sums[1]
    };
    let [camera, light] = [false, true].map(deviation);
    assert!(light < 0.2 * camera, "{light} is not much less than {camera}");
}

/// Light of the film is kept by the filter but for what leaves the picture.
#[test]
fn the_filter_keeps_the_light() {
    let scene = scene(&lamp_text(&diffraction(true), ""));
    let before = film(&scene, 3, 16).develop();
    let after = on_sensor(before.clone(), &scene.picture);
    let whole = [[0, SIDE], [0, SIDE]];
    for c in 0..3 {
        let kept = mean(&after, c, whole) / mean(&before, c, whole);
        assert!((kept - 1.0).abs() < 0.02, "{kept}");
    }
    assert!(before != after);
}

/// An obstacle map changes the picture with diffraction, and leaves it alone without.
#[test]
fn obstacles_diffract() {
    let stripes = Picture {
        width: 16,
        height: 16,
        pixels: (0..256).map(|i| [if i % 4 < 2 { 1.0 } else { 0.0 }; 4]).collect(),
    };
    let map = png::encode(&stripes, &indigo_imaging::Metadata::default(), png::Depth::Eight);
    let map = map.expect("a picture with pixels");
    let render = |diffraction: &str, more: &str| {
        let text = lamp_text(diffraction, more);
        sensor(&scene_with(&text, [("dust.png", map.clone())]), 1, 16)
    };
    let dusty = "<obstacle_map>dust.png</obstacle_map>";
    assert!(render(&diffraction(true), dusty) != render(&diffraction(true), ""));
    assert!(render(&diffraction(false), dusty) != render(&diffraction(false), ""));
    let off = "<aperture_diffraction>false</aperture_diffraction>";
    assert!(render(off, dusty) == render(off, ""));
    // The path may stand in a child.
    let child = "<obstacle_map><path>dust.png</path></obstacle_map>";
    assert!(render(&diffraction(true), child) == render(&diffraction(true), dusty));
}

/// Bloom is in the picture that is shown, and not in the light on the sensor.
#[test]
fn bloom_is_shown_but_not_measured() {
    let off = "<aperture_diffraction>false</aperture_diffraction>";
    let with = |weight: f64, radius: f64| {
        let bloom = format!("<bloom><weight>{weight}</weight><radius>{radius}</radius></bloom>");
        scene(&lamp_text(off, &bloom).replace("<scale>1<", "<scale>1e4<"))
    };
    let at = |scene: &Scene, x: usize| develop(&film(scene, 1, 16), &scene.picture).pixels[16 * SIDE + x][1];
    let scenes = [with(0.0, 0.05), with(0.2, 0.05), with(0.4, 0.05), with(0.4, 0.2)];
    let beside = scenes.each_ref().map(|s| at(s, 21));
    assert_eq!(beside[0], 0.0);
    assert!(beside[1] > 0.0 && (beside[2] / beside[1] - 2.0).abs() < 1e-3, "{beside:?}");
    assert!(at(&scenes[3], 30) > 10.0 * at(&scenes[2], 30), "a wider glow reaches farther");
    assert!(sensor(&scenes[0], 1, 16) == sensor(&scenes[2], 1, 16));
}

/// The exposure is that of the opening, and the picture's luminance is not changed by it.
#[test]
fn the_exposure_follows_the_open_area() {
    let off = "<aperture_diffraction>false</aperture_diffraction>";
    let circle = scene(&lamp_text(off, &shape("<circular/>")));
    // Three straight blades at a quarter of the width, 0.5 half sides: 3 ρ² tan 60 degrees.
    let triangle = scene(&lamp_text(
        off,
        &blades(3).replace("<blade_curvature_radius>50<", "<blade_curvature_radius>1e9<"),
    ));
    let area = |s: &Scene| s.picture.exposure.lux_seconds_per_nit() / 0.01 * 0.05f64.powi(2) / 1e-10;
    assert!((area(&circle) / std::f64::consts::PI - 1.0).abs() < 1e-6, "{}", area(&circle));
    let exact = 3.0 * 0.25 * 3f64.sqrt();
    assert!((area(&triangle) / exact - 1.0).abs() < 1e-6, "{} instead of {exact}", area(&triangle));
    let [a, b] = [&circle, &triangle]
        .map(|s| Moments::of((0..4).map(|seed| mean(&sensor(s, seed, 64), 1, [[12, 20], [12, 20]]))));
    assert_same("luminance behind another shape", &a, &b);
}

/// An image of a half disc lets half the light in, and points of the lens are on its open side.
#[test]
fn an_image_is_an_aperture() {
    let side = 512;
    let pixels = (0..side * side).map(|i| [if i % side < side / 2 { 1.0 } else { 0.0 }; 4]).collect();
    let picture = Picture { width: side, height: side, pixels };
    let bytes = png::encode(&picture, &indigo_imaging::Metadata::default(), png::Depth::Eight);
    let text = lamp_text(
        "<aperture_diffraction>false</aperture_diffraction>",
        &shape("<image><path>half.png</path></image>"),
    );
    let scene = scene_with(&text, [("half.png", bytes.expect("a picture"))]);
    assert!((scene.camera.aperture().area() - 2.0).abs() < 1e-6);
    for i in 0..64 {
        let u = |k: i32| (k as Real + 0.5) / 8.0;
        let p = scene.camera.aperture().sample(Vec2::new(u(i % 8), u(i / 8)));
        assert!(p.x <= 0.0, "{p:?}");
    }
}

/// Autofocus measures along the axis; it overrides a given distance, and is infinity where nothing is.
#[test]
fn autofocus_finds_what_is_in_the_middle() {
    let text = |camera_more: &str, at: f64| {
        let camera = flat_camera([0.0, 0.0, 5.0], [0.0, 0.0, -1.0], 0.3)
            .replace("<focus_distance>1</focus_distance>", camera_more)
            .replace("<aperture_radius>1e-5<", "<aperture_radius>0.1<");
        let wall = Mesh::square(1.0, at).text("wall", "grey") + &model("wall");
        let lamp = "<background><spectrum><uniform><value>1</value></uniform></spectrum></background>";
        scene_file(&[settings(8, ""), camera, grey("grey", 0.5), wall, lamp.to_owned()])
    };
    let ray = |camera_more: &str, at: f64| {
        let scene = scene(&text(camera_more, at));
        scene.camera.ray(Vec2::new(0.2, 0.7), Vec2::new(0.9, 0.4))
    };
    let given = |d: f64| format!("<focus_distance>{d}</focus_distance>");
    for at in [1.0, 3.5] {
        let [auto, fixed] = [ray("<autofocus/>", at), ray(&given(5.0 - at), at)];
        assert!((auto.direction - fixed.direction).length() < 1e-6);
        assert_eq!(ray(&format!("<autofocus/>{}", given(77.0)), at), auto);
    }
    // A shifted lens has something else in the middle: here a slope of 1 : 5 leads past the step. The plane of focus lies
    // 4 m ahead, though the way there is longer.
    let step = Mesh::square(0.4, 2.5).text("step", "grey") + &model("step") + "</scene>";
    let shift = "<lens_shift_up_distance>0.01</lens_shift_up_distance>";
    let [auto, fixed] = [String::from("<autofocus/>"), given(4.0)].map(|focus| {
        let text = text(&(focus + shift), 1.0).replace("</scene>", &step);
        let scene = scene(&text);
        scene.camera.ray(Vec2::new(0.2, 0.7), Vec2::new(0.9, 0.4))
    });
    assert!((auto.direction - fixed.direction).length() < 1e-6);
    // A pane that is not there is not what the camera sees.
    let pane = null("pane") + &Mesh::square(1.0, 4.2).text("pane", "pane") + &model("pane") + "</scene>";
    let behind = scene(&text("<autofocus/>", 1.0).replace("</scene>", &pane));
    assert_eq!(behind.camera.ray(Vec2::new(0.2, 0.7), Vec2::new(0.9, 0.4)), ray("<autofocus/>", 1.0));
    // The wall lies behind the camera: parallel rays.
    let far = scene(&text("<autofocus/>", 9.0));
    let at = |u: Real| far.camera.ray(Vec2::new(0.2, 0.7), Vec2::new(u, 0.4)).direction;
    assert!((at(0.1) - at(0.9)).length() < 1e-6);
}
