//! Lowering: from checked elements to a scene that can be traced.
//!
//! Each part of the scene has a file. What none of them reads is reported at the end: it would have
//! no effect.

mod aperture;
mod background;
mod camera;
mod closed;
mod complex_index;
mod dense_probe;
mod emission;
mod environment;
mod geometry;
mod keyframes;
mod lamps;
mod light_layers;
mod lights;
mod materials;
mod media;
mod meshes;
mod names;
mod picture;
mod placement;
mod portal_probe;
mod scales;
mod textures;

use crate::codes;
use crate::load::LoadOptions;
use crate::scene::{
    Development, Identity, MetropolisSettings, Names, OutputSettings, Scene, TransportSettings,
};
use crate::settings::Settings;
use geometry::Geometry;
use indigo_decl::{Node, ResolveError, Resolved, Resolver, hint_of_shipped, report_unread};
use indigo_diag::{Diagnostic, Severity, Sink, SourceId, SourceMap, Span};
use indigo_formats::FormatError;
use indigo_formats::image::{self, Image};
use indigo_geom::{Accel, BuildError, BuildOptions, Movement, Object, SurfacePoint};
use indigo_imaging::PictureSettings;
use indigo_math::Vec3d;
use indigo_scatter::{Material, MediumStack};
use indigo_spectrum::WavelengthSampler;
use light_layers::Layers;
use materials::MaterialTable;
use meshes::MeshTable;
use std::collections::HashSet;

/// What all parts of lowering share.
pub(crate) struct Context<'a> {
    pub options: &'a LoadOptions<'a>,
    /// Whether something stands in for textures and meshes whose files are missing.
    pub placeholders: bool,
    /// Where files come from that only the development of the picture looks at.
    pub development: &'a dyn Resolver,
    pub sources: &'a mut SourceMap,
    pub sink: &'a mut Sink,
    /// Paths of files that were asked for, and the files that name them.
    pub asked: HashSet<(String, SourceId)>,
    /// Those of them that are missing, and of which that was told as an error.
    pub missing: HashSet<(String, SourceId)>,
}

impl Context<'_> {
    /// A place in words.
    fn place(&self, span: Span) -> String {
        let p = self.sources.position(span);
        format!("{}:{}:{}", self.sources.name(span.source), p.line, p.column)
    }

    /// The bytes of a file named in the scene; `None` after reporting why not. An empty path is that of an element
    /// without one, which was reported; of a scene that is not wanted any more nothing is.
    fn read(&mut self, path: &str, span: Span) -> Option<Resolved> {
        if path.is_empty() || self.options.is_stopped() {
            return None;
        }
        self.asked.insert((path.to_owned(), span.source));
        let found = self.options.resolver.read(path, self.sources.name(span.source));
        self.or_report(found, path, span)
    }

    /// The same for a file that something can stand in for, in words: if that is asked for, its lack is no error.
    fn read_or_stand_in(&mut self, path: &str, span: Span, stand_in: &str) -> Option<Resolved> {
        if !self.placeholders || path.is_empty() {
            return self.read(path, span);
        }
        self.asked.insert((path.to_owned(), span.source));
        let found = self.options.resolver.read(path, self.sources.name(span.source));
        let missing = |error| {
            let message = format!("cannot read {path}: {error}; {stand_in} stands in");
            self.sink.push(Diagnostic::warning(codes::PLACEHOLDER, span, message));
        };
        found.map_err(missing).ok()
    }

    /// The same for response curves, which decide only how the film is developed, and came with programs and not with
    /// scenes: without theirs a scene opens all the same.
    fn read_curve(&mut self, path: &str, span: Span) -> Option<Resolved> {
        self.asked.insert((path.to_owned(), span.source));
        let found = self.development.read(path, self.sources.name(span.source));
        if let Err(error @ ResolveError::NotFound { .. }) = &found {
            let message = format!("cannot read {path}: {error}; the response of a display stands in");
            self.sink.push(Diagnostic::warning(codes::PLACEHOLDER, span, message));
            return None;
        }
        self.or_report(found, path, span)
    }

    /// The picture that a file holds; what of the file is not in it is told.
    fn picture(&mut self, file: &str, bytes: &[u8], span: Span) -> Result<Image, FormatError> {
        let image = image::decode(file, bytes)?;
        for note in &image.notes {
            let message = format!("{file}: {note}");
            self.sink.push_or_count(Diagnostic::warning(codes::FILE_NOTE, span, message));
        }
        Ok(image)
    }

    /// Reports files that cannot be had and that nothing has asked for: what names them has no effect, unless it is a fault that
    /// keeps from using it.
    fn report_missing_unused(&mut self, root: &Node) {
        let why = if self.sink.has_errors() {
            "which nothing uses that could be read"
        } else {
            "which has no effect here"
        };
        let mut paths = vec![];
        root.visit_paths(&mut |path, span| paths.push((path.to_owned(), span)));
        for (path, span) in paths {
            let from = self.sources.name(span.source);
            if !self.asked.insert((path.clone(), span.source)) {
                continue;
            }
            if let Err(error) = self.options.resolver.read(&path, from) {
                let message = format!("cannot read {path}, {why}: {error}");
                let missing = Diagnostic::warning(codes::IDLE_MISSING, span, message);
                self.sink.push(missing.expected(error.expected()));
            }
        }
    }

    /// Reports what cannot be had: one fault, however many things of a file use it.
    fn or_report(
        &mut self,
        found: Result<Resolved, ResolveError>,
        path: &str,
        span: Span,
    ) -> Option<Resolved> {
        match found {
            Ok(found) => Some(found),
            Err(_) if !self.missing.insert((path.to_owned(), span.source)) => None,
            Err(error) => {
                let from = self.sources.name(span.source);
                let hint = hint_of_shipped(path, from, &error, self.options.resolver);
                let message = format!("cannot read {path}: {error}");
                let missing =
                    Diagnostic::error(codes::MISSING_FILE, span, message).expected(error.expected());
                self.sink.push(Diagnostic { hint, ..missing });
                None
            }
        }
    }
}

