//! The unread rest of a file, taken in checked pieces.

use super::IgiError;

/// What has not been read yet.
pub(super) struct Bytes<'a>(pub &'a [u8]);

impl<'a> Bytes<'a> {
    /// The next `n` bytes; `what` names them where they are missing.
    pub fn take(&mut self, n: usize, what: &'static str) -> Result<&'a [u8], IgiError> {
        let (head, rest) = self.0.split_at_checked(n).ok_or(IgiError::Truncated(what))?;
        self.0 = rest;
        Ok(head)
    }

    fn array<const N: usize>(&mut self, what: &'static str) -> Result<[u8; N], IgiError> {
        let mut array = [0; N];
        array.copy_from_slice(self.take(N, what)?);
        Ok(array)
    }

    pub fn u32(&mut self, what: &'static str) -> Result<u32, IgiError> {
        self.array(what).map(u32::from_le_bytes)
    }

    pub fn u64(&mut self, what: &'static str) -> Result<u64, IgiError> {
        self.array(what).map(u64::from_le_bytes)
    }

    pub fn f64(&mut self, what: &'static str) -> Result<f64, IgiError> {
        self.array(what).map(f64::from_le_bytes)
    }

    pub fn hash(&mut self) -> Result<[u8; 32], IgiError> {
        self.array("a hash")
    }

    /// A number of things of at least `least` bytes each.
    pub fn count(&mut self, least: usize, what: &'static str) -> Result<usize, IgiError> {
        let n = self.u32(what)? as usize;
        if n > self.0.len() / least { Err(IgiError::Truncated(what)) } else { Ok(n) }
    }

    /// A text behind its length in bytes.
    pub fn text(&mut self, what: &'static str) -> Result<String, IgiError> {
        let n = self.count(1, what)?;
        let bytes = self.take(n, what)?;
        String::from_utf8(bytes.to_vec()).map_err(|_| IgiError::Malformed("a text is not UTF-8"))
    }

    /// A text of another program, whatever its encoding.
    pub fn foreign_text(&mut self, what: &'static str) -> Result<String, IgiError> {
        let n = self.count(1, what)?;
        Ok(String::from_utf8_lossy(self.take(n, what)?).into_owned())
    }
}
