//! JSON files that carry their own SHA-256, so that a reader finds any changed bit.
//!
//! ```text
//! {
//!   "sha256": "9f86d0…",     over all other lines, byte for byte
//!   "format": 2,
//!   …
//! }
//! ```
//!
//! To other programs the line is one more key.

use serde::{Serialize, ser::Error};
use sha2::{Digest, Sha256};

const OPENING: &str = "{\n";
const BEFORE: &str = "  \"sha256\": \"";
const AFTER: &str = "\",\n";
const DIGITS: usize = 64;

/// Reason why a file is refused.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum Broken {
    /// The file does not begin with its hash.
    #[error("it does not begin with its SHA-256, so it was not written by this version, or it was changed")]
    NoHash,
    /// The hash does not match the content.
    #[error("its content does not fit its SHA-256, so it was changed since it was written")]
    Differs,
}

/// Encodes an object as indented JSON with its hash.
///
/// # Errors
/// The value is no JSON object, or cannot be written as JSON.
pub fn encode(value: &impl Serialize) -> serde_json::Result<Vec<u8>> {
    let mut text = serde_json::to_string_pretty(value)?;
    text.push('\n');
    let content = text.strip_prefix(OPENING).ok_or_else(|| Error::custom("it is no object"))?;
    Ok(format!("{OPENING}{BEFORE}{}{AFTER}{content}", digest(content)).into_bytes())
}

/// Checks the hash and returns the JSON. The hash is replaced by an empty line, so that line numbers stay.
///
/// # Errors
/// The hash is missing, or does not match the content.
pub fn verify(bytes: &[u8]) -> Result<String, Broken> {
    let text = str::from_utf8(bytes).map_err(|_| Broken::Differs)?;
    let rest = text.strip_prefix(OPENING).and_then(|rest| rest.strip_prefix(BEFORE)).ok_or(Broken::NoHash)?;
    let (noted, rest) = rest.split_at_checked(DIGITS).ok_or(Broken::NoHash)?;
    let content = rest.strip_prefix(AFTER).ok_or(Broken::NoHash)?;
    match digest(content) == noted {
        true => Ok(format!("{OPENING}\n{content}")),
        false => Err(Broken::Differs),
    }
}

/// Returns whether bytes begin as a file of [`encode`] does whose object has this key first. Nothing else is checked.
pub fn begins(bytes: &[u8], key: &str) -> bool {
    let rest = bytes.strip_prefix(OPENING.as_bytes()).and_then(|rest| rest.strip_prefix(BEFORE.as_bytes()));
    let content = rest.and_then(|rest| rest.get(DIGITS..)).and_then(|rest| rest.strip_prefix(AFTER.as_bytes()));
    content.is_some_and(|content| content.starts_with(format!("  \"{key}\":").as_bytes()))
}

fn digest(text: &str) -> String {
    hexadecimal(&Sha256::digest(text))
}

/// Hexadecimal digits of the bytes, two each, in lower case.
pub fn hexadecimal(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}

/// Compiles and runs the example of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::{Value, json};

    fn sample() -> Value {
        json!({"format": 2, "rmse": [0.1, 2.5e-300], "trial": "a \"quoted\" ünï"})
    }

    #[test]
    fn the_hash_is_that_of_all_other_lines() {
        let text = String::from_utf8(encode(&json!({"a": 1})).unwrap()).unwrap();
        // Oracle: printf '  "a": 1\n}\n' | sha256sum
        let oracle = "b15d691ee91e61065da4da31edc55382";
        assert!(text.starts_with(&format!("{{\n  \"sha256\": \"{oracle}")), "{text}");
        assert!(text.ends_with("\",\n  \"a\": 1\n}\n"), "{text}");
    }

    #[test]
    fn a_file_is_known_by_its_first_key() {
        let bytes = encode(&sample()).unwrap();
        assert!(begins(&bytes, "format") && begins(&bytes[..100], "format"));
        assert!(!begins(&bytes, "rmse") && !begins(b"{\n  \"format\": 2\n}\n", "format") && !begins(b"", "format"));
    }

    #[test]
    fn every_flipped_bit_and_every_cut_is_found() {
        let good = encode(&sample()).unwrap();
        assert_eq!(serde_json::from_str::<Value>(&verify(&good).unwrap()).unwrap(), sample());
        for at in 0..good.len() {
            assert!(verify(&good[..at]).is_err(), "cut at {at}");
            for bit in 0..8 {
                let mut bytes = good.clone();
                bytes[at] ^= 1 << bit;
                assert!(verify(&bytes).is_err(), "bit {bit} of byte {at}");
            }
        }
    }
}
