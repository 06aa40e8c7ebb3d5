//! Spheres, planes, instances, reflections: the surface of each.

mod common;

use common::{KERNELS, Random, bumpy_sphere, options, place, ray, real, triangle_cloud, vec};
use indigo_geom::{
    Accel, BuildOptions, MeshBuffers, Movement, NoStore, Object, Ray, TriangleMesh, offset_origin,
    offset_target,
};
use indigo_math::{Bounds3, Float, Mat3, Motion, Pose, Real, Transform, Vec3, Vec3d};

fn shapes(objects: Vec<Object>) -> Accel {
    Accel::build(Vec::new(), objects, &BuildOptions::default(), &NoStore).unwrap()
}

fn sphere(center: Vec3d, radius: f64) -> Accel {
    shapes(vec![Object::Sphere { center, radius }])
}

/// Transforms that rotate, shear, scale unevenly and reflect; the second is a reflection.
fn transforms() -> Vec<Transform> {
    let make = |m, t: [f64; 3]| Transform::new(Mat3::from_rows(m), t.into()).unwrap();
    vec![
        make([0.6, -0.8, 0.0, 0.8, 0.6, 0.0, 0.0, 0.0, 1.0], [3.0, 0.0, 0.0]),
        make([-1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0], [0.0, 4.0, 0.0]),
        make([1.0, 0.5, 0.0, 0.0, 1.0, 0.2, 0.3, 0.0, 2.0], [0.0, 0.0, -5.0]),
        make([0.2, 0.0, 0.0, 0.0, -3.0, 0.0, 0.0, 0.0, -0.7], [-4.0, 1.0, 2.0]),
        make([0.0, 0.0, -1.0, 0.0, 2.0, 0.3, 1.5, 0.0, 0.0], [1.0, -6.0, 1.0]),
    ]
}

#[test]
fn a_huge_sphere_seen_from_a_millimetre() {
    // The top of the sphere is at the origin of render space.
    let accel = sphere(Vec3d::new(0.0, 0.0, -1000.0), 1000.0);
    let r = ray(Vec3d::new(0.0, 0.0, 1e-3), Vec3d::new(0.0, 0.0, -1.0));
    let hit = accel.intersect(&r).unwrap();
    assert!((hit.t.to_f64() - 1e-3).abs() < 1e-9, "{}", hit.t);
    let point = accel.surface(&r, &hit);
    assert!(point.p.length() < 1e-9);
    assert_eq!(point.n_g, Vec3::new(0.0, 0.0, 1.0));
}

#[test]
fn a_sphere_from_inside_and_outside_and_at_a_graze() {
    let mut random = Random(11);
    for _ in 0..20_000 {
        let radius = 10f64.powf(random.range(-3.0, 3.0));
        let center = random.in_box(10.0);
        let accel = sphere(center, radius);
        let o = center + random.direction() * (radius * random.range(0.0, 3.0));
        let r = ray(o, random.direction() * random.range(0.1, 10.0));
        // The exact ray in double precision.
        let (o, d) = (vec(r.o), vec(r.d));
        let closest = o - center - d * ((o - center).dot(d) / d.length2());
        let (distance, ahead) = (closest.length(), (center - o).dot(d) > 0.0);
        let inside = (o - center).length() < radius;
        let doubtful = ((distance - radius) / radius).abs() < 1e-6
            || (((o - center).length() - radius) / radius).abs() < 1e-6;
        if doubtful {
            continue;
        }
        let hit = accel.intersect(&r);
        assert_eq!(hit.is_some(), inside || (ahead && distance < radius));
        assert_eq!(accel.occluded(&r), hit.is_some());
        if let Some(hit) = hit {
            let s = accel.surface(&r, &hit);
            let off = ((vec(s.p) - center).length() - radius).abs();
            assert!(off <= vec(s.p_error).length(), "{off} beyond {:?}", s.p_error);
            let along = (vec(s.p) - (o + d * hit.t.to_f64())).length();
            let size = (hit.t.to_f64() * d.length() + vec(s.p).length() + radius) * 1e-6;
            assert!(along < size, "{along} {size}");
            assert!(
                (vec(s.n_g) - (vec(s.p) - center).normalized()).length()
                    < 1e-5 + vec(s.p_error).length() * 4.0 / radius
            );
            let from_inside = vec(s.n_g).dot(d) > 0.0;
            assert_eq!(from_inside, inside);
        }
    }
}

