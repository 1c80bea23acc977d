//! The command line: arguments, printed result and exit code.

mod arguments;
mod error;
mod job;

pub use arguments::{Cli, EngineName};
pub use error::{TrainError, explain};
pub use job::{conduct, conduct_with};
