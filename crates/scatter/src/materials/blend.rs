//! `blend`: two materials at once.
//!
//! A tree of blends is walked down at each point, by one random `Choice` after another: what is left is a
//! constituent with the probability of its share. A blend is linear in its constituents, so that has the right mean.

mod choice;

use super::{Material, MaterialContext, MaterialId, MaterialResources};
use crate::media::MediumId;
use indigo_decl::{Block, Field, Group, Kind, Node, Parameter, Presence, Range, StandIn, codes};
use indigo_diag::Diagnostic;
use indigo_math::{Float, Real, Vec2};
use indigo_texture::TextureId;
use indigo_texture::declare::TEXTURE;

pub(super) use self::choice::Choice;

/// The declaration of `blend`.
pub static BLOCK: Block = Block::new(
    "blend",
    "Two materials at once, weighted by a number or by an image map. Blends may be made of blends to any depth, \
     but at most one material in the whole tree may be `specular` or `null_material`. Where the shares are numbers, what is in \
     it emits its share.",
    &[
        Field::new(
            "blend_factor",
            Kind::Real,
            Presence::Optional,
            "The share of material b: 0 is material a alone, 1 is material b alone. Needed unless there is a \
             `blend_map`, which takes its place.",
        )
        .range(Range::Within(0.0, 1.0)),
        Field::new("a_name", Kind::Reference("material"), Presence::Required, "Name of material a.")
            .aliases(&["a_uid"]),
        Field::new("b_name", Kind::Reference("material"), Presence::Required, "Name of material b.")
            .aliases(&["b_uid"]),
        Field::new(
            "blend_map",
            Kind::Block(&TEXTURE),
            Presence::Optional,
            "An image map that takes the place of `blend_factor`. Below 0 it counts as 0, and above 1 as 1, with a warning.",
        ),
        Field::new(
            "step_blend",
            Kind::Bool,
            Presence::Default("false"),
            "Whether there is only one or the other material at any point: b where the share is at least 0.5.",
        ),
    ],
)
.with_needs(&[Group::any(&["blend_factor", "blend_map"])])
.with_parameters(&[Parameter {
    name: "blend",
    since: "1.1",
    constant: "blend_factor",
    texture: "blend_map",
    stand_in: StandIn::Text("0.5"),
}])
.with_example(
    "<blend>
    <blend_factor>0.5</blend_factor>
    <a_name>mata</a_name>
    <b_name>matb</b_name>
</blend>",
);

/// How many constituents of a blend may let light pass as if nothing were there, each counted as often as it is part
/// of the tree: every ray that looks through the surface asks all of them.
pub const MAX_UNSEEN: u32 = 1024;

/// Two materials at once.
#[derive(Clone, Debug)]
pub struct Blend {
    share: Share,
    a: MaterialId,
    b: MaterialId,
    facts: Facts,
}

/// The share of material b.
#[derive(Clone, Debug)]
enum Share {
    Constant(Real),
    Map(TextureId),
    /// 1 where the map is at least 0.5, and 0 elsewhere.
    Steps(TextureId),
}

/// What is known of a material as a constituent.
#[derive(Clone, Copy, Debug)]
struct Facts {
    /// Constituents whose scattering is of delta kind.
    deltas: u32,
    /// The one medium inside.
    medium: Option<MediumId>,
    /// Constituents that light may pass as if nothing were there.
    unseen: u32,
    /// Whether one of them is nothing at all, between whatever media.
    holds_nothing: bool,
    may_transmit: bool,
}

impl Facts {
    const NONE: Self = Self { deltas: 0, medium: None, unseen: 0, holds_nothing: false, may_transmit: false };

    fn of(material: &Material) -> Self {
        match material {
            Material::Blend(blend) => blend.facts,
            other => Self {
                deltas: u32::from(matches!(other, Material::Null | Material::Specular(_))),
                medium: other.internal_medium(),
                unseen: other.unseen_constituents(),
                holds_nothing: other.is_invisible(),
                may_transmit: other.may_transmit(),
            },
        }
    }

