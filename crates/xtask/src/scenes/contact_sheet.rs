//! Contact sheets of the libraries that come with the program: a ball of each metal and of each medium.

use std::io::{self, Write};

/// Balls stand in rows of this many, the first at the top left.
const COLUMNS: usize = 8;
/// From ball to ball, metres.
const PITCH: f64 = 0.05;
const RADIUS: f64 = 0.02;

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

/// A ball of each material, in reading order, standing upright before the camera.
fn write_balls(names: &[String], out: &mut dyn Write) -> io::Result<()> {
    let rows = names.len().div_ceil(COLUMNS);
    for (i, name) in names.iter().enumerate() {
        let x = ((i % COLUMNS) as f64 - 0.5 * (COLUMNS - 1) as f64) * PITCH;
        let z = (0.5 * (rows - 1) as f64 - (i / COLUMNS) as f64) * PITCH;
        writeln!(
            out,
            "<sphere><center>{x:.3} 0 {z:.3}</center><radius>{RADIUS}</radius><material_name>{name}</material_name></sphere>"
        )?;
    }
    Ok(())
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
    write_balls(&metals, out)
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
    write_balls(&media, out)
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
