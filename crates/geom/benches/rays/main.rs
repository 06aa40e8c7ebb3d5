//! The race: Embree 4 against this crate, one thread, interleaved, best of N.
//!
//! `INDIGO_EMBREE_DIR` names the folder of Embree's library (`cargo xtask bench rays` sees to that).
//! Options: `--check` exits 1 where a target is missed; `--reps N` (9); `--only NAME`; `--figures` tells each figure in a
//! line of its own as well, for programs: `figure`, series, name and value between tabs.
//! Both sides trace with denormal numbers as the processor starts: neither flushes them.

mod embree;
mod scenes;

use cpu_time::ThreadTime;
use embree::{Device, Embree, Mode, Scene};
use indigo_geom::{Accel, BuildOptions, NoStore, Object, Ray, TriangleMesh};
use indigo_math::{Mat3, Transform, Vec3d};
use scenes::{BenchScene, FACE_CELLS, Random, SETS};
use std::process::ExitCode;
use std::time::{Duration, Instant};

const EMBREE: [(&str, Mode); 3] =
    [("Embree medium", Mode::Medium), ("Embree high", Mode::High), ("Embree robust", Mode::MediumRobust)];

/// Rays timed at a time.
const PIECE: usize = 8192;

struct Arguments {
    check: bool,
    reps: usize,
    only: Option<String>,
    figures: bool,
}

fn arguments() -> Arguments {
    let mut parsed = Arguments { check: false, reps: 9, only: None, figures: false };
    let mut words = std::env::args().skip(1);
    while let Some(word) = words.next() {
        match word.as_str() {
            "--check" => parsed.check = true,
            "--reps" => parsed.reps = words.next().and_then(|n| n.parse().ok()).unwrap_or(parsed.reps),
            "--only" => parsed.only = words.next(),
            "--figures" => parsed.figures = true,
            // Cargo adds `--bench`.
            _ => {}
        }
    }
    parsed
}

fn main() -> ExitCode {
    let Some(folder) = std::env::var_os("INDIGO_EMBREE_DIR") else {
        println!("INDIGO_EMBREE_DIR is not set; run `cargo xtask bench rays`");
        return ExitCode::SUCCESS;
    };
    let embree = match Embree::load(folder.as_ref()) {
        Ok(embree) => embree,
        Err(why) => {
            eprintln!("cannot load Embree: {why}");
            return ExitCode::FAILURE;
        }
    };
    let arguments = arguments();
    let mut missed = Vec::new();
    let chosen = |s: &BenchScene| arguments.only.as_ref().is_none_or(|name| name == s.name);
    for scene in [scenes::sphere(), scenes::interior(), scenes::thin()].iter().filter(|s| chosen(s)) {
        race(&embree, scene, &arguments, &mut missed);
        if scene.name == "sphere" {
            leaks(&embree, scene, &mut missed);
        }
    }
    if arguments.only.is_none() {
        instances(&mut missed);
    }
    for what in &missed {
        println!("MISSED: {what}");
    }
    if arguments.check && !missed.is_empty() { ExitCode::FAILURE } else { ExitCode::SUCCESS }
}

fn build(mesh: &TriangleMesh, fast: bool, threads: usize) -> (Accel, Duration) {
    let options =
        BuildOptions { fast_threshold: if fast { 0 } else { usize::MAX }, ..BuildOptions::default() };
    let meshes = vec![mesh.clone()];
    let objects = vec![Object::Mesh { mesh: 0, transform: Transform::IDENTITY }];
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
    pool.install(|| {
        let start = Instant::now();
        let accel = Accel::build(meshes, objects, &options, &NoStore).expect("a sound scene");
        (accel, start.elapsed())
    })
}

/// Shortest of three.
fn best_of_three(mut run: impl FnMut() -> Duration) -> Duration {
    (0..3).map(|_| run()).min().unwrap_or_default()
}

/// Traces rays, for any hit where told so; returns how many hit and the sum of the distances.
type Trace<'a> = dyn Fn(&[Ray], bool) -> (usize, f64) + 'a;

