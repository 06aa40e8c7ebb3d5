//! Materials: one file each, and one line each in the list below.

pub mod blend;
pub mod coating;
mod declare;
pub mod diffuse;
pub mod diffuse_transmitter;
pub mod double_sided_thin;
pub mod fast_sss;
pub mod fields;
pub mod glossy_transparent;
pub mod later;
pub mod null_material;
pub mod oren_nayar;
pub mod phong;
pub mod specular;

pub use self::declare::{MATERIAL, MATERIAL_KIND, MATERIAL_LATER};

use self::fields::BUMP_MAP;
use crate::media::{Medium, MediumId};
use crate::scatter::{Crossing, LocalSample, Scatter};
use indigo_decl::{Block, Node};
use indigo_diag::Sink;
use indigo_math::{Real, Vec2, Vec3};
use indigo_spectrum::{LanePdf, SampledSpectrum, SampledWavelengths, Spectrum};
use indigo_texture::{Texture, TextureId};

/// What the evaluation of a material may look at.
#[derive(Clone, Copy, Debug)]
pub struct MaterialContext<'a> {
    /// All textures of the scene.
    pub textures: &'a [Texture],
    /// All materials of the scene.
    pub materials: &'a [Material],
    /// The wavelengths of the path.
    pub lambda: &'a SampledWavelengths,
    /// What lies on the two sides of the surface.
    pub interface: Interface,
    /// A number in [0, 1) that chooses among the materials of a blend.
    pub choice: Real,
    /// Whether the surface is seen from its front.
    pub is_front: bool,
}

/// The indices of refraction on the two sides of a surface, for each wavelength.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interface {
    /// On the side from which the point was found.
    pub above: SampledSpectrum,
    /// On the other side.
    pub below: SampledSpectrum,
}

impl Interface {
    /// Air, or nothing, on both sides.
    pub const NONE: Self = Self { above: SampledSpectrum::ONE, below: SampledSpectrum::ONE };

    /// The index below over that above.
    #[inline]
    pub fn eta(&self) -> SampledSpectrum {
        self.below / self.above
    }

    /// Whether the indices are equal, so that a smooth surface is not to be seen.
    #[inline]
    pub fn is_matched(&self) -> bool {
        self.above == self.below
    }
}

/// Number of a material in a scene's list.
pub type MaterialId = u32;

/// What the building of a material needs of the scene.
pub trait MaterialResources {
    /// The image map that a texture element asks for; whatever is wrong with it has been reported.
    fn texture(&mut self, node: &Node) -> TextureId;
    /// The image map of exponents, which have to be above 0, that a texture element asks for; whatever is wrong with it has
    /// been reported.
    fn exponents(&mut self, node: &Node) -> TextureId {
        self.texture(node)
    }
    /// The image map of colours from 0 to 1 that a texture element asks for; whatever is wrong with it has been reported.
    fn fractions(&mut self, node: &Node) -> TextureId {
        self.texture(node)
    }
    /// The same of scalars, which are means of the components.
    fn shares(&mut self, node: &Node) -> TextureId {
        self.texture(node)
    }
    /// The complex index of refraction, n and k by wavelength, of the file that a field names; whatever is wrong
    /// with it has been reported.
    fn complex_index(&mut self, node: &Node, field: &str) -> [Spectrum; 2];
    /// The material that a field names; whatever is wrong with it has been reported.
    fn material(&mut self, node: &Node, field: &str) -> MaterialId;
    /// The same of a material below another, which may emit.
    fn substrate(&mut self, node: &Node, field: &str) -> MaterialId {
        self.material(node, field)
    }
    /// A material that was built before.
    fn built(&self, id: MaterialId) -> &Material;
    /// The medium that a field names; whatever is wrong with it has been reported.
    fn medium(&mut self, node: &Node, field: &str) -> MediumId;
    /// Where to report what is wrong.
    fn sink(&mut self) -> &mut Sink;
}

/// What a kind of material says of the surface itself, beside how it scatters. The defaults are those of most.
pub trait SurfaceKind {
    /// The medium that fills the inside of the object, if the material is the interface of one. It is the
    /// same all over the surface and whatever becomes of the light that crosses it.
    fn internal_medium(&self) -> Option<MediumId> {
        None
    }

    /// Makes ready for the media of the scene, of which any may lie outside: called once, when all of them are known.
    fn immerse(&mut self, _media: &[Medium]) {}

    /// Whether light can come out on the other side, scattered or not, where that is another medium. (What divides a
    /// medium from itself is not there.)
    fn may_transmit(&self) -> bool {
        self.internal_medium().is_some()
    }
}

/// A kind of material with what any may have.
#[derive(Clone, Debug)]
pub struct Surface<K> {
    kind: K,
    /// The heights that bend the shading normal.
    bump: Option<TextureId>,
}

