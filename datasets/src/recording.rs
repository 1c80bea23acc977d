//! One data file as columns of numbers, before any meaning is given to them.
//!
//! CSV and Parquet are read by polars into the same [`Recording`]: each wanted column is an `f64` vector in the file's
//! own unit, and NaN stands for an empty cell (a NaN that the file itself contains is a problem, not an empty cell).

mod content;
mod csv;
mod numbers;
mod parquet;

pub(crate) use content::Content;
pub(crate) use parquet::{check_claims, check_ends, guarded};

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use polars_core::prelude::DataFrame;

use crate::error::DataError;
use parquet::ParquetFile;

/// The wanted columns of one file.
#[derive(Debug, Clone)]
pub(crate) struct Recording {
    /// The file.
    pub path: PathBuf,
    /// How many samples.
    pub rows: usize,
    /// The number of the first sample's row, where none was carried over.
    pub first_row: usize,
    /// Row numbers of the first samples, which were carried over from the piece before.
    pub carried: Vec<usize>,
    /// Numbers by column; NaN is an empty cell.
    pub numbers: BTreeMap<String, Vec<f64>>,
    /// The column of trial names.
    pub labels: Option<Vec<String>>,
}

/// What to read from a file.
#[derive(Debug, Clone)]
pub(crate) struct Wanted {
    /// Columns of numbers, and whether a cell may be empty.
    pub numbers: BTreeMap<String, bool>,
    /// Column of trial names.
    pub label: Option<String>,
    /// Separator of CSV cells.
    pub separator: u8,
}

/// An opened data file, which is read piece by piece.
pub(crate) struct DataFile<'a> {
    path: PathBuf,
    wanted: &'a Wanted,
    kind: Kind,
}

enum Kind {
    /// One piece.
    Csv(Vec<u8>),
    /// As many as its groups of rows make.
    Parquet(ParquetFile),
}

impl<'a> DataFile<'a> {
    /// Opens a file; the second is the SHA-256 of all of it, where it is asked for.
    pub fn open(path: &Path, wanted: &'a Wanted, hashed: bool) -> Result<(Self, Option<Vec<u8>>), DataError> {
        let csv = is(path, "csv");
        let content = if csv { Content::held(path)? } else { Content::of(path)? };
        let digest = if hashed { Some(content.digest()) } else { None };
        let digest = digest.transpose().map_err(|e| DataError::file_system("read", path, &e))?;
        Ok((Self { path: path.to_path_buf(), wanted, kind: Kind::of(path, content, wanted)? }, digest))
    }

    /// How many pieces it has.
    pub fn pieces(&self) -> usize {
        match &self.kind {
            Kind::Csv(_) => 1,
            Kind::Parquet(file) => file.pieces.len(),
        }
    }

    /// Reads a piece; what is wrong with it goes to `problems`.
    pub fn read(&self, piece: usize, problems: &mut Vec<DataError>) -> Option<Recording> {
        self.columns(piece, self.wanted, problems)
    }

    /// Names of the trials in a piece, row by row; none where they cannot be read.
    pub fn labels(&self, piece: usize) -> Vec<String> {
        let wanted = Wanted { numbers: BTreeMap::new(), ..self.wanted.clone() };
        self.columns(piece, &wanted, &mut Vec::new()).and_then(|recording| recording.labels).unwrap_or_default()
    }

    fn columns(&self, piece: usize, wanted: &Wanted, problems: &mut Vec<DataError>) -> Option<Recording> {
        let read = match &self.kind {
            Kind::Csv(bytes) => csv::read(&self.path, bytes.clone(), wanted).map(|frame| (frame, 2)),
            Kind::Parquet(file) => {
                let rows = file.pieces[piece].clone();
                file.read(rows.clone(), &wanted.columns()).map(|frame| (frame, 1 + rows.start))
            }
        };
        match read {
            Ok((frame, first_row)) => gather(&self.path, &frame, first_row, wanted, problems),
            Err(error) => {
                problems.extend(error.problems());
                None
            }
        }
    }
}

impl Kind {
    fn of(path: &Path, content: Content, wanted: &Wanted) -> Result<Self, DataError> {
        match content {
            Content::Held(bytes) if is(path, "csv") => Ok(Self::Csv(bytes)),
            content if is(path, "parquet") => ParquetFile::open(path, content, wanted).map(Self::Parquet),
            _ => Err(DataError::UnknownExtension { path: path.to_path_buf() }),
        }
    }
}

fn is(path: &Path, extension: &str) -> bool {
    path.extension().is_some_and(|e| e.eq_ignore_ascii_case(extension))
}

/// Reads all of a file; what is wrong with it goes to `problems`.
pub(crate) fn read(path: &Path, wanted: &Wanted, problems: &mut Vec<DataError>) -> Option<Recording> {
    let mut whole: Option<Recording> = None;
    let opened = DataFile::open(path, wanted, false).map_err(|error| problems.extend(error.problems()));
    let (file, _) = opened.ok()?;
    for piece in 0..file.pieces() {
        let recording = file.read(piece, problems)?;
        whole = Some(match whole {
            Some(before) => before.followed_by(recording),
            None => recording,
        });
    }
    whole
}

impl Recording {
    /// The number of a sample's row in the file.
    pub fn row(&self, sample: usize) -> usize {
        self.carried.get(sample).copied().unwrap_or_else(|| self.first_row + sample - self.carried.len())
    }

