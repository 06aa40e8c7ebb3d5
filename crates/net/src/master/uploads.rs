//! Receiving uploads: within their length and time, and no slower than others can wait for.

use crate::limits::{LEAST_RATE, RUN_UP, SILENCE, UPLOAD};
use crate::proto::UploadPart;
use crate::proto::upload_part::Part;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};
use tokio::time::{sleep, timeout};
use tokio_stream::{Stream, StreamExt as _};
use tonic::Status;

/// What an upload may take.
pub struct Bounds<F> {
    /// In all, however fast it is.
    time: Duration,
    /// For so long it may be as slow as it likes.
    run_up: Duration,
    /// Whether its room is wanted, which then is another's.
    is_wanted: F,
}

impl<F: Fn() -> bool> Bounds<F> {
    /// Those of all uploads.
    pub fn new(is_wanted: F) -> Self {
        Self { time: UPLOAD, run_up: RUN_UP, is_wanted }
    }

    /// Ends where an upload is so slow that others, who wait, cannot wait for it. Whoever gives a little each time would else
    /// keep them from the film.
    async fn give_up(&self, came: &AtomicU64) -> Status {
        /// How often that is looked at.
        const LOOKS: Duration = Duration::from_millis(500);
        let began = Instant::now();
        loop {
            sleep(LOOKS.min(self.run_up)).await;
            let time = began.elapsed();
            let rate = came.load(Ordering::Relaxed) as f64 / time.as_secs_f64();
            // In this order: what is wanted is asked for but once.
            if time >= self.run_up && rate < LEAST_RATE as f64 && (self.is_wanted)() {
                return Status::deadline_exceeded(format!(
                    "an upload that comes at {rate:.0} bytes a second makes room for others, who wait; while they do, \
                     {LEAST_RATE} are the least"
                ));
            }
        }
    }
}

/// Gathers the parts of an upload behind its beginning, within bounds, and tells of the bytes of each.
pub async fn gather(
    parcel: &mut Vec<u8>,
    length: u64,
    bounds: Bounds<impl Fn() -> bool>,
    mut parts: impl Stream<Item = Result<UploadPart, Status>> + Unpin,
    came: impl Fn(u64),
) -> Result<(), Status> {
    let all = AtomicU64::new(0);
    let gathered = async {
        while let Some(part) = next(&mut parts).await? {
            let Part::Data(data) = part else {
                return Err(Status::invalid_argument("an upload has one beginning"));
            };
            if (parcel.len() + data.len()) as u64 > length {
                return Err(Status::resource_exhausted("an upload is longer than it says"));
            }
            parcel.extend_from_slice(&data);
            all.fetch_add(data.len() as u64, Ordering::Relaxed);
            came(data.len() as u64);
        }
        if (parcel.len() as u64) < length {
            return Err(Status::data_loss("an upload is shorter than it says"));
        }
        Ok(())
    };
    // Who gives little each time holds room that others may come to wait for.
    let late = |_| Err(Status::deadline_exceeded("an upload takes too long"));
    tokio::select! {
        gathered = timeout(bounds.time, gathered) => gathered.unwrap_or_else(late),
        given_up = bounds.give_up(&all) => Err(given_up),
    }
}

/// The next part of an upload, within a time.
pub async fn next(
    parts: &mut (impl Stream<Item = Result<UploadPart, Status>> + Unpin),
) -> Result<Option<Part>, Status> {
    match timeout(SILENCE, parts.next()).await {
        Ok(Some(Ok(UploadPart { part: Some(part) }))) => Ok(Some(part)),
        Ok(Some(Ok(UploadPart { part: None }))) => {
            Err(Status::invalid_argument("an upload has an empty part"))
        }
        Ok(Some(Err(status))) => Err(status),
        Ok(None) => Ok(None),
        Err(_) => Err(Status::deadline_exceeded("an upload has stopped in its midst")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use bytes::Bytes;
    use tokio_stream::iter;

    /// What becomes of an upload that gives bytes each five milliseconds, and never ends.
    fn drip(bytes: usize, time: Duration, is_wanted: bool) -> (Status, usize) {
        let clock = tokio::runtime::Builder::new_current_thread().enable_time().build();
        clock.expect("a clock").block_on(async {
            let drops = iter(0..).then(move |_| async move {
                sleep(Duration::from_millis(5)).await;
                Ok(UploadPart { part: Some(Part::Data(Bytes::from(vec![b'.'; bytes]))) })
            });
            let run_up = Duration::from_millis(50);
            let bounds = Bounds { time, run_up, is_wanted: || is_wanted };
            let mut parcel = vec![];
            let check = |came| assert_eq!(came, bytes as u64);
            let gathered = gather(&mut parcel, u64::MAX, bounds, Box::pin(drops), check).await;
            (gathered.expect_err("it never ends"), parcel.len())
        })
    }

    /// Who gives a little each time, so that it is never silent, does not hold its room for ever.
    #[test]
    fn an_upload_has_its_time() {
        let (status, length) = drip(1, Duration::from_millis(200), false);
        assert!(status.message().contains("takes too long"), "{status}");
        assert!(length > 1, "it was not silent");
    }

    #[test]
    fn an_upload_that_others_wait_for_is_not_slow() {
        let (status, _) = drip(1, Duration::from_mins(1), true);
        assert!(status.message().contains("makes room for others"), "{status}");
        // On a machine that is ten times as slow as it should be it still is faster than the least.
        let (status, _) = drip(10 * LEAST_RATE as usize / 200, Duration::from_millis(200), true);
        assert!(status.message().contains("takes too long"), "{status}");
    }
}
