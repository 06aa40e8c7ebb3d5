//! Lights that are infinitely far away.

use super::materials::MaterialTable;
use super::{Context, background};
use crate::codes;
use indigo_decl::Node;
use indigo_diag::{Diagnostic, Span};
use indigo_formats::image::{Image, Pixels};
use indigo_formats::{FormatError, Position, float_map};
use indigo_light::DistantLight;
use indigo_light::kinds::background::Background;
use indigo_light::kinds::env_map::{EnvMap, Layout};
use indigo_light::kinds::sky::{Sky, SkyModel};
use indigo_light::kinds::sun::{self, Sun};
use indigo_light::sky::hosek::{self, HosekSky};
use indigo_light::sky::preetham::{self, PreethamSky};
use indigo_light::sky::space;
use indigo_math::{Mat3, Vec3d};
use indigo_spectrum::adaptation::rec709_of;
use indigo_spectrum::{Spectrum, read};
use indigo_texture::Curve;

/// All distant lights of a scene; their radiances add.
pub(super) fn distant_lights(
    root: &Node,
    materials: &MaterialTable,
    context: &mut Context,
) -> Vec<(DistantLight, u16)> {
    let mut lights = vec![];
    // What names no layer is of the first.
    let layer = materials.layer(0);
    if let Some(spectrum) = root.node("background").and_then(|b| b.node("spectrum")) {
        let colour = layer.colour.clone().unwrap_or(Spectrum::uniform(1.0));
        let radiance = read::emission(spectrum, context.sink).times(&colour);
        lights.push((Background(radiance).into(), layer.group));
    }
    if let Some(node) = root.node("skylight") {
        lights.extend(skylight(node, 1.0, materials, context));
    }
    if let Some(map) = root.node("env_map").and_then(Node::alternative) {
        layer.keep_colour_out_of(map, context.sink);
        lights.extend(env_map(map, context).map(|light| (light, layer.group)));
    }
    if let Some(settings) = root.node("background_settings") {
        lights.extend(background::lights(settings, materials, context));
    }
    lights
}

/// The sun, and the sky unless it is black, `gain` times as bright, each with its layer.
pub(super) fn skylight(
    node: &Node,
    gain: f64,
    materials: &MaterialTable,
    context: &mut Context,
) -> Vec<(DistantLight, u16)> {
    let [sun_layer, sky_layer] = ["sun_layer", "sky_layer"].map(|field| materials.layer(node.int(field)));
    let sundir = Vec3d::from(node.vec3("sundir"));
    let turbidity = node.real("turbidity");
    let model = node.text("model").value;
    let is_preetham = ["preetham", "original"].contains(&model.as_str());
    if model == "captured-simulation" {
        let message = "the sky of <captured-simulation> (of version 3.0) is not rendered: that of Hosek and Wilkie stands in";
        context.sink.push(Diagnostic::warning(codes::STANDS_IN, node.span_of("model"), message));
    }
    let is_outside = node.bool("extra_atmospheric");
    let Some(towards) = sundir.try_normalized().filter(|d| d.z > 0.0) else {
        context.sink.push(
            Diagnostic::error(
                indigo_decl::codes::OUT_OF_RANGE,
                node.span_of("sundir"),
                "the sun must stand above the horizon",
            )
            .expected(format!("expected z > 0, found {}", sundir.z)),
        );
        return vec![];
    };
    if gain == 0.0 {
        return vec![];
    }
    if is_outside {
        let disc = space::sun(Sun::solid_angle(sun::RADIUS)).scaled(gain);
        read::refuse_excess(&disc.radiance, node.span, context.sink);
        sun_layer.keep_colour_out_of(node, context.sink);
        return vec![(Sun::new(towards, sun::RADIUS, disc).into(), sun_layer.group)];
    }
    let [least, most] = if is_preetham { preetham::TURBIDITY } else { hosek::TURBIDITY };
    let known = turbidity.clamp(least, most);
    if known != turbidity {
        context.sink.push(
            Diagnostic::warning(
                codes::TURBIDITY,
                node.span_of("turbidity"),
                format!("the sky is that of turbidity {known}: the model knows {least} to {most}"),
            )
            .expected(format!("found {turbidity}")),
        );
    }
    let elevation = towards.z.min(1.0).asin();
    let (model, disc) = if is_preetham {
        let sky = SkyModel::Preetham(Box::new(PreethamSky::new(elevation, known).scaled(gain)));
        (sky, preetham::sun(elevation, known))
    } else {
        let sky = SkyModel::Hosek(Box::new(HosekSky::new(elevation, known).scaled(gain)));
        (sky, hosek::sun(elevation, known))
    };
    for layer in [&sky_layer, &sun_layer] {
        layer.keep_colour_out_of(node, context.sink);
    }
    let disc = disc.scaled(gain);
    read::refuse_excess(&disc.radiance, node.span, context.sink);
    let (sky, sun) = (Sky::new(towards, model), Sun::new(towards, sun::RADIUS, disc));
    vec![(sky.into(), sky_layer.group), (sun.into(), sun_layer.group)]
}

/// What a picture of the surroundings is stood in for by.
pub(super) const MAGENTA_LIGHT: &str = "an even magenta light";

/// The same as light of some radiance, where that is asked for.
pub(super) fn magenta_light(gain: f64, context: &Context) -> Option<DistantLight> {
    let magenta = Spectrum::rgb_reflectance([0.8, 0.0, 0.8]);
    context.placeholders.then(|| Background(magenta.scaled(gain)).into())
}

