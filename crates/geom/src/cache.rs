//! Built trees as bytes.

use crate::build::{Builder, build_triangles};
use crate::soup::Soup;
use crate::store::TreeStore;
use crate::wide::WideTree;

/// A tree over the triangles, how many were left out, and whether it came from the store.
pub(crate) fn load_or_build(soup: &Soup, builder: Builder, store: &dyn TreeStore) -> (WideTree, usize, bool) {
    let _ = store;
    let (tree, skipped) = build_triangles(soup, builder);
    (tree, skipped, false)
}
