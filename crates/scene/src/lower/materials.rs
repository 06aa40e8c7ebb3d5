//! Materials by name, built when they are first used with a mesh's texture coordinates.

use super::Context;
use super::complex_index;
use super::emission::{self, Emission, Layers};
use super::media::MediumTable;
use super::names::Names;
use super::textures::TextureTable;
use crate::codes;
use crate::settings::Settings;
use indigo_decl::{Kind, Node};
use indigo_diag::{Diagnostic, Sink, Span, Spanned};
use indigo_scatter::materials::blend;
use indigo_scatter::{Material, MaterialId, MaterialResources, Medium, MediumId};
use indigo_spectrum::Spectrum;
use indigo_texture::{Texture, TextureId};
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
    /// Blends whose constituents are being built, from the outermost in.
    open: Vec<String>,
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
            open: vec![],
            black: None,
            stand_in: None,
        }
    }

    /// The number of a material by name on a surface with certain uv sets. What is wrong is reported,
    /// and the number of some material returned all the same.
    pub(super) fn get(&mut self, name: &str, span: Span, uv: UvSets, context: &mut Context) -> MaterialId {
        let name = &*self.names.meant(name).to_owned();
        if let Some(&known) = self.plain.get(name) {
            return known;
        }
        let sets = match uv {
            UvSets::Named(sets) => Some(sets.to_vec()),
            UvSets::Natural => None,
        };
        let key = (name.to_owned(), sets);
        if let Some(&known) = self.textured.get(&key) {
            return known;
        }
        self.asked_for.insert(name.to_owned());
        let node = self.names.find(name, span, context.sink);
        let may_open = self.may_open(name, span, context.sink);
        // Without a kind it is incomplete, or of one that grey stands in for; either was reported.
        let Some(kind) = node.and_then(Node::alternative).filter(|_| may_open) else {
            // Reported as what it is, not as unread.
            node.into_iter().for_each(Node::disregard);
            let grey = self.add(Material::grey(), name);
            self.plain.insert(name.to_owned(), grey);
            return grey;
        };
        self.open.push(name.to_owned());
        // What it emits is the lamps' business.
        emission::disregard(kind);
        let (id, uses_textures) = if let Some(other) = stand_in(kind) {
            report_stand_in(kind, &other, context.sink);
            let id = self.get(&other.value, other.span, uv, context);
            (id, !self.plain.contains_key(self.names.meant(&other.value)))
        } else {
            report_stand_in_of_kind(kind, context.sink);
            let mut resources = Resources { table: self, context, uv, user: span, uses_textures: false };
            let material = Material::build(kind, &mut resources);
            let uses_textures = resources.uses_textures;
            (self.add(material, name), uses_textures)
        };
        self.open.pop();
        if uses_textures {
            self.textured.insert(key, id);
        } else {
            self.plain.insert(key.0, id);
        }
        id
    }

    /// What a material emits, or what stands in for it; `None` where it emits nothing.
    pub(super) fn emission(&mut self, name: &str, sink: &mut Sink) -> Option<&Emission<'a>> {
        let name = self.names.meant(name).to_owned();
        if !self.emissions.contains_key(&name) {
            let kind = self.kind_that_counts(&name);
            let emission = kind.and_then(|kind| Emission::of(kind, &self.layers, sink));
            self.emissions.insert(name.clone(), emission);
        }
        self.emissions.get(&name)?.as_ref()
    }

    /// What the layer of a kind of material multiplies its light by; that of layer 0 where the kind names none.
    pub(super) fn layer_factor(&self, kind: &Node) -> Option<Spectrum> {
        self.layers.factor(if kind.block.declares("layer") { kind.int("layer") } else { 0 })
    }

    /// The kind of a material, or of the one that stands in for it.
    fn kind_that_counts(&self, name: &str) -> Option<&'a Node> {
        let mut kind = self.names.get(name)?.alternative()?;
        // Materials that lead back to themselves are reported elsewhere.
        for _ in 0..blend::MAX_DEPTH {
            let Some(other) = stand_in(kind) else { break };
            kind = self.names.get(&other.value)?.alternative()?;
        }
        Some(kind)
    }

    /// The kind of a material by name, whether anything is made of it or not; nothing is reported.
    pub(super) fn kind_of(&self, name: &str) -> Option<&'a Node> {
        self.names.get(name)?.alternative()
    }

    /// Whether two references mean one material.
    pub(super) fn is_same(&self, a: &str, b: &str) -> bool {
        self.names.meant(a) == self.names.meant(b)
    }

    /// Whether a material may be begun: not within itself, nor too deep in others.
    fn may_open(&self, name: &str, span: Span, sink: &mut Sink) -> bool {
        if let Some(first) = self.open.iter().position(|open| open == name) {
            sink.push(made_of_itself(name, span, self.open[first..].iter()));
            return false;
        }
        if self.open.len() >= blend::MAX_DEPTH as usize {
            sink.push(Diagnostic::error(
                codes::BLEND_CYCLE,
                span,
                format!("blends are nested more than {} deep", blend::MAX_DEPTH),
            ));
            return false;
        }
        true
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

    /// Reports materials that nothing uses and that are made of themselves. Those in use were found when built.
    pub(super) fn check_unused(&self, sink: &mut Sink) {
        let mut done: HashSet<String> = self.asked_for.clone();
        let mut nodes: Vec<&Node> = self.names.nodes().collect();
        nodes.sort_by_key(|n| (n.span.source, n.span.start));
        for node in nodes {
            self.check_round(&node.text("name").value, &mut done, sink);
        }
    }

    /// Walks down what a material is made of, each material once, and reports the names that lead back up.
    fn check_round(&self, first: &str, done: &mut HashSet<String>, sink: &mut Sink) {
        // The materials above, and what is left to be looked at of each. A list of our own: a chain of blends can
        // be longer than the thread's stack.
        let mut open: Vec<(String, Vec<Spanned<String>>)> = vec![];
        let mut above: HashSet<String> = HashSet::new();
        let mut next = Some(first.to_owned());
        loop {
            if let Some(name) = next.take()
                && done.insert(name.clone())
            {
                let mut parts = self.names.get(&name).map(constituents).unwrap_or_default();
                for part in &mut parts {
                    part.value = self.names.meant(&part.value).to_owned();
                }
                above.insert(name.clone());
                open.push((name, parts));
            }
            let Some((name, parts)) = open.last_mut() else { return };
            match parts.pop() {
                None => {
                    above.remove(name.as_str());
                    open.pop();
                }
                Some(part) if above.contains(&part.value) => {
                    let round = open.iter().map(|(name, _)| name).skip_while(|name| **name != part.value);
                    sink.push(made_of_itself(&part.value, part.span, round));
                }
                Some(part) => next = Some(part.value),
            }
        }
    }

    /// Materials that nothing is made of, and media that none of them names, have no effect, whatever
    /// they hold.
    pub(super) fn disregard_unused(&self) {
        let asked_for = |n: &&Node| self.asked_for.contains(&n.text("name").value);
        self.names.nodes().filter(|n| !asked_for(n)).for_each(Node::disregard);
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

/// What building a material may ask for.
struct Resources<'t, 'a, 'c, 'd, 'u> {
    table: &'t mut MaterialTable<'a>,
    context: &'c mut Context<'d>,
    uv: UvSets<'u>,
    /// Who uses the material, for errors about missing uv sets.
    user: Span,
    uses_textures: bool,
}

impl MaterialResources for Resources<'_, '_, '_, '_, '_> {
    fn texture(&mut self, node: &Node) -> TextureId {
        self.uses_textures = true;
        let set = self.uv_set(node);
        self.table.textures.get(node, set, self.context)
    }

    fn exponents(&mut self, node: &Node) -> TextureId {
        let id = self.texture(node);
        let below = self.table.textures.texture(id).share_not_above(0.0);
        let found = format!("{}: exponents have to be above 0", node.text("path").value);
        if below == 1.0 {
            let what = "expected texels above 0 by the map's a, b and c, found none";
            self.context.sink.push_or_count(
                Diagnostic::error(indigo_decl::codes::OUT_OF_RANGE, node.span, found).expected(what),
            );
        } else if below > 0.0 {
            let share = (100.0 * below).max(0.1);
            let message =
                format!("{found}: {share:.1} % of the texels are not, and count as 0, the widest highlight");
            self.context.sink.push_or_count(Diagnostic::warning(codes::NO_EXPONENT, node.span, message));
        }
        id
    }

    fn complex_index(&mut self, node: &Node, field: &str) -> [Spectrum; 2] {
        let path = node.text(field);
        complex_index::read(&path.value, path.span, self.context)
    }

    fn material(&mut self, node: &Node, field: &str) -> MaterialId {
        let name = node.text(field);
        if self.table.emission(&name.value, self.context.sink).is_some() {
            emission::warn_of_darkness("a blend", name.span, self.context);
        }
        let id = self.table.get(&name.value, name.span, self.uv, self.context);
        self.uses_textures |= !self.table.plain.contains_key(self.table.names.meant(&name.value));
        id
    }

    fn built(&self, id: MaterialId) -> &Material {
        &self.table.materials[id as usize]
    }

    fn medium(&mut self, node: &Node, field: &str) -> MediumId {
        let name = node.text(field);
        self.table.media.get(&name.value, name.span, self.context.sink)
    }

    fn sink(&mut self) -> &mut Sink {
        self.context.sink
    }
}