/// One entry of the race.
struct Contender<'a> {
    name: &'static str,
    trace: Box<Trace<'a>>,
    /// Seconds to build with one and with two threads.
    builds: [f64; 2],
    bytes_per_triangle: Option<f64>,
    best: [f64; 4],
    hits: [usize; 4],
}

fn tally(rays: &[Ray], distance: impl Fn(&Ray) -> f32) -> (usize, f64) {
    rays.iter()
        .map(distance)
        .filter(|t| *t < f32::INFINITY)
        .fold((0, 0.0), |(n, s), t| (n + 1, s + f64::from(t)))
}

fn flag(met: bool) -> f32 {
    if met { 1.0 } else { f32::INFINITY }
}

fn embree_contender<'a>(scene: &'a Scene<'a>, name: &'static str, builds: [f64; 2]) -> Contender<'a> {
    let trace = move |rays: &[Ray], any: bool| {
        if any { tally(rays, |r| flag(scene.any(r))) } else { tally(rays, |r| scene.closest(r)) }
    };
    Contender {
        name,
        trace: Box::new(trace),
        builds,
        bytes_per_triangle: None,
        best: [f64::INFINITY; 4],
        hits: [0; 4],
    }
}

fn own_contender<'a>(accel: &'a Accel, name: &'static str, builds: [f64; 2]) -> Contender<'a> {
    let trace = move |rays: &[Ray], any: bool| {
        if any {
            tally(rays, |r| flag(accel.occluded(r)))
        } else {
            tally(rays, |r| accel.intersect(r).map_or(f32::INFINITY, |h| h.t))
        }
    };
    let stats = accel.stats();
    Contender {
        name,
        trace: Box::new(trace),
        builds,
        bytes_per_triangle: Some(stats.tree_bytes as f64 / stats.triangles as f64),
        best: [f64::INFINITY; 4],
        hits: [0; 4],
    }
}

fn race(embree: &Embree, scene: &BenchScene, arguments: &Arguments, missed: &mut Vec<String>) {
    let mesh = &scene.mesh;
    let seconds = |threads: usize, mode: Mode| {
        let device = embree.device(threads);
        best_of_three(|| device.scene(mesh, mode).build).as_secs_f64()
    };
    let own_seconds =
        |threads: usize, fast: bool| best_of_three(|| build(mesh, fast, threads).1).as_secs_f64();
    let device: Device = embree.device(1);
    let built = EMBREE.map(|(_, mode)| device.scene(mesh, mode));
    let own = [build(mesh, false, 2).0, build(mesh, true, 2).0];
    let mut field: Vec<Contender> = built
        .iter()
        .zip(EMBREE)
        .map(|(s, (name, mode))| embree_contender(s, name, [seconds(1, mode), seconds(2, mode)]))
        .collect();
    for (accel, (name, fast)) in own.iter().zip([("own quality", false), ("own fast", true)]) {
        field.push(own_contender(accel, name, [own_seconds(1, fast), own_seconds(2, fast)]));
    }
    let sets = scene.ray_sets(&own[0]);
    for (k, set) in sets.iter().enumerate() {
        time_set(&mut field, k, set, arguments.reps);
    }
    report(scene, &field, missed);
    if arguments.figures {
        tell_ratios(scene, &field);
        for contender in &field {
            tell(scene, contender);
        }
    }
}

/// How many times as fast as Embree ours are, set by set, for programs.
fn tell_ratios(scene: &BenchScene, field: &[Contender]) {
    let [embree @ .., quality, fast] = field else { return };
    for own in [quality, fast] {
        for (k, set) in SETS.iter().enumerate() {
            for theirs in embree {
                let ratio = theirs.best[k] / own.best[k];
                let name = format!("{} over {}: {set}, times as fast", own.name, theirs.name);
                println!("figure\trays, {}\t{name}\t{ratio}", scene.name);
            }
        }
    }
}

