//! The scene: from files to what can be traced.
//!
//! [`load`] reads a scene with all that it includes, checks everything against the declarations in
//! [`schema`] and lowers it to a [`Scene`]: plain data in arenas, immutable and shared by all threads.
//! What is wrong goes to a sink with its place; reading never stops at the first fault.

mod canonical;
pub mod codes;
mod contents;
mod identity;
mod load;
mod lower;
mod needs;
mod probe;
mod scene;
pub mod schema;
mod settings;

pub use canonical::{LoadedCanonical, NamedFile, load_canonical};
pub use contents::{Contents, LoadedContents, load_contents};
pub use indigo_geom::Stop;
pub use load::{LoadOptions, Loaded, LoadedDevelopment, Override, load, load_development};
pub use needs::{LoadedNeeds, Need, load_needs};
pub use scene::{
    DIFFRACTION_OF_RAYS, Development, FOREGROUND_ALPHA, FilmSettings, Identity, LAYER_SETTING,
    MetropolisSettings, Names, OutputSettings, RENDER_REGION, Scene, SceneStats, TransportSettings,
    region_of_words,
};
pub use settings::{Listed, Origin, Settings};
