//! Developing the film for the screen, again and again, on a thread of its own.
//!
//! A picture that is super-sampled is developed twice when a control moves: first from means over its output pixels, which
//! takes a quarter of the time or less and differs only where bright edges cross pixels, then wholly, unless the next
//! change has come meanwhile.

use crate::shrink;
use eframe::egui::{Color32, ColorImage};
use indigo_film::{FilmState, LightMix, XyzImage};
use indigo_front::logical_cores;
use indigo_imaging::{Picture, PictureSettings, develop_image, on_sensor, preview_light};
use indigo_render::pool::with_jobs;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// Bins of a histogram.
pub const BINS: usize = 128;

/// How often each brightness is there, for red, green and blue; the largest of all is 1.
#[derive(Clone, Debug, PartialEq)]
pub struct Histogram(pub [[f32; BINS]; 3]);

/// A picture to look at.
pub struct Shown {
    /// Its pixels.
    pub image: Arc<ColorImage>,
    /// The same as the graphics card takes it: smaller where it takes none so large.
    pub texture: Arc<ColorImage>,
    /// How often each brightness is there.
    pub histogram: Histogram,
    /// The light on the sensor, a value for each pixel of the picture: XYZ in cd/m².
    pub light: Arc<XyzImage>,
    /// From cd/m² to lux·s on the sensor.
    pub lux_seconds_per_nit: f64,
    /// How long developing took.
    pub time: Duration,
}

/// What is to be developed next.
#[derive(Default)]
struct Slot {
    film: Option<Arc<FilmState>>,
    settings: Option<PictureSettings>,
    /// How many pixels the sides of a texture may have.
    longest_side: Option<usize>,
    /// Whether nothing is to be shown until there is another film.
    is_cleared: bool,
    closed: bool,
}

/// Where films and settings go, and pictures come from.
#[derive(Default)]
pub struct Desk {
    slot: Mutex<Slot>,
    changed: Condvar,
    shown: Mutex<Option<Shown>>,
    /// What the last new film took, in microseconds.
    cost: AtomicU64,
}

/// A film and settings that came since the last picture.
type News = (Option<Arc<FilmState>>, Option<PictureSettings>);

/// What is kept between pictures.
#[derive(Default)]
struct Kept {
    settings: Option<PictureSettings>,
    /// The light of the film, where it may be diffracted or not.
    film: Option<Arc<FilmState>>,
    sensor: Option<Sensor>,
}

/// The light on the sensor.
struct Sensor {
    full: XyzImage,
    /// The same without super-sampling.
    small: Arc<XyzImage>,
    is_diffracted: bool,
    lights: LightMix,
}

impl Desk {
    fn slot(&self) -> MutexGuard<'_, Slot> {
        self.slot.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Shows another film from now on.
    pub fn set_film(&self, film: Arc<FilmState>) {
        let mut slot = self.slot();
        (slot.film, slot.is_cleared) = (Some(film), false);
        drop(slot);
        self.changed.notify_all();
    }

    /// Shows nothing from now on.
    pub fn clear(&self) {
        let mut slot = self.slot();
        (slot.film, slot.is_cleared) = (None, true);
        *self.shown.lock().unwrap_or_else(PoisonError::into_inner) = None;
    }

    /// Develops by other settings from now on.
    pub fn set_settings(&self, settings: PictureSettings) {
        self.slot().settings = Some(settings);
        self.changed.notify_all();
    }

    /// No texture has longer sides from now on. Nothing is developed before that is known.
    pub fn set_longest_side(&self, pixels: usize) {
        let mut slot = self.slot();
        if slot.longest_side != Some(pixels) {
            slot.longest_side = Some(pixels);
            self.changed.notify_all();
        }
    }

    /// A picture that has been developed since the last call.
    pub fn take(&self) -> Option<Shown> {
        self.shown.lock().unwrap_or_else(PoisonError::into_inner).take()
    }

    /// What developing the last new film took.
    pub fn last_cost(&self) -> Duration {
        Duration::from_micros(self.cost.load(Ordering::Relaxed))
    }

    /// Ends the work.
    pub fn close(&self) {
        self.slot().closed = true;
        self.changed.notify_all();
    }

