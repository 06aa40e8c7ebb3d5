//! What must not leak, panic or hang.

mod common;

use common::{KERNELS, Random, bumpy_sphere, mesh, options, place, ray, real, single, triangle_cloud, vec};
use indigo_geom::{
    Accel, BuildError, BuildOptions, KernelChoice, MeshBuffers, MeshError, NoStore, Object, Ray, TriangleMesh,
};
use indigo_math::{Float, Mat3, Real, Transform, Vec3, Vec3d};

#[test]
fn no_ray_slips_through_the_vertices_and_edges_of_a_closed_mesh() {
    let closed = bumpy_sphere(170);
    assert!(closed.triangles().len() > 50_000);
    let mut random = Random(1);
    let origin = Vec3d::new(0.013, 0.007, -0.011).cast::<f32>();
    let aim = |p: [f32; 3]| Vec3::<f32>::from(p) - origin;
    let mut directions: Vec<Vec3<f32>> = Vec::new();
    for p in closed.positions() {
        directions.extend([aim(*p), aim(*p).normalized()]);
    }
    for t in closed.triangles() {
        for k in 0..3 {
            let [a, b] =
                [t[k], t[(k + 1) % 3]].map(|i| Vec3d::from(closed.positions()[i as usize].map(f64::from)));
            directions.push(aim((a + (b - a) * random.unit()).cast::<f32>().to_array()).normalized());
        }
    }
    for kernel in KERNELS {
        for fast_threshold in [0, usize::MAX] {
            let accel = single(closed.clone(), &BuildOptions { fast_threshold, ..options(kernel) });
            let lost = |d: &&Vec3<f32>| {
                let r = Ray::new(origin.cast(), d.cast());
                accel.intersect(&r).is_none() || !accel.occluded(&r)
            };
            assert_eq!(directions.iter().filter(lost).count(), 0);
        }
    }
}

#[test]
fn an_instance_does_not_leak_either() {
    let closed = bumpy_sphere(60);
    let linear = Mat3::from_rows([1.3, 0.2, 0.0, -0.4, 0.9, 0.7, 0.1, -0.5, 2.0]);
    let transforms = [Vec3d::new(10.0, -20.0, 30.0), Vec3d::ZERO].map(|t| Transform::new(linear, t).unwrap());
    let objects = transforms.iter().map(|t| place(0, *t)).collect();
    let accel = Accel::build(
        vec![closed.clone()],
        objects,
        &BuildOptions { bake_limit: 0, ..BuildOptions::default() },
        &NoStore,
    )
    .unwrap();
    for (i, transform) in transforms.iter().enumerate() {
        let o = transform.origin();
        for p in closed.positions() {
            let target = transform.point(Vec3d::from(p.map(f64::from)));
            assert_eq!(accel.intersect(&ray(o, target - o)).map(|h| h.object as usize), Some(i));
        }
    }
}

#[test]
fn an_empty_scene_is_hit_by_nothing() {
    let accels = [
        Accel::build(Vec::new(), Vec::new(), &BuildOptions::default(), &NoStore).unwrap(),
        single(mesh(Vec::new(), Vec::new()), &BuildOptions::default()),
        single(mesh(vec![[1.0; 3]], vec![[0, 0, 0]]), &BuildOptions::default()),
    ];
    for accel in accels {
        let r = ray(Vec3d::ZERO, Vec3d::new(0.0, 0.0, 1.0));
        assert!(accel.intersect(&r).is_none() && !accel.occluded(&r));
        assert!(accel.bounds().is_empty());
        assert_eq!(accel.stats().triangles, 0);
    }
}

