//! Errors on the held-out trials by seed, and the check that two experiments were scored at the same time stamps.

use std::collections::BTreeMap;

use crate::run::record::RunRecord;

/// Errors of one final run on the held-out trials: root mean squared distances, SI.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SeedErrors {
    /// Seed of the run.
    pub seed: u64,
    /// Time stamps that were scored.
    pub samples: usize,
    /// Error of the nominal model; the same for every seed.
    pub nominal: f64,
    /// Error of the nominal model with the network.
    pub network: f64,
}

/// Returns every final run with held-out trials, in the order of the records.
pub fn errors(records: &[RunRecord]) -> Vec<SeedErrors> {
    let of = |record: &RunRecord| {
        let scores = &record.held_out.as_ref()?.estimators;
        let (nominal, network) = (scores.get("nominal")?, scores.get(&record.experiment.kind())?);
        let (seed, samples) = (record.seed, network.samples);
        Some(SeedErrors { seed, samples, nominal: nominal.rmse_total, network: network.rmse_total })
    };
    records.iter().filter_map(of).collect()
}

/// Returns whether all runs of both were scored at the same time stamps of the same data.
pub fn same_targets(a: &[RunRecord], b: &[RunRecord]) -> bool {
    let mut all = a.iter().chain(b).filter(|record| record.held_out.is_some()).map(targets);
    all.next().is_none_or(|first| all.all(|other| other == first))
}

/// Returns the properties that decide the time stamps: data, filter and windows. The number for each trial reveals any
/// other difference.
fn targets(record: &RunRecord) -> impl PartialEq + use<> {
    let windows = &record.experiment.windows;
    let counts: BTreeMap<String, usize> = record
        .held_out
        .iter()
        .flat_map(|part| &part.trials)
        .map(|(trial, scores)| (trial.clone(), scores.values().map(|score| score.samples).sum()))
        .collect();
    let rules = (windows.reach, windows.evaluation_stride, windows.max_gap, record.experiment.inputs.domain_filter);
    (record.data.hash.clone(), rules, counts)
}
