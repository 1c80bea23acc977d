//! Held actuators: each value stays until the next sample, where it jumps.
//!
//! ```text
//! q(t) = q_{k−1},   t_{k−1} ≤ t < t_k
//! ```
//!
//! A record is straight between its samples. So a sample with the values before goes in ahead of each jump, by [`AHEAD`] of the time
//! since the last sample; other signals are interpolated there, and rates of change are those at the jump. The command of a digital
//! controller is such a signal (zero-order hold): Franklin, Powell & Workman (1998), Digital Control of Dynamic Systems, 3rd ed., ch. 4.

use crate::recorded::record::Record;

/// Time from the added sample to the jump, as a share of the time between samples: short beside any memory, and long enough that the
/// slope of the jump loses no digits that matter.
pub const AHEAD: f64 = 1e-3;

/// Value ahead of a sample, between the last value and its own.
pub(crate) fn ahead(before: f64, now: f64) -> f64 {
    now - AHEAD * (now - before)
}

/// The record with these actuators held, and the row of each of its samples.
pub fn held(record: &Record, actuators: &[usize]) -> (Record, Vec<usize>) {
    let jumps = |t: usize| t > 0 && actuators.iter().any(|&a| record.actuators[a][t] != record.actuators[a][t - 1]);
    let (mut rows, mut next) = (Vec::with_capacity(record.samples()), 0);
    for t in 0..record.samples() {
        next += usize::from(jumps(t));
        rows.push(next);
        next += 1;
    }
    let with = |column: &Vec<f64>, added: &dyn Fn(usize) -> f64| -> Vec<f64> {
        let mut all = Vec::with_capacity(next);
        for (t, &value) in column.iter().enumerate() {
            all.extend(jumps(t).then(|| added(t)));
            all.push(value);
        }
        all
    };
    let straight = |column: &Vec<f64>| with(column, &|t| ahead(column[t - 1], column[t]));
    let actuator = |(a, column): (usize, &Vec<f64>)| match actuators.contains(&a) {
        true => with(column, &|t| column[t - 1]),
        false => straight(column),
    };
    let rate = |column: &Vec<f64>| with(column, &|t| column[t]);
    let record = Record {
        time: straight(&record.time),
        actuators: record.actuators.iter().enumerate().map(actuator).collect(),
        contexts: record.contexts.iter().map(straight).collect(),
        actuator_rates: record.actuator_rates.iter().map(rate).collect(),
        context_rates: record.context_rates.iter().map(rate).collect(),
        acceleration: record.acceleration.iter().map(straight).collect(),
        ..Record::default()
    };
    (record, rows)
}

/// The record with its actuators at rest at these values ahead of the first sample, by [`AHEAD`] of the time to the second: the states
/// of effects begin there.
pub fn resting(record: &Record, rest: &[f64]) -> Record {
    let ahead = if record.samples() > 1 { AHEAD * (record.time[1] - record.time[0]) } else { AHEAD };
    with_first(record, record.time[0] - ahead, rest)
}

/// The record with its actuators at rest at their first values, and a turning point at these ahead of the first sample: effects that
/// remember no time, as friction does, begin there, and lags at rest.
pub fn turning(record: &Record, turn: &[f64]) -> Record {
    let first: Vec<f64> = record.actuators.iter().map(|q| q[0]).collect();
    let turned = resting(record, turn);
    // As long before the turning point as that is before the first sample.
    with_first(&turned, 2.0 * turned.time[0] - turned.time[1], &first)
}

/// The record with a sample ahead of the first, with other values of the actuators: all else, rates too, is that of the first.
fn with_first(record: &Record, time: f64, values: &[f64]) -> Record {
    let with = |first: f64, column: &Vec<f64>| [&[first], &column[..]].concat();
    let same = |columns: &[Vec<f64>]| columns.iter().map(|column| with(column[0], column)).collect();
    Record {
        time: with(time, &record.time),
        actuators: record.actuators.iter().zip(values).map(|(column, &value)| with(value, column)).collect(),
        contexts: same(&record.contexts),
        actuator_rates: same(&record.actuator_rates),
        context_rates: same(&record.context_rates),
        acceleration: same(&record.acceleration),
        ..Record::default()
    }
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
        let (found, rows) = held(&record, &[0]);
        assert_eq!(rows, [0, 2, 3, 5]);
        assert_eq!(found.time, [1.0, 1.4995, 1.5, 2.5, 3.9985, 4.0]);
        assert_eq!(found.actuators[0], [2.0, 2.0, 5.0, 5.0, 5.0, -1.0]);
        assert_eq!(found.actuators[1], [0.0, 0.4995, 0.5, 0.5, 1.9985, 2.0]);
        assert_eq!(found.contexts[0], [0.0, 0.999, 1.0, 3.0, 5.997, 6.0]);
        assert_eq!(found.actuator_rates[0][1], record.actuator_rates[0][1]);
        assert_eq!(found.select(&rows), record);
        assert_eq!(held(&record, &[]), (record, vec![0, 1, 2, 3]));
    }

    /// Oracle: by hand. Between the first two samples lie 0.5 s.
    #[test]
    fn a_rest_and_a_turn_go_in_ahead_of_the_first_sample() {
        let record = Record::new(vec![1.0, 1.5, 2.5], vec![vec![2.0, 5.0, 4.0]], vec![vec![0.0, 1.0, 3.0]], vec![]);
        let behind = resting(&record, &[-7.0]);
        assert_eq!((&behind.time[..2], &behind.actuators[0][..2]), (&[0.9995, 1.0][..], &[-7.0, 2.0][..]));
        let behind = turning(&record, &[-7.0]);
        assert_eq!(behind.actuators[0], [2.0, -7.0, 2.0, 5.0, 4.0]);
        assert_eq!(behind.contexts[0], [0.0, 0.0, 0.0, 1.0, 3.0]);
        assert!((behind.time[0] - 0.999).abs() < 1e-12 && behind.time[1..3] == [0.9995, 1.0]);
        assert_eq!(behind.select(&[2, 3, 4]), record);
    }
}
