//! The kinds of light, one file each.
//!
//! A kind that lies infinitely far away implements [`Distant`] and has a line in the registry below;
//! the laws find it by that. Lamps are triangles, whatever their kind ([`AreaLight`](crate::AreaLight)).

pub mod background;
pub mod efficacy;
pub mod env_map;
pub mod mesh;
pub mod placement;
pub mod portal;
pub mod rectangle;
pub mod sky;
pub mod skylight;
pub mod sun;

use indigo_decl::Field;
use indigo_math::{Real, Vec3};
use indigo_spectrum::{SampledSpectrum, SampledWavelengths};

/// Whose switch a lamp hangs on.
pub(crate) const LAYER: Field = Field::index(
    "layer",
    "Number of the `layer_setting` in `renderer_settings` that it is scaled by. Of version 1.1.",
);

/// A light that is infinitely far away: radiance by direction, and a way of drawing directions.
///
/// All directions are unit vectors that lead towards the light.
pub trait Distant {
    /// Radiance, W m^-3 sr^-1, that comes from a direction.
    fn radiance(&self, towards: Vec3, lambda: &SampledWavelengths) -> SampledSpectrum;

    /// A direction with density [`pdf`](Self::pdf), for a receiver with unit normal `n`, or zero where
    /// light counts from all sides.
    fn sample(&self, n: Vec3, u: [Real; 2]) -> Option<Vec3>;

    /// Density (1/sr) of [`sample`](Self::sample).
    fn pdf(&self, n: Vec3, towards: Vec3) -> Real;

    /// Luminance integrated over all directions, cd sr/m²: what a small ball's surface gets of it, times 4.
    fn total_luminance(&self) -> f64;

    /// Whether receivers draw directions of it, where there are no portals. An even light is better found by
    /// scattering, which knows the surface: of the multiple importance sampling of both, the light's draws are
    /// what is to be left out (Karlik et al. 2019, "MIS Compensation", section 4, for a radiance that is all mean).
    fn is_drawn(&self) -> bool;

    /// The part of the draws for a receiver that is left to the portals of a scene, if it has any: all of them
    /// for an even light, none where all of it comes from one direction.
    fn portal_share(&self) -> Real;
}

/// Makes the enum of distant lights and everything that goes through all of them.
macro_rules! distant_lights {
    ($($file:ident => $light:ident,)*) => {
        /// A light that is infinitely far away.
        #[derive(Clone, Debug)]
        pub enum DistantLight {
            $(#[doc = concat!("See [`", stringify!($file), "`].")] $light($file::$light),)*
        }

        $(impl From<$file::$light> for DistantLight {
            fn from(light: $file::$light) -> Self {
                Self::$light(light)
            }
        })*

        impl DistantLight {
            /// Some of each kind, for the laws that all must keep.
            pub fn examples() -> Vec<(&'static str, Self)> {
                let mut all = vec![];
                $(all.extend($file::$light::examples().into_iter().map(|l| (stringify!($light), l.into())));)*
                all
            }
        }

        impl Distant for DistantLight {
            #[inline]
            fn radiance(&self, towards: Vec3, lambda: &SampledWavelengths) -> SampledSpectrum {
                match self {
                    $(Self::$light(l) => l.radiance(towards, lambda),)*
                }
            }

            #[inline]
            fn sample(&self, n: Vec3, u: [Real; 2]) -> Option<Vec3> {
                match self {
                    $(Self::$light(l) => l.sample(n, u),)*
                }
            }

            #[inline]
            fn pdf(&self, n: Vec3, towards: Vec3) -> Real {
                match self {
                    $(Self::$light(l) => l.pdf(n, towards),)*
                }
            }

            fn total_luminance(&self) -> f64 {
                match self {
                    $(Self::$light(l) => l.total_luminance(),)*
                }
            }

            fn is_drawn(&self) -> bool {
                match self {
                    $(Self::$light(l) => l.is_drawn(),)*
                }
            }

            #[inline]
            fn portal_share(&self) -> Real {
                match self {
                    $(Self::$light(l) => l.portal_share(),)*
                }
            }
        }
    };
}

distant_lights! {
    background => Background,
    env_map => EnvMap,
    sky => Sky,
    sun => Sun,
}
