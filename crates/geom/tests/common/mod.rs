//! Meshes, rays and a brute-force oracle in double precision, shared by the tests.
#![allow(dead_code, reason = "each test binary uses its own part")]

use indigo_geom::{Accel, BuildOptions, Hit, KernelChoice, MeshBuffers, NoStore, Object, Ray, TriangleMesh};
use indigo_math::{Float, Real, Transform, Vec3, Vec3d};

/// SplitMix64 (Steele, Lea, Flood 2014), enough for tests.
pub struct Random(pub u64);

impl Random {
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    /// Uniform in [0, 1).
    pub fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1u64 << 53) as f64
    }

    pub fn range(&mut self, a: f64, b: f64) -> f64 {
        a + (b - a) * self.unit()
    }

    pub fn index(&mut self, n: usize) -> usize {
        (self.bits() % n as u64) as usize
    }

    pub fn in_box(&mut self, half: f64) -> Vec3d {
        Vec3d::new(self.range(-half, half), self.range(-half, half), self.range(-half, half))
    }

    pub fn direction(&mut self) -> Vec3d {
        loop {
            let v = self.in_box(1.0);
            if v.length2() < 1.0 && v.length2() > 1e-6 {
                return v.normalized();
            }
        }
    }
}

pub fn mesh(positions: Vec<[f32; 3]>, triangles: Vec<[u32; 3]>) -> TriangleMesh {
    TriangleMesh::new(MeshBuffers { positions, triangles, ..MeshBuffers::default() }).unwrap()
}

/// Triangles that share no vertex, in a cube of half side 1.
pub fn triangle_cloud(n: usize, size: f64, random: &mut Random) -> TriangleMesh {
    let mut positions = Vec::new();
    for _ in 0..n {
        let center = random.in_box(1.0);
        for _ in 0..3 {
            positions.push((center + random.in_box(size)).cast::<f32>().to_array());
        }
    }
    mesh(positions, (0..n as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect())
}

/// A closed bumpy sphere of 2 · n · (n − 1) triangles, winding outwards, every vertex shared.
pub fn bumpy_sphere(n: usize) -> TriangleMesh {
    let mut positions = vec![[0.0, 0.0, 1.0f32]];
    for j in 1..n {
        for i in 0..n {
            let (theta, phi) =
                (j as f64 / n as f64 * std::f64::consts::PI, i as f64 / n as f64 * std::f64::consts::TAU);
            let r = 1.0 + 0.1 * (7.0 * theta).sin() * (5.0 * phi).cos() * theta.sin();
            let p = Vec3d::new(theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos()) * r;
            positions.push(p.cast::<f32>().to_array());
        }
    }
    let last = positions.len() as u32;
    positions.push([0.0, 0.0, -1.0]);
    let at = |j: usize, i: usize| (1 + (j - 1) * n + i % n) as u32;
    let mut triangles = Vec::new();
    for i in 0..n {
        triangles.push([0, at(1, i), at(1, i + 1)]);
        triangles.push([last, at(n - 1, i + 1), at(n - 1, i)]);
        for j in 1..n - 1 {
            triangles.push([at(j, i), at(j + 1, i), at(j + 1, i + 1)]);
            triangles.push([at(j, i), at(j + 1, i + 1), at(j, i + 1)]);
        }
    }
    mesh(positions, triangles)
}

pub fn place(mesh: u32, transform: Transform) -> Object {
    Object::Mesh { mesh, transform }
}

pub const KERNELS: [KernelChoice; 2] = [KernelChoice::Fastest, KernelChoice::Portable];

pub fn options(kernel: KernelChoice) -> BuildOptions {
    BuildOptions { kernel, ..BuildOptions::default() }
}

/// A scene of one mesh where it is.
pub fn single(mesh: TriangleMesh, options: &BuildOptions) -> Accel {
    Accel::build(vec![mesh], vec![place(0, Transform::IDENTITY)], options, &NoStore).unwrap()
}

pub fn ray(o: Vec3d, d: Vec3d) -> Ray {
    Ray::new(o.cast(), d.cast())
}

/// The closest hit by Möller and Trumbore's test of every triangle in double precision, and the
/// least distance of its barycentric coordinates from an edge (negative: outside).
pub fn brute_force(mesh: &TriangleMesh, ray: &Ray) -> Vec<OracleHit> {
    let (o, d) = (ray.o.cast::<f64>(), ray.d.cast::<f64>());
    let mut hits = Vec::new();
    for (i, t) in mesh.triangles().iter().enumerate() {
        let [a, b, c] = t.map(|k| Vec3d::from(mesh.positions()[k as usize].map(f64::from)));
        let (e1, e2, s) = (b - a, c - a, o - a);
        let p = d.cross(e2);
        let det = e1.dot(p);
        let (u, v) = (s.dot(p) / det, d.dot(s.cross(e1)) / det);
        let t = e2.dot(s.cross(e1)) / det;
        let inside = u.min(v).min(1.0 - u - v);
        let grazing = det.abs() / (e1.cross(e2).length() * d.length());
        if inside > -1e-4 && t > ray.t_min.to_f64() && t < ray.t_max.to_f64() {
            hits.push(OracleHit { triangle: i as u32, t, inside, grazing });
        }
    }
    hits.sort_by(|a, b| a.t.total_cmp(&b.t));
    hits
}

/// What the oracle found.
#[derive(Clone, Copy, Debug)]
pub struct OracleHit {
    pub triangle: u32,
    pub t: f64,
    /// Least barycentric coordinate.
    pub inside: f64,
    /// Cosine between ray and normal.
    pub grazing: f64,
}

/// Whether a hit agrees with the oracle: it is a triangle that the oracle also met, to rounding, and
/// no triangle met well inside is closer.
pub fn agrees(hit: Option<&Hit>, oracle: &[OracleHit], tolerance: f64) -> Result<(), String> {
    let sure = oracle.iter().find(|h| h.inside > 1e-4 && h.grazing > 1e-3);
    match hit {
        None => sure.map_or(Ok(()), |s| Err(format!("missed {s:?}"))),
        Some(h) => {
            let slack = |grazing: f64| tolerance / grazing.max(1e-3);
            let t = h.t.to_f64();
            let same = oracle.iter().find(|o| o.triangle == h.primitive);
            let Some(same) = same else { return Err(format!("{h:?} is not in {oracle:?}")) };
            if (same.t - t).abs() > slack(same.grazing) {
                return Err(format!("{h:?} is not at {same:?}"));
            }
            match sure {
                Some(s) if s.t + slack(s.grazing) + slack(same.grazing) < t => {
                    Err(format!("{h:?} is behind {s:?}"))
                }
                _ => Ok(()),
            }
        }
    }
}

pub fn real(v: f64) -> Real {
    Real::from_f64(v)
}

pub fn vec(v: Vec3) -> Vec3d {
    v.cast()
}
