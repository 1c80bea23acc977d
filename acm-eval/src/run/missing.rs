//! Runs that were planned and have no record; tables are then of the others.

use std::collections::BTreeSet;

use acm_train::run::names::some;

use crate::run::Run;

/// Names the missing parts of a run folder, and how to make them; none where it is complete.
pub fn sentence(run: &Run) -> Option<String> {
    let planned = planned(run);
    let there = |id: &String| run.records.iter().any(|record| record.id == *id);
    let said: Vec<String> = [("seeds", "final-"), ("runs of the folds", "fold")]
        .into_iter()
        .filter_map(|(what, prefix)| {
            let all: Vec<&String> = planned.iter().filter(|id| id.starts_with(prefix)).collect();
            let missing: Vec<String> = all.iter().filter(|id| !there(id)).map(|id| in_words(id)).collect();
            let verb = if missing.len() == 1 { "is" } else { "are" };
            let count = all.len() - missing.len();
            (!missing.is_empty())
                .then(|| format!("{count} of {} {what}: {} {verb} missing", all.len(), some(&missing, ", ")))
        })
        .collect();
    let folder = run.folder.display();
    (!said.is_empty()).then(|| {
        format!(
            "{folder} has {}. The numbers are of the others alone. `acm-train --config {folder}/experiment.toml --out \
             {folder} --resume` runs what is missing.",
            said.join(", and ")
        )
    })
}

/// Writes `final-seed2` as `seed 2`, `fold0-seed2` as `seed 2 of fold 0`.
fn in_words(id: &str) -> String {
    let (stage, seed) = id.split_once("-seed").unwrap_or((id, ""));
    match stage.strip_prefix("fold") {
        Some(fold) => format!("seed {seed} of fold {fold}"),
        None => format!("seed {seed}"),
    }
}

/// Returns the names of all runs, as `nominal.json` lists them. Older folders have no list: then as far as the protocol
/// determines them. It does not count folds that come from the manifest; the last of them that has a record is taken
/// for the last.
fn planned(run: &Run) -> BTreeSet<String> {
    if !run.nominal.runs.is_empty() {
        return run.nominal.runs.iter().cloned().collect();
    }
    let protocol = &run.records[0].experiment.protocol;
    let recorded = run.folds().map(|(fold, _)| fold + 1).max().unwrap_or(0);
    let folds = match &protocol.folds {
        _ if !protocol.cross_validation => 0,
        Some(folds) => folds.len(),
        None => recorded,
    };
    let finals = protocol.seeds.iter().filter(|_| protocol.final_runs).map(|seed| format!("final-seed{seed}"));
    let crossed = (0..folds).flat_map(|fold| protocol.seeds.iter().map(move |seed| format!("fold{fold}-seed{seed}")));
    finals.chain(crossed).collect()
}
