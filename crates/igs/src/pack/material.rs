//! Packed materials (`.pigm`) that a scene includes.

use super::read::{Pack, PackLimits};
use indigo_decl::{ResolveError, Resolved, Resolver};
use std::collections::HashMap;
use std::sync::{Arc, Mutex, PoisonError};

/// The ending of packed materials.
const ENDING: &str = ".pigm";

/// Finds files by another resolver, and in the packed materials among them.
///
/// A packed material stands for the `.igm` in it. What that names is looked for in the pack by the last part of its
/// path, and then where the pack itself would look for it.
pub struct MaterialPacks<'a> {
    inner: &'a dyn Resolver,
    limits: PackLimits,
    /// Those that have been opened, by their paths.
    packs: Mutex<HashMap<String, Arc<Pack>>>,
}

impl<'a> MaterialPacks<'a> {
    /// Over another resolver, for packs within some limits.
    pub fn new(inner: &'a dyn Resolver, limits: PackLimits) -> Self {
        Self { inner, limits, packs: Mutex::default() }
    }

    /// The pack that a file shown as `from` is in, and the pack's path.
    fn pack_of<'f>(&self, from: &'f str) -> Option<(Arc<Pack>, &'f str)> {
        let (path, _) = from.rsplit_once('/')?;
        let packs = self.packs.lock().unwrap_or_else(PoisonError::into_inner);
        packs.get(path).map(|pack| (pack.clone(), path))
    }

    /// A file that is in none of the packs, or the material in it.
    fn outside(&self, path: &str, from: &str) -> Result<Resolved, ResolveError> {
        let found = self.inner.read(path, from)?;
        let is_packed = found.path.to_ascii_lowercase().ends_with(ENDING);
        if is_packed { self.material(&found) } else { Ok(found) }
    }

    /// The material in a pack.
    fn material(&self, found: &Resolved) -> Result<Resolved, ResolveError> {
        let unreadable = |reason: String| ResolveError::Unreadable { path: found.path.clone(), reason };
        let pack = Pack::open(found.bytes.clone(), &self.limits).map_err(|e| unreadable(e.to_string()))?;
        let name = pack.material().map_err(|e| unreadable(e.to_string()))?.to_owned();
        let bytes = pack.read(&name).map_err(|e| unreadable(e.to_string()))?;
        let mut packs = self.packs.lock().unwrap_or_else(PoisonError::into_inner);
        packs.insert(found.path.clone(), Arc::new(pack));
        Ok(Resolved { path: format!("{}/{name}", found.path), bytes: bytes.into() })
    }
}

impl Resolver for MaterialPacks<'_> {
    fn read(&self, path: &str, from: &str) -> Result<Resolved, ResolveError> {
        let Some((pack, pack_path)) = self.pack_of(from) else { return self.outside(path, from) };
        let last = path.rsplit(['/', '\\']).next().unwrap_or_default();
        let Some(name) = pack.find(last) else { return self.outside(path, pack_path) };
        let shown = format!("{pack_path}/{name}");
        match pack.read(name) {
            Ok(bytes) => Ok(Resolved { path: shown, bytes: bytes.into() }),
            Err(error) => Err(ResolveError::Unreadable { path: shown, reason: error.to_string() }),
        }
    }
}
