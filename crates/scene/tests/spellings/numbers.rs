//! Numbers in the wrappers that exporters put round whatever may have a texture, too.

use super::common::*;

fn of(kind: &str) -> String {
    format!("{CAMERA}{LIGHT}{MESH}{MODEL}{}{}", material("n", GREY), material("m", kind))
}

#[test]
fn a_number_may_be_written_as_an_even_spectrum() {
    for (kind, number, value, other) in [
        ("<phong><ior>1.5</ior>{}</phong>", "exponent", "90", "80"),
        ("<phong><exponent>90</exponent>{}</phong>", "ior", "1.5", "1.4"),
        ("<phong><ior>1.5</ior>{}</phong>", "roughness", "0.3", "0.4"),
        ("<phong><ior>1.5</ior><exponent>90</exponent>{}</phong>", "fresnel_scale", "0.5", "0.4"),
        (
            "<oren_nayar><albedo><constant><uniform><value>0.5</value></uniform></constant></albedo>{}</oren_nayar>",
            "sigma",
            "0.3",
            "0.2",
        ),
        ("<blend><a_name>n</a_name><b_name>n</b_name>{}</blend>", "blend", "0.25", "0.5"),
        (
            "<double_sided_thin><front_material_name>n</front_material_name>{}</double_sided_thin>",
            "r_f",
            "0.25",
            "0.3",
        ),
    ] {
        let with = |value: &str| of(&kind.replace("{}", &format!("<{number}>{value}</{number}>")));
        let uniform = format!("<uniform><value>{value}</value></uniform>");
        assert_same([&with(value), &with(&uniform), &with(other)]);
        assert_same([&with(value), &with(&format!("<constant>{uniform}</constant>")), &with(other)]);
    }
}

/// A value by itself is no such spectrum.
#[test]
fn a_value_without_its_spectrum_is_told() {
    let found = findings(&loaded(&of("<phong><ior>1.5</ior><exponent><value>90</value></exponent></phong>")));
    assert!(found.iter().any(|(_, message)| message.contains("<value>")), "{found:?}");
}

#[test]
fn maps_of_numbers_that_are_not_rendered_are_told() {
    let map = "<texture><path>a.bmp</path></texture>";
    for (kind, told) in [
        (
            format!(
                "<double_sided_thin><front_material_name>n</front_material_name><r_f>{map}</r_f></double_sided_thin>"
            ),
            "W0102 <texture> in <r_f> is of a later format version (3.0) and not rendered: 0.5 stands in",
        ),
        (
            format!("<phong><ior>{map}</ior><exponent>90</exponent></phong>"),
            "W0102 <texture> in <ior> is of a later format version (1.1) and not rendered: 1.5 stands in",
        ),
    ] {
        scene_with(&of(&kind), &[told]);
    }
}
