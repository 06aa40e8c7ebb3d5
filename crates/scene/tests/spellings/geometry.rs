//! Geometry and cameras: models by uid, their own materials, keyframes.

use super::common::*;
use indigo_math::Real;

fn of(models: &str) -> String {
    let materials = ["m", "n"].map(|name| {
        let uid = if name == "m" { 1 } else { 2 };
        let albedo = 0.25 * f64::from(uid);
        format!("<material><uid>{uid}</uid><name>{name}</name><diffuse><albedo_spectrum><uniform><value>{albedo}</value></uniform></albedo_spectrum></diffuse></material>")
    });
    format!("{CAMERA}{LIGHT}{MESH}{}{models}", materials.concat())
}

#[test]
fn models_go_by_uid_and_have_materials_of_their_own() {
    let new = |materials: &str| {
        of(&format!(
            "<model2><name>a thing</name><uid>9</uid><pos>1 2 3</pos><scale>0.5</scale><rotation><matrix>1 0 0 0 1 0 0 0 1 0 0 0</matrix></rotation><geometry_uid>7</geometry_uid>{materials}</model2>"
        ))
    };
    let by_uid = "<materials><material_uid>1</material_uid><material_uid>2</material_uid></materials>";
    let swapped = "<materials><material_uid>2</material_uid><material_name>m</material_name></materials>";
    assert_same([&of(MODEL), &new(by_uid), &new(swapped)]);
    assert_same([&of(MODEL), &new(""), &new(swapped)]);
    let short = "<materials><material_uid>1</material_uid></materials>";
    scene_with(&new(short), &["W0318 the mesh has 2 materials, and <materials> lists 1"]);
}

#[test]
fn a_keyframe_takes_the_place_of_a_position_and_turns_what_has_been_turned() {
    let old = "<model><pos>1 2 3</pos><scale>2</scale><rotation><matrix>0 -1 0 1 0 0 0 0 1</matrix></rotation><mesh_name>tri</mesh_name></model>";
    let key = |time: f64, pos: &str, angle: f64| {
        format!(
            "<keyframe><time>{time}</time><pos>{pos}</pos><rotation_quaternion><axis>0 0 5</axis><angle>{angle}</angle></rotation_quaternion></keyframe>"
        )
    };
    let new = |keys: &str| {
        format!(
            "<model>{keys}<scale>2</scale><rotation><matrix>0 -1 0 1 0 0 0 0 1</matrix></rotation><mesh_name>tri</mesh_name></model>"
        )
    };
    let still = new(&key(0.0, "1 2 3", 0.0));
    assert_same([&of(old), &of(&still), &of(&new(&key(0.0, "1 2 4", 0.0)))]);
    // Twice the same is no motion.
    assert_same([&of(old), &of(&new(&(key(0.0, "1 2 3", 0.0) + &key(1.0, "1 2 3", 0.0)))), &of("")]);
    // A quarter turn clockwise undoes the one of the matrix.
    let corner = |text: &str, expected: &[&str]| {
        let scene = scene_with(&of(text), expected);
        let indigo_geom::Object::Mesh { transform, .. } = scene.accel.objects()[0] else { panic!("a mesh") };
        transform.vector(indigo_math::Vec3d::new(1.0, 0.0, 0.0)).to_array()
    };
    let turned = corner(&new(&key(0.0, "1 2 3", std::f64::consts::FRAC_PI_2)), &[]);
    assert!((turned[0] - 2.0).abs() < 1e-12 && turned[1].abs() < 1e-12, "{turned:?}");
    // What moves is where it is.
    let keys = key(-1.0, "0 2 3", 0.0) + &key(1.0, "2 2 3", 0.0);
    let moving = scene_with(&of(&new(&keys)), &[]);
    let place = |time: Real| moving.accel.movement(0).expect("it moves").at(time).origin();
    let camera = indigo_math::Vec3d::new(0.0, -2.0, 1.0);
    assert_eq!([0.0, 0.5, 1.0].map(|t| (place(t) + camera).x), [1.0, 1.5, 2.0]);
    // What shines stands where it is when the shutter opens, which is said once for all.
    let shining = |model: &str| {
        let lamp = "<diffuse><base_emission><constant><uniform><value>1</value></uniform></constant></base_emission></diffuse>";
        let grey = "<name>m</name><diffuse><albedo_spectrum><uniform><value>0.25</value></uniform></albedo_spectrum></diffuse>";
        of(&format!("{model}{model}")).replace(grey, &format!("<name>m</name>{lamp}"))
    };
    let warning = "W0317 motion is not rendered of what shines: the model stands";
    let twice = scene_with(&shining(&new(&keys)), &[warning]);
    assert!(twice.accel.movement(0).is_none() && twice.accel.movement(1).is_none());
    assert_eq!(dump(&twice), dump(&scene_with(&shining(old), &[])));
}

