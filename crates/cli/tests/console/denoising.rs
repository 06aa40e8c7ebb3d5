//! Denoised pictures and layers, beside the picture as it is.

use super::workbench::Workbench;
use std::path::PathBuf;
use std::process::Command;

const QUIET: &str = "<logging>false</logging>";

/// A library with the interface of Open Image Denoise that mirrors the picture, so that it can be seen to have been
/// called. It fails unless it gets all three pictures in full, the HDR mode, and its own handles.
const STAND_IN: &str = r#"
use std::ffi::{CStr, c_char, c_int, c_void};
static mut IMAGES: [(*mut f32, usize); 4] = [(std::ptr::null_mut(), 0); 4];
static mut HDR: bool = false;
static mut PROBLEM: *const c_char = std::ptr::null();
const NAMES: [&CStr; 4] = [c"color", c"albedo", c"normal", c"output"];
const DEVICE: usize = 16;
const FILTER: usize = 32;
unsafe fn check(holds: bool, problem: &'static CStr) { if !holds { unsafe { PROBLEM = problem.as_ptr() } } }
#[unsafe(no_mangle)] extern "C" fn oidnNewDevice(kind: c_int) -> usize { unsafe { check(kind == 1, c"no CPU") }; DEVICE }
#[unsafe(no_mangle)] extern "C" fn oidnCommitDevice(device: usize) { unsafe { check(device == DEVICE, c"device") } }
#[unsafe(no_mangle)] extern "C" fn oidnReleaseDevice(device: usize) { unsafe { check(device == DEVICE, c"device") } }
#[unsafe(no_mangle)] extern "C" fn oidnNewFilter(device: usize, kind: *const c_char) -> usize {
    unsafe { check(device == DEVICE && CStr::from_ptr(kind) == c"RT", c"not the filter for rendering") };
    FILTER
}
#[unsafe(no_mangle)] extern "C" fn oidnSetSharedFilterImage(filter: usize, name: *const c_char, data: *mut c_void,
    format: c_int, width: usize, height: usize, offset: usize, pixel: usize, row: usize) {
    unsafe {
        check(filter == FILTER && format == 3 && (offset, pixel, row) == (0, 0, 0), c"layout");
        match NAMES.iter().position(|n| *n == CStr::from_ptr(name)) {
            Some(i) => IMAGES[i] = (data.cast(), 3 * width * height),
            None => check(false, c"unknown image"),
        }
    }
}
#[unsafe(no_mangle)] extern "C" fn oidnSetFilterBool(_: usize, name: *const c_char, value: bool) {
    unsafe { HDR = value && CStr::from_ptr(name) == c"hdr" }
}
#[unsafe(no_mangle)] extern "C" fn oidnCommitFilter(filter: usize) { unsafe { check(filter == FILTER, c"filter") } }
#[unsafe(no_mangle)] extern "C" fn oidnReleaseFilter(filter: usize) { unsafe { check(filter == FILTER, c"filter") } }
#[unsafe(no_mangle)] extern "C" fn oidnExecuteFilter(_: usize) {
    unsafe {
        let images = IMAGES;
        check(HDR, c"the picture is HDR");
        check(images.iter().all(|i| i.1 == 3 * 40 * 30), c"an image is missing");
        let [color, albedo, normal, output] = images.map(|(data, n)| std::slice::from_raw_parts_mut(data, n));
        check(albedo.iter().any(|v| *v > 0.0) && normal.iter().any(|v| *v != 0.0), c"nothing is met");
        for (i, to) in output.chunks_mut(3).enumerate() { to.copy_from_slice(&color[3 * (i / 40 * 40 + 39 - i % 40)..][..3]) }
    }
}
#[unsafe(no_mangle)] extern "C" fn oidnGetDeviceError(_: usize, message: *mut *const c_char) -> c_int {
    unsafe { *message = PROBLEM; if PROBLEM.is_null() { 0 } else { 1 } }
}
"#;

fn stand_in(bench: &Workbench) -> PathBuf {
    bench.write("stand_in.rs", STAND_IN);
    let library = bench.path("stand_in.so");
    let built = Command::new(std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into()))
        .args(["--edition=2024", "--crate-type=cdylib", "-Adead_code", "-Astatic_mut_refs", "-o"])
        .args([&library, &bench.path("stand_in.rs")])
        .output()
        .expect("the compiler");
    assert!(built.status.success(), "{}", String::from_utf8_lossy(&built.stderr));
    library
}

fn codes(bench: &Workbench, name: &str) -> Vec<u8> {
    let image = indigo_formats::image::decode(name, &std::fs::read(bench.path(name)).expect("a picture"));
    let indigo_formats::image::Pixels::U8(codes) = image.expect("a picture").pixels else { panic!("8 bits") };
    codes
}