#[test]
fn triangles_that_are_not_finite_or_flat_are_left_out_and_counted() {
    let good = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let mut positions = good.to_vec();
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        positions.extend([[bad, 0.0, 0.0], [1.0, bad, 0.0], [0.0, 1.0, bad]]);
    }
    let mut triangles = vec![[0, 1, 2], [0, 0, 1], [1, 2, 1]];
    triangles.extend((1..4).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]));
    for fast_threshold in [0, usize::MAX] {
        let options = BuildOptions { fast_threshold, ..BuildOptions::default() };
        let accel = single(mesh(positions.clone(), triangles.clone()), &options);
        assert_eq!((accel.stats().triangles, accel.stats().skipped_triangles), (1, 5));
        let hit = accel.intersect(&ray(Vec3d::new(0.2, 0.2, 1.0), Vec3d::new(0.0, 0.0, -1.0)));
        assert!(hit.is_some_and(|h| h.primitive == 0 && (h.t - 1.0).abs() < 1e-6), "{hit:?}");
    }
}

#[test]
fn extreme_coordinates_neither_panic_nor_hang() {
    let mut random = Random(3);
    let mut positions = Vec::new();
    for _ in 0..3000 {
        let scale = 10f64.powf(random.range(-44.0, 38.4));
        positions.push((random.direction() * scale).cast::<f32>().to_array());
    }
    let triangles = (0..1000).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    let extreme = mesh(positions, triangles);
    for kernel in KERNELS {
        for fast_threshold in [0, usize::MAX] {
            let accel = single(extreme.clone(), &BuildOptions { fast_threshold, ..options(kernel) });
            assert!(accel.stats().triangles > 0);
            for _ in 0..2000 {
                let scale = 10f64.powf(random.range(-44.0, 38.4));
                let r = ray(
                    random.direction() * scale,
                    random.direction() * 10f64.powf(random.range(-44.0, 38.4)),
                );
                if let Some(hit) = accel.intersect(&r) {
                    accel.surface(&r, &hit);
                }
                accel.occluded(&r);
            }
        }
    }
}

#[test]
fn a_million_equal_triangles_are_built_and_traced() {
    let positions = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let equal = mesh(positions, vec![[0, 1, 2]; 1_000_000]);
    for fast_threshold in [0, usize::MAX] {
        let accel = single(equal.clone(), &BuildOptions { fast_threshold, ..BuildOptions::default() });
        assert_eq!(accel.stats().triangles, 1_000_000);
        let r = ray(Vec3d::new(0.2, 0.2, 1.0), Vec3d::new(0.0, 0.0, -1.0));
        let hit = accel.intersect(&r);
        assert!(hit.is_some_and(|h| (h.t - 1.0).abs() < 1e-6), "{hit:?}");
        assert!(accel.occluded(&r));
    }
}

#[test]
fn a_tree_that_wants_to_be_deep_is_kept_shallow() {
    // Sizes in geometric progression make every SAH cut take off one triangle.
    let mut positions = Vec::new();
    for i in 0..4000 {
        let x = 1.01f64.powi(i) as f32;
        positions.extend([[x, 0.0, 0.0], [x * 1.005, 0.0, 0.0], [x, x * 1e-3, 0.0]]);
    }
    let triangles = (0..4000).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    let deep = mesh(positions.clone(), triangles);
    for fast_threshold in [0, usize::MAX] {
        // Debug builds check every push onto the traversal stack.
        let accel = single(deep.clone(), &BuildOptions { fast_threshold, ..BuildOptions::default() });
        let along = ray(Vec3d::new(-1.0, 1e-4, 0.0), Vec3d::new(1.0, 0.0, 0.0));
        accel.intersect(&along);
        for (i, p) in positions.chunks(3).enumerate().step_by(7) {
            let x = f64::from(p[0][0]);
            let target = Vec3d::new(x * 1.001, x * 1e-4, 0.0);
            let r = ray(target + Vec3d::new(0.0, 0.0, x), Vec3d::new(0.0, 0.0, -1.0));
            assert_eq!(accel.intersect(&r).map(|h| h.primitive), Some(i as u32));
        }
    }
}

