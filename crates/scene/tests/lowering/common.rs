//! Scenes in memory, and what lowering says about them.

use indigo_decl::{ResolveError, Resolved, Resolver};
use indigo_imaging::png::Depth;
use indigo_scene::{LoadOptions, Loaded, load};

/// A scene, and beside it a broken mesh, a broken picture and settings.
pub struct Memory(pub String);

impl Resolver for Memory {
    fn read(&self, path: &str, _from: &str) -> Result<Resolved, ResolveError> {
        let bytes: &[u8] = match path {
            "scene.igs" => self.0.as_bytes(),
            "broken.obj" => b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n",
            "flat.obj" => b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 1 1\n",
            "broken.png" => b"not a picture",
            "no_numbers.exr" => return Ok(no_numbers(path)),
            "tiny.png" => return Ok(picture(path, [4, 4], |_| 0.0)),
            "grey.png" => return Ok(picture(path, [4, 4], |_| 0.5)),
            "dusty.png" => return Ok(picture(path, [4, 4], |i| if i == 5 { 0.0 } else { 1.0 })),
            "glass.tga" => return Ok(half_clear(path)),
            "oblong.png" => return Ok(picture(path, [1024, 512], |_| 0.0)),
            "odd.png" => return Ok(picture(path, [600, 600], |_| 0.0)),
            "black.png" => return Ok(picture(path, [512, 512], |_| 0.0)),
            "ultraviolet.nk" => b"4 100 200 1\n1 2\n1 2\n",
            "blue.nk" => b"4 350 500 1\n1 2\n1 2\n",
            "green.nk" => b"4 500 550 1\n1 2\n1 2\n",
            "noted.nk" => b"4 380 780 1\n1 2\n1 2\n\nby hand\n",
            "nkdata/au.nk" => b"4 380 780 1\n1 2\n1 2\n",
            "whole.nk" => b"\xef\xbb\xbf4 380 780 1\n1 2\n1 2\n",
            "inifile.xml" => {
                b"<settings><width>40</width><height>30</height><max_depth>7</max_depth></settings>"
            }
            _ => return Err(ResolveError::NotFound { looked: vec![path.to_owned()] }),
        };
        Ok(Resolved { path: path.to_owned(), bytes: bytes.into() })
    }
}

/// A grey PNG whose texels are told by their numbers.
fn picture(path: &str, [width, height]: [u32; 2], texel: impl Fn(u32) -> f32) -> Resolved {
    let pixels = (0..width * height).map(|i| [texel(i); 4]).collect();
    let picture = indigo_imaging::Picture { width, height, pixels };
    let bytes = indigo_imaging::png::encode(&picture, &indigo_imaging::Metadata::default(), Depth::Eight);
    Resolved { path: path.to_owned(), bytes: bytes.expect("a picture with pixels").into() }
}

/// A TGA of one texel of 32 bits, half transparent.
fn half_clear(path: &str) -> Resolved {
    let header = [0, 0, 2, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 1, 0, 32, 8];
    Resolved { path: path.to_owned(), bytes: [&header[..], &[10, 20, 30, 128]].concat().into() }
}

/// An EXR of two texels, one of which is NaN, a number and infinite.
fn no_numbers(path: &str) -> Resolved {
    let pixels = vec![[f32::NAN, 0.5, f32::INFINITY, 1.0], [0.25, 0.5, 0.75, 1.0]];
    let image = indigo_imaging::LinearImage { width: 2, height: 1, pixels };
    let bytes = indigo_imaging::exr::encode(&image, &indigo_imaging::Metadata::default());
    Resolved { path: path.to_owned(), bytes: bytes.expect("a picture with pixels").into() }
}

/// The first lines of every scene here: complete, and without a complaint.
pub const HEAD: &str = "<scene>
<renderer_settings><width>64</width><height>48</height><bidirectional>false</bidirectional><metropolis>false</metropolis><aperture_diffraction>false</aperture_diffraction></renderer_settings>
<tonemapping><linear><scale>1</scale></linear></tonemapping>
<background><spectrum><uniform><value>1</value></uniform></spectrum></background>
<material><name>white</name><diffuse><albedo_spectrum><uniform><value>0.5</value></uniform></albedo_spectrum></diffuse></material>
";
pub const CAMERA: &str = "<camera><pos>0 -2 1</pos><up>0 0 1</up><forwards>0 1 0</forwards><aperture_radius>0.001</aperture_radius><focus_distance>3</focus_distance><aspect_ratio>1.3333</aspect_ratio><sensor_width>0.036</sensor_width><lens_sensor_dist>0.02</lens_sensor_dist></camera>\n";
pub const MESH: &str = "<mesh><name>tri</name><embedded><vertex pos=\"0 0 0\"/><vertex pos=\"1 0 0\"/><vertex pos=\"0 1 0\"/><triangle_set><material_name>white</material_name><tri>0 1 2</tri></triangle_set></embedded></mesh>\n";
/// The line after `HEAD`.
pub const LINE: usize = 6;

pub fn options(resolver: &Memory) -> LoadOptions<'_> {
    LoadOptions::new(resolver)
}

pub fn loaded(text: &str) -> Loaded {
    let memory = Memory(text.to_owned());
    load("scene.igs", &options(&memory))
}

/// Codes with line and column of everything found in `HEAD` + `rest`.
pub fn found(rest: &str) -> Vec<String> {
    let l = loaded(&format!("{HEAD}{rest}</scene>"));
    l.sink
        .diagnostics()
        .iter()
        .map(|d| {
            let place = d.span.map(|s| l.sources.position(s));
            place.map_or_else(|| d.code.to_owned(), |p| format!("{}:{}:{}", p.line, p.column, d.code))
        })
        .collect()
}

/// All that is said of `HEAD` + `rest`, and what was expected.
pub fn said(rest: &str) -> Vec<(String, Option<String>)> {
    let loaded = loaded(&format!("{HEAD}{rest}</scene>"));
    loaded.sink.diagnostics().iter().map(|d| (d.message.clone(), d.label.clone())).collect()
}

/// Expects exactly one finding in a line after the head, at the text `at`, with a code.
pub fn expect_one(line: &str, at: &str, code: &str) {
    let column = line.find(at).expect("the text is in the line") + 1;
    assert_eq!(found(&format!("{line}\n{CAMERA}{MESH}")), [format!("{LINE}:{column}:{code}")], "{line}");
}
