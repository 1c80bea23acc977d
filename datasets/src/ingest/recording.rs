//! One data file as columns of numbers, before they are interpreted.
//!
//! CSV and Parquet are read into the same [`Recording`]: each wanted column is an `f64` vector in the file's own unit, and NaN
//! stands for a missing value. Dates and columns of a type of time stay in whole ticks.

mod cells;
mod content;
pub(crate) mod csv;
mod header;
mod numbers;
mod parquet;
mod ticks;
mod written;

pub(crate) use cells::{Cells, Texts};
pub(crate) use content::Content;
pub(crate) use header::visible;
pub(crate) use numbers::{Missing, numbers_of, spelled};
pub(crate) use parquet::{Held, check_claims, check_ends, columns, guarded, schema};
pub(crate) use ticks::{TickType, Ticks};

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use csv::Csv;
use csv::decimal::Decimal;
use parquet::ParquetFile;

use crate::error::DataError;
use crate::formats::{Format, recognise};

/// The wanted columns of one file.
#[derive(Debug, Clone, Default)]
pub(crate) struct Recording {
    /// The file.
    pub path: PathBuf,
    /// How many samples.
    pub rows: usize,
    /// The number of the first sample's row, where none was carried over.
    pub first_row: usize,
    /// Row numbers of the first samples, which were carried over from the piece before.
    pub carried: Vec<usize>,
    /// Numbers by column; NaN is a missing value.
    pub numbers: BTreeMap<String, Vec<f64>>,
    /// Spellings of missing values.
    pub missing: Missing,
    /// Recognised properties.
    pub notes: Vec<String>,
    /// The column of time, where its type is one of time.
    pub ticks: Option<Ticks>,
    /// The column of trial names.
    pub labels: Option<Vec<String>>,
    /// Something is wrong with it: NaN stands for bad cells too, and columns may be missing.
    pub spoiled: bool,
}

/// Columns to read from a file.
#[derive(Debug, Clone, Default)]
pub(crate) struct Wanted {
    /// Columns of numbers, and whether a cell may be empty.
    pub numbers: BTreeMap<String, bool>,
    /// Column of trial names.
    pub label: Option<String>,
    /// Column of time, where the manifest names one.
    pub time: Option<TimeColumn>,
    /// Separator of CSV cells; recognised if it is omitted.
    pub separator: Option<char>,
    /// Decimal separator of CSV, a comma or a point; recognised if it is omitted.
    pub decimal: Option<char>,
}

/// The column of time, as the manifest has it.
#[derive(Debug, Clone)]
pub(crate) struct TimeColumn {
    pub column: String,
    /// As it is written; a column of a type of time needs none.
    pub unit: Option<String>,
    /// It counts samples.
    pub counts: bool,
}

/// An opened data file, which is read piece by piece.
pub(crate) struct DataFile<'a> {
    path: PathBuf,
    wanted: &'a Wanted,
    kind: Kind,
    /// Problems of its columns, until they are taken.
    problems: Vec<DataError>,
    spoiled: bool,
}

enum Kind {
    /// One piece.
    Csv(Csv),
    /// As many as its groups of rows make.
    Parquet(ParquetFile),
}

impl<'a> DataFile<'a> {
    /// Opens a file, of a format if it is known; the second is the SHA-256 of all of it, if requested.
    pub fn open(
        path: &Path,
        format: Option<Format>,
        wanted: &'a Wanted,
        hashed: bool,
    ) -> Result<(Self, Option<Vec<u8>>), DataError> {
        let format = if format.is_none() { recognise(path)? } else { format };
        let content = if format == Some(Format::Csv) { Content::held(path)? } else { Content::of(path)? };
        let digest = if hashed { Some(content.digest()) } else { None };
        let digest = digest.transpose().map_err(|e| DataError::file_system("read", path, &e))?;
        let mut problems = Vec::new();
        let kind = Kind::of(path, format, content, wanted, &mut problems)?;
        let spoiled = !problems.is_empty();
        Ok((Self { path: path.to_path_buf(), wanted, kind, problems, spoiled }, digest))
    }

