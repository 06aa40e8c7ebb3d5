//! The kernels, and what each has to do.

use crate::common::scene;
use crate::common::shapes::{Mesh, mesh_light, model};
use crate::common::text::{basic, camera, grey, medium, scene_file, settings, specular, sphere, uniform};
use indigo_film::{FilmDelta, FilmFilter, FilmSize, Filter, LayerKind, MasterFilm, Sensor};
use indigo_geom::{Accel, BuildOptions, KernelChoice, MeshBuffers, NoStore, Object, Ray, TriangleMesh};
use indigo_light::Receiver;
use indigo_math::rng::Rng;
use indigo_math::{Real, Transform, Vec2, Vec3, warp};
use indigo_scatter::{Interface, Mode, ShadingPoint};
use indigo_scene::{MetropolisSettings, Scene};
use indigo_spectrum::{SampledSpectrum, WavelengthSampler};
use indigo_transport::driver::Driver;
use indigo_transport::sampler::{Block, PrimarySample, SobolSample};
use std::hint::black_box;

/// Work that is ready to be done.
type Work = Box<dyn FnMut()>;

/// A kernel by name.
pub struct Kernel {
    pub name: &'static str,
    pub prepare: fn() -> Work,
}

/// All of them.
pub const KERNELS: &[Kernel] = &[
    Kernel { name: "rays_closest_avx2", prepare: || closest(KernelChoice::Fastest) },
    Kernel { name: "rays_any_avx2", prepare: || any(KernelChoice::Fastest) },
    Kernel { name: "rays_closest_portable", prepare: || closest(KernelChoice::Portable) },
    Kernel { name: "bsdf_diffuse", prepare: || bsdf(&grey("m", 0.5)) },
    Kernel {
        name: "bsdf_oren_nayar",
        prepare: || {
            bsdf(&material(
                "<oren_nayar><sigma>0.3</sigma><albedo_spectrum><uniform><value>0.5</value></uniform></albedo_spectrum></oren_nayar>",
            ))
        },
    },
    Kernel {
        name: "bsdf_phong",
        prepare: || {
            bsdf(&material(
                "<phong><ior>1.5</ior><exponent>300</exponent><diffuse_albedo_spectrum><uniform><value>0.5</value></uniform></diffuse_albedo_spectrum></phong>",
            ))
        },
    },
    Kernel { name: "bsdf_specular", prepare: || bsdf(&(glass() + &specular("m", "glass"))) },
    Kernel { name: "bsdf_glossy_transparent", prepare: || bsdf(&(glass() + &frosted())) },
    Kernel { name: "light_choice", prepare: light_choice },
    Kernel { name: "sampler", prepare: sampler },
    Kernel { name: "sensor_splat", prepare: sensor_splat },
    Kernel { name: "film_merge", prepare: film_merge },
    Kernel { name: "path", prepare: || render(false, None) },
    Kernel { name: "bidirectional", prepare: || render(true, None) },
    Kernel { name: "metropolis", prepare: || render(true, Some(MUTATING)) },
];

/// The manual's own settings.
const MUTATING: MetropolisSettings =
    MetropolisSettings { large_mutation_prob: 0.4, max_change: 0.01, max_consecutive_rejections: 1000 };
/// Rays of a kernel: enough that each part of the tree is met often.
const RAYS: usize = 20_000;
/// Evaluations and samples of a kernel.
const EVENTS: usize = 20_000;
/// Side of the pictures, in pixels.
const SIDE: u32 = 16;

/// A ball of 8192 triangles with bumps on it, which hide each other.
fn bumpy_ball(kernel: KernelChoice) -> Accel {
    let ball = Mesh::ball(5);
    let bump = |p: &[f64; 3]| 1.0 + 0.2 * (p[0] * 40.0).fract() * (p[1] * 40.0).fract();
    let positions = ball.points.iter().map(|p| p.map(|x| (x * bump(p)) as f32)).collect();
    let triangles = ball.triangles.iter().map(|t| t.map(|i| i as u32)).collect();
    let mesh = TriangleMesh::new(MeshBuffers { positions, triangles, ..MeshBuffers::default() });
    let object = Object::Mesh { mesh: 0, transform: Transform::IDENTITY };
    let options = BuildOptions { kernel, ..BuildOptions::default() };
    Accel::build(vec![mesh.expect("arrays that fit")], vec![object], &options, &NoStore)
        .expect("a small mesh")
}

