//! Loading a scene with what the command line and this machine add to it.

use crate::flags::Arguments;
use crate::{logical_cores, packs, paths};
use indigo_decl::Resolver;
use indigo_igs::Limits;
use indigo_igs::pack::{MaterialPacks, PackLimits};
use indigo_render::disk::{DiskResolver, DiskTreeStore};
use indigo_render::pool::with_jobs;
use indigo_scene::{LoadOptions, Loaded, Stop, load};
use std::path::PathBuf;

/// A scene, unless that was stopped, and the files that it was read from.
///
/// # Errors
/// Why a packed scene is not read.
pub fn load_scene(
    path: &str,
    arguments: &Arguments,
    stop: Option<&Stop>,
) -> Result<(Loaded, Vec<PathBuf>), String> {
    with_load_options(path, arguments, |options| {
        with_jobs(logical_cores(), || load(path, &LoadOptions { stop, ..*options }))
    })
}

/// Calls `load` with what the command line and this machine add to a scene; what it gives, and the files that it read.
///
/// # Errors
/// Why a packed scene is not read.
pub fn with_load_options<T>(
    scene: &str,
    arguments: &Arguments,
    load: impl FnOnce(&LoadOptions) -> T,
) -> Result<(T, Vec<PathBuf>), String> {
    let trees = DiskTreeStore::new(paths::tree_cache());
    with_resolver(scene, |resolver, inifile| {
        load(&LoadOptions {
            resolver,
            trees: &trees,
            inifile,
            overrides: &arguments.settings,
            limits: Limits::default(),
            check_only: arguments.check || arguments.print_settings,
            stop: None,
        })
    })
}

/// Calls `load` with where the files of a scene come from, and the path of the settings file; what it gives, and the
/// files that were read.
///
/// # Errors
/// Why a packed scene is not read.
pub fn with_resolver<T>(
    scene: &str,
    load: impl FnOnce(&dyn Resolver, Option<&str>) -> T,
) -> Result<(T, Vec<PathBuf>), String> {
    let disk = DiskResolver::new(paths::resource_directories()).for_scene(scene);
    let resources = DiskResolver::only(paths::resource_directories());
    let inifile = paths::inifile();
    let load = |resolver: &dyn Resolver| {
        load(&MaterialPacks::new(resolver, PackLimits::default()), inifile.as_deref())
    };
    let loaded =
        if packs::is_pack(scene) { load(&packs::open(scene, &disk, &resources)?) } else { load(&disk) };
    Ok((loaded, disk.files()))
}
