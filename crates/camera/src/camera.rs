//! A camera: a lens behind an aperture, or none.

use crate::diffraction::deflection::{Deflection, Offset};
use crate::{
    Aperture, FarField, FilmPosition, LensRay, Orthographic, Spherical, ThinLens, ThinLensParameters,
};
use indigo_math::{Float, Mat3, Motion, Real, Vec2, Vec3, Vec3d};
use indigo_spectrum::{LanePdf, SampledWavelengths};

/// What makes an image of the scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CameraKind {
    /// A thin lens.
    ThinLens,
    /// Nothing: rays are parallel.
    Orthographic,
    /// Nothing: all directions are seen from a point.
    Spherical,
}

impl CameraKind {
    /// Its name in scene files.
    pub fn name(self) -> &'static str {
        match self {
            Self::ThinLens => "thin-lens-perspective",
            Self::Orthographic => "orthographic",
            Self::Spherical => "spherical",
        }
    }

    /// The geometry of such a camera; `None` where its directions do not span a plane.
    pub fn optics(self, parameters: &ThinLensParameters) -> Option<Optics> {
        Some(match self {
            Self::ThinLens => Optics::ThinLens(ThinLens::new(parameters)?),
            Self::Orthographic => Optics::Orthographic(Orthographic::new(parameters)?),
            Self::Spherical => Optics::Spherical(Spherical::new(parameters)?),
        })
    }
}

/// Geometry, from film positions to rays and back.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Optics {
    /// A thin lens.
    ThinLens(ThinLens),
    /// Parallel rays.
    Orthographic(Orthographic),
    /// All directions.
    Spherical(Spherical),
}

impl Optics {
    /// The same turned about the origin, and then moved.
    fn moved(&self, turn: Mat3<Real>, by: Vec3) -> Self {
        match self {
            Self::ThinLens(lens) => Self::ThinLens(lens.moved(turn, by)),
            Self::Orthographic(parallel) => Self::Orthographic(parallel.moved(turn, by)),
            Self::Spherical(sphere) => Self::Spherical(sphere.moved(turn, by)),
        }
    }
}

impl From<ThinLens> for Optics {
    fn from(lens: ThinLens) -> Self {
        Self::ThinLens(lens)
    }
}

/// Where paths begin: a thin lens, the opening through which light reaches it, and what that opening
/// does to light; or rays without a lens.
#[derive(Clone, Debug)]
pub struct Camera {
    optics: Optics,
    aperture: Aperture,
    /// Area of the opening, m².
    opening_m2: Real,
    deflection: Option<Box<Deflection>>,
    motion: Option<Motion>,
}

/// The beginning of a path at the camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CameraRay {
    /// Point on the lens.
    pub origin: Vec3,
    /// Unit direction.
    pub direction: Vec3,
    /// What its radiance counts on the film: 1 on the axis, cos⁴ off it with vignetting.
    pub importance: Real,
    /// The diffraction of this sample: from the film position that the path counts for to the one that
    /// the ray belongs to. A light path that meets the lens at `origin` is deflected by as much.
    pub offset: Vec2,
    /// Density of that offset for each wavelength, over the hero's.
    pub ratio: LanePdf,
    /// The mean of that density over all wavelengths, over the area of the film; infinite where there is no
    /// diffraction. It is the same whichever wavelength is the hero.
    pub offset_density: Real,
    /// Part of the film that a disc covers whose radius is the offset.
    pub offset_disc: Real,
    /// When it is traced: the shutter opens at 0 and closes at 1.
    pub time: Real,
}

impl CameraRay {
    fn new(ray: LensRay, offset: Offset, disc: Real, time: Real) -> Self {
        Self {
            origin: ray.origin,
            direction: ray.direction,
            importance: ray.importance,
            offset: offset.on_film,
            ratio: offset.ratio,
            offset_density: offset.density * offset.ratio.mean(),
            offset_disc: disc,
            time,
        }
    }
}

