//! Clock correction: actuators at shifted time stamps.
//!
//! ```text
//! q̃(t) = q(t + c)
//! ```
//!
//! | symbol | meaning                                                              | unit |
//! | `c`    | correction; positive where the actuators' clock is late              | s    |
//!
//! Actuators are linearly interpolated and held at the ends of the record; rates of change are computed from the result.
//! It is a property of the recording, not of the robot: a positive one reads ahead, which no physical effect does.
//! Ljung (1999), System Identification, 2nd ed., ch. 14: preprocessing data.

use crate::effects::memory::DelayLine;
use crate::recorded::record::Record;

/// The record with its actuators read `c` seconds later; contexts and acceleration stay.
pub fn clock_corrected(record: &Record, c: f64) -> Record {
    let Record { time, contexts, acceleration, .. } = record;
    let moved = |q: &Vec<f64>| {
        let mut q = q.clone();
        DelayLine::default().run(time, &mut q, |_| -c, 0.0);
        q
    };
    let actuators = record.actuators.iter().map(moved).collect();
    Record::new(time.clone(), actuators, contexts.clone(), acceleration.clone())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn record(time: &[f64], q: Vec<f64>) -> Record {
        let twice = q.iter().map(|q| 2.0 * q).collect();
        Record::new(time.to_vec(), vec![q, twice], vec![time.to_vec()], vec![])
    }

    /// Oracle: a straight line read later is the line at that time, and rests at the end of the record.
    #[test]
    fn a_line_is_read_later_or_earlier() {
        let time = [5.0, 5.2, 5.25, 6.0, 6.5];
        let line = record(&time, time.iter().map(|t| 3.0 * t).collect());
        for (c, expected) in [(0.3, [5.3, 5.5, 5.55, 6.3, 6.5]), (-0.3, [5.0, 5.0, 5.0, 5.7, 6.2])] {
            let found = clock_corrected(&line, c);
            for (t, expected) in expected.iter().enumerate() {
                assert!((found.actuators[0][t] - 3.0 * expected).abs() < 1e-12, "{c}: {:?}", found.actuators[0]);
                assert!((found.actuators[1][t] - 6.0 * expected).abs() < 1e-12);
            }
            assert_eq!((&found.time, &found.contexts), (&line.time, &line.contexts));
        }
        // By hand: of (5.25, 16.65), (6, 18.9), (6.5, 19.5) the mean is (5 11/12, 18.35), and the slope 1.85/0.7917.
        let rate = clock_corrected(&line, 0.3).actuator_rates[0][4];
        assert!((rate - 1.85 / (19.0 / 24.0)).abs() < 1e-9, "{rate}");
        assert_eq!(clock_corrected(&line, 0.0), line);
    }

    /// No sample and one sample have nothing to interpolate.
    #[test]
    fn short_of_samples() {
        let one = record(&[1.0], vec![7.0]);
        assert_eq!(clock_corrected(&one, 0.5).actuators[0], [7.0]);
        let none = record(&[], vec![]);
        assert_eq!(clock_corrected(&none, 0.5), none);
    }
}
