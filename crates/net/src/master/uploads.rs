//! Receiving uploads: within their length and time, and no slower than others can wait for.

use crate::limits::{LEAST_RATE, SILENCE, UPLOAD};
use crate::proto::UploadPart;
use crate::proto::upload_part::Part;
use std::time::Duration;
use tokio::time::{sleep, timeout};
use tokio_stream::{Stream, StreamExt as _};
use tonic::Status;

/// What an upload may take.
pub struct Bounds<F> {
    /// In all, however fast it is.
    time: Duration,
    /// Whether its room is wanted, which then is another's, and at what rate it came, in bytes a second.
    is_wanted: F,
}

impl<F: Fn() -> Option<f64>> Bounds<F> {
    /// Those of all uploads.
    pub fn new(is_wanted: F) -> Self {
        Self { time: UPLOAD, is_wanted }
    }

    /// Ends where an upload is so slow that others, who wait, cannot wait for it. Whoever gives a little each time would else
    /// keep them from the film.
    async fn give_up(&self) -> Status {
        /// How often that is looked at.
        const LOOKS: Duration = Duration::from_millis(500);
        loop {
            sleep(LOOKS).await;
            if let Some(rate) = (self.is_wanted)() {
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
    bounds: Bounds<impl Fn() -> Option<f64>>,
    mut parts: impl Stream<Item = Result<UploadPart, Status>> + Unpin,
    came: impl Fn(u64),
) -> Result<(), Status> {
    let gathered = async {
        while let Some(part) = next(&mut parts).await? {
            let Part::Data(data) = part else {
                return Err(Status::invalid_argument("an upload has one beginning"));
            };
            if (parcel.len() + data.len()) as u64 > length {
                return Err(Status::resource_exhausted("an upload is longer than it says"));
            }
            parcel.extend_from_slice(&data);
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
        // What is complete is not given up.
        biased;
        gathered = timeout(bounds.time, gathered) => gathered.unwrap_or_else(late),
        given_up = bounds.give_up() => Err(given_up),
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
            let bounds = Bounds { time, is_wanted: || is_wanted.then_some(7.0) };
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
        assert!(status.message().contains("comes at 7 bytes a second makes room for others"), "{status}");
    }
}
