//! From film to picture: white balance, tone mapping, downsizing, and the files they end in.
//!
//! The film itself never changes: a picture is made from it as often as one likes, with other
//! settings each time. [`develop`] makes the picture that is shown and saved as PNG; [`untonemapped`]
//! makes the linear one, in cd/m², that is saved as EXR.
//!
//! Before either, [`on_sensor`] spreads the light by the diffraction of the aperture: what falls on the
//! sensor is a matter of light, so the linear picture has it, too. Bloom, which imitates it, is a matter
//! of taste and only in the picture that is shown.
//!
//! The order of the steps, for each internal pixel: XYZ, diffraction, bloom, Bradford adaptation to D65, linear
//! Rec. 709, tone mapping, clamping to [0, 1]; then the downsize filter, in display-linear light,
//! and clamping again, since a filter with negative lobes overshoots; the watermark, if it is asked for. Clamping first is what makes
//! an edge of something very bright as smooth as any other.
//!
//! Everything here is a pure function of bytes and numbers; large loops run on the caller's rayon
//! pool and give the same bits whatever its size.

mod bloom;
mod camera_facts;
mod convolution;
mod develop;
mod diffraction;
mod downsize;
mod error;
pub mod exr;
mod facts;
pub mod layers;
mod metadata;
mod picture;
pub mod png;
mod settings;
mod srgb;
mod tonemap;
mod watermark;
mod white_balance;
mod window;

pub use bloom::Bloom;
pub use camera_facts::CameraFacts;
pub use develop::{
    coverage, develop, develop_image, from_linear, linear_picture, on_sensor, preview_light, untonemapped,
};
pub use diffraction::Diffraction;
pub use error::ImagingError;
pub use facts::Content;
pub use metadata::{Metadata, RenderFacts};
pub use picture::{LinearImage, Picture};
pub use settings::{Exposure, PictureSettings, Region};
pub use tonemap::{Response, ToneMapping};
pub use white_balance::WhiteBalance;