    /// Develops until closed, and calls `wake` for each picture; `fail` for each that cannot be developed, by a bug.
    pub fn work(&self, wake: &dyn Fn(), fail: &dyn Fn()) {
        let mut kept = Kept::default();
        while let Some(news) = self.next() {
            let develops = AssertUnwindSafe(|| self.develop(&mut kept, news, wake));
            if catch_unwind(develops).is_err() {
                kept.sensor = None;
                fail();
            }
        }
    }

    fn develop(&self, kept: &mut Kept, (film, settings): News, wake: &dyn Fn()) {
        let start = Instant::now();
        if self.slot().is_cleared {
            (kept.film, kept.sensor) = (None, None);
        }
        let is_new_film = film.is_some();
        kept.film = film.or(kept.film.take());
        kept.settings = settings.or(kept.settings.take());
        let (Some(film), Some(settings)) = (&kept.film, kept.settings.clone()) else { return };
        if is_new_film || kept.sensor.as_ref().is_none_or(|sensor| !sensor.is_of(&settings)) {
            kept.sensor = with_jobs(logical_cores(), || Sensor::new(film, &settings));
        }
        let Some(Sensor { full, small, .. }) = &kept.sensor else { return };
        let is_small_enough = full.size.super_sample() == 1;
        if !is_new_film && !is_small_enough {
            self.show(small, small, &settings, start, wake);
        }
        if is_new_film || is_small_enough || !self.has_next() {
            self.show(full, small, &settings, start, wake);
            if is_new_film {
                self.cost.store(start.elapsed().as_micros() as u64, Ordering::Relaxed);
            }
        }
    }

    /// Waits for something to do; `None` after the end.
    fn next(&self) -> Option<News> {
        let mut slot = self.slot();
        loop {
            if slot.closed {
                return None;
            }
            if slot.longest_side.is_some() && (slot.film.is_some() || slot.settings.is_some()) {
                return Some((slot.film.take(), slot.settings.take()));
            }
            slot = self.changed.wait(slot).unwrap_or_else(PoisonError::into_inner);
        }
    }

    fn has_next(&self) -> bool {
        let slot = self.slot();
        slot.closed || slot.film.is_some() || slot.settings.is_some()
    }

    fn show(
        &self,
        from: &XyzImage,
        light: &Arc<XyzImage>,
        settings: &PictureSettings,
        start: Instant,
        wake: &dyn Fn(),
    ) {
        let longest_side = self.slot().longest_side.unwrap_or(usize::MAX);
        let (image, texture, histogram) = with_jobs(logical_cores(), || {
            let (image, histogram) = on_screen(&develop_image(from, settings));
            let image = Arc::new(image);
            let texture = shrink::to_fit(&image, longest_side);
            (image, texture, histogram)
        });
        let shown = Shown {
            image,
            texture,
            histogram,
            light: Arc::clone(light),
            lux_seconds_per_nit: settings.exposure.lux_seconds_per_nit(),
            time: start.elapsed(),
        };
        let slot = self.slot();
        if slot.is_cleared {
            return;
        }
        *self.shown.lock().unwrap_or_else(PoisonError::into_inner) = Some(shown);
        drop(slot);
        wake();
    }
}

impl Sensor {
    fn new(film: &FilmState, settings: &PictureSettings) -> Option<Self> {
        let full = on_sensor(film.develop_mixed(&settings.lights, |_| true), settings);
        let small = Arc::new(preview_light(&full)?);
        Some(Self {
            full,
            small,
            is_diffracted: settings.diffraction.is_some(),
            lights: settings.lights.clone(),
        })
    }

    /// Whether it would be the same by other settings.
    fn is_of(&self, settings: &PictureSettings) -> bool {
        self.is_diffracted == settings.diffraction.is_some() && self.lights == settings.lights
    }
}

fn on_screen(picture: &Picture) -> (ColorImage, Histogram) {
    let codes = picture.to_screen();
    let pixels = || codes.iter().map(|&[r, g, b, _]| Color32::from_rgb(r, g, b)).collect();
    let (histogram, pixels) = rayon::join(|| histogram(&codes), pixels);
    (ColorImage::new([picture.width as usize, picture.height as usize], pixels), histogram)
}

