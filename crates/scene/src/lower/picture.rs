//! Film, picture and output.

use super::Context;
use super::camera::Unfocused;
use super::light_layers::Layers;
use crate::codes;
use crate::scene::{
    DIFFRACTION_OF_RAYS, FOREGROUND_ALPHA, FilmSettings, LAYER_SETTING, OutputSettings, RENDER_REGION,
    TransportSettings, region_in_words,
};
use crate::settings::Settings;
use indigo_decl::Node;
use indigo_diag::{Diagnostic, Sink, Spanned};
use indigo_film::{FilmFilter, FilmSize, Filter, LightMix};
use indigo_formats::response;
use indigo_imaging::{Bloom, Exposure, PictureSettings, Region, Response, ToneMapping, WhiteBalance, png};
use indigo_spectrum::illuminant;
use std::sync::Arc;

/// The tone mapping of a scene that has none.
const DEFAULT_TONE_MAPPING: ToneMapping =
    ToneMapping::Reinhard { pre_scale: 4.0, post_scale: 1.2, burn: 6.0 };

/// The film; `None` after reporting an impossible size.
pub(super) fn film(settings: &Settings, sink: &mut Sink) -> Option<FilmSettings> {
    let dimension = |field: &str| u32::try_from(settings.int(field).value).unwrap_or(u32::MAX);
    let (width, height) = (dimension("width"), dimension("height"));
    let filter = filter(settings, "splat_filter", sink);
    let factor = dimension("super_sample_factor");
    let size = FilmSize::new(width, height, factor)
        .map_err(|_| {
            // Of the three the one that is to blame, as far as one is.
            let blamed = match (FilmSize::new(width, height, 1), width >= height) {
                (Ok(_), _) => "super_sample_factor",
                (Err(_), true) => "width",
                (Err(_), false) => "height",
            };
            let [w, h, s] = ["width", "height", "super_sample_factor"].map(|f| settings.int(f).value);
            sink.push(
                Diagnostic::error(
                    codes::PICTURE_SIZE,
                    settings.span_of(blamed),
                    format!("a picture of {w} x {h} pixels, super-sampled {s} times, is too large"),
                )
                .expected(format!(
                    "expected at most {} pixels a side and {} in all, each side times {s}",
                    FilmSize::MAX_SIDE,
                    FilmSize::MAX_PIXELS
                )),
            );
        })
        .ok()?;
    let region =
        region(settings, size, sink).map(|r| [[r.start()[0], r.end()[0]], [r.start()[1], r.end()[1]]]);
    let prepared = FilmFilter::new(filter, size)
        .map_err(|e| {
            sink.push(Diagnostic::error(
                codes::PICTURE_SIZE,
                settings.span_of("splat_filter"),
                e.to_string(),
            ));
        })
        .ok()?;
    Some(FilmSettings { size, splat: filter, filter: prepared, region })
}

/// Name and value of the settings that decide what the film converges to, or which layers it has.
pub(super) fn decisive(
    settings: &Settings,
    film: &FilmSettings,
    transport: &TransportSettings,
    layers: &Layers,
) -> Vec<(String, String)> {
    let size = film.size;
    // Only Metropolis sampling looks at it.
    let rejections = transport.metropolis.map_or(0, |m| m.max_consecutive_rejections);
    let by_rays = settings.bool("aperture_diffraction") && !settings.bool("post_process_diffraction");
    let is_mask = settings.bool(FOREGROUND_ALPHA);
    let mut values = vec![
        (FOREGROUND_ALPHA, is_mask.to_string()),
        ("width", size.width().to_string()),
        ("height", size.height().to_string()),
        ("super_sample_factor", size.super_sample().to_string()),
        (RENDER_REGION, region_in_words(film.region)),
        ("splat_filter", film.splat.to_string()),
        ("ray_origin_nudge_distance", settings.real("ray_origin_nudge_distance").to_string()),
        ("vignetting", settings.bool("vignetting").to_string()),
        (DIFFRACTION_OF_RAYS, by_rays.to_string()),
    ];
    values.extend(layers.decisive().map(|value| (LAYER_SETTING, value)));
    if !is_mask {
        // A mask is rendered in one way, whatever these say.
        values.extend([
            ("bidirectional", transport.bidirectional.to_string()),
            ("metropolis", transport.metropolis.is_some().to_string()),
            ("hybrid", transport.hybrid.to_string()),
            ("max_depth", transport.max_depth.to_string()),
            ("max_num_consec_rejections", rejections.to_string()),
            // Direct and indirect light, and the background, are kept apart then.
            ("save_layers_exr", settings.bool("save_layers_exr").to_string()),
        ]);
    }
    values.into_iter().map(|(name, value)| (name.to_owned(), value)).collect()
}

