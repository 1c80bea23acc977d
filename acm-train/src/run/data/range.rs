//! Ranges of the inputs of a run, checked before training.
//!
//! ```text
//! far outside:  x < low − (high − low)/2   or   x > high + (high − low)/2      low, high of the training trials
//! ```
//!
//! A network knows nothing of values that it has not seen, and says something all the same. What is found here is a
//! warning: an input that never changes is no help, and held-out trials may be meant to lie elsewhere.

use std::collections::{BTreeMap, BTreeSet};

use acm_core::display::significant;
use acm_datasets::{Channel, DataError, Trial};

use super::Data;
use crate::config::Experiment;
use crate::run::names;
use crate::run::plan::Plan;

/// Margin as a share of the range of the training trials.
const MARGIN: f64 = 0.5;

/// Largest share of a trial's samples that may lie far outside, such as a peak or a confused marker.
const SHARE: f64 = 0.1;

/// Smallest and largest value of each channel; none where there are no samples.
type Ranges = Vec<Option<(f64, f64)>>;

/// Returns warnings about the inputs of all plans, each once.
///
/// # Errors
/// A trial that cannot be read.
pub fn warnings(
    experiment: &Experiment,
    data: &Data,
    channels: &[Channel],
    plans: &[Plan],
) -> Result<Vec<String>, DataError> {
    let mut warnings = vec![];
    let splits: BTreeSet<(&[String], &[String])> =
        plans.iter().map(|plan| (plan.split.training.as_slice(), plan.split.held_out.as_slice())).collect();
    let seen: Vec<&Channel> =
        channels.iter().filter(|channel| !experiment.inputs.shuffled.contains(&channel.name)).collect();
    let max_gap = experiment.windows.gap();
    let ranges = ranges(data, &splits, &seen, max_gap)?;
    for (training, held_out) in splits {
        let learned: Ranges = (0..seen.len()).map(|c| union(training, &ranges, c)).collect();
        let mut far: Vec<Vec<(String, f64, f64)>> = vec![vec![]; seen.len()];
        for trial in data.trials(held_out) {
            let trial = trial?;
            for ((channel, learned), far) in seen.iter().zip(&learned).zip(&mut far) {
                let Some((low, high)) = learned.filter(|(low, high)| low < high) else { continue };
                far.extend(far_outside(&trial, &channel.of(&trial.with_unmeasured().0, max_gap), low, high));
            }
        }
        for ((channel, learned), far) in seen.iter().zip(learned).zip(far) {
            match learned {
                Some((low, high)) if low == high => warnings.push(constant(&channel.name, low, training)),
                Some(range) => warnings.extend(outside(&channel.name, range, far)),
                None => {}
            }
        }
    }
    let mut told = BTreeSet::new();
    warnings.retain(|warning| told.insert(warning.clone()));
    Ok(warnings)
}

/// Returns the ranges of each training trial, in one pass.
fn ranges(
    data: &Data,
    splits: &BTreeSet<(&[String], &[String])>,
    channels: &[&Channel],
    max_gap: f64,
) -> Result<BTreeMap<String, Ranges>, DataError> {
    let names: BTreeSet<&String> = splits.iter().flat_map(|(training, _)| *training).collect();
    let names: Vec<String> = names.into_iter().cloned().collect();
    let of = |trial: &Trial| {
        let (whole, _) = trial.with_unmeasured();
        channels.iter().map(|channel| range(&channel.of(&whole, max_gap))).collect()
    };
    data.trials(&names).map(|trial| trial.map(|trial| (trial.name.clone(), of(&trial)))).collect()
}

/// Returns the range of a channel over some trials.
fn union(names: &[String], ranges: &BTreeMap<String, Ranges>, channel: usize) -> Option<(f64, f64)> {
    let each = names.iter().filter_map(|name| ranges.get(name)?[channel]);
    each.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)))
}

/// Returns the smallest and the greatest value; none where there are no samples.
fn range(values: &[f64]) -> Option<(f64, f64)> {
    values.iter().map(|value| (*value, *value)).reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)))
}

/// Returns the name and range of a trial of which a good part lies far outside.
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
        names::some(training, ", ")
    )
}

fn outside(channel: &str, (low, high): (f64, f64), far: Vec<(String, f64, f64)>) -> Option<String> {
    let (first, rest) = far.split_first()?;
    let (least, greatest) = rest.iter().fold((first.1, first.2), |range, one| (range.0.min(one.1), range.1.max(one.2)));
    let names: Vec<String> = far.iter().map(|one| one.0.clone()).collect();
    let shown = |value: f64| significant(value, 4);
    Some(format!(
        "input `{channel}` goes from {} to {} in the held-out trials {}, far outside of {} to {} in the training trials: \
         there a network says what nothing has taught it; learn from trials that go as far, or leave it out of \
         inputs.channels",
        shown(least),
        shown(greatest),
        names::some(&names, ", "),
        shown(low),
        shown(high),
    ))
}
