//! The command line: what is asked, what is printed, and with which code the program ends.

mod arguments;
mod error;
mod job;

pub use arguments::{Cli, EngineName};
pub use error::{TrainError, explain};
pub use job::{conduct, conduct_with};
