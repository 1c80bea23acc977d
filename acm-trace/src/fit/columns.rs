//! Columns of additive effects at the samples that count: a search meets the same values many times.

use std::collections::HashMap;
use std::sync::{Arc, Mutex, PoisonError};

use super::state::Placed;

/// Numbers that are kept, about; beyond, all are forgotten.
const MOST: usize = 20_000_000;

/// What a column is computed from: trial, effect with its signals and nonlinear values, group of parameters, clock.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct Key {
    trial: usize,
    effect: &'static str,
    signals: String,
    values: Vec<u64>,
    group: usize,
    clock: u64,
}

impl Key {
    /// Of one group of linear parameters in one trial.
    pub fn new(trial: usize, placed: &Placed, group: usize, clock: f64) -> Self {
        let linear = placed.linear();
        let nonlinear = placed.theta.iter().enumerate().filter(|(j, _)| !linear.contains(j));
        Self {
            trial,
            effect: placed.instance.effect().name(),
            signals: format!("{:?} {:?}", placed.instance.carrier(), placed.instance.context()),
            values: nonlinear.map(|(_, value)| value.to_bits()).collect(),
            group,
            clock: clock.to_bits(),
        }
    }
}

/// Columns by what they are computed from; shared by all clones.
#[derive(Debug, Clone, Default)]
pub struct Columns(Arc<Mutex<Kept>>);

#[derive(Debug, Default)]
struct Kept {
    columns: HashMap<Key, Arc<Vec<f64>>>,
    numbers: usize,
}

impl Columns {
    /// The column of a key, computed where it is not known.
    pub fn get(&self, key: Key, compute: impl FnOnce() -> Vec<f64>) -> Arc<Vec<f64>> {
        if let Some(known) = self.0.lock().unwrap_or_else(PoisonError::into_inner).columns.get(&key) {
            return known.clone();
        }
        let column = Arc::new(compute());
        let mut kept = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if kept.numbers > MOST {
            *kept = Kept::default();
        }
        kept.numbers += column.len();
        kept.columns.insert(key, column.clone());
        column
    }
}