/// From a sphere round the ball to points in and about it.
fn rays() -> Vec<Ray> {
    let mut rng = Rng::new(1);
    let mut point = |radius: Real| {
        let u = Vec2::new(rng.next_real(), rng.next_real());
        warp::uniform_sphere(u) * radius
    };
    (0..RAYS)
        .map(|_| {
            let (from, to) = (point(3.0), point(0.9));
            Ray::new(from, (to - from).normalized())
        })
        .collect()
}

fn closest(kernel: KernelChoice) -> Work {
    let (accel, rays) = (bumpy_ball(kernel), rays());
    Box::new(move || {
        for ray in &rays {
            black_box(accel.intersect(ray));
        }
    })
}

fn any(kernel: KernelChoice) -> Work {
    let (accel, rays) = (bumpy_ball(kernel), rays());
    Box::new(move || {
        for ray in &rays {
            black_box(accel.occluded(ray));
        }
    })
}

fn material(kind: &str) -> String {
    format!("<material><name>m</name>{kind}</material>")
}

fn glass() -> String {
    medium("glass", 10, &basic(1.5, &uniform(0.0), ""))
}

fn frosted() -> String {
    material(
        "<glossy_transparent><internal_medium_name>glass</internal_medium_name><exponent>1000</exponent></glossy_transparent>",
    )
}

/// A scene that is seen from a little way off, with a lamp over it.
fn seen(parts: &[String], picture: &str) -> Scene {
    let lamp = Mesh::disc(0.7, 12).text("lamp", "lamp_material")
        + &mesh_light("lamp", &uniform(1e5), [0.0, 0.3, 2.5], 1.0, "");
    let common = [
        settings(SIDE, picture),
        camera([0.0, -4.0, 1.0], [0.0, 1.0, -0.1], 0.6, ""),
        grey("lamp_material", 0.0),
        lamp,
    ];
    scene(&scene_file(&[&common[..], parts].concat()))
}

/// Sampling and evaluating a material named `m` from and to all directions above it.
fn bsdf(text: &str) -> Work {
    let scene = seen(&[text.to_owned(), sphere([0.0; 3], 1.0, "m")], "");
    let lambda = scene.wavelengths.sample(0.3);
    let below = SampledSpectrum::splat(1.5);
    let context_of = Interface { above: SampledSpectrum::ONE, below };
    let materials =
        scene.names.materials.iter().position(|name| name == "m").expect("the material of the sphere");
    let mut rng = Rng::new(2);
    let mut directions = move || {
        let u = [(); 2].map(|()| rng.next_real());
        (warp::cosine_hemisphere(Vec2::new(u[0], u[1])), [(); 3].map(|()| rng.next_real()))
    };
    let inputs: Vec<_> = (0..EVENTS).map(|_| (directions(), directions().0)).collect();
    Box::new(move || {
        let material = &scene.materials()[materials];
        let context = scene.material_context(&lambda, context_of, 0.5);
        let n = Vec3::new(0.0, 0.0, 1.0);
        for ((wo, u), wi) in &inputs {
            let leaf = material.leaf(&context, |_| Vec2::new(0.5, 0.5)).expect("a surface that is seen");
            let point = ShadingPoint::new(leaf, n, n, *wo);
            black_box(point.eval(*wi, Mode::Radiance));
            black_box(point.sample(*u, Mode::Radiance));
        }
    })
}

