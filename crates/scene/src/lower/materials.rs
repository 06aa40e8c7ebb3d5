//! Materials by name, built when they are first used with a mesh's texture coordinates.
//!
//! What a blend is made of is built before it, however deep that goes: a chain of blends may be longer than a thread's
//! stack.

mod resources;
mod rounds;

use super::emission::{self, Emission};
use super::light_layers::{Layer, Layers};
use super::media::MediumTable;
use super::names::Names;
use super::textures::TextureTable;
use super::{Context, complex_index};
use crate::codes;
use crate::settings::Settings;
use indigo_decl::Node;
use indigo_diag::{Diagnostic, Sink, Span, Spanned};
use indigo_scatter::materials::{blend, coating};
use indigo_scatter::{Material, MaterialId, MaterialResources, Medium, MediumId};
use indigo_texture::Texture;
use resources::Resources;
use std::collections::{HashMap, HashSet};

/// The uv sets that a surface offers.
#[derive(Clone, Copy)]
pub(super) enum UvSets<'a> {
    /// Sets by name.
    Named(&'a [(String, u32)]),
    /// One set that answers to every name: the natural coordinates of a sphere or a plane.
    Natural,
}

/// A material by its name and, where it has textures, the uv sets of the surface that it is on.
type Key = (String, Option<Vec<(String, u32)>>);

/// All materials and textures in use.
pub(super) struct MaterialTable<'a> {
    names: Names<'a>,
    materials: Vec<Material>,
    /// What each of them is called.
    called: Vec<String>,
    textures: TextureTable,
    media: MediumTable<'a>,
    /// Materials with textures.
    textured: HashMap<Key, MaterialId>,
    /// Materials without textures serve every surface.
    plain: HashMap<String, MaterialId>,
    /// Names that anything in the scene uses.
    asked_for: HashSet<String>,
    black: Option<MaterialId>,
    stand_in: Option<MaterialId>,
    layers: Layers,
    /// What materials emit, as far as that was asked.
    emissions: HashMap<String, Option<Emission<'a>>>,
}

impl<'a> MaterialTable<'a> {
    pub(super) fn new(root: &'a Node, settings: &Settings, sink: &mut Sink) -> Self {
        Self {
            layers: Layers::new(settings, sink),
            emissions: HashMap::new(),
            names: Names::new(root, "material", sink),
            materials: vec![],
            called: vec![],
            textures: TextureTable::default(),
            media: MediumTable::new(root, sink),
            textured: HashMap::new(),
            plain: HashMap::new(),
            asked_for: HashSet::new(),
            black: None,
            stand_in: None,
        }
    }

    /// The number of a material by name on a surface with certain uv sets. What is wrong is reported,
    /// and the number of some material returned all the same.
    pub(super) fn get(&mut self, name: &str, span: Span, uv: UvSets, context: &mut Context) -> MaterialId {
        let name = self.names.meant(name).to_owned();
        if let Some(known) = self.known(&name, uv) {
            return known;
        }
        let named = Spanned::new(name, span);
        for part in self.unknown_parts(&named, uv, context.sink) {
            self.build(&part, span, uv, context);
        }
        self.build(&named, span, uv, context)
    }

    /// The number of a material that was built before.
    fn known(&self, name: &str, uv: UvSets) -> Option<MaterialId> {
        self.plain.get(name).or_else(|| self.textured.get(&key(name, uv))).copied()
    }

    /// Builds a material of parts that are known, for who uses it.
    fn build(&mut self, name: &Spanned<String>, user: Span, uv: UvSets, context: &mut Context) -> MaterialId {
        self.asked_for.insert(name.value.clone());
        let node = self.names.find(&name.value, name.span, context.sink);
        // Without a kind it is incomplete, or of one that grey stands in for; either was reported.
        let Some(kind) = node.and_then(Node::alternative) else {
            // Reported as what it is, not as unread.
            node.into_iter().for_each(Node::disregard);
            return self.add_grey(&name.value);
        };
        // What it emits is the lamps' business.
        emission::disregard(kind);
        let (id, uses_textures) = if let Some(other) = self.stand_in_of(kind) {
            report_stand_in(kind, &other, context.sink);
            let id = self.get(&other.value, other.span, uv, context);
            (id, !self.plain.contains_key(self.names.meant(&other.value)))
        } else {
            report_stand_in_of_kind(kind, context.sink);
            let mut resources = Resources { table: self, context, uv, user, uses_textures: false };
            let material = Material::build(kind, &mut resources);
            let uses_textures = resources.uses_textures;
            let called = node.map_or_else(String::new, |node| node.text("name").value);
            (self.add(material, &called), uses_textures)
        };
        if uses_textures {
            self.textured.insert(key(&name.value, uv), id);
        } else {
            self.plain.insert(name.value.clone(), id);
        }
        id
    }

