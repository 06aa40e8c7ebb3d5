//! `-n m` and `-n wm`.

use super::own::Own;
use super::{PULSE, events, fail, key, machine};
use crate::claim::Claim;
use crate::console::Console;
use crate::interrupts::{end_in_order, is_interrupted};
use crate::render::{between_lines, say_why};
use indigo_film::SavedFilm;
use indigo_front::flags::{Arguments, Role};
use indigo_front::messages::{Messages as _, count, say_saved};
use indigo_front::prepare::{Prepared, describe_film, fail as fail_session, prepare};
use indigo_front::saver::Saver;
use indigo_front::status::{BAD_INPUT, FAILED, RENDERED};
use indigo_front::{packs, paths, program};
use indigo_net::event::Event;
use indigo_net::ledger::Refusal;
use indigo_net::limits::{PORT, REPORTS, SETTINGS};
use indigo_net::master::{Master, SceneParcel, Setup, Status};
use indigo_net::slave::written;
use indigo_render::disk::read_limited;
use indigo_render::memory::check_master;
use indigo_render::saved::blank_film;
use indigo_render::{Halt, HaltReason, Progress};
use indigo_scene::Scene;
use std::net::SocketAddr;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::mpsc::Receiver;
use std::time::{Duration, Instant};

/// When slaves are to report often, so that they do not render much more than is wanted: they hear of it by a report of the
/// usual time, and the estimate is rough.
const NEAR_END: Duration = Duration::from_secs(3 * REPORTS.as_secs());
/// How long slaves have, at the end, to begin sending what they have.
const GRACE: Duration = Duration::from_secs(20);
/// How long they have in all, if they do.
const LONGEST_GRACE: Duration = Duration::from_mins(5);
/// How long they have to hear that everything is saved: some reports.
const FAREWELL: Duration = Duration::from_secs(5);
/// Settings that are each machine's own.
const OWN: [&str; 2] = ["num_threads", "auto_choose_num_threads"];

/// Adds up what slaves render until told to stop; the exit status. See [`render`](crate::render::render).
pub fn master(
    scene: Scene,
    read: &[PathBuf],
    arguments: &Arguments,
    saved: Option<SavedFilm>,
    named: Option<PathBuf>,
    console: &mut Console,
) -> u8 {
    let key = match key(arguments, console) {
        Ok(key) => key,
        Err(status) => return status,
    };
    let parcel = match parcel(&scene, arguments) {
        Ok(parcel) => parcel,
        Err(message) => {
            console.error(&message);
            return BAD_INPUT;
        }
    };
    let prepared = match prepare(Arc::new(scene), read, arguments, saved.as_ref(), named, console) {
        Ok(prepared) => prepared,
        Err(status) => return status,
    };
    end_in_order();
    let Prepared { scene, options, job, .. } = &prepared;
    let _claim = match Claim::of(&job.paths.png, console) {
        Ok(claim) => claim,
        Err(status) => return status,
    };
    let igi = job.paths.igi();
    if saved.is_none() && igi.exists() {
        let igi = igi.display();
        console.warn(&format!("the film {igi} will be written over; to go on with it, give -r {igi}, too"));
    }
    if let Err(error) = check_master(scene, parcel.pack.len() as u64) {
        return fail_session(&error, console);
    }
    let film = match saved {
        Some(saved) => {
            describe_film(arguments.resume.as_deref(), Some(&saved), console);
            saved
        }
        None => blank_film(scene, &job.version),
    };
    // Not the last of the film's, which may be that of a slave who is still at work. Slaves draw theirs from so many that this
    // is none of them, and is refused to those who ask for it.
    let own_seed = arguments.seed.unwrap_or(0);
    let is_open = key.is_some();
    let (sink, events) = events();
    let setup = Setup {
        scene: parcel,
        film,
        program: program(),
        key,
        own_seed: (arguments.network == Some(Role::WorkingMaster)).then_some(own_seed),
        port: arguments.port.unwrap_or(PORT),
        page: arguments.status.map(|address| (address, job.paths.png.clone())),
    };
    let master = match Master::start(setup, sink) {
        Ok(master) => master,
        Err(error) => return fail(&error, console),
    };
    say_where(&master, is_open, console);
    if let Some(page) = master.page() {
        console.say(&about_page(page, &machine()));
    }
    let own = match arguments.network {
        Some(Role::WorkingMaster) => match Own::start(scene, options, own_seed, &master) {
            Ok(own) => Some(own),
            Err(error) => return fail_session(&error, console),
        },
        _ => None,
    };
    Run { master, own, events, halt: options.halt, started: Instant::now(), saver: Saver::new(job.clone()) }
        .follow(between_lines(&scene.output, console), console)
}

