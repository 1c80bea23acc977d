//! Every spoiled set, and what `acm-data check` says of it.

use std::panic::{AssertUnwindSafe, catch_unwind};

use acm_datasets::Campaign;

use super::case::Case;
use super::good::Set;
use super::{cells, manifests, parquets, tables, units};

/// All cases, in the order of their kinds.
pub fn all() -> Vec<Case> {
    [cells::all(), tables::all(), parquets::all(), manifests::all(), units::all()].into_iter().flatten().collect()
}

/// Samples of the longest window, and the longest gap, as `acm-data check` has them.
const WINDOW: usize = 50;
const MAX_GAP: f64 = 0.5;

/// Spoils a set, checks it as the program does, and says what the message lacks.
pub fn judge(case: &Case) -> std::io::Result<Vec<String>> {
    let set = Set::new()?;
    (case.spoil)(&set)?;
    let checked = catch_unwind(AssertUnwindSafe(|| Campaign::check(&set.path(), None, WINDOW, MAX_GAP)));
    // pauses are not what a set with a warning is evaluated by
    let longest = |set: &Set| Campaign::check(&set.path(), None, WINDOW, 1e12);
    let (code, message) = match checked {
        Err(_) => (-1, "panicked".to_string()),
        Ok(Ok(campaign)) => (0, campaign.warnings.join("\n")),
        Ok(Err(error)) if case.said.code != 0 => (i32::from(error.exit_code()), error.to_string()),
        Ok(Err(_)) => match longest(&set) {
            Ok(campaign) => (0, campaign.warnings.join("\n")),
            Err(error) => (i32::from(error.exit_code()), error.to_string()),
        },
    };
    let lacks = case.said.lacks(code, &message);
    if lacks.is_empty() {
        return Ok(lacks);
    }
    let shown: String = message.chars().take(700).collect();
    Ok(lacks.into_iter().chain([shown]).collect())
}
