//! The secret that all machines of a render share.

use std::fmt;
use std::fmt::Write as _;

/// What the text of a key begins with, so that nobody takes something else for one.
const PREFIX: &str = "indigo-key-1-";

/// 32 random bytes: whoever has them may join, and read all traffic's meaning.
///
/// Nothing weaker is taken, such as a password: what proves the key to a stranger could be tried offline.
#[derive(Clone, PartialEq, Eq)]
pub struct Key([u8; 32]);

/// Why there is no key.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum KeyError {
    /// The text is none.
    #[error(
        "this is no key: {PREFIX} and 64 digits or letters from a to f are expected, as indigo_console --make-key writes"
    )]
    Malformed,
    /// The system gives no random numbers.
    #[error("the system gives no random numbers: {0}")]
    NoRandomness(String),
}

impl Key {
    /// A new key.
    ///
    /// # Errors
    /// Where the system gives no random numbers.
    pub fn random() -> Result<Self, KeyError> {
        random_bytes().map(Self)
    }

    /// Reads a key's text; white space round it does not count.
    ///
    /// # Errors
    /// Where it is none.
    pub fn parse(text: &str) -> Result<Self, KeyError> {
        let digits = text.trim().strip_prefix(PREFIX).ok_or(KeyError::Malformed)?.as_bytes();
        let mut key = [0; 32];
        if digits.len() != 2 * key.len() {
            return Err(KeyError::Malformed);
        }
        for (byte, pair) in key.iter_mut().zip(digits.chunks_exact(2)) {
            let digit = |c: u8| char::from(c).to_digit(16).filter(|_| !c.is_ascii_uppercase());
            let &[high, low] = pair else { return Err(KeyError::Malformed) };
            let (Some(high), Some(low)) = (digit(high), digit(low)) else {
                return Err(KeyError::Malformed);
            };
            *byte = (16 * high + low) as u8;
        }
        Ok(Self(key))
    }

    /// The key's text, which [`parse`](Self::parse) reads.
    pub fn text(&self) -> String {
        format!("{PREFIX}{}", hex(&self.0))
    }

    /// 32 bytes for a purpose, from which neither the key follows nor what is derived for another purpose.
    pub(crate) fn derive(&self, purpose: &str) -> [u8; 32] {
        blake3::derive_key(purpose, &self.0)
    }
}

/// A key is not to be found in logs.
impl fmt::Debug for Key {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Key(..)")
    }
}

/// Bytes that nobody can guess.
///
/// # Errors
/// Where the system gives none.
pub(crate) fn random_bytes<const N: usize>() -> Result<[u8; N], KeyError> {
    let mut bytes = [0; N];
    getrandom::fill(&mut bytes).map_err(|error| KeyError::NoRandomness(error.to_string()))?;
    Ok(bytes)
}

/// Bytes as text.
pub(crate) fn hex(bytes: &[u8]) -> String {
    let mut text = String::with_capacity(2 * bytes.len());
    for byte in bytes {
        // Writing to a string cannot fail.
        let _ = write!(text, "{byte:02x}");
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_are_read_as_they_are_written_and_nothing_else_is() {
        let key = Key::random().unwrap();
        assert_ne!(key, Key::random().unwrap());
        let text = key.text();
        assert_eq!(Key::parse(&format!(" {text}\r\n")), Ok(key.clone()));
        for bad in
            ["", "secret", &text[1..], &text[..text.len() - 1], &format!("{text}0"), &text.to_uppercase()]
        {
            assert_eq!(Key::parse(bad), Err(KeyError::Malformed), "{bad}");
        }
        assert_eq!(Key::parse(&text.replace(&text[13..15], "é")), Err(KeyError::Malformed));
        assert!(!format!("{key:?}").contains(&text[13..]), "a key is not printed");
    }
}