#[test]
fn planes_are_met_from_both_sides_and_face_their_normal() {
    let accel = shapes(vec![
        Object::Plane { normal: Vec3d::new(0.0, 0.0, 5.0), dist: 10.0, uv_origin: Vec3d::ZERO },
        Object::Plane { normal: Vec3d::new(0.0, 0.0, -1e-30), dist: 1e-30, uv_origin: Vec3d::ZERO },
    ]);
    let down = ray(Vec3d::new(1.0, 2.0, 7.0), Vec3d::new(0.0, 0.0, -0.5));
    let hit = accel.intersect(&down).unwrap();
    assert_eq!((hit.object, hit.t), (0, 10.0));
    let s = accel.surface(&down, &hit);
    assert_eq!((s.p, s.n_g), (Vec3::new(1.0, 2.0, 2.0), Vec3::new(0.0, 0.0, 1.0)));
    let up = ray(Vec3d::new(0.0, 0.0, -3.0), Vec3d::new(0.0, 0.0, 1.0));
    let hit = accel.intersect(&up).unwrap();
    assert_eq!((hit.object, hit.t), (1, 2.0));
    assert_eq!(accel.surface(&up, &hit).n_g, Vec3::new(0.0, 0.0, -1.0));
    assert!(accel.intersect(&ray(Vec3d::ZERO, Vec3d::new(1.0, 1.0, 0.0))).is_none());
    assert!(accel.occluded(&up) && !accel.occluded(&Ray { t_max: 2.0, ..up }));
}

/// A mesh used by five objects, once as instances and once baked.
fn instanced_and_baked(mesh: &TriangleMesh, kernel: indigo_geom::KernelChoice) -> [Accel; 2] {
    [0, usize::MAX].map(|bake_limit| {
        let options = BuildOptions { bake_limit, ..options(kernel) };
        let objects = transforms().into_iter().map(|t| place(0, t)).collect();
        Accel::build(vec![mesh.clone()], objects, &options, &NoStore).unwrap()
    })
}

#[test]
fn instances_and_baked_meshes_are_the_same_surfaces() {
    let mesh = bumpy_sphere(60);
    for kernel in KERNELS {
        let [instanced, baked] = instanced_and_baked(&mesh, kernel);
        assert_eq!((instanced.stats().instances, baked.stats().instances), (5, 0));
        let mut random = Random(21);
        let (mut met, mut differing) = (0, 0);
        for _ in 0..20_000 {
            let from = random.in_box(8.0);
            let target = transforms()[random.index(5)].origin() + random.in_box(1.0);
            let r = ray(from, (target - from) * random.range(0.1, 10.0));
            assert_eq!(instanced.occluded(&r), instanced.intersect(&r).is_some());
            let (Some(a), Some(b)) = (instanced.intersect(&r), baked.intersect(&r)) else {
                differing += usize::from(instanced.occluded(&r) != baked.occluded(&r));
                continue;
            };
            met += 1;
            if (a.object, a.primitive) != (b.object, b.primitive) {
                differing += 1;
                continue;
            }
            let (p, q) = (instanced.surface(&r, &a), baked.surface(&r, &b));
            let cosine = vec(p.n_g).dot(vec(r.d)).abs() / vec(r.d).length();
            assert!((vec(p.p) - vec(q.p)).length() < 1e-5 / cosine.max(1e-2), "{p:?} {q:?}");
            assert!((vec(p.n_g) - vec(q.n_g)).length() < 1e-4, "{p:?} {q:?}");
        }
        assert!(met > 4000 && differing < met / 500, "{met} met, {differing} differ at edges");
    }
}

#[test]
fn normals_face_outwards_under_every_transform() {
    // The mesh is star-shaped round its centre and winds outwards.
    let mesh = bumpy_sphere(40);
    let inverted = {
        let normals = mesh.positions().iter().map(|p| p.map(|x| -x)).collect();
        let (positions, triangles) = (mesh.positions().to_vec(), mesh.triangles().to_vec());
        TriangleMesh::new(MeshBuffers { positions, triangles, normals, smooth: true, ..Default::default() })
            .unwrap()
    };
    for accel in instanced_and_baked(&inverted, indigo_geom::KernelChoice::Fastest) {
        let mut random = Random(31);
        for (i, transform) in transforms().iter().enumerate() {
            for _ in 0..500 {
                let r = ray(transform.origin(), random.direction());
                let hit = accel.intersect(&r).unwrap();
                assert_eq!(hit.object as usize, i);
                let s = accel.surface(&r, &hit);
                assert!(vec(s.n_g).dot(vec(r.d)) > 0.0, "{s:?}");
                assert!(s.n_g.dot(s.n_s) >= 0.0, "{s:?}");
                assert!((s.n_g.length() - 1.0).abs() < 1e-5 && (s.n_s.length() - 1.0).abs() < 1e-5);
            }
        }
    }
}

