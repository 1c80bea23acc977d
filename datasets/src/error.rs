//! Errors of a data set, each with a remedy.
//!
//! Each message names the file, the row, the column and the value, and ends with a remedy. Rows are numbered as a
//! spreadsheet numbers them: in a CSV file the header is row 1; a Parquet file has no header, and its first row is 1.
//!
//! | exit code | what is wrong |
//! | --- | --- |
//! | 2 | usage, a manifest or another configuration file |
//! | 3 | the data |
//! | 4 | the file system: permission, a full disk |
//! | 5 | another process writes there |

use std::fmt;
use std::path::{Path, PathBuf};

pub use crate::text::rows::More;
use crate::toml_file::TomlError;
use crate::units::Unit;

/// One problem of a data set, or all of them.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[allow(missing_docs)] // the messages say what the fields are
pub enum DataError {
    /// A configuration file, with line and column.
    #[error(transparent)]
    Toml(#[from] Box<TomlError>),

    #[error("{0}")]
    Usage(String),

    #[error("cannot {action} {path}: {reason}; {remedy}")]
    FileSystem { action: &'static str, path: PathBuf, reason: String, remedy: &'static str },

    #[error("trial `{trial}`: the model {what}; {remedy}")]
    Model { trial: String, what: String, remedy: &'static str },

    #[error("{folder} is in use by {holder}; wait until it ends, or name another folder with --out DIR")]
    InUse { folder: PathBuf, holder: String },

    #[error("no data for `{name}`; looked in\n{places}{obtain}")]
    MissingData { name: String, places: String, obtain: String },

    #[error("{folder}: the pattern {pattern:?} matches no file; correct `files` in [table], or put the files there")]
    PatternWithoutFile { folder: PathBuf, pattern: String },

    #[error("{path}: the file name ends in neither .csv nor .parquet; convert the file, or narrow `files` in [table]")]
    UnknownExtension { path: PathBuf },

    #[error(
        "{path} leads to {target}, outside of the data folder {folder}; copy the file there, or name its own folder with \
         --data DIR"
    )]
    LeavesFolder { path: PathBuf, target: PathBuf, folder: PathBuf },

    #[error("{folder}: the name of the file `{name}` has control characters; rename the file")]
    ControlInName { folder: PathBuf, name: String },

