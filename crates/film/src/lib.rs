//! The film: what reaches the sensor, summed.
//!
//! A worker puts its samples into a [`FilmDelta`] of its own (`f32`, bricks made on first touch)
//! and hands it to the [`MasterFilm`] (`f64`, one lock per band of rows) about once a second. A
//! [`FilmState`] is the same film as plain data: what is saved, resumed and merged. All of them
//! combine by addition alone, which is associative and commutative up to rounding, so threads,
//! network slaves, a resumed run and merged files are one operation.
//!
//! The film holds CIE XYZ in cd/m² on the sensor's axis at *internal* resolution: the picture's
//! pixels times the super-sampling factor, with no margin. Pixel (0, 0) is the top left one, x
//! grows to the right and y downwards; pixel `i` covers positions from `i` to `i + 1`.
//!
//! | part | purpose |
//! |---|---|
//! | [`FilmSize`] | output and internal resolution |
//! | [`Filter`], [`FilmFilter`] | the splat filter: spreading splats, and drawing camera samples |
//! | [`Sensor`] | spectrum to XYZ, the only place where that happens |
//! | [`FilmDelta`], [`MasterFilm`], [`FilmState`] | gathering, sharing and keeping the sums |
//! | [`LightMix`] | groups of lights, and how bright each is in the picture |
//! | [`FirstHit`] | what a pixel shows, for denoisers and compositing |
//! | [`XyzImage`] | the film developed: radiance per internal pixel |
//! | [`SavedFilm`], [`igi`] | a film with where it comes from, and as a file |

mod band;
mod delta;
mod develop;
mod error;
mod film_filter;
mod filter;
mod first_hit;
pub mod igi;
mod layer;
mod master;
pub mod mix;
mod profile;
mod record;
mod sensor;
mod share;
mod size;
mod state;

pub use delta::FilmDelta;
pub use develop::XyzImage;
pub use error::FilmError;
pub use film_filter::{FilmFilter, FilmSample, Footprint};
pub use filter::Filter;
pub use first_hit::FirstHit;
pub use layer::{Layer, LayerKind, Totals};
pub use master::MasterFilm;
pub use mix::{LightGroup, LightMix};
pub use record::{DevelopedFilm, FilmRecord, Mismatch, Run, SavedFilm};
pub use sensor::Sensor;
pub use share::{Counted, Share, is_count};
pub use size::FilmSize;
pub use state::FilmState;
