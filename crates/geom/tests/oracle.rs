//! Every hit against brute force in double precision, for every builder and kernel.

mod common;

use common::{KERNELS, Random, agrees, brute_force, ray, real, single, triangle_cloud};
use indigo_geom::{BuildOptions, KernelChoice, Ray};

/// Rays of all kinds round a cloud in the unit cube: from inside and outside, and along axes.
fn rays(n: usize, random: &mut Random) -> Vec<Ray> {
    (0..n)
        .map(|i| {
            let mut d = random.direction();
            match i % 8 {
                0 => d.x = 0.0,
                1 => (d.y, d.z) = (0.0, -0.0),
                _ => {}
            }
            let length = random.range(0.01, 100.0);
            let d = if d.length2() > 0.0 { d * length } else { d };
            ray(random.in_box(if i % 2 == 0 { 1.0 } else { 4.0 }), d)
        })
        .collect()
}

#[test]
fn closest_and_any_hits_agree_with_brute_force() {
    for (seed, size) in [(1, 0.5), (2, 0.1), (3, 0.06)] {
        let mut random = Random(seed);
        let mesh = triangle_cloud(1500, size, &mut random);
        let rays = rays(1500, &mut random);
        for kernel in KERNELS {
            for fast_threshold in [0, usize::MAX] {
                let options = BuildOptions { kernel, fast_threshold, ..BuildOptions::default() };
                let accel = single(mesh.clone(), &options);
                let mut met = 0;
                for r in &rays {
                    let oracle = brute_force(&mesh, r);
                    let hit = accel.intersect(r);
                    met += usize::from(hit.is_some());
                    let tolerance = 1e-5 / indigo_math::Float::to_f64(r.d.length());
                    agrees(hit.as_ref(), &oracle, tolerance).unwrap_or_else(|e| panic!("{r:?}: {e}"));
                    assert_eq!(accel.occluded(r), hit.is_some(), "{r:?}");
                }
                assert!(met > 100, "only {met} rays met anything");
            }
        }
    }
}

#[test]
fn hits_lie_strictly_inside_the_interval() {
    let mut random = Random(4);
    let mesh = triangle_cloud(2000, 0.2, &mut random);
    let accel = single(mesh, &BuildOptions::default());
    let mut ends = 0;
    for r in rays(3000, &mut random) {
        let Some(hit) = accel.intersect(&r) else { continue };
        ends += 1;
        let before = Ray { t_max: hit.t, ..r };
        assert!(accel.intersect(&before).is_none(), "{r:?}");
        assert!(!accel.occluded(&before), "{r:?}");
        let behind = Ray { t_min: hit.t, ..r };
        assert!(accel.intersect(&behind).is_none_or(|h| h.t > hit.t), "{r:?}");
        let just = Ray { t_max: hit.t * real(1.0001), ..r };
        assert!(accel.occluded(&just) && accel.intersect(&just) == Some(hit), "{r:?}");
    }
    assert!(ends > 500);
}

#[test]
fn both_kernels_give_the_same_bits() {
    let mut random = Random(5);
    let mesh = triangle_cloud(20_000, 0.05, &mut random);
    let fastest = single(mesh.clone(), &BuildOptions::default());
    let portable = BuildOptions { kernel: KernelChoice::Portable, ..BuildOptions::default() };
    let portable = single(mesh, &portable);
    for r in rays(20_000, &mut random) {
        assert_eq!(fastest.intersect(&r), portable.intersect(&r));
        assert_eq!(fastest.occluded(&r), portable.occluded(&r));
    }
}