/// The scene as slaves get it.
fn parcel(scene: &Scene, arguments: &Arguments) -> Result<SceneParcel, String> {
    let pack = packs::in_memory(&scene.output.scene_path, arguments)?;
    let settings_file = paths::inifile()
        .map(|path| read_limited(Path::new(&path)).map_err(|error| format!("cannot read {path}: {error}")))
        .transpose()?;
    if let Some(file) = settings_file.as_ref().filter(|file| file.len() > SETTINGS) {
        let bytes = file.len();
        return Err(format!("the settings file has {bytes} bytes; slaves are sent at most {SETTINGS}"));
    }
    let overrides = arguments.settings.iter().filter(|setting| !OWN.contains(&setting.setting));
    let texts = overrides.map(|s| [s.option.to_owned(), s.setting.to_owned(), s.value.clone()]);
    Ok(SceneParcel::new(scene, pack, settings_file, texts.collect()))
}

/// Says where slaves find the master.
fn say_where(master: &Master, is_open: bool, console: &mut Console) {
    let address = master.address();
    if is_open {
        console.say(&format!("Waiting for slaves that have the key, at port {}", address.port()));
    } else {
        console.say(&format!(
            "Waiting for slaves of this machine alone, at {address}; to let others join, make a key with \
             indigo_console --make-key FILE, and give it to master and slaves by --key-file"
        ));
    }
}

/// Where people can look, and who can.
fn about_page(page: SocketAddr, machine: &str) -> String {
    if page.ip().is_loopback() {
        return format!("How things stand is shown at http://{page}/");
    }
    let host = if page.ip().is_unspecified() { machine.to_owned() } else { page.ip().to_string() };
    let place = written(&host, page.port());
    format!("How things stand is shown to everybody who reaches this machine, at http://{place}/")
}

/// Says what became of what was rendered here.
fn say_added(added: &Result<Option<Event>, Refusal>, console: &mut Console) {
    match added {
        Ok(Some(event)) => console.event(event),
        Ok(None) => {}
        Err(refusal) => console.warn(&format!("what was rendered here does not fit the film: {refusal}")),
    }
}

/// A render of many machines.
struct Run {
    master: Master,
    own: Option<Own>,
    events: Receiver<Event>,
    halt: Halt,
    started: Instant,
    saver: Saver,
}

impl Run {
    /// Until it is to end; the exit status.
    fn follow(mut self, between: Duration, console: &mut Console) -> u8 {
        let mut last_line: Option<Instant> = None;
        loop {
            self.pass(PULSE.min(between).min(self.saver.until_due()), console);
            let progress = self.progress();
            if last_line.is_none_or(|t| t.elapsed() >= between) {
                last_line = Some(Instant::now());
                console.progress_of(&progress, &self.company());
            }
            self.save(console);
            // It may be near as long as nobody has said how fast it comes.
            let is_near_end =
                progress.samples_per_second == 0.0 || progress.left.is_some_and(|left| left < NEAR_END);
            self.master.tell_near_end(is_near_end && self.halt.samples_per_pixel.is_some());
            if let Some(reason) = self.why_end(progress.elapsed) {
                return self.finish(&reason, progress.elapsed, console);
            }
        }
    }

    /// Lets time pass.
    fn pass(&mut self, time: Duration, console: &mut Console) {
        match &mut self.own {
            Some(own) => own.wait(time, &self.master),
            None => {
                // It may also be that there will be none any more.
                if let Ok(event) = self.events.recv_timeout(time) {
                    console.event(&event);
                }
            }
        }
        self.tell_events(console);
    }

    fn save(&mut self, console: &mut Console) {
        if let Some(record) = self.saver.look_after(console) {
            self.master.saved(record);
        }
        if self.saver.is_due() {
            let version = self.saver.job().version.clone();
            let added = self.own.as_mut().map_or(Ok(None), |own| own.hand_over(&self.master, &version));
            say_added(&added, console);
            let film = self.copy(console);
            self.saver.begin(film, console);
        }
    }

    /// A copy of the film, of all of which the log tells by then.
    fn copy(&self, console: &mut Console) -> SavedFilm {
        let film = self.master.copy();
        self.tell_events(console);
        film
    }

    /// Why it is to end, if it is.
    fn why_end(&self, elapsed: Duration) -> Option<HaltReason> {
        let failure = self.own.as_ref().and_then(|own| own.ended.clone());
        let is_late = || self.halt.time.is_some_and(|time| elapsed >= time);
        failure
            .or_else(|| is_interrupted().then_some(HaltReason::Stopped))
            .or_else(|| self.has_enough(true).then_some(HaltReason::Samples))
            .or_else(|| is_late().then_some(HaltReason::Time))
    }

    /// Whether there are as many samples as were asked for, with those that slaves have still to send or without.
    fn has_enough(&self, with_waiting: bool) -> bool {
        self.halt.samples_per_pixel.is_some_and(|passes| {
            let Status { size: [width, height], samples, waiting, .. } = self.master.status();
            let wanted = u128::from(width) * u128::from(height) * u128::from(passes);
            u128::from(samples) + u128::from(if with_waiting { waiting } else { 0 }) >= wanted
        })
    }

