//! Inter-sample behaviour of actuators.
//!
//! ```text
//! straight   q(t) = q_{k−1} + (q_k − q_{k−1}) (t − t_{k−1}) / h_k
//! held       q(t) = q_{k−1}                                          zero-order hold: the command of a digital controller
//! quartic    q(t) through the samples k−4 to k                       a band-limited signal of which a period has few samples
//! ```
//!
//! for t_{k−1} ≤ t < t_k, h_k = t_k − t_{k−1}. Effects interpolate a record linearly, so a sample is added before each:
//!
//! * held: with the values before, ahead of each jump by [`AHEAD`] of h_k;
//! * quartic: halfway, at q(t_k − h_k/2). Samples from before a step that is more than [`UNEVEN`] times longer or shorter than the next do
//!   not count; with fewer samples the degree falls. Nothing ahead of t_k is needed, so a stream has the same values.
//!
//! Halfway between samples of a sine, linear interpolation errs by 13 % and the quartic by 3 % at six a period; at ten, by 5 and 0.25 %.
//!
//! Other signals are interpolated there. Rates of change are those at the jump, or halfway between two samples.
//!
//! Franklin, Powell & Workman (1998), Digital Control of Dynamic Systems, 3rd ed., ch. 4; Pintelon & Schoukens (2012), System
//! Identification, 2nd ed., ch. 13, on zero-order hold and band-limited signals.

use super::record::Record;

/// Time from the added sample to the jump, as a share of the time between samples: short beside any memory, and long enough that the
/// slope of the jump loses no digits that matter.
pub const AHEAD: f64 = 1e-3;

/// Largest ratio of two steps within a quartic.
pub const UNEVEN: f64 = 2.0;

/// Number of samples that a quartic goes through.
pub const QUARTIC: usize = 5;

/// Actuators between samples; those not listed are interpolated linearly.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub enum InterSample {
    /// All are linear.
    #[default]
    Straight,
    /// These are held.
    Held(Vec<usize>),
    /// These follow a quartic through the last five samples.
    Quartic(Vec<usize>),
}

impl InterSample {
    /// Actuators held or quartic.
    pub fn actuators(&self) -> &[usize] {
        match self {
            Self::Straight => &[],
            Self::Held(actuators) | Self::Quartic(actuators) => actuators,
        }
    }

    /// Time from the added sample to the next, as a share of the time between samples.
    pub(crate) fn ahead(&self) -> f64 {
        if matches!(self, Self::Quartic(_)) { 0.5 } else { AHEAD }
    }

    /// The record with the added samples, and the row of each original one.
    pub fn of(&self, record: &Record) -> (Record, Vec<usize>) {
        let with_added = |t: usize| {
            let jumps = |&a: &usize| record.actuators[a][t] != record.actuators[a][t - 1];
            t > 0
                && match self {
                    Self::Straight => false,
                    Self::Held(actuators) => actuators.iter().any(jumps),
                    Self::Quartic(_) => true,
                }
        };
        let (mut rows, mut next) = (Vec::with_capacity(record.samples()), 0);
        for t in 0..record.samples() {
            next += usize::from(with_added(t));
            rows.push(next);
            next += 1;
        }
        let with = |column: &Vec<f64>, added: &dyn Fn(usize) -> f64| -> Vec<f64> {
            let mut all = Vec::with_capacity(next);
            for (t, &value) in column.iter().enumerate() {
                all.extend(with_added(t).then(|| added(t)));
                all.push(value);
            }
            all
        };
        let between = |column: &Vec<f64>| with(column, &|t| straight(column[t - 1], column[t], self.ahead()));
        let actuator = |(a, column): (usize, &Vec<f64>)| match self {
            Self::Held(actuators) if actuators.contains(&a) => with(column, &|t| column[t - 1]),
            Self::Quartic(actuators) if actuators.contains(&a) => with(column, &|t| {
                let first = (t + 1).saturating_sub(QUARTIC);
                halfway(&record.time[first..=t], &column[first..=t])
            }),
            _ => between(column),
        };
        let rate = |column: &Vec<f64>| match self {
            Self::Quartic(_) => between(column),
            _ => with(column, &|t| column[t]),
        };
        let record = Record {
            time: between(&record.time),
            actuators: record.actuators.iter().enumerate().map(actuator).collect(),
            contexts: record.contexts.iter().map(between).collect(),
            actuator_rates: record.actuator_rates.iter().map(rate).collect(),
            context_rates: record.context_rates.iter().map(rate).collect(),
            acceleration: record.acceleration.iter().map(between).collect(),
            ..Record::default()
        };
        (record, rows)
    }
}

/// Value on the straight line between two samples, by a share of it ahead of the second.
pub(crate) fn straight(before: f64, now: f64, ahead: f64) -> f64 {
    now - ahead * (now - before)
}

