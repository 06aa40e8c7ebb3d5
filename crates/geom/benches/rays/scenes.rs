//! The three meshes and their rays, generated: a bumpy sphere in a box (1.0 million triangles), a
//! room full of furniture (0.1 million, sizes from walls to books), and thin sticks (0.2 million,
//! the worst for boxes).

use indigo_geom::{Accel, MeshBuffers, Ray, TriangleMesh};
use indigo_math::{Mat3, Vec3, Vec3d};
use std::f64::consts::TAU;

/// SplitMix64 (Steele, Lea, Flood 2014).
pub struct Random(pub u64);

impl Random {
    fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    /// Uniform in [0, 1).
    pub fn unit(&mut self) -> f64 {
        (self.bits() >> 40) as f64 / (1u64 << 24) as f64
    }

    fn range(&mut self, a: f64, b: f64) -> f64 {
        a + (b - a) * self.unit()
    }
}

/// A mesh with the eye and light that make its rays.
pub struct BenchScene {
    pub name: &'static str,
    pub mesh: TriangleMesh,
    /// Rays timed of each set.
    pub rays: usize,
    eye: Vec3d,
    at: Vec3d,
    /// Field of view, degrees.
    fov: f64,
    light: Vec3d,
    light_half: f64,
}

/// Names of the ray sets; the last is traced for any hit.
pub const SETS: [&str; 4] = ["primary", "bounce 1", "bounce 3", "shadow"];

type Turn = Mat3<f64>;

#[derive(Default)]
struct Soup {
    positions: Vec<[f32; 3]>,
    triangles: Vec<[u32; 3]>,
}

impl Soup {
    fn add(&mut self, part: &Self, turn: Turn, shift: Vec3d) {
        let first = self.positions.len() as u32;
        let moved = |p: &[f32; 3]| (turn * Vec3d::from(p.map(f64::from)) + shift).cast::<f32>().to_array();
        self.positions.extend(part.positions.iter().map(moved));
        self.triangles.extend(part.triangles.iter().map(|t| t.map(|i| i + first)));
    }

    fn into_mesh(self) -> TriangleMesh {
        let Self { positions, triangles } = self;
        TriangleMesh::new(MeshBuffers { positions, triangles, ..MeshBuffers::default() }).expect("in range")
    }
}

fn cuboid(x: f64, y: f64, z: f64) -> Soup {
    let sign = |i: usize, bit: usize, half: f64| if i >> bit & 1 == 1 { half as f32 } else { -half as f32 };
    let positions = (0..8).map(|i| [sign(i, 0, x), sign(i, 1, y), sign(i, 2, z)]).collect();
    let quads = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]];
    let triangles = quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    Soup { positions, triangles }
}

fn grid(nu: usize, nv: usize, f: impl Fn(f64, f64) -> Vec3d) -> Soup {
    let mut soup = Soup::default();
    for j in 0..=nv {
        for i in 0..=nu {
            soup.positions.push(f(i as f64 / nu as f64, j as f64 / nv as f64).cast::<f32>().to_array());
        }
    }
    for j in 0..nv {
        for i in 0..nu {
            let a = (j * (nu + 1) + i) as u32;
            let (b, c) = (a + 1, a + nu as u32 + 1);
            soup.triangles.extend([[a, b, c + 1], [a, c + 1, c]]);
        }
    }
    soup
}

fn ball(r: f64, nu: usize, nv: usize) -> Soup {
    grid(nu, nv, |u, v| {
        let ((s, c), (st, ct)) = ((u * TAU).sin_cos(), ((0.001 + 0.998 * v) * TAU * 0.5).sin_cos());
        Vec3d::new(s * st, ct, c * st) * r
    })
}

fn torus(r: f64, tube: f64, nu: usize, nv: usize) -> Soup {
    grid(nu, nv, |u, v| {
        let ((s, c), (sv, cv)) = ((u * TAU).sin_cos(), (v * TAU).sin_cos());
        Vec3d::new((r + tube * cv) * c, tube * sv, (r + tube * cv) * s)
    })
}

fn tube(r: f64, height: f64, n: usize) -> Soup {
    grid(n, 1, |u, v| {
        let (s, c) = (u * TAU).sin_cos();
        Vec3d::new(r * c, height * (v - 0.5), r * s)
    })
}

