//! Finding a master that takes this slave.

use super::Options;
use super::calls::{Client, Outcome, first_answer};
use super::connect::written;
use super::visit::Life;
use crate::discovery;
use crate::event::Event;
use crate::limits::PROTOCOL;
use crate::plain::plain;
use crate::proto::{JoinReply, JoinRequest};
use std::net::SocketAddr;

/// So many addresses are tried at a time: one that does not answer takes seconds, and there may be some hundred.
const AT_ONCE: usize = 16;
/// The most addresses that are remembered for having turned this slave down.
const MOST_TURNED_DOWN: usize = 256;

/// A master that has let this slave in; and where it is, if it was found there.
pub type Joined = (Client, JoinReply, Option<SocketAddr>);

impl Life {
    /// Connects, and introduces itself: to the master that was named, or to one in the local network.
    pub(super) async fn join(&mut self) -> Result<Joined, Outcome> {
        let Some((host, port)) = &self.options.master else {
            let found = discovery::masters().await.map_err(|why| {
                Outcome::Lost(format!("no master can be looked for: {why}; name its machine by -h"))
            })?;
            return self.join_one(found.into_iter().map(SocketAddr::from).collect()).await;
        };
        let place = written(host, *port);
        let client = self.connector.connect(host, *port).await;
        let client =
            client.map_err(|why| Outcome::Lost(format!("no master is reached at {place}: {why}")))?;
        let (client, reply) = self.introduce(client, place).await?;
        Ok((client, reply, None))
    }

    /// Joins the first of several masters that has the key and takes this slave.
    pub async fn join_one(&mut self, mut places: Vec<SocketAddr>) -> Result<Joined, Outcome> {
        // Those that had nothing for it come last, and the others stay as they are sorted.
        places.sort_by_key(|place| self.turned_down.contains(place));
        // Of several reasons the first says best why there is none: the likeliest to be reached is first.
        let mut reason = None;
        for some in places.chunks(AT_ONCE) {
            let tries: Vec<_> = some.iter().map(|place| (*place, self.try_at(*place))).collect();
            for (place, connected) in tries {
                let joined = match connected.await {
                    Ok(Ok(client)) => self.introduce(client, place.to_string()).await,
                    Ok(Err(why)) => Err(Outcome::Lost(format!("there is a master at {place}, but {why}"))),
                    Err(error) => Err(Outcome::Lost(error.to_string())),
                };
                match joined {
                    Ok((client, reply)) => return Ok((client, reply, Some(place))),
                    Err(outcome) => drop(reason.get_or_insert(outcome)),
                }
            }
        }
        Err(reason.unwrap_or_else(|| Outcome::Lost("no master is in the local network".to_owned())))
    }

    fn try_at(&self, place: SocketAddr) -> tokio::task::JoinHandle<Result<Client, String>> {
        let connector = self.connector.clone();
        tokio::spawn(async move { connector.connect(&place.ip().to_string(), place.port()).await })
    }

    /// Introduces itself.
    async fn introduce(&self, mut client: Client, place: String) -> Result<(Client, JoinReply), Outcome> {
        let Options { name, program, threads, key, .. } = &self.options;
        let request = JoinRequest {
            protocol: PROTOCOL,
            program: program.clone(),
            slave: self.id(),
            seed: self.seed,
            name: name.clone(),
            threads: u32::try_from(*threads).unwrap_or(u32::MAX),
        };
        let reply =
            first_answer(client.join(request), &place, key.is_some()).await.map_err(
                |outcome| match outcome {
                    Outcome::Lost(why) if key.is_none() => Outcome::Lost(format!(
                        "{why}; if it has a key, this slave needs the same one (--key-file FILE)"
                    )),
                    outcome => outcome,
                },
            )?;
        self.tell(Event::Connected { master: place, scene: plain(&reply.scene) });
        Ok((client, reply))
    }

    /// Others come before the master that was found there from now on.
    pub fn turn_down(&mut self, place: SocketAddr) {
        if self.turned_down.len() >= MOST_TURNED_DOWN {
            self.turned_down.clear();
        }
        if !self.turned_down.contains(&place) {
            self.turned_down.push(place);
        }
    }
}
