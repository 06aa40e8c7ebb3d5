//! The compressed body of version 4.

use std::io::Read;

use ruzstd::decoding::StreamingDecoder;

use crate::bytes::Bytes;
use crate::error::FormatError;

/// What the decompressed body may take per compressed byte. Positions barely compress; index differences of regular
/// grids do, by tens.
const MAX_RATIO: u64 = 256;
/// What it may take besides, so that tiny meshes have room.
const ALLOWANCE: u64 = 1 << 20;
/// Encoders that do not know the size beforehand ask for windows of up to 8 MiB.
const WINDOW: u64 = 8 << 20;

/// Decompresses the rest of the file: a 64-bit size and a zstd frame (RFC 8878). The size may be that of the frame or
/// of what comes out of it: writers' habits are not documented, and either tells whether the data are whole.
pub(super) fn body(bytes: &mut Bytes) -> Result<Vec<u8>, FormatError> {
    let size_at = bytes.offset();
    let size = bytes.u64("the size of the compressed body")?;
    let frame = bytes.rest();
    let frame_at = bytes.offset();
    let limit = frame.len() as u64 * MAX_RATIO + ALLOWANCE;
    if size > limit {
        let expected =
            format!("a compressed body of at most {limit} bytes, {MAX_RATIO} times its compressed size");
        return Err(bytes.error_at(size_at, expected, format!("a size of {size}")));
    }
    let damaged = |found: String| bytes.error_at(frame_at, "a zstd frame", found);
    let mut left = frame;
    let decoder = StreamingDecoder::new_with_max_window_size(&mut left, limit.max(WINDOW))
        .map_err(|error| damaged(error.to_string()))?;
    let mut out = Vec::new();
    decoder.take(limit + 1).read_to_end(&mut out).map_err(|error| damaged(error.to_string()))?;
    if out.len() as u64 > limit {
        return Err(damaged(format!("one that grows beyond {limit} bytes")));
    }
    let consumed = frame.len() - left.len();
    if size != out.len() as u64 && size != consumed as u64 {
        let expected =
            format!("the size of the compressed body ({} bytes, {consumed} compressed)", out.len());
        return Err(bytes.error_at(size_at, expected, size.to_string()));
    }
    Ok(out)
}
