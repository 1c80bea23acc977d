//! What a Parquet file claims to hold, checked before any of it is decoded: a decoder asks for the memory that the footer and
//! the page headers name, and a damaged or a malicious one names 10¹² rows.
//!
//! | claim                                  | must                                                     |
//! | -------------------------------------- | -------------------------------------------------------- |
//! | rows of the groups                     | add up to the rows of the file                           |
//! | values of a column in a group          | be one a row                                             |
//! | bytes of a column, of a page           | lie within the file                                      |
//! | decoded bytes of all wanted columns    | be [`RATIO`] times the file's, or [`ALWAYS`], at most    |
//! | values of the pages                    | add up to those of the column                            |
//!
//! Footer and page headers: the Parquet format's `parquet.thrift`.

use std::io::{Read, Seek, SeekFrom};
use std::path::Path;

use super::thrift::{Value, structure};
use crate::error::DataError;

/// Recordings shrink by a factor of ten; a hundred times that is no recording.
const RATIO: u64 = 1000;

/// As much may be decoded from any file: 64 MiB.
const ALWAYS: u64 = 64 << 20;

/// A footer says a few hundred bytes for each column of each group.
const LARGEST_FOOTER: u64 = 64 << 20;

/// A page header with the smallest and the greatest value of its page.
const LARGEST_HEADER: u64 = 64 << 10;

/// Names of the codecs by their number; those with `true` can be decoded.
const CODECS: &[(&str, bool)] = &[
    ("none", true),
    ("snappy", true),
    ("gzip", true),
    ("lzo", false),
    ("brotli", true),
    ("lz4", true),
    ("zstd", true),
    ("lz4_raw", true),
];

/// A column of a group.
struct Chunk {
    column: String,
    /// Its values stand in lists or structures.
    nested: bool,
    start: u64,
    end: u64,
    values: u64,
}

/// Checks the claims of a file of `length` bytes, whose ends were checked before, about the `wanted` columns.
///
/// # Errors
/// The first claim that cannot be, with the column it is about.
pub(super) fn check(
    path: &Path,
    file: &mut (impl Read + Seek),
    length: u64,
    wanted: &dyn Fn(&str) -> bool,
) -> Result<(), DataError> {
    let damaged = |reason: String| DataError::Damaged { path: path.to_path_buf(), reason };
    let bytes = footer(file, length).ok_or_else(|| damaged("the footer cannot be read".into()))?;
    let (footer, _) = structure(&bytes).ok_or_else(|| damaged("the footer is no footer of a Parquet file".into()))?;
    let mut rows = 0u64;
    let mut decoded = 0u64;
    for (g, group) in footer.list(4).iter().enumerate() {
        let refuse = |reason: String| damaged(format!("row group {g}: {reason}"));
        let of_group = count(group, 3).ok_or_else(|| refuse("it has no number of rows".into()))?;
        rows = rows.saturating_add(of_group);
        for column in group.list(1) {
            let Some(chunk) = chunk(path, column, length, wanted).transpose()? else { continue };
            // a list has as many values as it is long, or one that says that it is empty
            if chunk.values < of_group || (chunk.values > of_group && !chunk.nested) {
                let what = format!("column `{}` has {} values in {of_group} rows", chunk.column, chunk.values);
                return Err(refuse(what));
            }
            // what is kept of a value, beside the bytes of its page
            let kept = chunk.values.saturating_mul(8);
            let limit = ALWAYS.max(length.saturating_mul(RATIO));
            let pages =
                pages(file, &chunk, limit).map_err(|reason| refuse(format!("column `{}`: {reason}", chunk.column)))?;
            decoded = decoded.saturating_add(kept).saturating_add(pages);
            if decoded > limit {
                return Err(DataError::Bomb { path: path.to_path_buf(), rows: rows.max(of_group), bytes: length });
            }
        }
    }
    match count(&footer, 3) {
        Some(claimed) if claimed == rows => Ok(()),
        Some(claimed) => Err(damaged(format!("the footer claims {claimed} rows, and the row groups have {rows}"))),
        None => Err(damaged("the footer has no number of rows".into())),
    }
}

fn footer(file: &mut (impl Read + Seek), length: u64) -> Option<Vec<u8>> {
    let mut size = [0; 4];
    file.seek(SeekFrom::Start(length.checked_sub(8)?)).ok()?;
    file.read_exact(&mut size).ok()?;
    let size = u64::from(u32::from_le_bytes(size));
    if size > LARGEST_FOOTER {
        return None;
    }
    file.seek(SeekFrom::Start(length.checked_sub(8 + size)?)).ok()?;
    let mut bytes = Vec::new();
    file.take(size).read_to_end(&mut bytes).ok()?;
    (bytes.len() as u64 == size).then_some(bytes)
}

/// Wanted columns that have columns of their own, and what they are, by the footer alone; none where it cannot be read.
pub(super) fn nested(
    file: &mut (impl Read + Seek),
    length: u64,
    wanted: &dyn Fn(&str) -> bool,
) -> Vec<(String, &'static str)> {
    let (bytes, mut found, mut next) = (footer(file, length).unwrap_or_default(), Vec::new(), 1);
    let Some((footer, _)) = structure(&bytes) else { return found };
    let elements = footer.list(2);
    while let Some(element) = elements.get(next) {
        let name = element.field(4).and_then(Value::text).unwrap_or_default();
        let nested = element.number(5).is_some_and(|children| children > 0) || element.number(3) == Some(2);
        found.extend((nested && wanted(&name)).then(|| (name, nested_kind(element))));
        next = after(elements, next, 0);
    }
    found
}

