//! The time from a control's move to the picture, of two megapixels.

use crate::develop::{Desk, Shown};
use crate::median;
use indigo_film::{FilmSize, FilmState, LayerKind};
use indigo_imaging::{Exposure, PictureSettings, Response, ToneMapping};
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, channel};
use std::time::{Duration, Instant};

const SIZE: [u32; 2] = [1920, 1080];
const MOVES: u32 = 20;

/// Measures, and tells.
pub fn measure(_folder: &Path) {
    println!("milliseconds from a control's move to a picture of {} x {}: median, worst", SIZE[0], SIZE[1]);
    for super_sample in [1, 2] {
        let film = film(super_sample);
        for is_busy in [false, true] {
            let busy = if is_busy { ", while all cores are busy" } else { "" };
            for (name, mapping) in mappings() {
                let times = with_load(is_busy, || times(&film, &mapping));
                let worst = times.iter().copied().fold(0.0, f64::max);
                println!("  super-sampling {super_sample}, {name}{busy}: {:.0}, {worst:.0}", median(times));
            }
        }
    }
}

/// A tone mapping of a brightness.
type Mapping = Box<dyn Fn(f64) -> ToneMapping>;

fn mappings() -> [(&'static str, Mapping); 3] {
    let response = Arc::new(Response::display());
    [
        ("linear", Box::new(|ev: f64| ToneMapping::Linear { scale: ev.exp2() })),
        (
            "Reinhard",
            Box::new(|ev: f64| ToneMapping::Reinhard {
                pre_scale: 4.0 * ev.exp2(),
                post_scale: 1.2,
                burn: 6.0,
            }),
        ),
        (
            "camera",
            Box::new(move |ev| ToneMapping::Camera {
                response: Arc::clone(&response),
                ev_adjust: ev,
                film_iso: 100.0,
            }),
        ),
    ]
}

/// Light of all brightnesses, without a pattern.
fn film(super_sample: u32) -> Arc<FilmState> {
    let size = FilmSize::new(SIZE[0], SIZE[1], super_sample).expect("a size");
    let mut film = FilmState::new(size, &[(LayerKind::PerPixel, "camera")]);
    let layer = &mut film.layers[0];
    for (i, sums) in layer.sums.iter_mut().enumerate() {
        // Knuth's multiplicative hash.
        let value = f64::from((i as u32).wrapping_mul(2_654_435_769) >> 16) / 65536.0;
        *sums = [0.9505, 1.0, 1.089, 1.0].map(|v| v * value);
    }
    layer.counts.fill(1.0);
    Arc::new(film)
}

/// Runs something beside threads that render, as it were, or alone.
fn with_load<T>(is_busy: bool, run: impl FnOnce() -> T) -> T {
    let ends = AtomicBool::new(false);
    std::thread::scope(|scope| {
        if is_busy {
            for _ in 0..indigo_front::logical_cores() {
                scope.spawn(|| {
                    while !ends.load(Ordering::Relaxed) {
                        std::hint::spin_loop();
                    }
                });
            }
        }
        let result = run();
        ends.store(true, Ordering::Relaxed);
        result
    })
}

fn times(film: &Arc<FilmState>, mapping: &Mapping) -> Vec<f64> {
    let exposure = Exposure { aperture_area: 1e-5, lens_sensor_dist: 0.035, duration: 0.008 };
    let settings = |ev| PictureSettings::plain(mapping(ev), exposure);
    let desk = Desk::default();
    let (woken, waking) = channel();
    std::thread::scope(|scope| {
        scope.spawn(|| desk.work(&move || _ = woken.send(()), &|| panic!("a picture cannot be developed")));
        desk.set_longest_side(SIZE[0] as usize);
        desk.set_settings(settings(0.0));
        desk.set_film(Arc::clone(film));
        wait(&waking, &desk);
        let times = (1..=MOVES).map(|step| {
            let start = Instant::now();
            desk.set_settings(settings(f64::from(step) / f64::from(MOVES)));
            wait(&waking, &desk);
            let time = start.elapsed();
            // The whole picture behind a preview is nobody's wait.
            while waking.recv_timeout(Duration::from_millis(400)).is_ok() {}
            desk.take();
            1000.0 * time.as_secs_f64()
        });
        let times = times.collect();
        desk.close();
        times
    })
}

fn wait(waking: &Receiver<()>, desk: &Desk) -> Shown {
    waking.recv_timeout(Duration::from_mins(1)).expect("a picture");
    desk.take().expect("a picture")
}
