//! The declarations themselves: complete, consistent, and documented.

use indigo_decl::codes::Code;
use indigo_decl::{
    Block, Element, Kind, Presence, Range, ResolveError, Resolved, Resolver, bind, reference, value,
};
use indigo_diag::{Sink, SourceMap};
use indigo_igs::{Limits, read_document, read_scene};
use indigo_scene::schema::{self, SCENE};
use std::collections::BTreeSet;

/// One file in memory, `scene.igs`.
struct One(String);

impl Resolver for One {
    fn read(&self, path: &str, _: &str) -> Result<Resolved, ResolveError> {
        if path != "scene.igs" {
            return Err(ResolveError::NotFound { looked: vec![path.to_owned()] });
        }
        Ok(Resolved { path: path.to_owned(), bytes: self.0.as_bytes().into() })
    }
}

fn read(text: &str, sink: &mut Sink) -> Option<Element> {
    let file = One(text.to_owned());
    read_document("scene.igs", &file, &mut SourceMap::default(), sink, &Limits::default())
}

#[test]
fn every_example_binds_without_a_diagnostic() {
    let mut examples = 0;
    for block in reference::blocks(&SCENE) {
        if block.example.is_empty() {
            continue;
        }
        let mut sink = Sink::new();
        let element = read(block.example, &mut sink).expect(block.name);
        bind(element, block, &mut sink);
        assert!(sink.diagnostics().is_empty(), "{}: {:?}", block.name, sink.diagnostics());
        examples += 1;
    }
    // All but the elements of an embedded mesh, which are shown in the example of `mesh`.
    assert_eq!(examples, reference::blocks(&SCENE).len() - 4);
}

#[test]
fn every_default_is_of_its_type_and_in_its_range() {
    for block in reference::blocks(&SCENE) {
        for field in block.fields {
            if let Presence::Default(text) = field.presence {
                assert_eq!(value::parse(field, text).1, None, "{} in {}", field.name, block.name);
            }
        }
    }
}

#[test]
fn tables_are_consistent() {
    for block in reference::blocks(&SCENE) {
        let fields = block.fields.iter().flat_map(|f| [f.name].into_iter().chain(f.aliases.iter().copied()));
        let alternatives = block.alternatives.iter().flat_map(|a| a.blocks.iter().map(|b| b.name));
        let later = block.later.iter().map(|l| l.name).chain(block.ignored.iter().copied());
        let names: Vec<&str> = fields.chain(alternatives).chain(later).collect();
        let distinct: BTreeSet<&str> = names.iter().copied().collect();
        assert_eq!(names.len(), distinct.len(), "{}: a name stands for two things", block.name);
        for name in block.needs.iter().flat_map(|g| g.fields) {
            assert!(block.fields.iter().any(|f| f.name == *name), "{}: no field {name}", block.name);
        }
        assert!(block.doc.ends_with('.'), "{}: {}", block.name, block.doc);
        for field in block.fields {
            assert!(field.doc.ends_with('.'), "{} in {}: {}", field.name, block.name, field.doc);
        }
    }
}

/// Every element that the manual of version 1.0 describes, by the way that leads to it.
const MANUAL: &str = "
renderer_settings/ width height bih_tri_threshold metropolis large_mutation_prob max_change max_depth
    max_num_consec_rejections logging bidirectional save_untonemapped_exr save_tonemapped_exr save_igi
    image_save_period halt_time halt_samples_per_pixel hybrid frame_upload_period auto_choose_num_threads
    num_threads super_sample_factor display_period ray_origin_nudge_distance watermark cache_trees
    aperture_diffraction post_process_diffraction render_region render_foreground_alpha splat_filter
    downsize_filter
render_region/ x1 y1 x2 y2
splat_filter/ box gaussian mn_cubic
downsize_filter/ box gaussian mn_cubic
mn_cubic/ blur ring
background/ spectrum
skylight/ sundir turbidity extra_atmospheric
env_map/ latlong spherical
latlong/ path gain
spherical/ path width gain
tonemapping/ linear reinhard camera
linear/ scale
reinhard/ pre_scale post_scale burn
camera/ response_function_path ev_adjust film_iso
camera/ pos up forwards aperture_radius focus_distance aspect_ratio sensor_width lens_sensor_dist white_balance
    exposure_duration autofocus bloom obstacle_map aperture_shape
bloom/ weight radius
aperture_shape/ circular image generated
image/ path
generated/ num_blades start_angle blade_offset blade_curvature_radius
texture/ uv_set path exponent a b c
material/ name diffuse specular phong glossy_transparent diffuse_transmitter blend null_material oren_nayar
diffuse/ albedo_spectrum colour albedo_texture bump_map
specular/ internal_medium_name transparent bump_map
phong/ diffuse_albedo_spectrum diffuse ior exponent nk_data specular_reflectivity_spectrum albedo_texture
    bump_map exponent_map
