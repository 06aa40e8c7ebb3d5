//! The camera.

use super::geometry::FARTHEST;
use super::keyframes;
use super::{Context, aperture};
use crate::codes;
use crate::scene::FilmSettings;
use crate::settings::Settings;
use indigo_camera::{Aperture, Camera, CameraKind, Pupil, ThinLens, ThinLensParameters};
use indigo_decl::Node;
use indigo_decl::codes::OUT_OF_RANGE;
use indigo_diag::{Diagnostic, Sink};
use indigo_geom::{Accel, Ray, SurfacePoint};
use indigo_imaging::{CameraFacts, Diffraction as DiffractionFilter, PictureSettings};
use indigo_math::{Float, Motion, Pose, Vec3, Vec3d};
use std::sync::Arc;

/// Relative difference between the sensor's aspect ratio and the picture's that is worth a warning.
const ASPECT_TOLERANCE: f64 = 0.01;

/// A camera whose focus may still have to be found.
pub(super) struct Unfocused {
    kind: CameraKind,
    lens: ThinLensParameters,
    /// How it moves, from its place when the shutter opens.
    motion: Motion,
    aperture: Aperture,
    pupil: Pupil,
    diffraction: Diffraction,
    /// Whether that is so.
    autofocus: bool,
}

/// Reads the camera; `None` after reporting that it has no direction.
pub(super) fn parameters(
    node: &Node,
    settings: &Settings,
    film: Option<&FilmSettings>,
    context: &mut Context,
) -> Option<Unfocused> {
    let kind = kind(node);
    let (sensor_width, aspect) = (node.real("sensor_width"), node.real("aspect_ratio"));
    let autofocus = node.flag("autofocus");
    let focus_distance = node.opt_real("focus_distance").map_or(f64::INFINITY, |v| v.value);
    // The settings' switch and the camera's own both take vignetting out.
    let vignetting = node.bool("vignetting") && settings.bool("vignetting");
    // Where it is too far away is the business of `position`.
    let motion = keyframes::motion(node);
    let start = motion.at(0.0);
    let turn = start.rotation();
    let motion = motion.moved_by(-start.pos);
    let lens = ThinLensParameters {
        position: Vec3d::ZERO,
        forwards: turn * Vec3d::from(node.vec3("forwards")),
        up: turn * Vec3d::from(node.vec3("up")),
        aperture_radius: node.real("aperture_radius"),
        focus_distance,
        sensor_width,
        sensor_height: sensor_width / aspect,
        lens_sensor_dist: node.real("lens_sensor_dist"),
        lens_shift: [node.real("lens_shift_right_distance"), node.real("lens_shift_up_distance")],
        vignetting,
    };
    let is_size_known = !settings.is_faulty("width") && !settings.is_faulty("height");
    if let Some(film) = film.filter(|_| is_size_known && !node.is_faulty("aspect_ratio")) {
        warn_of_aspect(node, kind, aspect, film, context.sink);
    }
    let aperture = aperture::aperture(node, context);
    let mut diffraction = Diffraction::of(settings);
    if kind != CameraKind::ThinLens {
        diffraction = Diffraction::Off;
        warn_without_lens(node, kind, context.sink);
    }
    let pupil = pupil(node, &aperture, diffraction, context);
    if ThinLens::new(&lens).is_none() {
        refuse_directions(node, context.sink);
        // Nothing is wrong with the rest, which nobody will read.
        node.disregard();
        return None;
    }
    Some(Unfocused { kind, lens, motion, aperture, pupil, diffraction, autofocus })
}

fn kind(node: &Node) -> CameraKind {
    let name = node.text("camera_type").value;
    let of_name = |kind: &CameraKind| kind.name() == name;
    // A wrong name was reported.
    [CameraKind::Orthographic, CameraKind::Spherical]
        .into_iter()
        .find(of_name)
        .unwrap_or(CameraKind::ThinLens)
}

