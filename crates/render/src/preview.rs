//! A picture of the camera's aperture.

use crate::atomic::write_atomically;
use crate::output::SaveError;
use indigo_camera::Aperture;
use indigo_imaging::png;
use std::io::Write as _;
use std::path::Path;

/// Side of the picture in pixels: the least that an aperture image may have, so that it can be one.
const SIDE: u16 = 512;

/// Writes a grey PNG of what an aperture lets through: white where it is open.
///
/// # Errors
/// Where the file cannot be written.
pub fn save_aperture(aperture: &Aperture, path: &Path) -> Result<(), SaveError> {
    let mask = aperture.draw(usize::from(SIDE));
    let codes: Vec<u8> = mask.cells.iter().map(|t| (t * 255.0).round() as u8).collect();
    let bytes = png::encode_grey(u32::from(SIDE), &codes)?;
    write_atomically(path, |file| file.write_all(&bytes))
        .map_err(|source| SaveError::Write { path: path.to_path_buf(), source })
}