impl Camera {
    /// A lens behind an aperture whose square has the aperture's radius as half its side. Cameras without a lens have
    /// no use for it.
    pub fn new(optics: impl Into<Optics>, aperture: Aperture) -> Self {
        let optics = optics.into();
        let opening_m2 = match &optics {
            Optics::ThinLens(lens) => (lens.aperture_radius().to_f64().powi(2) * aperture.area()) as Real,
            Optics::Orthographic(_) | Optics::Spherical(_) => 0.0,
        };
        Self { optics, aperture, opening_m2, deflection: None, motion: None }
    }

    /// How far from the camera's position a ray may begin, metres; infinite where that is no lens.
    pub fn reach(&self) -> Real {
        match &self.optics {
            Optics::ThinLens(lens) => lens.aperture_radius(),
            Optics::Orthographic(_) => Real::INFINITY,
            Optics::Spherical(_) => 0.0,
        }
    }

    /// The same camera with diffraction by ray: `field` is the far field of what light passes. Without a lens there is
    /// none.
    #[must_use]
    pub fn with_diffraction(self, field: &FarField) -> Self {
        let Optics::ThinLens(lens) = &self.optics else { return self };
        let deflection = Deflection::new(field, lens.cycle_per_nm());
        Self { deflection: Some(Box::new(deflection)), ..self }
    }

    /// The same camera in motion through poses of which that at time 0 is the origin, where it stands: how it is turned then
    /// is how its directions were given.
    #[must_use]
    pub fn with_motion(self, motion: Motion) -> Self {
        let motion = motion.moves().then_some(motion);
        Self { motion, ..self }
    }

    /// Whether it moves while the shutter is open.
    pub fn moves(&self) -> bool {
        self.motion.is_some()
    }

    /// Asks the geometry at a time.
    #[inline(always)]
    fn at<R>(&self, time: Real, ask: impl FnOnce(&Optics) -> R) -> R {
        match &self.motion {
            None => ask(&self.optics),
            Some(motion) => ask(&self.moved(motion, time)),
        }
    }

    fn moved(&self, motion: &Motion, time: Real) -> Optics {
        let (start, pose) = (motion.at(0.0), motion.at(time.to_f64()));
        let turn = pose.rotation() * start.rotation().transposed();
        let turn = Mat3 { rows: turn.rows.map(Vec3d::cast) };
        self.optics.moved(turn, (pose.pos - start.pos).cast())
    }

    /// The ray of a film position, from (0, 0), top left, to (1, 1), for two numbers in [0, 1) that
    /// choose a point of the aperture, evenly over what is open, when the shutter opens. There is no diffraction.
    #[inline]
    pub fn ray(&self, film: Vec2, lens: Vec2) -> CameraRay {
        self.ray_at(film, lens, 0.0)
    }

    /// [`ray`](Self::ray) at a time.
    #[inline]
    pub fn ray_at(&self, film: Vec2, lens: Vec2, time: Real) -> CameraRay {
        let ray = self.at(time, |optics| match optics {
            Optics::ThinLens(thin) => thin.ray(film, self.aperture.sample(lens)),
            Optics::Orthographic(parallel) => parallel.ray(film),
            Optics::Spherical(sphere) => sphere.ray(film),
        });
        CameraRay::new(ray, Offset::NONE, 0.0, time)
    }

    /// Whether [`sample`](Self::sample) sends rays elsewhere than [`ray_at`](Self::ray_at).
    pub fn deflects(&self) -> bool {
        self.deflection.is_some()
    }