impl<K: SurfaceKind> Surface<K> {
    /// From the element of the kind, which has been built from it.
    fn new(kind: K, node: &Node, resources: &mut dyn MaterialResources) -> Self {
        let map = if node.block.declares(BUMP_MAP.name) { node.node(BUMP_MAP.name) } else { None };
        Self { kind, bump: map.map(|map| resources.texture(map)) }
    }

    /// Whether light passes as if nothing were there: between equal indices a transparent interface does nothing.
    #[inline]
    fn is_unseen(&self, interface: &Interface) -> bool {
        interface.is_matched() && self.kind.internal_medium().is_some() && self.kind.may_transmit()
    }
}

/// Makes the enums of materials and of their leaves, and everything that goes through all of them.
///
/// A line `name => Material / Leaf` registers a material of the file `name.rs`: `Material` is a
/// [`SurfaceKind`] and has `build(&Node, &mut dyn MaterialResources)` and `leaf(&MaterialContext, uv)`, which
/// is not asked where the surface is unseen; `Leaf` is a [`Scatter`].
/// `blend`, `double_sided_thin` and `null_material` have no leaves, and stand beside the list.
macro_rules! registry {
    ($($name:ident => $material:ident / $leaf:ident,)*) => {
        /// The kinds of material.
        pub static KINDS: &[&Block] = &[$(&$name::BLOCK,)* &blend::BLOCK, &null_material::BLOCK];

        /// Those, and kinds of later format versions for which something stands in.
        static KINDS_AND_LATER: &[&Block] = &[
            $(&$name::BLOCK,)*
            &blend::BLOCK,
            &null_material::BLOCK,
            &double_sided_thin::BLOCK,
            &coating::BLOCK,
            &fast_sss::BLOCK,
            &later::SUM,
            &later::SUNSKY,
        ];

        /// A material as the scene holds it.
        #[derive(Clone, Debug)]
        pub enum Material {
            /// Does nothing to light.
            Null,
            /// Is one material or another.
            Blend(blend::Blend),
            /// Is one material or another, and not the same on both sides.
            Sheet(double_sided_thin::DoubleSidedThin),
            $(#[doc = concat!("See [`", stringify!($name), "`].")] $material(Surface<$name::$material>),)*
        }

        /// A scattering model as a path holds it: all numbers baked for a point and its wavelengths.
        #[derive(Clone, Copy, Debug)]
        pub enum Leaf {
            $(#[doc = concat!("See [`", stringify!($name), "`].")] $material($name::$leaf),)*
        }

        impl Material {
            /// From the element of a kind of material.
            pub fn build(node: &Node, resources: &mut dyn MaterialResources) -> Self {
                $(if std::ptr::eq(node.block, &raw const $name::BLOCK) {
                    let kind = $name::$material::build(node, resources);
                    return Self::$material(Surface::new(kind, node, resources));
                })*
                if std::ptr::eq(node.block, &raw const coating::BLOCK) {
                    return coating::build(node, resources);
                }
                if std::ptr::eq(node.block, &raw const fast_sss::BLOCK) {
                    return fast_sss::build(node, resources);
                }
                if std::ptr::eq(node.block, &raw const later::SUNSKY) {
                    node.disregard();
                    return Self::black();
                }
                if std::ptr::eq(node.block, &raw const double_sided_thin::BLOCK) {
                    return Self::Sheet(double_sided_thin::DoubleSidedThin::build(node, resources));
                }
                if std::ptr::eq(node.block, &raw const blend::BLOCK) {
                    return Self::Blend(blend::Blend::build(node, resources));
                }
                node.mark_used();
                Self::Null
            }

            /// What a blend or sheet is at a point by the context's choice: a material that is neither.
            #[inline]
            pub fn chosen<'a>(&'a self, context: &MaterialContext<'a>, uv: &impl Fn(u32) -> Vec2) -> &'a Self {
                match self {
                    Self::Blend(_) | Self::Sheet(_) => self.chosen_part(context, uv),
                    other => other,
                }
            }

            fn chosen_part<'a>(&'a self, context: &MaterialContext<'a>, uv: &impl Fn(u32) -> Vec2) -> &'a Self {
                let (mut material, mut choice) = (self, blend::Choice::new(context.choice));
                loop {
                    material = match material {
                        Self::Blend(b) => &context.materials[b.choose(context, uv, &mut choice) as usize],
                        Self::Sheet(sheet) => sheet.choose(context, &mut choice),
                        other => return other,
                    };
                }
            }

            /// The heights that bend the shading normal; a blend or sheet has none of its own.
            #[inline]
            pub fn bump_map(&self) -> Option<TextureId> {
                match self {
                    Self::Null | Self::Blend(_) | Self::Sheet(_) => None,
                    $(Self::$material(m) => m.bump,)*
                }
            }

            /// The scattering model at a point, whose texture coordinates `uv` gives for each set;
            /// `None` where light passes as if nothing were there. Of a blend or sheet one is to be [chosen](Self::chosen) first.
            #[inline]
            pub fn leaf(&self, context: &MaterialContext, uv: impl Fn(u32) -> Vec2) -> Option<Leaf> {
                match self {
                    Self::Null | Self::Blend(_) | Self::Sheet(_) => None,
                    $(Self::$material(m) if m.is_unseen(&context.interface) => None,)*
                    $(Self::$material(m) => Some(Leaf::$material(m.kind.leaf(context, uv))),)*
                }
            }

            /// See [`SurfaceKind::internal_medium`].
            #[inline]
            pub fn internal_medium(&self) -> Option<MediumId> {
                match self {
                    Self::Null | Self::Sheet(_) => None,
                    Self::Blend(blend) => blend.internal_medium(),
                    $(Self::$material(m) => m.kind.internal_medium(),)*
                }
            }

            /// See [`SurfaceKind::immerse`].
            pub fn immerse(&mut self, media: &[Medium]) {
                match self {
                    Self::Null | Self::Blend(_) | Self::Sheet(_) => {}
                    $(Self::$material(m) => m.kind.immerse(media),)*
                }
            }

            /// How many of the materials that it is made of can ever let light pass as if nothing were there, each as
            /// often as it is part of it: there is no leaf, or the surface divides a medium from itself.
            pub fn unseen_constituents(&self) -> u32 {
                match self {
                    Self::Null => 1,
                    Self::Sheet(_) => 0,
                    Self::Blend(blend) => blend.unseen_constituents(),
                    $(Self::$material(m) => u32::from(m.kind.internal_medium().is_some()),)*
                }
            }

            /// See [`SurfaceKind::may_transmit`].
            pub fn may_transmit(&self) -> bool {
                match self {
                    Self::Null | Self::Sheet(_) => true,
                    Self::Blend(blend) => blend.may_transmit(),
                    $(Self::$material(m) => m.kind.may_transmit(),)*
                }
            }

            /// The share of light that passes as if nothing were there: the mean over `choice` of the cases in
            /// which there is no leaf.
            #[inline]
            pub fn unseen_share(&self, context: &MaterialContext, uv: &impl Fn(u32) -> Vec2) -> Real {
                match self {
                    Self::Null => 1.0,
                    Self::Sheet(_) => 0.0,
                    Self::Blend(blend) => blend.unseen_share(context, uv),
                    $(Self::$material(m) => if m.is_unseen(&context.interface) { 1.0 } else { 0.0 },)*
                }
            }
        }

        impl Scatter for Leaf {
            #[inline]
            fn f(&self, wo: Vec3, wi: Vec3, crossing: Crossing) -> SampledSpectrum {
                match self {
                    $(Self::$material(m) => m.f(wo, wi, crossing),)*
                }
            }

            #[inline]
            fn pdf(&self, wo: Vec3, wi: Vec3, crossing: Crossing) -> LanePdf {
                match self {
                    $(Self::$material(m) => m.pdf(wo, wi, crossing),)*
                }
            }

            #[inline]
            fn sample(&self, wo: Vec3, u: [Real; 3]) -> Option<LocalSample> {
                match self {
                    $(Self::$material(m) => m.sample(wo, u),)*
                }
            }

            #[inline]
            fn eta(&self) -> SampledSpectrum {
                match self {
                    $(Self::$material(m) => m.eta(),)*
                }
            }

            #[inline]
            fn lets_through(&self) -> bool {
                match self {
                    $(Self::$material(m) => m.lets_through(),)*
                }
            }

            #[inline]
            fn is_matt(&self) -> bool {
                match self {
                    $(Self::$material(m) => m.is_matt(),)*
                }
            }

            #[inline]
            fn is_connectable(&self) -> bool {
                match self {
                    $(Self::$material(m) => m.is_connectable(),)*
                }
            }
        }
    };
}

registry! {
    diffuse => Diffuse / DiffuseLeaf,
    oren_nayar => OrenNayar / OrenNayarLeaf,
    diffuse_transmitter => DiffuseTransmitter / DiffuseTransmitterLeaf,
    specular => Specular / SpecularLeaf,
    phong => Phong / PhongLeaf,
    glossy_transparent => GlossyTransparent / GlossyTransparentLeaf,
}

impl Material {
    /// A grey diffuse surface, which stands in for kinds that are not rendered.
    pub fn grey() -> Self {
        Self::Diffuse(Surface { kind: diffuse::Diffuse::grey(), bump: None })
    }

    /// A surface that scatters nothing.
    pub fn black() -> Self {
        Self::Diffuse(Surface { kind: diffuse::Diffuse::black(), bump: None })
    }

    /// A diffuse surface in a colour that is seen at a glance.
    pub fn magenta() -> Self {
        Self::Diffuse(Surface { kind: diffuse::Diffuse::magenta(), bump: None })
    }

    /// Whether light can ever pass as if nothing were there.
    #[inline]
    pub fn may_be_unseen(&self) -> bool {
        self.unseen_constituents() > 0
    }

    /// Whether light passes as if the surface were not there.
    #[inline]
    pub fn is_invisible(&self) -> bool {
        matches!(self, Self::Null)
    }
}