glossy_transparent/ internal_medium_name exponent bump_map
diffuse_transmitter/ albedo_spectrum colour albedo_texture
blend/ blend_factor a_name b_name blend_map
oren_nayar/ sigma albedo_spectrum albedo_texture bump_map
medium/ name precedence basic epidermis dermis
epidermis/ melanin_fraction melanin_type_blend
dermis/ hemoglobin_fraction
basic/ ior cauchy_b_coeff absorption_coefficient_spectrum subsurface_scattering
subsurface_scattering/ scattering_coefficient_spectrum phase_function
phase_function/ uniform henyey_greenstein
henyey_greenstein/ g_spectrum
spectrum/ peak blackbody rgb uniform regular_tabulated
peak/ peak_min peak_width base_value peak_value
blackbody/ temperature gain
rgb/ rgb gamma
uniform/ value
regular_tabulated/ start_wavelength end_wavelength num_values values
rectanglelight/ pos width height spectrum efficacy_scale
efficacy_scale/ power_drawn overall_luminous_efficacy
exit_portal/ pos scale rotation mesh_name
rotation/ matrix
meshlight/ pos scale rotation mesh_name spectrum efficacy_scale texture ies_profile
ies_profile/ path
mesh/ name scale path normal_smoothing external embedded
external/ path
embedded/ expose_uv_set vertex triangle_set
expose_uv_set/ index name
vertex/ pos normal uv0 uv1 uv2 uv3
triangle_set/ material_name tri
model/ pos scale rotation mesh_name
plane/ normal dist material_name
sphere/ center radius material_name
include/ pathname
scene/ renderer_settings background skylight env_map tonemapping camera material medium rectanglelight
    exit_portal meshlight mesh model plane sphere include
";

/// Everything that may stand in a block or a field, as pairs of parent and child.
fn pairs() -> BTreeSet<(&'static str, &'static str)> {
    let mut pairs = BTreeSet::new();
    for block in reference::blocks(&SCENE) {
        let blocks = block.alternatives.iter().flat_map(|a| a.blocks).map(|b| b.name);
        pairs.extend(block.fields.iter().map(|f| f.name).chain(blocks).map(|child| (block.name, child)));
        for field in block.fields {
            if let Kind::OneOf(a) = field.kind {
                pairs.extend(a.blocks.iter().map(|b| (field.name, b.name)));
            }
        }
    }
    pairs
}

#[test]
fn every_element_of_the_manual_is_declared() {
    let pairs = pairs();
    let mut parent = "";
    let mut checked = 0;
    for word in MANUAL.split_whitespace() {
        match word.strip_suffix('/') {
            Some(name) => parent = name,
            None => {
                assert!(pairs.contains(&(parent, word)), "<{word}> in <{parent}>");
                checked += 1;
            }
        }
    }
    assert_eq!(checked, 236);
}

/// What the manual says of the numbers of each element, in its order: `>` and `>=` a number, or both ends. Where a
/// declaration is wider (`max_depth` 0 is what shines straight into the lens) or narrower (see its text), the
/// declaration's own stands here.
const RESTRICTIONS: &str = "
renderer_settings: width >0, height >0, bih_tri_threshold >0, large_mutation_prob 0..1, max_change 0..1, max_depth >=0,
    max_num_consec_rejections >0, image_save_period >0, frame_upload_period >0, num_threads 1..1024,
    super_sample_factor >0, display_period >0, ray_origin_nudge_distance >=0
render_region: x1 >=0, y1 >=0, x2 >0, y2 >0
skylight: turbidity >0
latlong: gain >0
spherical: width >0, gain >0
linear: scale >=0
reinhard: pre_scale >=0, post_scale >=0, burn >1
camera in tonemapping: film_iso >0
camera: aperture_radius >0, focus_distance >0, aspect_ratio 0.001..1000, sensor_width >0, lens_sensor_dist >0,
    exposure_duration >0
bloom: weight >=0, radius >=0
generated: num_blades >=3, blade_offset >0, blade_curvature_radius >0
texture: exponent >0
phong: ior >=1, exponent >0
glossy_transparent: exponent >0
blend: blend_factor 0..1
oren_nayar: sigma 0..1
medium: precedence >1
epidermis: melanin_fraction 0..1, melanin_type_blend 0..1
dermis: hemoglobin_fraction 0..1
basic: ior >=1, cauchy_b_coeff >=0
peak: peak_min >=0, peak_width >0
blackbody: temperature >0, gain >0
rgb: gamma >0
regular_tabulated: start_wavelength >=0, end_wavelength >=0, num_values >=2
rectanglelight: width >0, height >0
efficacy_scale: power_drawn >0, overall_luminous_efficacy >0
exit_portal: scale >0
meshlight: scale >0
model: scale >0
mesh: scale >0
sphere: radius >0";