/// The material that stands in for a kind which is not rendered as it is meant.
fn stand_in(kind: &Node) -> Option<Spanned<String>> {
    match kind.block.name {
        "coating" => kind.opt_text("substrate_material_name"),
        "double_sided_thin" => {
            kind.disregard_field("back_material_name");
            kind.opt_text("front_material_name")
        }
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
        format!(
            "<{}> is of a later format version and not rendered: {} stands in",
            kind.block.name, other.value
        ),
    ));
}

fn report_stand_in_of_kind(kind: &Node, sink: &mut Sink) {
    if kind.block.name == "fast_sss" {
        let message = "<fast_sss> is of a later format version (4.0) and not rendered: <phong> stands in";
        sink.push_or_count(Diagnostic::warning(codes::STANDS_IN, kind.span, message));
    }
}

/// The materials that a material is made of.
fn constituents(node: &Node) -> Vec<Spanned<String>> {
    let Some(kind) = node.alternative() else { return vec![] };
    let parts = kind.block.fields.iter().filter(|f| matches!(f.kind, Kind::Reference("material")));
    parts.filter_map(|f| kind.opt_text(f.name)).collect()
}

/// The error of a material that leads back to itself by way of `round`, which begins with it.
fn made_of_itself<'n>(name: &str, span: Span, round: impl Iterator<Item = &'n String>) -> Diagnostic {
    let mut round: Vec<&str> = round.map(String::as_str).collect();
    round.push(name);
    let message = format!("material {name} is made of itself: {}", round.join(", then "));
    Diagnostic::error(codes::BLEND_CYCLE, span, message)
        .expected("expected a material that is made of others")
}

impl Resources<'_, '_, '_, '_, '_> {
    fn uv_set(&mut self, node: &Node) -> u32 {
        let (name, index) = (node.text("uv_set"), node.opt_int("uv_set_index"));
        let UvSets::Named(sets) = self.uv else { return 0 };
        // A number counts before a name; without either it is the set that is called `default`, or else the first.
        let found = match index {
            Some(index) => sets.iter().find(|(_, set)| i64::from(*set) == index.value),
            None => sets.iter().find(|(n, _)| *n == name.value),
        };
        let first = sets.iter().find(|(_, set)| *set == 0);
        let is_free = index.is_none() && !node.has("uv_set");
        if let Some((_, set)) = found.or_else(|| first.filter(|_| is_free)) {
            return *set;
        }
        let name = index.map_or(name, |index| Spanned::new(format!("number {}", index.value), index.span));
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
