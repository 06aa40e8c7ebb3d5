//! Damaged scenes: no panic, places for all errors, bounded time and memory.

use indigo_camera::declare::CAMERA;
use indigo_decl::{Block, ResolveError, Resolved, Resolver, reference};
use indigo_diag::{Severity, Sink, Style, to_text};
use indigo_light::kinds::mesh;
use indigo_math::rng::{Rng, key};
use indigo_scene::schema::geometry::{MATERIALS, MODEL};
use indigo_scene::schema::settings::RENDERER_SETTINGS;
use indigo_scene::schema::{SCENE, emission, tonemapping};
use indigo_scene::{LoadOptions, Loaded, Stop, load};
use indigo_texture::declare::{SPHERICAL, TEX_COORD_GENERATION};
use std::time::{Duration, Instant};

struct One(Vec<u8>);

impl Resolver for One {
    fn read(&self, path: &str, _: &str) -> Result<Resolved, ResolveError> {
        match path {
            "scene.igs" => Ok(Resolved { path: path.to_owned(), bytes: self.0.as_slice().into() }),
            "materials.igs" => {
                Ok(Resolved { path: path.to_owned(), bytes: b"<scenedata/>".as_slice().into() })
            }
            _ => Err(ResolveError::NotFound { looked: vec![path.to_owned()] }),
        }
    }
}

/// Loads, but builds no trees; returns what was found, rendered, and the number of errors.
fn check(bytes: Vec<u8>) -> (Vec<String>, usize) {
    let one = One(bytes);
    let options = LoadOptions { check_only: true, ..LoadOptions::new(&one) };
    let started = Instant::now();
    let Loaded { sources, sink, .. } = load("scene.igs", &options);
    // Milliseconds where nothing else runs.
    assert!(started.elapsed() < Duration::from_secs(10), "{:?}", started.elapsed());
    for d in sink.diagnostics().iter().filter(|d| d.severity == Severity::Error) {
        let span = d.span.unwrap_or_else(|| panic!("every error of a file has a place: {}", d.message));
        let position = sources.position(span);
        assert!(position.line >= 1 && position.column >= 1);
        assert!((span.start as usize) <= sources.text(span.source).len());
    }
    let text = sink.diagnostics().iter().map(|d| to_text(d, &sources, Style::Plain)).collect();
    (text, sink.error_count())
}

#[test]
fn nothing_more_is_read_of_a_scene_that_is_not_wanted() {
    let one = One(b"<scene><nonsense/></scene>".to_vec());
    let stop = Stop::default();
    let load = || load("scene.igs", &LoadOptions { stop: Some(&stop), ..LoadOptions::new(&one) });
    assert!(load().settings.is_some());
    stop.set();
    let stopped = load();
    assert!(stopped.settings.is_none() && stopped.sink.diagnostics().is_empty());
}

/// An example with one more child.
fn with_child(parent: &Block, child: &str) -> String {
    let end = format!("</{}>", parent.name);
    let whole = parent.example.strip_suffix(end.as_str()).expect(parent.name);
    format!("{whole}{child}{end}")
}

fn is_one_of(block: &Block, blocks: &[&Block]) -> bool {
    blocks.iter().any(|b| std::ptr::eq(*b, block))
}