    #[error("{path}: {bytes} bytes are past the limit of {limit} bytes; {remedy}")]
    TooLarge { path: PathBuf, bytes: u64, limit: u64, remedy: &'static str },

    #[error(
        "{path}: the file is compressed with {how}, and compressed tables are not read; decompress it, or narrow `files` \
         in [table]"
    )]
    Packed { path: PathBuf, how: &'static str },

    #[error("{path}: the file is empty; copy it again from where it was recorded, or delete it")]
    EmptyFile { path: PathBuf },

    #[error("{path}: the file has no rows below its header; delete it, or record it again")]
    NoRows { path: PathBuf },

    #[error("{path}, row {row}: {what}; {remedy}")]
    BadText { path: PathBuf, row: usize, what: String, remedy: &'static str },

    #[error("{path}, row {row}: {found} cells under {expected} columns, {what}{more}; complete the row or delete it")]
    RaggedRow { path: PathBuf, row: usize, expected: usize, found: usize, what: String, more: More },

    #[error("{path}: {reason}; the file is truncated or damaged: copy it again from where it was recorded")]
    Damaged { path: PathBuf, reason: String },

    #[error(
        "{path}: the file of {bytes} bytes claims {rows} rows or more, which is no recording; copy it again from where \
         it was recorded"
    )]
    Bomb { path: PathBuf, rows: u64, bytes: u64 },

    #[error(
        "{path}, column `{column}`: it is compressed with {codec}, which cannot be read here; write the file with zstd, \
         snappy, gzip, lz4, brotli or without compression"
    )]
    Codec { path: PathBuf, column: String, codec: &'static str },

    #[error(
        "{path}: column `{column}` is missing; the file has {known}: correct the name where it is asked for (the \
         manifest, or an experiment on sequences), or in the header"
    )]
    MissingColumn { path: PathBuf, column: String, known: String },

    #[error("{path}: column `{column}` is there {count} times; rename or delete the others")]
    DoubledColumn { path: PathBuf, column: String, count: usize },

    #[error("{path}, column `{column}`: values of type {kind} {what}; {remedy}")]
    WrongType { path: PathBuf, column: String, kind: String, what: &'static str, remedy: &'static str },

    #[error(
        "{path}, column `{column}`: its values are plain numbers, and `time` in [table] has no unit; add unit = \"s\" (or \
         ms, us, ns, or sample with rate_hz)"
    )]
    TimeWithoutUnit { path: PathBuf, column: String },

    #[error("{path}, row {row}, column `{column}`: {value:?} is not a number{what}{more}; {remedy}")]
    NotANumber {
        path: PathBuf,
        row: usize,
        column: String,
        value: String,
        what: &'static str,
        remedy: &'static str,
        more: More,
    },

    #[error(
        "{path}, row {row}, column `{column}`: {value} is not finite{more}; correct the cell or delete the row (a lost \
         marker is an empty cell)"
    )]
    NotFinite { path: PathBuf, row: usize, column: String, value: String, more: More },

    #[error(
        "{path}, row {row}, column `{column}`: {value:e} is beyond ±1e30, which no unit needs{more}; correct the cell or \
         delete the row"
    )]
    TooFar { path: PathBuf, row: usize, column: String, value: f64, more: More },

    #[error(
        "{path}, row {row}, column `{column}`: {what}{more}; only measured and vehicle cells may be empty (a \
         lost marker): fill it or delete the row; for a signal that is sampled more slowly write fill = \"previous\" or \
         \"linear\" below its `unit`"
    )]
    EmptyCell { path: PathBuf, row: usize, column: String, what: String, more: More },

    #[error("{path}, row {row}, column `{column}`: time goes back from {before} s to {after} s{more}; {remedy}")]
    TimeReversed { path: PathBuf, row: usize, column: String, before: f64, after: f64, more: More, remedy: String },

    #[error(
        "{path}, row {row}, column `{column}`: time stands still, duplicate time stamp {at} s{more}; delete one of the two \
         rows or correct the time stamp"
    )]
    TimeStill { path: PathBuf, row: usize, column: String, at: f64, more: More },

    #[error(
        "{path}, row {row}, column `{column}`: the row repeats row {first} (time {at} s and all values){more}; delete one \
         of them"
    )]
    DuplicateRow { path: PathBuf, row: usize, column: String, first: usize, at: f64, more: More },

    #[error("trial `{trial}` lies in {first} and in {second}; join the files, or give the trials different names")]
    TrialInTwoFiles { trial: String, first: PathBuf, second: PathBuf },

    #[error(
        "{path}, column `{column}`: {single} of the {trials} trials that it names have one sample, and a trial needs two; rows \
         that are poses belong into one trial: leave `trial` out of [table], or give all rows of a recording one name, and \
         name the trial in [roles] (without a clock, number the poses: time = {{ rate_hz = 10.0 }})"
    )]
    TrialOfEachRow { path: PathBuf, column: String, single: usize, trials: usize },

    #[error(
        "{path}: the file name does not match the pattern {pattern:?} that gives the trial's name; correct `trial` in \
         [table] or rename the file"
    )]
    UnnamedTrial { path: PathBuf, pattern: String },

    #[error(
        "{manifest}: trial `{trial}` ({file}) has no role; add it to calibration, development, held_out or excluded \
         in [roles]"
    )]
    TrialWithoutRole { manifest: PathBuf, trial: String, file: PathBuf },

    #[error(
        "{at}: {section} names trial `{trial}`, which the data do not have; the trials are {known}: correct the \
         name or delete it"
    )]
    UnknownTrial { at: String, section: &'static str, trial: String, known: String },

    #[error(
        "{at}: trial `{trial}` has {samples} samples {part}; move `until` (the trial runs from {from} s to {to} s)"
    )]
    EmptyPart { at: String, trial: String, samples: usize, part: &'static str, from: f64, to: f64 },

    #[error("{at}: {what}; {remedy}")]
    BadFold { at: String, what: String, remedy: &'static str },

    #[error(
        "{file}: trial `{trial}` has {samples} samples in one stretch{gap}, fewer than {needed}{why}; exclude it in \
         [roles], record it longer, or ask for a shorter window"
    )]
    FewSamples { file: PathBuf, trial: String, samples: usize, needed: usize, gap: String, why: &'static str },

    #[error(
        "{path}, row {row}, column `{column}`: {value} is no label; write 0 or 1, or ask for loss = \"mean_square\""
    )]
    NoLabel { path: PathBuf, row: usize, column: String, value: f64 },

    #[error("{path}, row {row}, column `{column}`: an elapsed time of {value} s; write the time since the row before")]
    NegativeElapsed { path: PathBuf, row: usize, column: String, value: f64 },

    #[error(
        "{path}, row {row}: sequence `{name}` goes on after another one; sort the rows so that each sequence stands in \
         one piece"
    )]
    ScatteredSequence { path: PathBuf, row: usize, name: String },

    #[error("{path}, row {row}: sequence `{name}` has {steps} rows, and {needed} are needed; complete it or delete it")]
    ShortSequence { path: PathBuf, row: usize, name: String, steps: usize, needed: usize },

    #[error("{path}, row {row}, column `{column}`: {value:?} is no part; write training, validation or test")]
    NoPart { path: PathBuf, row: usize, column: String, value: String },

    #[error(
        "{path}, row {row}, column `{column}`: sequence `{name}` began in part {before}, and goes on in {value}; give \
         all its rows one part"
    )]
    TwoParts { path: PathBuf, row: usize, column: String, name: String, before: String, value: String },

    #[error("{at}: trial `{trial}`, source `{of}`: {what}")]
    Unjoined { at: String, trial: String, of: String, what: String },

    #[error(
        "{path}, column `{column}`: the file has the unit {written:?}, and the manifest {declared:?}; correct the unit"
    )]
    OtherUnit { path: PathBuf, column: String, written: String, declared: String },

    #[error("{path}: not supported: {what}; {remedy}")]
    Unsupported { path: PathBuf, what: String, remedy: &'static str },

    #[error(
        "{path}, row {row}: the time of source `{of}` jumps to {at} s{more}, and its other rows are from {from} s to {to} s; correct \
         the time stamps, or split the file where the clock was set"
    )]
    SourceJump { path: PathBuf, of: String, row: usize, at: f64, from: f64, to: f64, more: More },

    #[error("{0}")]
    NoHull(String),

    #[error("warning: {0}")]
    Warning(String),

    #[error("{0}")]
    Problems(Problems),
}