fn histogram(codes: &[[u8; 4]]) -> Histogram {
    let mut counts = [[0u32; BINS]; 3];
    for code in codes {
        for (counts, &value) in counts.iter_mut().zip(code) {
            counts[usize::from(value) * BINS / 256] += 1;
        }
    }
    // Black and white are often so many that nothing else would be seen.
    let inner = counts.iter().flat_map(|counts| &counts[1..BINS - 1]).max().copied().unwrap_or(0);
    Histogram(counts.map(|counts| counts.map(|n| (n as f32 / inner.max(1) as f32).min(1.0))))
}

#[cfg(test)]
mod tests {
    use super::*;
    use indigo_film::{FilmSize, LayerKind};
    use indigo_imaging::{Exposure, ToneMapping};

    fn settings(scale: f64) -> PictureSettings {
        let exposure = Exposure { aperture_area: 1.0, lens_sensor_dist: 1.0, duration: 1.0 };
        PictureSettings::plain(ToneMapping::Linear { scale }, exposure)
    }

    /// A film of even light of so many cd/m².
    fn film(luminance: f64, super_sample: u32) -> Arc<FilmState> {
        let size = FilmSize::new(4, 3, super_sample).unwrap();
        let mut film = FilmState::new(size, &[(LayerKind::PerPixel, "camera")]);
        film.layers[0].sums.fill([0.9505, 1.0, 1.089, 1.0].map(|v| v * luminance));
        film.layers[0].counts.fill(1.0);
        Arc::new(film)
    }

    /// Ends the work with the test, also where it fails: its thread is waited for.
    struct Ends<'d>(&'d Desk);

    impl Drop for Ends<'_> {
        fn drop(&mut self) {
            self.0.close();
        }
    }

    #[test]
    fn each_change_is_shown_in_the_end() {
        let desk = Desk::default();
        let (woken, waking) = std::sync::mpsc::channel();
        std::thread::scope(|scope| {
            let _ends = Ends(&desk);
            scope.spawn(|| {
                desk.work(&move || _ = woken.send(()), &|| panic!("a picture cannot be developed"));
            });
            let wait = || {
                waking.recv_timeout(Duration::from_mins(1)).expect("a picture");
                desk.take()
            };
            desk.set_settings(settings(0.25));
            desk.set_film(film(1.0, 2));
            assert!(waking.recv_timeout(Duration::from_millis(50)).is_err(), "how large may it be?");
            desk.set_longest_side(2);
            let first = wait().expect("a picture");
            assert_eq!((first.image.size, first.texture.size), ([4, 3], [2, 2]));
            // 0.25 of full light is code 137.
            assert_eq!(first.image.pixels[5].r(), 137);
            assert_eq!(first.light.pixels.len(), 12);
            assert!((first.light.pixels[0][1] - 1.0).abs() < 1e-6);
            desk.set_settings(settings(0.5));
            let second = wait().expect("a preview");
            assert_eq!(second.image.pixels[5].r(), 188);
            wait();
            desk.set_film(film(2.0, 2));
            assert_eq!(wait().expect("a picture").image.pixels[5].r(), 255);
        });
    }

    #[test]
    fn a_picture_that_cannot_be_developed_is_told_and_the_next_is_shown() {
        let desk = Desk::default();
        let (told, telling) = std::sync::mpsc::channel();
        let failed = told.clone();
        std::thread::scope(|scope| {
            let _ends = Ends(&desk);
            scope.spawn(|| desk.work(&move || _ = told.send(true), &move || _ = failed.send(false)));
            let wait = || telling.recv_timeout(Duration::from_mins(1)).expect("an answer");
            desk.set_longest_side(4);
            desk.set_settings(settings(0.25));
            let mut broken = (*film(1.0, 1)).clone();
            // No file is read into a film whose pixels have sums but no counts.
            broken.layers[0].counts.truncate(5);
            desk.set_film(Arc::new(broken));
            assert!(!wait());
            desk.set_film(film(1.0, 1));
            assert!(wait());
        });
    }

    #[test]
    fn black_and_white_do_not_hide_the_rest() {
        let mut codes = vec![[0, 0, 0, 255]; 1000];
        codes.extend([[100, 100, 200, 255]; 10]);
        codes.extend([[100, 100, 100, 255]; 10]);
        let Histogram([red, _, blue]) = histogram(&codes);
        assert_eq!((red[0], red[50], red[51]), (1.0, 1.0, 0.0));
        assert_eq!((blue[50], blue[100]), (0.5, 0.5));
    }
}
