//! Which scene it is: a hash of all that the film depends on, so that a film is never gone on with, or added
//! to, for another scene.
//!
//! Left out is what decides how long, how and with what name to render (`renderer_settings`, whose deciding
//! values are compared by name), and what decides only how the film is developed. Places and paths do not
//! count: the same scene on another machine is the same scene. Where an element names a file, the file's content counts
//! in the place of its path, so that two files whose contents change places make another scene.

use indigo_decl::{Element, EmbeddedMesh, ResolveError, Resolved, Resolver};
use indigo_diag::{SourceMap, Span};
use std::collections::{BTreeMap, HashSet};
use std::sync::{Mutex, PoisonError};

/// Elements without influence on the film.
const DEVELOPMENT: &[&str] = &[
    "renderer_settings",
    "tonemapping",
    "white_balance",
    "white_point",
    "exposure_duration",
    "bloom",
    "metadata",
];

/// Hands files on and keeps the hashes of their contents.
pub(crate) struct Witness<'a> {
    inner: &'a dyn Resolver,
    /// By the path as it was written, and the file that it was written in.
    seen: Mutex<BTreeMap<(String, String), [u8; 32]>>,
}

impl<'a> Witness<'a> {
    pub fn new(inner: &'a dyn Resolver) -> Self {
        Self { inner, seen: Mutex::default() }
    }

    /// The hash of a scene and of the files that have been read for it. `paths` are the places of all paths: a file
    /// that was not read, since nothing uses what names it, has no influence on the film.
    pub fn identity(&self, outline: &Outline, paths: &HashSet<Span>, sources: &SourceMap) -> [u8; 32] {
        let seen = self.seen.lock().unwrap_or_else(PoisonError::into_inner);
        let mut hasher = blake3::Hasher::new();
        hasher.update(&outline.shape);
        for (span, text) in &outline.texts {
            // A name that happens to be a path as well is but a name.
            if !paths.contains(span) {
                hasher.update(&[0]);
                hash_text(&mut hasher, text);
            } else if let Some(content) = seen.get(&(text.to_string(), sources.name(span.source).to_owned()))
            {
                hasher.update(&[1]).update(content);
            } else {
                hasher.update(&[2]);
            }
        }
        *hasher.finalize().as_bytes()
    }
}

impl Resolver for Witness<'_> {
    fn read(&self, path: &str, from: &str) -> Result<Resolved, ResolveError> {
        let found = self.inner.read(path, from)?;
        let hash = *blake3::hash(&found.bytes).as_bytes();
        let mut seen = self.seen.lock().unwrap_or_else(PoisonError::into_inner);
        seen.insert((path.to_owned(), from.to_owned()), hash);
        Ok(found)
    }

    fn has(&self, path: &str, from: &str) -> bool {
        self.inner.has(path, from)
    }
}

/// What a scene's elements say, before it is known which of their texts are paths.
pub(crate) struct Outline {
    /// The hash of all but the texts.
    shape: [u8; 32],
    /// The texts in order, each with its place.
    texts: Vec<(Span, Box<str>)>,
}

impl Outline {
    pub fn new(root: &Element) -> Self {
        let (mut hasher, mut texts) = (blake3::Hasher::new(), vec![]);
        outline_element(&mut hasher, &mut texts, root);
        Self { shape: *hasher.finalize().as_bytes(), texts }
    }
}

fn outline_element(hasher: &mut blake3::Hasher, texts: &mut Vec<(Span, Box<str>)>, element: &Element) {
    hash_text(hasher, &element.name);
    let text = &element.text;
    hash_count(hasher, usize::from(!text.value.is_empty()));
    if !text.value.is_empty() {
        texts.push((text.span, text.value.clone()));
    }
    hash_count(hasher, element.attributes.len());
    for attribute in &element.attributes {
        hash_text(hasher, &attribute.name.value);
        hash_text(hasher, &attribute.value.value);
    }
    if let Some(mesh) = &element.mesh {
        hash_mesh(hasher, mesh);
    }
    let children = element.children.iter().filter(|c| !DEVELOPMENT.contains(&&*c.name));
    hash_count(hasher, children.clone().count());
    children.for_each(|child| outline_element(hasher, texts, child));
}

fn hash_mesh(hasher: &mut blake3::Hasher, mesh: &EmbeddedMesh) {
    let data = &mesh.data;
    hash_words(hasher, data.positions.as_flattened().iter().map(|v| v.to_bits()));
    hash_words(hasher, data.normals.as_flattened().iter().map(|v| v.to_bits()));
    hash_count(hasher, data.uv_sets.len());
    for set in &data.uv_sets {
        hash_words(hasher, set.as_flattened().iter().map(|v| v.to_bits()));
    }
    for (name, set) in &data.uv_names {
        hash_text(hasher, name);
        hash_count(hasher, *set as usize);
    }
    hash_words(hasher, data.triangles.as_flattened().iter().copied());
    hash_words(hasher, data.triangle_materials.iter().copied());
    data.material_names.iter().for_each(|name| hash_text(hasher, name));
}

/// Words behind their number, in pieces that fit the processor's cache.
fn hash_words(hasher: &mut blake3::Hasher, words: impl ExactSizeIterator<Item = u32>) {
    const PIECE: usize = 16 << 10;
    hash_count(hasher, words.len());
    let mut bytes = Vec::with_capacity(PIECE);
    for word in words {
        bytes.extend(word.to_le_bytes());
        if bytes.len() >= PIECE {
            hasher.update(&bytes);
            bytes.clear();
        }
    }
    hasher.update(&bytes);
}

fn hash_text(hasher: &mut blake3::Hasher, text: &str) {
    hash_count(hasher, text.len());
    hasher.update(text.as_bytes());
}

fn hash_count(hasher: &mut blake3::Hasher, n: usize) {
    hasher.update(&(n as u64).to_le_bytes());
}
