//! Phase functions: into which directions a medium scatters light. One file each, and one line each in
//! the list below.

pub mod henyey_greenstein;
pub mod uniform;

use indigo_decl::{Alternatives, Block, Node};
use indigo_diag::Sink;
use indigo_math::{Real, Vec3};
use indigo_spectrum::{LanePdf, SampledWavelengths};

/// What the author of a phase function writes: with all its numbers baked for one set of wavelengths.
///
/// Both directions point away from the point, so light that goes straight on has `wi == -wo`. A phase
/// function is its own density: it integrates to 1 over `wi` in every lane, and it is symmetric.
pub trait Phase {
    /// The phase function, and the density of [`sample`](Self::sample), in 1/sr.
    fn pdf(&self, wo: Vec3, wi: Vec3) -> LanePdf;

    /// A direction drawn by the hero's phase function.
    fn sample(&self, wo: Vec3, u: [Real; 2]) -> Vec3;
}

/// Makes the enums of phase functions as a scene and as a path holds them.
///
/// A line `name => Kind / Lobe` registers a phase function of the file `name.rs`: `Kind` has
/// `build(&Node, &mut Sink)`, `mean_cosine(nm)` and `at(&SampledWavelengths)`, `Lobe` is a [`Phase`].
macro_rules! registry {
    ($($name:ident => $kind:ident / $lobe:ident,)*) => {
        /// The kinds of phase function.
        pub static KINDS: &[&Block] = &[$(&$name::BLOCK,)*];

        /// A phase function as the scene holds it.
        #[derive(Clone, Debug)]
        pub enum PhaseFunction {
            $(#[doc = concat!("See [`", stringify!($name), "`].")] $kind($name::$kind),)*
        }

        /// A phase function as a path holds it: all numbers baked for its wavelengths.
        #[derive(Clone, Copy, Debug)]
        pub enum Lobe {
            $(#[doc = concat!("See [`", stringify!($name), "`].")] $kind($name::$lobe),)*
        }

        impl PhaseFunction {
            /// From the element of a kind of phase function; `None` where it is of no known kind.
            pub fn build(node: &Node, sink: &mut Sink) -> Option<Self> {
                $(if std::ptr::eq(node.block, &raw const $name::BLOCK) {
                    return Some(Self::$kind($name::$kind::build(node, sink)));
                })*
                None
            }

            /// The mean cosine between the old and the new way of light of a wavelength in nm.
            pub fn mean_cosine(&self, nm: f64) -> f64 {
                match self {
                    $(Self::$kind(p) => p.mean_cosine(nm),)*
                }
            }

            /// The phase function at some wavelengths.
            #[inline]
            pub fn at(&self, lambda: &SampledWavelengths) -> Lobe {
                match self {
                    $(Self::$kind(p) => Lobe::$kind(p.at(lambda)),)*
                }
            }
        }

        impl Phase for Lobe {
            #[inline]
            fn pdf(&self, wo: Vec3, wi: Vec3) -> LanePdf {
                match self {
                    $(Self::$kind(p) => p.pdf(wo, wi),)*
                }
            }

            #[inline]
            fn sample(&self, wo: Vec3, u: [Real; 2]) -> Vec3 {
                match self {
                    $(Self::$kind(p) => p.sample(wo, u),)*
                }
            }
        }
    };
}

registry! {
    uniform => Uniform / UniformLobe,
    henyey_greenstein => HenyeyGreenstein / HenyeyGreensteinLobe,
}

/// The content of `phase_function`.
pub static PHASE_FUNCTION: Alternatives = Alternatives::new("phase function", KINDS);
