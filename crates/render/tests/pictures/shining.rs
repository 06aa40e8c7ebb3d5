//! What surfaces emit by themselves is added to what they scatter, whatever kind of material says so.

use super::common::judge::{NITS_PER_UNIFORM, assert_near};
use super::common::measure;
use super::common::text::{grey, uniform};
use super::materials::{RADIANCE, sheet_with};

/// Twice as bright as the even light round it.
fn emission() -> String {
    format!("<base_emission><constant>{}</constant></base_emission>", uniform(2.0 * RADIANCE))
}

/// The front of a square shows its emission and the share of even light that it scatters, the back that share alone.
fn assert_shines(what: &str, kind: &str, share: f64) {
    for (degrees, emitted) in [(20.0, 2.0), (160.0, 0.0)] {
        for bidirectional in [false, true] {
            let mut scene = sheet_with(kind, degrees, "", &grey("below", 0.4));
            scene.transport.bidirectional = bidirectional;
            let measured = measure(&scene, 8, 200);
            let expected = (emitted + share) * RADIANCE * NITS_PER_UNIFORM;
            let what = format!("{what} from {degrees}°, bidirectional: {bidirectional}");
            assert_near(&what, measured.luminance(), expected, 1e-2);
        }
    }
}

#[test]
fn surfaces_add_what_they_emit() {
    let albedo = format!("<albedo_spectrum>{}</albedo_spectrum>", uniform(0.6));
    assert_shines("diffuse", &format!("<diffuse>{albedo}{}</diffuse>", emission()), 0.6);
    let through = format!("<transmittance><constant>{}</constant></transmittance>", uniform(0.8));
    let thin = format!(
        "<double_sided_thin><front_material_name>below</front_material_name><r_f>0.5</r_f>{through}{}</double_sided_thin>",
        emission()
    );
    assert_shines("a thin sheet", &thin, 0.5 * 0.4 + 0.5 * 0.8);
    // A coat of the index of air is not to be seen.
    let coat = format!(
        "<coating><substrate_material_name>below</substrate_material_name><ior>1</ior>{}</coating>",
        emission()
    );
    assert_shines("a coat", &coat, 0.4);
}