    /// How far it is, with what has been rendered here and is not in the film yet.
    fn progress(&self) -> Progress {
        let status = self.master.status();
        let pixels = (f64::from(status.size[0]) * f64::from(status.size[1])).max(1.0);
        let (samples, samples_per_second) = (status.samples, status.samples_per_second);
        let elapsed = self.started.elapsed();
        let by_samples = self.halt.samples_per_pixel.map(|spp| {
            let (wanted, rendered) = (spp as f64 * pixels, samples as f64 + status.waiting as f64);
            let left = (wanted - rendered).max(0.0) / samples_per_second;
            (rendered / wanted.max(1.0), if left.is_finite() { left } else { f64::MAX })
        });
        let by_time = self.halt.time.map(|time| {
            (elapsed.as_secs_f64() / time.as_secs_f64(), time.saturating_sub(elapsed).as_secs_f64())
        });
        let next = [by_samples, by_time].into_iter().flatten().min_by(|a, b| a.1.total_cmp(&b.1));
        Progress {
            samples,
            samples_per_pixel: samples as f64 / pixels,
            samples_per_second,
            rays: self.own.as_ref().map_or(0, |own| own.progress.rays),
            elapsed,
            left: next.and_then(|(_, left)| Duration::try_from_secs_f64(left).ok()),
            fraction: next.map(|(fraction, _)| fraction.clamp(0.0, 1.0)),
            relative_error: None,
        }
    }

    /// Who else is at work.
    fn company(&self) -> String {
        format!("   {}", count(self.master.status().present, "slave"))
    }

    /// Gathers the last of what there is, and saves it; the exit status.
    fn finish(mut self, reason: &HaltReason, elapsed: Duration, console: &mut Console) -> u8 {
        let program = self.saver.job().version.clone();
        self.master.begin_end();
        let added = self.own.as_mut().map_or(Ok(None), |own| own.end(&self.master, &program));
        say_added(&added, console);
        self.wait_for_rest(console);
        if let Some(record) = self.saver.wait_for_last(console) {
            self.master.saved(record);
        }
        self.tell_events(console);
        let progress = self.progress();
        console.last_progress(&progress);
        if *reason == HaltReason::Samples && !self.has_enough(false) {
            console.warn(
                "slaves that are gone had the last of the samples: go on with the film to have them all (-r)",
            );
        } else {
            // The last of the slaves' samples are counted, and the time that they took to come is not.
            say_why(reason, &Progress { elapsed, ..progress }, console);
        }
        let job = self.saver.job();
        let film = self.copy(console);
        let mut saved = job.save(&film);
        if let Some(record) = film.record
            && saved.written.contains(&job.paths.igi())
        {
            let runs = record.runs.clone();
            self.master.saved(record);
            self.see_off(console);
            self.master.close();
            // Somebody who was given up has come after all.
            let film = self.copy(console);
            if film.record.as_ref().is_some_and(|record| record.runs != runs) {
                saved = job.save(&film);
            }
        }
        let is_saved = say_saved(&saved, console);
        if is_saved && !matches!(reason, HaltReason::Failed(_)) { RENDERED } else { FAILED }
    }

    /// Waits for what slaves have left. Those that send may need longer than those that are silent, which a slave that was
    /// killed is.
    fn wait_for_rest(&self, console: &mut Console) {
        if !self.master.has_all() {
            let slaves = count(self.master.status().present, "slave");
            console.say(&format!(
                "Waiting for the last of {slaves}; Ctrl-C again ends at once, and saves nothing more"
            ));
        }
        let start = Instant::now();
        let (mut seen, mut last_news) = (0, start);
        while !self.master.has_all() && last_news.elapsed() < GRACE && start.elapsed() < LONGEST_GRACE {
            if let Ok(event) = self.events.recv_timeout(PULSE) {
                console.event(&event);
            }
            let status = self.master.status();
            let news = status.samples.wrapping_add(status.bytes_received);
            if news != seen {
                (seen, last_news) = (news, Instant::now());
            }
        }
    }

    /// Waits until slaves have heard that all they sent is in a file, and have left. Who does not hear of it would only send
    /// it once more, to a master that goes on with that file.
    fn see_off(&self, console: &mut Console) {
        let start = Instant::now();
        while !self.master.is_deserted() && start.elapsed() < FAREWELL {
            if let Ok(event) = self.events.recv_timeout(PULSE) {
                console.event(&event);
            }
        }
        self.tell_events(console);
    }

    fn tell_events(&self, console: &mut Console) {
        for event in self.events.try_iter() {
            console.event(&event);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::about_page;

    #[test]
    fn the_page_is_told_by_an_address_that_can_be_opened() {
        let told = |address: &str| about_page(address.parse().expect("an address"), "lust");
        assert!(told("127.0.0.1:80").ends_with("shown at http://127.0.0.1:80/"));
        for (address, place) in [
            ("0.0.0.0:8080", "http://lust:8080/"),
            ("[::]:8080", "http://lust:8080/"),
            ("10.0.0.1:80", "http://10.0.0.1:80/"),
            ("[2001:db8::1]:80", "http://[2001:db8::1]:80/"),
        ] {
            let said = told(address);
            assert!(said.contains("everybody") && said.ends_with(place), "{said}");
        }
    }
}
