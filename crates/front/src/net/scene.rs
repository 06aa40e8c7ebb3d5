//! Loading a master's scene on a slave.

use crate::paths;
use indigo_decl::{ResolveError, Resolved, Resolver};
use indigo_diag::{Severity, Style, to_text};
use indigo_igs::Limits;
use indigo_igs::pack::{PackLimits, PackResolver};
use indigo_net::slave::{Loader, SceneFiles};
use indigo_render::disk::{DiskResolver, DiskTreeStore};
use indigo_render::pool::with_jobs;
use indigo_scene::{LoadOptions, Override, Scene, load};
use std::sync::Arc;

/// What the master's settings file is called here.
const INIFILE: &str = "inifile.xml";

/// Loads scenes with what this machine adds: the files that come with the program, and the trees that it keeps. Nothing
/// else of its disk is read.
pub struct SceneLoader;

/// The master's settings file, and nothing else.
struct SettingsFile<'a>(Option<&'a [u8]>);

impl Resolver for SettingsFile<'_> {
    fn read(&self, path: &str, _from: &str) -> Result<Resolved, ResolveError> {
        match self.0 {
            Some(bytes) if path == INIFILE => Ok(Resolved { path: path.to_owned(), bytes: bytes.into() }),
            _ => Err(ResolveError::NotFound { looked: vec![] }),
        }
    }
}

impl Loader for SceneLoader {
    fn load(&self, files: &SceneFiles) -> Result<Scene, String> {
        let outside = SettingsFile(files.settings_file.as_deref());
        let resources = DiskResolver::only(paths::resource_directories());
        let resolver = PackResolver::open(
            &files.name,
            Arc::clone(&files.pack),
            &PackLimits::default(),
            &outside,
            &resources,
        )
        .map_err(|error| error.to_string())?;
        let overrides: Vec<Override<'_>> = files
            .overrides
            .iter()
            .map(|[option, setting, value]| Override { option, setting, value: value.clone() })
            .collect();
        let trees = DiskTreeStore::new(paths::tree_cache());
        let options = LoadOptions {
            resolver: &resolver,
            trees: &trees,
            inifile: files.settings_file.is_some().then_some(INIFILE),
            overrides: &overrides,
            limits: Limits::default(),
            check_only: false,
            stop: None,
        };
        let loaded = with_jobs(usize::MAX, || load(&files.name, &options));
        loaded.scene.ok_or_else(|| {
            let errors = loaded.sink.diagnostics().iter().filter(|d| d.severity == Severity::Error);
            errors.map(|d| to_text(d, &loaded.sources, Style::Plain)).collect::<Vec<_>>().join("\n")
        })
    }
}