#[test]
fn a_denoised_picture_lies_beside_the_noisy_one() {
    // A picture that no filter blurs (nor diffraction: the scene has none) is the same in both orders.
    let sharp = "<super_sample_factor>1</super_sample_factor>";
    let bench = Workbench::new(&format!("{QUIET}{sharp}"));
    let library = stand_in(&bench);
    let text = std::fs::read_to_string(bench.path("scene.igs")).expect("the scene");
    let exrs = "<save_untonemapped_exr>true</save_untonemapped_exr><save_tonemapped_exr>true</save_tonemapped_exr></renderer_settings>";
    bench.write("exrs.igs", &text.replace("</renderer_settings>", exrs));
    let arguments = ["exrs.igs", "-haltspp", "2", "-seed", "3", "-t", "1", "-o", "a.png", "-denoise"];
    let ran = bench.run_with("INDIGO_OIDN", &library, &arguments);
    assert_eq!(ran.status, Some(0), "{ran:?}");
    for kind in ["untonemapped", "tonemapped"] {
        let green = |name: &str| {
            let image = exr::prelude::read_first_flat_layer_from_file(bench.path(name)).expect("an EXR");
            let told = format!(
                "{:?}",
                image.layer_data.attributes.other.get(&exr::prelude::Text::from("indigo.denoised"))
            );
            let green = image.layer_data.channel_data.list.iter().find(|c| c.name.eq("G")).expect("green");
            (green.sample_data.values_as_f32().collect::<Vec<_>>(), told)
        };
        let (noisy, denoised) = (green(&format!("a_{kind}.exr")), green(&format!("a_denoised_{kind}.exr")));
        assert!(
            noisy.1 == "None" && denoised.1.contains("by Open Image Denoise"),
            "{} {}",
            noisy.1,
            denoised.1
        );
        for (i, v) in denoised.0.iter().enumerate() {
            let mirrored = noisy.0[i / 40 * 40 + 39 - i % 40];
            assert!(
                (v - mirrored).abs() <= 1e-5 * mirrored.abs() + 1e-6,
                "{kind}, pixel {i}: {v} {mirrored}"
            );
        }
    }
    let told = |name| bench.run(&["-dumpmetadata", name]).stdout.contains("denoised: by Open Image Denoise");
    assert!(told("a_denoised.png") && !told("a.png"));
    assert!(ran.stderr.contains("a_denoised.png") && !ran.stderr.contains("warning"), "{}", ran.stderr);
    let (noisy, denoised) = (codes(&bench, "a.png"), codes(&bench, "a_denoised.png"));
    let mirrored: Vec<u8> =
        noisy.chunks(3 * 40).flat_map(|row| row.chunks(3).rev().flatten().copied()).collect();
    assert!(
        noisy.iter().zip(&mirrored).any(|(a, b)| a.abs_diff(*b) > 8),
        "the scene must not be its own mirror image"
    );
    for (a, b) in mirrored.iter().zip(&denoised) {
        // From RGB to XYZ and back is right to rounding.
        assert!(a.abs_diff(*b) <= 1, "{a} {b}");
    }
    assert_eq!(
        bench.run(&["scene.igs", "-haltspp", "2", "-seed", "3", "-t", "1", "-o", "b.png"]).status,
        Some(0)
    );
    assert_eq!(codes(&bench, "b.png"), noisy, "the picture itself is as without denoising");
}

#[test]
fn without_the_library_the_picture_is_there_and_a_warning() {
    let bench = Workbench::new(QUIET);
    let nowhere = bench.path("nowhere.so");
    let ran =
        bench.run_with("INDIGO_OIDN", &nowhere, &["scene.igs", "-haltspp", "1", "-o", "a.png", "-denoise"]);
    assert_eq!(ran.status, Some(0), "{ran:?}");
    for part in ["warning: no denoised picture", "Open Image Denoise", "nowhere.so", "INDIGO_OIDN"] {
        assert!(ran.stderr.contains(part), "{part}: {}", ran.stderr);
    }
    assert!(bench.path("a.png").exists() && !bench.path("a_denoised.png").exists());
}

#[test]
fn layers_are_saved_where_they_are_asked_for() {
    let bench = Workbench::new(&format!("{QUIET}<save_layers_exr>true</save_layers_exr>"));
    let ran = bench.run(&["scene.igs", "-haltspp", "1", "-o", "a.png"]);
    assert_eq!(ran.status, Some(0), "{ran:?}");
    let bytes = std::fs::read(bench.path("a_layers.exr")).expect("the layers");
    for name in ["albedo.R", "normal.Z", "depth.Z", "object_id.X", "material_id.X"] {
        assert!(bytes.windows(name.len()).any(|w| w == name.as_bytes()), "{name}");
    }
}