fn turn_y(a: f64) -> Turn {
    let (s, c) = a.sin_cos();
    Mat3::from_rows([c, 0.0, s, 0.0, 1.0, 0.0, -s, 0.0, c])
}

fn turn_x(a: f64) -> Turn {
    let (s, c) = a.sin_cos();
    Mat3::from_rows([1.0, 0.0, 0.0, 0.0, c, -s, 0.0, s, c])
}

fn turn_z(a: f64) -> Turn {
    let (s, c) = a.sin_cos();
    Mat3::from_rows([c, -s, 0.0, s, c, 0.0, 0.0, 0.0, 1.0])
}

fn lattice(x: i64, y: i64, z: i64) -> f64 {
    let mut h = (x as u32).wrapping_mul(374_761_393)
        ^ (y as u32).wrapping_mul(668_265_263)
        ^ (z as u32).wrapping_mul(2_147_483_647);
    h = (h ^ (h >> 13)).wrapping_mul(1_274_126_177);
    h ^= h >> 16;
    f64::from(h & 0xff_ffff) / 16_777_215.0
}

/// Value noise: smooth interpolation of random numbers on a lattice.
fn noise(p: Vec3d) -> f64 {
    let cell = p.to_array().map(f64::floor);
    let w = std::array::from_fn::<f64, 3, _>(|i| {
        let t = p[i] - cell[i];
        t * t * (3.0 - 2.0 * t)
    });
    let corner = |c: usize| {
        let d = [c & 1, c >> 1 & 1, c >> 2 & 1];
        let weight: f64 = (0..3).map(|i| if d[i] == 1 { w[i] } else { 1.0 - w[i] }).product();
        let at = |i: usize| cell[i] as i64 + d[i] as i64;
        weight * lattice(at(0), at(1), at(2))
    };
    (0..8).map(corner).sum()
}

/// Cells along one edge of a face of the bumpy sphere's cube.
pub const FACE_CELLS: usize = 289;

fn bumpy_face(face: usize) -> Soup {
    grid(FACE_CELLS, FACE_CELLS, |u, v| {
        let (a, b) = (((u - 0.5) * TAU / 4.0).tan(), ((v - 0.5) * TAU / 4.0).tan());
        let p = match face {
            0 => Vec3d::new(1.0, a, b),
            1 => Vec3d::new(-1.0, b, a),
            2 => Vec3d::new(b, 1.0, a),
            3 => Vec3d::new(a, -1.0, b),
            4 => Vec3d::new(a, b, 1.0),
            _ => Vec3d::new(b, a, -1.0),
        };
        let p = p.normalized();
        let octave = |k: i32| {
            let at = p * (4.0 * 2f64.powi(k)) + Vec3d::new(7.1, 3.3, 9.7);
            0.25 * 0.5f64.powi(k) * (noise(at) - 0.5)
        };
        p * (1.0 + (0..6).map(octave).sum::<f64>())
    })
}

/// The bumpy sphere; its six faces are the first triangles, a box round it the last twelve.
pub fn sphere() -> BenchScene {
    let mut soup = Soup::default();
    for face in 0..6 {
        soup.add(&bumpy_face(face), Mat3::IDENTITY, Vec3d::ZERO);
    }
    soup.add(&cuboid(4.0, 2.0, 4.0), Mat3::IDENTITY, Vec3d::new(0.0, 0.8, 0.0));
    BenchScene {
        name: "sphere",
        mesh: soup.into_mesh(),
        rays: 262_144,
        eye: Vec3d::new(1.6, 0.7, 2.6),
        at: Vec3d::ZERO,
        fov: 45.0,
        light: Vec3d::new(0.0, 2.79, 0.0),
        light_half: 1.0,
    }
}

fn table(soup: &mut Soup, p: Vec3d, angle: f64) {
    let q = turn_y(angle);
    soup.add(&cuboid(0.7, 0.02, 0.4), q, p + Vec3d::new(0.0, 0.72, 0.0));
    for (x, z) in [(0.62, 0.33), (-0.62, 0.33), (0.62, -0.33), (-0.62, -0.33)] {
        soup.add(&cuboid(0.03, 0.35, 0.03), q, p + q * Vec3d::new(x, 0.35, z));
    }
}