    /// The material that stands in for a kind which is not rendered as it is meant: of a coat over what it is not rendered over
    /// what is below.
    fn stand_in_of(&self, kind: &Node) -> Option<Spanned<String>> {
        if kind.block.name != "coating" {
            return stand_in(kind);
        }
        let below = kind.opt_text("substrate_material_name")?;
        let is_rendered =
            self.kind_of(&below.value).is_none_or(|below| coating::is_rendered_over(kind, below));
        if is_rendered {
            return None;
        }
        kind.disregard();
        Some(below)
    }

    /// What takes the place of a material that cannot be built.
    fn add_grey(&mut self, name: &str) -> MaterialId {
        let grey = self.add(Material::grey(), name);
        self.plain.insert(name.to_owned(), grey);
        grey
    }

    /// What a material emits, or what stands in for it; `None` where it emits nothing.
    pub(super) fn emission(&mut self, name: &str, sink: &mut Sink) -> Option<&Emission<'a>> {
        let name = self.names.meant(name).to_owned();
        if !self.emissions.contains_key(&name) {
            let emission = self.find_emission(&name, sink);
            self.emissions.insert(name.clone(), emission);
        }
        self.emissions.get(&name)?.as_ref()
    }

    /// The layer of a number.
    pub(super) fn layer(&self, number: i64) -> Layer {
        self.layers.of(number)
    }

    /// All layers.
    pub(super) fn layers(&self) -> &Layers {
        &self.layers
    }

    fn find_emission(&self, name: &str, sink: &mut Sink) -> Option<Emission<'a>> {
        match self.shining(name, sink)? {
            Shining::Alone(emission) => Some(emission),
            Shining::Blend(blend) => self.blended_emission(blend, sink),
        }
    }

    /// What a material emits itself, or else the one that stands in for it or is below it; or the blend that it is.
    fn shining(&self, name: &str, sink: &mut Sink) -> Option<Shining<'a>> {
        let mut kind = self.names.get(name)?.alternative()?;
        let mut seen = HashSet::new();
        loop {
            let own = Emission::of(kind, &self.layers, sink);
            let part = shining_part(kind);
            if let Some(own) = own {
                if let Some(below) = &part {
                    self.report_hidden_emission(below, sink);
                }
                return Some(Shining::Alone(own));
            }
            if kind.block.name == "blend" {
                return Some(Shining::Blend(kind));
            }
            let part = part?;
            // Materials that lead back to themselves are reported elsewhere.
            if !seen.insert(self.names.meant(&part.value).to_owned()) {
                return None;
            }
            kind = self.names.get(&part.value)?.alternative()?;
        }
    }

    /// What a blend emits: of each material in it as much as its share. `None` where that is no spectrum, times a map at most:
    /// where shares are of maps, where several maps or layers meet, and in trees of very many blends.
    fn blended_emission(&self, blend: &Node, sink: &mut Sink) -> Option<Emission<'a>> {
        let mut sum: Option<Emission> = None;
        let mut blends = vec![(blend, 1.0)];
        for _ in 0..MOST_BLENDS {
            let Some((blend, weight)) = blends.pop() else { return sum };
            let share = blend::constant_share(blend)?;
            for (field, share) in [("a_name", 1.0 - share), ("b_name", share)] {
                if share == 0.0 {
                    continue;
                }
                match self.shining(&blend.opt_text(field)?.value, sink) {
                    Some(Shining::Blend(inner)) => blends.push((inner, weight * share)),
                    Some(Shining::Alone(part)) => sum = Some(part.dimmed(weight * share).plus(sum)?),
                    None => {}
                }
            }
        }
        None
    }

    /// Whether a blend shines with the light of what is in it.
    fn is_shining_blend(&self, kind: &Node) -> bool {
        kind.block.name == "blend" && self.blended_emission(kind, &mut Sink::new()).is_some()
    }

    /// Tells of light from below something that shines by itself.
    fn report_hidden_emission(&self, below: &Spanned<String>, sink: &mut Sink) {
        // What is wrong with it is told with the material.
        let emission = |kind| Emission::of(kind, &self.layers, &mut Sink::new());
        if self.kind_of(&below.value).and_then(emission).is_some() {
            let message = format!("{} gives no light: the coat over it shines by itself", below.value);
            sink.push(Diagnostic::warning(codes::NOT_EMITTING, below.span, message));
        }
    }

    /// The kind of a material by name, whether anything is made of it or not; nothing is reported.
    pub(super) fn kind_of(&self, name: &str) -> Option<&'a Node> {
        self.names.get(name)?.alternative()
    }

    /// Whether two references mean one material.
    pub(super) fn is_same(&self, a: &str, b: &str) -> bool {
        self.names.meant(a) == self.names.meant(b)
    }

    fn add(&mut self, material: Material, name: &str) -> MaterialId {
        self.materials.push(material);
        self.called.push(name.to_owned());
        (self.materials.len() - 1) as MaterialId
    }

    /// Reports a name that no material has.
    pub(super) fn check_name(&mut self, name: &str, span: Span, sink: &mut Sink) {
        self.names.find(name, span, sink);
    }

    /// Reports a name that no medium has.
    pub(super) fn check_medium(&mut self, name: &str, span: Span, sink: &mut Sink) {
        self.media.check_name(name, span, sink);
    }

    /// Whether light passes the surface of a material into a medium inside, other than what is outside anyway.
    pub(super) fn bounds_medium(&self, id: MaterialId) -> bool {
        let material = &self.materials[id as usize];
        material.may_transmit() && material.internal_medium().is_some_and(|medium| medium != MediumId::AIR)
    }

    /// The image map of a lamp whose mesh has certain uv sets; what is wrong is reported.
    pub(super) fn lamp_texture(
        &mut self,
        node: &Node,
        user: Span,
        uv: UvSets,
        context: &mut Context,
    ) -> Texture {
        let mut resources = Resources { table: self, context, uv, user, uses_textures: false };
        let id = resources.texture(node);
        self.textures.texture(id).clone()
    }

    /// A surface that scatters nothing.
    pub(super) fn black(&mut self) -> MaterialId {
        if let Some(id) = self.black {
            return id;
        }
        let id = self.add(Material::black(), "black");
        self.black = Some(id);
        id
    }

    /// The surface of what stands in for things that are missing.
    pub(super) fn stand_in(&mut self) -> MaterialId {
        if let Some(id) = self.stand_in {
            return id;
        }
        let id = self.add(Material::magenta(), "stand-in");
        self.stand_in = Some(id);
        id
    }

    /// Materials that nothing is made of, and media that none of them names, have no effect, whatever
    /// they hold.
    pub(super) fn disregard_unused(&self) {
        let unused = self.names.entries().filter(|(key, _)| !self.asked_for.contains(*key));
        unused.for_each(|(_, node)| node.disregard());
        self.media.disregard_unused();
    }

    /// The names of materials in the order of their numbers.
    pub(super) fn take_names(&mut self) -> Vec<String> {
        std::mem::take(&mut self.called)
    }

    /// Materials, textures and media in the order of their numbers.
    pub(super) fn into_arenas(self) -> (Vec<Material>, Vec<Texture>, Vec<Medium>) {
        let (mut materials, media) = (self.materials, self.media.into_arena());
        for material in &mut materials {
            material.immerse(&media);
        }
        (materials, self.textures.into_arena(), media)
    }
}

