//! Actuators before the first sample of a record.

use super::inter_sample::AHEAD;
use super::record::Record;

/// The record with its actuators at rest at `rest` before the first sample, by [`AHEAD`] of the time to the second: states of
/// effects begin there.
pub fn resting(record: &Record, rest: &[f64]) -> Record {
    let ahead = if record.samples() > 1 { AHEAD * (record.time[1] - record.time[0]) } else { AHEAD };
    with_first(record, record.time[0] - ahead, rest)
}

/// The record with its actuators at rest at their first values, and then a reversal at `turn` before the first sample:
/// rate-independent effects, such as friction, begin there, and lags at rest.
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