/// Value halfway between the last two of two to five samples, the last at the end, of the polynomial through them.
pub(crate) fn halfway(time: &[f64], values: &[f64]) -> f64 {
    let last = time.len() - 1;
    let step = |k: usize| time[k] - time[k - 1];
    let is_even = |k: &usize| step(*k) <= UNEVEN * step(k + 1) && step(k + 1) <= UNEVEN * step(*k);
    let first = (1..last).rev().take_while(is_even).last().map_or(last - 1, |k| k - 1);
    let (time, values) = (&time[first..], &values[first..]);
    let at = 0.5 * (time[time.len() - 2] + time[time.len() - 1]);
    let weight = |j: usize| -> f64 {
        let others = time.iter().enumerate().filter(|(i, _)| *i != j);
        others.map(|(_, other)| (at - other) / (time[j] - other)).product()
    };
    values.iter().enumerate().map(|(j, value)| weight(j) * value).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: by hand. The first actuator is held and jumps at 1.5 and 4 s; the second and the context go straight.
    #[test]
    fn a_sample_with_the_values_before_goes_in_ahead_of_each_jump() {
        let (time, context) = (vec![1.0, 1.5, 2.5, 4.0], vec![0.0, 1.0, 3.0, 6.0]);
        let record =
            Record::new(time, vec![vec![2.0, 5.0, 5.0, -1.0], vec![0.0, 0.5, 0.5, 2.0]], vec![context], vec![]);
        let (found, rows) = InterSample::Held(vec![0]).of(&record);
        assert_eq!(rows, [0, 2, 3, 5]);
        assert_eq!(found.time, [1.0, 1.4995, 1.5, 2.5, 3.9985, 4.0]);
        assert_eq!(found.actuators[0], [2.0, 2.0, 5.0, 5.0, 5.0, -1.0]);
        assert_eq!(found.actuators[1], [0.0, 0.4995, 0.5, 0.5, 1.9985, 2.0]);
        assert_eq!(found.contexts[0], [0.0, 0.999, 1.0, 3.0, 5.997, 6.0]);
        assert_eq!(found.actuator_rates[0][1], record.actuator_rates[0][1]);
        assert_eq!(found.select(&rows), record);
        assert_eq!(InterSample::Straight.of(&record), (record, vec![0, 1, 2, 3]));
    }

    /// Oracle: a quartic. Between samples at uneven times the added sample lies on it, once there are five; before that on polynomials of
    /// lower degree. Its time and other signals go straight.
    #[test]
    fn the_sample_halfway_lies_on_a_quartic() {
        let quartic = |t: f64| 0.3 + t * (1.1 + t * (-0.7 + t * (0.4 - 0.2 * t)));
        let time = vec![0.0, 0.4, 0.9, 1.3, 1.7, 2.2];
        let values: Vec<f64> = time.iter().map(|t| quartic(*t)).collect();
        let record = Record::new(time.clone(), vec![values.clone(), values.clone()], vec![], vec![]);
        let (found, rows) = InterSample::Quartic(vec![1]).of(&record);
        assert_eq!(rows, [0, 2, 4, 6, 8, 10]);
        assert_eq!(found.select(&rows), record);
        for t in 1..time.len() {
            let (added, at) = (2 * t - 1, 0.5 * (time[t] + time[t - 1]));
            let off = found.actuators[1][added] - quartic(at);
            assert_eq!(off.abs() < 1e-14, t >= 4, "{t}: off by {off:.1e}");
            assert!((found.time[added] - at).abs() < 1e-15);
            assert!(
                (found.actuators[0][added] - 0.5 * (values[t] + values[t - 1])).abs() < 1e-15,
                "others go straight"
            );
            let rates = &record.actuator_rates[1];
            assert!((found.actuator_rates[1][added] - 0.5 * (rates[t] + rates[t - 1])).abs() < 1e-15);
        }
        assert!((found.actuators[1][1] - 0.5 * (values[0] + values[1])).abs() < 1e-15, "the first step is straight");
    }

    /// Oracle: an exponential of which a period has n samples, against the weights −5, 28, −70, 140, 35 over 128 of even steps, in Python.
    #[test]
    fn a_quartic_misses_less_of_a_sine_than_a_straight_line() {
        let missed = |n: f64, samples: usize| {
            let at = |k: f64| (2.0 * std::f64::consts::PI * k / n).sin_cos();
            let time: Vec<f64> = (0..samples).map(|k| k as f64).collect();
            let part = |of: &dyn Fn((f64, f64)) -> f64| {
                let values: Vec<f64> = time.iter().map(|k| of(at(*k))).collect();
                halfway(&time, &values) - of(at(samples as f64 - 1.5))
            };
            part(&|(sine, _)| sine).hypot(part(&|(_, cosine)| cosine))
        };
        for (n, straight, quartic) in [(6.0, 0.134, 0.02946), (10.0, 0.0489, 0.002532)] {
            assert!((missed(n, 2) - straight).abs() < 1e-3 && (missed(n, 5) / quartic - 1.0).abs() < 1e-3);
        }
    }

    /// Oracle: the straight line. Behind a gap, and behind two samples that lie close together, what was before does not count.
    #[test]
    fn a_cubic_does_not_reach_over_a_gap() {
        for time in [[0.0, 0.1, 0.2, 1.2, 1.3], [0.0, 0.5, 1.0, 1.001, 1.1]] {
            let values = [3.0, -1.0, 2.0, 5.0, 6.0];
            assert_eq!(halfway(&time[1..], &values[1..]), 5.5);
        }
        assert!(halfway(&[0.1, 0.2, 0.3, 0.4], &[-1.0, 2.0, 5.0, 6.0]) > 5.5);
    }
}