/// A scene with all kinds of objects.
fn everything(kernel: KernelChoice) -> Accel {
    let mut random = Random(5);
    let meshes = vec![triangle_cloud(500, 0.3, &mut random), triangle_cloud(100, 0.3, &mut random)];
    let objects = vec![
        place(0, Transform::IDENTITY),
        place(1, Transform::translation(Vec3d::new(2.0, 0.0, 0.0))),
        place(1, Transform::translation(Vec3d::new(-2.0, 0.0, 0.0))),
        Object::Sphere { center: Vec3d::new(0.0, 3.0, 0.0), radius: 1.0 },
        Object::Plane { normal: Vec3d::new(0.0, 1.0, 0.0), dist: -2.0, uv_origin: Vec3d::ZERO },
    ];
    Accel::build(meshes, objects, &BuildOptions { bake_limit: 0, ..options(kernel) }, &NoStore).unwrap()
}

#[test]
fn rays_without_a_meaning_hit_nothing() {
    for kernel in KERNELS {
        let accel = everything(kernel);
        let (o, d) = (Vec3::new(0.1, 0.2, 5.0), Vec3::new(0.0, 0.0, -1.0));
        assert!(accel.intersect(&Ray::new(o, d)).is_some());
        for bad in [Real::NAN, Real::INFINITY, Real::NEG_INFINITY] {
            for axis in 0..3 {
                let spoil = |v: Vec3| {
                    let mut a = v.to_array();
                    a[axis] = bad;
                    Vec3::from(a)
                };
                for r in [Ray::new(spoil(o), d), Ray::new(o, spoil(d))] {
                    assert!(accel.intersect(&r).is_none() && !accel.occluded(&r), "{r:?}");
                }
            }
        }
        let without = [
            Ray::new(o, Vec3::ZERO),
            Ray { t_max: Real::NAN, ..Ray::new(o, d) },
            Ray { t_min: Real::NAN, ..Ray::new(o, d) },
            Ray { t_max: 0.0, ..Ray::new(o, d) },
            Ray { t_min: 9.0, t_max: 3.0, ..Ray::new(o, d) },
            Ray { t_max: -1.0, ..Ray::new(o, d) },
        ];
        for r in without {
            assert!(accel.intersect(&r).is_none() && !accel.occluded(&r), "{r:?}");
        }
        let behind = Ray { t_min: -100.0, ..Ray::new(o, -d) };
        assert_eq!(accel.intersect(&behind), accel.intersect(&Ray::new(o, -d)));
    }
}

#[test]
fn both_kernels_see_the_same_scene_of_everything() {
    let [a, b] = KERNELS.map(everything);
    let mut random = Random(6);
    let mut by_object = [0; 5];
    for i in 0..20_000 {
        let mut d = random.direction();
        if i % 5 == 0 {
            d.y = 0.0;
        }
        let r = ray(random.in_box(4.0), d);
        let hit = a.intersect(&r);
        assert_eq!(hit, b.intersect(&r));
        assert_eq!(a.occluded(&r), b.occluded(&r));
        assert_eq!(a.occluded(&r), hit.is_some());
        if let Some(h) = hit {
            by_object[h.object as usize] += 1;
        }
    }
    assert!(by_object.iter().all(|n| *n > 100), "{by_object:?}");
}

#[test]
fn a_ray_in_the_plane_of_a_box_side_is_not_lost() {
    // Zero direction components and an origin on the planes of the boxes.
    let quad = mesh(
        vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]],
        vec![[0, 1, 2], [0, 2, 3]],
    );
    for kernel in KERNELS {
        let accel = single(quad.clone(), &options(kernel));
        for (x, y) in
            [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0), (0.5, 0.0), (0.0, 0.5), (0.5, 0.5), (1.0, 0.3)]
        {
            for z in [-0.0, 0.0] {
                let r = Ray::new(Vec3::new(real(x), real(y), 1.0), Vec3::new(real(z), real(-z), -1.0));
                assert_eq!(accel.intersect(&r).map(|h| h.t), Some(1.0), "{r:?}");
            }
        }
    }
}