/// The example of a block, within what it needs around it to stand in a scene.
fn in_a_scene(block: &Block) -> Option<String> {
    let (name, example) = (block.name, block.example);
    if is_one_of(block, indigo_scatter::materials::MATERIAL_KIND.blocks) {
        return Some(format!("<material><name>{name}</name>{example}</material>"));
    }
    if is_one_of(block, indigo_scatter::media::KINDS) {
        return Some(format!("<medium><name>{name}</name>{example}</medium>"));
    }
    if is_one_of(block, indigo_spectrum::declare::SPECTRUM.blocks) {
        return Some(format!("<background><spectrum>{example}</spectrum></background>"));
    }
    if is_one_of(block, tonemapping::TONEMAPPING.alternatives.expect("tone mappings").blocks) {
        return Some(format!("<tonemapping>{example}</tonemapping>"));
    }
    if is_one_of(block, &[&emission::IES_PROFILE, &emission::EMISSION_SCALE, &MATERIALS]) {
        return Some(with_child(&MODEL, example));
    }
    if is_one_of(block, &[&TEX_COORD_GENERATION, &SPHERICAL]) {
        let generation = example.replace("<spherical>", "<tex_coord_generation><spherical>");
        let generation = generation.replace("</spherical>", "</spherical></tex_coord_generation>");
        return Some(format!(
            "<material><name>g</name><diffuse><albedo_texture><path>a.png</path>{generation}</albedo_texture></diffuse></material>"
        ));
    }
    Some(match name {
        "scene" => return None,
        _ if SCENE.fields.iter().any(|f| f.name == name) => example.to_owned(),
        "external" => format!("<mesh><name>e</name>{example}</mesh>"),
        "latlong" => format!("<env_map>{example}</env_map>"),
        "texture" => format!("<material><name>t</name><diffuse>{example}</diffuse></material>"),
        "aperture_shape" | "bloom" | "keyframe" | "white_point" => with_child(&CAMERA, example),
        "circular" | "image" | "generated" => {
            with_child(&CAMERA, &format!("<aperture_shape>{example}</aperture_shape>"))
        }
        "render_region" | "layer_setting" => with_child(&RENDERER_SETTINGS, example),
        "box" => with_child(&RENDERER_SETTINGS, &format!("<splat_filter>{example}</splat_filter>")),
        "ies_profile" => with_child(&mesh::BLOCK, example),
        _ => return None,
    })
}

/// A scene in which every element of the format stands.
fn everything() -> String {
    let parts: Vec<String> = reference::blocks(&SCENE).into_iter().filter_map(in_a_scene).collect();
    format!("<?xml version=\"1.0\" encoding=\"utf-8\"?>\n<scene>\n{}\n</scene>\n", parts.join("\n"))
}

#[test]
fn the_scene_to_be_damaged_is_whole_and_has_every_element() {
    let scene = everything();
    let (found, _) = check(scene.clone().into_bytes());
    // It names files that are not there and things that it does not define, but is well formed: binding is silent.
    let well_formed = |text: &&String| ["[E01", "[E00", "[E02"].iter().any(|code| text.contains(code));
    let faults: Vec<&String> =
        found.iter().filter(well_formed).filter(|text| !text.contains("[E0205]")).collect();
    assert!(faults.is_empty(), "{faults:#?}");
    for block in reference::blocks(&SCENE).into_iter().filter(|b| b.name != "texture") {
        let there = [block.name].iter().chain(block.aliases).any(|n| scene.contains(&format!("<{n}")));
        assert!(there, "<{}>", block.name);
    }
    assert!(scene.contains("<albedo_texture>"));
}

/// One way to damage a file.
fn damage(bytes: &mut Vec<u8>, rng: &mut Rng) {
    if bytes.is_empty() {
        return;
    }
    let start = rng.below(bytes.len());
    let end = (start + 1 + rng.below(60)).min(bytes.len());
    match rng.below(6) {
        0 => bytes[start] ^= 1 << rng.below(8),
        1 => bytes.truncate(start),
        2 => drop(bytes.drain(start..end)),
        3 => {
            let piece = bytes[start..end].to_vec();
            let to = rng.below(bytes.len());
            bytes.splice(to..to, piece);
        }
        4 => bytes[start] = b"<>&\"'/=! -.0\xFF\0"[rng.below(14)],
        _ => bytes.swap(start, end - 1),
    }
}

#[test]
fn two_hundred_damaged_scenes() {
    let whole = everything().into_bytes();
    let mut rng = Rng::new(key(&[2008]));
    let (undamaged, _) = check(whole.clone());
    let mut noticed = 0;
    for _ in 0..200 {
        let mut bytes = whole.clone();
        for _ in 0..=rng.below(4) {
            damage(&mut bytes, &mut rng);
        }
        let (found, _) = check(bytes);
        assert!(found.len() <= Sink::LIMIT);
        noticed += usize::from(found != undamaged);
    }
    // Some damage falls into a comment, a name or a digit and is no fault.
    assert!(noticed > 120, "{noticed}");
}