#[test]
fn rays_that_leave_a_surface_do_not_meet_it_again() {
    let mut random = Random(41);
    let mut tried = 0;
    for power in -3..=6 {
        let scale = 10f64.powi(power);
        let linear = Mat3::scaling(scale);
        for (instanced, object) in [(false, 0), (true, 0), (false, 1)] {
            let origin = random.in_box(3.0 * scale);
            let mesh = triangle_cloud(64, 0.7, &mut random);
            let transform = Transform::new(linear, origin).unwrap();
            let far = Transform::new(linear, origin + Vec3d::splat(1e3 * scale)).unwrap();
            let objects = if object == 1 {
                vec![Object::Sphere { center: origin, radius: scale }; 2]
            } else {
                vec![place(0, transform), place(0, far)]
            };
            let options =
                BuildOptions { bake_limit: if instanced { 0 } else { 1 << 20 }, ..BuildOptions::default() };
            let accel = Accel::build(vec![mesh], objects, &options, &NoStore).unwrap();
            for _ in 0..40_000 {
                let target = origin + random.in_box(scale);
                let from = origin + random.direction() * (2.0 * scale);
                let r = ray(from, target - from);
                let Some(hit) = accel.intersect(&r) else { continue };
                let s = accel.surface(&r, &hit);
                let dir: Vec3 = random.direction().cast();
                let o = offset_origin(s.p, s.p_error, s.n_g, dir, 0.0);
                tried += 1;
                if let Some(again) = accel.intersect(&Ray::new(o, dir)) {
                    let same = again.object == hit.object && again.primitive == hit.primitive;
                    // Only a sphere's far side may be met again.
                    let through = object == 1 && dir.dot(s.n_g) < 0.0;
                    assert!(!same || through, "scale {scale} {s:?} {dir:?} {again:?}");
                    assert!(!through || again.t.to_f64() > 1e-5 * scale, "{again:?}");
                }
            }
        }
    }
    assert!(tried > 400_000, "{tried}");
}

#[test]
fn rays_that_end_at_a_surface_do_not_meet_it() {
    let mut random = Random(43);
    let mut tried = 0;
    for (power, instanced) in (-3..=6).zip([false, true].into_iter().cycle()) {
        let scale = 10f64.powi(power);
        // Small beside where it is: what is near the camera has small coordinates, and rounds no less for that.
        let origin = random.in_box(0.1 * scale);
        let transform = Transform::new(Mat3::scaling(scale), origin).unwrap();
        let far = Transform::new(Mat3::scaling(scale), origin + Vec3d::splat(1e3 * scale)).unwrap();
        let options =
            BuildOptions { bake_limit: if instanced { 0 } else { 1 << 20 }, ..BuildOptions::default() };
        let mesh = triangle_cloud(64, 0.7, &mut random);
        let objects = vec![place(0, transform), place(0, far)];
        let accel = Accel::build(vec![mesh], objects, &options, &NoStore).unwrap();
        for _ in 0..20_000 {
            let (u, v) = (random.unit(), random.unit());
            let bary = if u + v > 1.0 { (1.0 - u, 1.0 - v) } else { (u, v) };
            let triangle = (random.unit() * 64.0) as u32;
            let s = accel.triangle_point(0, triangle, (real(bary.0), real(bary.1))).unwrap();
            let distance = scale * 10f64.powf(4.0 * random.unit() - 1.0);
            let o: Vec3 = (vec(s.p) + random.direction() * distance).cast();
            let end = offset_target(s.p, s.p_error, s.n_g, o - s.p, 0.0);
            let ray = Ray { t_max: 1.0, ..Ray::new(o, end - o) };
            tried += 1;
            if let Some(hit) = accel.intersect(&ray) {
                assert!(
                    hit.object != 0 || hit.primitive != triangle,
                    "scale {scale} {distance} {s:?} {hit:?}"
                );
            }
        }
    }
    assert_eq!(tried, 200_000);
}

