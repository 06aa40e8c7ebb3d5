//! Lowering: from checked elements to a scene that can be traced.
//!
//! Each part of the scene has a file. What none of them reads is reported at the end: it would have
//! no effect.

mod aperture;
mod camera;
mod environment;
mod geometry;
mod lamps;
mod lights;
mod materials;
mod media;
mod meshes;
mod names;
mod picture;
mod placement;
mod portal_probe;

use crate::codes;
use crate::load::LoadOptions;
use crate::scene::{MetropolisSettings, OutputSettings, Scene, TransportSettings};
use crate::settings::Settings;
use geometry::Geometry;
use indigo_decl::{Node, report_unread};
use indigo_diag::{Diagnostic, Severity, Sink, SourceMap, Span};
use indigo_geom::{Accel, BuildOptions};
use indigo_math::Vec3d;
use indigo_scatter::MediumStack;
use materials::MaterialTable;
use meshes::MeshTable;
use std::sync::Arc;

/// What all parts of lowering share.
struct Context<'a> {
    options: &'a LoadOptions<'a>,
    sources: &'a mut SourceMap,
    sink: &'a mut Sink,
}

impl Context<'_> {
    /// A place in words.
    fn place(&self, span: Span) -> String {
        let p = self.sources.position(span);
        format!("{}:{}:{}", self.sources.name(span.source), p.line, p.column)
    }

    /// The bytes of a file named in the scene; `None` after reporting why not.
    fn read(&mut self, path: &str, span: Span) -> Option<indigo_decl::Resolved> {
        match self.options.resolver.read(path, self.sources.name(span.source)) {
            Ok(found) => Some(found),
            Err(error) => {
                self.sink.push(Diagnostic::error(
                    codes::MISSING_FILE,
                    span,
                    format!("cannot read {path}: {error}"),
                ));
                None
            }
        }
    }
}

/// Lowers a scene. `None` where an error, now in the sink, leaves nothing to trace.
pub(crate) fn lower(
    root: &Node,
    settings: &Settings,
    path: &str,
    options: &LoadOptions,
    sources: &mut SourceMap,
    sink: &mut Sink,
) -> Option<Scene> {
    let mut context = Context { options, sources, sink };
    let scene = build(root, settings, path, &mut context);
    root.mark_used();
    report_unread(root, Severity::Error, context.sink);
    settings.report_unread(context.sink);
    scene
}

fn build(root: &Node, settings: &Settings, path: &str, context: &mut Context) -> Option<Scene> {
    let transport = transport(settings);
    let film = picture::film(settings, context.sink);
    let output = picture::output(settings, context.sink, path);
    let camera_node = find_camera(root, context.sink);
    if camera_node.is_none() {
        camera::settings_without_camera(settings);
    }
    let aperture_preview = camera_node.is_some_and(|c| c.has("aperture_shape"));
    let origin = camera_node.map_or(Vec3d::ZERO, |c| camera::position(c, context.sink));
    let camera = camera_node.and_then(|c| camera::parameters(c, settings, film.as_ref(), context));

    let mut meshes = MeshTable::new(root, context.sink);
    let mut materials = MaterialTable::new(root, context.sink);
    let mut geometry = Geometry::new(origin);
    geometry.add_objects(root, settings, &mut meshes, &mut materials, context);
    let mut lights = lights::Lights::default();
    lights.add_environment(root, context);
    lights.add_mesh_lights(root, &mut geometry, &mut meshes, &mut materials, context);
    lights.add_rectangles(root, &mut geometry, &mut meshes, &mut materials, context.sink);
    lights.add_portals(root, &geometry, &mut meshes, context);
    root.visit_references(&mut |what, name, span| match what {
        "mesh" => meshes.check_name(name, span, context.sink),
        "medium" => materials.check_medium(name, span, context.sink),
        _ => materials.check_name(name, span, context.sink),
    });
    meshes.disregard_unused();
    materials.disregard_unused();

    let picture = picture::picture(root, camera_node.zip(camera.as_ref()), settings, context.sink);
    let threshold = usize::try_from(settings.int("bih_tri_threshold").value).unwrap_or(usize::MAX);
    let caching = settings.bool("cache_trees");
    // A light that is there but wrong, or not rendered, has its own message.
    let is_dark = LIGHTS.iter().all(|light| !root.has(light) && !root.is_faulty(light));
    if is_dark && !context.sink.has_errors() {
        context.sink.push(
            Diagnostic::warning(
                codes::NO_LIGHT,
                root.span,
                "the scene has no light: the picture will be black",
            )
            .hint("add a <background>, a <meshlight> or a <rectanglelight>"),
        );
    }
    if context.sink.has_errors() || context.options.check_only {
        return None;
    }
    let build_options = BuildOptions { fast_threshold: threshold, ..BuildOptions::default() };
    let trees: &dyn indigo_geom::TreeStore =
        if caching { context.options.trees } else { &indigo_geom::NoStore };
    let accel = match Accel::build(meshes.into_triangles(), geometry.objects(), &build_options, trees) {
        Ok(accel) => accel,
        Err(error) => {
            context.sink.push(Diagnostic::error(codes::GEOMETRY, root.span, error.to_string()));
            return None;
        }
    };
    let camera = camera::focus(camera?, &accel).into_camera()?;
    let lights = lights.into_table(&geometry, &accel);
    portal_probe::warn_of_openings(root, &accel, &lights, origin, context);
    let lamps: Vec<Option<u32>> = geometry.lights().collect();
    let (first_slot, slots) = geometry.into_slots();
    let (materials, textures, media) = materials.into_arenas();
    let mut scene = Scene {
        has_unseen_surfaces: slots.iter().any(|&m| materials[m as usize].may_be_unseen()),
        accel,
        lights,
        camera,
        textures,
        media,
        camera_media: MediumStack::AIR,
        lamp_media: vec![],
        materials,
        first_slot,
        slots,
        nudge_m: settings.real("ray_origin_nudge_distance") as indigo_math::Real,
        transport,
        film: film?,
        picture: picture?,
        output: OutputSettings { aperture_preview, ..output },
    };
    scene.find_starting_media(&lamps);
    Some(scene)
}

/// Elements that give light.
const LIGHTS: [&str; 5] = ["background", "skylight", "env_map", "meshlight", "rectanglelight"];

fn find_camera<'a>(root: &'a Node, sink: &mut Sink) -> Option<&'a Node> {
    let camera = root.node("camera");
    if camera.is_none() {
        sink.push(
            Diagnostic::error(codes::NO_CAMERA, root.span, "the scene has no camera")
                .expected("expected a <camera> inside"),
        );
    }
    camera
}

fn transport(settings: &Settings) -> TransportSettings {
    let hybrid = settings.bool("hybrid");
    // A hybrid leaves indirect light to Metropolis sampling, whatever `metropolis` says.
    let metropolis = (settings.bool("metropolis") || hybrid).then(|| MetropolisSettings {
        large_mutation_prob: settings.real("large_mutation_prob"),
        max_change: settings.real("max_change") as indigo_math::Real,
        max_consecutive_rejections: settings.int("max_num_consec_rejections").value,
    });
    if metropolis.is_none() {
        for field in ["large_mutation_prob", "max_change", "max_num_consec_rejections"] {
            settings.disregard(field);
        }
    }
    TransportSettings {
        max_depth: u32::try_from(settings.int("max_depth").value).unwrap_or(u32::MAX),
        bidirectional: settings.bool("bidirectional"),
        metropolis,
        hybrid,
    }
}

/// An empty file, for resources that could not be read.
fn nothing() -> Arc<[u8]> {
    Arc::from([])
}
