//! Materials by name, built when they are first used with a mesh's texture coordinates.

use super::Context;
use super::media::MediumTable;
use super::names::Names;
use crate::codes;
use indigo_decl::Node;
use indigo_diag::{Diagnostic, Sink, Span};
use indigo_formats::image;
use indigo_scatter::{Material, MaterialResources, Medium, MediumId};
use indigo_texture::{Curve, Texture, TextureId};
use std::collections::{HashMap, HashSet};

/// The uv sets that a surface offers.
#[derive(Clone, Copy)]
pub(super) enum UvSets<'a> {
    /// Sets by name.
    Named(&'a [(String, u32)]),
    /// One set that answers to every name: the natural coordinates of a sphere or a plane.
    Natural,
}

/// All materials and textures in use.
pub(super) struct MaterialTable<'a> {
    names: Names<'a>,
    materials: Vec<Material>,
    textures: TextureTable,
    media: MediumTable<'a>,
    /// Materials built, by name and by the uv sets that their textures found.
    built: HashMap<(String, Vec<u32>), u32>,
    /// Names that anything in the scene uses.
    asked_for: HashSet<String>,
    /// Materials without textures serve every mesh.
    plain: HashMap<String, Option<u32>>,
    black: Option<u32>,
}

impl<'a> MaterialTable<'a> {
    pub(super) fn new(root: &'a Node, sink: &mut Sink) -> Self {
        Self {
            names: Names::new(root, "material", sink),
            materials: vec![],
            textures: TextureTable::default(),
            media: MediumTable::new(root, sink),
            built: HashMap::new(),
            asked_for: HashSet::new(),
            plain: HashMap::new(),
            black: None,
        }
    }

    /// The number of a material by name on a surface with certain uv sets. What is wrong is reported,
    /// and the number of some material returned all the same.
    pub(super) fn get(&mut self, name: &str, span: Span, uv: UvSets, context: &mut Context) -> u32 {
        if let Some(known) = self.plain.get(name) {
            return known.unwrap_or_else(|| self.black());
        }
        self.asked_for.insert(name.to_owned());
        let built = self
            .names
            .find(name, span, context.sink)
            .and_then(|node| self.build(name, node, span, uv, context));
        built.unwrap_or_else(|| {
            self.plain.insert(name.to_owned(), None);
            self.black()
        })
    }

    /// Reports a name that no material has.
    pub(super) fn check_name(&mut self, name: &str, span: Span, sink: &mut Sink) {
        self.names.find(name, span, sink);
    }

    /// Reports a name that no medium has.
    pub(super) fn check_medium(&mut self, name: &str, span: Span, sink: &mut Sink) {
        self.media.check_name(name, span, sink);
    }

    /// The image map of a lamp whose mesh has certain uv sets; what is wrong is reported.
    pub(super) fn lamp_texture(
        &mut self,
        node: &Node,
        user: Span,
        uv: UvSets,
        context: &mut Context,
    ) -> Texture {
        let mut resources = Resources {
            textures: &mut self.textures,
            media: &mut self.media,
            context,
            uv,
            user,
            sets: vec![],
            uses_textures: false,
        };
        let id = resources.texture(node);
        self.textures.textures[id as usize].clone()
    }

    /// A surface that scatters nothing.
    pub(super) fn black(&mut self) -> u32 {
        if let Some(id) = self.black {
            return id;
        }
        self.materials.push(Material::black());
        let id = (self.materials.len() - 1) as u32;
        self.black = Some(id);
        id
    }

    fn build(
        &mut self,
        name: &str,
        node: &Node,
        user: Span,
        uv: UvSets,
        context: &mut Context,
    ) -> Option<u32> {
        let kind = node.alternative()?;
        let mut resources = Resources {
            textures: &mut self.textures,
            media: &mut self.media,
            context,
            uv,
            user,
            sets: vec![],
            uses_textures: false,
        };
        let material = Material::build(kind, &mut resources)?;
        let (sets, uses_textures) = (resources.sets, resources.uses_textures);
        if uses_textures && let Some(&id) = self.built.get(&(name.to_owned(), sets.clone())) {
            return Some(id);
        }
        self.materials.push(material);
        let id = (self.materials.len() - 1) as u32;
        if uses_textures {
            self.built.insert((name.to_owned(), sets), id);
        } else {
            self.plain.insert(name.to_owned(), Some(id));
        }
        Some(id)
    }