/// Characters of one problem in a list, and bytes of a list: who has more to mend, mends these first.
const LONGEST_PROBLEM: usize = 900;
const LONGEST_LIST: usize = 3600;

/// All problems that were found in one data set, in the order of the files.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Problems(pub Vec<DataError>);

impl DataError {
    /// The process's exit code: 2 configuration, 3 data, 4 file system.
    pub fn exit_code(&self) -> u8 {
        match self {
            DataError::Toml(_) | DataError::Usage(_) | DataError::NoHull(_) => 2,
            DataError::FileSystem { .. } => 4,
            DataError::InUse { .. } => 5,
            DataError::Problems(all) => all.0.iter().map(DataError::exit_code).max().unwrap_or(3),
            _ => 3,
        }
    }

    /// A failed operation of the file system, with the remedy that fits it.
    pub fn file_system(action: &'static str, path: impl Into<PathBuf>, reason: &std::io::Error) -> Self {
        use std::io::ErrorKind::{
            AlreadyExists, FileTooLarge, IsADirectory, NotADirectory, NotFound, PermissionDenied, QuotaExceeded,
            ReadOnlyFilesystem, StorageFull,
        };
        let remedy = match reason.kind() {
            NotFound => "check the path",
            PermissionDenied => "check the permissions, or choose another folder",
            StorageFull | QuotaExceeded | FileTooLarge => "make room, or choose another folder",
            ReadOnlyFilesystem => "choose a folder that can be written",
            NotADirectory | IsADirectory | AlreadyExists => "choose another path",
            _ => "check the disk and try again",
        };
        DataError::FileSystem { action, path: path.into(), reason: reason.to_string(), remedy }
    }

