//! Contact sheets of the libraries that come with the program: a ball of each metal and of each medium.
//!
//! `docs/gallery/make_pictures.py` writes the names under the balls; it counts rows and columns as is done here.

use std::io::{self, Write};

use super::igs::write_mesh;
use super::sphere::Mesh;

/// Balls in rows, the first at the top left, standing upright before the camera.
struct Sheet {
    columns: usize,
    /// From column to column, metres.
    pitch: f64,
    /// From row to row in pitches: more than 1, which leaves room for names.
    rows: f64,
}

impl Sheet {
    const METALS: Self = Self { columns: 8, pitch: 0.05, rows: 1.33 };
    const MEDIA: Self = Self { columns: 11, pitch: 0.0125, rows: 1.5 };
    /// Of the pitch.
    const RADIUS: f64 = 0.4;

    /// Where ball `i` of `count` is, to the right and upwards.
    fn place(&self, i: usize, count: usize) -> [f64; 2] {
        let rows = count.div_ceil(self.columns);
        let x = (i % self.columns) as f64 - 0.5 * (self.columns - 1) as f64;
        let z = 0.5 * (rows - 1) as f64 - (i / self.columns) as f64;
        [x * self.pitch, z * self.rows * self.pitch]
    }

    /// A ball of each material.
    fn write_balls(&self, names: &[String], out: &mut dyn Write) -> io::Result<()> {
        let radius = Self::RADIUS * self.pitch;
        for (i, name) in names.iter().enumerate() {
            let [x, z] = self.place(i, names.len());
            writeln!(
                out,
                "<sphere><center>{x:.5} 0 {z:.5}</center><radius>{radius}</radius><material_name>{name}</material_name></sphere>"
            )?;
        }
        Ok(())
    }

    /// Bars of light behind the balls, `bars`: four to a pitch, as wide as the gaps between them and a little higher than the
    /// balls.
    fn write_bars(&self, count: usize, out: &mut dyn Write) -> io::Result<()> {
        let mut bars = Mesh { positions: vec![], normals: vec![], triangles: vec![] };
        let step = 0.25 * self.pitch;
        for row in 0..count.div_ceil(self.columns) {
            let [left, z] = self.place(row * self.columns, count);
            for bar in 0..4 * self.columns {
                let x = left - 0.5 * self.pitch + (bar as f64 + 0.25) * step;
                let first = bars.positions.len() as u32;
                for [dx, dz] in [[0.0, -0.45], [0.5, -0.45], [0.5, 0.45], [0.0, 0.45]] {
                    bars.positions.push([x + dx * step, 2.0 * self.pitch, z + dz * self.pitch]);
                    bars.normals.push([0.0, -1.0, 0.0]);
                }
                bars.triangles.extend([[first, first + 1, first + 2], [first, first + 2, first + 3]]);
            }
        }
        write_mesh("bars", false, "black", &bars, out)?;
        writeln!(
            out,
            "<meshlight><pos>0 0 0</pos><scale>1</scale><mesh_name>bars</mesh_name>\
             <spectrum><blackbody><temperature>6500</temperature><gain>{BARS}</gain></blackbody></spectrum></meshlight>"
        )
    }
}

/// Brightness of the bars; twice that of the surroundings of `data/scenes/media.igs`.
const BARS: f64 = 6e-7;

/// Names of the files of a folder of the repository with an extension, in order.
fn names(folder: &str, extension: &str) -> io::Result<Vec<String>> {
    let entries = std::fs::read_dir(crate::process::root().join(folder))?;
    let mut names = vec![];
    for entry in entries {
        let name = entry?.file_name().to_string_lossy().into_owned();
        names.extend(name.strip_suffix(extension).map(str::to_owned));
    }
    names.sort();
    Ok(names)
}

/// Every file of `nkdata`.
pub fn write_metals(out: &mut dyn Write) -> io::Result<()> {
    let metals = names("nkdata", ".nk")?;
    for name in &metals {
        writeln!(
            out,
            "<material><name>{name}</name><phong><nk_data>nkdata/{name}.nk</nk_data><exponent>800</exponent></phong></material>"
        )?;
    }
    Sheet::METALS.write_balls(&metals, out)
}

/// Every file of `media`.
pub fn write_media(out: &mut dyn Write) -> io::Result<()> {
    let media = names("media", ".igs")?;
    for name in &media {
        writeln!(out, "<include><pathname>media/{name}.igs</pathname></include>")?;
        writeln!(
            out,
            "<material><name>{name}</name><specular><transparent>true</transparent>\
             <internal_medium_name>{name}</internal_medium_name></specular></material>"
        )?;
    }
    Sheet::MEDIA.write_bars(media.len(), out)?;
    Sheet::MEDIA.write_balls(&media, out)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_row_of_the_libraries_is_there_once() {
        for (write, count) in [(write_metals as fn(&mut dyn Write) -> _, 23), (write_media, 55)] {
            let mut text = vec![];
            write(&mut text).unwrap();
            assert_eq!(String::from_utf8(text).unwrap().matches("<sphere>").count(), count);
        }
    }
}
