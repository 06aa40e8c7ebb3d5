//! Pictures that the console wrote.

use std::path::Path;

use exr::prelude::{FlatSamples, read_first_flat_layer_from_file};

use super::check::{Area, Quantity};

/// Rows of Rec. 709 (D65) to XYZ, as IEC 61966-2-1 derives them, to seven digits.
pub const RGB_TO_XYZ: [[f64; 3]; 3] = [
    [0.412_390_8, 0.357_584_3, 0.180_480_8],
    [0.212_639_0, 0.715_168_7, 0.072_192_3],
    [0.019_330_8, 0.119_194_8, 0.950_532_2],
];

/// A picture in X, Y, Z, cd/m².
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// Columns and rows.
    pub size: [usize; 2],
    /// Rows from the top.
    pub pixels: Vec<[f64; 3]>,
}

impl Picture {
    /// Reads an EXR file of linear Rec. 709.
    pub fn read(path: &Path) -> Result<Self, String> {
        let (size, rgb) = read_rgb(path)?;
        let to_xyz = |rgb: [f64; 3]| RGB_TO_XYZ.map(|row| (0..3).map(|c| row[c] * rgb[c]).sum());
        Ok(Self { size, pixels: rgb.into_iter().map(to_xyz).collect() })
    }

    /// The same, if it has the size that a scene asks for: areas are of that.
    pub fn of_size(self, scene: &str) -> Result<Self, String> {
        let asked = ["width", "height"].map(|name| number_in(scene, name));
        if asked == self.size.map(Some) {
            return Ok(self);
        }
        let [width, height] = self.size;
        let [asked_width, asked_height] = asked.map(Option::unwrap_or_default);
        Err(format!(
            "a picture of {width} × {height} pixels, where the scene asks for {asked_width} × {asked_height}"
        ))
    }

    /// Mean X, Y, Z of an area, or of all.
    pub fn mean(&self, area: Option<Area>) -> [f64; 3] {
        let [x0, x1, y0, y1] = area.unwrap_or([0, self.size[0], 0, self.size[1]]);
        let mut sum = [0.0; 3];
        for y in y0..y1 {
            for pixel in &self.pixels[y * self.size[0] + x0..y * self.size[0] + x1] {
                (0..3).for_each(|c| sum[c] += pixel[c]);
            }
        }
        sum.map(|s| s / ((x1 - x0) * (y1 - y0)) as f64)
    }

    /// A number of an area.
    pub fn value(&self, quantity: Quantity, area: Option<Area>, unit: f64) -> f64 {
        let [x, y, z] = self.mean(area);
        match quantity {
            Quantity::Y => y / unit,
            Quantity::XOverY => x / y,
            Quantity::ZOverY => z / y,
        }
    }
}

/// Columns and rows, and the pixels, rows from the top, of an EXR file of linear Rec. 709.
pub fn read_rgb(path: &Path) -> Result<([usize; 2], Vec<[f64; 3]>), String> {
    let fault = |why: &dyn std::fmt::Display| format!("{}: {why}", path.display());
    let image = read_first_flat_layer_from_file(path).map_err(|error| fault(&error))?;
    let layer = image.layer_data;
    let channel = |name: &str| {
        let found = layer.channel_data.list.iter().find(|channel| channel.name.to_string() == name);
        match found.map(|channel| &channel.sample_data) {
            Some(FlatSamples::F32(values)) => Ok(values),
            _ => Err(fault(&format!("no channel {name} of 32-bit numbers"))),
        }
    };
    let (r, g, b) = (channel("R")?, channel("G")?, channel("B")?);
    let rgb = r.iter().zip(g).zip(b).map(|((r, g), b)| [*r, *g, *b].map(f64::from));
    Ok(([layer.size.x(), layer.size.y()], rgb.collect()))
}

/// The number that the one element of a name holds.
fn number_in(scene: &str, name: &str) -> Option<usize> {
    let (_, after) = scene.split_once(&format!("<{name}>"))?;
    after.split_once('<')?.0.trim().parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_picture_of_another_size_than_the_scene_s_is_refused() {
        let picture = Picture { size: [8, 4], pixels: vec![[0.0; 3]; 32] };
        let scene = |width: u32| format!("<width>{width}</width><height>4</height>");
        assert_eq!(picture.clone().of_size(&scene(8)), Ok(picture.clone()));
        assert!(picture.clone().of_size(&scene(16)).is_err());
        assert!(picture.of_size("").is_err());
    }
}
