//! Getting the scene: from the cache, or from the master.

use crate::key::hex;
use crate::limits::PACK;
use crate::master::Override;
use crate::proto::Piece;
use indigo_render::atomic::write_atomically;
use indigo_render::disk::read_limited;
use std::fs;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::SystemTime;
use tonic::Streaming;

/// The most packed scenes that are kept, and their bytes together; the newest one is kept in any case.
const MOST_PACKS: usize = 32;
const MOST_BYTES: u64 = 16 << 30;
/// The ending of their names.
const ENDING: &str = "pigs";

/// A packed scene with what its master adds to it.
#[derive(Clone, Debug)]
pub struct SceneFiles {
    /// What people call it.
    pub name: String,
    /// The packed scene.
    pub pack: Arc<[u8]>,
    /// The master's settings file.
    pub settings_file: Option<Vec<u8>>,
    /// Settings of the master's command line.
    pub overrides: Vec<Override>,
}

/// The path of a packed scene in the cache.
pub fn path_of(cache: &Path, hash: &[u8]) -> PathBuf {
    cache.join(format!("{}.{ENDING}", hex(hash)))
}

/// A packed scene, if the cache has it undamaged.
pub fn cached(path: &Path, hash: &[u8]) -> Option<Vec<u8>> {
    let pack = read_limited(path).ok().filter(|pack| blake3::hash(pack).as_bytes() == hash)?;
    if let Ok(file) = fs::File::open(path) {
        // Used just now: others are thrown away first. Where that cannot be noted, it goes sooner.
        drop(file.set_modified(SystemTime::now()));
    }
    Some(pack)
}

/// Receives a packed scene.
///
/// # Errors
/// Where it does not come, or is not what it should be.
pub async fn receive(mut pieces: Streaming<Piece>, length: u64, hash: &[u8]) -> Result<Vec<u8>, String> {
    if length > PACK {
        return Err(format!("the scene of {length} bytes is larger than the {PACK} that a slave takes"));
    }
    // Room is made for what comes, not for what is announced.
    let mut pack = vec![];
    loop {
        let piece = tokio::time::timeout(crate::limits::SILENCE, pieces.message()).await;
        let piece = piece.map_err(|_| "the scene has stopped coming".to_owned())?;
        let Some(Piece { data }) = piece.map_err(|status| status.message().to_owned())? else { break };
        if (pack.len() + data.len()) as u64 > length {
            return Err("the scene is longer than the master has said".to_owned());
        }
        pack.extend_from_slice(&data);
    }
    // That of a large scene takes seconds, in which the master may want an answer.
    let hashed = tokio::task::spawn_blocking(move || (blake3::hash(&pack), pack));
    let (found, pack) = hashed.await.map_err(|error| error.to_string())?;
    if found.as_bytes() == hash { Ok(pack) } else { Err("the scene was damaged on its way".to_owned()) }
}

/// Keeps a packed scene, and throws away what has not been used for longest.
///
/// # Errors
/// What the system says.
pub fn keep(path: &Path, pack: &[u8]) -> std::io::Result<()> {
    write_atomically(path, |file| file.write_all(pack))?;
    if let Some(folder) = path.parent() {
        clear(folder, path);
    }
    Ok(())
}

/// Best effort: a cache that is too large harms nobody at once.
fn clear(folder: &Path, newest: &Path) {
    let Ok(entries) = fs::read_dir(folder) else { return };
    let mut packs: Vec<(SystemTime, u64, PathBuf)> = entries
        .filter_map(Result::ok)
        .filter(|entry| entry.path().extension().is_some_and(|ending| ending == ENDING))
        .filter_map(|entry| {
            let meta = entry.metadata().ok()?;
            Some((meta.modified().ok()?, meta.len(), entry.path()))
        })
        .filter(|(_, _, path)| path != newest)
        .collect();
    packs.sort();
    let mut bytes: u64 = packs.iter().map(|pack| pack.1).sum();
    let mut count = packs.len() + 1;
    for (_, length, path) in packs {
        if count <= MOST_PACKS && bytes <= MOST_BYTES {
            break;
        }
        drop(fs::remove_file(path));
        (count, bytes) = (count - 1, bytes - length);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    #[test]
    fn the_cache_keeps_what_was_used_last() {
        let folder = std::env::temp_dir().join(format!("indigo-packs-{}", std::process::id()));
        let hash = |n: usize| *blake3::hash(&n.to_le_bytes()).as_bytes();
        let path = |n: usize| path_of(&folder, &hash(n));
        for n in 0..MOST_PACKS {
            keep(&path(n), &n.to_le_bytes()).unwrap();
            let made = SystemTime::now() - Duration::from_secs((1000 - n) as u64);
            fs::File::open(path(n)).unwrap().set_modified(made).unwrap();
        }
        assert!(cached(&path(0), &hash(0)).is_some(), "and used just now");
        keep(&path(MOST_PACKS), &MOST_PACKS.to_le_bytes()).unwrap();
        assert!(path(0).exists() && !path(1).exists() && path(2).exists());
        fs::write(path(2), b"damaged").unwrap();
        assert_eq!(cached(&path(2), &hash(2)), None);
        fs::remove_dir_all(folder).unwrap();
    }
}
