//! Values of one key of a sweep, as points of the unit interval and back.
//!
//! ```text
//! list of n values:  v[⌊n u⌋]        range:  low + u (high − low),   or  low · (high / low)^u  with `log`
//! ```

use serde::{Deserialize, Deserializer, de::Error};
use toml::Value;
use tpe::{TpeOptimizer, categorical_range, histogram_estimator, parzen_estimator, range};

use crate::config::Fault;

/// One value for each key of the space, in its order.
pub type Setting = Vec<(String, Value)>;

/// Largest number of points of a grid.
const MOST_STEPS: usize = 10_000;

/// Largest whole number; larger ones are not exact.
const LARGEST: f64 = 1e15;

/// Values of one key.
#[derive(Debug, Clone, PartialEq)]
pub enum Axis {
    /// Listed values.
    Values(Vec<Value>),
    /// Range of numbers.
    Range(Range),
}

/// Range of numbers, its ends included.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Range {
    /// Smallest value.
    pub low: f64,
    /// Largest value.
    pub high: f64,
    /// Whether it is uniform in the logarithm.
    #[serde(default)]
    pub log: bool,
    /// Whether it has whole numbers only.
    #[serde(default)]
    pub whole: bool,
    /// Points of a grid.
    #[serde(default = "default_steps")]
    pub steps: usize,
}

fn default_steps() -> usize {
    4
}

/// Reads a list or a table, distinguished by hand: of an untagged enum serde says no more than that nothing fits.
impl<'de> Deserialize<'de> for Axis {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        match Value::deserialize(deserializer)? {
            Value::Array(values) => Ok(Self::Values(values)),
            Value::Table(table) => {
                Range::deserialize(table).map(Self::Range).map_err(|e| D::Error::custom(e.message()))
            }
            other => Err(D::Error::custom(format!(
                "{other} is neither a list of values to try nor a range {{ low = …, high = … }}"
            ))),
        }
    }
}

impl Axis {
    /// Returns the fault of the axis; `key` is its key.
    pub(super) fn fault(&self, key: &str) -> Option<Fault> {
        let fault = |name: &str, what: String, help: &str| {
            let parts = ["sweep", "space", key, name].into_iter().filter(|part| !part.is_empty());
            Some(Fault::at(parts.map(String::from).collect(), what, help))
        };
        match self {
            Self::Values(values) if values.is_empty() => {
                fault("", "has no values".into(), "list the values to try: [16, 32]")
            }
            Self::Values(_) => None,
            Self::Range(r) if !(r.low < r.high) => {
                fault("low", format!("is {}, and high is {}", r.low, r.high), "write low below high")
            }
            Self::Range(r) if r.low < -LARGEST || r.high > LARGEST => {
                let (name, value) = if r.high > LARGEST { ("high", r.high) } else { ("low", r.low) };
                fault(name, format!("is {value:e}"), "write numbers from -1e15 to 1e15")
            }
            Self::Range(r) if r.log && r.low <= 0.0 => {
                fault("low", format!("is {} beside log = true", r.low), "write low above 0, or leave log out")
            }
            Self::Range(r) if r.whole && r.low.ceil() > r.high.floor() => {
                let what = format!("is true, and there is no whole number from {} to {}", r.low, r.high);
                fault("whole", what, "widen the range, or leave whole out")
            }
            Self::Range(r) if !(2..=MOST_STEPS).contains(&r.steps) => {
                fault("steps", format!("is {}", r.steps), "write 2 to 10000")
            }
            Self::Range(_) => None,
        }
    }

    /// Returns the number of points of a grid along it.
    pub(super) fn points(&self) -> usize {
        match self {
            Self::Values(values) => values.len(),
            Self::Range(range) => range.steps,
        }
    }

    /// Returns the points of a grid.
    pub(super) fn grid(&self) -> Vec<f64> {
        let count = self.points();
        let last = match self {
            Self::Values(_) => count as f64,
            Self::Range(_) => (count - 1) as f64,
        };
        (0..count).map(|i| i as f64 / last).collect()
    }

    /// Returns the value at `u`.
    pub(super) fn value(&self, u: f64) -> Value {
        match self {
            Self::Values(values) => values[((u * values.len() as f64) as usize).min(values.len() - 1)].clone(),
            Self::Range(range) => range.value(u),
        }
    }

    /// Returns the estimator, with places 0 .. n for a list and 0 .. 1 for a range.
    pub(super) fn estimator(&self) -> TpeOptimizer {
        let made = match self {
            Self::Values(values) => {
                categorical_range(values.len()).map(|places| TpeOptimizer::new(histogram_estimator(), places))
            }
            Self::Range(_) => range(0.0, 1.0).map(|places| TpeOptimizer::new(parzen_estimator(), places)),
        };
        made.expect("validated: at least one value")
    }

    /// Returns the value at an estimator's place.
    pub(super) fn at(&self, place: f64) -> Value {
        match self {
            Self::Values(values) => self.value((place + 0.5) / values.len() as f64),
            Self::Range(_) => self.value(place),
        }
    }

    /// Returns the estimator's place of a value; not a number where the axis does not have it.
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
    /// Rounds to three digits, so that settings can be read and written down.
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
