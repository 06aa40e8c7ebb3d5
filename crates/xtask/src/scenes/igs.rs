//! Pieces of scene files.

use std::io::{self, Write};

use super::sphere::Mesh;
use super::vector::{Vector, add, cross, dot, normalize, scale, sub};

/// Picture settings, tone mapping and camera.
pub struct View {
    /// Picture size in pixels.
    pub size: [u32; 2],
    /// Lens centre.
    pub from: Vector,
    /// What it looks at.
    pub at: Vector,
    /// Distance from lens to sensor in metres, for a sensor 0.036 m wide.
    pub lens_sensor_dist: f64,
    /// Distance of the plane in focus in metres.
    pub focus: f64,
    /// Reinhard's pre_scale.
    pub pre_scale: f64,
}

/// Opens the scene: settings, tone mapping, camera.
pub fn write_head(view: &View, out: &mut dyn Write) -> io::Result<()> {
    let [width, height] = view.size;
    writeln!(out, "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n<scene>")?;
    writeln!(out, "<renderer_settings>\n<width>{width}</width>\n<height>{height}</height>")?;
    writeln!(
        out,
        "<metropolis>false</metropolis>\n<bidirectional>false</bidirectional>\n\
         <aperture_diffraction>false</aperture_diffraction>\n</renderer_settings>"
    )?;
    writeln!(out, "<tonemapping>\n<reinhard>\n<pre_scale>{}</pre_scale>", view.pre_scale)?;
    writeln!(out, "<post_scale>1</post_scale>\n<burn>6</burn>\n</reinhard>\n</tonemapping>")?;
    writeln!(out, "<camera>\n<pos>{}</pos>\n<up>0 0 1</up>", numbers(&view.from))?;
    writeln!(out, "<forwards>{}</forwards>", numbers(&normalize(sub(view.at, view.from))))?;
    writeln!(
        out,
        "<aperture_radius>0.001</aperture_radius>\n<focus_distance>{}</focus_distance>",
        view.focus
    )?;
    writeln!(out, "<aspect_ratio>{}</aspect_ratio>", f64::from(width) / f64::from(height))?;
    writeln!(out, "<sensor_width>0.036</sensor_width>")?;
    writeln!(out, "<lens_sensor_dist>{}</lens_sensor_dist>", view.lens_sensor_dist)?;
    writeln!(out, "<white_balance>E</white_balance>\n</camera>")
}

/// Closes the scene.
pub fn write_tail(out: &mut dyn Write) -> io::Result<()> {
    writeln!(out, "</scene>")
}

/// An even background of the same spectral radiance (W m^-3 sr^-1) at all wavelengths.
pub fn write_background(value: f64, out: &mut dyn Write) -> io::Result<()> {
    writeln!(out, "<background><spectrum><uniform><value>{value}</value></uniform></spectrum></background>")
}

/// A matt material of a linear RGB albedo.
pub fn write_diffuse(name: &str, rgb: Vector, out: &mut dyn Write) -> io::Result<()> {
    writeln!(
        out,
        "<material><name>{name}</name><diffuse><albedo_spectrum><rgb><rgb>{}</rgb>",
        numbers(&rgb)
    )?;
    writeln!(out, "<gamma>1</gamma></rgb></albedo_spectrum></diffuse></material>")
}

/// A mesh whose triangles stand in the scene file.
pub fn write_mesh(
    name: &str,
    smooth: bool,
    material: &str,
    mesh: &Mesh,
    out: &mut dyn Write,
) -> io::Result<()> {
    writeln!(out, "<mesh>\n<name>{name}</name>\n<normal_smoothing>{smooth}</normal_smoothing>\n<embedded>")?;
    for (position, normal) in mesh.positions.iter().zip(&mesh.normals) {
        writeln!(out, "<vertex pos=\"{}\" normal=\"{}\"/>", numbers(position), numbers(normal))?;
    }
    writeln!(out, "<triangle_set>\n<material_name>{material}</material_name>")?;
    for [a, b, c] in &mesh.triangles {
        writeln!(out, "<tri>{a} {b} {c}</tri>")?;
    }
    writeln!(out, "</triangle_set>\n</embedded>\n</mesh>")
}

