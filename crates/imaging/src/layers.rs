//! The layers of an EXR, by the names that compositing programs sort them by: `layer.channel`, where colours have the
//! channels R, G, B and vectors X, Y, Z (OpenEXR, "Technical Introduction", on channel names).

use crate::LinearImage;
use crate::white_balance::plain_rgb;
use indigo_film::FirstHit;
use std::borrow::Cow;
use std::fmt::Write as _;

/// A channel of a layered EXR: its full name, and a value for each pixel, rows from top to bottom.
#[derive(Clone, Debug, PartialEq)]
pub struct Channel {
    /// Such as `albedo.R`.
    pub name: Cow<'static, str>,
    /// Its values.
    pub values: Vec<f32>,
}

/// The picture's own colours, R, G and B.
pub fn rgb_channels(image: &LinearImage) -> Vec<Channel> {
    channels(&image.pixels, ["R", "G", "B"], |[r, g, b, _]| [*r, *g, *b])
}

/// The picture's `foreground`: the light of all but the surroundings, and the part of each pixel that it covers, A. The colours
/// are what the pixel gets of it, premultiplied as compositing programs have them: over another picture, they are added to
/// 1 - A of that.
pub fn foreground_channels(image: &LinearImage) -> Vec<Channel> {
    let names = ["foreground.R", "foreground.G", "foreground.B", "foreground.A"];
    channels(&image.pixels, names, |pixel| *pixel)
}

/// The picture's `background`: the light that the surroundings send straight into the camera.
pub fn background_channels(image: &LinearImage) -> Vec<Channel> {
    channels(&image.pixels, ["background.R", "background.G", "background.B"], |[r, g, b, _]| [*r, *g, *b])
}

/// The picture's `direct` light.
pub fn direct_channels(image: &LinearImage) -> Vec<Channel> {
    channels(&image.pixels, ["direct.R", "direct.G", "direct.B"], |[r, g, b, _]| [*r, *g, *b])
}

/// The picture's `indirect` light.
pub fn indirect_channels(image: &LinearImage) -> Vec<Channel> {
    channels(&image.pixels, ["indirect.R", "indirect.G", "indirect.B"], |[r, g, b, _]| [*r, *g, *b])
}

/// The picture's light of one group of lights, as `light1` and so on by its number from 0.
pub fn light_channels(number: usize, image: &LinearImage) -> Vec<Channel> {
    let names = ["R", "G", "B"].map(|channel| format!("light{}.{channel}", number + 1));
    channels(&image.pixels, names, |[r, g, b, _]| [*r, *g, *b])
}

/// `albedo` (linear Rec. 709), `normal`, `depth` (metres), `object_id` and `material_id`. Numbers are exact up to 2^24.
pub fn first_hit_channels(hits: &[FirstHit]) -> Vec<Channel> {
    let matrix = plain_rgb();
    let albedo = |hit: &FirstHit| matrix.apply(&[hit.albedo[0], hit.albedo[1], hit.albedo[2], 0.0]);
    let mut all = channels(hits, ["albedo.R", "albedo.G", "albedo.B"], albedo);
    all.extend(channels(hits, ["normal.X", "normal.Y", "normal.Z"], |hit| hit.normal));
    let names = ["depth.Z", "object_id.X", "material_id.X"];
    all.extend(channels(hits, names, |hit| [hit.depth_m, hit.object as f32, hit.material as f32]));
    all
}

/// A JSON object that tells the names of the numbers that a channel holds: `{"1":"floor","2":"ball"}`.
pub fn manifest<'a>(names: impl IntoIterator<Item = &'a str>) -> String {
    let mut text = String::from("{");
    for (i, name) in names.into_iter().enumerate() {
        let comma = if i > 0 { "," } else { "" };
        // Writing to a string cannot fail.
        let _ = write!(text, "{comma}\"{}\":\"", i + 1);
        for c in name.chars() {
            let _ = match c {
                '"' | '\\' => write!(text, "\\{c}"),
                c if c < ' ' => write!(text, "\\u{:04x}", u32::from(c)),
                c => write!(text, "{c}"),
            };
        }
        text.push('"');
    }
    text + "}"
}

fn channels<T, const N: usize>(
    pixels: &[T],
    names: [impl Into<Cow<'static, str>>; N],
    values: impl Fn(&T) -> [f32; N],
) -> Vec<Channel> {
    let mut channels: Vec<Channel> = names
        .into_iter()
        .map(|name| Channel { name: name.into(), values: Vec::with_capacity(pixels.len()) })
        .collect();
    for pixel in pixels {
        for (channel, value) in channels.iter_mut().zip(values(pixel)) {
            channel.values.push(value);
        }
    }
    channels
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_manifest_is_json_whatever_the_names_are() {
        assert_eq!(manifest([]), "{}");
        assert_eq!(manifest(["a", "b \"c\" \\ \n", "σ"]), r#"{"1":"a","2":"b \"c\" \\ \u000a","3":"σ"}"#);
    }
}