    /// Of both together; an error where they cannot be.
    fn together(self, other: Self) -> Result<Self, [&'static str; 2]> {
        let facts = Self {
            deltas: self.deltas + other.deltas,
            medium: self.medium.or(other.medium),
            unseen: self.unseen + other.unseen,
            holds_nothing: self.holds_nothing || other.holds_nothing,
            may_transmit: self.may_transmit || other.may_transmit,
        };
        if facts.deltas > 1 {
            return Err([
                "this blend has two materials that are specular or null_material",
                "at most one in all",
            ]);
        }
        if facts.medium != other.medium.or(self.medium) {
            return Err([
                "the materials of this blend have different internal media",
                "one and the same, or none",
            ]);
        }
        if facts.unseen > MAX_UNSEEN {
            return Err([
                "this blend has more than 1024 transparent constituents",
                "fewer in the whole tree",
            ]);
        }
        Ok(facts)
    }
}

/// The share of material b, where it is the same everywhere.
pub fn constant_share(node: &Node) -> Option<f64> {
    if node.has("blend_map") {
        return None;
    }
    let share = node.opt_real("blend_factor").map_or(0.0, |f| f.value);
    Some(if node.bool("step_blend") { step(Real::from_f64(share)).to_f64() } else { share })
}

impl Blend {
    /// From its element.
    pub fn build(node: &Node, resources: &mut dyn MaterialResources) -> Self {
        let is_stepped = node.bool("step_blend");
        let share = if let Some(map) = node.node("blend_map") {
            node.disregard_field("blend_factor");
            // A step is taken wherever its threshold lies.
            let map = if is_stepped { resources.texture(map) } else { resources.shares(map) };
            if is_stepped { Share::Steps(map) } else { Share::Map(map) }
        } else {
            Share::Constant(Real::from_f64(constant_share(node).unwrap_or(0.0)))
        };
        let [a, b] = ["a_name", "b_name"].map(|field| resources.material(node, field));
        let [of_a, of_b] = [a, b].map(|id| Facts::of(resources.built(id)));
        let facts = of_a.together(of_b).unwrap_or_else(|[fault, expected]| {
            resources.sink().push(
                Diagnostic::error(codes::CONTRADICTION, node.span_of("b_name"), fault)
                    .expected(format!("expected {expected}")),
            );
            // Reported once, not again by every blend above.
            Facts::NONE
        });
        Self { share, a, b, facts }
    }

    /// The share of material b at a point, limited to [0, 1].
    #[inline]
    fn share(&self, context: &MaterialContext, uv: &impl Fn(u32) -> Vec2) -> Real {
        match self.share {
            Share::Constant(share) => share,
            Share::Map(id) => {
                let map = &context.textures[id as usize];
                let share = map.scalar(uv(map.uv_set));
                // A texel that is no number counts as 0.
                if share > 0.0 { share.min(1.0) } else { 0.0 }
            }
            Share::Steps(id) => {
                let map = &context.textures[id as usize];
                step(map.scalar(uv(map.uv_set)))
            }
        }
    }

    /// One of the two materials.
    #[inline]
    pub(super) fn choose(
        &self,
        context: &MaterialContext,
        uv: &impl Fn(u32) -> Vec2,
        choice: &mut Choice,
    ) -> MaterialId {
        if choice.is_within(self.share(context, uv)) { self.b } else { self.a }
    }

    /// See [`SurfaceKind::internal_medium`](super::SurfaceKind::internal_medium): that of the constituent that has one.
    #[inline]
    pub(super) fn internal_medium(&self) -> Option<MediumId> {
        self.facts.medium
    }

    /// See [`Material::unseen_constituents`].
    pub(super) fn unseen_constituents(&self) -> u32 {
        self.facts.unseen
    }

    /// See [`SurfaceKind::may_transmit`](super::SurfaceKind::may_transmit).
    pub(super) fn may_transmit(&self) -> bool {
        self.facts.may_transmit
    }

