//! A camera: a lens behind an aperture.

use crate::diffraction::deflection::{Deflection, Offset};
use crate::{Aperture, FarField, FilmPosition, LensRay, ThinLens};
use indigo_math::{Float, Real, Vec2, Vec3};
use indigo_spectrum::{LanePdf, SampledWavelengths};

/// Where paths begin: a thin lens, the opening through which light reaches it, and what that opening
/// does to light.
#[derive(Clone, Debug)]
pub struct Camera {
    lens: ThinLens,
    aperture: Aperture,
    /// Area of the opening, m².
    opening_m2: Real,
    deflection: Option<Box<Deflection>>,
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
}

impl CameraRay {
    fn new(ray: LensRay, offset: Offset, disc: Real) -> Self {
        Self {
            origin: ray.origin,
            direction: ray.direction,
            importance: ray.importance,
            offset: offset.on_film,
            ratio: offset.ratio,
            offset_density: offset.density * offset.ratio.mean(),
            offset_disc: disc,
        }
    }
}

impl Camera {
    /// A lens behind an aperture whose square has the aperture's radius as half its side.
    pub fn new(lens: ThinLens, aperture: Aperture) -> Self {
        let opening_m2 = (lens.aperture_radius().to_f64().powi(2) * aperture.area()) as Real;
        Self { lens, aperture, opening_m2, deflection: None }
    }

    /// Radius of the opening, metres: how far from the camera's position a ray may begin.
    pub fn aperture_radius(&self) -> Real {
        self.lens.aperture_radius()
    }

    /// The same camera with diffraction by ray: `field` is the far field of what light passes.
    #[must_use]
    pub fn with_diffraction(self, field: &FarField) -> Self {
        let cycle = self.lens.cycle_per_nm();
        Self { deflection: Some(Box::new(Deflection::new(field, cycle))), ..self }
    }

    /// The ray of a film position, from (0, 0), top left, to (1, 1), for two numbers in [0, 1) that
    /// choose a point of the aperture, evenly over what is open. There is no diffraction.
    #[inline]
    pub fn ray(&self, film: Vec2, lens: Vec2) -> CameraRay {
        CameraRay::new(self.lens.ray(film, self.aperture.sample(lens)), Offset::NONE, 0.0)
    }

    /// Whether [`sample`](Self::sample) sends rays elsewhere than [`ray`](Self::ray).
    pub fn deflects(&self) -> bool {
        self.deflection.is_some()
    }

    /// [`ray`](Self::ray) with what diffraction does to it, for two more numbers in [0, 1) and the
    /// wavelengths of the path.
    #[inline]
    pub fn sample(
        &self,
        film: Vec2,
        lens: Vec2,
        diffraction: Vec2,
        lambda: &SampledWavelengths,
    ) -> CameraRay {
        let Some(deflection) = &self.deflection else { return self.ray(film, lens) };
        let offset = deflection.sample(diffraction, lambda);
        let disc = self.lens.disc(offset.on_film);
        CameraRay::new(self.lens.ray(film + offset.on_film, self.aperture.sample(lens)), offset, disc)
    }

    /// The film position that sees along a direction from a point of the lens, without diffraction: see
    /// [`ThinLens::film_position`].
    #[inline]
    pub fn film_position(&self, origin: Vec3, direction: Vec3) -> Option<FilmPosition> {
        self.lens.film_position(origin, direction)
    }

    /// Density (1/sr) of unit directions for film positions that are uniform over the film: see
    /// [`ThinLens::pdf_direction`].
    #[inline]
    pub fn pdf_direction(&self, direction: Vec3) -> Real {
        self.lens.pdf_direction(direction)
    }

    /// Over what part of the film the light of a point spreads that lies in a direction at a distance in metres, which
    /// may be infinite: the area of its blur where the opening is even, without diffraction; 0 in focus.
    #[inline]
    pub fn blur(&self, direction: Vec3, distance: Real) -> Real {
        self.lens.blur(direction, distance) * self.opening_m2
    }

    /// The viewing direction.
    pub fn forwards(&self) -> Vec3 {
        self.lens.forwards()
    }

    /// The shape of the opening.
    pub fn aperture(&self) -> &Aperture {
        &self.aperture
    }
}