fn env_map(node: &Node, context: &mut Context) -> Option<DistantLight> {
    let path = node.text("path");
    let gain = node.real("gain");
    let width = (node.block.name == "spherical").then(|| node.int("width"));
    // A width that is not there or wrong was reported, and none fits the file.
    if width.is_some() && (!node.has("width") || node.is_faulty("width")) {
        node.disregard();
        return None;
    }
    let Some(file) = context.read_or_stand_in(&path.value, path.span, MAGENTA_LIGHT) else {
        return magenta_light(gain, context);
    };
    let (layout, image) = match width {
        Some(width) => {
            (Layout::Angular, float_map::decode(&file.bytes, u32::try_from(width).unwrap_or(u32::MAX)))
        }
        None => (Layout::LatLong, context.picture(&file.path, &file.bytes, path.span)),
    };
    Surroundings { layout, curve: None, gain }
        .env_map(image, &file.path, path.span, context)
        .map(DistantLight::from)
}

/// How a picture is one of the surroundings.
pub(super) struct Surroundings {
    pub(super) layout: Layout,
    /// What makes its values linear; without it they must be so.
    pub(super) curve: Option<Curve>,
    pub(super) gain: f64,
}

impl Surroundings {
    /// The light of a picture file; `None` after reporting what is wrong with it.
    pub(super) fn env_map(
        &self,
        image: Result<Image, FormatError>,
        file: &str,
        span: Span,
        context: &mut Context,
    ) -> Option<EnvMap> {
        let image = image.map(|image| match self.curve {
            Some(curve) => curved(&image, curve),
            None => image,
        });
        let texels = image.and_then(|image| Ok((image.width, image.height, linear_texels(image)?)));
        let (width, height, mut texels) = match texels {
            Ok(found) => found,
            Err(error) => {
                let place = match error.position {
                    Position::Text { .. } => format!("{file}:{}", error.position),
                    Position::Byte(_) | Position::Unpacked(_) => file.to_owned(),
                };
                context.sink.push(
                    Diagnostic::error(codes::BAD_FILE, span, format!("{place}: bad environment map"))
                        .expected(format!("expected {}, found {}", error.expected, error.found)),
                );
                return None;
            }
        };
        let bad = scale(&mut texels, self.gain);
        if bad > 0 {
            let what = if bad == 1 { "1 texel is".to_owned() } else { format!("{bad} texels are") };
            context.sink.push(Diagnostic::warning(
                codes::BAD_TEXELS,
                span,
                format!(
                    "{file}: {what} negative, too large or no number, and taken as the nearest that can be"
                ),
            ));
        }
        Some(EnvMap::new(self.layout, width as usize, height as usize, texels))
    }
}

/// A picture whose values a curve has made linear.
fn curved(image: &Image, curve: Curve) -> Image {
    let to_linear = |x: f64| curve.apply(x) as f32;
    let values = match &image.pixels {
        Pixels::U8(v) => v.iter().map(|&x| to_linear(f64::from(x) / 255.0)).collect(),
        Pixels::U16(v) => v.iter().map(|&x| to_linear(f64::from(x) / 65535.0)).collect(),
        Pixels::F32(v) => v.iter().map(|&x| to_linear(f64::from(x))).collect(),
    };
    Image { pixels: Pixels::F32(values), notes: vec![], ..*image }
}

/// The texels of a picture in linear light, whose colours are those of Rec. 709: integers are not, and have not the range.
fn linear_texels(image: Image) -> Result<Vec<[f32; 3]>, FormatError> {
    let Pixels::F32(values) = image.pixels else {
        return Err(FormatError::new(
            Position::Byte(0),
            "a picture of high dynamic range (EXR or HDR)",
            "a picture of 8 or 16 bits",
        ));
    };
    if image.channels == 1 {
        return Ok(values.into_iter().map(|v| [v; 3]).collect());
    }
    let texels = values.as_chunks::<3>().0.to_vec();
    let Some(primaries) = image.primaries else { return Ok(texels) };
    let Some(matrix) = rec709_of(primaries) else {
        let position = Position::Byte(0);
        let found = format!("chromaticities of {primaries:?}");
        return Err(FormatError::new(position, "red, green and blue that mix to a white", found));
    };
    if matrix == Mat3::IDENTITY {
        return Ok(texels);
    }
    let convert = |texel: [f32; 3]| (matrix * Vec3d::from(texel.map(f64::from))).to_array().map(|v| v as f32);
    Ok(texels.into_iter().map(convert).collect())
}

/// Multiplies all texels, and counts those that cannot be light. Of their components negative ones, which saturated
/// colours of wide gamuts have, and those that are no number become 0; too large ones, such as a sun beyond the
/// range of half floats, as large as the largest that can be.
fn scale(texels: &mut [[f32; 3]], gain: f64) -> usize {
    let can_be = 0.0..=read::LARGEST as f32;
    let scaled = |v: f32| (f64::from(v) * gain) as f32;
    let possible = texels.iter().flatten().map(|&v| scaled(v)).filter(|v| can_be.contains(v));
    let largest = possible.fold(0.0, f32::max);
    let nearest = |v: f32| if v > largest { largest } else { v.max(0.0) };
    let mut bad = 0;
    for texel in texels {
        let light = texel.map(scaled);
        bad += usize::from(!light.iter().all(|v| can_be.contains(v)));
        *texel = light.map(nearest);
    }
    bad
}
