//! `acm-data check`: everything that is wrong, and what to do about it.

use std::fmt::Write;

use acm_datasets::{Campaign, DataError};

use crate::Set;

pub fn run(set: &Set, window: usize, text: &mut String) -> Result<(), DataError> {
    let campaign = Campaign::check(&set.folder, set.data.as_deref(), window, set.max_gap)?;
    for warning in &campaign.warnings {
        let _ = writeln!(text, "warning: {warning}");
    }
    let samples: usize = campaign.trials.iter().map(|t| t.samples()).sum();
    let dropped: usize = campaign.trials.iter().flat_map(|t| t.dropped.values()).sum();
    let (name, trials) = (&campaign.manifest.name, campaign.trials.len());
    let _ = writeln!(text, "{name}: {trials} trials, {samples} samples, {dropped} left out: no problems");
    Ok(())
}
