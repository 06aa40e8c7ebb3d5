//! Scene elements: what they may contain, declared once.
//!
//! A [`Block`] is the declaration of an element with children: its name, its documentation and a
//! table of [`Field`]s, each with kind, unit, range, default and aliases. From that one table come
//! reading and checking ([`bind()`]), the settings listing and the scene-format reference
//! ([`mod@reference`]).
//!
//! The way of a scene: text → [`Element`] tree (made by a reader such as `igs`) → [`bind()`] against
//! the declarations → [`Node`] tree of typed values → lowering, which reads every value it can use.
//! A value that nobody read is reported by [`report_unread`]: what is in a scene either has an
//! effect or is named, never silently dropped.
//!
//! Nothing here knows XML or the renderer.

pub mod bind;
mod canonical;
pub mod codes;
pub mod element;
pub mod field;
pub mod meaning;
pub mod mesh;
pub mod node;
pub mod parameter;
pub mod reference;
mod report;
pub mod resolver;
pub mod value;

pub use bind::{UID, bind, report_unread};
pub use canonical::Written;
pub use element::{Attribute, Element};
pub use field::{Alternatives, Block, Field, Group, Kind, Later, Presence, Range};
pub use meaning::Meaning;
pub use mesh::{EmbeddedMesh, MeshData};
pub use node::{Node, Slot};
pub use parameter::{Parameter, StandIn};
pub use resolver::{ResolveError, Resolved, Resolver, SHIPPED, hint_of_shipped};
pub use value::Value;