fn region(settings: &Settings, size: FilmSize, sink: &mut Sink) -> Option<Region> {
    let node = settings.node("render_region")?;
    let at = |field: &str| u32::try_from(node.int(field)).unwrap_or(u32::MAX);
    Region::new([at("x1"), at("y1")], [at("x2"), at("y2")], size)
        .map_err(|e| {
            sink.push(Diagnostic::error(codes::PICTURE_SIZE, node.span, e.to_string()).expected(format!(
                "expected x1 < x2 <= {} and y1 < y2 <= {}",
                size.width(),
                size.height()
            )));
        })
        .ok()
}

fn filter(settings: &Settings, field: &str, sink: &mut Sink) -> Filter {
    // Without a kind there was an error, or a word that this stands in.
    let Some(kind) = settings.node(field).and_then(Node::alternative) else { return Filter::Box };
    kind.mark_used();
    let filter = match kind.block.name {
        "box" => Filter::Box,
        "gaussian" => Filter::Gaussian,
        _ => Filter::MitchellNetravali { blur: kind.real("blur"), ring: kind.real("ring") },
    };
    match filter.check() {
        Ok(()) => filter,
        Err(error) => {
            sink.push(Diagnostic::error(indigo_decl::codes::OUT_OF_RANGE, kind.span, error.to_string()));
            Filter::Box
        }
    }
}

/// How the picture is made; `None` after reporting what is wrong.
pub(super) fn picture(
    root: &Node,
    camera: Option<(&Node, &Unfocused)>,
    settings: &Settings,
    context: &mut Context,
) -> Option<PictureSettings> {
    let tone_mapping = tone_mapping(root, context);
    let sink = &mut *context.sink;
    let downsize = filter(settings, "downsize_filter", sink);
    let foreground_alpha = settings.bool("render_foreground_alpha");
    let (camera, opening) = camera?;
    let white_balance = white_balance(camera, sink);
    let exposure = Exposure {
        aperture_area: opening.aperture_area(),
        lens_sensor_dist: camera.real("lens_sensor_dist"),
        duration: camera.real("exposure_duration"),
    };
    let region = film(settings, &mut Sink::new()).and_then(|f| {
        let [x, y] = f.region?;
        Region::new([x[0], y[0]], [x[1], y[1]], f.size).ok()
    });
    let watermark = settings.bool("watermark");
    Some(PictureSettings {
        // They are known to others.
        lights: LightMix::default(),
        diffraction: opening.filter(),
        bloom: bloom(camera),
        tone_mapping,
        white_balance: white_balance?,
        downsize,
        exposure,
        foreground_alpha,
        region,
        watermark,
    })
}

/// By `white_balance` where it is given, else by `white_point`; `None` after reporting that it is no white.
fn white_balance(camera: &Node, sink: &mut Sink) -> Option<WhiteBalance> {
    let Spanned { value: xy, span } = match camera.node("white_point") {
        Some(point) if !camera.has("white_balance") => white_point(point)?,
        point => {
            if let Some(point) = point {
                let message = "<white_point> has no effect beside <white_balance>";
                sink.push(
                    Diagnostic::warning(codes::WHITE_TWICE, point.span, message).hint("take one of them out"),
                );
                point.disregard();
            }
            named_white(camera, sink)?
        }
    };
    WhiteBalance::from_white(xy)
        .map_err(|e| sink.push(Diagnostic::error(codes::UNKNOWN_WHITE, span, e.to_string())))
        .ok()
}

/// `None` where one of its numbers is wrong or missing, which was reported.
fn white_point(node: &Node) -> Option<Spanned<[f64; 2]>> {
    let of = node.node("chromaticity_coordinates")?;
    let xy = ["x", "y"].map(|field| of.real(field));
    let is_told = ["x", "y"].iter().all(|field| of.has(field) && !of.is_faulty(field));
    is_told.then_some(Spanned::new(xy, of.span))
}

