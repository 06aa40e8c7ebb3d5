//! Lamps and files of lamps that are wrong, or hardly meant, are named.

use super::{loaded, profile, rectangle, text};

#[test]
fn files_that_are_no_lamps_are_named_with_their_place() {
    let codes = |more: &str| {
        let l = loaded(&text(more));
        l.sink.diagnostics().iter().map(|d| (d.code, d.message.clone())).collect::<Vec<_>>()
    };
    let type_b = codes(&profile("reject_type_B.ies"));
    assert_eq!(type_b.len(), 1);
    assert_eq!(type_b[0].0, "E0303");
    assert!(type_b[0].1.starts_with("reject_type_B.ies:"), "{type_b:?}");
    assert_eq!(codes(&profile("nothing.ies"))[0].0, "E0302");
    let twice = format!(
        "{}<efficacy_scale><power_drawn>1</power_drawn><overall_luminous_efficacy>1</overall_luminous_efficacy></efficacy_scale>",
        profile("lambert_1000cd.ies")
    );
    assert_eq!(codes(&twice).iter().map(|c| c.0).collect::<Vec<_>>(), ["W0310"]);
    let set = "<texture><uv_set>other</uv_set><path>half.bmp</path></texture>";
    assert_eq!(codes(set)[0].0, "E0307");
    // Factors for tilt count for nothing, wherever they are, and a wrong count is told with its place.
    let beside = codes(&profile("beside.ies"));
    assert!(beside.len() == 1 && beside[0].0 == "W0303", "{beside:?}");
    assert!(
        beside[0].1.starts_with("beside.ies:") && beside[0].1.contains("'lamp.tlt' are left out"),
        "{beside:?}"
    );
    assert_eq!(codes(&profile("left_over.ies"))[0].0, "E0303");
    // A path that is not there has one message.
    for missing in ["<ies_profile/>", "<ies_profile><path></path></ies_profile>"] {
        assert_eq!(codes(missing).len(), 1, "{missing}: {:?}", codes(missing));
    }
    // Beyond the manual: a lamp that shines to both sides.
    assert!(codes(&profile("reject_vertical_0_180.ies")).is_empty());
    // The light of a whole lamp from less than an atom: more radiance than numbers hold.
    let tiny = loaded(&text(&profile("lambert_1000cd.ies")).replace("<scale>0.1<", "<scale>1e-14<"));
    assert_eq!(tiny.sink.diagnostics().iter().map(|d| d.code).collect::<Vec<_>>(), ["E0203"]);
}

/// Each triangle of a photometric lamp emits about its own normal: a bent mesh has not the candelas of its file.
#[test]
fn a_photometric_lamp_that_is_not_flat_is_warned_of() {
    let found = |corner: &str, more: &str| {
        let bent = text(more).replace("pos=\"1 1 0\"", &format!("pos=\"1 1 {corner}\""));
        let l = loaded(&bent);
        l.sink.diagnostics().iter().map(|d| (d.code, d.message.clone())).collect::<Vec<_>>()
    };
    let profile = profile("lambert_1000cd.ies");
    // The triangle with the corner lies at the atan of z/√2... about the diagonal: at z = 2 the mean faces 24.9 degrees
    // away, at 0.05 less than one.
    assert_eq!(found("0", &profile), []);
    assert_eq!(found("0.05", &profile), []);
    assert_eq!(found("2", ""), []);
    let bent = found("2", &profile);
    assert!(bent.len() == 1 && bent[0].0 == "W0313", "{bent:?}");
    assert!(bent[0].1.contains("not flat"), "{bent:?}");
}

/// What rounding does to a lamp is said: a part of it is left at 1e8 m, where numbers are 8 m apart, nothing at 1e9.
#[test]
fn lamps_that_rounding_takes_are_named() {
    let codes = |x: &str, size: &str| {
        let far = |text: &str| text.replace("<pos>0 0 2</pos>", &format!("<pos>{x} 0 2</pos>"));
        let mesh = far(&text("")).replace("<scale>0.1<", &format!("<scale>{size}<"));
        let sides: f64 = size.parse().expect("a number");
        [mesh, far(&rectangle(2.0 * sides, 2.0 * sides, ""))].map(|text| {
            let l = loaded(&text);
            l.sink.diagnostics().iter().map(|d| d.code).collect::<Vec<_>>()
        })
    };
    assert_eq!(codes("100", "1"), [[""; 0]; 2]);
    assert_eq!(codes("1e9", "1"), [["E0306"]; 2]);
    assert_eq!(codes("1.00000003e8", "7"), [["W0315"]; 2]);
    assert_eq!(codes("1e9", "1e5"), [[""; 0]; 2]);
    // What is no lamp is warned of.
    let model = |size: &str| {
        let model = format!(
            "<model><pos>1e9 0 0</pos><scale>{size}</scale><mesh_name>square</mesh_name></model></scene>"
        );
        let l = loaded(&text("").replace("</scene>", &model));
        l.sink.diagnostics().iter().map(|d| d.code).collect::<Vec<_>>()
    };
    assert_eq!((model("1"), model("1e4")), (vec!["W0315"], vec![]));
}

#[test]
fn an_efficacy_beyond_all_light_is_warned_of() {
    let codes = |efficacy: &str| {
        let scale = format!(
            "<efficacy_scale><power_drawn>100</power_drawn><overall_luminous_efficacy>{efficacy}</overall_luminous_efficacy></efficacy_scale>"
        );
        [text(&scale), rectangle(1.0, 1.0, &scale)]
            .map(|text| loaded(&text).sink.diagnostics().iter().map(|d| d.code).collect::<Vec<_>>())
    };
    assert_eq!(codes("683"), [[""; 0]; 2]);
    assert_eq!(codes("700"), [["W0314"]; 2]);
}