/// Warns of what only a lens makes use of, where that is more than exporters write in any case.
fn warn_without_lens(node: &Node, kind: CameraKind, sink: &mut Sink) {
    let shifts = ["lens_shift_right_distance", "lens_shift_up_distance"];
    let is_shifted = |field: &&&str| kind == CameraKind::Spherical && node.real(field) != 0.0;
    let fields = shifts.iter().filter(is_shifted).chain(&["obstacle_map"]);
    for field in fields.filter(|field| node.has(field)) {
        let message = format!("<{field}> has no effect on a camera of type {}", kind.name());
        sink.push(Diagnostic::warning(codes::NO_LENS, node.span_of(field), message).hint("take it out"));
    }
}

/// The camera's place in the world; the origin where that is wrong.
pub(super) fn position(node: &Node, sink: &mut Sink) -> Vec3d {
    let motion = keyframes::motion(node);
    keyframes::warn_of_keys(node, sink);
    let is_near = |pose: &Pose| pose.pos.to_array().iter().all(|x| x.abs() <= FARTHEST);
    if motion.poses(1.0).iter().all(is_near) {
        return motion.at(0.0).pos;
    }
    sink.push(
        Diagnostic::error(OUT_OF_RANGE, node.span_of("pos"), "the camera is too far away from the origin")
            .expected(format!("expected coordinates up to {FARTHEST:e} m")),
    );
    Vec3d::ZERO
}

fn refuse_directions(node: &Node, sink: &mut Sink) {
    // A direction that is no number at all was reported.
    if ["up", "forwards"].iter().any(|field| node.is_faulty(field) || !node.has(field)) {
        return;
    }
    for field in ["forwards", "up"] {
        if Vec3d::from(node.vec3(field)).try_normalized().is_none() {
            let message = format!("<{field}> has no direction");
            sink.push(
                Diagnostic::error(codes::SINGULAR, node.span_of(field), message)
                    .expected("expected a vector of any length but 0"),
            );
            return;
        }
    }
    sink.push(
        Diagnostic::error(codes::SINGULAR, node.span_of("up"), "<up> and <forwards> span no plane")
            .expected("expected an <up> that does not point along <forwards>"),
    );
}

fn warn_of_aspect(node: &Node, kind: CameraKind, aspect: f64, film: &FilmSettings, sink: &mut Sink) {
    let picture = f64::from(film.size.width()) / f64::from(film.size.height());
    if kind == CameraKind::Spherical {
        if (picture / 2.0 - 1.0).abs() > ASPECT_TOLERANCE {
            let message = format!(
                "the picture of all directions is {picture:.4} times as wide as high: it will look stretched"
            );
            sink.push(
                Diagnostic::warning(codes::ASPECT_RATIO, node.span_of("camera_type"), message)
                    .hint("make it twice as wide as high"),
            );
        }
        return;
    }
    if (aspect / picture - 1.0).abs() > ASPECT_TOLERANCE {
        sink.push(
            Diagnostic::warning(
                codes::ASPECT_RATIO,
                node.span_of("aspect_ratio"),
                format!(
                    "<aspect_ratio> is {aspect}, but the picture's is {picture:.4}: it will look stretched"
                ),
            )
            .hint(format!("set it to {picture:.6}")),
        );
    }
}

/// How the aperture's diffraction is rendered.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Diffraction {
    /// Not at all.
    Off,
    /// As a filter on the picture.
    Filter,
    /// By the deflection of rays.
    Rays,
}

impl Diffraction {
    fn of(settings: &Settings) -> Self {
        let is_filter = settings.bool("post_process_diffraction");
        match (settings.bool("aperture_diffraction"), is_filter) {
            (false, _) => Self::Off,
            (true, true) => Self::Filter,
            (true, false) => Self::Rays,
        }
    }
}

/// Reads what the settings say of cameras, so that a scene without one has no further errors.
pub(super) fn settings_without_camera(settings: &Settings) {
    for field in ["aperture_diffraction", "post_process_diffraction", "vignetting"] {
        settings.disregard(field);
    }
}

