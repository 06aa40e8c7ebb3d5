//! Spectra from scene files. What a number may be depends on the use, so each use is a function.

use crate::Spectrum;
use crate::adaptation::rgb_of_xyz;
use indigo_decl::{Node, codes};
use indigo_diag::{Diagnostic, Sink, Span};

/// What an RGB triple stands for.
#[derive(Clone, Copy)]
enum Use {
    Reflectance,
    Emission,
    Coefficient,
    Factor,
}

/// The largest radiance (W m^-3 sr^-1) and the largest coefficient (1/m) that a scene may give. The sun has 3e13;
/// the film refuses contributions beyond 1e30 cd/m², so this leaves a factor of ten million to the weights of paths.
pub const LARGEST: f64 = 1e27;

/// A fraction of light: clamped to 1, silently, as the manual says. Negative values are errors, but for the noise of
/// measured tables, which counts as 0.
pub fn reflectance(node: &Node, sink: &mut Sink) -> Spectrum {
    refuse_negative(node, "a reflectance", sink);
    build(node, Use::Reflectance, sink).clamped(0.0, 1.0)
}

/// Spectral radiance, W m^-3 sr^-1: negative values are errors, but for the noise of measured tables,
/// which counts as 0.
pub fn emission(node: &Node, sink: &mut Sink) -> Spectrum {
    refuse_negative(node, "an emitter", sink);
    let spectrum = build(node, Use::Emission, sink).clamped(0.0, f64::INFINITY);
    refuse_excess(&spectrum, node.span, sink);
    spectrum
}

/// What multiplies an emission, as an image map does: white (1, 1, 1) changes nothing. Negative values are errors, but for
/// the noise of measured tables, which counts as 0.
pub fn factor(node: &Node, sink: &mut Sink) -> Spectrum {
    refuse_negative(node, "a factor", sink);
    let spectrum = build(node, Use::Factor, sink).clamped(0.0, f64::INFINITY);
    refuse_excess(&spectrum, node.span, sink);
    spectrum
}

/// A coefficient of a medium (1/m): negative values are errors, but for the noise of measured tables, which counts as
/// 0.
pub fn coefficient(node: &Node, sink: &mut Sink) -> Spectrum {
    refuse_negative(node, "a coefficient", sink);
    let spectrum = build(node, Use::Coefficient, sink).clamped(0.0, f64::INFINITY);
    refuse_excess(&spectrum, node.span, sink);
    spectrum
}

/// Reports values beyond [`LARGEST`], and what is no number.
pub fn refuse_excess(spectrum: &Spectrum, span: Span, sink: &mut Sink) {
    let (lowest, largest) = spectrum.range();
    let is_held = lowest >= 0.0 && lowest <= largest && largest <= LARGEST;
    if !is_held {
        sink.push(
            Diagnostic::error(
                codes::OUT_OF_RANGE,
                span,
                "the values of this spectrum are too large to be computed with",
            )
            .expected(format!("expected at most {LARGEST:e}, found {largest:.1e}")),
        );
    }
}

/// The mean cosine of a phase function: clamped to [-0.99, 0.99], silently, as the manual says.
pub fn mean_cosine(node: &Node, sink: &mut Sink) -> Spectrum {
    build(node, Use::Coefficient, sink).clamped(-0.99, 0.99)
}

fn refuse_negative(node: &Node, what: &str, sink: &mut Sink) {
    for field in node.block.fields {
        let lowest = match field.name {
            "rgb" | "xyz" => node.vec3(field.name).into_iter().fold(f64::INFINITY, f64::min),
            "value" | "base_value" | "peak_value" => node.real(field.name),
            _ => continue,
        };
        if lowest < 0.0 {
            sink.push(
                Diagnostic::error(
                    codes::OUT_OF_RANGE,
                    node.span_of(field.name),
                    format!("<{}> of {what} must be >= 0", field.name),
                )
                .expected(format!("found {lowest}")),
            );
        }
    }
}

/// No table of visible light begins beyond a millimetre; one in nanometres or micrometres does.
const LONGEST: f64 = 1e-3;

fn build(node: &Node, purpose: Use, sink: &mut Sink) -> Spectrum {
    match node.block.name {
        "uniform" => Spectrum::uniform(node.real("value")),
        "blackbody" => Spectrum::blackbody(node.real("temperature"), node.real("gain")),
        "peak" => Spectrum::peak(
            node.real("peak_min"),
            node.real("peak_width"),
            node.real("base_value"),
            node.real("peak_value"),
        ),
        "rgb" => {
            let (gamma, gain) = (node.real("gamma"), node.real("gain"));
            let rgb = node.vec3("rgb").map(|v| if gamma == 1.0 { v } else { v.max(0.0).powf(gamma) });
            colour(rgb.map(|v| v * gain), purpose)
        }
        "xyz" => {
            let gain = node.real("gain");
            colour(rgb_of_xyz(node.vec3("xyz")).map(|v| v.max(0.0) * gain), purpose)
        }
        _ => table(node, sink),
    }
}

fn colour(rgb: [f64; 3], purpose: Use) -> Spectrum {
    match purpose {
        Use::Reflectance => Spectrum::rgb_reflectance(rgb),
        Use::Emission => Spectrum::rgb_emission(rgb),
        Use::Coefficient => Spectrum::rgb_coefficient(rgb),
        Use::Factor => {
            // A reflectance's shape, as an image map on a lamp has it; a factor may go beyond 1.
            let scale = rgb.into_iter().fold(1.0, f64::max);
            Spectrum::rgb_reflectance(rgb.map(|v| v / scale)).scaled(scale)
        }
    }
}

fn table(node: &Node, sink: &mut Sink) -> Spectrum {
    let values = node.reals("values");
    let count = node.int("num_values");
    if usize::try_from(count) != Ok(values.value.len()) {
        sink.push(
            Diagnostic::error(
                codes::OUT_OF_RANGE,
                values.span,
                format!("<num_values> is {count}, but <values> has {}", values.value.len()),
            )
            .expected(format!("expected {count} numbers")),
        );
    }
    let (start, end) = (node.real("start_wavelength"), node.real("end_wavelength"));
    if start > LONGEST {
        sink.push(
            Diagnostic::warning(
                codes::SUSPECT_UNIT,
                node.span_of("start_wavelength"),
                "the table lies far outside of visible light: its wavelengths are in metres",
            )
            .hint(format!("did you mean {:e}?", start / 1e9)),
        );
    }
    match Spectrum::regular_tabulated(start, end, &values.value) {
        Ok(spectrum) => spectrum,
        Err(error) => {
            let place = node.span_of("end_wavelength");
            sink.push(Diagnostic::error(codes::OUT_OF_RANGE, place, format!("<regular_tabulated>: {error}")));
            Spectrum::uniform(1.0)
        }
    }
}
