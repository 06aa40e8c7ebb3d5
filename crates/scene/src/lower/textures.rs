//! Image maps, each file decoded once however often it is used.

use super::Context;
use crate::codes;
use indigo_decl::Node;
use indigo_diag::{Diagnostic, SourceId, Span};
use indigo_formats::image::{Image, Pixels};
use indigo_math::{Float, Mat3, Real};
use indigo_spectrum::adaptation::rec709_of;
use indigo_texture::{Curve, Mapping, Texture, TextureId};
use std::collections::HashMap;
use std::sync::Arc;

/// Textures loaded so far.
#[derive(Default)]
pub(super) struct TextureTable {
    textures: Vec<Texture>,
    /// Where a path named in a file was found.
    found: HashMap<(SourceId, String), String>,
    images: HashMap<String, Arc<Image>>,
    /// Textures by file, curve (exponent, a, b, c), uv set and mapping.
    by_content: HashMap<(String, [u64; 4], u32, [u64; 6]), TextureId>,
    /// Shares of texels that were counted: it goes through all of them, and a texture may be used any number of times.
    shares: HashMap<(TextureId, Unfit), f64>,
}

/// What texels may be that some use of them cannot take.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
pub(super) enum Unfit {
    /// Of a scalar that is not above 0.
    NotAbove0,
    /// With a component that is no fraction.
    NoFractions,
    /// Of a scalar that is no fraction.
    NoShare,
}

impl TextureTable {
    /// The texture of an element on a uv set. What is wrong with its file is reported, and a grey texel stands
    /// in.
    pub(super) fn get(&mut self, node: &Node, uv_set: u32, context: &mut Context) -> TextureId {
        let path = node.text("path");
        let mapping = mapping(node, context);
        let [exponent, a, b, c] = ["exponent", "a", "b", "c"].map(|field| node.real(field));
        let file = self.load(&path.value, path.span, context);
        let key = (file, [exponent, a, b, c].map(f64::to_bits), uv_set, bits(&mapping));
        if let Some(&id) = self.by_content.get(&key) {
            return id;
        }
        let image = self.images[&key.0].clone();
        self.textures.push(Texture::new(image, Curve { exponent, a, b, c }, uv_set).with_mapping(mapping));
        let id = (self.textures.len() - 1) as TextureId;
        self.by_content.insert(key, id);
        id
    }

    /// A texture by its number.
    pub(super) fn texture(&self, id: TextureId) -> &Texture {
        &self.textures[id as usize]
    }

    /// Which share of the texels of a texture some use of it cannot take.
    pub(super) fn share_of(&mut self, id: TextureId, unfit: Unfit) -> f64 {
        let texture = &self.textures[id as usize];
        *self.shares.entry((id, unfit)).or_insert_with(|| match unfit {
            Unfit::NotAbove0 => texture.share_not_above(0.0),
            Unfit::NoFractions => texture.share_beyond(0.0, 1.0),
            Unfit::NoShare => texture.share_of_scalars_beyond(0.0, 1.0),
        })
    }

    /// All textures in the order of their numbers.
    pub(super) fn into_arena(self) -> Vec<Texture> {
        self.textures
    }

    /// The key of an image in the table.
    fn load(&mut self, path: &str, span: Span, context: &mut Context) -> String {
        let named = (span.source, path.to_owned());
        if let Some(file) = self.found.get(&named) {
            return file.clone();
        }
        let stand_in = "a picture of magenta and black squares";
        let (file, image) = match context.read_or_stand_in(path, span, stand_in) {
            Some(found) if self.images.contains_key(&found.path) => (found.path, None),
            Some(found) => {
                let image = decode(&found.path, &found.bytes, span, context);
                (found.path, Some(image))
            }
            None if context.placeholders => (path.to_owned(), Some(squares())),
            None => (path.to_owned(), Some(grey())),
        };
        if let Some(image) = image {
            self.images.insert(file.clone(), Arc::new(image));
        }
        self.found.insert(named, file.clone());
        file
    }
}

