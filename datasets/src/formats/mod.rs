//! Recordings in foreign formats, motion capture and flight logs, as named columns with units and times.
//!
//! ```text
//! file → Take { groups: [ Group { time, columns } ] }      one group for everything that is sampled at the same instants
//! ```
//!
//! | format | groups | times |
//! | --- | --- | --- |
//! | `motive` | one | frame ÷ rate |
//! | `vicon` | one a section | frame ÷ rate |
//! | `trc` | one | frame ÷ rate |
//! | `ulog` | one a topic and instance | `timestamp`, µs since boot |
//! | `mcap` | one a topic | `header.stamp`, or when it was recorded; with the feature `mcap` |
//!
//! Values stay in the file's unit, and NaN is an empty cell. Only the wanted columns are kept, so that the memory
//! is theirs and not the file's.

#[cfg(feature = "mcap")]
mod mcap;
mod motive;
mod numbers;
mod recognise;
mod trc;
mod ulog;
mod vicon;

use std::collections::BTreeSet;
use std::path::Path;

pub use recognise::{Format, recognise};

use crate::error::DataError;

/// Values that are held of one file: 2 GB of them.
pub const VALUE_LIMIT: usize = 1 << 28;

/// Contents of one file.
#[derive(Debug, Clone, PartialEq)]
pub struct Take {
    /// Format of the file.
    pub format: Format,
    /// Groups of columns that are sampled together.
    pub groups: Vec<Group>,
    /// Recognized properties, one sentence each.
    pub notes: Vec<String>,
    /// Lost parts of a damaged file, one sentence each.
    pub lost: Vec<String>,
}

/// Columns with the same instants.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Group {
    /// Topic or section; empty where a file has one group.
    pub name: String,
    /// How many samples the file has.
    pub samples: usize,
    /// First and last time, s.
    pub span: (f64, f64),
    /// Samples per second as the file declares them, Hz.
    pub rate: Option<f64>,
    /// Time of each sample, s; empty where no column is kept.
    pub time: Vec<f64>,
    /// Recorded columns.
    pub columns: Vec<Column>,
    /// Row of the first sample in the file, from 1; records of a log are counted alike.
    pub first_row: usize,
}

/// One column of numbers.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Column {
    /// Name, unique in the file.
    pub name: String,
    /// Unit, where the file says it.
    pub unit: Option<&'static str>,
    /// Values in that unit, NaN for an empty cell; empty where the column is not kept.
    pub values: Vec<f64>,
}

/// Which columns are kept.
#[derive(Debug, Clone, Copy)]
pub enum Keep<'a> {
    /// All of them.
    All,
    /// None: names, counts and times alone.
    Nothing,
    /// Those with these names.
    Named(&'a BTreeSet<String>),
}

impl Keep<'_> {
    /// Whether a column is kept.
    pub fn keeps(&self, column: &str) -> bool {
        match self {
            Keep::All => true,
            Keep::Nothing => false,
            Keep::Named(names) => names.contains(column),
        }
    }
}

impl Take {
    /// A take without samples.
    pub(crate) fn new(format: Format) -> Self {
        Self { format, groups: Vec::new(), notes: Vec::new(), lost: Vec::new() }
    }

    /// A column and the group that it belongs to.
    pub fn column(&self, name: &str) -> Option<(&Group, &Column)> {
        self.groups.iter().find_map(|group| Some((group, group.columns.iter().find(|c| c.name == name)?)))
    }
}

/// Reads a file of a format; a format of tables is none of these.
///
/// # Errors
/// The file system; a file that is none of its format; a cell that is no number, with row, column and value; more than
/// [`VALUE_LIMIT`] values.
pub fn read(path: &Path, format: Format, keep: Keep) -> Result<Take, DataError> {
    match format {
        Format::Motive => motive::read(path, keep),
        Format::Vicon => vicon::read(path, keep),
        Format::Trc => trc::read(path, keep),
        Format::Ulog => ulog::read(path, keep),
        #[cfg(feature = "mcap")]
        Format::Mcap => mcap::read(path, keep),
        #[cfg(not(feature = "mcap"))]
        Format::Mcap => {
            let remedy = "build it with `--features mcap`, or convert the recording to CSV";
            Err(DataError::Usage(format!("{}: this program was built without MCAP; {remedy}", path.display())))
        }
        Format::Csv | Format::Parquet => {
            let message = format!("{}: a table is read by its manifest; name its time in [[source]]", path.display());
            Err(DataError::Usage(message))
        }
    }
}

/// A file of this format that cannot be one.
pub(crate) fn no_such(path: &Path, row: usize, what: impl Into<String>, remedy: &'static str) -> DataError {
    DataError::BadText { path: path.to_path_buf(), row, what: what.into(), remedy }
}

/// Doubled names are numbered: `X`, `X (2)`.
pub(crate) fn unique(columns: &mut [Column]) {
    let mut seen = std::collections::BTreeMap::<String, usize>::new();
    for column in columns {
        let count = seen.entry(column.name.clone()).or_insert(0);
        *count += 1;
        if *count > 1 {
            column.name = format!("{} ({count})", column.name);
        }
    }
}

/// Refuses what is past [`VALUE_LIMIT`].
pub(crate) fn check_size(path: &Path, values: usize) -> Result<(), DataError> {
    if values <= VALUE_LIMIT {
        return Ok(());
    }
    let (path, bytes, limit) = (path.to_path_buf(), 8 * values as u64, 8 * VALUE_LIMIT as u64);
    Err(DataError::TooLarge { path, bytes, limit, remedy: "ask for fewer of its columns, or split the recording" })
}