/// The figures of a contender, for programs.
fn tell(scene: &BenchScene, contender: &Contender) {
    let figure = |what: &str, value: f64| {
        println!("figure\trays, {}\t{}: {what}\t{value}", scene.name, contender.name);
    };
    for (set, seconds) in SETS.iter().zip(contender.best) {
        figure(&format!("{set}, rays per second"), scene.rays as f64 / seconds);
    }
    figure("build on one thread, s", contender.builds[0]);
    figure("build on two threads, s", contender.builds[1]);
}

/// Times one ray set for all contenders in turn: for each short piece of it the shortest of `reps`
/// runs, summed, so that other load on the machine falls on few pieces and on all contenders alike.
/// Only the time in which the thread itself ran is counted.
fn time_set(field: &mut [Contender], k: usize, set: &[Ray], reps: usize) {
    for c in field.iter_mut() {
        (c.best[k], c.hits[k]) = (0.0, 0);
    }
    for piece in set.chunks(PIECE) {
        let mut best = vec![f64::INFINITY; field.len()];
        let mut hits = vec![0; field.len()];
        for _ in 0..reps {
            for (i, contender) in field.iter().enumerate() {
                let start = ThreadTime::now();
                let (count, sum) = (contender.trace)(piece, k == 3);
                best[i] = best[i].min(start.elapsed().as_secs_f64());
                std::hint::black_box(sum);
                hits[i] = count;
            }
        }
        for (i, contender) in field.iter_mut().enumerate() {
            contender.best[k] += best[i];
            contender.hits[k] += hits[i];
        }
    }
}

fn report(scene: &BenchScene, field: &[Contender], missed: &mut Vec<String>) {
    println!("\n{}: {} triangles, {} rays a set", scene.name, scene.mesh.triangles().len(), scene.rays);
    println!("{:16}{:>9}{:>9}{:>7}   Mrays/s: {}", "", "build 1", "build 2", "B/tri", SETS.join(", "));
    for c in field {
        let bytes = c.bytes_per_triangle.map_or("-".into(), |b| format!("{b:.1}"));
        let rates = c.best.map(|s| format!("{:8.3}", scene.rays as f64 / s * 1e-6)).join("");
        let most = (0..4).map(|k| c.hits[k].abs_diff(field[0].hits[k])).max().unwrap_or(0);
        println!(
            "{:16}{:8.3}s{:8.3}s{bytes:>7}  {rates}   hits differ by {most}",
            c.name, c.builds[0], c.builds[1]
        );
    }
    let [medium, high, robust, quality, fast] = field else { return };
    for own in [quality, fast] {
        let to_robust = std::array::from_fn(|k| robust.best[k] / own.best[k]);
        let fastest = |k: usize| medium.best[k].min(high.best[k]).min(robust.best[k]);
        let to_fastest = std::array::from_fn(|k| fastest(k) / own.best[k]);
        println!(
            "{:16}over robust {}   over its fastest {}",
            own.name,
            ratios(to_robust),
            ratios(to_fastest)
        );
        if own.name == quality.name {
            judge(scene.name, "robust mode", to_robust, 1.25, missed);
            judge(scene.name, "fastest mode", to_fastest, 1.05, missed);
        }
        let bytes = own.bytes_per_triangle.unwrap_or(f64::INFINITY);
        if bytes > 70.0 {
            missed.push(format!("{}: {} takes {bytes:.1} bytes a triangle, not 70", scene.name, own.name));
        }
    }
    for (own, theirs) in [(quality, high), (fast, medium)] {
        for t in 0..2 {
            let ratio = own.builds[t] / theirs.builds[t];
            let line = format!(
                "{}: {} builds in {ratio:.2} of {} with {} threads",
                scene.name,
                own.name,
                theirs.name,
                t + 1
            );
            println!("{line}");
            if ratio > 2.0 {
                missed.push(line);
            }
        }
    }
}

fn ratios(r: [f64; 4]) -> String {
    r.map(|x| format!("{x:.2}")).join(" ")
}

fn judge(scene: &str, mode: &str, reached: [f64; 4], wanted: f64, missed: &mut Vec<String>) {
    for (set, ratio) in SETS.iter().zip(reached) {
        if ratio < wanted {
            missed.push(format!("{scene}, {set}: {ratio:.2} of Embree's {mode}, not {wanted}"));
        }
    }
}