    /// Takes the problems of its columns.
    pub fn take_problems(&mut self) -> Vec<DataError> {
        std::mem::take(&mut self.problems)
    }

    /// The type of the column of time, where it has one of its own.
    pub fn time_type(&self) -> Option<&TickType> {
        match &self.kind {
            Kind::Csv(_) => None,
            Kind::Parquet(file) => file.time_type(self.wanted),
        }
    }

    /// Recognised properties.
    pub fn notes(&self) -> &[String] {
        match &self.kind {
            Kind::Csv(csv) => &csv.notes,
            Kind::Parquet(_) => &[],
        }
    }

    /// Units by column, if the file says them.
    pub fn units(&self) -> BTreeMap<String, String> {
        match &self.kind {
            Kind::Csv(csv) => csv.units.clone().unwrap_or_default(),
            Kind::Parquet(_) => BTreeMap::new(),
        }
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
        let before = problems.len();
        let mut gathered = Gathered::new(&self.path, self.first_row(piece), wanted);
        let read = match &self.kind {
            Kind::Csv(csv) => csv.read(wanted, problems).map(|columns| {
                let decimal = columns.decimal;
                columns.cells.iter().for_each(|(name, cells)| gathered.take(name, cells, decimal, problems));
                gathered.recording.notes = columns.notes;
                columns.rows
            }),
            Kind::Parquet(file) => file.read(&file.pieces[piece], wanted, &mut |name, cells| {
                gathered.take(name, cells, Decimal::default(), problems);
            }),
        };
        match read {
            Ok(0) => {
                problems.push(DataError::NoRows { path: self.path.clone() });
                None
            }
            Ok(rows) => {
                let spoiled = self.spoiled || problems.len() > before;
                Some(Recording { rows, spoiled, ..gathered.recording })
            }
            Err(error) => {
                problems.extend(error.problems());
                None
            }
        }
    }

    /// The number of a piece's first row.
    fn first_row(&self, piece: usize) -> usize {
        match &self.kind {
            Kind::Csv(csv) => csv.first_row(),
            Kind::Parquet(file) => 1 + file.pieces[piece].rows.start,
        }
    }
}

impl Kind {
    fn of(
        path: &Path,
        format: Option<Format>,
        content: Content,
        wanted: &Wanted,
        problems: &mut Vec<DataError>,
    ) -> Result<Self, DataError> {
        match (format, content) {
            (Some(Format::Csv), Content::Held(bytes)) => Csv::new(path, bytes, wanted).map(Self::Csv),
            (Some(Format::Parquet), content) => ParquetFile::open(path, content, wanted, problems).map(Self::Parquet),
            (Some(other), _) => Err(DataError::Usage(format!(
                "{}: this is a recording of format {name}, and a table is wanted; declare it as [[source]] with format = {name:?}",
                path.display(),
                name = other.name(),
            ))),
            (None, _) => Err(match packed(path) {
                Some(how) => DataError::Packed { path: path.to_path_buf(), how },
                None => DataError::UnknownExtension { path: path.to_path_buf() },
            }),
        }
    }
}

fn is(path: &Path, extension: &str) -> bool {
    path.extension().is_some_and(|e| e.eq_ignore_ascii_case(extension))
}

/// Endings of files that are compressed or packed, and with what.
pub(crate) const PACKED: &[(&str, &str)] = &[
    ("gz", "gzip"),
    ("xz", "xz"),
    ("zst", "zstd"),
    ("bz2", "bzip2"),
    ("lz4", "lz4"),
    ("br", "brotli"),
    ("zip", "zip"),
    ("7z", "7-Zip"),
    ("rar", "RAR"),
];

