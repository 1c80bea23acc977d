//! One trial as columns over time, the input of an effect.

use super::derived::Derived;

/// One trial of T samples, each signal a column.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Record {
    /// Time stamps `[T]`, s, increasing.
    pub time: Vec<f64>,
    /// A columns of T values, SI.
    pub actuators: Vec<Vec<f64>>,
    /// E columns of T values: context signals, then conditions.
    pub contexts: Vec<Vec<f64>>,
    /// Rates of change of the actuators, A columns, per second ([`slope`]).
    pub actuator_rates: Vec<Vec<f64>>,
    /// Rates of change of the contexts, E columns, per second.
    pub context_rates: Vec<Vec<f64>>,
    /// Acceleration of the carrier, three columns, m/s²; none where it was not recorded.
    pub acceleration: Vec<Vec<f64>>,
    pub(crate) derived: Derived,
}

impl Record {
    /// A record whose rates of change follow from the signals.
    pub fn new(time: Vec<f64>, actuators: Vec<Vec<f64>>, contexts: Vec<Vec<f64>>, acceleration: Vec<Vec<f64>>) -> Self {
        let actuator_rates = actuators.iter().map(|q| slope(&time, q)).collect();
        let context_rates = contexts.iter().map(|c| slope(&time, c)).collect();
        Self { time, actuators, contexts, actuator_rates, context_rates, acceleration, derived: Derived::default() }
    }

    /// Number of samples T.
    pub fn samples(&self) -> usize {
        self.time.len()
    }

    /// This record and the next of the same signals, as one.
    #[must_use]
    pub fn followed_by(&self, next: &Record) -> Record {
        let both = |first: &[Vec<f64>], then: &[Vec<f64>]| -> Vec<Vec<f64>> {
            first.iter().zip(then).map(|(first, then)| [first.as_slice(), then].concat()).collect()
        };
        Record::new(
            [self.time.as_slice(), &next.time].concat(),
            both(&self.actuators, &next.actuators),
            both(&self.contexts, &next.contexts),
            both(&self.acceleration, &next.acceleration),
        )
    }

    /// The samples of `rows`, which are increasing.
    pub fn select(&self, rows: &[usize]) -> Record {
        let pick = |column: &Vec<f64>| rows.iter().map(|&t| column[t]).collect::<Vec<f64>>();
        let all = |columns: &[Vec<f64>]| columns.iter().map(pick).collect();
        Record {
            time: pick(&self.time),
            actuators: all(&self.actuators),
            contexts: all(&self.contexts),
            actuator_rates: all(&self.actuator_rates),
            context_rates: all(&self.context_rates),
            acceleration: all(&self.acceleration),
            derived: Derived::default(),
        }
    }
}

/// Samples on each side that a rate of change is fitted to.
pub(crate) const REACH: usize = 2;

/// Slope of a straight line through each sample and its two neighbours on either side, per second.
pub fn slope(time: &[f64], values: &[f64]) -> Vec<f64> {
    (0..time.len()).map(|t| slope_at(time, values, t)).collect()
}

/// Slope at sample `t` alone.
pub(crate) fn slope_at(time: &[f64], values: &[f64], t: usize) -> f64 {
    let near = t.saturating_sub(REACH)..=(t + REACH).min(time.len() - 1);
    let count = near.clone().count() as f64;
    let mean_time = near.clone().map(|k| time[k]).sum::<f64>() / count;
    let mean = near.clone().map(|k| values[k]).sum::<f64>() / count;
    let spread: f64 = near.clone().map(|k| (time[k] - mean_time).powi(2)).sum();
    let joint: f64 = near.map(|k| (time[k] - mean_time) * (values[k] - mean)).sum();
    if spread > 0.0 { joint / spread } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: a straight line has its slope everywhere, on irregular time stamps.
    #[test]
    fn a_line_has_one_slope() {
        let time = [0.0, 0.1, 0.25, 0.3, 1.0, 1.1];
        let values: Vec<f64> = time.iter().map(|t| 3.0 - 2.0 * t).collect();
        assert!(slope(&time, &values).iter().all(|v| (v + 2.0).abs() < 1e-12));
        assert_eq!(slope(&[1.0], &[5.0]), [0.0]);
    }
}
