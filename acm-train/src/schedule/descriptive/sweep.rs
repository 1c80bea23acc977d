//! Swept and held actuators: the axes of the figures of tip and residual.
//!
//! ```text
//! swept   = argmax_a  mean over trials of (range of q_a in the trial / range of q_a over all)
//! q*      = q − (least q + greatest q) / 2
//! slice   = trials whose other actuators are held at the same values
//! planar  = the trial in which all actuators but the swept one are nearest to zero, where the arm bends in one plane
//! ```

use std::cmp::Ordering;

use acm_datasets::{Campaign, Trial, units::Unit};
use serde::{Deserialize, Serialize};

/// Name and SI unit of an actuator or a context signal.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Signal {
    /// Name in the manifest.
    pub name: String,
    /// SI unit.
    pub unit: String,
}

impl Signal {
    /// Returns one of a list that was read from a file.
    pub fn at(signals: &[Signal], index: usize) -> Signal {
        signals.get(index).cloned().unwrap_or_else(|| Signal { name: "q".into(), unit: "1".into() })
    }

    /// Writes `q1* [rad]`: the signal counted from the middle of its range.
    pub fn centred(&self) -> String {
        format!("{}* [{}]", self.name, self.unit)
    }
}

/// Returns the actuators of a campaign, in order.
pub fn actuators(campaign: &Campaign) -> Vec<Signal> {
    let si = |unit: &str| Unit::parse(unit).map_or(unit.to_string(), |unit| unit.si_name().to_string());
    campaign.manifest.actuator.iter().map(|a| Signal { name: a.name().into(), unit: si(&a.unit) }).collect()
}

/// Returns the index of the actuator that is swept in `trials`; the first where several are.
pub fn swept(trials: &[&Trial]) -> usize {
    let actuators = trials.iter().map(|trial| trial.actuators.ncols()).max().unwrap_or(0);
    let share = |a: usize| -> f64 { trials.iter().map(|trial| parts(trial, trials, a)).sum() };
    (0..actuators).rev().max_by(|a, b| share(*a).total_cmp(&share(*b))).unwrap_or(0)
}

/// Returns the middle of the range of an actuator over `trials`, from which q* is counted.
pub fn middle(trials: &[&Trial], actuator: usize) -> f64 {
    let (low, high) = range(trials, actuator);
    0.5 * (low + high)
}

/// Returns the trial that bends the arm in one plane; the first where several do as well.
pub fn planar<'a>(trials: &[&'a Trial], swept: usize) -> Option<&'a Trial> {
    let effort = |trial: &Trial| -> f64 {
        let others = (0..trial.actuators.ncols()).filter(|&a| a != swept);
        others
            .map(|a| {
                let most = trials.iter().map(|trial| trial.actuators.column(a).amax()).fold(0.0, f64::max);
                let square = trial.actuators.column(a).norm_squared() / trial.samples().max(1) as f64;
                if most > 0.0 { square / (most * most) } else { 0.0 }
            })
            .sum()
    };
    trials.iter().copied().min_by(|a, b| effort(a).total_cmp(&effort(b)))
}

/// Trials whose other actuators are held at the same values.
#[derive(Debug, Clone, PartialEq)]
pub struct Slice {
    /// Value of every actuator, averaged over the trials; the swept one at the middle of its range.
    pub actuators: Vec<f64>,
    /// Indices of the trials in the list that was sliced.
    pub trials: Vec<usize>,
}

/// Returns the slices by rising values of the other actuators. Values within `tolerance`, as a share of each actuator's
/// range, are the same. `None` where a trial moves more than one actuator, or none has another.
pub fn slices(trials: &[&Trial], swept: usize, tolerance: f64) -> Option<Vec<Slice>> {
    let others: Vec<usize> = (0..trials.first()?.actuators.ncols()).filter(|&a| a != swept).collect();
    let held = |trial: &Trial| others.iter().all(|&a| parts(trial, trials, a) <= tolerance || still(trials, a));
    if others.is_empty() || !trials.iter().all(|trial| held(trial)) {
        return None;
    }
    let width = |a: usize| {
        let (low, high) = range(trials, a);
        tolerance * (high - low)
    };
    let mut slices: Vec<Slice> = vec![];
    for (place, trial) in trials.iter().enumerate() {
        let mean = |a: usize| trial.actuators.column(a).mean();
        let same = |slice: &&mut Slice| others.iter().all(|&a| (slice.actuators[a] - mean(a)).abs() <= width(a));
        match slices.iter_mut().find(same) {
            Some(slice) => slice.trials.push(place),
            None => {
                let actuators = (0..trial.actuators.ncols()).map(mean).collect();
                slices.push(Slice { actuators, trials: vec![place] });
            }
        }
    }
    for slice in &mut slices {
        let of: Vec<&Trial> = slice.trials.iter().map(|&place| trials[place]).collect();
        for (a, value) in slice.actuators.iter_mut().enumerate() {
            *value = if a == swept { middle(&of, a) } else { mean(&of, a) };
        }
    }
    let held = |slice: &Slice| -> Vec<f64> { others.iter().map(|&other| slice.actuators[other]).collect() };
    slices.sort_by(|a, b| held(a).partial_cmp(&held(b)).unwrap_or(Ordering::Equal));
    Some(slices)
}