fn bits(mapping: &Mapping) -> [u64; 6] {
    let ([a, b, c, d], [x, y]) = (mapping.matrix, mapping.translation);
    [a, b, c, d, x, y].map(|v| v.to_f64().to_bits())
}

/// How coordinates of the mesh become those of the map.
fn mapping(node: &Node, context: &mut Context) -> Mapping {
    let Some(generation) = node.node("tex_coord_generation") else { return Mapping::IDENTITY };
    if let Some(spherical) = generation.node("spherical") {
        spherical.disregard();
        let message = "<spherical> coordinates are of a later format version (2.0) and not rendered: those of the mesh stand in";
        context.sink.push_or_count(Diagnostic::warning(codes::STANDS_IN, spherical.span, message));
    }
    let Some(uv) = generation.node("uv") else { return Mapping::IDENTITY };
    Mapping {
        matrix: numbers(uv, "matrix", context).unwrap_or(Mapping::IDENTITY.matrix),
        translation: numbers(uv, "translation", context).unwrap_or(Mapping::IDENTITY.translation),
    }
}

/// The numbers of a field, of which there have to be so many.
fn numbers<const N: usize>(node: &Node, field: &str, context: &mut Context) -> Option<[Real; N]> {
    node.value(field)?;
    let given = node.reals(field);
    let numbers = <[f64; N]>::try_from(given.value.as_slice());
    if numbers.is_err() {
        context.sink.push(
            Diagnostic::error(
                indigo_decl::codes::WRONG_TYPE,
                given.span,
                format!("a {field} of {} numbers", given.value.len()),
            )
            .expected(format!("expected {N} numbers")),
        );
    }
    Some(numbers.ok()?.map(Real::from_f64))
}

fn decode(file: &str, bytes: &[u8], span: Span, context: &mut Context) -> Image {
    let mut image = context.picture(file, bytes, span);
    if let Ok(Image { primaries: Some(primaries), .. }) = &image
        && rec709_of(*primaries) != Some(Mat3::IDENTITY)
    {
        let note = format!("{file}: its colours are not those of Rec. 709, and are taken as if they were");
        context.sink.push(Diagnostic::warning(codes::FILE_NOTE, span, note));
    }
    if let Ok(Image { pixels: Pixels::F32(values), .. }) = &mut image {
        let bad = drop_no_numbers(values);
        if bad > 0 {
            let note = format!("{file}: {bad} of its values are infinite or no numbers, and taken as 0");
            context.sink.push(Diagnostic::warning(codes::BAD_TEXELS, span, note));
        }
    }
    image.unwrap_or_else(|error| {
        context.sink.push(
            Diagnostic::error(codes::BAD_FILE, span, format!("{file}: bad picture file"))
                .expected(format!("expected {}, found {}", error.expected, error.found)),
        );
        grey()
    })
}

/// Sets values that are infinite or no numbers to 0, and tells how many they were.
fn drop_no_numbers(values: &mut [f32]) -> usize {
    let bad = values.iter_mut().filter(|v| !v.is_finite());
    bad.map(|v| *v = 0.0).count()
}

fn grey() -> Image {
    Image { width: 1, height: 1, channels: 1, pixels: Pixels::U8(vec![128]), primaries: None, notes: vec![] }
}

/// What stands in for a picture that is missing: nobody paints anything so.
fn squares() -> Image {
    const SIDE: u32 = 64;
    const SQUARE: u32 = 8;
    let texel = |i: u32| {
        if (i % SIDE / SQUARE + i / SIDE / SQUARE).is_multiple_of(2) { [255, 0, 255] } else { [0; 3] }
    };
    let texels = (0..SIDE * SIDE).flat_map(texel).collect();
    Image {
        width: SIDE,
        height: SIDE,
        channels: 3,
        pixels: Pixels::U8(texels),
        primaries: None,
        notes: vec![],
    }
}
