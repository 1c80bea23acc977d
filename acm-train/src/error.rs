//! What can go wrong, and the exit code that says of which kind it was.
//!
//! | code | kind                                                    |
//! | ---- | ------------------------------------------------------- |
//! | 2    | usage and configuration: the command line, the TOML file |
//! | 3    | data: a table of the data set; a loss that is no number |
//! | 4    | file system: unreadable, unwritable, full               |
//! | 5    | the run folder is in use by another process             |
//! | 130  | stopped by Ctrl-C; `--resume` continues                 |

use std::{io, path::PathBuf};

use acm_core::CalibrationError;
use acm_datasets::{
    DataError,
    toml_words::{LONGEST, cut},
};
use miette::{Diagnostic, MietteHandlerOpts, Report};
use thiserror::Error;

use crate::{experiment::Complaint, learn::LearnError, slurm::SlurmError};

/// Everything that ends a run early. Each message names the file, the value and what to do.
#[derive(Debug, Error, Diagnostic)]
pub enum TrainError {
    /// The experiment file, or a `--set`, asks for something that cannot be.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Experiment(#[from] Box<Complaint>),

    /// The command line asks for something that cannot be.
    #[error("{what}")]
    #[diagnostic(help("{help}"))]
    Usage {
        /// What was asked, and why it cannot be.
        what: String,
        /// What to do instead.
        help: String,
    },

    /// The data set cannot be used.
    #[error(transparent)]
    Data(#[from] DataError),

    /// The data set can be read, but not used for this experiment.
    #[error("{what}")]
    #[diagnostic(help("{help}"))]
    Unusable {
        /// Which part of the data, and why it cannot be used.
        what: String,
        /// What to do.
        help: String,
    },

    /// The nominal model cannot be calibrated on these data.
    #[error("the nominal model cannot be calibrated on trials {trials}: {source}")]
    #[diagnostic(help(
        "choose another [nominal] model in the experiment file (strain, polynomial, none), or give more calibration trials"
    ))]
    Calibration {
        /// Trials calibrated on.
        trials: String,
        /// Why not.
        source: CalibrationError,
    },

    /// The network cannot be fitted.
    #[error(transparent)]
    Learn(LearnError),

    /// The file system refused.
    #[error("cannot {verb} {}: {source}", path.display())]
    #[diagnostic(help("{}", remedy(source)))]
    Io {
        /// `read`, `write`, `create`, `remove` or `lock`.
        verb: &'static str,
        /// The file or folder.
        path: PathBuf,
        /// What the operating system says.
        source: io::Error,
    },

    /// A record is not one.
    #[error("{} is not a record of this program: {source}", file.display())]
    #[diagnostic(help("move the file away and run again with --resume: the run is repeated"))]
    Record {
        /// The file.
        file: PathBuf,
        /// Where and why.
        source: serde_json::Error,
    },

    /// A file that carries its hash is not as it was written.
    #[error("{}: {why}", file.display())]
    #[diagnostic(help(
        "bring the file back as it was, or move it away and run again with --resume: what it held is computed again"
    ))]
    Changed {
        /// The file.
        file: PathBuf,
        /// What does not fit.
        why: String,
    },

    /// A table is not the one that its record was written with.
    #[error("{}: {why} ({})", file.display(), record.display())]
    #[diagnostic(help("bring the file back as it was, or move it and its record away and run again with --resume"))]
    Table {
        /// The table.
        file: PathBuf,
        /// The record that holds its hash.
        record: PathBuf,
        /// What does not fit.
        why: String,
    },

    /// A record was written by another version.
    #[error("{} has format {found}, and this program knows format {known}", file.display())]
    #[diagnostic(help(
        "read it with the version of acm that wrote it, or train again in a folder of its own with --out DIR"
    ))]
    RecordFormat {
        /// The file.
        file: PathBuf,
        /// Its format.
        found: u32,
        /// Ours.
        known: u32,
    },

    /// Another process works in the run folder.
    #[error("{} is in use by {holder}", folder.display())]
    #[diagnostic(help("wait until it ends, or give this run a folder of its own with --out DIR"))]
    InUse {
        /// The run folder.
        folder: PathBuf,
        /// Who holds it: `process 4711 on lab3, for 2 hours`.
        holder: String,
    },

    /// Slurm does not do what it is asked.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Slurm(#[from] SlurmError),

    /// Ctrl-C, after the checkpoint was written.
    #[error("stopped; {finished} of {planned} runs are finished and the rest are checkpointed in {}", folder.display())]
    #[diagnostic(help("continue where it stopped: the same command with --resume"))]
    Stopped {
        /// The run folder.
        folder: PathBuf,
        /// Runs with a record.
        finished: usize,
        /// Runs that the experiment asks for.
        planned: usize,
    },
}

impl TrainError {
    /// A refusal of the file system, with the path it was about.
    pub fn io(verb: &'static str, path: impl Into<PathBuf>, source: io::Error) -> Self {
        Self::Io { verb, path: path.into(), source }
    }

    /// The exit code of the process, as the table above.
    pub fn exit_code(&self) -> u8 {
        match self {
            Self::Experiment(_) | Self::Usage { .. } => 2,
            Self::Learn(error) => error.exit_code(),
            Self::Data(error) => error.exit_code(),
            Self::Unusable { .. } | Self::Calibration { .. } => 3,
            Self::Io { .. } | Self::Record { .. } | Self::RecordFormat { .. } => 4,
            Self::Changed { .. } | Self::Table { .. } => 4,
            Self::Slurm(error) => error.exit_code(),
            Self::InUse { .. } => 5,
            Self::Stopped { .. } => 130,
        }
    }
}

/// The message as it is printed: nothing is wrapped, so that a path or a value can be searched for in a log, and the messages
/// name their cause themselves.
pub fn explain(error: TrainError) -> String {
    // the hook belongs to the process: whoever set one before keeps it
    let _ = miette::set_hook(Box::new(|_| {
        Box::new(MietteHandlerOpts::new().wrap_lines(false).without_cause_chain().build())
    }));
    cut(&format!("{:?}", Report::new(error)), LONGEST)
}

/// A refused file is the same to a reader, whoever was refused.
impl From<LearnError> for TrainError {
    fn from(error: LearnError) -> Self {
        match error {
            LearnError::Io { verb, path, source } => Self::Io { verb, path, source },
            other => Self::Learn(other),
        }
    }
}

fn remedy(source: &io::Error) -> &'static str {
    match source.kind() {
        io::ErrorKind::NotFound => "check the path: it is taken from the current directory",
        io::ErrorKind::PermissionDenied | io::ErrorKind::ReadOnlyFilesystem => {
            "change the permissions, or choose a folder that you may write with --out DIR"
        }
        io::ErrorKind::StorageFull | io::ErrorKind::QuotaExceeded | io::ErrorKind::FileTooLarge => {
            "free some space, then run the same command with --resume: finished runs are kept"
        }
        io::ErrorKind::NotADirectory | io::ErrorKind::AlreadyExists => {
            "a part of this path is a file; choose another folder with --out DIR"
        }
        _ => "once the cause is mended, the same command with --resume continues: finished runs are kept",
    }
}