/// Returns one slice with every trial, for campaigns that hold nothing.
pub fn whole(trials: &[&Trial], swept: usize) -> Slice {
    let actuators = trials.first().map_or(0, |trial| trial.actuators.ncols());
    let value = |a| if a == swept { middle(trials, a) } else { mean(trials, a) };
    Slice { actuators: (0..actuators).map(value).collect(), trials: (0..trials.len()).collect() }
}

fn mean(trials: &[&Trial], actuator: usize) -> f64 {
    let samples: usize = trials.iter().map(|trial| trial.samples()).sum();
    trials.iter().map(|trial| trial.actuators.column(actuator).sum()).sum::<f64>() / samples.max(1) as f64
}

fn range(trials: &[&Trial], actuator: usize) -> (f64, f64) {
    let values = trials.iter().flat_map(|trial| trial.actuators.column(actuator).iter().copied().collect::<Vec<_>>());
    values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), q| (low.min(q), high.max(q)))
}

fn still(trials: &[&Trial], actuator: usize) -> bool {
    let (low, high) = range(trials, actuator);
    low >= high
}

/// Returns the range of an actuator in a trial, as a share of its range over all.
fn parts(trial: &Trial, trials: &[&Trial], actuator: usize) -> f64 {
    let ((least, most), (low, high)) = (range(&[trial], actuator), range(trials, actuator));
    if high > low && most > least { (most - least) / (high - low) } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use acm_datasets::Role;
    use nalgebra::DMatrix;

    /// Returns sweeps of `moved` between −1 and 2 with the other of two actuators held.
    fn trial(name: &str, moved: usize, held: f64) -> Trial {
        let samples = 31;
        let value = |t: usize, a: usize| if a == moved { -1.0 + 0.1 * t as f64 } else { held };
        Trial {
            name: name.into(),
            role: Role::Calibration,
            time: (0..samples).map(|t| t as f64).collect(),
            actuators: DMatrix::from_fn(samples, 2, value),
            context: DMatrix::zeros(samples, 0),
            measured: DMatrix::zeros(samples, 3),
            predicted: None,
            vehicle: None,
            conditions: Default::default(),
            dropped: Default::default(),
            file: Default::default(),
            unmeasured: None,
        }
    }

    #[test]
    fn the_actuator_that_moves_within_trials_is_the_swept_one() {
        for moved in [0, 1] {
            let trials = [("a", 1.2), ("b", 0.1), ("c", 2.8)].map(|(name, held)| trial(name, moved, held));
            let trials: Vec<&Trial> = trials.iter().collect();
            assert_eq!(swept(&trials), moved);
            assert!((middle(&trials, moved) - 0.5).abs() < 1e-12);
            assert_eq!(planar(&trials, moved).map(|trial| trial.name.as_str()), Some("b"));
        }
    }

    /// Oracle: by hand; the range of the held actuator is 0 to 3, so 0.1 and 0 are one slice, and 1.2 is another.
    #[test]
    fn trials_with_the_same_held_value_are_a_slice() {
        let trials = [("a", 1.2), ("b", 0.1), ("c", 3.0), ("d", 0.0)].map(|(name, held)| trial(name, 0, held));
        let trials: Vec<&Trial> = trials.iter().collect();
        let found = slices(&trials, 0, 0.1).unwrap();
        assert_eq!(found.iter().map(|s| s.trials.clone()).collect::<Vec<_>>(), [vec![1, 3], vec![0], vec![2]]);
        assert!((found[0].actuators[1] - 0.05).abs() < 1e-12 && (found[0].actuators[0] - 0.5).abs() < 1e-12);
    }

    #[test]
    fn where_both_actuators_move_there_are_no_slices() {
        let trials = [trial("a", 0, 0.0), trial("b", 1, 0.0)];
        let trials: Vec<&Trial> = trials.iter().collect();
        assert_eq!(slices(&trials, 0, 0.1), None);
        assert_eq!(whole(&trials, 0).trials, [0, 1]);
    }
}
