//! Films as they travel.

use crate::ledger::run_of;
use crate::limits::PIECE;
use crate::proto::upload_part::Part;
use crate::proto::{UploadPart, UploadStart};
use bytes::Bytes;
use indigo_film::igi::write_parcel;
use indigo_film::{FilmRecord, Run, SavedFilm};

/// The samples and units of a film, and the film as it travels.
pub fn parcel_of(film: &SavedFilm) -> (u64, Run, Bytes) {
    let blank = FilmRecord::default();
    let record = film.record.as_ref().unwrap_or(&blank);
    let mut bytes = vec![];
    // To write to memory cannot fail, and what came out wrong the master would refuse.
    drop(write_parcel(&mut bytes, &film.film, record));
    let run = run_of(film).unwrap_or(Run { seed: 0, first: 0, end: 0 });
    (record.samples, run, bytes.into())
}

/// A parcel in pieces, behind what says how long it is.
pub fn parts(slave: Bytes, parcel: Bytes) -> impl Iterator<Item = UploadPart> + Send + 'static {
    let start = Part::Start(UploadStart { slave, bytes: parcel.len() as u64 });
    let pieces = (0..parcel.len())
        .step_by(PIECE)
        .map(move |from| Part::Data(parcel.slice(from..(from + PIECE).min(parcel.len()))));
    std::iter::once(start).chain(pieces).map(|part| UploadPart { part: Some(part) })
}
