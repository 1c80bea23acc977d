//! Errors of files and folders.

use std::{io, path::PathBuf};

use acm_datasets::DataError;
use miette::Diagnostic;
use thiserror::Error;

/// Reasons why a file or a folder cannot be used. Each message names it, and what to do.
#[derive(Debug, Error, Diagnostic)]
pub enum StoreError {
    /// The file system refused.
    #[error("cannot {verb} {}: {source}", path.display())]
    #[diagnostic(help("{}", remedy(source)))]
    Io {
        /// Verb of the operation: `read`, `write`, `create`, `remove` or `lock`.
        verb: &'static str,
        /// The file or folder.
        path: PathBuf,
        /// Error of the operating system.
        source: io::Error,
    },

    /// A record is not one.
    #[error("{} is not a record of this program: {source}", file.display())]
    #[diagnostic(help("move the file away and run again with --resume: the run is repeated"))]
    Record {
        /// Path of the file.
        file: PathBuf,
        /// Place and reason.
        source: serde_json::Error,
    },

    /// A file that carries its hash is not as it was written.
    #[error("{}: {why}", file.display())]
    #[diagnostic(help(
        "bring the file back as it was, or move it away and run again with --resume: what it held is computed again"
    ))]
    Changed {
        /// Path of the file.
        file: PathBuf,
        /// Reason of the mismatch.
        why: String,
    },

    /// A table is not the one that its record was written with.
    #[error("{}: {why} ({})", file.display(), record.display())]
    #[diagnostic(help("bring the file back as it was, or move it and its record away and run again with --resume"))]
    Table {
        /// Path of the table.
        file: PathBuf,
        /// The record that holds its hash.
        record: PathBuf,
        /// Reason of the mismatch.
        why: String,
    },

    /// A record was written by another version.
    #[error("{} has format {found}, and this program reads format {known}", file.display())]
    #[diagnostic(help(
        "read it with the version of acm that wrote it, or train again in a folder of its own with --out DIR"
    ))]
    RecordFormat {
        /// Path of the file.
        file: PathBuf,
        /// Format of the file.
        found: u32,
        /// Format that this program knows.
        known: u32,
    },

    /// Another process works in the run folder.
    #[error("{} is in use by {holder}", folder.display())]
    #[diagnostic(help("wait until it ends, or give this run a folder of its own with --out DIR"))]
    InUse {
        /// The run folder.
        folder: PathBuf,
        /// Holder of the lock: `process 4711 on lab3, for 2 hours`.
        holder: String,
    },

    /// A file that another process left behind cannot be removed.
    #[error(transparent)]
    Data(#[from] DataError),

    /// The folder holds something else, or must not be continued.
    #[error("{what}")]
    #[diagnostic(help("{help}"))]
    Folder {
        /// Folder and its contents.
        what: String,
        /// Advice to the user.
        help: String,
    },
}

impl StoreError {
    /// Returns a refusal of the file system, with the path it was about.
    pub fn io(verb: &'static str, path: impl Into<PathBuf>, source: io::Error) -> Self {
        Self::Io { verb, path: path.into(), source }
    }

    /// Returns the exit code: 2 usage, 4 file system, 5 in use.
    pub fn exit_code(&self) -> u8 {
        match self {
            Self::Folder { .. } => 2,
            Self::Data(error) => error.exit_code(),
            Self::Io { .. } | Self::Record { .. } | Self::RecordFormat { .. } => 4,
            Self::Changed { .. } | Self::Table { .. } => 4,
            Self::InUse { .. } => 5,
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

/// Errors of lower layers, which convert to `$to` through `$next`, the error of the layer between.
macro_rules! rises {
    ($($from:ty),+ => $next:ty => $to:ty) => {
        $(impl From<$from> for $to {
            fn from(error: $from) -> Self {
                <$next>::from(error).into()
            }
        })+
    };
}
pub(crate) use rises;