/// Rays from inside the closed bumpy sphere at its vertices and at points of its edges.
///
/// The cube's faces meet to rounding only, so what lies on their borders is left out.
fn leak_rays(mesh: &TriangleMesh) -> [Vec<Ray>; 2] {
    let side = FACE_CELLS + 1;
    let inner = |i: u32| {
        let (x, y) = (i as usize % (side * side) % side, i as usize % (side * side) / side);
        x > 0 && y > 0 && x < FACE_CELLS && y < FACE_CELLS
    };
    let o = Vec3d::new(0.013, 0.007, -0.011).cast::<f32>();
    let at = |p: [f32; 3]| Ray::new(o, indigo_math::Vec3::from(p) - o);
    let unit = |r: Ray| Ray::new(o, r.d.normalized());
    let vertices = (0..(6 * side * side) as u32).filter(|i| inner(*i));
    let to_vertices = vertices.flat_map(|i| {
        let r = at(mesh.positions()[i as usize]);
        [r, unit(r)]
    });
    let mut random = Random(7);
    let faces = &mesh.triangles()[..mesh.triangles().len() - 12];
    let to_edges = faces.iter().filter(|t| inner(t[0]) && inner(t[1])).map(|t| {
        let [a, b] = [t[0], t[1]].map(|i| Vec3d::from(mesh.positions()[i as usize].map(f64::from)));
        unit(at((a + (b - a) * random.unit()).cast::<f32>().to_array()))
    });
    [to_vertices.collect(), to_edges.collect()]
}

fn leaks(embree: &Embree, scene: &BenchScene, missed: &mut Vec<String>) {
    let rays = leak_rays(&scene.mesh);
    // Without the box round the sphere, a ray that slips through meets nothing.
    let triangles = scene.mesh.triangles();
    let open = indigo_geom::MeshBuffers {
        positions: scene.mesh.positions().to_vec(),
        triangles: triangles[..triangles.len() - 12].to_vec(),
        ..Default::default()
    };
    let mesh = TriangleMesh::new(open).expect("in range");
    println!("leaks at {} vertices and {} edges:", rays[0].len(), rays[1].len());
    let device = embree.device(1);
    for (name, mode) in EMBREE {
        let s = device.scene(&mesh, mode);
        let lost = rays.each_ref().map(|set| set.iter().filter(|r| s.closest(r) == f32::INFINITY).count());
        println!("  {name}: {} {}", lost[0], lost[1]);
    }
    for (name, fast) in [("own quality", false), ("own fast", true)] {
        let accel = build(&mesh, fast, 2).0;
        let lost = rays.each_ref().map(|set| set.iter().filter(|r| accel.intersect(r).is_none()).count());
        println!("  {name}: {} {}", lost[0], lost[1]);
        if lost != [0, 0] {
            missed
                .push(format!("{name} lets {} rays through vertices and {} through edges", lost[0], lost[1]));
        }
    }
}

/// Builds 15,000 instances of two meshes.
fn instances(missed: &mut Vec<String>) {
    let meshes = vec![scenes::interior().mesh, scenes::thin().mesh];
    let mut random = Random(3);
    let mut at = || random.unit() * 1000.0;
    let objects = (0..15_000).map(|i| {
        let transform = Transform::new(Mat3::IDENTITY, Vec3d::new(at(), at(), at())).expect("invertible");
        Object::Mesh { mesh: i % 2, transform }
    });
    let objects: Vec<Object> = objects.collect();
    let start = Instant::now();
    let accel = Accel::build(meshes, objects, &BuildOptions::default(), &NoStore).expect("a sound scene");
    let all = start.elapsed().as_secs_f64();
    println!("\n{} instances of two meshes: built in {all:.3} s, meshes included", accel.stats().instances);
    // A scene of so many is to be read and ready within a second.
    if all > 1.0 {
        missed.push(format!("15,000 instances of two meshes build in {all:.3} s, not 1.0"));
    }
}