/// Whatever samples the light: the ball covers the middle and nothing covers the corners, and the parts make up the whole.
#[test]
fn layers_are_told_apart_in_every_mode() {
    for mode in [
        "<metropolis>false</metropolis><bidirectional>false<",
        "<metropolis>false</metropolis><bidirectional>true<",
        "<metropolis>true</metropolis><bidirectional>false<",
        "<metropolis>false</metropolis><hybrid>true</hybrid><bidirectional>true<",
    ] {
        let bench = Workbench::new(&format!("{QUIET}<save_layers_exr>true</save_layers_exr>"));
        let text = std::fs::read_to_string(bench.path("scene.igs")).expect("the scene");
        let text = text.replace("<metropolis>false</metropolis><bidirectional>false<", mode);
        bench.write("scene.igs", &text);
        let ran = bench.run(&["scene.igs", "-haltspp", "1", "-o", "a.png"]);
        assert_eq!(ran.status, Some(0), "{ran:?}");
        let image =
            exr::prelude::read_first_flat_layer_from_file(bench.path("a_layers.exr")).expect("an EXR");
        let channel = |name: &str| -> Vec<f32> {
            let found = image.layer_data.channel_data.list.iter().find(|c| c.name.eq(name));
            found.unwrap_or_else(|| panic!("{name}")).sample_data.values_as_f32().collect()
        };
        let (middle, corner) = (15 * 40 + 20, 0);
        let alpha = channel("foreground.A");
        assert_eq!((alpha[middle], alpha[corner]), (1.0, 0.0), "{mode}");
        assert!(alpha.iter().any(|a| (0.1..0.9).contains(a)), "no edge is smooth");
        let names = ["G", "foreground.G", "background.G", "direct.G", "indirect.G"];
        let [whole, foreground, background, direct, indirect] = names.map(channel);
        assert!(foreground[corner] == 0.0 && background[middle] == 0.0, "{mode}");
        assert!(foreground[middle] > 0.0 && background[corner] > 0.0, "{mode}");
        for i in 0..whole.len() {
            let near = |a: f32| (a - whole[i]).abs() <= 1e-4 * whole[i].abs() + 1e-3;
            assert!(
                near(foreground[i] + background[i]) && near(direct[i] + indirect[i]),
                "{mode}, pixel {i}"
            );
        }
        for (key, json) in [("object_names", r#"{"1":"sphere"}"#), ("material_names", r#"{"1":"grey"}"#)] {
            let key = exr::prelude::Text::from(&*format!("indigo.{key}"));
            let told = format!("{:?}", image.layer_data.attributes.other.get(&key));
            assert!(told.replace('\\', "").contains(json), "{told}");
        }
    }
}

/// The library itself, where `cargo xtask test` could install it.
fn open_image_denoise() -> Option<PathBuf> {
    let python = std::env::var_os("INDIGO_TEST_PYTHON")?;
    let script = "import importlib.util as u; s = u.find_spec('pyoidn'); print(s.submodule_search_locations[0] if s else '')";
    let ran = Command::new(python).args(["-c", script]).output().expect("Python");
    let folder = String::from_utf8(ran.stdout).expect("a path");
    let library = PathBuf::from(folder.trim()).join("oidn/lib/libOpenImageDenoise.so.2");
    library.exists().then_some(library)
}

/// A few samples, denoised by the library itself, come closer to many samples.
#[test]
fn open_image_denoise_takes_noise_out() {
    let Some(library) = open_image_denoise() else { return };
    let bench = Workbench::new(&format!("{QUIET}<width>96</width><height>72</height>"));
    let text = std::fs::read_to_string(bench.path("scene.igs")).expect("the scene");
    // A small lamp makes noise.
    let from = text.find("<background>").expect("the background");
    let to = text.find("</background>").expect("its end") + "</background>".len();
    let lamp = "<sphere><center>0 0 -101</center><radius>100</radius><material_name>grey</material_name></sphere>\
        <rectanglelight><pos>-1.5 3 3</pos><width>1.5</width><height>1.5</height><spectrum><uniform><value>1e6</value></uniform></spectrum></rectanglelight>";
    let text = format!("{}{lamp}{}", &text[..from], &text[to..]);
    // Of one exposure, whatever the picture: by the mean of its logarithms noise would change all of it.
    let (from, to) = (text.find("<tonemapping>"), text.find("</tonemapping>"));
    let (from, to) = (from.expect("tone mapping"), to.expect("its end"));
    bench.write(
        "scene.igs",
        &format!("{}<tonemapping><linear><scale>3000</scale></linear>{}", &text[..from], &text[to..]),
    );
    let ran =
        bench.run_with("INDIGO_OIDN", &library, &["scene.igs", "-haltspp", "4", "-o", "a.png", "-denoise"]);
    assert_eq!(ran.status, Some(0), "{ran:?}");
    assert!(!ran.stderr.contains("warning"), "{}", ran.stderr);
    assert_eq!(bench.run(&["scene.igs", "-haltspp", "400", "-o", "clean.png"]).status, Some(0));
    let clean = codes(&bench, "clean.png");
    let error = |name: &str| {
        let squares = codes(&bench, name)
            .iter()
            .zip(&clean)
            .map(|(a, b)| f64::from(a.abs_diff(*b)).powi(2))
            .sum::<f64>();
        (squares / clean.len() as f64).sqrt()
    };
    let (noisy, denoised) = (error("a.png"), error("a_denoised.png"));
    assert!(noisy > 4.0, "there is no noise to take out: {noisy}");
    assert!(denoised < 0.5 * noisy, "{denoised} codes off after denoising, {noisy} before");
}