fn named_white(camera: &Node, sink: &mut Sink) -> Option<Spanned<[f64; 2]>> {
    let Spanned { value, span } = camera.text("white_balance");
    let found = illuminant::white_point(&value);
    if found.is_none() {
        sink.push(
            Diagnostic::error(codes::UNKNOWN_WHITE, span, format!("'{value}' is not a white"))
                .expected("expected A, B, C, D50, D55, D65, D75, E, F1 to F12, or a chromaticity x y"),
        );
    }
    found.map(|xy| Spanned::new(xy, span))
}

fn bloom(camera: &Node) -> Option<Bloom> {
    let node = camera.node("bloom")?;
    Some(Bloom { weight: node.real("weight"), radius: node.real("radius") })
}

fn tone_mapping(root: &Node, context: &mut Context) -> ToneMapping {
    let Some(node) = root.node("tonemapping") else {
        context.sink.push(
            Diagnostic::warning(
                codes::NO_TONEMAPPING,
                root.span,
                "the scene has no <tonemapping>: reinhard 4, 1.2, 6 is used",
            )
            .hint("add <tonemapping><reinhard>...</reinhard></tonemapping>"),
        );
        return DEFAULT_TONE_MAPPING;
    };
    match node.alternative() {
        Some(t) if t.block.name == "linear" => ToneMapping::Linear { scale: t.real("scale") },
        Some(t) if t.block.name == "reinhard" => ToneMapping::Reinhard {
            pre_scale: t.real("pre_scale"),
            post_scale: t.real("post_scale"),
            burn: t.real("burn"),
        },
        Some(t) if t.block.name == "camera" => ToneMapping::Camera {
            response: Arc::new(response(t, context).unwrap_or_else(Response::display)),
            ev_adjust: t.real("ev_adjust"),
            film_iso: t.real("film_iso"),
        },
        // Without a kind that was reported.
        _ => DEFAULT_TONE_MAPPING,
    }
}

/// The response curves of a camera; `None` where none are named, or after reporting what is wrong with them.
fn response(camera: &Node, context: &mut Context) -> Option<Response> {
    let path = camera.text("response_function_path");
    if path.value.is_empty() {
        return None;
    }
    let found = context.read_curve(&path.value, path.span)?;
    let curves = response::read(&found.bytes).map_err(|error| {
        let message = format!("{} is no file of camera response curves: {error}", found.path);
        context.sink.push(Diagnostic::error(codes::BAD_FILE, path.span, message));
    });
    let curves = curves.ok()?;
    // One curve may serve all three colours.
    let mut oddities: Vec<_> =
        curves.iter().flat_map(|curve| &curve.oddities).map(ToString::to_string).collect();
    oddities.dedup();
    for oddity in oddities {
        let message = format!("{}:{oddity}", found.path);
        context.sink.push(Diagnostic::warning(codes::FILE_NOTE, path.span, message));
    }
    // What was read has been checked for all that is asked of curves here.
    Response::new([0, 1, 2].map(|c: usize| (&*curves[c].irradiance, &*curves[c].brightness)))
        .map(|response| response.named(&path.value))
}

fn png(settings: &Settings) -> png::Format {
    let depth = if settings.text("png_bits").value == "16" { png::Depth::Sixteen } else { png::Depth::Eight };
    png::Format { depth, dithered: settings.bool("dithering") }
}

/// What is written, and when.
pub(super) fn output(settings: &Settings, scene_path: &str) -> OutputSettings {
    let positive = |field: &str| Some(settings.real(field)).filter(|v| *v > 0.0);
    let threads = usize::try_from(settings.int("num_threads").value).unwrap_or(1);
    OutputSettings {
        scene_path: scene_path.to_owned(),
        untonemapped_exr: settings.bool("save_untonemapped_exr"),
        tonemapped_exr: settings.bool("save_tonemapped_exr"),
        layers_exr: settings.bool("save_layers_exr"),
        denoised: settings.bool("denoise"),
        // The camera knows.
        aperture_preview: false,
        igi: settings.bool("save_igi"),
        png: png(settings),
        image_save_period: settings.real("image_save_period"),
        frame_upload_period: settings.real("frame_upload_period"),
        halt_time: positive("halt_time"),
        halt_samples_per_pixel: positive("halt_samples_per_pixel"),
        threads: (!settings.bool("auto_choose_num_threads")).then_some(threads),
        logging: settings.bool("logging"),
        display_period: settings.real("display_period"),
    }
}
