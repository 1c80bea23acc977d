//! The sets that an elimination of inputs tried ([`super::inputs`]), as records hold them and as a text.

use std::collections::BTreeMap;

use acm_core::display::{plain, signed, with_spread};
use acm_datasets::text::terminal::ruled;

use super::{
    fold_errors::FoldErrors,
    inputs::{Tried, chosen},
    record::{Runs, StudyRecord},
};
use crate::run::evaluation::summary::{display, in_unit, total_name};
use crate::run::record::{RunRecord, Stage};

/// A set that was tried.
#[derive(Debug, Clone, PartialEq)]
pub struct Step {
    /// Inputs and errors of the folds, SI.
    pub set: Tried,
    /// Excess error over the best step: mean over folds, and standard error.
    pub more: (f64, Option<f64>),
    /// Whether it is within one standard error of the best.
    pub as_good: bool,
    /// Whether it was chosen.
    pub chosen: bool,
}

/// Returns the sets of a base in the order in which they were tried, all inputs first.
pub fn steps(base: &str, runs: &[Runs]) -> Vec<Step> {
    let of = runs.iter().filter(|run| run.member.base == base);
    let sets: Vec<Tried> = of.filter_map(|run| tried(run.records)).collect();
    let Some(best) = sets.iter().min_by(|a, b| a.mean().total_cmp(&b.mean())).cloned() else { return vec![] };
    let winner = chosen(&sets);
    let step = |(place, set): (usize, Tried)| Step {
        more: set.more_than(&best),
        as_good: set.as_good_as(&best),
        chosen: place == winner,
        set,
    };
    sets.into_iter().enumerate().map(step).collect()
}

/// Returns a set of inputs from its runs in cross-validation; errors are means over seeds.
pub fn tried(records: &[RunRecord]) -> Option<Tried> {
    let mut folds: BTreeMap<usize, Vec<f64>> = BTreeMap::new();
    for record in records {
        if let (Stage::CrossValidation { fold }, Some(score)) =
            (record.stage, record.validation.estimators.get(&record.experiment.kind()))
        {
            folds.entry(fold).or_default().push(score.rmse_total);
        }
    }
    let errors = folds.into_values().map(|errors| errors.iter().sum::<f64>() / errors.len() as f64).collect();
    Some(Tried { inputs: records.first()?.channels.clone(), errors: FoldErrors(errors) })
}

/// Returns a table for each base, with what was chosen.
pub fn text(study: &StudyRecord, runs: &[Runs]) -> String {
    bases(study).into_iter().map(|base| table(base, runs)).collect::<Vec<_>>().join("\n\n")
}

/// Returns the names of the bases, each once.
pub fn bases(study: &StudyRecord) -> Vec<&str> {
    let mut bases: Vec<&str> = vec![];
    for base in study.members.iter().map(|member| member.base.as_str()) {
        if !bases.contains(&base) {
            bases.push(base);
        }
    }
    bases
}

fn table(base: &str, runs: &[Runs]) -> String {
    let mine = || runs.iter().filter(|run| run.member.base == base);
    let Some(first) = mine().find_map(|run| run.records.first()) else { return String::new() };
    let shown = display(&first.data.unit, mine().flat_map(|run| run.records).map(|record| &record.validation));
    let error = |value: f64| plain(shown.factor * value, 2);
    let steps = steps(base, runs);
    let folds = steps.first().map_or(0, |step| step.set.errors.0.len());
    let row = |step: &Step| {
        let (mean, se) = step.more;
        let more = with_spread(shown.factor * mean, se.map(|se| shown.factor * se));
        let more = if mean == 0.0 { String::new() } else { signed(mean, more) };
        let mark = match (step.chosen, step.as_good) {
            (true, _) => "chosen",
            (false, true) => "as good",
            (false, false) => "",
        };
        let errors = step.set.errors.0.iter().map(|value| error(*value));
        let total = error(step.set.mean());
        [step.set.inputs.join(" ")].into_iter().chain(errors).chain([total, more, mark.into()]).collect()
    };
    let total = total_name(&first.data.unit, first.outputs.len()).to_string();
    let header = std::iter::once(String::new())
        .chain((0..folds).map(|fold| format!("fold {fold}")))
        .chain([total, shown.label("more than the best, ± standard error"), String::new()])
        .collect();
    let made = first.folds.as_ref().map_or(String::new(), |folds| format!(", {}", folds.made));
    format!(
        "Inputs of {base}: RMSE{} in cross-validation{made}; the fewest inputs within one standard error of the best are chosen\n{}",
        in_unit(&shown),
        ruled(header, steps.iter().map(row).collect(), 1)
    )
}
