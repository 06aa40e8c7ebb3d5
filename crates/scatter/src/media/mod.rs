//! Media: what fills the inside of objects. One file each, and one line each in the list below.
//!
//! Every kind of medium comes down to an index of refraction, two coefficients and a phase function, so a
//! kind is a way to make a [`Medium`] from its element.

pub mod basic;
pub mod dermis;
pub mod epidermis;
mod skin;

use crate::phase::{Lobe, PhaseFunction, uniform};
use indigo_decl::{Alternatives, Block, Field, Kind, Later, Node, Presence, Range, Written};
use indigo_diag::Sink;
use indigo_math::{Float, Real};
use indigo_spectrum::{SampledSpectrum, SampledWavelengths, Spectrum};

/// Names a medium of a scene.
///
/// Numbers are in the order of precedence, and in that of definition where precedences are equal: of
/// several media at one place, the one of the largest number is there.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct MediumId(u16);

impl MediumId {
    /// What is everywhere by itself.
    pub const AIR: Self = Self(0);

    /// Number `i`, from 1 on for the media of the scene; `None` where there are too many.
    pub fn new(i: usize) -> Option<Self> {
        u16::try_from(i).ok().map(Self)
    }

    /// Its place in a list of all media, of which air is the first.
    #[inline]
    pub fn index(self) -> usize {
        usize::from(self.0)
    }
}

/// The index of refraction by Cauchy's equation n = A + B/λ².
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cauchy {
    /// A.
    pub a: f64,
    /// B, µm².
    pub b: f64,
}

impl Cauchy {
    /// The same index at every wavelength.
    pub const fn constant(ior: f64) -> Self {
        Self { a: ior, b: 0.0 }
    }

    /// The index at a wavelength, nm.
    #[inline]
    pub fn at(&self, nm: Real) -> Real {
        // 1 µm² is 10^6 nm².
        Real::from_f64(self.a) + Real::from_f64(self.b * 1e6) / (nm * nm)
    }

    /// The indices at some wavelengths.
    #[inline]
    pub fn eval(&self, lambda: &SampledWavelengths) -> SampledSpectrum {
        SampledSpectrum(lambda.lambda.map(|nm| self.at(nm)))
    }
}

/// A medium as a scene holds it.
#[derive(Clone, Debug)]
pub struct Medium {
    /// The index of refraction.
    pub ior: Cauchy,
    /// Absorption coefficient, 1/m.
    pub absorption: Spectrum,
    /// Scattering coefficient, 1/m.
    pub scattering: Spectrum,
    /// Where scattered light goes.
    pub phase: PhaseFunction,
}

/// A medium as a path holds it: all numbers baked for its wavelengths.
#[derive(Clone, Copy, Debug)]
pub struct Coefficients {
    /// Indices of refraction.
    pub eta: SampledSpectrum,
    /// Absorption, 1/m.
    pub absorption: SampledSpectrum,
    /// Scattering, 1/m.
    pub scattering: SampledSpectrum,
    /// Where scattered light goes.
    pub phase: Lobe,
}

impl Medium {
    /// What is everywhere by itself: it does nothing to light.
    pub const AIR: Self = Self::clear(Cauchy::constant(1.0));

    /// A medium that only refracts.
    pub const fn clear(ior: Cauchy) -> Self {
        Self {
            ior,
            absorption: Spectrum::BLACK,
            scattering: Spectrum::BLACK,
            phase: PhaseFunction::Uniform(uniform::Uniform),
        }
    }

    /// The medium at some wavelengths.
    #[inline]
    pub fn at(&self, lambda: &SampledWavelengths) -> Coefficients {
        Coefficients {
            eta: self.ior.eval(lambda),
            absorption: self.absorption.eval(lambda),
            scattering: self.scattering.eval(lambda),
            phase: self.phase.at(lambda),
        }
    }
}

/// Makes the list of kinds, and the function that goes through all of them. A line `name` registers a
/// kind of the file `name.rs`, which has a `BLOCK` and `build(&Node, &mut Sink) -> Medium`.
macro_rules! registry {
    ($($name:ident,)*) => {
        /// The kinds of medium.
        pub static KINDS: &[&Block] = &[$(&$name::BLOCK,)*];

        impl Medium {
            /// From the element of a kind of medium; `None` where it is of no known kind.
            pub fn build(node: &Node, sink: &mut Sink) -> Option<Self> {
                $(if std::ptr::eq(node.block, &raw const $name::BLOCK) {
                    return Some($name::build(node, sink));
                })*
                None
            }
        }
    };
}

registry! {
    basic,
    epidermis,
    dermis,
}

/// The uid of a medium.
const UID: Field = Field::new(
    "uid",
    Kind::Text,
    Presence::Optional,
    "A number by which later versions refer to it (`internal_medium_uid`).",
);

/// The declaration of `medium`.
pub static MEDIUM: Block = Block::new(
    "medium",
    "Defines a medium: a name, a precedence and one kind. Where it stands in the scene matters only beside media of the same precedence. \
     The children of `basic` may also stand directly in `medium`. Its surface has to be closed: a mesh with an edge \
     that an odd number of its triangles have is told of, where vertices in just one place are one, and triangles without an area \
     count. So are T-junctions, where triangles meet others between the ends of an edge, and meshes that are closed only together. \
     Nothing is told of triangles that face the wrong way, nor of meshes of more than 4,194,304 triangles. \
     Measured media come with the program, to be included: those that `media/README.md` lists.",
    &[
        Field::new(
            "name",
            Kind::Name,
            Presence::Required,
            "Name by which materials refer to it. Without a definition there is one that is called `air`: that which fills the \
             scene by itself. A medium of that name takes its place for materials that name it, and nowhere else.",
        ),
        UID,
        Field::new(
            "precedence",
            Kind::Int,
            Presence::Default("10"),
            "Where several media overlap, the one with the highest precedence is there and displaces the \
             others; of those with the same, the one that is defined last. Air, which fills the scene by itself, has 1. \
             Surfaces of two media must not lie in one plane where they overlap: let one reach into the other.",
        )
        .range(Range::Above(1.0)),
    ],
)
.with_alternatives(Alternatives {
    implied: Some(&basic::BLOCK),
    later: &[Later::new("atmosphere", "3.0"), Later::new("fast_sss", "3.0")],
    stand_in: "air",
    written: Some(Written::of("basic", &[Written::text("ior", "1")])),
    ..Alternatives::new("kind of medium", KINDS)
})
.with_later(&[
    Later::new("metadata", "3.0"),
    Later::new("step_size", "3.0"),
    Later::new("max_extinction_coeff", "3.0"),
])
.with_example(
    "<medium>
    <name>milk</name>
    <precedence>8</precedence>
    <basic>
        <ior>1.33</ior>
        <cauchy_b_coeff>0</cauchy_b_coeff>
        <absorption_coefficient_spectrum>
            <rgb><rgb>11.5 5.75 2.875</rgb><gamma>1</gamma></rgb>
        </absorption_coefficient_spectrum>
        <subsurface_scattering>
            <scattering_coefficient_spectrum>
                <uniform><value>15000</value></uniform>
            </scattering_coefficient_spectrum>
            <phase_function>
                <henyey_greenstein>
                    <g_spectrum><uniform><value>0.9</value></uniform></g_spectrum>
                </henyey_greenstein>
            </phase_function>
        </subsurface_scattering>
    </basic>
</medium>",
);
