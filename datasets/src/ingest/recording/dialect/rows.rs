//! Splitting of text into rows and cells.
//!
//! A line end within quotes ends no row, as in a spreadsheet, so that rows keep their numbers there.

use std::path::Path;

use crate::error::DataError;

/// Rows that the separator is recognised from.
const LOOKED_AT: usize = 200;

/// Separators that are looked for.
const KNOWN: [char; 4] = [',', ';', '\t', '|'];

/// The separator that a first row `sep=;` names, as spreadsheets write it, and the text behind that row.
pub(super) fn named(text: &str) -> (Option<char>, &str) {
    let (first, rest) = text.split_once('\n').unwrap_or((text, ""));
    let named = first.strip_prefix("sep=").map(|named| named.chars().collect::<Vec<char>>());
    match named.as_deref() {
        Some([separator]) if KNOWN.contains(separator) => (Some(*separator), rest),
        _ => (None, text),
    }
}

/// All rows, from the one with number `first`; quotes are taken off.
pub(super) fn split(path: &Path, text: &str, separator: char, first: usize) -> Result<Vec<Vec<String>>, DataError> {
    if text.is_empty() {
        return Ok(Vec::new());
    }
    let (mut rows, mut quoted, mut opened) = (vec![vec![String::new()]], false, first);
    for c in text.chars() {
        let last = rows.len() - 1;
        match c {
            '"' => {
                quoted = !quoted;
                opened = first + last;
            }
            '\n' if !quoted => rows.push(vec![String::new()]),
            c if c == separator && !quoted => rows[last].push(String::new()),
            c => rows[last].last_mut().into_iter().for_each(|cell| cell.push(c)),
        }
    }
    if quoted {
        let what = "a quotation mark is opened and never closed".into();
        return Err(DataError::BadText { path: path.to_path_buf(), row: opened, what, remedy: "close or delete it" });
    }
    Ok(rows)
}

/// A cell as it stands in the one form.
pub(super) fn quoted(cell: &str) -> String {
    if cell.contains([',', '\n']) { format!("\"{cell}\"") } else { cell.to_string() }
}

/// How many cells a line has.
fn count(line: &str, separator: char) -> usize {
    let mut quoted = false;
    let ends = line.chars().filter(|c| {
        quoted ^= *c == '"';
        *c == separator && !quoted
    });
    1 + ends.count()
}

/// The only character that separates the header and as many cells in each row.
pub(super) fn separator(path: &Path, text: &str) -> Result<char, DataError> {
    let lines = lines(text);
    let Some(header) = lines.first() else { return Ok(',') };
    let fits = |separator: &char| {
        let cells = count(header, *separator);
        cells > 1 && lines.iter().all(|line| line.trim().is_empty() || count(line, *separator) == cells)
    };
    let fitting: Vec<char> = KNOWN.into_iter().filter(fits).collect();
    match fitting.as_slice() {
        [one] => Ok(*one),
        [] => Ok(','),
        several => {
            let what = format!("{several:?} each separate as many cells in every row");
            let remedy = "say separator = \",\" or another in its [[source]]";
            Err(DataError::BadText { path: path.to_path_buf(), row: 1, what, remedy })
        }
    }
}

/// The first rows as they are written.
fn lines(text: &str) -> Vec<&str> {
    let mut quoted = false;
    let ends = text.split(|c: char| {
        quoted ^= c == '"';
        c == '\n' && !quoted
    });
    ends.take(LOOKED_AT).collect()
}
