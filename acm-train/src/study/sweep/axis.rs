//! Values of one key of a sweep, as points of the unit interval and back.
//!
//! ```text
//! list of n values:  v[⌊n u⌋]        range:  low + u (high − low),   or  low · (high / low)^u  with `log`
//! ```

use serde::Deserialize;
use toml::Value;
use tpe::{TpeOptimizer, categorical_range, histogram_estimator, parzen_estimator, range};

use crate::experiment::Fault;

/// Values of one key.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(untagged)]
pub enum Axis {
    /// One of these.
    Values(Vec<Value>),
    /// A number between two.
    Range(Range),
}

/// A number between two, both among them.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Range {
    /// The smallest.
    pub low: f64,
    /// The largest.
    pub high: f64,
    /// Uniform in the logarithm.
    #[serde(default)]
    pub log: bool,
    /// Whole numbers only.
    #[serde(default)]
    pub whole: bool,
    /// Points of a grid.
    #[serde(default = "default_steps")]
    pub steps: usize,
}

fn default_steps() -> usize {
    4
}

impl Axis {
    /// What cannot be tried; `key` is the axis's.
    pub(super) fn fault(&self, key: &str) -> Option<Fault> {
        let key = format!("sweep.space.{key}");
        match self {
            Self::Values(values) if values.is_empty() => {
                Some(Fault::new(&key, "has no values", "list the values to try: [16, 32]"))
            }
            Self::Range(r) if !(r.low < r.high) => {
                let what = format!("goes from {} to {}", r.low, r.high);
                Some(Fault::new(&key, what, "write low below high"))
            }
            Self::Range(r) if r.log && r.low <= 0.0 => {
                Some(Fault::new(&key, format!("has log = true from {}", r.low), "write low above 0, or leave log out"))
            }
            Self::Range(r) if r.steps < 2 => {
                Some(Fault::new(&key, format!("has steps = {}", r.steps), "write 2 or more"))
            }
            _ => None,
        }
    }

    /// Points of a grid.
    pub(super) fn grid(&self) -> Vec<f64> {
        let (count, last) = match self {
            Self::Values(values) => (values.len(), values.len() as f64),
            Self::Range(range) => (range.steps, (range.steps - 1) as f64),
        };
        (0..count).map(|i| i as f64 / last).collect()
    }

    /// The value at `u`.
    pub(super) fn value(&self, u: f64) -> Value {
        match self {
            Self::Values(values) => values[((u * values.len() as f64) as usize).min(values.len() - 1)].clone(),
            Self::Range(range) => range.value(u),
        }
    }

    /// The estimator of a list sees places 0 .. n, that of a range 0 .. 1.
    pub(super) fn estimator(&self) -> TpeOptimizer {
        let made = match self {
            Self::Values(values) => {
                categorical_range(values.len()).map(|places| TpeOptimizer::new(histogram_estimator(), places))
            }
            Self::Range(_) => range(0.0, 1.0).map(|places| TpeOptimizer::new(parzen_estimator(), places)),
        };
        made.expect("validated: at least one value")
    }

    /// The value at an estimator's place.
    pub(super) fn at(&self, place: f64) -> Value {
        match self {
            Self::Values(values) => self.value((place + 0.5) / values.len() as f64),
            Self::Range(_) => self.value(place),
        }
    }

    /// The estimator's place of a value; not a number where the axis does not have it.
    pub(super) fn place(&self, value: &Value) -> f64 {
        let number = || value.as_float().or(value.as_integer().map(|n| n as f64)).unwrap_or(f64::NAN);
        match self {
            Self::Values(values) => values.iter().position(|known| known == value).map_or(f64::NAN, |i| i as f64),
            Self::Range(r) if r.log => (number() / r.low).ln() / (r.high / r.low).ln(),
            Self::Range(r) => (number() - r.low) / (r.high - r.low),
        }
    }
}

impl Range {
    /// Rounded to three digits, so that settings can be read and written down.
    fn value(&self, u: f64) -> Value {
        let exact =
            if self.log { self.low * (self.high / self.low).powf(u) } else { self.low + u * (self.high - self.low) };
        if self.whole {
            return Value::Integer(exact.round().clamp(self.low.ceil(), self.high.floor()) as i64);
        }
        let rounded: f64 = format!("{exact:.2e}").parse().unwrap_or(exact);
        Value::Float(rounded.clamp(self.low, self.high))
    }
}