/// A square light of half side `half` around `at`, shining towards `target`.
pub fn write_panel(at: Vector, target: Vector, half: f64, value: f64, out: &mut dyn Write) -> io::Result<()> {
    let normal = normalize(sub(target, at));
    let right = normalize(cross(normal, [0.0, 0.0, 1.0]));
    let up = cross(right, normal);
    let corner = |r: f64, u: f64| add(scale(r * half, right), scale(u * half, up));
    let panel = Mesh {
        positions: vec![corner(-1.0, -1.0), corner(-1.0, 1.0), corner(1.0, 1.0), corner(1.0, -1.0)],
        normals: vec![normal; 4],
        triangles: facing(normal, [corner(-1.0, -1.0), corner(-1.0, 1.0), corner(1.0, 1.0)]),
    };
    write_diffuse("panel", [0.0; 3], out)?;
    write_mesh("panel", false, "panel", &panel, out)?;
    writeln!(
        out,
        "<meshlight>\n<pos>{}</pos>\n<scale>1</scale>\n<mesh_name>panel</mesh_name>",
        numbers(&at)
    )?;
    writeln!(out, "<spectrum><uniform><value>{value}</value></uniform></spectrum>\n</meshlight>")
}

/// The two triangles of a square, wound so that their front is where `normal` points.
fn facing(normal: Vector, [a, b, c]: [Vector; 3]) -> Vec<[u32; 3]> {
    if dot(cross(sub(b, a), sub(c, a)), normal) > 0.0 {
        vec![[0, 1, 2], [0, 2, 3]]
    } else {
        vec![[0, 2, 1], [0, 3, 2]]
    }
}

/// A model of a mesh; `rotation` in row order.
pub fn write_model(
    mesh: &str,
    at: Vector,
    size: f64,
    rotation: Option<[Vector; 3]>,
    out: &mut dyn Write,
) -> io::Result<()> {
    write!(out, "<model><pos>{}</pos><scale>{size:.6}</scale>", numbers(&at))?;
    if let Some(rows) = rotation {
        write!(out, "<rotation><matrix>{}</matrix></rotation>", rows.map(|row| numbers(&row)).join(" "))?;
    }
    writeln!(out, "<mesh_name>{mesh}</mesh_name></model>")
}

/// Numbers as the format has them; six decimals are a micrometre.
pub fn numbers(values: &[f64]) -> String {
    values.iter().map(|value| format!("{value:.6}")).collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panel_s_front_faces_its_target() {
        for target in [[0.0, 0.0, 0.0], [3.0, -2.0, 1.0]] {
            let at = [-4.0, -1.5, 2.5];
            let normal = normalize(sub(target, at));
            let right = normalize(cross(normal, [0.0, 0.0, 1.0]));
            let corners = [[0.0; 3], cross(right, normal), add(cross(right, normal), right)];
            let front = facing(normal, corners);
            let [a, b, c] = front[0].map(|i| corners[i as usize]);
            assert!(dot(cross(sub(b, a), sub(c, a)), normal) > 0.0);
        }
    }

    #[test]
    fn elements_are_balanced() {
        let view = View {
            size: [4, 3],
            from: [0.0; 3],
            at: [0.0, 1.0, 0.0],
            lens_sensor_dist: 0.03,
            focus: 1.0,
            pre_scale: 1.0,
        };
        let mut bytes = Vec::new();
        write_head(&view, &mut bytes).unwrap();
        write_background(1.0, &mut bytes).unwrap();
        write_panel([0.0, 0.0, 3.0], [0.0, 1.0, 0.0], 1.0, 1e7, &mut bytes).unwrap();
        write_model(
            "panel",
            [0.0; 3],
            1.0,
            Some([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]),
            &mut bytes,
        )
        .unwrap();
        write_tail(&mut bytes).unwrap();
        let text = String::from_utf8(bytes).unwrap();
        let mut open = Vec::new();
        for tag in text.split('<').skip(1).map(|rest| rest.split('>').next().unwrap()) {
            if let Some(name) = tag.strip_prefix('/') {
                assert_eq!(open.pop(), Some(name));
            } else if !tag.ends_with(['/', '?']) {
                open.push(tag.split(' ').next().unwrap());
            }
        }
        assert!(open.is_empty(), "{open:?}");
    }
}