fn chair(soup: &mut Soup, p: Vec3d, angle: f64) {
    let q = turn_y(angle);
    soup.add(&cuboid(0.22, 0.02, 0.22), q, p + Vec3d::new(0.0, 0.45, 0.0));
    soup.add(&cuboid(0.22, 0.25, 0.015), q, p + q * Vec3d::new(0.0, 0.72, -0.21));
    for (x, z) in [(0.19, 0.19), (-0.19, 0.19), (0.19, -0.19), (-0.19, -0.19)] {
        soup.add(&tube(0.015, 0.45, 24), q, p + q * Vec3d::new(x, 0.225, z));
    }
}

fn set_table(soup: &mut Soup, place: usize, r: &mut Random) {
    let p = Vec3d::new(-4.0 + 2.4 * (place % 4) as f64, 0.0, -2.8 + 1.8 * (place / 4) as f64);
    let angle = r.unit() * TAU;
    table(soup, p, angle);
    for k in 0..4 {
        let b = angle + f64::from(k) * TAU / 4.0;
        chair(soup, p + turn_y(b) * Vec3d::new(0.0, 0.0, -0.75), b);
    }
    for _ in 0..10 {
        let turn = turn_y(r.unit() * TAU);
        let at = p + Vec3d::new(r.range(-0.4, 0.4), r.range(0.76, 0.9), r.range(-0.25, 0.25));
        soup.add(&cuboid(0.11, 0.015, 0.08), turn, at);
    }
    for _ in 0..2 {
        let size = r.range(0.05, 0.12);
        let at = p + Vec3d::new(r.range(-0.4, 0.4), 0.86, r.range(-0.2, 0.2));
        soup.add(&ball(size, 32, 20), Mat3::IDENTITY, at);
    }
}

fn shelves(soup: &mut Soup, r: &mut Random) {
    for (k, s) in (0..3).flat_map(|k| (0..6).map(move |s| (f64::from(k), f64::from(s)))) {
        let board = Vec3d::new(-3.0 + 3.0 * k, 0.2 + 0.4 * s, -3.8);
        soup.add(&cuboid(0.9, 0.015, 0.15), Mat3::IDENTITY, board);
        for b in 0..40 {
            let h = r.range(0.1, 0.17);
            let book = cuboid(0.018, h, r.range(0.08, 0.13));
            let at = Vec3d::new(-3.85 + 3.0 * k + 0.0425 * f64::from(b), 0.23 + 0.4 * s + h, -3.8);
            soup.add(&book, turn_z(r.range(-0.15, 0.15)), at);
        }
    }
}

fn lamps(soup: &mut Soup, r: &mut Random) {
    for k in 0..6 {
        let p = Vec3d::new(-4.0 + 1.6 * f64::from(k), 2.3, r.range(-2.5, 2.5));
        let turn = turn_x(r.unit() * 0.5) * turn_y(r.unit()) * turn_z(r.unit() * 0.5);
        soup.add(&torus(0.3, 0.06, 48, 20), turn, p);
        soup.add(&tube(0.01, 0.7, 16), Mat3::IDENTITY, p + Vec3d::new(0.0, 0.35, 0.0));
        soup.add(&ball(0.1, 24, 16), Mat3::IDENTITY, p);
    }
}

/// A room with tables, chairs, shelves, curtains and lamps.
pub fn interior() -> BenchScene {
    let (mut soup, mut r) = (Soup::default(), Random(42));
    soup.add(&cuboid(5.0, 1.5, 4.0), Mat3::IDENTITY, Vec3d::new(0.0, 1.5, 0.0));
    (0..16).for_each(|i| set_table(&mut soup, i, &mut r));
    shelves(&mut soup, &mut r);
    for k in 0..2 {
        let phase = r.unit() * 6.0;
        let curtain = grid(110, 40, |u, v| {
            let x = (0.08 + 0.02 * v) * (u * 40.0 + phase).sin() + 4.7;
            Vec3d::new(x, 0.1 + 2.6 * v, -3.0 + 2.6 * u + 3.0 * f64::from(k))
        });
        soup.add(&curtain, Mat3::IDENTITY, Vec3d::ZERO);
    }
    lamps(&mut soup, &mut r);
    BenchScene {
        name: "interior",
        mesh: soup.into_mesh(),
        rays: 262_144,
        eye: Vec3d::new(4.4, 1.7, 3.6),
        at: Vec3d::new(-1.5, 0.8, -1.0),
        fov: 70.0,
        light: Vec3d::new(0.0, 2.98, 0.0),
        light_half: 1.2,
    }
}