/// Kind of a nested column, by the number of its converted type, as pyarrow calls it.
fn nested_kind(element: &Value) -> &'static str {
    match (element.number(3), element.number(6)) {
        (Some(2), _) | (_, Some(3)) => "list",
        (_, Some(1 | 2)) => "map",
        _ => "struct",
    }
}

/// The element behind an element and all that is below it.
fn after(elements: &[Value], at: usize, depth: usize) -> usize {
    let children = elements.get(at).and_then(|element| element.number(5)).unwrap_or(0).max(0);
    let mut next = at + 1;
    for _ in 0..children {
        if depth > 16 || next >= elements.len() {
            return elements.len();
        }
        next = after(elements, next, depth + 1);
    }
    next
}

/// Claims of a group about one column; nothing for a column that is not wanted.
fn chunk(path: &Path, column: &Value, length: u64, wanted: &dyn Fn(&str) -> bool) -> Option<Result<Chunk, DataError>> {
    let damaged = |reason: &str| DataError::Damaged { path: path.to_path_buf(), reason: reason.to_string() };
    if column.field(8).is_some() {
        return Some(Err(encrypted(path)));
    }
    let Some(about) = column.field(3) else { return Some(Err(damaged("a column of the footer says nothing"))) };
    let name: Vec<String> = about.list(3).iter().filter_map(Value::text).collect();
    let (root, nested) = (name.first().cloned().unwrap_or_default(), name.len() > 1);
    if !wanted(&root) {
        return None;
    }
    let column = name.join(".");
    Some(match (about.number(4), count(about, 5), count(about, 7), count(about, 9)) {
        (Some(codec), _, _, _) if !known(codec) => {
            let codec = usize::try_from(codec).ok().and_then(|c| CODECS.get(c)).map_or("an unknown codec", |c| c.0);
            Err(DataError::Codec { path: path.to_path_buf(), column, codec })
        }
        (Some(_), Some(values), Some(size), Some(data)) => {
            let start = count(about, 11).filter(|dictionary| *dictionary > 0).map_or(data, |d| d.min(data));
            let end = start.saturating_add(size);
            match end <= length {
                true => Ok(Chunk { column, nested, start, end, values }),
                false => Err(damaged(&format!("column `{column}` would end at byte {end} of {length}"))),
            }
        }
        _ => Err(damaged(&format!("the footer does not say where column `{column}` stands"))),
    })
}

/// A file, or a column of it, that is encrypted.
pub(super) fn encrypted(path: &Path) -> DataError {
    let (what, remedy) = ("it is encrypted".to_string(), "write it without encryption");
    DataError::Unsupported { path: path.to_path_buf(), what, remedy }
}

fn known(codec: i64) -> bool {
    usize::try_from(codec).ok().and_then(|c| CODECS.get(c)).is_some_and(|(_, known)| *known)
}

/// Walks the headers of a column's pages; how many bytes they are when decompressed.
fn pages(file: &mut (impl Read + Seek), chunk: &Chunk, limit: u64) -> Result<u64, String> {
    let (mut at, mut values, mut decoded) = (chunk.start, 0u64, 0u64);
    while values < chunk.values {
        let room = chunk.end.saturating_sub(at).min(LARGEST_HEADER);
        let mut bytes = Vec::new();
        file.seek(SeekFrom::Start(at)).map_err(|e| e.to_string())?;
        // most headers are short
        file.by_ref().take(room.min(256)).read_to_end(&mut bytes).map_err(|e| e.to_string())?;
        if structure(&bytes).is_none() {
            file.by_ref().take(room.saturating_sub(256)).read_to_end(&mut bytes).map_err(|e| e.to_string())?;
        }
        let (header, taken) = structure(&bytes).ok_or_else(|| format!("the page at byte {at} has no header"))?;
        let page = Page::of(&header).ok_or_else(|| format!("the header of the page at byte {at} is incomplete"))?;
        at = at.saturating_add(taken as u64).saturating_add(page.compressed);
        if at > chunk.end {
            return Err(format!("a page would end at byte {at}, and the column ends at byte {}", chunk.end));
        }
        values = values.saturating_add(page.values);
        decoded = decoded.saturating_add(page.decompressed);
        if decoded > limit {
            return Err(format!("its pages claim {decoded} bytes, in {} bytes of the file", chunk.end - chunk.start));
        }
    }
    match values == chunk.values {
        true => Ok(decoded),
        false => Err(format!("its pages have {values} values, and the footer claims {}", chunk.values)),
    }
}

/// The numbers of a page header.
struct Page {
    decompressed: u64,
    compressed: u64,
    /// None in a dictionary.
    values: u64,
}

impl Page {
    fn of(header: &Value) -> Option<Page> {
        let (decompressed, compressed) = (count(header, 2)?, count(header, 3)?);
        let values = match (header.field(5), header.field(8)) {
            (Some(data), _) => count(data, 1)?,
            (None, Some(data)) => {
                let levels = count(data, 5)?.checked_add(count(data, 6)?)?;
                if levels > compressed || levels > decompressed {
                    return None;
                }
                count(data, 1)?
            }
            (None, None) => 0,
        };
        Some(Page { decompressed, compressed, values })
    }
}

/// A field that counts something, and so is not negative.
fn count(value: &Value, field: i64) -> Option<u64> {
    u64::try_from(value.number(field)?).ok()
}