#[test]
fn unsound_scenes_are_errors() {
    let build = |object| Accel::build(Vec::new(), vec![object], &BuildOptions::default(), &NoStore).err();
    assert_eq!(
        build(place(0, Transform::IDENTITY)),
        Some(BuildError::NoSuchMesh { object: 0, mesh: 0, meshes: 0 })
    );
    let c = Vec3d::ZERO;
    for radius in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert_eq!(build(Object::Sphere { center: c, radius }), Some(BuildError::Unsound(0)));
    }
    assert_eq!(
        build(Object::Plane { normal: c, dist: 0.0, uv_origin: Vec3d::ZERO }),
        Some(BuildError::Unsound(0))
    );
    let up = Vec3d::new(0.0, 0.0, 1.0);
    assert_eq!(
        build(Object::Plane { normal: up, dist: f64::NAN, uv_origin: Vec3d::ZERO }),
        Some(BuildError::Unsound(0))
    );
}

#[test]
fn buffers_that_do_not_fit_are_errors() {
    let sound =
        MeshBuffers { positions: vec![[0.0; 3]; 3], triangles: vec![[0, 1, 2]], ..MeshBuffers::default() };
    let err = |change: fn(&mut MeshBuffers)| {
        let mut b = sound.clone();
        change(&mut b);
        TriangleMesh::new(b).err()
    };
    assert_eq!(err(|_| {}), None);
    let out = MeshError::IndexOutOfRange { triangle: 0, index: 3, vertices: 3 };
    assert_eq!(err(|b| b.triangles[0][1] = 3), Some(out));
    assert_eq!(err(|b| b.normals = vec![[0.0; 3]]), Some(MeshError::NormalCount { expected: 3, found: 1 }));
    let short = MeshError::UvCount { set: 1, expected: 3, found: 2 };
    assert_eq!(err(|b| b.uv_sets = vec![vec![[0.0; 2]; 3], vec![[0.0; 2]; 2]]), Some(short));
    let slots = MeshError::MaterialCount { expected: 1, found: 2 };
    assert_eq!(err(|b| b.triangle_materials = vec![0, 0]), Some(slots));
}

#[test]
fn points_of_triangles_that_are_not_there_are_none() {
    let accel = everything(KernelChoice::Fastest);
    let bary = (real(0.2), real(0.3));
    assert!(accel.triangle_point(0, 500, bary).is_none());
    assert!(accel.triangle_point(3, 0, bary).is_none() && accel.triangle_point(9, 0, bary).is_none());
    let corners = accel.corners(1, 7).unwrap();
    let p = accel.triangle_point(1, 7, bary).unwrap().p;
    let expected = corners[0] * 0.5 + corners[1] * 0.2 + corners[2] * 0.3;
    assert!((vec(p) - expected).length() < 1e-6);
    assert!(accel.bounds().hi.x.to_f64() > 2.0);
}

/// The image of a ray in a tiny or huge instance's own space can leave single precision.
#[test]
fn instances_of_extreme_scale_are_refused_or_traced_without_harm() {
    let mut random = Random(5);
    let points: Vec<[f32; 3]> = (0..3 * 9001).map(|_| random.direction().cast::<f32>().to_array()).collect();
    let triangles = (0..9001).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    let shape = mesh(points, triangles);
    let mut built = 0;
    for exponent in [-45, -42, -39, -38, -37, -30, 30, 37, 38, 39, 45] {
        let s = 10f64.powi(exponent);
        let scale =
            Mat3 { rows: [Vec3d::new(s, 0.0, 0.0), Vec3d::new(0.0, s, 0.0), Vec3d::new(0.0, 0.0, s)] };
        for at in [0.0, 10.0, 1e30] {
            let place = |x: f64| {
                let transform = Transform::new(scale, Vec3d::new(x, at, at)).expect("invertible");
                Object::Mesh { mesh: 0, transform }
            };
            let objects = vec![place(at), place(2.0 * at)];
            let built_now = Accel::build(vec![shape.clone()], objects, &BuildOptions::default(), &NoStore);
            let Ok(accel) = built_now else { continue };
            built += 1;
            for _ in 0..300 {
                let o = random.direction() * 10f64.powf(random.range(-44.0, 38.4));
                let r = ray(o, Vec3d::new(at, at, at) - o + random.direction());
                let hit = accel.intersect(&r);
                assert!(hit.is_none_or(|h| h.primitive < 9001 && h.object < 2));
                accel.occluded(&r);
            }
        }
    }
    assert!(built > 10);
}
