//! A cursor over little-endian binary data that knows its offset and never reads past the end.

use crate::error::{FormatError, Position};

/// How an offset is told to the user: of the file, or of what was decompressed from it.
pub(crate) type Place = fn(usize) -> Position;

/// The unread rest of a binary block.
#[derive(Clone)]
pub(crate) struct Bytes<'a> {
    rest: &'a [u8],
    offset: usize,
    place: Place,
}

impl<'a> Bytes<'a> {
    /// Starts at the first byte of a whole file.
    pub(crate) fn new(data: &'a [u8]) -> Self {
        Self::placed(data, 0, Position::Byte)
    }

    /// Starts at `data`, whose first byte stands at `offset` of what `place` names.
    pub(crate) fn placed(data: &'a [u8], offset: usize, place: Place) -> Self {
        Self { rest: data, offset, place }
    }

    pub(crate) fn offset(&self) -> usize {
        self.offset
    }

    pub(crate) fn rest(&self) -> &'a [u8] {
        self.rest
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.rest.is_empty()
    }

    pub(crate) fn position(&self) -> Position {
        (self.place)(self.offset)
    }

    /// An error at an earlier offset.
    pub(crate) fn error_at(
        &self,
        offset: usize,
        expected: impl Into<String>,
        found: impl Into<String>,
    ) -> FormatError {
        FormatError::new((self.place)(offset), expected, found)
    }

    /// The next `n` bytes; `what` completes "expected ... (n bytes)".
    pub(crate) fn take(&mut self, n: usize, what: &str) -> Result<&'a [u8], FormatError> {
        let Some((head, tail)) = self.rest.split_at_checked(n) else {
            return Err(FormatError::new(
                self.position(),
                format!("{what} ({n} bytes)"),
                format!("only {} bytes more", self.rest.len()),
            ));
        };
        self.rest = tail;
        self.offset += n;
        Ok(head)
    }

    /// The next `n` bytes as a cursor of their own.
    pub(crate) fn sub(&mut self, n: usize, what: &str) -> Result<Self, FormatError> {
        let (offset, place) = (self.offset, self.place);
        Ok(Self::placed(self.take(n, what)?, offset, place))
    }

    fn array<const N: usize>(&mut self, what: &str) -> Result<[u8; N], FormatError> {
        let taken = self.take(N, what)?;
        let mut out = [0; N];
        out.copy_from_slice(taken);
        Ok(out)
    }

    pub(crate) fn u16(&mut self, what: &str) -> Result<u16, FormatError> {
        Ok(u16::from_le_bytes(self.array(what)?))
    }

    pub(crate) fn u32(&mut self, what: &str) -> Result<u32, FormatError> {
        Ok(u32::from_le_bytes(self.array(what)?))
    }

    pub(crate) fn u64(&mut self, what: &str) -> Result<u64, FormatError> {
        Ok(u64::from_le_bytes(self.array(what)?))
    }

    /// Checks that `count` rows of at least `row_bytes` can still follow, before anyone allocates for them.
    pub(crate) fn promise(&self, count: usize, row_bytes: usize, what: &str) -> Result<usize, FormatError> {
        let needed = count as u128 * row_bytes as u128;
        if needed <= self.rest.len() as u128 {
            return Ok(count);
        }
        Err(FormatError::new(
            self.position(),
            format!("{count} {what} ({needed} bytes or more)"),
            format!("only {} bytes more", self.rest.len()),
        ))
    }

    /// `count` rows of `N` floats each; all must be finite when `finite` is set.
    pub(crate) fn f32_rows<const N: usize>(
        &mut self,
        count: usize,
        finite: bool,
        what: &str,
    ) -> Result<Vec<[f32; N]>, FormatError> {
        self.promise(count, 4 * N, what)?;
        let start = self.offset;
        let mut rows = Vec::with_capacity(count);
        for (i, row) in self.take(count * 4 * N, what)?.chunks_exact(4 * N).enumerate() {
            let values = f32_row(row);
            if finite && !values.iter().all(|x: &f32| x.is_finite()) {
                return Err(self.error_at(
                    start + i * 4 * N,
                    format!("finite numbers among the {what}"),
                    format!("{values:?} (number {i})"),
                ));
            }
            rows.push(values);
        }
        Ok(rows)
    }
}

/// `N` little-endian floats from a slice of (at least) 4·N bytes.
fn f32_row<const N: usize>(row: &[u8]) -> [f32; N] {
    let mut values = [0.0; N];
    for (value, bytes) in values.iter_mut().zip(row.as_chunks::<4>().0) {
        *value = f32::from_le_bytes(*bytes);
    }
    values
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reads_little_endian_and_reports_the_offset_of_what_is_missing() {
        let mut bytes = Bytes::new(&[1, 2, 3, 4, 5, 6, 7]);
        assert_eq!(bytes.u16("a word"), Ok(0x0201));
        assert_eq!(bytes.u32("a count"), Ok(0x0605_0403));
        let error = bytes.u16("a word").unwrap_err();
        assert_eq!(error.to_string(), "byte 6: expected a word (2 bytes), found only 1 bytes more");
    }

    #[test]
    fn refuses_a_promise_that_the_rest_cannot_hold() {
        let bytes = Bytes::new(&[0; 36]);
        assert_eq!(bytes.promise(3, 12, "vertices"), Ok(3));
        assert!(bytes.promise(4, 12, "vertices").is_err());
        assert!(bytes.promise(usize::MAX, usize::MAX, "vertices").is_err());
    }
}
