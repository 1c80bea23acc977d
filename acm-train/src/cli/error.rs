//! Errors of the program, and their exit codes.
//!
//! | code | kind                                                    |
//! | ---- | ------------------------------------------------------- |
//! | 2    | usage and configuration: the command line, the TOML file |
//! | 3    | data: a table of the data set; a loss that is not finite |
//! | 4    | file system: unreadable, unwritable, full               |
//! | 5    | the run folder is in use by another process             |
//! | 130  | stopped by Ctrl-C; `--resume` continues                 |

use acm_datasets::toml_file::words::{LONGEST, cut};
use miette::{Diagnostic, MietteHandlerOpts, Report};
use thiserror::Error;

use crate::{
    config::ConfigError,
    learn::LearnError,
    run::RunError,
    schedule::ScheduleError,
    store::{StoreError, rises},
};

/// Errors that end the program. Each message names the file, the value and what to do.
#[derive(Debug, Error, Diagnostic)]
pub enum TrainError {
    /// The request cannot be fulfilled.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Schedule(#[from] ScheduleError),

    /// The command line asks for something that cannot be.
    #[error("{what}")]
    #[diagnostic(help("{help}"))]
    Usage {
        /// The request, and why it is refused.
        what: String,
        /// Advice to the user.
        help: String,
    },
}

rises!(StoreError, ConfigError, LearnError, RunError => ScheduleError => TrainError);

impl TrainError {
    /// Returns the exit code of the process, as the table above.
    pub fn exit_code(&self) -> u8 {
        match self {
            Self::Usage { .. } => 2,
            Self::Schedule(error) => error.exit_code(),
        }
    }
}

/// Returns the message as it is printed: nothing is wrapped, so that a path or a value can be searched for in a log,
/// and the messages name their cause themselves.
pub fn explain(error: TrainError) -> String {
    // the hook belongs to the process: an earlier hook stays
    let _ = miette::set_hook(Box::new(|_| {
        Box::new(MietteHandlerOpts::new().wrap_lines(false).without_cause_chain().build())
    }));
    cut(&format!("{:?}", Report::new(error)), LONGEST)
}
