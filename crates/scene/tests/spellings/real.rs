//! Files shaped as exporters have written them: by 3ds Max of 2008, a material library, a material preview, and by
//! Blender today.

use super::common::*;
use indigo_decl::{ResolveError, Resolved, Resolver};
use indigo_scene::{LoadOptions, Loaded, load, load_canonical};
use std::fmt::Write as _;

/// Files by their last parts, as a disk finds those that absolute paths of another machine lead to.
struct Folder(Vec<(&'static str, Vec<u8>)>);

impl Resolver for Folder {
    fn read(&self, path: &str, _from: &str) -> Result<Resolved, ResolveError> {
        let last = path.rsplit(['/', '\\']).next().unwrap_or_default();
        let found = self.0.iter().find(|(name, _)| name.eq_ignore_ascii_case(last));
        let (name, bytes) = found.ok_or_else(|| ResolveError::NotFound { looked: vec![path.to_owned()] })?;
        Ok(Resolved { path: (*name).to_owned(), bytes: bytes.clone().into() })
    }
}

fn loaded(files: Vec<(&'static str, Vec<u8>)>) -> Loaded {
    let first = files[0].0;
    load(first, &LoadOptions::new(&Folder(files)))
}

#[track_caller]
fn assert_found(loaded: &Loaded, expected: &[&str]) {
    let found = findings(loaded);
    let matches =
        found.len() == expected.len() && found.iter().zip(expected).all(|((_, f), e)| f.starts_with(e));
    assert!(matches && loaded.scene.is_some(), "{found:#?}");
}

fn words(values: &[u32]) -> Vec<u8> {
    values.iter().flat_map(|v| v.to_le_bytes()).collect()
}

fn floats(values: &[f32]) -> Vec<u8> {
    values.iter().flat_map(|v| v.to_le_bytes()).collect()
}

/// A square of a version of the format, as two triangles or (from version 2 on) one quadrilateral, of one material.
fn igmesh(version: u32, material: &str) -> Vec<u8> {
    let mut bytes = words(&[5_456_751, version]);
    bytes.extend(words(&[1, 1, material.len() as u32]));
    bytes.extend(material.as_bytes());
    if version == 1 {
        bytes.extend(words(&[1, 8]));
        bytes.extend(b"channel1");
        bytes.extend(words(&[0]));
    } else {
        bytes.extend(words(&[0]));
    }
    bytes.extend(words(&[4]));
    bytes.extend(floats(&[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 1.0, 0.0]));
    bytes.extend(words(&[0]));
    if version >= 3 {
        bytes.extend(words(&[1]));
    }
    bytes.extend(words(&[1]));
    bytes.extend(floats(&[0.25, 0.5]));
    if version == 1 {
        bytes.extend(words(&[2, 0, 1, 2, 0, 0, 0, 0, 0, 2, 3, 0, 0, 0, 0]));
    } else {
        bytes.extend(words(&[0, 1, 0, 1, 2, 3, 0, 0, 0, 0, 0]));
    }
    bytes
}

#[test]
fn a_max_scene_with_pseudo_comments_windows_paths_and_many_instances() {
    let main = "<?xml version=\"1.0\" encoding=\"utf-8\" ?>
<!====== INDIGO SCENE ======>
<!====== RENDER SETTINGS ======>
<scene>
<!====== CAMERA ======>
<tonemapping><camera><response_function_path></response_function_path><ev_adjust>0.000000</ev_adjust><film_iso>100</film_iso></camera></tonemapping>
<camera><pos>0 -2 1</pos><up>0 0 1</up><forwards>0 1 -0.00000</forwards><forwards>0 1 0</forwards><aperture_radius>1e-003</aperture_radius><focus_distance>3</focus_distance><aspect_ratio>1.3333</aspect_ratio><sensor_width>0.036</sensor_width><lens_sensor_dist>0.02</lens_sensor_dist><white_balance>D65</white_balance><exposure_duration>0.0333</exposure_duration></camera>
<skylight><sundir>0 0.6 1</sundir><turbidity>2</turbidity></skylight>
<include><pathname>geometry.igs</pathname></include>
<include><pathname>N:\\work/..\\materials.igs</pathname></include>
</scene>";
    let mut geometry = String::from(
        "<scenedata><mesh><name>leaf</name><normal_smoothing>false</normal_smoothing><external><path>N:/..\\trees\\Leaf.igmesh</path></external></mesh>",
    );
    for i in 0..15_000 {
        let (x, y) = (i % 120, i / 120);
        let _ = write!(
            geometry,
            "<model><pos>{x}.000000 {y}.000000 -0.00000</pos><scale>1.0</scale><rotation><matrix>1 0 0 0 1 0 0 0 1 </matrix></rotation><mesh_name>leaf</mesh_name></model>"
        );
    }
    geometry.push_str("</scenedata>");
    let materials = "<scenedata><material><name>Leaf Mat #12</name><phong><diffuse_albedo_spectrum><rgb>
 <rgb>
  0.4 0.5 0.4
 </rgb><gamma>2.2</gamma></rgb></diffuse_albedo_spectrum><ior>1.5</ior><exponent><constant>
 2000
 </constant></exponent><nk_data></nk_data></phong></material></scenedata>";
    let files = vec![
        ("scene.igs", main.as_bytes().to_vec()),
        ("geometry.igs", geometry.into_bytes()),
        ("materials.igs", materials.as_bytes().to_vec()),
        ("leaf.igmesh", igmesh(1, "Leaf Mat #12")),
    ];
    let found = loaded(files.clone());
    assert_found(&found, &["W0103 <forwards> is given more than once"]);
    let scene = found.scene.expect("a scene");
    assert_eq!(scene.stats().objects, 15_000);
    assert_eq!(scene.names.materials, ["Leaf Mat #12"]);
    // Written anew it is one file, of which there is nothing to be told, and the same scene.
    let mesh = files[3].clone();
    let title = "A scene of 3ds Max";
    let written =
        load_canonical("scene.igs", &LoadOptions::new(&Folder(files)), title, &|file| file.written.into());
    let text = written.text.expect("a scene without errors");
    let again = loaded(vec![("scene.igs", text.into_bytes()), mesh]);
    assert_found(&again, &[]);
    let again = again.scene.expect("a scene");
    assert!(dump(&again) == dump(&scene), "written anew it differs");
}

#[test]
fn a_material_library_with_a_mark_of_byte_order_and_quoted_text() {
    let mut library = b"\xEF\xBB\xBF".to_vec();
    library.extend(
        "<?xml version=\"1.0\" encoding=\"utf-8\"?>
<scenedata>
 <material>
  <uid>3</uid>
  <name><![CDATA[wall \u{20ac} <old>]]></name>
  <diffuse>
   <texture><path><![CDATA[maps\\a.bmp]]></path><exponent>2.2</exponent><a>0</a><b>1</b><c>0</c></texture>
   <albedo><texture><texture_index>0</texture_index></texture></albedo>
  </diffuse>
 </material>
</scenedata>"
            .as_bytes(),
    );
    let scene = format!(
        "<scene>{TONES}{CAMERA}{LIGHT}<include><pathname>library\\wall.igm</pathname><offset_uids>true</offset_uids></include><include><pathname>library\\wall.igm</pathname></include><mesh><name>m</name><external><path>m.igmesh</path></external></mesh><model2><pos>0 0 0</pos><geometry_uid>1</geometry_uid><materials><material_uid>3</material_uid></materials></model2></scene>"
    );
    let mesh = scene.replace("<name>m</name>", "<uid>1</uid><name>m</name>");
    let files = vec![
        ("scene.igs", mesh.into_bytes()),
        ("wall.igm", library),
        ("m.igmesh", igmesh(3, "nobody")),
        ("a.bmp", bmp([[0, 60, 120], [200, 220, 240]])),
    ];
    let loaded = loaded(files);
    // Both have the same name, but only one has the uid.
    assert_found(&loaded, &["W0302 material wall"]);
    let scene = loaded.scene.expect("a scene");
    assert_eq!((&*scene.names.materials[0], scene.textures.len()), ("wall \u{20ac} <old>", 1));
}

/// What every scene here has.
const TONES: &str = "<tonemapping><reinhard><pre_scale>4</pre_scale><post_scale>1.2</post_scale><burn>6</burn></reinhard></tonemapping>";

/// As the exporter of today writes: models in a file of their own, and everything else of section 13 of the notes.
#[test]
fn a_scene_of_todays_blender_exporter() {
    let main = format!("<?xml version=\"1.0\" encoding=\"utf-8\"?><scene>
<renderer_settings>
 <width>288</width><height>216</height><super_sample_factor>2</super_sample_factor>
 <splat_filter><fastbox/></splat_filter>
 <downsize_filter><mn_cubic><blur>1</blur><ring>0</ring><radius>1.65</radius></mn_cubic></downsize_filter>
 <vignetting>true</vignetting><metropolis>false</metropolis><bidirectional>true</bidirectional>
 <layer_setting><name>default</name><enabled>true</enabled><layer_scale><rgb><rgb>1 1 1</rgb><gain>1</gain></rgb></layer_scale></layer_setting>
 <layer_setting><name>lamps</name><enabled>true</enabled><layer_scale><xyz><xyz>0.95 1 1.09</xyz><gain>0.5</gain></xyz></layer_scale></layer_setting>
</renderer_settings>{TONES}
<camera>
 <up>0 0 2</up><forwards>0 1.5 0</forwards>
 <keyframe><time>0</time><pos>0 -4 1</pos><rotation_quaternion><axis>1 0 0</axis><angle>-0.0</angle></rotation_quaternion></keyframe>
 <keyframe><time>5.208</time><pos>0 -4 1</pos><rotation_quaternion><axis>1 0 0</axis><angle>-0.0</angle></rotation_quaternion></keyframe>
 <aperture_radius>0.001</aperture_radius><focus_distance>10</focus_distance><autofocus/><aspect_ratio>1.3333</aspect_ratio>
 <sensor_width>0.036</sensor_width><lens_sensor_dist>0.035</lens_sensor_dist><white_balance>E</white_balance>
 <exposure_duration>0.008</exposure_duration><camera_type>thin-lens-perspective</camera_type>
 <lens_shift_up_distance>0</lens_shift_up_distance><lens_shift_right_distance>0</lens_shift_right_distance>
</camera>
<include><pathname>models.igs</pathname></include>
<include><pathname>glass.igm</pathname><offset_uids>false</offset_uids></include>
<material><name>wood</name><phong>
 <texture><uv_set_index>0</uv_set_index><path>a.bmp</path><exponent>2.2</exponent><tex_coord_generation><uv/></tex_coord_generation></texture>
 <ior>1.5</ior><nk_data></nk_data><roughness><constant>0.2</constant></roughness><fresnel_scale><constant>1</constant></fresnel_scale>
 <diffuse_albedo><texture><texture_index>0</texture_index></texture></diffuse_albedo>
 <backface_emit>false</backface_emit><emission_sampling_factor>1</emission_sampling_factor>
</phong></material>
<material><name>lamp</name><diffuse>
 <albedo><constant><uniform><value>0.8</value></uniform></constant></albedo>
 <base_emission><constant><uniform><value>1e10</value></uniform></constant></base_emission>
 <emission><constant><blackbody><temperature>3000</temperature><gain>1</gain></blackbody></constant></emission>
 <layer>1</layer></diffuse></material>
<background_settings>
 <background_material><material><name>world</name><sunsky><sundir>0 0.6 1</sundir><turbidity>2</turbidity><extra_atmospheric>false</extra_atmospheric><model>original</model></sunsky></material></background_material>
</background_settings>
</scene>");
    let models = "<scenedata>
<mesh><name>floor</name><normal_smoothing>true</normal_smoothing><external><path>floor.igmesh</path></external></mesh>
<mesh><name>lamp</name><external><path>lamp.igmesh</path></external></mesh>
<model><name>Floor</name><uid>100</uid><pos>0 0 0</pos><scale>1.0</scale><rotation><matrix>2 0 0 0 2 0 0 0 2 0 0 0</matrix></rotation><mesh_name>floor</mesh_name></model>
<model><name>Lamp</name><uid>101</uid><pos>0 0 3</pos><scale>1.0</scale><rotation><matrix>1 0 0 0 -1 0 0 0 -1 0 0 0</matrix></rotation><mesh_name>lamp</mesh_name>
 <emission_scale><material_name>lamp</material_name><measure>luminous_flux</measure><value>800</value></emission_scale>
 <ies_profile><material_name>lamp</material_name><path>lamp.ies</path></ies_profile><invisible_to_camera>false</invisible_to_camera></model>
<sphere><center>0 0 1</center><radius>0.4</radius><material_name>glass</material_name></sphere>
</scenedata>";
    let glass = "<scenedata><medium><uid>6</uid><name>glass medium</name><precedence>10</precedence><basic><ior>1.5</ior><cauchy_b_coeff>0</cauchy_b_coeff><absorption_coefficient><constant><rgb><rgb>1 2 3</rgb><gamma>1</gamma></rgb></constant></absorption_coefficient></basic></medium><material><name>glass</name><specular><internal_medium_uid>6</internal_medium_uid><transparent>true</transparent><arch_glass>false</arch_glass><single_face>false</single_face></specular></material></scenedata>";
    let files = vec![
        ("scene.igs", main.into_bytes()),
        ("models.igs", models.as_bytes().to_vec()),
        ("glass.igm", glass.as_bytes().to_vec()),
        ("floor.igmesh", igmesh(3, "wood")),
        ("lamp.igmesh", igmesh(2, "lamp")),
        ("a.bmp", bmp([[0, 60, 120], [200, 220, 240]])),
        ("lamp.ies", include_bytes!("../../../../testscenes/ies/lambert_1000cd.ies").to_vec()),
    ];
    let loaded = loaded(files);
    assert_found(&loaded, &["W0102 <radius> in <mn_cubic>"]);
    let scene = loaded.scene.expect("a scene");
    // The floor, the lamp and the sphere; the lamp, the sun and the sky.
    assert_eq!((scene.stats().objects, scene.lights.len()), (3, 3));
    assert_eq!(scene.names.materials, ["wood", "lamp", "glass"]);
}

/// The file lists `b` after `a`, but uses it first, and lists one that it does not use.
#[test]
fn a_model_lists_its_materials_in_the_order_of_the_mesh_file() {
    let mut mesh = words(&[5_456_751, 3, 0, 3]);
    for name in ["a", "b", "unused"] {
        mesh.extend(words(&[1]));
        mesh.push(name.as_bytes()[0]);
    }
    mesh.extend(words(&[0, 4]));
    mesh.extend(floats(&[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 1.0, 0.0]));
    mesh.extend(words(&[0, 1, 0, 2, 0, 1, 2, 0, 0, 0, 1, 0, 2, 3, 0, 0, 0, 0, 0]));
    let scene = |materials: &str| {
        let named = ["a", "b", "c"].map(|name| material(name, GREY)).concat();
        format!(
            "<scene>{TONES}{CAMERA}{LIGHT}{named}<mesh><name>m</name><external><path>m.igmesh</path></external></mesh><model><pos>0 0 0</pos><mesh_name>m</mesh_name>{materials}</model></scene>"
        )
    };
    let slots = |materials: &str, expected: &[&str]| {
        let files = vec![("scene.igs", scene(materials).into_bytes()), ("m.igmesh", mesh.clone())];
        let loaded = loaded(files);
        assert_found(&loaded, expected);
        // In the order of their first use.
        loaded.scene.expect("a scene").names.materials
    };
    assert_eq!(slots("", &[]), ["b", "a"]);
    let list = |names: &[&str]| {
        let names: Vec<String> =
            names.iter().map(|name| format!("<material_name>{name}</material_name>")).collect();
        let names = names.concat();
        format!("<materials>{names}</materials>")
    };
    assert_eq!(slots(&list(&["c", "a", "b"]), &[]), ["a", "c"]);
    assert_eq!(slots(&list(&["c", "a"]), &[]), ["a", "c"]);
    assert_eq!(slots(&list(&["c"]), &["W0318 the mesh has 2 materials"]), ["b", "c"]);
}

#[test]
fn a_material_preview() {
    let scene = format!(
        "<scene>{TONES}<include><pathname>preview.igs</pathname></include><include><pathname>wall.igm</pathname></include><model2><keyframe><time>0</time><pos>0 0 1</pos><rotation_quaternion><axis>0 0 1</axis><angle>0</angle></rotation_quaternion></keyframe><scale>1</scale><rotation><matrix>1 0 0 0 1 0 0 0 1</matrix></rotation><geometry_uid>1</geometry_uid><materials><material_uid>3</material_uid></materials></model2></scene>"
    );
    let preview = format!(
        "<scenedata>{CAMERA}<background_settings><background_material><material><diffuse><texture><path>sky.hdr</path><exponent>1</exponent></texture><base_emission><constant><uniform><value>700000</value></uniform></constant></base_emission><emission><texture><texture_index>0</texture_index></texture></emission></diffuse></material></background_material></background_settings><mesh><uid>1</uid><name>ball</name><external><path>ball.igmesh</path></external></mesh></scenedata>"
    );
    let material = "<scenedata><material><uid>3</uid><name>wall</name><diffuse><albedo><constant><rgb><rgb>0.2 0.3 0.4</rgb><gamma>2.2</gamma></rgb></constant></albedo></diffuse></material></scenedata>";
    let files = vec![
        ("scene.igs", scene.into_bytes()),
        ("preview.igs", preview.into_bytes()),
        ("wall.igm", material.as_bytes().to_vec()),
        ("ball.igmesh", igmesh(3, "previewed")),
        ("sky.hdr", hdr([[10, 20, 30, 129], [200, 100, 50, 131]])),
    ];
    let loaded = loaded(files);
    assert_found(&loaded, &[]);
    let scene = loaded.scene.expect("a scene");
    assert_eq!((&*scene.names.materials[0], scene.lights.len()), ("wall", 1));
}
