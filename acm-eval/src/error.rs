//! Errors between run folders and a page, each with a remedy.

use std::path::{Path, PathBuf};

use acm_datasets::DataError;
use acm_train::{
    TrainError, config::ConfigError, learn::LearnError, run::RunError, schedule::ScheduleError, store::StoreError,
};
use thiserror::Error;

/// A report that could not be made.
#[derive(Debug, Error)]
pub enum EvalError {
    /// The path given on the command line is not there.
    #[error(
        "{path}: there is no such folder; give a run folder, such as runs/cfc, \
         which `acm-train --config experiments/cfc.toml` makes"
    )]
    NoFolder {
        /// Path as given.
        path: PathBuf,
    },
    /// The path is there, but no run ever wrote to it.
    #[error(
        "{path} is not a run folder: it has no {missing}; give a folder that acm-train wrote, such as runs/cfc, \
         not the folder around it"
    )]
    NotARun {
        /// Path as given.
        path: PathBuf,
        /// Missing part of the run folder.
        missing: &'static str,
    },
    /// The run has begun, and no network is trained yet.
    #[error("{path} has no finished record yet; wait for acm-train, or continue it with `acm-train --resume`")]
    NoRecords {
        /// Path as given.
        path: PathBuf,
    },
    /// A study whose runs are not all there.
    #[error("{folder}: the study is not finished, {run} has no records; continue it with `acm-train --resume`")]
    Unfinished {
        /// The study, as given.
        folder: PathBuf,
        /// The first run folder without records.
        run: PathBuf,
    },
    /// A folder that is given twice.
    #[error("{path} is given twice; name each run once")]
    Twice {
        /// Path as given the second time.
        path: PathBuf,
    },
    /// A record that cannot be read.
    #[error("{file}:{line}:{column}: {reason}; the record is damaged: delete it and run `acm-train --resume`")]
    Json {
        /// Path of the record.
        file: PathBuf,
        /// Line, from 1.
        line: usize,
        /// Column, from 1.
        column: usize,
        /// Message of the parser.
        reason: String,
    },
    /// A record of another version of the format.
    #[error("{file}: record of format {found}, and this program reads format {known}; {remedy}")]
    Format {
        /// Path of the record.
        file: PathBuf,
        /// Version of the record.
        found: u64,
        /// Version that this program knows.
        known: u32,
        /// Advice to the user.
        remedy: &'static str,
    },
    /// A record is incomplete or contradictory.
    #[error("{file}: {reason}; the record is damaged: delete it and run `acm-train --resume`")]
    Record {
        /// Path of the record.
        file: PathBuf,
        /// Description of the fault.
        reason: String,
    },
    /// A record without its table.
    #[error(
        "{path}: the prediction table is missing; bring it back, or delete its record and run `acm-train --resume`"
    )]
    MissingPredictions {
        /// Expected path.
        path: PathBuf,
    },
    /// A table that cannot be read, or does not belong to its record.
    #[error("{path}: {reason}; delete the table and its record, and run `acm-train --resume`")]
    Predictions {
        /// Path of the table.
        path: PathBuf,
        /// Description of the fault.
        reason: String,
    },
    /// A table that the file system keeps back.
    #[error(transparent)]
    Table(DataError),
    /// A data set that can be read, but not used.
    #[error("{0}")]
    Data(String),
    /// The request is impossible.
    #[error("{0}")]
    Usage(String),
    /// A folder for results that holds something else.
    #[error("{folder} is no folder of {made}: {what}; give this one a folder of its own with `--out DIR`")]
    NotOwned {
        /// Folder as requested.
        folder: PathBuf,
        /// Expected contents of the folder.
        made: &'static str,
        /// Actual contents.
        what: String,
    },
    /// Another process works in the folder.
    #[error("{folder} is in use by {holder}; wait until it ends, or choose another folder with `--out DIR`")]
    InUse {
        /// Folder as requested.
        folder: PathBuf,
        /// Holder of the lock: `process 4711 on lab3 since …`.
        holder: String,
    },
    /// The user pressed Ctrl-C while networks were trained.
    #[error(
        "stopped; {finished} of {planned} runs in {folder} are finished and the rest are checkpointed; the same command \
         continues"
    )]
    Stopped {
        /// The run folder.
        folder: PathBuf,
        /// Runs with a record.
        finished: usize,
        /// Runs that the experiment asks for.
        planned: usize,
    },
    /// A configuration, a data set or a training that was refused.
    #[error(transparent)]
    Train(#[from] TrainError),
    /// Records of one folder contradict each other.
    #[error("{path}: {reason}; run folders must not be mixed: train again with another `--out`")]
    Mixed {
        /// The run folder.
        path: PathBuf,
        /// Description of the difference.
        reason: String,
    },
    /// Errors of two runs cannot be compared in one table.
    #[error(
        "{first} and {second} cannot be compared, although their data are the same: {difference}. Errors compare only \
         at identical target time stamps: give both experiments the same [windows] reach, evaluation_stride and \
         max_gap, the same [inputs] domain_filter and the same [protocol], or report each run by itself"
    )]
    Incomparable {
        /// A run folder.
        first: PathBuf,
        /// Another run folder.
        second: PathBuf,
        /// Description of the difference.
        difference: String,
    },
    /// A figure could not be drawn.
    #[error("figure {name} could not be drawn: {reason}; please report this with the run's records")]
    Figure {
        /// Name of the figure.
        name: String,
        /// Reason of the failure.
        reason: String,
    },
    /// A file or folder could not be read or written.
    #[error("{path}: cannot {action}: {source}; {remedy}")]
    Io {
        /// Path of the file or folder.
        path: PathBuf,
        /// Attempted action.
        action: &'static str,
        /// Error of the operating system.
        source: std::io::Error,
        /// Advice to the user.
        remedy: &'static str,
    },
}

macro_rules! of_training {
    ($($floor:ty),+) => {
        $(impl From<$floor> for EvalError {
            fn from(error: $floor) -> Self {
                Self::Train(error.into())
            }
        })+
    };
}
of_training!(StoreError, ConfigError, LearnError, RunError, ScheduleError);

impl EvalError {
    /// Returns a file that could not be written.
    pub fn write(path: &Path, source: std::io::Error) -> Self {
        let remedy = "choose a folder that can be written with `--out`, and check the space left on the disk";
        Self::Io { path: path.into(), action: "write", source, remedy }
    }

    /// Returns a file that could not be read.
    pub fn read(path: &Path, source: std::io::Error) -> Self {
        Self::Io { path: path.into(), action: "read", source, remedy: "check the path and its permissions" }
    }

    /// Returns the exit code of the program: 2 usage, 3 data, 4 file system, 5 folder in use, 130 stopped by Ctrl-C.
    pub fn exit_code(&self) -> u8 {
        match self {
            Self::NotARun { .. } | Self::NoRecords { .. } | Self::Unfinished { .. } | Self::Twice { .. } => 2,
            Self::Usage(_) | Self::NotOwned { .. } => 2,
            Self::NoFolder { .. } | Self::Io { .. } => 4,
            Self::InUse { .. } => 5,
            Self::Stopped { .. } => 130,
            Self::Table(error) => error.exit_code(),
            Self::Train(error) => error.exit_code(),
            _ => 3,
        }
    }
}
