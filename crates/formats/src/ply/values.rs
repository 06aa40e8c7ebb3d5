//! The data after the header, number by number, whatever their encoding.

use super::header::{Kind, Scalar};
use crate::error::{FormatError, Position};
use crate::text::Text;

/// A cursor over a file's numbers.
pub(super) trait Values: Clone {
    /// Where the next number begins (or the white space before it).
    fn offset(&self) -> usize;
    fn remaining(&self) -> usize;
    /// The fewest bytes that a property can take in this encoding.
    fn least_bytes(&self, kind: Kind) -> usize;
    /// The next number; it need not be finite.
    fn real(&mut self, scalar: Scalar) -> Result<f32, FormatError>;
    /// The next number, which must be whole.
    fn integer(&mut self, scalar: Scalar) -> Result<i64, FormatError>;
    fn skip(&mut self, scalar: Scalar, count: usize) -> Result<(), FormatError>;
    fn error_at(&self, offset: usize, expected: &str, found: &str) -> FormatError;
    fn error(&self, expected: &str, found: &str) -> FormatError {
        self.error_at(self.offset(), expected, found)
    }
}

/// Words between white space.
#[derive(Clone)]
pub(super) struct Ascii<'a>(Text<'a>);

impl<'a> Ascii<'a> {
    pub(super) fn new(bytes: &'a [u8], at: usize) -> Self {
        Self(Text::new(bytes, at))
    }
}

impl Values for Ascii<'_> {
    fn offset(&self) -> usize {
        let mut text = self.0.clone();
        text.skip_space();
        text.offset()
    }

    fn remaining(&self) -> usize {
        self.0.remaining()
    }

    fn least_bytes(&self, _: Kind) -> usize {
        2
    }

    fn real(&mut self, _: Scalar) -> Result<f32, FormatError> {
        self.0.skip_space();
        self.0.number("a number")
    }

    fn integer(&mut self, _: Scalar) -> Result<i64, FormatError> {
        self.0.skip_space();
        self.0.number("a whole number")
    }

    fn skip(&mut self, _: Scalar, count: usize) -> Result<(), FormatError> {
        for _ in 0..count {
            self.0.skip_space();
            if self.0.word().is_empty() {
                return Err(self.0.error("a number"));
            }
        }
        Ok(())
    }

    fn error_at(&self, offset: usize, expected: &str, found: &str) -> FormatError {
        self.0.error_saying(offset, expected, found)
    }
}

/// Fixed-width numbers of either byte order.
#[derive(Clone)]
pub(super) struct Binary<'a, const BIG: bool> {
    bytes: &'a [u8],
    at: usize,
}

impl<'a, const BIG: bool> Binary<'a, BIG> {
    pub(super) fn new(bytes: &'a [u8], at: usize) -> Self {
        Self { bytes, at: at.min(bytes.len()) }
    }

    /// Called for every number of a file, so it must come down to a comparison and an addition.
    #[inline]
    fn take(&mut self, n: usize, what: &str) -> Result<&'a [u8], FormatError> {
        let end = self.at.checked_add(n);
        let taken = end.and_then(|end| self.bytes.get(self.at..end));
        match taken {
            Some(taken) => {
                self.at += n;
                Ok(taken)
            }
            None => Err(self.ended(n, what)),
        }
    }

    #[cold]
    fn ended(&self, n: usize, what: &str) -> FormatError {
        self.error(&format!("{what} ({n} bytes)"), &format!("only {} bytes more", self.remaining()))
    }
}

/// The first `N` bytes in little-endian order; zeros where there are fewer.
fn ordered<const N: usize, const BIG: bool>(bytes: &[u8]) -> [u8; N] {
    let mut out = bytes.first_chunk().copied().unwrap_or([0; N]);
    if BIG {
        out.reverse();
    }
    out
}

impl<const BIG: bool> Values for Binary<'_, BIG> {
    fn offset(&self) -> usize {
        self.at
    }

    fn remaining(&self) -> usize {
        self.bytes.len() - self.at
    }

    fn least_bytes(&self, kind: Kind) -> usize {
        match kind {
            Kind::Scalar(scalar) | Kind::List { count: scalar, .. } => scalar.size(),
        }
    }

    fn real(&mut self, scalar: Scalar) -> Result<f32, FormatError> {
        let bytes = self.take(scalar.size(), "a number")?;
        Ok(match scalar {
            Scalar::I8 => i8::from_le_bytes(ordered::<1, BIG>(bytes)).into(),
            Scalar::U8 => u8::from_le_bytes(ordered::<1, BIG>(bytes)).into(),
            Scalar::I16 => i16::from_le_bytes(ordered::<2, BIG>(bytes)).into(),
            Scalar::U16 => u16::from_le_bytes(ordered::<2, BIG>(bytes)).into(),
            Scalar::I32 => i32::from_le_bytes(ordered::<4, BIG>(bytes)) as f32,
            Scalar::U32 => u32::from_le_bytes(ordered::<4, BIG>(bytes)) as f32,
            Scalar::F32 => f32::from_le_bytes(ordered::<4, BIG>(bytes)),
            Scalar::F64 => f64::from_le_bytes(ordered::<8, BIG>(bytes)) as f32,
        })
    }

    #[inline]
    fn integer(&mut self, scalar: Scalar) -> Result<i64, FormatError> {
        let at = self.at;
        let bytes = self.take(scalar.size(), "a whole number")?;
        Ok(match scalar {
            Scalar::I8 => i8::from_le_bytes(ordered::<1, BIG>(bytes)).into(),
            Scalar::U8 => u8::from_le_bytes(ordered::<1, BIG>(bytes)).into(),
            Scalar::I16 => i16::from_le_bytes(ordered::<2, BIG>(bytes)).into(),
            Scalar::U16 => u16::from_le_bytes(ordered::<2, BIG>(bytes)).into(),
            Scalar::I32 => i32::from_le_bytes(ordered::<4, BIG>(bytes)).into(),
            Scalar::U32 => u32::from_le_bytes(ordered::<4, BIG>(bytes)).into(),
            Scalar::F32 | Scalar::F64 => {
                let value = match scalar {
                    Scalar::F32 => f32::from_le_bytes(ordered::<4, BIG>(bytes)).into(),
                    _ => f64::from_le_bytes(ordered::<8, BIG>(bytes)),
                };
                if value.fract() != 0.0 {
                    return Err(self.error_at(at, "a whole number", &value.to_string()));
                }
                // Saturates; no index or length is that large.
                value as i64
            }
        })
    }

    fn skip(&mut self, scalar: Scalar, count: usize) -> Result<(), FormatError> {
        self.take(scalar.size().saturating_mul(count), "numbers").map(|_| ())
    }

    fn error_at(&self, offset: usize, expected: &str, found: &str) -> FormatError {
        FormatError::new(Position::Byte(offset), expected, found)
    }
}
