//! Check that runs were scored on the same targets: the same trials at the same times.

use std::path::Path;

use acm_train::run::record::Stage;

use crate::error::EvalError;
use crate::run::Run;
use crate::run::predictions::{HELD_OUT, Predictions, TrialRows, VALIDATION};

/// Checks that all records of one stage, in all runs, score the same trials at the same times.
///
/// # Errors
/// They do not: the first difference is named.
pub fn same_targets(runs: &[Run]) -> Result<(), EvalError> {
    let mut seen: Vec<(Stage, &str, &Path, &Predictions)> = Vec::new();
    for run in runs {
        for (record, table) in run.records.iter().zip(&run.predictions) {
            let part = if record.stage == Stage::Final { HELD_OUT } else { VALIDATION };
            let known = seen.iter().find(|(stage, ..)| *stage == record.stage);
            match known {
                None => seen.push((record.stage, part, &run.folder, table)),
                Some((_, _, folder, other)) => {
                    if let Some(difference) = difference(other, table, part) {
                        let (first, second) = (folder.to_path_buf(), run.folder.clone());
                        return Err(EvalError::Incomparable { first, second, difference });
                    }
                }
            }
        }
    }
    Ok(())
}

/// Returns the first place where two tables have different targets.
fn difference(a: &Predictions, b: &Predictions, part: &str) -> Option<String> {
    let (left, right) = (a.trials(part), b.trials(part));
    let names = |trials: &[TrialRows]| trials.iter().map(|rows| rows.trial).collect::<Vec<_>>().join(", ");
    let (ours, theirs) = (names(&left), names(&right));
    if ours != theirs {
        return Some(format!("the {part} trials of the first are [{ours}], of the second [{theirs}]"));
    }
    left.iter().zip(&right).find_map(|(l, r)| {
        let (l_times, r_times) = (&a.time()[l.rows.clone()], &b.time()[r.rows.clone()]);
        let trial = l.trial;
        let place = l_times.iter().zip(r_times).position(|(x, y)| x != y);
        match place {
            Some(row) => Some(format!(
                "in {part} trial {trial}, target {} is at {} s in the first and at {} s in the second",
                row + 1,
                l_times[row],
                r_times[row]
            )),
            None if l_times.len() != r_times.len() => Some(format!(
                "{part} trial {trial} has {} targets in the first and {} in the second",
                l_times.len(),
                r_times.len()
            )),
            None => None,
        }
    })
}
