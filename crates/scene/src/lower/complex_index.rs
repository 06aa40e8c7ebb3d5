//! Files of complex indices of refraction, as the spectra that metals are made of.

use super::Context;
use crate::codes;
use indigo_diag::{Diagnostic, Sink, Span};
use indigo_formats::nk;
use indigo_spectrum::Spectrum;

/// n and k of a file; whatever is wrong with it is reported, and those of air stand in.
pub(super) fn read(path: &str, span: Span, context: &mut Context) -> [Spectrum; 2] {
    let stand_in = [Spectrum::uniform(1.0), Spectrum::BLACK];
    let Some(file) = context.read(path, span) else { return stand_in };
    match nk::read(&file.bytes) {
        Ok(index) => {
            report_range(&index, &file.path, span, context.sink);
            if let Some(place) = index.left_out {
                let message =
                    format!("{}:{place}: text behind the last pair of n and k, which is left out", file.path);
                context.sink.push_or_count(Diagnostic::warning(codes::FILE_NOTE, span, message));
            }
            tabulated(&index)
        }
        Err(error) => {
            let place = format!("{}:{}: bad file of refractive indices", file.path, error.position);
            let what = format!("expected {}, found {}", error.expected, error.found);
            context.sink.push(Diagnostic::error(codes::BAD_FILE, span, place).expected(what));
            stand_in
        }
    }
}

/// What is seen, nm: outside, the eye's response is below a ten-thousandth of its peak.
const VISIBLE_NM: [f64; 2] = [380.0, 780.0];

/// Says so where a table of refractive indices lacks some of what is seen; one that lacks all of it is an error.
fn report_range(index: &nk::ComplexIndex, file: &str, span: Span, sink: &mut Sink) {
    let [first, last] = index.range_nm();
    let [from, to] = VISIBLE_NM;
    let range = format!("{file}: refractive indices from {} to {} nm", rounded(first), rounded(last));
    if last < from || first > to {
        let what = format!("expected a range that reaches into visible light, {from} to {to} nm");
        sink.push(Diagnostic::error(codes::BAD_FILE, span, range).expected(what));
        return;
    }
    let held = |end: f64, side: &str| format!("those at {} nm are held {side}", rounded(end));
    let below = (first > from).then(|| held(first, "below"));
    let above = (last < to).then(|| held(last, "above"));
    let ends: Vec<String> = below.into_iter().chain(above).collect();
    if !ends.is_empty() {
        let message = format!("{range}, of {from} to {to} that are seen: {}", ends.join(", and "));
        sink.push(Diagnostic::warning(codes::FILE_NOTE, span, message));
    }
}

/// To a tenth, as one would write it.
fn rounded(nm: f64) -> f64 {
    (nm * 10.0).round() / 10.0
}

/// n and k at every nanometre of the visible range.
fn tabulated(index: &nk::ComplexIndex) -> [Spectrum; 2] {
    const FIRST_NM: u32 = 360;
    const LAST_NM: u32 = 830;
    let samples: Vec<[f64; 2]> = (FIRST_NM..=LAST_NM).map(|nm| index.at(f64::from(nm))).collect();
    [0, 1].map(|i| {
        let values: Vec<f64> = samples.iter().map(|s| s[i]).collect();
        let (start, end) = (f64::from(FIRST_NM) * 1e-9, f64::from(LAST_NM) * 1e-9);
        // The reader lets nothing through that a table could not hold.
        Spectrum::regular_tabulated(start, end, &values).unwrap_or(Spectrum::BLACK)
    })
}