/// Lowers a scene. `None` where an error, now in the sink, leaves nothing to trace.
pub(crate) fn lower(root: &Node, settings: &Settings, path: &str, mut context: Context) -> Option<Scene> {
    let scene = build(root, settings, path, &mut context);
    // It takes reading them.
    if context.options.check_only {
        context.report_missing_unused(root);
    }
    root.mark_used();
    report_unread(root, Severity::Error, context.sink);
    settings.report_unread(context.sink);
    scene
}

/// Lowers only what developing a film takes. `None` where an error, now in the sink, keeps it from that.
pub(crate) fn development(
    root: &Node,
    settings: &Settings,
    path: &str,
    mut context: Context,
) -> Option<Development> {
    let transport = transport(settings);
    let film = picture::film(settings, context.sink);
    let output = picture::output(settings, path);
    let node = find_camera(root, context.sink);
    let camera = node.and_then(|c| camera::parameters(c, settings, film.as_ref(), &mut context));
    let layers = Layers::new(settings, context.sink);
    let picture = picture::picture(root, node.zip(camera.as_ref()), settings, &mut context)?;
    let picture = PictureSettings { lights: layers.all(), ..picture };
    let light_layers = layers.decisive();
    let position = node.map_or(Vec3d::ZERO, |c| camera::position(c, context.sink));
    let camera = camera?.facts(position, &picture);
    Some(Development { transport, size: film?.size, picture, light_layers, camera, output })
}

