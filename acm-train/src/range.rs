//! What the inputs of a run cover, looked at before anything is trained.
//!
//! ```text
//! far outside:  x < low − (high − low)/2   or   x > high + (high − low)/2      low, high of the training trials
//! ```
//!
//! A network knows nothing of values that it has not seen, and says something all the same. What is found here is a
//! warning: an input that never changes is no help, and held-out trials may be meant to lie elsewhere.

use std::collections::BTreeSet;

use acm_datasets::{Campaign, Channel, Trial};

use crate::{experiment::Experiment, plan::Plan};

/// As a part of the range of the training trials.
const MARGIN: f64 = 0.5;

/// Fewer samples of a trial may lie far outside: a peak, a marker that was taken for another.
const SHARE: f64 = 0.1;

/// Warnings about the inputs of all plans, each once.
pub fn warnings(experiment: &Experiment, campaign: &Campaign, channels: &[Channel], plans: &[Plan]) -> Vec<String> {
    let mut warnings = vec![];
    let splits: BTreeSet<(&[String], &[String])> =
        plans.iter().map(|plan| (plan.split.training.as_slice(), plan.split.held_out.as_slice())).collect();
    for (training, held_out) in splits {
        for channel in channels.iter().filter(|channel| !experiment.inputs.shuffled.contains(&channel.name)) {
            let values = |trial: &Trial| channel.of(trial, experiment.windows.max_gap);
            let learned: Vec<(f64, f64)> =
                trials(campaign, training).filter_map(|trial| range(&values(trial))).collect();
            let Some((low, high)) = learned.into_iter().reduce(|a, b| (a.0.min(b.0), a.1.max(b.1))) else { continue };
            if low == high {
                warnings.push(constant(&channel.name, low, training));
                continue;
            }
            let far = trials(campaign, held_out).filter_map(|trial| far_outside(trial, &values(trial), low, high));
            warnings.extend(outside(&channel.name, (low, high), far.collect()));
        }
    }
    let mut seen = BTreeSet::new();
    warnings.retain(|warning| seen.insert(warning.clone()));
    warnings
}

fn trials<'a>(campaign: &'a Campaign, names: &'a [String]) -> impl Iterator<Item = &'a Trial> {
    campaign.trials.iter().filter(move |trial| names.contains(&trial.name))
}

/// The smallest and the greatest value; none where there are no samples.
fn range(values: &[f64]) -> Option<(f64, f64)> {
    values.iter().map(|value| (*value, *value)).reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)))
}

/// Name and range of a trial of which a good part lies far outside.
fn far_outside(trial: &Trial, values: &[f64], low: f64, high: f64) -> Option<(String, f64, f64)> {
    let margin = MARGIN * (high - low);
    let far = values.iter().filter(|value| **value < low - margin || **value > high + margin).count();
    let (least, greatest) = range(values)?;
    (far as f64 > SHARE * values.len() as f64).then(|| (trial.name.clone(), least, greatest))
}

fn constant(channel: &str, value: f64, training: &[String]) -> String {
    format!(
        "input `{channel}` is {value} in all training trials ({}): a network learns nothing from it; leave it out of \
         inputs.channels",
        training.join(", ")
    )
}

fn outside(channel: &str, (low, high): (f64, f64), far: Vec<(String, f64, f64)>) -> Option<String> {
    let (first, rest) = far.split_first()?;
    let (least, greatest) = rest.iter().fold((first.1, first.2), |range, one| (range.0.min(one.1), range.1.max(one.2)));
    let names: Vec<&str> = far.iter().map(|one| one.0.as_str()).collect();
    Some(format!(
        "input `{channel}` goes from {least:.4} to {greatest:.4} in the held-out trials {}, far outside of {low:.4} to \
         {high:.4} in the training trials: there a network says what nothing has taught it; learn from trials that go as \
         far, or leave it out of inputs.channels",
        names.join(", ")
    ))
}
