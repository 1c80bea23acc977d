//! The inputs of a network, by name: `q1`, `rate(q1)`, a context signal, a condition.
//!
//! ```text
//! rate(q)_k = (q_k − q_{k−1}) / (t_k − t_{k−1})
//! ```
//!
//! A causal backward difference over elapsed time. At the first sample of a segment nothing is known yet: it is 0.

use std::fmt;
use std::ops::Range;

use crate::entry::Entry;
use crate::manifest::{Manifest, Role};
use crate::preprocessing::increments::Increments;
use crate::preprocessing::segments::segments;
use crate::trial::Trial;

/// One network input.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Channel {
    /// As written in an experiment.
    pub name: String,
    signal: Signal,
    rate: bool,
}

#[derive(Debug, Clone, PartialEq, Eq)]
enum Signal {
    Actuator(usize),
    Context(usize),
    Condition(String),
}

/// A name that is no input.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct UnknownChannel {
    /// As written.
    pub name: String,
    /// Why, and what is known.
    pub reason: String,
}

impl fmt::Display for UnknownChannel {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "channel {:?} {}", self.name, self.reason)
    }
}

impl std::error::Error for UnknownChannel {}

/// Returns all inputs of a manifest: the actuators, then the context signals.
pub fn default_channels(manifest: &Manifest) -> Vec<String> {
    manifest.actuator.iter().chain(&manifest.context).map(|signal| signal.name().to_string()).collect()
}

/// Returns the rates of those inputs whose increments are motion in the trials that are learned from ([`Increments`]).
pub fn default_rates(manifest: &Manifest, trials: &[Entry]) -> Vec<String> {
    let learned = || trials.iter().filter(|trial| matches!(trial.role, Role::Calibration | Role::Development));
    let moves = |signal: usize| learned().map(|trial| trial.increments[signal]).sum::<Increments>().are_motion();
    let names = default_channels(manifest).into_iter().enumerate();
    names.filter(|(signal, _)| moves(*signal)).map(|(_, name)| format!("rate({name})")).collect()
}

impl Channel {
    /// Returns whether it is the rate of a signal.
    pub fn is_rate(&self) -> bool {
        self.rate
    }

    /// Looks `name` up in the manifest: by name or column of an actuator or context signal, else as a condition that
    /// every trial that is used has.
    ///
    /// # Errors
    /// A name that is unknown, an output, a condition that some of the trials lack, or the rate of a condition.
    pub fn parse(name: &str, manifest: &Manifest, trials: &[Entry]) -> Result<Channel, UnknownChannel> {
        let inner = name.strip_prefix("rate(").and_then(|n| n.strip_suffix(')')).map(str::trim);
        let (signal, rate) = (inner.unwrap_or(name), inner.is_some());
        let refuse = |reason: String| Err(UnknownChannel { name: name.to_string(), reason });
        let find = |signals: &[crate::manifest::Signal]| {
            let by_name = signals.iter().position(|s| s.name() == signal);
            by_name.or_else(|| signals.iter().position(|s| s.column == signal))
        };
        let found = match (find(&manifest.actuator), find(&manifest.context)) {
            (Some(i), _) => Signal::Actuator(i),
            (None, Some(i)) => Signal::Context(i),
            (None, None) => {
                let lacking: Vec<&str> =
                    used(trials).filter(|t| !t.conditions.contains_key(signal)).map(|t| t.name.as_str()).collect();
                let output = manifest.measured.iter().any(|m| m.column == signal || m.name() == signal);
                if output {
                    return refuse("is an output: it is not known when it is to be predicted; choose an input".into());
                }
                if used(trials).all(|t| !t.conditions.contains_key(signal)) {
                    return refuse(format!("is unknown; the set has {}", known(manifest)));
                }
                if !lacking.is_empty() {
                    let trials = lacking.join(" ");
                    return refuse(format!("is a condition that trials {trials} do not have; add it to [conditions]"));
                }
                if rate {
                    return refuse("is the rate of a constant; delete it".into());
                }
                Signal::Condition(signal.to_string())
            }
        };
        Ok(Channel { name: name.to_string(), signal: found, rate })
    }

    /// Values of a trial `[T]` in SI, one after the other; rates restart after a gap over `max_gap` seconds.
    pub fn of(&self, trial: &Trial, max_gap: f64) -> Vec<f64> {
        self.values(trial, &segments(&trial.time, max_gap))
    }

    /// Values `[T]` in SI (per second for a rate).
    pub(crate) fn values(&self, trial: &Trial, segments: &[Range<usize>]) -> Vec<f64> {
        let values: Vec<f64> = match &self.signal {
            Signal::Actuator(i) => trial.actuators.column(*i).iter().copied().collect(),
            Signal::Context(i) => trial.context.column(*i).iter().copied().collect(),
            Signal::Condition(name) => vec![trial.conditions.get(name).copied().unwrap_or(0.0); trial.samples()],
        };
        if self.rate { rate(&trial.time, &values, segments) } else { values }
    }
}

fn used(trials: &[Entry]) -> impl Iterator<Item = &Entry> {
    trials.iter().filter(|t| t.role != Role::Excluded)
}

fn known(manifest: &Manifest) -> String {
    let names = default_channels(manifest).join(" ");
    match manifest.actuator.first() {
        Some(first) => format!("{names}, and rates as in \"rate({})\"", first.name()),
        None => names,
    }
}

/// Backward difference over elapsed time; 0 at the first sample of a segment.
pub fn rate(time: &[f64], values: &[f64], segments: &[Range<usize>]) -> Vec<f64> {
    let mut rate = vec![0.0; values.len()];
    for t in segments.iter().flat_map(|s| s.clone().skip(1)) {
        rate[t] = (values[t] - values[t - 1]) / (time[t] - time[t - 1]);
    }
    rate
}

#[cfg(test)]
mod tests {
    /// Oracle: by hand, with steps of 0.5, 0.5, a gap of 3, and 0.25 s.
    #[test]
    fn rate_is_a_backward_difference_that_restarts_at_a_gap() {
        let (time, values) = ([0.0, 0.5, 1.0, 4.0, 4.25], [1.0, 2.0, 0.0, 9.0, 9.5]);
        assert_eq!(super::rate(&time, &values, &[0..3, 3..5]), [0.0, 2.0, -4.0, 0.0, 2.0]);
        assert_eq!(super::rate(&time, &values, &[0..5])[3], 3.0, "without the gap");
    }
}
