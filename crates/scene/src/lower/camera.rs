//! The camera.

use super::geometry::FARTHEST;
use super::{Context, aperture};
use crate::codes;
use crate::scene::FilmSettings;
use crate::settings::{Origin, Settings};
use indigo_camera::{Aperture, Camera, ThinLens, ThinLensParameters};
use indigo_decl::Node;
use indigo_decl::codes::OUT_OF_RANGE;
use indigo_diag::{Diagnostic, Sink};
use indigo_geom::{Accel, Ray};
use indigo_math::{Float, Vec3, Vec3d};

/// Relative difference between the sensor's aspect ratio and the picture's that is worth a warning.
const ASPECT_TOLERANCE: f64 = 0.01;

/// A camera whose focus may still have to be found.
pub(super) struct Unfocused {
    lens: ThinLensParameters,
    aperture: Aperture,
    autofocus: bool,
}

/// Reads the camera; `None` after reporting that it has no direction.
pub(super) fn parameters(
    node: &Node,
    settings: &Settings,
    film: Option<&FilmSettings>,
    context: &mut Context,
) -> Option<Unfocused> {
    let (sensor_width, aspect) = (node.real("sensor_width"), node.real("aspect_ratio"));
    let autofocus = node.flag("autofocus");
    let focus_distance = node.opt_real("focus_distance").map_or(f64::INFINITY, |v| v.value);
    // The settings' switch and the camera's own both take vignetting out.
    let vignetting = node.bool("vignetting") && settings.bool("vignetting");
    let lens = ThinLensParameters {
        position: Vec3d::ZERO,
        forwards: node.vec3("forwards").into(),
        up: node.vec3("up").into(),
        aperture_radius: node.real("aperture_radius"),
        focus_distance,
        sensor_width,
        sensor_height: sensor_width / aspect,
        lens_sensor_dist: node.real("lens_sensor_dist"),
        vignetting,
    };
    let is_size_known = !settings.is_faulty("width") && !settings.is_faulty("height");
    if let Some(film) = film.filter(|_| is_size_known && !node.is_faulty("aspect_ratio")) {
        warn_of_aspect(node, aspect, film, context.sink);
    }
    obstacles(node, settings);
    let aperture = aperture::aperture(node, context);
    if ThinLens::new(&lens).is_none() {
        refuse_directions(node, context.sink);
        return None;
    }
    Some(Unfocused { lens, aperture, autofocus })
}

/// The camera's place in the world; the origin where that is wrong.
pub(super) fn position(node: &Node, sink: &mut Sink) -> Vec3d {
    let pos = node.vec3("pos");
    if pos.iter().all(|x| x.abs() <= FARTHEST) {
        return pos.into();
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

fn warn_of_aspect(node: &Node, aspect: f64, film: &FilmSettings, sink: &mut Sink) {
    let picture = f64::from(film.size.width()) / f64::from(film.size.height());
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

/// Reads what the settings say of cameras, so that a scene without one has no further errors.
pub(super) fn diffraction(settings: &Settings, sink: &mut Sink) {
    settings.refuse_true("aperture_diffraction", Some("the picture has no diffraction glare"), sink);
    settings.disregard("post_process_diffraction");
    settings.disregard("vignetting");
}

/// What stands before the lens.
fn obstacles(node: &Node, settings: &Settings) {
    if !settings.bool("aperture_diffraction") || settings.origin("aperture_diffraction") == Origin::Default {
        // An obstacle map has an effect on diffraction alone.
        node.disregard_field("obstacle_map");
    }
}

/// Sets the focus by what the camera sees in its direction, if it is to find its focus itself.
pub(super) fn focus(mut camera: Unfocused, accel: &Accel) -> Unfocused {
    if camera.autofocus {
        let forwards = camera.lens.forwards.normalized();
        let ray = Ray::new(Vec3::ZERO, forwards.cast());
        camera.lens.focus_distance = accel.intersect(&ray).map_or(f64::INFINITY, |hit| hit.t.to_f64());
    }
    camera
}

impl Unfocused {
    /// Area of the opening in m².
    pub(super) fn aperture_area(&self) -> f64 {
        self.aperture.area() * self.lens.aperture_radius.powi(2)
    }

    /// The camera.
    pub(super) fn into_camera(self) -> Option<Camera> {
        Some(Camera::new(ThinLens::new(&self.lens)?, self.aperture))
    }
}
