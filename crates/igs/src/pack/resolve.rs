//! Rendering straight from a packed scene.

use super::read::{Pack, PackError, PackLimits};
use indigo_decl::{ResolveError, Resolved, Resolver, SHIPPED};
use std::sync::Arc;

/// Finds files in a packed scene, and what the program brings with it elsewhere.
///
/// The pack's own path stands for the scene in it. A file of the pack may name others of the pack, and files that come
/// with the program, such as `nkdata/au.nk`; it never reaches anything else of the disk.
pub struct PackResolver<'a> {
    path: &'a str,
    pack: Pack,
    /// The scene's name in the pack.
    main: String,
    /// Where files come from that are not named by the pack.
    outside: &'a dyn Resolver,
    /// Where files are that come with the program.
    resources: &'a dyn Resolver,
}

impl<'a> PackResolver<'a> {
    /// A resolver for the packed scene that is called `path` and has these bytes.
    ///
    /// `outside` finds what the front end asks for by itself, such as its settings file; `resources` what comes with the
    /// program, by paths from nowhere in particular.
    ///
    /// # Errors
    /// See [`PackError`].
    pub fn open(
        path: &'a str,
        bytes: Arc<[u8]>,
        limits: &PackLimits,
        outside: &'a dyn Resolver,
        resources: &'a dyn Resolver,
    ) -> Result<Self, PackError> {
        let pack = Pack::open(bytes, limits)?;
        let main = pack.main()?.to_owned();
        Ok(Self { path, pack, main, outside, resources })
    }

    fn member(&self, name: &str) -> Result<Resolved, ResolveError> {
        let path = format!("{}/{name}", self.path);
        match self.pack.read(name) {
            Ok(content) => Ok(Resolved { path, bytes: content.into() }),
            Err(error) => Err(ResolveError::Unreadable { path, reason: error.to_string() }),
        }
    }

    /// The member of the pack that a file means which is shown as `from`.
    fn inside<'f>(&self, from: &'f str) -> Option<&'f str> {
        from.strip_prefix(self.path)?.strip_prefix('/')
    }
}

impl Resolver for PackResolver<'_> {
    fn read(&self, path: &str, from: &str) -> Result<Resolved, ResolveError> {
        if from.is_empty() {
            return if path == self.path { self.member(&self.main) } else { self.outside.read(path, from) };
        }
        // What comes with the program may name what else does.
        let Some(from) = self.inside(from) else { return self.resources.read(path, from) };
        let wanted = path.replace('\\', "/");
        let beside = from.rsplit_once('/').map_or("", |(folder, _)| folder);
        // Whatever the path once was, a file of its name in the pack is what is meant.
        let last = wanted.rsplit('/').next().unwrap_or_default();
        let candidates = [within(beside, &wanted), within("", &wanted), Some(last.to_owned())];
        if let Some(name) = candidates.iter().flatten().find_map(|name| self.pack.find(name)) {
            return self.member(name);
        }
        let looked = candidates.into_iter().flatten().map(|name| format!("{}/{name}", self.path)).collect();
        let not_found = Err(ResolveError::NotFound { looked });
        let is_resource = |name: &String| {
            SHIPPED.iter().any(|folder| name.strip_prefix(folder).is_some_and(|rest| rest.starts_with('/')))
        };
        match within("", &wanted).filter(is_resource) {
            Some(resource) => self.resources.read(&resource, self.path).or(not_found),
            None => not_found,
        }
    }
}

/// A relative path from a folder, without detours; `None` where it leads out of the pack.
fn within(folder: &str, path: &str) -> Option<String> {
    if path.starts_with('/') {
        return None;
    }
    let mut parts: Vec<&str> = vec![];
    for part in folder.split('/').chain(path.split('/')) {
        match part {
            "" | "." => {}
            ".." => drop(parts.pop()?),
            part => parts.push(part),
        }
    }
    Some(parts.join("/"))
}
