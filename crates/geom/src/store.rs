//! Where built trees are kept between runs; the host decides.

/// Keeps the bytes of built trees by key.
///
/// What `load` returns is checked before use, so a store may be stale, damaged or hostile.
pub trait TreeStore: Sync {
    /// The bytes kept under a key, if any.
    fn load(&self, key: &[u8; 32]) -> Option<Vec<u8>>;
    /// Keeps bytes under a key; failures are the store's own affair.
    fn store(&self, key: &[u8; 32], bytes: &[u8]);
    /// Whether keeping is wanted at all; where not, nothing is serialised.
    fn is_active(&self) -> bool {
        true
    }
}

/// A store that keeps nothing.
#[derive(Clone, Copy, Debug, Default)]
pub struct NoStore;

impl TreeStore for NoStore {
    fn load(&self, _key: &[u8; 32]) -> Option<Vec<u8>> {
        None
    }
    fn store(&self, _key: &[u8; 32], _bytes: &[u8]) {}
    fn is_active(&self) -> bool {
        false
    }
}
