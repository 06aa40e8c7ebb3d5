//! The scene of a master.

use super::calls::{Client, Outcome, answer};
use super::fetch::{self, SceneFiles};
use super::visit::Life;
use crate::event::Event;
use crate::plain::{plain, plain_lines};
use crate::proto::{JoinReply, SceneRequest};
use indigo_scene::Scene;
use std::sync::Arc;
use tokio::task::spawn_blocking;

impl Life {
    /// Fetches the scene, if it is not there, and loads it, with signs of life meanwhile.
    pub(super) async fn load(&mut self, client: &mut Client, reply: &JoinReply) -> Result<Scene, Outcome> {
        let pack = self.fetch(client, reply).await?;
        let overrides = reply.overrides.iter().map(|s| [s.option.clone(), s.name.clone(), s.value.clone()]);
        let files = SceneFiles {
            name: reply.scene.clone(),
            pack: pack.into(),
            settings_file: reply.settings_file.as_ref().map(|file| file.to_vec()),
            overrides: overrides.collect(),
        };
        let loader = Arc::clone(&self.loader);
        let loaded = self.aside(client, move || loader.load(&files)).await?;
        loaded.map_err(|why| {
            Outcome::Refused(format!("the master's scene cannot be loaded: {}", plain_lines(&why)))
        })
    }

    /// The packed scene, from the cache or the master.
    async fn fetch(&mut self, client: &mut Client, reply: &JoinReply) -> Result<Vec<u8>, Outcome> {
        let hash = reply.pack_hash.clone();
        let path = fetch::path_of(&self.options.cache, &hash);
        let (at, of) = (path.clone(), hash.clone());
        if let Some(pack) = self.aside(client, move || fetch::cached(&at, &of)).await? {
            return Ok(pack);
        }
        self.tell(Event::Fetching { bytes: reply.pack_bytes });
        let request = SceneRequest { slave: self.id(), pack_hash: hash.clone() };
        let pieces = answer(client.fetch_scene(request)).await?;
        let received = fetch::receive(pieces, reply.pack_bytes, &hash).await;
        let pack = received.map_err(|why| Outcome::Lost(plain(&why)))?;
        let at = path.clone();
        let (kept, pack) = self.aside(client, move || (fetch::keep(&at, &pack), pack)).await?;
        if let Err(error) = kept {
            // It is rendered all the same, and fetched again by the next.
            self.tell(Event::Trouble(format!(
                "the scene cannot be kept: {}: {error}; the variable INDIGO_CACHE may name another folder for that",
                path.display()
            )));
        }
        Ok(pack)
    }

    /// Does what takes a disk or long on a thread of its own: this one answers the master meanwhile.
    async fn aside<T: Send + 'static>(
        &mut self,
        client: &mut Client,
        work: impl FnOnce() -> T + Send + 'static,
    ) -> Result<T, Outcome> {
        let done = self.beside(client, spawn_blocking(work)).await?;
        done.map_err(|error| Outcome::Broken(error.to_string()))
    }
}
