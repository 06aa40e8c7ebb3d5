//! Memory for uploads, bounded, and kept: pages that the system has just given cost a fifth of an upload.

use super::lock;
use crate::limits::{LEAST_RATE, PATIENCE, ROOM, RUN_UP, UPLOADS};
use std::ops::{Deref, DerefMut};
use std::pin::pin;
use std::sync::atomic::{AtomicBool, AtomicU64, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, Weak};
use std::time::Instant;
use tokio::sync::{AcquireError, OwnedSemaphorePermit, Semaphore};
use tokio::time::timeout;

/// Memory of parcels that were.
type Kept = Arc<Mutex<Vec<Vec<u8>>>>;

/// Room for as many parcels as [`UPLOADS`] says, shared by their real lengths.
pub struct Rooms {
    /// In units of [`ROOM`].
    free: Arc<Semaphore>,
    kept: Kept,
    /// How far those are that have room.
    paces: Mutex<Vec<Weak<Pace>>>,
    /// How many have waited for long.
    waiting: AtomicUsize,
    /// Whether one of those that have room is to give it up for them.
    is_wanted: AtomicBool,
}

/// How far an upload is.
pub struct Pace {
    began: Instant,
    came: AtomicU64,
}

impl Pace {
    fn new() -> Self {
        Self { began: Instant::now(), came: AtomicU64::new(0) }
    }

    /// So many bytes more have come.
    pub fn add(&self, bytes: u64) {
        self.came.fetch_add(bytes, Ordering::Relaxed);
    }

    fn bytes(&self) -> u64 {
        self.came.load(Ordering::Relaxed)
    }

    /// Bytes a second on the average, of one that has had its run-up.
    fn rate(&self) -> Option<f64> {
        let time = self.began.elapsed();
        (time >= RUN_UP).then(|| self.bytes() as f64 / time.as_secs_f64())
    }
}

/// Who waits for long is counted, until it waits no more.
struct Waiting<'a>(&'a AtomicUsize);

impl<'a> Waiting<'a> {
    fn new(count: &'a AtomicUsize) -> Self {
        count.fetch_add(1, Ordering::Relaxed);
        Self(count)
    }
}

impl Drop for Waiting<'_> {
    fn drop(&mut self) {
        self.0.fetch_sub(1, Ordering::Relaxed);
    }
}

impl Rooms {
    /// For parcels of at most so many bytes.
    pub fn new(parcel_limit: u64) -> Self {
        let units = (UPLOADS as u64 * parcel_limit).div_ceil(ROOM);
        Self {
            free: Arc::new(Semaphore::new(units as usize)),
            kept: Kept::default(),
            paces: Mutex::default(),
            waiting: AtomicUsize::new(0),
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
        let mut waiting = None;
        let permit = loop {
            match timeout(PATIENCE, &mut permit).await {
                Ok(permit) => break permit?,
                // One that is given up may not be enough.
                Err(_) => {
                    waiting.get_or_insert_with(|| Waiting::new(&self.waiting));
                    self.is_wanted.store(true, Ordering::Relaxed);
                }
            }
        };
        drop(waiting);
        // Who waits still says so again.
        self.is_wanted.store(false, Ordering::Relaxed);
        let pace = Arc::new(Pace::new());
        lock(&self.paces).push(Arc::downgrade(&pace));
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
        Ok(Room { memory, pace, kept: Arc::clone(&self.kept), _permit: permit })
    }

    /// Whether whoever asks has to give up its room, since somebody has waited for long, and at what rate it was used: the
    /// slowest does that has had its run-up and is slower than [`LEAST_RATE`]. Never the one that has come furthest: else a line
    /// that is too slow for all of them together would bring none to its end.
    pub fn must_give_up(&self, asks: &Pace) -> Option<f64> {
        if self.waiting.load(Ordering::Relaxed) == 0 || !self.is_wanted.load(Ordering::Relaxed) {
            return None;
        }
        let mut paces = lock(&self.paces);
        paces.retain(|pace| pace.strong_count() > 0);
        let all: Vec<_> = paces.iter().filter_map(Weak::upgrade).collect();
        drop(paces);
        let furthest = all.iter().max_by_key(|pace| pace.bytes())?;
        let slow = |pace: &Arc<Pace>| {
            let rate = pace.rate().filter(|rate| *rate < LEAST_RATE as f64)?;
            (!Arc::ptr_eq(pace, furthest)).then_some((rate, Arc::as_ptr(pace)))
        };
        let (rate, slowest) = all.iter().filter_map(slow).min_by(|a, b| a.0.total_cmp(&b.0))?;
        // Nobody else is told so for the same.
        (std::ptr::eq(slowest, asks) && self.is_wanted.swap(false, Ordering::Relaxed)).then_some(rate)
    }
}

/// Memory of a parcel, empty at first.
pub struct Room {
    memory: Vec<u8>,
    /// How far it is filled.
    pub pace: Arc<Pace>,
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

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    fn began(ago: Duration, came: u64) -> Arc<Pace> {
        Arc::new(Pace { began: Instant::now().checked_sub(ago).expect("long ago"), came: came.into() })
    }

    /// Of those that are slow the slowest makes room, when somebody waits, and once for each time that it is asked for.
    #[test]
    fn the_slowest_makes_room() {
        let rooms = Rooms::new(1000);
        let long = 3 * RUN_UP;
        let least = LEAST_RATE * long.as_secs();
        let [fast, slow, slower, slowest] =
            [2 * least, least / 2, least / 3, 10].map(|came| began(long, came));
        let new = began(Duration::ZERO, 0);
        *lock(&rooms.paces) = [&fast, &slow, &slower, &slowest, &new].map(Arc::downgrade).into();
        let who = |rooms: &Rooms, paces: &[&Arc<Pace>]| {
            paces.iter().position(|pace| rooms.must_give_up(pace).is_some())
        };
        rooms.is_wanted.store(true, Ordering::Relaxed);
        assert_eq!(who(&rooms, &[&fast, &slow, &slower, &slowest, &new]), None, "who wanted it has gone");
        let _waiting = Waiting::new(&rooms.waiting);
        assert_eq!(who(&rooms, &[&fast, &slow, &slower, &slowest, &new]), Some(3));
        assert_eq!(who(&rooms, &[&slowest]), None, "for one there is room now");
        drop(slowest);
        rooms.is_wanted.store(true, Ordering::Relaxed);
        assert_eq!(who(&rooms, &[&fast, &slow, &slower, &new]), Some(2));
    }

    /// A line that is too slow for all of them still brings one after the other to its end.
    #[test]
    fn who_has_come_furthest_does_not() {
        let rooms = Rooms::new(1000);
        let [first, second] = [(4, 30), (2, 20)].map(|(run_ups, came)| began(run_ups * RUN_UP, came));
        *lock(&rooms.paces) = [&first, &second].map(Arc::downgrade).into();
        let _waiting = Waiting::new(&rooms.waiting);
        rooms.is_wanted.store(true, Ordering::Relaxed);
        assert!(rooms.must_give_up(&first).is_none(), "it is the slower of both");
        assert!(rooms.must_give_up(&second).is_some());
    }
}
