//! `acm-data check`: everything that is wrong, and what to do about it.

use std::fmt::Write;

use acm_datasets::{DataError, describe};

use crate::Set;

pub fn run(set: &Set, window: usize, text: &mut String) -> Result<(), DataError> {
    let data = super::open(set, Some(window))?;
    text.push_str(&describe::checked(&data));
    let _ = writeln!(text, "next: cargo run -p acm-eval -- close-loop {}", set.folder.display());
    Ok(())
}
