//! Meshes made here, their scene text, and what light they send by closed forms.

use std::collections::HashMap;
use std::f64::consts::{PI, TAU};
use std::fmt::Write;

pub type Point = [f64; 3];

/// A triangle mesh.
#[derive(Clone, Debug)]
pub struct Mesh {
    pub points: Vec<Point>,
    pub triangles: Vec<[usize; 3]>,
}

impl Mesh {
    /// A convex polygon, counter-clockwise seen from its front, as a fan.
    pub fn polygon(points: Vec<Point>) -> Self {
        let triangles = (1..points.len() - 1).map(|i| [0, i, i + 1]).collect();
        Self { points, triangles }
    }

    /// A square of half side `half` at height `z`; its front looks up.
    pub fn square(half: f64, z: f64) -> Self {
        Self::polygon(vec![[-half, -half, z], [half, -half, z], [half, half, z], [-half, half, z]])
    }

    /// A regular polygon round the origin at z = 0; its front looks down.
    pub fn disc(radius: f64, corners: u32) -> Self {
        let corner = |i: u32| {
            let phi = -TAU * f64::from(i) / f64::from(corners);
            [radius * phi.cos(), radius * phi.sin(), 0.0]
        };
        Self::polygon((0..corners).map(corner).collect())
    }

    /// A box from -`half` to `half`; its front looks out.
    pub fn cube(half: f64) -> Self {
        let points =
            (0..8u8).map(|i| [0, 1, 2].map(|a| if i >> a & 1 == 1 { half } else { -half })).collect();
        let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        let triangles = faces.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
        Self { points, triangles }
    }

    /// A subdivided octahedron on the unit sphere; its front looks out.
    pub fn ball(levels: u32) -> Self {
        let mut mesh = Self {
            points: vec![
                [1.0, 0.0, 0.0],
                [-1.0, 0.0, 0.0],
                [0.0, 1.0, 0.0],
                [0.0, -1.0, 0.0],
                [0.0, 0.0, 1.0],
                [0.0, 0.0, -1.0],
            ],
            triangles: vec![
                [0, 2, 4],
                [2, 1, 4],
                [1, 3, 4],
                [3, 0, 4],
                [2, 0, 5],
                [1, 2, 5],
                [3, 1, 5],
                [0, 3, 5],
            ],
        };
        for _ in 0..levels {
            mesh.subdivide();
        }
        mesh
    }

    fn subdivide(&mut self) {
        let mut middles = HashMap::new();
        let points = &mut self.points;
        let mut middle = |a: usize, b: usize| {
            *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
                points.push(unit(add(points[a], points[b])));
                points.len() - 1
            })
        };
        let mut finer = vec![];
        for &[a, b, c] in &self.triangles {
            let [ab, bc, ca] = [middle(a, b), middle(b, c), middle(c, a)];
            finer.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
        }
        self.triangles = finer;
    }

    /// The same with front and back exchanged.
    pub fn inside_out(mut self) -> Self {
        self.triangles.iter_mut().for_each(|t| t.swap(1, 2));
        self
    }

    /// The same moved: p to m · (scale · p) + pos. Under a reflection the winding turns, so that the
    /// front stays the front.
    pub fn placed(&self, m: [f64; 9], scale: f64, pos: Point) -> Self {
        let place =
            |p: &Point| [0, 1, 2].map(|r| (0..3).map(|c| m[3 * r + c] * scale * p[c]).sum::<f64>() + pos[r]);
        let moved =
            Self { points: self.points.iter().map(place).collect(), triangles: self.triangles.clone() };
        let det = dot(cross([m[0], m[1], m[2]], [m[3], m[4], m[5]]), [m[6], m[7], m[8]]);
        if det < 0.0 { moved.inside_out() } else { moved }
    }

    /// Area in m².
    pub fn area(&self) -> f64 {
        self.corners().map(|[a, b, c]| 0.5 * length(cross(sub(b, a), sub(c, a)))).sum()
    }

    fn corners(&self) -> impl Iterator<Item = [Point; 3]> + '_ {
        self.triangles.iter().map(|t| t.map(|i| self.points[i]))
    }

    /// Irradiance at a point of a surface with unit normal `n` from the mesh's front, for radiance 1:
    /// Lambert's ½ Σ θ (n · Γ) over the edges of each triangle that shows its front. All of a triangle
    /// must lie above the surface, and none hide another (true of convex meshes).
    pub fn irradiance(&self, at: Point, n: Point) -> f64 {
        self.corners().map(|corners| triangle_irradiance(corners, at, n)).sum()
    }

    /// `<mesh>` without smoothing.
    pub fn text(&self, name: &str, material: &str) -> String {
        let mut text =
            format!("<mesh><name>{name}</name><normal_smoothing>false</normal_smoothing><embedded>");
        for [x, y, z] in &self.points {
            let _ = write!(text, "<vertex pos=\"{x} {y} {z}\"/>");
        }
        let _ = write!(text, "<triangle_set><material_name>{material}</material_name>");
        for [a, b, c] in &self.triangles {
            let _ = write!(text, "<tri>{a} {b} {c}</tri>");
        }
        text + "</triangle_set></embedded></mesh>"
    }
}

/// `<model>` at the origin.
pub fn model(mesh: &str) -> String {
    format!("<model><pos>0 0 0</pos><scale>1</scale><mesh_name>{mesh}</mesh_name></model>")
}

/// `<meshlight>`; `more` may hold a rotation or an efficacy scale.
pub fn mesh_light(mesh: &str, spectrum: &str, pos: Point, scale: f64, more: &str) -> String {
    format!(
        "<meshlight><pos>{} {} {}</pos><scale>{scale}</scale><mesh_name>{mesh}</mesh_name>\
         <spectrum>{spectrum}</spectrum>{more}</meshlight>",
        pos[0], pos[1], pos[2]
    )
}

/// `<rotation>`.
pub fn rotation(m: [f64; 9]) -> String {
    let words: Vec<String> = m.iter().map(f64::to_string).collect();
    format!("<rotation><matrix>{}</matrix></rotation>", words.join(" "))
}

fn triangle_irradiance(corners: [Point; 3], at: Point, n: Point) -> f64 {
    let [a, b, c] = corners.map(|p| sub(p, at));
    if dot(cross(sub(b, a), sub(c, a)), a) >= 0.0 {
        return 0.0;
    }
    assert!([a, b, c].iter().all(|p| dot(*p, n) >= 0.0), "the triangle dips below the surface");
    let edge = |p: Point, q: Point| {
        let across = cross(p, q);
        let angle = length(across).atan2(dot(p, q));
        angle * dot(unit(across), n)
    };
    // Counter-clockwise from the front is clockwise round the outward view: the sign turns.
    -0.5 * (edge(a, b) + edge(b, c) + edge(c, a))
}

/// Irradiance for radiance 1 of a coaxial disc.
pub fn disc_irradiance(radius: f64, distance: f64) -> f64 {
    PI * radius * radius / (radius * radius + distance * distance)
}

pub fn add(a: Point, b: Point) -> Point {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

pub fn sub(a: Point, b: Point) -> Point {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

pub fn dot(a: Point, b: Point) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub fn cross(a: Point, b: Point) -> Point {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

pub fn length(a: Point) -> f64 {
    dot(a, a).sqrt()
}

pub fn unit(a: Point) -> Point {
    let l = length(a);
    a.map(|x| x / l)
}
