//! The lines of a text file, one after the other, and their cells.

use std::fs::File;
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};

use crate::error::DataError;

/// A longer line is none of a table.
const LINE_LIMIT: usize = 1 << 24;

/// A text file that is read line by line.
pub(super) struct Lines {
    pub path: PathBuf,
    reader: BufReader<File>,
    line: Vec<u8>,
    /// Number of the line that was read last, from 1.
    pub row: usize,
}

impl Lines {
    pub fn open(path: &Path) -> Result<Self, DataError> {
        let file = File::open(path).map_err(|e| DataError::file_system("read", path, &e))?;
        let reader = BufReader::with_capacity(1 << 18, file);
        Ok(Self { path: path.to_path_buf(), reader, line: Vec::new(), row: 0 })
    }

    /// The next line without its end; `None` after the last.
    pub fn next(&mut self) -> Result<Option<&[u8]>, DataError> {
        self.line.clear();
        let mut limited = std::io::Read::take(&mut self.reader, LINE_LIMIT as u64 + 1);
        let read = limited.read_until(b'\n', &mut self.line);
        if read.map_err(|e| DataError::file_system("read", &self.path, &e))? == 0 {
            return Ok(None);
        }
        self.row += 1;
        if self.line.len() > LINE_LIMIT {
            let what = format!("the line is longer than {LINE_LIMIT} bytes");
            return Err(super::no_such(&self.path, self.row, what, "this is no table: check the file"));
        }
        while matches!(self.line.last(), Some(b'\n' | b'\r')) {
            self.line.pop();
        }
        let start = if self.row == 1 && self.line.starts_with(b"\xef\xbb\xbf") { 3 } else { 0 };
        Ok(Some(&self.line[start..]))
    }

    /// The names in the next line; `None` after the last.
    pub fn names(&mut self, separator: u8) -> Result<Option<Vec<String>>, DataError> {
        Ok(self.next()?.map(|line| names(line, separator)))
    }
}

/// The cells of a header: quotes and surrounding blanks removed.
pub(super) fn names(line: &[u8], separator: u8) -> Vec<String> {
    let (mut cells, mut quoted) = (vec![String::new()], false);
    for c in String::from_utf8_lossy(line).chars() {
        match c {
            '"' => quoted = !quoted,
            c if c == separator as char && !quoted => cells.push(String::new()),
            c if c.is_control() => {}
            c => cells.last_mut().into_iter().for_each(|cell| cell.push(c)),
        }
    }
    cells.iter().map(|cell| cell.trim().to_string()).collect()
}

/// The last cell that is not empty, and those before it.
pub(super) fn without_empty_end(mut cells: Vec<String>) -> Vec<String> {
    while cells.last().is_some_and(String::is_empty) {
        cells.pop();
    }
    cells
}