/// Half a turn and more between neighbours goes the other way, and a whole one nowhere.
#[test]
fn turns_that_go_the_shorter_way_are_told() {
    let key = |time: f64, axis: &str, angle: f64| {
        format!(
            "<keyframe><time>{time}</time><pos>1 2 3</pos><rotation_quaternion><axis>{axis}</axis><angle>{angle}</angle></rotation_quaternion></keyframe>"
        )
    };
    let model = |keys: &str| MODEL.replace("<pos>1 2 3</pos>", keys);
    let warning = "W0330 between two keyframes the angle changes by 355 degrees";
    scene_with(&of(&model(&(key(1.0, "0 0 2", 6.2) + &key(0.0, "0 0 1", 0.0)))), &[warning]);
    scene_with(&of(&model(&(key(0.0, "0 0 1", -3.0) + &key(1.0, "0 0 -1", -3.2)))), &[warning]);
    let camera = of(MODEL).replace("<pos>0 -2 1</pos>", &(key(0.0, "0 0 1", 0.0) + &key(1.0, "0 0 1", 6.2)));
    scene_with(&camera, &[warning]);
    for fine in [
        key(0.0, "0 0 1", 0.0) + &key(1.0, "0 0 1", 3.13),
        key(0.0, "0 0 1", 0.0) + &key(0.5, "0 0 1", 3.0) + &key(1.0, "0 0 1", 6.0),
        // About other axes nobody knows which way is meant.
        key(0.0, "0 0 1", 3.0) + &key(1.0, "0 1 0", 3.0),
        // It jumps there.
        key(0.5, "0 0 1", 0.0) + &key(0.5, "0 0 1", 6.0),
    ] {
        scene_with(&of(&model(&fine)), &[]);
    }
}

/// Texture coordinates of a plane are those of the world, wherever the camera stands.
#[test]
fn a_plane_holds_its_texture_coordinates() {
    let plane = "<plane><normal>0 0.6 0.8</normal><dist>-1</dist><material_name>m</material_name></plane>";
    let at = |camera: [f64; 3]| {
        let [x, y, z] = camera;
        let scene =
            scene_with(&of(plane).replace("<pos>0 -2 1</pos>", &format!("<pos>{x} {y} {z}</pos>")), &[]);
        let (from, camera) = (indigo_math::Vec3d::new(3.0, 4.0, 5.0), indigo_math::Vec3d::from(camera));
        let ray = indigo_geom::Ray::new((from - camera).cast(), indigo_math::Vec3::new(0.0, 0.0, -1.0));
        let hit = scene.accel.intersect(&ray).expect("the plane");
        scene.accel.uv(&scene.accel.surface(&ray, &hit), 0)
    };
    let (here, there) = (at([0.0, -2.0, 1.0]), at([1.5, -7.25, 3.0]));
    assert!((here.x - there.x).abs() < 1e-5 && (here.y - there.y).abs() < 1e-5, "{here:?} {there:?}");
    assert!(here.x.abs() + here.y.abs() > 1.0, "{here:?}");
}

#[test]
fn a_camera_may_move() {
    let keys = "<keyframe><time>0</time><pos>0 -2 1</pos></keyframe><keyframe><time>1</time><pos>0 -2 3</pos><rotation_quaternion><axis>0 0 1</axis><angle>0.2</angle></rotation_quaternion></keyframe>";
    let scene = scene_with(&of(MODEL).replace("<pos>0 -2 1</pos>", keys), &[]);
    let middle = indigo_math::Vec2::new(0.5, 0.5);
    let ray = |time: Real| scene.camera.ray_at(middle, middle, time);
    assert_eq!(ray(0.0), scene.camera.ray(middle, middle));
    for (time, height, angle) in [(0.5, 1.0, 0.1), (1.0, 2.0, 0.2)] as [(Real, Real, Real); 2] {
        let ray = ray(time);
        assert!((ray.origin.z - height).abs() < 1e-5 && ray.origin.y.abs() < 1e-5, "{ray:?}");
        assert!((ray.direction.x - angle.sin()).abs() < 1e-5, "{ray:?}");
    }
}

/// What the shift does is told by the pictures of the camera's own tests.
#[test]
fn a_lens_may_be_shifted_either_way() {
    let scene = |more: &str| of(MODEL).replace("</camera>", &format!("{more}</camera>"));
    let shift = |name: &str, metres: f64| {
        scene(&format!("<lens_shift_{name}_distance>{metres}</lens_shift_{name}_distance>"))
    };
    for name in ["right", "up"] {
        assert_same([&scene(""), &shift(name, 0.0), &shift(name, -0.001)]);
    }
    let [right, up] = ["right", "up"].map(|name| dump(&scene_with(&shift(name, 0.01), &[])));
    assert!(right != up, "the two are not the same");
}

#[test]
fn a_camera_may_have_a_keyframe() {
    let scene = |camera: &str| of(MODEL).replace(CAMERA, camera);
    let key = |angle: f64| {
        format!(
            "<keyframe><time>0</time><pos>0 -2 1</pos><rotation_quaternion><axis>0 0 1</axis><angle>{angle}</angle></rotation_quaternion></keyframe>"
        )
    };
    let keyed = |angle: f64| CAMERA.replace("<pos>0 -2 1</pos>", &key(angle));
    assert_same([&scene(CAMERA), &scene(&keyed(0.0)), &scene(&keyed(0.1))]);
    // Clockwise seen from above: towards +x.
    let scene = scene_with(&scene(&keyed(0.1)), &[]);
    let forwards = scene.camera.forwards();
    assert!((forwards.x - 0.1_f32.sin()).abs() < 1e-6 && forwards.y > 0.9, "{forwards:?}");
    let neither = findings(&loaded(&of(MODEL).replace("<pos>0 -2 1</pos>", "")));
    assert!(neither[0].1.starts_with("E0201 <camera> has none of <pos>, <keyframe>"), "{neither:?}");
}
