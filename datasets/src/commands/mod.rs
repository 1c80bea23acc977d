//! One command a file; each writes to a text that `main` prints.

pub mod check;
pub mod describe;
pub mod generate;
pub mod init;
pub mod join;
pub mod predict;
mod progress;
pub mod statistics;

use std::fmt::Write;
use std::path::Path;
use std::time::Duration;

use acm_datasets::DataError;
use acm_datasets::recordings::{Options, Recordings};
use acm_datasets::text::hint::command;
use indicatif::{ProgressBar, ProgressStyle};

use crate::Set;

/// Writes the command that usually follows.
fn next(text: &mut String, program: &str, verb: &str, folder: &Path, rest: &str) {
    let _ = writeln!(text, "next: {}", command(program, verb, folder, rest));
}

/// Opens a data set and shows how many samples were read; with `window`, shorter trials are problems.
fn open(set: &Set, window: Option<usize>) -> Result<Recordings, DataError> {
    let style = ProgressStyle::with_template("{spinner} {human_pos} samples read");
    let bar = ProgressBar::new_spinner().with_style(style.unwrap_or_else(|_| ProgressStyle::default_spinner()));
    bar.enable_steady_tick(Duration::from_millis(200));
    let progress = |samples: usize| bar.inc(samples as u64);
    let options = Options { window, max_gap: set.max_gap, progress: &progress, ..Options::default() };
    let opened = Recordings::open(&set.folder, set.data.as_deref(), &options);
    bar.finish_and_clear();
    opened
}
