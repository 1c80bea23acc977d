//! `acm-data check`: everything that is wrong, and what to do about it.

use std::fmt::Write;

use acm_datasets::DataError;

use crate::Set;

pub fn run(set: &Set, window: usize, text: &mut String) -> Result<(), DataError> {
    let data = super::open(set, Some(window))?;
    super::clocks(&data, text);
    for warning in &data.warnings {
        let _ = writeln!(text, "warning: {warning}");
    }
    let (samples, trials) = (data.samples(), data.entries.len());
    let dropped: usize = data.entries.iter().flat_map(|entry| entry.dropped.values()).sum();
    let _ =
        writeln!(text, "{}: {trials} trials, {samples} samples, {dropped} left out: no problems", data.manifest.name);
    let _ = writeln!(text, "next: cargo run -p acm-eval -- close-loop {}", set.folder.display());
    Ok(())
}