/// Choosing one of 400 lamps and a point on it, for receivers all about.
fn light_choice() -> Work {
    let lamps = (0..400).map(|i| {
        let at = [f64::from(i % 20) - 10.0, f64::from(i / 20) - 10.0, 3.0 + f64::from(i % 7) * 0.3];
        mesh_light("lamp", &uniform(1e3 * f64::from(1 + i % 5)), at, 0.05, "")
    });
    let floor = grey("m", 0.5) + &Mesh::square(12.0, 0.0).text("floor", "m") + &model("floor");
    let scene = seen(&[lamps.collect(), floor], "");
    let lambda = scene.wavelengths.sample(0.3);
    let mut rng = Rng::new(3);
    let inputs: Vec<_> = (0..EVENTS)
        .map(|_| {
            let p = Vec3::new(
                20.0 * rng.next_real() - 10.0,
                20.0 * rng.next_real() - 10.0,
                rng.next_real() - 1.0,
            );
            (Receiver::facing(p, Vec3::new(0.0, 0.0, 1.0)), [(); 4].map(|()| rng.next_real()))
        })
        .collect();
    Box::new(move || {
        for (to, u) in &inputs {
            black_box(scene.lights.sample(to, *u, &lambda));
        }
    })
}

/// The numbers of samples of five bounces.
fn sampler() -> Work {
    Box::new(|| {
        for index in 0..EVENTS as u32 / 10 {
            let mut sample = SobolSample::new(1, u64::from(index % 64), index / 64);
            for vertex in 0..5 {
                black_box(sample.block(Block::light(vertex)));
                black_box(sample.block(Block::scatter(vertex)));
            }
        }
    })
}

/// Light to XYZ and onto the film, anywhere on it.
fn sensor_splat() -> Work {
    let size = FilmSize::new(320, 240, 1).expect("a size");
    let filter = FilmFilter::new(Filter::MN_DEFAULT, size).expect("the default");
    let wavelengths = WavelengthSampler::visible();
    let mut film = FilmDelta::new(size, [LayerKind::PerScreen]);
    let mut rng = Rng::new(4);
    let inputs: Vec<_> = (0..EVENTS)
        .map(|_| {
            let at = Vec2::new(320.0 * rng.next_real(), 240.0 * rng.next_real());
            (at, wavelengths.sample(rng.next_real()), SampledSpectrum::splat(rng.next_real()))
        })
        .collect();
    // Bricks are made on first touch.
    for (at, ..) in &inputs {
        film.splat(0, *at, [0.0; 3], &filter);
    }
    Box::new(move || {
        for (at, lambda, light) in &inputs {
            film.splat(0, *at, Sensor::new(lambda).xyz(light), &filter);
        }
    })
}

/// Handing over what a worker has, on half of the film's bricks.
fn film_merge() -> Work {
    let size = FilmSize::new(640, 480, 1).expect("a size");
    let film = MasterFilm::new(size, &[(LayerKind::PerPixel, "camera")]).expect("memory for a small film");
    let mut delta = film.delta();
    for y in 0..240 {
        (0..640).for_each(|x| delta.add_sample(0, x, y, [1.0, 2.0, 3.0], 1.0));
    }
    Box::new(move || film.merge(&delta).expect("a delta of this film"))
}

/// Units of work of a whole mode: a glass ball and a matt one on a floor.
fn render(bidirectional: bool, metropolis: Option<MetropolisSettings>) -> Work {
    let floor = grey("floor_material", 0.6)
        + &Mesh::square(4.0, -1.0).text("floor", "floor_material")
        + &model("floor");
    let balls =
        [sphere([-0.8, 0.0, -0.3], 0.7, "m"), sphere([0.8, 0.0, -0.3], 0.7, "floor_material")].concat();
    let mut scene = seen(&[floor, glass(), specular("m", "glass"), balls], "");
    scene.transport.bidirectional = bidirectional;
    scene.transport.metropolis = metropolis;
    let driver = Driver::new(&scene, 5);
    let film = MasterFilm::new(scene.film.size, driver.layers()).expect("memory for a small film");
    let (mut delta, mut tracer) = (film.delta(), driver.tracer());
    let units = match metropolis {
        // The first unit of a chain looks for its start; the second is mutations alone.
        Some(_) => {
            let second =
                (1..10_000).find(|&unit| driver.units_before(unit).next() == Some(0)).expect("more units");
            driver.render_unit(&scene, 0, &mut tracer, &mut delta);
            second..second + 1
        }
        None => 0..driver.units(8),
    };
    Box::new(move || {
        for unit in units.clone() {
            black_box(driver.render_unit(&scene, unit, &mut tracer, &mut delta));
        }
    })
}