/// The aperture with what stands before it, which matters to diffraction alone.
fn pupil(node: &Node, aperture: &Aperture, diffraction: Diffraction, context: &mut Context) -> Pupil {
    let open = Pupil::new(aperture.clone(), None);
    let Some(path) = node.opt_text("obstacle_map") else { return open };
    // Looked at even where it does nothing: its faults are not to come up when diffraction is switched on.
    let Some(obstacles) = aperture::obstacles(&path.value, path.span, context) else { return open };
    let pupil = Pupil::new(aperture.clone(), Some(obstacles));
    if pupil.is_dark() {
        context.sink.push(
            Diagnostic::error(
                codes::BAD_FILE,
                path.span,
                format!("{} covers all of the aperture", path.value),
            )
            .expected("expected an image that is not black where the aperture is open"),
        );
        return open;
    }
    if pupil.is_unobstructed() {
        // Diffraction is of the opening's shape, and the exposure goes by the aperture alone.
        context.sink.push(
            Diagnostic::warning(
                codes::FILE_NOTE,
                path.span,
                format!("{} is the same all over: there is no obstacle in it", path.value),
            )
            .hint("make it dark where something stands before the lens, or leave <obstacle_map> out"),
        );
        return open;
    }
    if diffraction == Diffraction::Off { open } else { pupil }
}

/// Sets the focus by what the middle of the picture shows, if the camera is to find its focus itself: the first surface
/// that is not wholly unseen.
pub(super) fn focus(
    mut camera: Unfocused,
    accel: &Accel,
    is_unseen: impl Fn(&SurfacePoint) -> bool,
) -> Unfocused {
    if camera.autofocus && camera.kind == CameraKind::ThinLens {
        let forwards = camera.lens.forwards.normalized();
        // A lens without directions was reported.
        let middle = camera.lens.middle_direction().unwrap_or(forwards);
        let mut ray = Ray::new(Vec3::ZERO, middle.cast());
        camera.lens.focus_distance = loop {
            let Some(hit) = accel.intersect(&ray) else { break f64::INFINITY };
            let at = accel.surface(&ray, &hit);
            if !is_unseen(&at) {
                // The plane of focus lies across `forwards`.
                break hit.t.to_f64() * middle.dot(forwards);
            }
            ray = ray.beyond(hit.t, at.p_error.length());
        };
        camera.autofocus = false;
    }
    camera
}

impl Unfocused {
    /// Area of the opening in m².
    pub(super) fn aperture_area(&self) -> f64 {
        self.aperture.area() * self.lens.aperture_radius.powi(2)
    }

    /// What pictures tell of it, where it stands at a place of the world.
    pub(super) fn facts(&self, position: Vec3d, picture: &PictureSettings) -> CameraFacts {
        let lens = &self.lens;
        let forwards = lens.forwards.normalized();
        CameraFacts {
            kind: self.kind,
            position,
            forwards,
            up: forwards.cross(lens.up).cross(forwards).normalized(),
            sensor_width: lens.sensor_width,
            sensor_height: lens.sensor_height,
            aperture_radius: lens.aperture_radius,
            lens_sensor_dist: lens.lens_sensor_dist,
            lens_shift: lens.lens_shift,
            focus_distance: (!self.autofocus).then_some(lens.focus_distance),
            exposure_duration: picture.exposure.duration,
            film_iso: picture.film_iso(),
        }
    }

    /// Diffraction as a filter on the picture, if that is how it is rendered.
    pub(super) fn filter(&self) -> Option<Arc<DiffractionFilter>> {
        if self.diffraction != Diffraction::Filter {
            return None;
        }
        let cycle = ThinLens::new(&self.lens)?.cycle_per_nm();
        let cycle = [cycle.x.to_f64(), cycle.y.to_f64()];
        Some(Arc::new(DiffractionFilter::new(self.pupil.clone(), cycle)))
    }

    /// The camera.
    pub(super) fn into_camera(self) -> Option<Camera> {
        let camera = Camera::new(self.kind.optics(&self.lens)?, self.aperture).with_motion(self.motion);
        if self.diffraction != Diffraction::Rays {
            return Some(camera);
        }
        Some(camera.with_diffraction(&self.pupil.far_field()?))
    }
}