/// What a material with textures is known by.
fn key(name: &str, uv: UvSets) -> Key {
    let sets = match uv {
        UvSets::Named(sets) => Some(sets.to_vec()),
        UvSets::Natural => None,
    };
    (name.to_owned(), sets)
}

/// Whose light a material has.
enum Shining<'a> {
    /// That of one material.
    Alone(Emission<'a>),
    /// That of what is in a blend.
    Blend(&'a Node),
}

/// The most blends of a tree whose light is added up.
const MOST_BLENDS: usize = 256;

/// The material whose emission is that of a kind which has none of its own.
fn shining_part(kind: &Node) -> Option<Spanned<String>> {
    match kind.block.name {
        "coating" => kind.opt_text("substrate_material_name"),
        _ => stand_in(kind),
    }
}

/// The material that stands in for a kind which is not rendered as it is meant.
fn stand_in(kind: &Node) -> Option<Spanned<String>> {
    match kind.block.name {
        "sum" => {
            let mut parts = kind.nodes("mat");
            let first = parts.next();
            first.into_iter().chain(parts).for_each(Node::disregard);
            first.and_then(|mat| mat.opt_text("mat_name"))
        }
        _ => None,
    }
}

fn report_stand_in(kind: &Node, other: &Spanned<String>, sink: &mut Sink) {
    sink.push_or_count(Diagnostic::warning(
        codes::STANDS_IN,
        kind.span,
        if kind.block.name == "coating" {
            format!(
                "a <coating> (of version 3.0) is rendered over <diffuse>, and with <interference> over a <phong> of <nk_data>: {} stands in without its coat",
                other.value
            )
        } else {
            format!(
                "<{}> is of a later format version (4.0) and not rendered: {} stands in",
                kind.block.name, other.value
            )
        },
    ));
}

fn report_stand_in_of_kind(kind: &Node, sink: &mut Sink) {
    if kind.block.name == "fast_sss" && !kind.has("internal_medium_name") {
        let message = "<fast_sss> is of a later format version (4.0) and not rendered: <phong> stands in";
        sink.push_or_count(Diagnostic::warning(codes::STANDS_IN, kind.span, message));
    }
    if kind.block.name == "sunsky" {
        let message =
            "<sunsky> (of version 3.0) is rendered as a background alone: on a surface black stands in";
        sink.push_or_count(Diagnostic::warning(codes::STANDS_IN, kind.span, message));
    }
}
