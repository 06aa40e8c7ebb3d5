//! What a material asks for while it is built.

use super::{Context, MaterialTable, UvSets, complex_index, emission};
use crate::codes;
use crate::lower::textures::Unfit;
use indigo_decl::Node;
use indigo_diag::{Diagnostic, Sink, Span, Spanned};
use indigo_scatter::{Material, MaterialId, MaterialResources, MediumId};
use indigo_spectrum::Spectrum;
use indigo_texture::TextureId;

/// What building a material may ask for.
pub(super) struct Resources<'t, 'a, 'c, 'd, 'u> {
    pub(super) table: &'t mut MaterialTable<'a>,
    pub(super) context: &'c mut Context<'d>,
    pub(super) uv: UvSets<'u>,
    /// Who uses the material, for errors about missing uv sets.
    pub(super) user: Span,
    pub(super) uses_textures: bool,
}

impl MaterialResources for Resources<'_, '_, '_, '_, '_> {
    fn texture(&mut self, node: &Node) -> TextureId {
        self.uses_textures = true;
        let set = self.uv_set(node);
        self.table.textures.get(node, set, self.context)
    }

    fn exponents(&mut self, node: &Node) -> TextureId {
        let id = self.texture(node);
        let below = self.table.textures.share_of(id, Unfit::NotAbove0);
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

    fn fractions(&mut self, node: &Node) -> TextureId {
        let id = self.texture(node);
        let beyond = self.table.textures.share_of(id, Unfit::NoFractions);
        self.warn_of_clamping(beyond, node);
        id
    }

    fn shares(&mut self, node: &Node) -> TextureId {
        let id = self.texture(node);
        let beyond = self.table.textures.share_of(id, Unfit::NoShare);
        self.warn_of_clamping(beyond, node);
        id
    }

    fn complex_index(&mut self, node: &Node, field: &str) -> [Spectrum; 2] {
        let path = node.text(field);
        complex_index::read(&path.value, path.span, self.context)
    }

    fn material(&mut self, node: &Node, field: &str) -> MaterialId {
        let name = node.text(field);
        if self.table.emission(&name.value, self.context.sink).is_some() && !self.table.is_shining_blend(node)
        {
            let what = if node.block.name == "blend" { "a blend" } else { "a sheet" };
            let hint = if node.block.declares("base_emission") {
                "give it a <base_emission> of its own"
            } else {
                "it shines where the shares are numbers, and the light is of one layer and has at most one map"
            };
            emission::warn_of_darkness(what, hint, name.span, self.context);
        }
        self.substrate(node, field)
    }

    fn substrate(&mut self, node: &Node, field: &str) -> MaterialId {
        let name = node.text(field);
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

impl Resources<'_, '_, '_, '_, '_> {
    /// Tells of texels that count as other than they are, where some do.
    fn warn_of_clamping(&mut self, beyond: f64, node: &Node) {
        if beyond == 0.0 {
            return;
        }
        let share = (100.0 * beyond).max(0.1);
        let path = node.text("path").value;
        let message = format!(
            "{path}: {share:.1} % of the texels are below 0 or above 1 by the map's a, b and c, and count as the nearest"
        );
        self.context.sink.push_or_count(Diagnostic::warning(codes::BEYOND_FRACTIONS, node.span, message));
    }

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
        let is_plain = index.as_ref().map_or(is_free, |index| index.value == 0);
        if sets.is_empty() && is_plain {
            // As exporters write objects that were never unwrapped.
            let message = "a mesh of this material has no texture coordinates: it shows one texel, that at (0, 0), all over";
            let place = self.context.place(self.user);
            self.context.sink.push_or_count(
                Diagnostic::warning(codes::NO_COORDINATES, node.span, message)
                    .note(format!("the mesh is used at {place}")),
            );
            return 0;
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