fn build(root: &Node, settings: &Settings, path: &str, context: &mut Context) -> Option<Scene> {
    let transport = transport(settings);
    let film = picture::film(settings, context.sink);
    let output = picture::output(settings, path);
    let camera_node = find_camera(root, context.sink);
    if camera_node.is_none() {
        camera::settings_without_camera(settings);
    }
    let aperture_preview = camera_node.is_some_and(|c| c.has("aperture_shape"));
    let origin = camera_node.map_or(Vec3d::ZERO, |c| camera::position(c, context.sink));
    let camera = camera_node.and_then(|c| camera::parameters(c, settings, film.as_ref(), context));

    let mut meshes = MeshTable::new(root, context.sink);
    let mut materials = MaterialTable::new(root, settings, context.sink);
    let mut geometry = Geometry::new(origin);
    geometry.add_objects(root, settings, &mut meshes, &mut materials, context);
    let mut lights = lights::Lights::default();
    lights.add_environment(root, &materials, context);
    lights.add_emitting_parts(&mut geometry, &meshes, &mut materials, context);
    lights.add_mesh_lights(root, &mut geometry, &mut meshes, &mut materials, context);
    lights.add_rectangles(root, &mut geometry, &mut meshes, &mut materials, context.sink);
    lights.add_portals(root, &geometry, &mut meshes, context);
    root.visit_references(&mut |what, name, span| match what {
        "mesh" => meshes.check_name(name, span, context.sink),
        "medium" => materials.check_medium(name, span, context.sink),
        _ => materials.check_name(name, span, context.sink),
    });
    materials.check_unused(context.sink);
    meshes.disregard_unused();
    materials.disregard_unused();

    let layers = materials.layers();
    let decisive = film.as_ref().map(|film| picture::decisive(settings, film, &transport, layers));
    let picture = picture::picture(root, camera_node.zip(camera.as_ref()), settings, context);
    // Read before anything can end this, since what nothing reads is reported.
    let (threshold, caching) = (settings.int("bih_tri_threshold").value, settings.bool("cache_trees"));
    // A light that is there but wrong, or not rendered, has its own message.
    let is_dark = LIGHTS.iter().all(|light| !root.has(light) && !root.is_faulty(light));
    if is_dark && lights.is_empty() && !context.sink.has_errors() {
        context.sink.push(
            Diagnostic::warning(
                codes::NO_LIGHT,
                root.span,
                "the scene has no light: the picture will be black",
            )
            .hint("add a <background>, a <meshlight>, a <rectanglelight> or a material that emits"),
        );
    }
    if context.sink.has_errors() || context.options.check_only || context.options.is_stopped() {
        return None;
    }
    let placed = (geometry.objects(), geometry.take_movements());
    let accel = accel(meshes, placed, threshold, caching, root.span, context)?;
    let (lights, mix) = lights.into_table(&geometry, &accel, materials.layers());
    let lamps: Vec<Option<u32>> = geometry.lights().collect();
    let (first_slot, slots, objects) = geometry.into_slots();
    let names = Names { objects, materials: materials.take_names() };
    let (materials, textures, media) = materials.into_arenas();
    let is_unseen = |at: &SurfacePoint| {
        let slot = first_slot[at.object as usize] + at.material_slot;
        matches!(materials[slots[slot as usize] as usize], Material::Null)
    };
    let (camera, picture) = (camera::focus(camera?, &accel, is_unseen), picture?);
    let picture = PictureSettings { lights: mix, ..picture };
    let camera_facts = camera.facts(origin, &picture);
    let camera = camera.into_camera()?;
    let mut scene = Scene {
        has_unseen_surfaces: slots.iter().any(|&m| materials[m as usize].may_be_unseen()),
        accel,
        wavelengths: Box::new(WavelengthSampler::of_light(&lights.spectrum())),
        lights,
        camera,
        textures,
        media,
        camera_media: MediumStack::AIR,
        camera_meets_interface: false,
        lamp_media: vec![],
        materials,
        first_slot,
        slots,
        nudge_m: settings.real("ray_origin_nudge_distance") as indigo_math::Real,
        names,
        transport,
        film: film?,
        picture,
        camera_facts,
        output: OutputSettings { aperture_preview, ..output },
        identity: Identity { hash: [0; 32], settings: decisive? },
    };
    scene.find_starting_media(&lamps);
    portal_probe::warn_of_openings(root, &scene, origin, context);
    dense_probe::warn_of_dense_media(root, &scene, context);
    Some(scene)
}

/// All geometry; `None` where it cannot be traced, after reporting why, or is not wanted any more.
fn accel(
    meshes: MeshTable,
    (objects, movements): (Vec<Object>, Vec<(u32, Movement)>),
    threshold: i64,
    caching: bool,
    span: Span,
    context: &mut Context,
) -> Option<Accel> {
    let options = BuildOptions {
        fast_threshold: usize::try_from(threshold).unwrap_or(usize::MAX),
        stop: context.options.stop.cloned().unwrap_or_default(),
        ..BuildOptions::default()
    };
    let trees: &dyn indigo_geom::TreeStore =
        if caching { context.options.trees } else { &indigo_geom::NoStore };
    match Accel::build_moving(meshes.into_triangles(), objects, movements, &options, trees) {
        Ok(accel) => Some(accel),
        Err(BuildError::Stopped) => None,
        Err(error) => {
            context.sink.push(Diagnostic::error(codes::GEOMETRY, span, error.to_string()));
            None
        }
    }
}

/// Elements that give light whatever materials there are: of those that emit, as a background or on models, the lights that
/// came of them are looked at.
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
    let max_depth = u32::try_from(settings.int("max_depth").value).unwrap_or(u32::MAX);
    let bidirectional = settings.bool("bidirectional");
    if settings.bool("render_foreground_alpha") {
        // What hides the background is known from the first hit, and only samples with a pixel of their own
        // can tell of it.
        return TransportSettings { max_depth: 0, bidirectional: false, metropolis: None, hybrid: false };
    }
    TransportSettings { max_depth, bidirectional, metropolis, hybrid }
}