    /// These samples and those of the piece after them.
    pub fn followed_by(mut self, next: Recording) -> Recording {
        let read = self.first_row..self.first_row + self.rows - self.carried.len();
        self.carried.extend(read);
        for (name, values) in &mut self.numbers {
            values.extend(next.numbers.get(name).into_iter().flatten());
        }
        if let (Some(labels), Some(more)) = (&mut self.labels, next.labels) {
            labels.extend(more);
        }
        Recording { rows: self.rows + next.rows, first_row: next.first_row, ..self }
    }

    /// Some of the samples, which are then carried over.
    pub fn select(&self, samples: &[usize]) -> Recording {
        let pick = |values: &Vec<f64>| samples.iter().map(|i| values[*i]).collect();
        Recording {
            path: self.path.clone(),
            rows: samples.len(),
            first_row: self.first_row,
            carried: samples.iter().map(|i| self.row(*i)).collect(),
            numbers: self.numbers.iter().map(|(name, values)| (name.clone(), pick(values))).collect(),
            labels: self.labels.as_ref().map(|labels| samples.iter().map(|i| labels[*i].clone()).collect()),
        }
    }
}

fn gather(
    path: &Path,
    frame: &DataFrame,
    first_row: usize,
    wanted: &Wanted,
    problems: &mut Vec<DataError>,
) -> Option<Recording> {
    let before = problems.len();
    if frame.height() == 0 {
        problems.push(DataError::NoRows { path: path.to_path_buf() });
        return None;
    }
    // a decoder that meets damaged bytes can give columns of unequal length
    if let Some(column) = frame.columns().iter().find(|column| column.len() != frame.height()) {
        let reason = format!("column `{}` has {} values in {} rows", column.name(), column.len(), frame.height());
        problems.push(DataError::Damaged { path: path.to_path_buf(), reason });
        return None;
    }
    let mut columns = BTreeMap::new();
    for (name, may_be_empty) in &wanted.numbers {
        let column = numbers::Column { path, name, first_row, may_be_empty: *may_be_empty };
        columns.insert(name.clone(), column.read(frame, problems));
    }
    let labels = wanted.label.as_ref().map(|name| {
        let column = numbers::Column { path, name, first_row, may_be_empty: false };
        column.labels(frame, problems)
    });
    let rows = frame.height();
    (problems.len() == before).then(|| Recording {
        path: path.to_path_buf(),
        rows,
        first_row,
        carried: Vec::new(),
        numbers: columns,
        labels,
    })
}

impl Wanted {
    /// Every column that must be there.
    fn columns(&self) -> Vec<&str> {
        let label = self.label.as_deref().filter(|l| !self.numbers.contains_key(*l));
        self.numbers.keys().map(String::as_str).chain(label).collect()
    }

    /// Columns that are missing or doubled in a header.
    fn check_header(&self, path: &Path, header: &[String]) -> Result<(), DataError> {
        let mut problems = Vec::new();
        for column in self.columns() {
            let (path, column) = (path.to_path_buf(), column.to_string());
            match header.iter().filter(|h| **h == column).count() {
                1 => {}
                0 => problems.push(DataError::MissingColumn {
                    path,
                    known: list(header, &column),
                    column: crate::error::shown(&visible(&column)),
                }),
                count => problems.push(DataError::DoubledColumn { path, column, count }),
            }
        }
        crate::error::Problems(problems).into_result()
    }
}

/// The names of a header, and the one that was meant.
fn list(header: &[String], wanted: &str) -> String {
    let names: Vec<String> =
        header.iter().take(40).map(|h| format!("`{}`", crate::error::shown(&visible(h)))).collect();
    let more = if header.len() > 40 { format!(" and {} more", header.len() - 40) } else { String::new() };
    let alike = |name: &&String| *name != wanted && bare(name) == bare(wanted);
    let meant = header.iter().find(alike).or_else(|| {
        let name = crate::spelling::meant(wanted, header.iter().map(String::as_str))?;
        header.iter().find(|h| *h == name)
    });
    let meant =
        meant.map_or(String::new(), |name| format!(" (did you mean `{}`?)", crate::error::shown(&visible(name))));
    names.join(" ") + &more + &meant
}

/// A name whose letters can all be seen: others are written by their number, as `\u{200b}`.
pub(crate) fn visible(name: &str) -> String {
    name.chars().map(|c| if unseen(c) { c.escape_unicode().to_string() } else { c.to_string() }).collect()
}

/// Letters that take no room, or turn the order of others: controls, joiners, marks, selectors, spaces but the usual one.
fn unseen(c: char) -> bool {
    c.is_control()
        || (c.is_whitespace() && c != ' ')
        || matches!(c, '\u{ad}' | '\u{300}'..='\u{36f}' | '\u{61c}' | '\u{180e}' | '\u{200b}'..='\u{200f}'
            | '\u{202a}'..='\u{202e}' | '\u{2060}'..='\u{206f}' | '\u{fe00}'..='\u{fe0f}' | '\u{feff}'
            | '\u{e0000}'..='\u{e007f}')
}

/// A name as it looks: small letters, without what cannot be seen.
fn bare(name: &str) -> String {
    name.chars().filter(|c| !unseen(*c) && *c != ' ').flat_map(char::to_lowercase).collect()
}