    /// Materials that nothing is made of, and media that none of them names, have no effect, whatever
    /// they hold.
    pub(super) fn disregard_unused(&self) {
        let asked_for = |n: &&Node| self.asked_for.contains(&n.text("name").value);
        self.names.nodes().filter(|n| !asked_for(n)).for_each(Node::disregard);
        self.media.disregard_unused();
    }

    /// Materials, textures and media in the order of their numbers.
    pub(super) fn into_arenas(self) -> (Vec<Material>, Vec<Texture>, Vec<Medium>) {
        (self.materials, self.textures.textures, self.media.into_arena())
    }
}

/// Textures loaded so far, each image and curve once.
#[derive(Default)]
struct TextureTable {
    textures: Vec<Texture>,
    by_content: HashMap<(String, [u64; 4]), TextureId>,
    by_use: HashMap<(TextureId, u32), TextureId>,
}

/// What building a material may ask for.
struct Resources<'t, 'm, 'c, 'd, 'u> {
    textures: &'t mut TextureTable,
    media: &'t mut MediumTable<'m>,
    context: &'c mut Context<'d>,
    uv: UvSets<'u>,
    /// Who uses the material, for errors about missing uv sets.
    user: Span,
    /// The uv sets found, in order.
    sets: Vec<u32>,
    uses_textures: bool,
}

impl MaterialResources for Resources<'_, '_, '_, '_, '_> {
    fn texture(&mut self, node: &Node) -> TextureId {
        self.uses_textures = true;
        let set = self.uv_set(node);
        self.sets.push(set);
        let path = node.text("path");
        let curve = Curve {
            exponent: node.real("exponent"),
            a: node.real("a"),
            b: node.real("b"),
            c: node.real("c"),
        };
        let first = self.textures.load(&path.value, path.span, curve, self.context);
        self.textures.on_set(first, set)
    }

    fn medium(&mut self, node: &Node, field: &str) -> MediumId {
        let name = node.text(field);
        self.media.get(&name.value, name.span, self.context.sink)
    }

    fn sink(&mut self) -> &mut Sink {
        self.context.sink
    }
}

impl Resources<'_, '_, '_, '_, '_> {
    fn uv_set(&mut self, node: &Node) -> u32 {
        let name = node.text("uv_set");
        let UvSets::Named(sets) = self.uv else { return 0 };
        if let Some((_, set)) = sets.iter().find(|(n, _)| *n == name.value) {
            return *set;
        }
        let names: Vec<&str> = sets.iter().map(|(n, _)| n.as_str()).collect();
        let offers =
            if names.is_empty() { "no uv set".to_owned() } else { format!("only {}", names.join(", ")) };
        self.context.sink.push(
            Diagnostic::error(
                codes::NO_UV_SET,
                name.span,
                format!("a mesh of this material has no uv set {}", name.value),
            )
            .expected(format!("the mesh exposes {offers}"))
            .note(format!("the mesh is used at {}", self.context.place(self.user))),
        );
        0
    }
}

impl TextureTable {
    fn load(&mut self, path: &str, span: Span, curve: Curve, context: &mut Context) -> TextureId {
        let found = context.read(path, span);
        let file = found.as_ref().map_or_else(|| path.to_owned(), |f| f.path.clone());
        let key = (file, [curve.exponent, curve.a, curve.b, curve.c].map(f64::to_bits));
        if let Some(&id) = self.by_content.get(&key) {
            return id;
        }
        let bytes = found.as_ref().map_or_else(super::nothing, |f| f.bytes.clone());
        let image = match image::decode(&key.0, &bytes) {
            Ok(image) => image,
            Err(error) => {
                if found.is_some() {
                    context.sink.push(
                        Diagnostic::error(codes::BAD_FILE, span, format!("{}: bad picture file", key.0))
                            .expected(format!("expected {}, found {}", error.expected, error.found)),
                    );
                }
                // One grey texel stands in.
                image::Image { width: 1, height: 1, channels: 1, pixels: image::Pixels::U8(vec![128]) }
            }
        };
        self.textures.push(Texture::new(image, curve, 0));
        let id = (self.textures.len() - 1) as TextureId;
        self.by_content.insert(key, id);
        self.by_use.insert((id, 0), id);
        id
    }

    /// The same texture laid on by another uv set.
    fn on_set(&mut self, first: TextureId, set: u32) -> TextureId {
        if let Some(&id) = self.by_use.get(&(first, set)) {
            return id;
        }
        self.textures.push(self.textures[first as usize].with_uv_set(set));
        let id = (self.textures.len() - 1) as TextureId;
        self.by_use.insert((first, set), id);
        id
    }
}
