//! Answer of an engine.

use crate::run::evaluation::summary::count;

/// Status of the runs.
#[derive(Debug)]
pub enum Answer<T> {
    /// All runs are finished.
    Finished(T),
    /// Other processes compute runs; the text says how far they are and what to do.
    Waiting(String),
}

/// Returns the closing line of a dry run.
pub fn nothing_to_submit(runs: usize) -> String {
    format!("{}: all done, nothing to submit; without --dry-run this prints the tables", count(runs, "run"))
}
