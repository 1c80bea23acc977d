//! CSV: the layout is checked here, the cells are split by the crate csv.
//!
//! The header is read by hand, for names that are there twice, and the cells of each row are counted before any is taken, so that
//! every row of another length is told at once.

use std::path::Path;

use csv::{ReaderBuilder, StringRecord};

use super::cells::{Cells, Columns, Texts};
use super::{Wanted, header, visible};
use crate::error::{DataError, More, Problems};

/// The wanted columns; what is wrong with the header or with rows goes to `problems`, and the rest is read.
pub(super) fn read(
    path: &Path,
    bytes: Vec<u8>,
    first_row: usize,
    wanted: &Wanted,
    problems: &mut Vec<DataError>,
) -> Result<Columns, DataError> {
    let text = text(path, bytes, wanted.separator)?;
    if text.is_empty() {
        return Err(DataError::EmptyFile { path: path.to_path_buf() });
    }
    let (names, body) = text.split_once('\n').unwrap_or((&text, ""));
    let names = cells(names, wanted.separator as char);
    separator_fits(path, &names, wanted)?;
    let mut found = header::check(path, &names, wanted);
    let present = header::present(&names, wanted);
    let without = wanted.time.as_ref().filter(|time| time.unit.is_none() && present.contains(&time.column.as_str()));
    found.extend(without.map(|time| DataError::TimeWithoutUnit { path: path.into(), column: time.column.clone() }));
    if body.is_empty() {
        found.push(DataError::NoRows { path: path.to_path_buf() });
    } else {
        found.extend(count_cells(path, body, first_row, &names, wanted.separator));
    }
    let readable = !found.iter().any(|p| matches!(p, DataError::RaggedRow { .. } | DataError::BadText { .. }));
    if present.is_empty() || body.is_empty() || !readable {
        Problems(std::mem::take(&mut found)).into_result()?;
    }
    problems.extend(found);
    let parsed = parse(body, &names, &present, wanted.separator);
    parsed.map_err(|e| DataError::Damaged { path: path.to_path_buf(), reason: e.to_string() })
}

/// How files begin that are something else, what they are, and what to do.
const OTHER_FORMATS: &[(&[u8], &str, &str)] = &[
    (&[0xff, 0xfe], "the text is UTF-16", "save the file as CSV in UTF-8"),
    (&[0xfe, 0xff], "the text is UTF-16", "save the file as CSV in UTF-8"),
    (b"PK\x03\x04", "this is a spreadsheet or another ZIP archive", "save the table as CSV in UTF-8"),
    (&[0x1f, 0x8b], "the file is compressed with gzip", "decompress it"),
    (&[0x28, 0xb5, 0x2f, 0xfd], "the file is compressed with zstd", "decompress it"),
    (b"PAR1", "this is a Parquet file", "let its name end in .parquet"),
    (b"version https://git-lfs", "this is a pointer of Git LFS", "fetch the file itself: git lfs pull"),
    (b"<!DOCTYPE", "this is a web page", "download the table itself"),
    (b"<html", "this is a web page", "download the table itself"),
];

/// Actual format of a file that is no text table, and a remedy.
pub(super) fn other_format(bytes: &[u8]) -> Option<(&'static str, &'static str)> {
    OTHER_FORMATS.iter().find(|(start, _, _)| bytes.starts_with(start)).map(|(_, what, remedy)| (*what, *remedy))
}

/// UTF-8 without byte-order mark, with `\n` at line ends and none at the end of the file.
fn text(path: &Path, bytes: Vec<u8>, separator: u8) -> Result<String, DataError> {
    let bad = |row, what: String, remedy| Err(DataError::BadText { path: path.to_path_buf(), row, what, remedy });
    if let Some((what, remedy)) = other_format(&bytes) {
        return bad(1, what.to_string(), remedy);
    }
    let text = match String::from_utf8(bytes) {
        Ok(text) => text,
        Err(e) => {
            let (row, column) = place(&e.as_bytes()[..e.utf8_error().valid_up_to()], separator);
            return bad(row, format!("the text is not UTF-8{column}"), "save the file as CSV in UTF-8");
        }
    };
    if let Some(at) = text.find('\0') {
        let (row, column) = place(&text.as_bytes()[..at], separator);
        return bad(row, format!("there is a zero byte in the text{column}"), "the file is damaged: copy it again");
    }
    let trimmed = text.strip_prefix('\u{feff}').unwrap_or(&text).trim_end_matches(['\n', '\r']);
    match trimmed.contains('\r') {
        true => Ok(trimmed.replace("\r\n", "\n").replace('\r', "\n")),
        false if trimmed.len() == text.len() => Ok(text),
        false => Ok(trimmed.to_string()),
    }
}