    /// A column of a type that is not read.
    pub(crate) fn unread(path: &Path, column: &str, kind: &str) -> Self {
        let (what, remedy) = ("are not numbers", "write the column as 64-bit floats, or names of trials as text");
        DataError::WrongType { path: path.to_path_buf(), column: column.into(), kind: kind.into(), what, remedy }
    }

    /// A file that a decoder does not read: what it does not support is no damage.
    pub(crate) fn undecoded(path: &Path, reason: String, remedy: &'static str) -> Self {
        let (path, lower) = (path.to_path_buf(), reason.to_lowercase());
        match ["not supported", "not yet supported", "unsupported", "not implemented"].iter().any(|w| lower.contains(w))
        {
            true => DataError::Unsupported { path, what: reason, remedy },
            false => DataError::Damaged { path, reason },
        }
    }

    /// A column whose file says another unit than the manifest.
    pub(crate) fn other_unit(path: &Path, column: &str, written: Option<&String>, declared: &str) -> Option<Self> {
        let (a, b) = (Unit::parse(written?).ok()?, Unit::parse(declared).ok()?);
        let same = a.dimension == b.dimension && a.factor() == b.factor();
        let (path, column, written, declared) =
            (path.to_path_buf(), column.to_string(), written?.clone(), declared.to_string());
        (!same).then_some(DataError::OtherUnit { path, column, written, declared })
    }

    /// Where further cells with the same problem are noted, if it can have them.
    pub(crate) fn more(&mut self) -> Option<&mut More> {
        match self {
            DataError::NotANumber { more, .. }
            | DataError::NotFinite { more, .. }
            | DataError::TooFar { more, .. }
            | DataError::EmptyCell { more, .. }
            | DataError::TimeReversed { more, .. }
            | DataError::TimeStill { more, .. }
            | DataError::DuplicateRow { more, .. }
            | DataError::SourceJump { more, .. }
            | DataError::RaggedRow { more, .. } => Some(more),
            _ => None,
        }
    }

    /// The single problems: itself, or the members of a list.
    pub fn problems(self) -> Vec<DataError> {
        match self {
            DataError::Problems(all) => all.0,
            one => vec![one],
        }
    }
}

impl From<TomlError> for DataError {
    fn from(error: TomlError) -> Self {
        DataError::Toml(Box::new(error))
    }
}

impl Problems {
    /// `Ok` where nothing is wrong; a single problem stays itself.
    ///
    /// # Errors
    /// What is wrong.
    pub fn into_result(mut self) -> Result<(), DataError> {
        match self.0.len() {
            0 => Ok(()),
            1 => Err(self.0.remove(0)),
            _ => Err(DataError::Problems(self)),
        }
    }
}

impl fmt::Display for Problems {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{} problems", self.0.len())?;
        let mut written = 0;
        for (i, problem) in self.0.iter().enumerate() {
            let text = short(problem.to_string().trim_end(), LONGEST_PROBLEM).replace('\n', "\n  ");
            written += text.len();
            if i > 0 && written > LONGEST_LIST {
                return writeln!(f, "  and {} more; mend these first", self.0.len() - i);
            }
            writeln!(f, "  {text}")?;
        }
        Ok(())
    }
}

/// A text as it is shown in a message: at most so many characters.
pub(crate) fn short(text: &str, most: usize) -> String {
    match text.char_indices().nth(most) {
        Some((end, _)) => format!("{}…", &text[..end]),
        None => text.to_string(),
    }
}

/// A value as it is shown in a message.
pub(crate) fn shown(value: &str) -> String {
    short(value, 40)
}
