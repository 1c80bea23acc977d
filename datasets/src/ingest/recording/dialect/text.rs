//! The text of a file: decompressed, and in UTF-8 with `\n` at line ends.

use std::io::Read;
use std::path::Path;

use flate2::read::MultiGzDecoder;

use super::super::csv::other_format;
use crate::error::DataError;

/// A compressed file holds no more than this, so that it cannot fill the memory.
const LIMIT: u64 = 1 << 29;

/// Decompresses and decodes; what was recognised becomes a note.
pub(super) fn decoded(path: &Path, bytes: Vec<u8>, notes: &mut Vec<String>) -> Result<String, DataError> {
    let bytes = if bytes.starts_with(&[0x1f, 0x8b]) {
        notes.push("the file is compressed with gzip".into());
        unpacked(path, &bytes)?
    } else {
        bytes
    };
    if let Some((what, remedy)) = other_format(&bytes).filter(|_| !is_wide(&bytes)) {
        return Err(bad(path, 1, what, remedy));
    }
    let text = match bytes.get(..2) {
        Some([0xff, 0xfe]) => wide(path, &bytes[2..], u16::from_le_bytes, notes)?,
        Some([0xfe, 0xff]) => wide(path, &bytes[2..], u16::from_be_bytes, notes)?,
        _ => String::from_utf8(bytes).map_err(|e| {
            let before = &e.as_bytes()[..e.utf8_error().valid_up_to()];
            let row = 1 + before.iter().filter(|byte| **byte == b'\n').count();
            bad(path, row, "the text is neither UTF-8 nor UTF-16", "save the file as CSV in UTF-8")
        })?,
    };
    if let Some(at) = text.find('\0') {
        let row = 1 + text[..at].matches('\n').count();
        return Err(bad(
            path,
            row,
            "there is a zero byte in the text",
            "the file is damaged: copy it again, or save it as CSV in UTF-8",
        ));
    }
    let text = text.strip_prefix('\u{feff}').unwrap_or(&text).trim_end_matches(['\n', '\r']);
    Ok(text.replace("\r\n", "\n").replace('\r', "\n"))
}

fn is_wide(bytes: &[u8]) -> bool {
    bytes.starts_with(&[0xff, 0xfe]) || bytes.starts_with(&[0xfe, 0xff])
}

fn unpacked(path: &Path, bytes: &[u8]) -> Result<Vec<u8>, DataError> {
    let mut all = Vec::new();
    let read = MultiGzDecoder::new(bytes).take(LIMIT + 1).read_to_end(&mut all);
    let damaged = |reason: String| DataError::Damaged { path: path.to_path_buf(), reason };
    read.map_err(|e| damaged(format!("it cannot be decompressed ({e})")))?;
    if all.len() as u64 > LIMIT {
        let remedy = "split the recording into one file per trial";
        return Err(DataError::TooLarge { path: path.to_path_buf(), bytes: LIMIT + 1, limit: LIMIT, remedy });
    }
    Ok(all)
}

fn wide(path: &Path, bytes: &[u8], of: fn([u8; 2]) -> u16, notes: &mut Vec<String>) -> Result<String, DataError> {
    notes.push("the text is UTF-16".into());
    let units = bytes.chunks_exact(2).map(|pair| of([pair[0], pair[1]]));
    let decoded: Result<String, _> = char::decode_utf16(units).collect();
    decoded.map_err(|_| bad(path, 1, "the text begins as UTF-16 and is not", "save the file as CSV in UTF-8"))
}

fn bad(path: &Path, row: usize, what: &str, remedy: &'static str) -> DataError {
    DataError::BadText { path: path.to_path_buf(), row, what: what.into(), remedy }
}
