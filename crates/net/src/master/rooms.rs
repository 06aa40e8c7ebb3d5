//! Memory for uploads, bounded, and kept: pages that the system has just given cost a fifth of an upload.

use super::lock;
use crate::limits::{PATIENCE, ROOM, UPLOADS};
use std::ops::{Deref, DerefMut};
use std::pin::pin;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};
use tokio::sync::{AcquireError, OwnedSemaphorePermit, Semaphore};
use tokio::time::timeout;

/// Memory of parcels that were.
type Kept = Arc<Mutex<Vec<Vec<u8>>>>;

/// Room for as many parcels as [`UPLOADS`] says, shared by their real lengths.
pub struct Rooms {
    /// In units of [`ROOM`].
    free: Arc<Semaphore>,
    kept: Kept,
    /// Whether somebody has waited for long.
    is_wanted: AtomicBool,
}

impl Rooms {
    /// For parcels of at most so many bytes.
    pub fn new(parcel_limit: u64) -> Self {
        let units = (UPLOADS as u64 * parcel_limit).div_ceil(ROOM);
        Self {
            free: Arc::new(Semaphore::new(units as usize)),
            kept: Kept::default(),
            is_wanted: AtomicBool::new(false),
        }
    }

    /// Waits for room for so many bytes, which must be within the limit.
    ///
    /// # Errors
    /// None while there is a master.
    pub async fn take(&self, bytes: u64) -> Result<Room, AcquireError> {
        // Not more than there is, as the length is within the limit.
        let units = u32::try_from(bytes.div_ceil(ROOM)).unwrap_or(u32::MAX).max(1);
        let mut permit = pin!(Arc::clone(&self.free).acquire_many_owned(units));
        let permit = loop {
            match timeout(PATIENCE, &mut permit).await {
                Ok(permit) => break permit?,
                // One that is given up may not be enough.
                Err(_) => self.is_wanted.store(true, Ordering::Relaxed),
            }
        };
        // Who waits still says so again.
        self.is_wanted.store(false, Ordering::Relaxed);
        let mut kept = lock(&self.kept);
        let mut memory = kept.pop().unwrap_or_default();
        // What is in use and what is kept are together no more than there is room for.
        memory.shrink_to(bytes as usize);
        let free = self.free.available_permits() as u64 * ROOM;
        while kept.iter().map(|memory| memory.capacity() as u64).sum::<u64>() > free {
            kept.pop();
        }
        drop(kept);
        memory.reserve_exact(bytes as usize);
        Ok(Room { memory, kept: Arc::clone(&self.kept), _permit: permit })
    }
}

impl Rooms {
    /// Whether whoever asks has to give up its room, since somebody has waited for long: nobody else is told so for the same.
    pub fn must_give_up(&self) -> bool {
        self.is_wanted.swap(false, Ordering::Relaxed)
    }
}

/// Memory of a parcel, empty at first.
pub struct Room {
    memory: Vec<u8>,
    kept: Kept,
    _permit: OwnedSemaphorePermit,
}

impl Deref for Room {
    type Target = Vec<u8>;

    fn deref(&self) -> &Vec<u8> {
        &self.memory
    }
}

impl DerefMut for Room {
    fn deref_mut(&mut self) -> &mut Vec<u8> {
        &mut self.memory
    }
}

impl Drop for Room {
    fn drop(&mut self) {
        let mut memory = std::mem::take(&mut self.memory);
        memory.clear();
        let mut kept = lock(&self.kept);
        // Of many small ones no more than there may be large ones.
        if kept.len() < UPLOADS {
            kept.push(memory);
        }
    }
}
