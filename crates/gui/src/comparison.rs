//! A saved picture that the render is compared with.

use crate::shrink;
use eframe::egui::{Color32, ColorImage};
use indigo_formats::image::{Image, Pixels, decode};
use indigo_render::disk::read_limited;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// How two pictures are shown.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Layout {
    /// Only the render.
    #[default]
    Off,
    /// The render on the left, the other on the right.
    Side,
    /// The render to the left of a line, the other to the right of it, both in the same place.
    Wipe,
}

impl Layout {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Off, Self::Side, Self::Wipe];
}

/// See the module.
pub struct Comparison {
    /// How both are shown.
    pub layout: Layout,
    /// Where the line is, from 0 (left) to 1.
    pub wipe: f32,
    /// The other picture.
    pub picture: Option<(PathBuf, Arc<ColorImage>)>,
}

impl Comparison {
    /// The name of the other picture.
    pub fn name(&self) -> Option<String> {
        let (path, _) = self.picture.as_ref()?;
        Some(path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned())
    }
}

impl Default for Comparison {
    fn default() -> Self {
        Self { layout: Layout::Off, wipe: 0.5, picture: None }
    }
}

/// Reads a picture as a screen shows it, with no side longer than so many pixels.
///
/// # Errors
/// What is wrong with the file.
pub fn read(path: &Path, longest_side: usize) -> Result<Arc<ColorImage>, String> {
    let name = path.display().to_string();
    let bytes = read_limited(path).map_err(|error| format!("{name}: {error}"))?;
    let image = decode(&name, &bytes).map_err(|error| format!("{name}: {error}"))?;
    Ok(shrink::to_fit(&Arc::new(on_screen(&image)), longest_side))
}

fn on_screen(image: &Image) -> ColorImage {
    let codes: Vec<u8> = match &image.pixels {
        Pixels::U8(codes) => codes.clone(),
        Pixels::U16(codes) => codes.iter().map(|code| (code >> 8) as u8).collect(),
        // What has no bounds is linear light.
        Pixels::F32(light) => light.iter().map(|&light| code_of(light)).collect(),
    };
    let pixels = codes.chunks_exact(usize::from(image.channels.max(1))).map(|channels| match channels {
        [r, g, b, ..] => Color32::from_rgb(*r, *g, *b),
        [grey, ..] => Color32::from_gray(*grey),
        [] => Color32::BLACK,
    });
    ColorImage::new([image.width as usize, image.height as usize], pixels.collect())
}

fn code_of(light: f32) -> u8 {
    let light = light.clamp(0.0, 1.0);
    let value = if light <= 0.003_130_8 { 12.92 * light } else { 1.055 * light.powf(1.0 / 2.4) - 0.055 };
    (value * 255.0).round() as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_kinds_of_pixels_become_codes() {
        let image = |channels, pixels| Image {
            width: 1,
            height: 1,
            channels,
            pixels,
            primaries: None,
            notes: vec![],
        };
        let shown = |image| on_screen(&image).pixels[0];
        assert_eq!(shown(image(3, Pixels::U8(vec![1, 2, 3]))), Color32::from_rgb(1, 2, 3));
        assert_eq!(shown(image(1, Pixels::U16(vec![0x8000]))), Color32::from_gray(128));
        assert_eq!(shown(image(3, Pixels::F32(vec![0.18, 7.0, f32::NAN]))), Color32::from_rgb(118, 255, 0));
    }
}