/// 25,000 sticks in a box, 8 triangles each, at random angles.
pub fn thin() -> BenchScene {
    let (mut soup, mut r) = (Soup::default(), Random(42));
    soup.add(&cuboid(6.0, 4.0, 6.0), Mat3::IDENTITY, Vec3d::ZERO);
    for _ in 0..25_000 {
        let turn = turn_x(r.unit() * TAU) * turn_y(r.unit() * TAU) * turn_z(r.unit() * TAU);
        let (length, width) = (r.range(0.3, 1.5), r.range(0.002, 0.006));
        let mut stick = cuboid(width, length, width);
        stick.triangles.drain(4..8);
        let at = Vec3d::new(r.range(-2.0, 2.0), r.range(-2.0, 2.0), r.range(-2.0, 2.0));
        soup.add(&stick, turn, at);
    }
    BenchScene {
        name: "thin",
        mesh: soup.into_mesh(),
        rays: 32_768,
        eye: Vec3d::new(4.5, 1.5, 4.5),
        at: Vec3d::ZERO,
        fov: 50.0,
        light: Vec3d::new(0.0, 3.9, 0.0),
        light_half: 2.0,
    }
}

fn cosine_direction(n: Vec3d, r: &mut Random) -> Vec3d {
    let (u, v) = (r.unit(), r.unit());
    let (sine, (s, c)) = (u.sqrt(), (v * TAU).sin_cos());
    let side = if n.x.abs() > 0.5 { Vec3d::new(0.0, 1.0, 0.0) } else { Vec3d::new(1.0, 0.0, 0.0) };
    let t = n.cross(side).normalized();
    (t * (sine * c) + n.cross(t) * (sine * s) + n * (1.0 - u).max(1e-6).sqrt()).normalized()
}

impl BenchScene {
    fn primary(&self, r: &mut Random) -> Vec<Ray> {
        const SIDE: usize = 1024;
        let forward = (self.at - self.eye).normalized();
        let right = forward.cross(Vec3d::new(0.0, 1.0, 0.0)).normalized();
        let up = right.cross(forward);
        let k = (self.fov.to_radians() * 0.5).tan();
        let mut rays = Vec::with_capacity(SIDE * SIDE);
        for (y, x) in (0..SIDE).flat_map(|y| (0..SIDE).map(move |x| (y, x))) {
            let sx = ((x as f64 + r.unit()) / SIDE as f64 * 2.0 - 1.0) * k;
            let sy = (1.0 - (y as f64 + r.unit()) / SIDE as f64 * 2.0) * k;
            let d = (forward + right * sx + up * sy).normalized();
            rays.push(Ray::new(self.eye.cast(), d.cast()));
        }
        rays
    }

    /// The four ray sets, as the names in [`SETS`].
    pub fn ray_sets(&self, accel: &Accel) -> [Vec<Ray>; 4] {
        let mut r = Random(7);
        let primary = self.primary(&mut r);
        let (mut shadow, mut bounces) = (Vec::new(), vec![primary]);
        for bounce in 0..3 {
            let mut next = Vec::new();
            for ray in &bounces[bounce] {
                let Some(hit) = accel.intersect(ray) else { continue };
                let s = accel.surface(ray, &hit);
                let n: Vec3d = if s.n_g.dot(ray.d) > 0.0 { -s.n_g.cast() } else { s.n_g.cast() };
                let p = s.p.cast::<f64>() + n * 2e-4;
                if bounce == 0 {
                    shadow.extend(self.shadow_ray(p, n, &mut r));
                }
                next.push(Ray::new(p.cast(), cosine_direction(n, &mut r).cast()));
            }
            bounces.push(next);
        }
        let [primary, first, _, third] = <[Vec<Ray>; 4]>::try_from(bounces).expect("four generations");
        [primary, first, third, shadow].map(|set| {
            let from = set.len() * 4 / 9;
            set[from..from + self.rays].to_vec()
        })
    }

    fn shadow_ray(&self, p: Vec3d, n: Vec3d, r: &mut Random) -> Option<Ray> {
        let h = self.light_half;
        let to = self.light + Vec3d::new(r.range(-h, h), 0.0, r.range(-h, h)) - p;
        let distance = to.length();
        let d: Vec3 = (to / distance).cast();
        (to.dot(n) > 0.0).then(|| Ray { t_max: (distance * 0.999) as f32, ..Ray::new(p.cast(), d) })
    }
}