    /// See [`Material::unseen_share`].
    ///
    /// It goes down the way of the most constituents that may be unseen, and calls itself for the other one, so that it
    /// stands in itself at most ten times, the logarithm of [`MAX_UNSEEN`]: a chain may be longer than a thread's stack.
    pub(super) fn unseen_share(&self, context: &MaterialContext, uv: &impl Fn(u32) -> Vec2) -> Real {
        // All but nothing itself are seen between different indices.
        let may_be_unseen = self.facts.holds_nothing || context.interface.is_matched();
        if self.facts.unseen == 0 || !may_be_unseen {
            return 0.0;
        }
        let (mut blend, mut weight, mut sum) = (self, 1.0, 0.0);
        loop {
            let share = blend.share(context, uv);
            let of = |id: MaterialId, share: Real| (&context.materials[id as usize], share);
            let (mut most, mut fewest) = (of(blend.a, 1.0 - share), of(blend.b, share));
            if fewest.0.unseen_constituents() > most.0.unseen_constituents() {
                std::mem::swap(&mut most, &mut fewest);
            }
            if fewest.0.may_be_unseen() {
                sum += weight * fewest.1 * fewest.0.unseen_share(context, uv);
            }
            weight *= most.1;
            match most.0 {
                Material::Blend(below) => blend = below,
                other => return sum + weight * other.unseen_share(context, uv),
            }
        }
    }
}

/// All or nothing of a share.
#[inline]
fn step(share: Real) -> Real {
    if share >= 0.5 { 1.0 } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::materials::{Interface, MaterialContext};
    use indigo_spectrum::SampledWavelengths;

    /// Of evenly spread choices each constituent gets its share, at any depth; what passes unseen is that of nothing.
    #[test]
    fn choices_have_the_shares_of_the_constituents() {
        let blend = |share: Real, a: MaterialId, b: MaterialId, materials: &[Material]| {
            let [of_a, of_b] = [a, b].map(|id| Facts::of(&materials[id as usize]));
            let facts = of_a.together(of_b).expect("a sound blend");
            Material::Blend(Blend { share: Share::Constant(share), a, b, facts })
        };
        let uv = |_| Vec2::new(0.0, 0.0);
        let lambda = SampledWavelengths::sample(0.5);
        for (outer, inner, nothing) in [(0.5, 0.25, 0.125), (0.0, 1.0, 1.0), (1.0, 0.5, 0.0), (0.9, 0.0, 0.0)]
        {
            let mut materials = vec![Material::black(), Material::Null];
            materials.push(blend(inner, 0, 1, &materials));
            materials.push(blend(outer, 2, 0, &materials));
            let at = |choice: Real| MaterialContext {
                textures: &[],
                materials: &materials,
                lambda: &lambda,
                interface: Interface::NONE,
                choice,
                is_front: true,
            };
            let n = 4096;
            let unseen =
                (0..n).filter(|i| materials[3].chosen(&at(*i as Real / n as Real), &uv).is_invisible());
            let share = unseen.count() as Real / n as Real;
            assert!((share - nothing).abs() < 2.0 / n as Real, "{outer}, {inner}: {share}");
            assert!((materials[3].unseen_share(&at(0.0), &uv) - nothing).abs() < 1e-6);
        }
    }

    /// Blends go deeper than a thread's stack. A quarter of the last one is nothing, and half of the first one is the
    /// chain that leads there.
    #[test]
    fn a_chain_has_no_end_that_a_stack_has() {
        let mut materials = vec![Material::black(), Material::Null];
        let mut push = |share: Real, a: MaterialId, b: MaterialId| {
            let [of_a, of_b] = [a, b].map(|id| Facts::of(&materials[id as usize]));
            let facts = of_a.together(of_b).expect("a sound blend");
            materials.push(Material::Blend(Blend { share: Share::Constant(share), a, b, facts }));
            (materials.len() - 1) as MaterialId
        };
        let mut chain = push(0.25, 0, 1);
        for i in 0..100_000 {
            chain = if i % 2 == 0 { push(0.0, chain, 0) } else { push(1.0, 0, chain) };
        }
        chain = push(0.5, 0, chain);
        let uv = |_| Vec2::new(0.0, 0.0);
        let lambda = SampledWavelengths::sample(0.5);
        let at = |choice| MaterialContext {
            textures: &[],
            materials: &materials,
            lambda: &lambda,
            interface: Interface::NONE,
            choice,
            is_front: true,
        };
        let chain = &materials[chain as usize];
        assert_eq!(chain.unseen_share(&at(0.0), &uv), 0.125);
        assert!(chain.chosen(&at(0.1), &uv).is_invisible());
        assert!(!chain.chosen(&at(0.2), &uv).is_invisible());
    }
}
