//! One trial as columns over time, the input of an effect.

use super::derived::Derived;
use super::slope::slope;

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