#[test]
fn the_offset_has_a_floor() {
    let (p, n) = (Vec3::new(1.0, 2.0, 3.0), Vec3::new(0.0, 0.0, 1.0));
    let below = offset_origin(p, Vec3::ZERO, n, Vec3::new(0.0, 0.6, -0.8), real(1e-3));
    assert!((below.z.to_f64() - 2.999).abs() < 1e-6 && below.x == 1.0 && below.y == 2.0);
    // Without error or floor what remains is the rounding of the sum.
    let above = offset_origin(p, Vec3::ZERO, n, n, 0.0);
    assert!((above - p).length() <= 4.0 * indigo_math::Real::EPSILON * p.length());
}

#[test]
fn texture_coordinates_and_their_derivatives() {
    let mesh = TriangleMesh::new(MeshBuffers {
        positions: vec![[0.0; 3], [2.0, 0.0, 0.0], [0.0, 3.0, 0.0]],
        triangles: vec![[0, 1, 2]],
        uv_sets: vec![vec![[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]], vec![[5.0, 5.0]; 3]],
        triangle_materials: vec![7],
        ..MeshBuffers::default()
    })
    .unwrap();
    let accel = common::single(mesh, &BuildOptions::default());
    let r = ray(Vec3d::new(0.5, 0.75, 1.0), Vec3d::new(0.0, 0.0, -1.0));
    let s = accel.surface(&r, &accel.intersect(&r).unwrap());
    assert_eq!((s.material_slot, s.n_g, s.n_s), (7, Vec3::new(0.0, 0.0, 1.0), Vec3::new(0.0, 0.0, 1.0)));
    let uv = accel.uv(&s, 0);
    assert!((uv.x - 0.25).abs() < 1e-6 && (uv.y - 0.25).abs() < 1e-6);
    assert_eq!(accel.uv_derivatives(&s, 0), Some((Vec3::new(2.0, 0.0, 0.0), Vec3::new(0.0, 3.0, 0.0))));
    assert_eq!(accel.uv(&s, 9).x, 0.0);
    // A set that does not vary, and one that is missing.
    assert_eq!([1, 9].map(|set| accel.uv_derivatives(&s, set)), [None; 2]);
}

#[test]
fn sphere_coordinates_match_their_derivatives() {
    let (center, radius) = (Vec3d::new(1.0, -2.0, 0.5), 3.0);
    let accel = sphere(center, radius);
    let at = |theta: f64, phi: f64| {
        let n = Vec3d::new(theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos());
        let r = ray(center + n * 5.0, -n);
        accel.surface(&r, &accel.intersect(&r).unwrap())
    };
    let (theta, phi) = (1.1, 4.0);
    let s = at(theta, phi);
    let uv = accel.uv(&s, 0);
    assert!((uv.x.to_f64() - phi / std::f64::consts::TAU).abs() < 1e-6);
    assert!((uv.y.to_f64() - theta / std::f64::consts::PI).abs() < 1e-6);
    let (du, dv) = accel.uv_derivatives(&s, 0).unwrap();
    let h = 1e-3;
    let slope = |a: Vec3, b: Vec3, period: f64| (vec(b) - vec(a)) * (period / (2.0 * h));
    let by_u = slope(at(theta, phi - h).p, at(theta, phi + h).p, std::f64::consts::TAU);
    let by_v = slope(at(theta - h, phi).p, at(theta + h, phi).p, std::f64::consts::PI);
    assert!((by_u - vec(du)).length() < 2e-2, "{by_u:?} {du:?}");
    assert!((by_v - vec(dv)).length() < 2e-2, "{by_v:?} {dv:?}");
}

#[test]
fn a_scene_of_everything_has_the_right_bounds_and_hits() {
    let objects = vec![
        place(0, Transform::IDENTITY),
        Object::Sphere { center: Vec3d::new(0.0, 0.0, 5.0), radius: 1.0 },
        Object::Plane { normal: Vec3d::new(0.0, 0.0, 1.0), dist: -3.0, uv_origin: Vec3d::ZERO },
        place(1, Transform::translation(Vec3d::new(5.0, 0.0, 0.0))),
        place(1, Transform::translation(Vec3d::new(-5.0, 0.0, 0.0))),
    ];
    let meshes = vec![bumpy_sphere(30), bumpy_sphere(20)];
    let options = BuildOptions { bake_limit: 0, ..BuildOptions::default() };
    let accel = Accel::build(meshes, objects, &options, &NoStore).unwrap();
    let looks = [([0.0, 0.0, 1.0], 0), ([1.0, 0.0, 0.0], 3), ([-1.0, 0.0, 0.0], 4), ([0.0, 0.01, -1.0], 2)];
    for (d, object) in looks {
        let r = ray(Vec3d::from(d) * 2.0, d.into());
        let expected = if object == 0 { 1 } else { object };
        assert_eq!(accel.intersect(&r).map(|h| h.object), Some(expected));
        let back = ray(Vec3d::from(d) * 3.0, -Vec3d::from(d));
        assert_eq!(accel.intersect(&back).map(|h| h.object), Some(0));
    }
    let b = accel.bounds();
    let near = |a: indigo_math::Real, b: f64| (a.to_f64() - b).abs() < 0.2;
    assert!(near(b.lo.x, -6.0) && near(b.hi.x, 6.0) && near(b.hi.z, 6.0) && near(b.lo.z, -1.0), "{b:?}");
    let stats = accel.stats();
    assert_eq!((stats.instances, stats.shapes), (2, 2));
    assert_eq!(stats.triangles, 2 * 30 * 29 + 2 * 20 * 19);
}

