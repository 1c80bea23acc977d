//! Text of a file: decompressed, in UTF-8, without a byte-order mark, with `\n` at line ends.

use std::io::Read;
use std::path::Path;

use flate2::read::MultiGzDecoder;

use crate::error::DataError;
use crate::ingest::recording::content::Content;
use crate::ingest::recording::header::visible;

/// Largest decompressed size: a small file must not fill the memory.
const LIMIT: u64 = 1 << 29;

/// First bytes of files that are no text, what such a file is, and the remedy.
const OTHER_FORMATS: &[(&[u8], &str, &str)] = &[
    (b"PK\x03\x04", "this is a spreadsheet or another ZIP archive", "save the table as CSV in UTF-8"),
    (&[0x28, 0xb5, 0x2f, 0xfd], "the file is compressed with zstd", "decompress it"),
    (b"PAR1", "this is a Parquet file", "let its name end in .parquet"),
    (b"version https://git-lfs", "this is a pointer of Git LFS", "fetch the file itself: git lfs pull"),
    (b"<!DOCTYPE", "this is a web page", "download the table itself"),
    (b"<html", "this is a web page", "download the table itself"),
];

/// Reads and decodes a file; compression and encoding become notes.
///
/// # Errors
/// The file system; another format; text that is neither UTF-8 nor UTF-16, with its row.
pub(crate) fn read(path: &Path, notes: &mut Vec<String>) -> Result<String, DataError> {
    match Content::held(path)? {
        Content::Held(bytes) => decoded(path, bytes, notes),
        Content::OnDisk(..) => Ok(String::new()),
    }
}

/// As [`read`], of bytes that were read before.
pub(crate) fn decoded(path: &Path, bytes: Vec<u8>, notes: &mut Vec<String>) -> Result<String, DataError> {
    let bytes = match bytes.starts_with(&[0x1f, 0x8b]) {
        true => {
            notes.push("the file is compressed with gzip".into());
            unpacked(path, &bytes)?
        }
        false => bytes,
    };
    if let Some((_, what, remedy)) = OTHER_FORMATS.iter().find(|(start, _, _)| bytes.starts_with(start)) {
        return Err(bad(path, 1, what, remedy));
    }
    let text = match bytes.get(..2) {
        Some([0xff, 0xfe]) => wide(path, &bytes[2..], u16::from_le_bytes, notes)?,
        Some([0xfe, 0xff]) => wide(path, &bytes[2..], u16::from_be_bytes, notes)?,
        _ => narrow(path, bytes)?,
    };
    if let Some(at) = text.find('\0') {
        let before = &text.as_bytes()[..at];
        let what = format!("there is a zero byte in the text{}", column(before));
        return Err(bad(path, row(before), &what, "the file is damaged: copy it again, or save it as UTF-8"));
    }
    let plain = text.strip_prefix('\u{feff}').unwrap_or(&text).trim_end_matches(['\n', '\r']);
    Ok(match plain.contains('\r') {
        true => plain.replace("\r\n", "\n").replace('\r', "\n"),
        false if plain.len() == text.len() => text,
        false => plain.to_string(),
    })
}

fn unpacked(path: &Path, bytes: &[u8]) -> Result<Vec<u8>, DataError> {
    let mut all = Vec::new();
    let read = MultiGzDecoder::new(bytes).take(LIMIT + 1).read_to_end(&mut all);
    let damaged = |reason: String| DataError::Damaged { path: path.to_path_buf(), reason };
    read.map_err(|e| damaged(format!("the gzip data cannot be decompressed ({e})")))?;
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

fn narrow(path: &Path, bytes: Vec<u8>) -> Result<String, DataError> {
    String::from_utf8(bytes).map_err(|e| {
        let before = &e.as_bytes()[..e.utf8_error().valid_up_to()];
        let what = format!("the text is not UTF-8{}, and not UTF-16", column(before));
        bad(path, row(before), &what, "save the file as CSV in UTF-8")
    })
}

fn row(before: &[u8]) -> usize {
    1 + memchr::memchr_iter(b'\n', before).count()
}

/// The column in which `before` ends, by the sign that is most frequent in its first line.
fn column(before: &[u8]) -> String {
    let header = String::from_utf8_lossy(before.split(|byte| *byte == b'\n').next().unwrap_or_default()).into_owned();
    let sign = [',', ';', '\t', '|']
        .into_iter()
        .max_by_key(|sign| (header.matches(*sign).count(), *sign == ','))
        .unwrap_or(',');
    let last = before.rsplit(|byte| *byte == b'\n').next().unwrap_or_default();
    let index = memchr::memchr_iter(sign as u8, last).count();
    let name = header.split(sign).nth(index).map(|name| name.trim().trim_matches('"')).filter(|name| !name.is_empty());
    name.filter(|_| row(before) > 1).map_or(String::new(), |name| format!(" in column `{}`", visible(name)))
}

fn bad(path: &Path, row: usize, what: &str, remedy: &'static str) -> DataError {
    DataError::BadText { path: path.to_path_buf(), row, what: what.into(), remedy }
}
