//! The shape of the camera's aperture.

use super::Context;
use crate::codes;
use indigo_camera::{Aperture, Blades, BladesError, GreyImage};
use indigo_decl::Node;
use indigo_diag::{Diagnostic, Span};
use indigo_formats::image::{Image, Pixels};

/// First bytes of every PNG.
const PNG_MAGIC: &[u8] = b"\x89PNG\r\n\x1a\n";
/// Sides of an aperture image in texels. The upper limit keeps the tables of a scene's aperture below
/// 200 MB.
const SIDES: std::ops::RangeInclusive<u32> = 512..=4096;

/// The aperture of a camera; a circle where there is none, or where it is wrong, which is reported.
pub(super) fn aperture(camera: &Node, context: &mut Context) -> Aperture {
    let Some(shape) = camera.node("aperture_shape").and_then(Node::alternative) else {
        return Aperture::Circular;
    };
    shape.mark_used();
    let made = match shape.block.name {
        "generated" => generated(shape, context),
        "image" => drawn(shape, context),
        _ => None,
    };
    made.unwrap_or(Aperture::Circular)
}

fn generated(node: &Node, context: &mut Context) -> Option<Aperture> {
    let blades = Blades::new(
        node.int("num_blades"),
        node.real("start_angle"),
        node.real("blade_offset"),
        node.real("blade_curvature_radius"),
    );
    let complain = |error: BladesError| {
        let (field, expected) = match error {
            BladesError::Count => ("num_blades", format!("expected 3 to {}", Blades::MAX)),
            BladesError::Closed => {
                ("blade_curvature_radius", "expected more than half of <blade_offset>".to_owned())
            }
            BladesError::NotPositive => ("blade_offset", "expected finite numbers above 0".to_owned()),
        };
        context.sink.push(
            Diagnostic::error(indigo_decl::codes::OUT_OF_RANGE, node.span_of(field), error.to_string())
                .expected(expected),
        );
    };
    blades.map_err(complain).ok().map(|b| Aperture::generated(&b))
}

fn drawn(node: &Node, context: &mut Context) -> Option<Aperture> {
    let path = node.text("path");
    let (image, bytes) = read_image(&path.value, path.span, context)?;
    let (width, height) = (image.width, image.height);
    let is_right = width == height && width.is_power_of_two() && SIDES.contains(&width);
    let wrong = if !bytes.starts_with(PNG_MAGIC) {
        Some((format!("{}: an aperture image must be a PNG", path.value), "expected a PNG file".to_owned()))
    } else if !is_right {
        Some((
            format!("{}: an aperture image of {width} x {height} texels", path.value),
            format!("expected a square whose side is a power of 2 from {} to {}", SIDES.start(), SIDES.end()),
        ))
    } else {
        None
    };
    if let Some((message, expected)) = wrong {
        let error = Diagnostic::error(codes::BAD_FILE, path.span, message).expected(expected);
        context.sink.push(error);
        return None;
    }
    let complain = |error: indigo_camera::NothingOpen| {
        let message = format!("{}: {error}", path.value);
        let error = Diagnostic::error(codes::BAD_FILE, path.span, message);
        context.sink.push(error.expected("expected an image with some white"));
    };
    Aperture::image(&grey(&image)).map_err(complain).ok()
}

/// An image of what stands before the lens; `None` after reporting why not.
pub(super) fn obstacles(path: &str, span: Span, context: &mut Context) -> Option<GreyImage> {
    read_image(path, span, context).map(|(image, _)| grey(&image))
}

/// A picture file and its bytes; `None` after reporting why not.
fn read_image(path: &str, span: Span, context: &mut Context) -> Option<(Image, std::sync::Arc<[u8]>)> {
    let found = context.read(path, span)?;
    match context.picture(&found.path, &found.bytes, span) {
        Ok(image) => Some((image, found.bytes)),
        Err(error) => {
            context.sink.push(
                Diagnostic::error(codes::BAD_FILE, span, format!("{}: bad picture file", found.path))
                    .expected(format!("expected {}, found {}", error.expected, error.found)),
            );
            None
        }
    }
}

/// A picture as shades of grey from 0 to 1, as stored: what they mean is transmission, not light.
fn grey(image: &Image) -> GreyImage {
    let channels = usize::from(image.channels);
    let texel = |values: [f32; 3]| {
        // The weights of luma in ITU-R BT.709.
        0.2126 * values[0] + 0.7152 * values[1] + 0.0722 * values[2]
    };
    let at = |i: usize, c: usize| {
        let i = i * channels + c.min(channels - 1);
        match &image.pixels {
            Pixels::U8(v) => f32::from(v[i]) / 255.0,
            Pixels::U16(v) => f32::from(v[i]) / 65535.0,
            Pixels::F32(v) => v[i],
        }
    };
    let count = image.width as usize * image.height as usize;
    let texels = (0..count).map(|i| texel([at(i, 0), at(i, 1), at(i, 2)])).collect();
    GreyImage { width: image.width as usize, height: image.height as usize, texels }
}