#[test]
fn every_restriction_of_the_manual_is_declared() {
    let blocks = reference::blocks(&SCENE);
    let mut checked = 0;
    for line in RESTRICTIONS.replace(",\n", ",").lines().filter(|l| !l.is_empty()) {
        let (block, fields) = line.split_once(':').expect("a block");
        let tone_mapping = block.strip_suffix(" in tonemapping");
        for field in fields.split(',') {
            let (name, range) = field.trim().split_once(' ').expect("a field and its range");
            let number = |text: &str| text.parse::<f64>().expect("a number");
            let expected = match (range.strip_prefix(">="), range.strip_prefix('>'), range.split_once("..")) {
                (Some(lo), ..) => Range::AtLeast(number(lo)),
                (None, Some(lo), _) => Range::Above(number(lo)),
                (.., Some((lo, hi))) => Range::Within(number(lo), number(hi)),
                _ => panic!("{range}"),
            };
            let has = |b: &&&Block| {
                b.name == tone_mapping.unwrap_or(block) && b.fields.iter().any(|f| f.name == name)
            };
            let found = blocks.iter().find(has).unwrap_or_else(|| panic!("{block} {name}"));
            let declared = found.fields.iter().find(|f| f.name == name).map(|f| f.range);
            assert_eq!(declared, Some(expected), "{block} {name}");
            checked += 1;
        }
    }
    assert_eq!(checked, 66);
}

fn check_codes(all: &[Code]) {
    for code in all.iter().filter(|c| !c.example.starts_with('(') && !c.example.is_empty()) {
        let whole = code.example.starts_with("<?") || code.example.starts_with("<!");
        let text = if whole {
            format!("{}<scene></scene>", code.example)
        } else {
            format!("<scene>{}</scene>", code.example)
        };
        let (mut sink, mut sources) = (Sink::new(), SourceMap::default());
        let root = read_scene("scene.igs", &One(text), &mut sources, &mut sink, &Limits::default());
        if let Some(root) = root {
            bind_inside(root, &mut sink);
        }
        let found: Vec<&str> = sink.diagnostics().iter().map(|d| d.code).collect();
        assert!(found.contains(&code.code), "{}: {found:?}", code.code);
    }
}

/// Binds a scene whose elements may be of any place in the format.
fn bind_inside(root: Element, sink: &mut Sink) {
    let all = reference::blocks(&SCENE);
    let (known, inner): (Vec<_>, Vec<_>) =
        root.children.into_iter().partition(|c| SCENE.fields.iter().any(|f| f.is_called(&c.name)));
    let block_of = |name: &str| -> Option<&'static Block> { all.iter().find(|b| b.is_called(name)).copied() };
    let mut top = Element::new("scene", root.span);
    for child in inner {
        match block_of(&child.name) {
            Some(block) => drop(bind(child, block, sink)),
            None => top.children.push(child),
        }
    }
    top.children.extend(known);
    bind(top, &SCENE, sink);
}

#[test]
fn examples_of_codes_have_the_fault_they_show() {
    check_codes(indigo_igs::codes::ALL);
    check_codes(indigo_decl::codes::ALL);
}

#[test]
fn codes_are_distinct() {
    let lists = [indigo_igs::codes::ALL, indigo_decl::codes::ALL, indigo_scene::codes::ALL];
    let all: Vec<&str> = lists.concat().iter().map(|c| c.code).collect();
    let distinct: BTreeSet<&str> = all.iter().copied().collect();
    assert_eq!(all.len(), distinct.len());
    let errors = schema::errors();
    for code in all {
        assert!(errors.contains(&format!("| {code} |")), "{code}");
    }
}

#[test]
fn the_reference_names_every_element_once() {
    let text = schema::reference();
    let headings: Vec<&str> = text.lines().filter(|l| l.starts_with("## ")).collect();
    let distinct: BTreeSet<&str> = headings.iter().copied().collect();
    assert_eq!(headings.len(), distinct.len(), "two sections have the same heading");
    let links = text.split("](#").skip(1).map(|rest| rest.split(')').next().unwrap_or_default());
    for link in links {
        let heading = format!("## {}", link.replace("-in-", " in "));
        assert!(distinct.contains(&*heading), "no section {heading}");
    }
}

#[test]
fn the_manual_is_up_to_date() {
    let pages = [("scene-format.md", schema::reference()), ("errors.md", schema::errors())];
    for (name, text) in pages {
        let path = format!("{}/../../docs/manual/{name}", env!("CARGO_MANIFEST_DIR"));
        let written = std::fs::read_to_string(path).expect(name).replace('\r', "");
        assert!(written == text, "docs/manual/{name} is stale: run `cargo xtask gen`");
    }
}
