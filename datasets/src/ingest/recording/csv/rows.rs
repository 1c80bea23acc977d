//! Rows of a text table, split by the crate `csv`: cells in quotes may hold separators, line ends and doubled quotes (RFC 4180).
//!
//! Rows are numbered as a spreadsheet numbers them: a line end in quotes ends no row, and blank lines count.

use std::borrow::Cow;
use std::io::Cursor;
use std::path::Path;

use csv::{Reader, ReaderBuilder, StringRecord};

use crate::error::DataError;
use crate::ingest::recording::header::visible;

/// Blanks as a separator; several are one.
pub(crate) const BLANKS: char = ' ';

/// One row after the other.
pub(crate) struct Rows<'t> {
    path: &'t Path,
    text: &'t str,
    reader: Reader<Cursor<Cow<'t, [u8]>>>,
    /// Cells of the row that was read last.
    pub record: StringRecord,
    /// Number of the row that was read last.
    pub number: usize,
    /// Number of blank lines before it.
    pub blank: usize,
    /// Whether the next row is this one again.
    pub held: bool,
    /// Number of bytes that are read.
    length: usize,
    /// Cells of the first row, for messages.
    names: Vec<String>,
    /// Whether the text has an odd number of quotation marks, once it was asked.
    odd: Option<bool>,
}

impl<'t> Rows<'t> {
    /// The rows of a text whose first row has the number `first`.
    pub fn new(path: &'t Path, text: &'t str, separator: char, first: usize) -> Self {
        let bytes = match separator {
            BLANKS => Cow::Owned(single_blanks(text).into_bytes()),
            _ => Cow::Borrowed(text.as_bytes()),
        };
        let length = bytes.len();
        let mut builder = ReaderBuilder::new();
        let reader =
            builder.has_headers(false).flexible(true).delimiter(separator as u8).from_reader(Cursor::new(bytes));
        Self {
            path,
            text,
            reader,
            record: StringRecord::new(),
            number: first - 1,
            blank: 0,
            held: false,
            length,
            names: Vec::new(),
            odd: None,
        }
    }

    /// Reads the next row into `record`; false after the last.
    ///
    /// # Errors
    /// A quotation mark that is never closed.
    pub fn next(&mut self) -> Result<bool, DataError> {
        if std::mem::take(&mut self.held) {
            return Ok(true);
        }
        let start = self.reader.position().line();
        let read = self.reader.read_record(&mut self.record);
        let damaged = |e: csv::Error| DataError::Damaged { path: self.path.to_path_buf(), reason: e.to_string() };
        if !read.map_err(damaged)? {
            return Ok(false);
        }
        let within = memchr::memchr_iter(b'\n', self.record.as_slice().as_bytes()).count();
        let lines = (self.reader.position().line() - start) as usize;
        self.blank = lines.saturating_sub(1 + within);
        self.number += 1 + self.blank;
        if self.names.is_empty() {
            self.names = self.record.iter().map(|cell| bare(cell).to_string()).collect();
        }
        let ended = self.reader.position().byte() as usize >= self.length;
        if (within > 0 || ended) && self.is_odd() {
            return Err(self.never_closed());
        }
        Ok(true)
    }

    /// Whether the text has an odd number of quotation marks, and so has the end of it that was read last.
    fn is_odd(&mut self) -> bool {
        let count = |text: &str| memchr::memchr_iter(b'"', text.as_bytes()).count() % 2 == 1;
        let of_record = self.record.as_slice().contains('\n') || self.text.lines().last().is_some_and(count);
        of_record && *self.odd.get_or_insert_with(|| count(self.text))
    }

    fn never_closed(&self) -> DataError {
        let last = self.record.len().saturating_sub(1);
        let opened = self.record.iter().position(|cell| cell.contains('\n')).unwrap_or(last);
        let column = self.names.get(opened).map_or(String::new(), |name| format!(" in column `{}`", visible(name)));
        let (path, row) = (self.path.to_path_buf(), self.number);
        let what = format!("a quotation mark is opened{column} and never closed");
        DataError::BadText { path, row, what, remedy: "close or delete it" }
    }
}

/// A cell without the blanks and quotes around it.
pub(crate) fn bare(cell: &str) -> &str {
    let cell = cell.trim();
    cell.strip_prefix('"').and_then(|cell| cell.strip_suffix('"')).unwrap_or(cell)
}

/// Number of cells up to the last that is not empty.
pub(crate) fn width(cells: &StringRecord) -> usize {
    let filled = cells.iter().enumerate().filter(|(_, cell)| !cell.trim().is_empty());
    filled.last().map_or(0, |(last, _)| last + 1)
}

/// The text with single blanks between cells, and none at the ends of its lines.
fn single_blanks(text: &str) -> String {
    let line = |line: &str| line.split_ascii_whitespace().collect::<Vec<_>>().join(" ");
    text.lines().map(line).collect::<Vec<_>>().join("\n")
}
