//! `basic`: a medium of given coefficients.

use super::{Cauchy, Medium};
use crate::phase::{PHASE_FUNCTION, PhaseFunction};
use indigo_decl::{Block, Field, Kind, Later, Node, Parameter, Presence, Range, StandIn};
use indigo_diag::Sink;
use indigo_spectrum::declare::SPECTRUM;
use indigo_spectrum::read;

/// The declaration of `basic`.
pub static BLOCK: Block = Block::new(
    "basic",
    "A medium given by its index of refraction, absorption and scattering.",
    &[
        Field::new(
            "ior",
            Kind::Real,
            Presence::Required,
            "Index of refraction: about 1.5 for glass and plastics, 1.33 for water.",
        )
        .range(Range::AtLeast(1.0)),
        Field::new(
            "cauchy_b_coeff",
            Kind::Real,
            Presence::Default("0"),
            "The coefficient B of Cauchy's equation n = A + B/λ², with which the index varies over the \
             wavelengths; 0.003 to 0.01 for glass and water, 0 for no dispersion. Dispersion costs time: a \
             refracted ray stands for one wavelength only.",
        )
        .unit("µm²")
        .range(Range::AtLeast(0.0)),
        Field::new(
            "absorption_coefficient_spectrum",
            Kind::OneOf(&SPECTRUM),
            Presence::Optional,
            "How fast light is absorbed along its way, at least 0; without it the medium is \
             clear.",
        )
        .unit("m^-1"),
        Field::new(
            "subsurface_scattering",
            Kind::Block(&SUBSURFACE_SCATTERING),
            Presence::Optional,
            "Makes the medium scatter light.",
        ),
    ],
)
.with_parameters(&[coefficient("absorption_coefficient", "absorption_coefficient_spectrum")])
.with_later(&[Later::new("fast_sss", "3.0").unless("false")])
.with_example(
    "<basic>
    <ior>1.5</ior>
    <cauchy_b_coeff>0.004</cauchy_b_coeff>
    <absorption_coefficient_spectrum>
        <rgb><rgb>14.4 27.0 9.2</rgb></rgb>
    </absorption_coefficient_spectrum>
</basic>",
);

/// The declaration of `subsurface_scattering`.
pub static SUBSURFACE_SCATTERING: Block = Block::new(
    "subsurface_scattering",
    "How a medium scatters light.",
    &[
        Field::new(
            "scattering_coefficient_spectrum",
            Kind::OneOf(&SPECTRUM),
            Presence::Required,
            "How often light is scattered along its way, at least 0.",
        )
        .unit("m^-1"),
        Field::new(
            "phase_function",
            Kind::OneOf(&PHASE_FUNCTION),
            Presence::Required,
            "Into which directions light is scattered.",
        ),
    ],
)
.with_parameters(&[coefficient("scattering_coefficient", "scattering_coefficient_spectrum")])
.with_example(
    "<subsurface_scattering>
    <scattering_coefficient_spectrum>
        <uniform><value>10</value></uniform>
    </scattering_coefficient_spectrum>
    <phase_function><uniform/></phase_function>
</subsurface_scattering>",
);

/// A coefficient as later versions write it; of the same value everywhere, since maps of the inside are not rendered.
const fn coefficient(name: &'static str, constant: &'static str) -> Parameter {
    Parameter { name, since: "1.1", constant, texture: "", stand_in: StandIn::Uniform("0") }
}

/// From its element.
pub fn build(node: &Node, sink: &mut Sink) -> Medium {
    let mut medium = Medium::clear(Cauchy { a: node.real("ior"), b: node.real("cauchy_b_coeff") });
    if let Some(absorption) = node.node("absorption_coefficient_spectrum") {
        medium.absorption = read::coefficient(absorption, sink);
    }
    let Some(scatters) = node.node("subsurface_scattering") else { return medium };
    if let Some(scattering) = scatters.node("scattering_coefficient_spectrum") {
        medium.scattering = read::coefficient(scattering, sink);
    }
    if let Some(phase) = scatters.node("phase_function").and_then(|p| PhaseFunction::build(p, sink)) {
        medium.phase = phase;
    }
    medium
}
