//! Pieces of scene files.

/// A camera that sees ±`tangent` in width; `more` holds further elements, or overrides none.
pub fn camera(pos: [f64; 3], forwards: [f64; 3], tangent: f64, more: &str) -> String {
    let vec = |v: [f64; 3]| format!("{} {} {}", v[0], v[1], v[2]);
    // Straight up and down are seen with north on top.
    let up = if forwards[0] == 0.0 && forwards[1] == 0.0 { "0 1 0" } else { "0 0 1" };
    format!(
        "<camera><pos>{}</pos><up>{up}</up><forwards>{}</forwards><aperture_radius>1e-5</aperture_radius>\
         <focus_distance>1</focus_distance><aspect_ratio>1</aspect_ratio><sensor_width>{}</sensor_width>\
         <lens_sensor_dist>0.05</lens_sensor_dist>{more}</camera>",
        vec(pos),
        vec(forwards),
        0.1 * tangent
    )
}

/// A camera as [`camera`] without the darkening towards the corners.
pub fn flat_camera(pos: [f64; 3], forwards: [f64; 3], tangent: f64) -> String {
    camera(pos, forwards, tangent, "<vignetting>false</vignetting>")
}

/// Settings for a square picture rendered by path tracing; `more` holds further ones.
pub fn settings(side: u32, more: &str) -> String {
    format!(
        "<renderer_settings><width>{side}</width><height>{side}</height><super_sample_factor>1</super_sample_factor>\
         <metropolis>false</metropolis><bidirectional>false</bidirectional>\
         <aperture_diffraction>false</aperture_diffraction><cache_trees>false</cache_trees>{more}</renderer_settings>"
    )
}

/// Settings for a film that keeps each sample in its own pixel, so that none is lost over its edge.
pub const ONE_PIXEL: &str = "<splat_filter><box></box></splat_filter>";

/// A spectrum of one value.
pub fn uniform(value: f64) -> String {
    format!("<uniform><value>{value}</value></uniform>")
}

/// A diffuse material.
pub fn diffuse(name: &str, spectrum: &str) -> String {
    format!(
        "<material><name>{name}</name><diffuse><albedo_spectrum>{spectrum}</albedo_spectrum></diffuse></material>"
    )
}

/// A diffuse material of one albedo.
pub fn grey(name: &str, albedo: f64) -> String {
    diffuse(name, &uniform(albedo))
}

/// A material that does nothing.
pub fn null(name: &str) -> String {
    format!("<material><name>{name}</name><null_material/></material>")
}

/// A medium of a kind.
pub fn medium(name: &str, precedence: u32, kind: &str) -> String {
    format!("<medium><name>{name}</name><precedence>{precedence}</precedence>{kind}</medium>")
}

/// The content of a `basic` medium without dispersion; `scattering` may hold its `subsurface_scattering`.
pub fn basic(ior: f64, absorption: &str, scattering: &str) -> String {
    format!(
        "<basic><ior>{ior}</ior><absorption_coefficient_spectrum>{absorption}</absorption_coefficient_spectrum>\
         {scattering}</basic>"
    )
}

/// `subsurface_scattering` of a coefficient and a kind of phase function.
pub fn scattering(coefficient: &str, phase: &str) -> String {
    format!(
        "<subsurface_scattering><scattering_coefficient_spectrum>{coefficient}</scattering_coefficient_spectrum>\
         <phase_function>{phase}</phase_function></subsurface_scattering>"
    )
}

/// The phase function of Henyey and Greenstein.
pub fn henyey_greenstein(g: f64) -> String {
    format!("<henyey_greenstein><g_spectrum>{}</g_spectrum></henyey_greenstein>", uniform(g))
}

/// The smooth surface of a medium.
pub fn specular(name: &str, medium: &str) -> String {
    format!(
        "<material><name>{name}</name><specular><transparent>true</transparent>\
         <internal_medium_name>{medium}</internal_medium_name></specular></material>"
    )
}

/// A sphere of a material.
pub fn sphere(center: [f64; 3], radius: f64, material: &str) -> String {
    let [x, y, z] = center;
    format!(
        "<sphere><center>{x} {y} {z}</center><radius>{radius}</radius><material_name>{material}</material_name></sphere>"
    )
}

/// Light from everywhere.
pub fn background(spectrum: &str) -> String {
    format!("<background><spectrum>{spectrum}</spectrum></background>")
}

/// A whole scene.
pub fn scene_file(parts: &[String]) -> String {
    format!("<scene>{}<tonemapping><linear><scale>1</scale></linear></tonemapping></scene>", parts.concat())
}