    /// [`ray_at`](Self::ray_at) with what diffraction does to it, for two more numbers in [0, 1) and the
    /// wavelengths of the path.
    #[inline]
    pub fn sample(
        &self,
        film: Vec2,
        lens: Vec2,
        diffraction: Vec2,
        lambda: &SampledWavelengths,
        time: Real,
    ) -> CameraRay {
        let (Some(deflection), Optics::ThinLens(thin)) = (&self.deflection, &self.optics) else {
            return self.ray_at(film, lens, time);
        };
        let offset = deflection.sample(diffraction, lambda);
        let disc = thin.disc(offset.on_film);
        let CameraRay { origin, direction, importance, .. } = self.ray_at(film + offset.on_film, lens, time);
        CameraRay::new(LensRay { origin, direction, importance }, offset, disc, time)
    }

    /// Where the ray begins at a time by which a point of the scene is seen: at the point of the lens that was drawn, unless
    /// rays are parallel, when there is but one place.
    #[inline]
    pub fn origin_towards(&self, p: Vec3, drawn: Vec3, time: Real) -> Vec3 {
        self.at(time, |optics| match optics {
            Optics::ThinLens(_) | Optics::Spherical(_) => drawn,
            Optics::Orthographic(parallel) => parallel.foot(p),
        })
    }

    /// The film position that sees along a direction from a point where rays begin, at a time and without diffraction. It
    /// may lie beside the film. The one direction of parallel rays is for the caller to keep to.
    #[inline]
    pub fn film_position(&self, origin: Vec3, direction: Vec3, time: Real) -> Option<FilmPosition> {
        self.at(time, |optics| match optics {
            Optics::ThinLens(lens) => lens.film_position(origin, direction),
            Optics::Orthographic(parallel) => parallel.film_position(origin, direction),
            Optics::Spherical(sphere) => sphere.film_position(direction),
        })
    }

    /// Whether all rays have the same direction, so that light from far away comes along one of them with probability 0,
    /// and densities over area do not fall with distance.
    #[inline]
    pub fn is_parallel(&self) -> bool {
        matches!(self.optics, Optics::Orthographic(_))
    }

    /// Density (1/sr) at a time, as seen from where the ray begins, of what lies at a distance in metres, for film positions that are
    /// uniform over the film. Over squared distance it is that over area across the ray, which alone parallel rays have:
    /// only there the distance matters.
    #[inline]
    pub fn pdf_direction(&self, direction: Vec3, distance: Real, time: Real) -> Real {
        self.at(time, |optics| match optics {
            Optics::ThinLens(lens) => lens.pdf_direction(direction),
            Optics::Orthographic(parallel) => parallel.density() * distance * distance,
            Optics::Spherical(sphere) => sphere.pdf_direction(direction),
        })
    }

    /// Over what part of the film the light of a point spreads at a time that lies in a direction at a distance in metres, which
    /// may be infinite: the area of its blur where the opening is even, without diffraction; 0 in focus.
    #[inline]
    pub fn blur(&self, direction: Vec3, distance: Real, time: Real) -> Real {
        self.at(time, |optics| match optics {
            Optics::ThinLens(lens) => lens.blur(direction, distance) * self.opening_m2,
            Optics::Orthographic(_) | Optics::Spherical(_) => 0.0,
        })
    }

    /// The viewing direction when the shutter opens.
    pub fn forwards(&self) -> Vec3 {
        match &self.optics {
            Optics::ThinLens(lens) => lens.forwards(),
            Optics::Orthographic(parallel) => parallel.forwards(),
            Optics::Spherical(sphere) => sphere.forwards(),
        }
    }

    /// How deep in the picture a point of render space lies at a time, metres: along the viewing direction, or from the point
    /// from which all directions are seen.
    pub fn depth(&self, p: Vec3, time: Real) -> Real {
        self.at(time, |optics| match optics {
            Optics::ThinLens(lens) => lens.depth(p),
            Optics::Orthographic(parallel) => parallel.depth(p),
            Optics::Spherical(sphere) => sphere.depth(p),
        })
    }

    /// The shape of the opening.
    pub fn aperture(&self) -> &Aperture {
        &self.aperture
    }
}