/// The row in which `before` ends, and ` in column …` where its header names one.
fn place(before: &[u8], separator: u8) -> (usize, String) {
    let line = before.rsplit(|b| *b == b'\n').next().unwrap_or_default();
    let row = 1 + before.iter().filter(|b| **b == b'\n').count();
    let header = before.split(|b| *b == b'\n').next().filter(|_| row > 1).unwrap_or_default();
    let names = cells(&String::from_utf8_lossy(header), separator as char);
    let index = line.iter().filter(|b| **b == separator).count();
    let name = names.get(index).filter(|name| !name.is_empty());
    (row, name.map_or(String::new(), |name| format!(" in column `{}`", visible(name))))
}

/// The names in a header: quotes and surrounding blanks removed.
fn cells(header: &str, separator: char) -> Vec<String> {
    let mut cells = vec![String::new()];
    let mut quoted = false;
    for c in header.chars() {
        match c {
            '"' => quoted = !quoted,
            c if c == separator && !quoted => cells.push(String::new()),
            c => cells.last_mut().into_iter().for_each(|cell| cell.push(c)),
        }
    }
    cells.iter().map(|cell| cell.trim().to_string()).collect()
}

/// One column whose name contains another separator is a file with that separator.
fn separator_fits(path: &Path, header: &[String], wanted: &Wanted) -> Result<(), DataError> {
    if header.len() > 1 || wanted.columns().iter().any(|c| *c == header[0]) {
        return Ok(());
    }
    let Some(other) = [',', ';', '\t', '|'].into_iter().find(|s| header[0].contains(*s)) else { return Ok(()) };
    let what = format!("the cells are separated by {other:?} and not by {:?}", wanted.separator as char);
    let remedy = "set `separator` in [table] or [[source]] of the manifest";
    Err(DataError::BadText { path: path.to_path_buf(), row: 1, what, remedy })
}

/// Rows with too few or too many cells, one problem for each number of cells.
fn count_cells(path: &Path, body: &str, first_row: usize, header: &[String], separator: u8) -> Vec<DataError> {
    let (mut problems, expected) = (Vec::<(usize, DataError)>::new(), header.len());
    let mut ragged = |row, found: usize| {
        if found == expected {
            return;
        }
        if let Some((_, first)) = problems.iter_mut().find(|(count, _)| *count == found) {
            return first.more().into_iter().for_each(|more| more.add(row));
        }
        let what = match header.get(found) {
            Some(first) => format!("none for column `{}`", visible(first)),
            None => format!("so cell {} has no column", expected + 1),
        };
        let (path, more) = (path.to_path_buf(), More::default());
        problems.push((found, DataError::RaggedRow { path, row, expected, found, what, more }));
    };
    // a line end within quotes does not end the row, as in a spreadsheet
    let (mut row, mut found, mut quoted, mut empty, mut opened) = (first_row, 1, false, true, (first_row, 1));
    for byte in body.bytes() {
        match byte {
            b'"' => {
                quoted = !quoted;
                opened = (row, found);
                empty = false;
            }
            b'\n' if !quoted => {
                ragged(row, if empty { 0 } else { found });
                (row, found, empty) = (row + 1, 1, true);
            }
            b'\n' => {}
            byte if byte == separator && !quoted => {
                found += 1;
                empty = false;
            }
            _ => empty = false,
        }
    }
    if !quoted {
        ragged(row, if empty { 0 } else { found });
    } else {
        let (row, cell) = opened;
        let column = header.get(cell - 1).map_or(String::new(), |name| format!(" in column `{}`", visible(name)));
        let what = format!("a quotation mark is opened{column} and never closed");
        let open = DataError::BadText { path: path.to_path_buf(), row, what, remedy: "close or delete it" };
        problems.push((usize::MAX, open));
    }
    problems.into_iter().map(|(_, problem)| problem).collect()
}

/// All wanted columns as text: numbers are parsed afterwards, where a bad one can still be shown as it was written.
fn parse(body: &str, header: &[String], wanted: &[&str], separator: u8) -> Result<Columns, csv::Error> {
    let place = |name: &&str| header.iter().position(|column| column == name);
    let mut texts: Vec<(usize, Texts)> = wanted.iter().filter_map(place).map(|at| (at, Texts::default())).collect();
    let mut reader =
        ReaderBuilder::new().has_headers(false).flexible(true).delimiter(separator).from_reader(body.as_bytes());
    let (mut row, mut rows) = (StringRecord::new(), 0);
    while reader.read_record(&mut row)? {
        texts.iter_mut().for_each(|(at, texts)| texts.push(row.get(*at).unwrap_or_default()));
        rows += 1;
    }
    let cells = texts.into_iter().map(|(at, texts)| (header[at].clone(), Cells::Text(texts))).collect();
    Ok(Columns { rows, cells })
}