/// Compression of a file, by its name.
pub(crate) fn packed(path: &Path) -> Option<&'static str> {
    PACKED.iter().find(|(ending, _)| is(path, ending)).map(|(_, how)| *how)
}

/// Reads all of a file; what is wrong with it goes to `problems`, and then there is none.
pub(crate) fn read(path: &Path, wanted: &Wanted, problems: &mut Vec<DataError>) -> Option<Recording> {
    let opened = DataFile::open(path, None, wanted, false).map_err(|error| problems.extend(error.problems()));
    opened.ok()?.0.whole(problems)
}

impl DataFile<'_> {
    /// Reads all of it; what is wrong with it goes to `problems`, and then there is none.
    pub fn whole(mut self, problems: &mut Vec<DataError>) -> Option<Recording> {
        problems.extend(self.take_problems());
        let mut whole: Option<Recording> = None;
        for piece in 0..self.pieces() {
            let recording = self.read(piece, problems)?;
            whole = Some(match whole {
                Some(before) => before.followed_by(recording),
                None => recording,
            });
        }
        whole.filter(|recording| !recording.spoiled)
    }
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
        if let (Some(ticks), Some(more)) = (&mut self.ticks, next.ticks) {
            ticks.values.extend(more.values);
        }
        next.missing.into_iter().for_each(|(cell, count)| *self.missing.entry(cell).or_insert(0) += count);
        let spoiled = self.spoiled || next.spoiled;
        Recording { rows: self.rows + next.rows, first_row: next.first_row, spoiled, ..self }
    }

    /// Recognised properties, and how missing values are spelled.
    pub fn said(&self) -> Vec<String> {
        self.notes.iter().cloned().chain(spelled(&self.missing)).collect()
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
            ticks: self.ticks.as_ref().map(|ticks| ticks.select(samples)),
            labels: self.labels.as_ref().map(|labels| samples.iter().map(|i| labels[*i].clone()).collect()),
            missing: Missing::new(),
            notes: Vec::new(),
            spoiled: self.spoiled,
        }
    }
}

/// A recording whose columns come one after the other, so that no more than one of them is held as cells.
struct Gathered<'a> {
    wanted: &'a Wanted,
    recording: Recording,
}

impl<'a> Gathered<'a> {
    fn new(path: &Path, first_row: usize, wanted: &'a Wanted) -> Self {
        let recording = Recording { path: path.to_path_buf(), first_row, ..Recording::default() };
        Self { wanted, recording }
    }

    /// A column becomes numbers, ticks of time or names of trials, whatever is wanted of it.
    fn take(&mut self, name: &str, cells: &Cells, decimal: Decimal, problems: &mut Vec<DataError>) {
        let (wanted, may_be_empty) = (self.wanted, self.wanted.numbers.get(name).copied());
        let time = wanted.time.as_ref().is_some_and(|time| time.column == name);
        let (path, first_row) = (&self.recording.path, self.recording.first_row);
        let may_be_absent = may_be_empty.unwrap_or(false);
        let row = |i: usize| first_row + i;
        let column = numbers::Column { path, name, row: &row, may_be_empty: may_be_absent, time, decimal };
        if wanted.label.as_deref() == Some(name) {
            self.recording.labels = Some(column.labels(cells, problems));
        }
        match (cells, may_be_empty) {
            (_, None) => {}
            (Cells::Ticks(kind, values), _) => {
                column.check_ticks(values, problems);
                self.recording.ticks = Some(Ticks { kind: kind.clone(), values: values.clone() });
            }
            (cells, _) => {
                let values = column.read(cells, &mut self.recording.missing, problems);
                self.recording.numbers.insert(name.to_string(), values);
            }
        }
    }
}

impl Wanted {
    /// Every column that must be there.
    fn columns(&self) -> Vec<&str> {
        let label = self.label.as_deref().filter(|l| !self.numbers.contains_key(*l));
        self.numbers.keys().map(String::as_str).chain(label).collect()
    }
}