#[test]
fn bounds_of_nothing_are_empty() {
    assert!(shapes(Vec::new()).bounds().is_empty());
    let _: Bounds3 = shapes(Vec::new()).bounds();
}

/// What moves is met where it is at the time of the ray, as an instance that stands there is, whatever else is in the scene.
#[test]
fn a_moving_mesh_is_where_it_is_at_the_time_of_the_ray() {
    let turn = |angle: f64| ((angle / 2.0).cos(), Vec3d::new(0.0, 0.6, 0.8) * (angle / 2.0).sin());
    let pose = |pos: [f64; 3], angle| Pose { pos: pos.into(), turn: turn(angle) };
    let motion = Motion::new(vec![
        (0.0, pose([0.0; 3], 0.0)),
        (0.7, pose([3.0, 1.0, 0.0], 2.5)),
        (1.0, pose([0.0, 5.0, 1.0], 2.0)),
    ]);
    let linear = transforms()[2].linear();
    let movement = Movement::new(linear, motion.expect("poses")).expect("an invertible map");
    let mesh = || bumpy_sphere(12);
    let still = Object::Mesh { mesh: 1, transform: Transform::translation(Vec3d::new(0.0, 0.0, -8.0)) };
    let moved = |time| Object::Mesh { mesh: 0, transform: movement.at(time) };
    let mut random = Random(31);
    for kernel in KERNELS {
        // An instance that stands still is one since its mesh is used more than once.
        let instanced = BuildOptions { bake_limit: 0, ..options(kernel) };
        let moving = Accel::build_moving(
            vec![mesh(), mesh()],
            vec![moved(0.0), still],
            vec![(0, movement.clone())],
            &instanced,
            &NoStore,
        )
        .unwrap();
        let mut hits = 0;
        for i in 0..=10u16 {
            let time = Real::from(i) / 10.0;
            let far = Object::Mesh { mesh: 0, transform: Transform::translation(Vec3d::new(0.0, 1e5, 0.0)) };
            let objects = vec![moved(time), still, far];
            let standing = Accel::build(vec![mesh(), mesh()], objects, &instanced, &NoStore).unwrap();
            let bounds = moving.object_bounds(0);
            assert!(
                bounds.contains(standing.object_bounds(0).lo)
                    && bounds.contains(standing.object_bounds(0).hi)
            );
            for _ in 0..300 {
                let from = random.in_box(8.0);
                // Near its middle, wherever that is.
                let aim = movement.at(time).point(random.in_box(1.5)) - from;
                let r = Ray { time, ..ray(from, aim) };
                let (hit, expected) = (moving.intersect(&r), standing.intersect(&r));
                assert_eq!(hit, expected);
                assert_eq!(moving.occluded(&r), expected.is_some());
                if let Some(hit) = hit {
                    assert_eq!(moving.surface(&r, &hit).p, standing.surface(&r, &hit).p);
                    assert_eq!(moving.surface(&r, &hit).n_g, standing.surface(&r, &hit).n_g);
                    hits += usize::from(hit.object == 0);
                }
            }
        }
        assert!(hits > 100, "{hits} hits of what moves are few");
    }
    // A sphere has no place in time, and nothing has two meshes.
    let sphere = Object::Sphere { center: Vec3d::ZERO, radius: 1.0 };
    let refused = Accel::build_moving(
        vec![mesh()],
        vec![sphere],
        vec![(0, movement)],
        &BuildOptions::default(),
        &NoStore,
    );
    assert!(refused.is_err());
}
