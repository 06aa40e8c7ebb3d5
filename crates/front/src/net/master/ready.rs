//! From a scene to a master that listens.

use super::{MasterRender, events, fail, fail_session};
use crate::flags::{Arguments, Role};
use crate::messages::Messages;
use crate::net::key::key;
use crate::net::machine;
use crate::net::own::Own;
use crate::prepare::{Prepared, describe_film, prepare};
use crate::saver::Saver;
use crate::status::BAD_INPUT;
use crate::{packs, paths, program};
use indigo_film::SavedFilm;
use indigo_net::key::Key;
use indigo_net::limits::{PACK, PORT, SETTINGS};
use indigo_net::master::{Master, SceneParcel, Setup};
use indigo_net::slave::written;
use indigo_render::disk::read_limited;
use indigo_render::memory::check_master;
use indigo_render::saved::blank_film;
use indigo_scene::Scene;
use std::net::SocketAddr;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;

/// Settings that are each machine's own.
const OWN: [&str; 2] = ["num_threads", "auto_choose_num_threads"];

/// A master that can begin.
pub struct Ready {
    /// As of a render of this machine alone.
    pub prepared: Prepared,
    key: Option<Key>,
    parcel: SceneParcel,
}

/// Gets ready to be a scene's master. See [`prepare`].
///
/// # Errors
/// The exit status where that cannot be; the reason was told.
pub fn get_ready(
    scene: Arc<Scene>,
    read: &[PathBuf],
    arguments: &Arguments,
    saved: Option<&SavedFilm>,
    named: Option<PathBuf>,
    messages: &mut dyn Messages,
) -> Result<Ready, u8> {
    let key = key(arguments, messages)?;
    let parcel = parcel(&scene, arguments).map_err(|message| {
        messages.error(&message);
        BAD_INPUT
    })?;
    let prepared = prepare(scene, read, arguments, saved, named, messages)?;
    Ok(Ready { prepared, key, parcel })
}

impl Ready {
    /// Listens, and begins to render if the role is that of a working master.
    ///
    /// # Errors
    /// The exit status where that cannot be; the reason was told.
    pub fn start(
        self,
        arguments: &Arguments,
        saved: Option<SavedFilm>,
        messages: &mut dyn Messages,
    ) -> Result<MasterRender, u8> {
        let Self { prepared, key, parcel } = self;
        let Prepared { scene, options, job, .. } = &prepared;
        let igi = job.paths.igi();
        if saved.is_none() && igi.exists() {
            let igi = igi.display();
            messages
                .warn(&format!("the film {igi} will be written over; to go on with it, give -r {igi}, too"));
        }
        check_master(scene, parcel.pack.len() as u64).map_err(|error| fail_session(&error, messages))?;
        describe_film(arguments.resume.as_deref(), saved.as_ref(), messages);
        let film = saved.unwrap_or_else(|| blank_film(scene, &job.version));
        // Not the last of the film's, which may be that of a slave who is still at work. Slaves draw theirs from so many that
        // this is none of them, and is refused to those who ask for it.
        let own_seed = arguments.seed.unwrap_or(0);
        let works = arguments.network == Some(Role::WorkingMaster);
        let is_open = key.is_some();
        let (sink, events) = events();
        let setup = Setup {
            scene: parcel,
            film,
            program: program(),
            key,
            own_seed: works.then_some(own_seed),
            port: arguments.port.unwrap_or(PORT),
            page: arguments.status.map(|address| (address, job.paths.png.clone())),
        };
        let master = Master::start(setup, sink).map_err(|error| fail(&error, messages))?;
        say_where(&master, is_open, messages);
        let own = works.then(|| Own::start(scene, options, own_seed, &master)).transpose();
        let own = own.map_err(|error| fail_session(&error, messages))?;
        let saver = Saver::new(job.clone());
        Ok(MasterRender { master, own, own_seed, events, started: Instant::now(), saver, prepared })
    }
}

/// The scene as slaves get it.
fn parcel(scene: &Scene, arguments: &Arguments) -> Result<SceneParcel, String> {
    let pack = packs::in_memory(&scene.output.scene_path, arguments)?;
    if pack.len() as u64 > PACK {
        let bytes = pack.len();
        return Err(format!(
            "the scene with its files has {bytes} bytes, packed; slaves take at most {PACK}"
        ));
    }
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

/// Says where slaves find the master, and people how things stand.
fn say_where(master: &Master, is_open: bool, messages: &mut dyn Messages) {
    let address = master.address();
    if is_open {
        messages.say(&format!("Waiting for slaves that have the key, at port {}", address.port()));
    } else {
        messages.say(&format!(
            "Waiting for slaves of this machine alone, at {address}; to let others join, make a key with \
             indigo_console --make-key FILE, and give it to master and slaves by --key-file"
        ));
    }
    if let Some(page) = master.page() {
        messages.say(&about_page(page, &machine()));
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
