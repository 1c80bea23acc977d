//! Cached columns at the compared samples: a search uses the same effects with the same values many times.

use std::collections::HashMap;
use std::sync::{Arc, Mutex, PoisonError};

use super::state::Placed;

/// Approximate limit of cached numbers of each kind. Beyond it, all columns of the kind are deleted.
const MOST: usize = 10_000_000;

/// Kinds of cached columns.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Kind {
    /// A column of an additive effect.
    Additive,
    /// Inputs as a chain of effects leaves them.
    Inputs,
    /// Columns that are the same at every sample of the record.
    Courses,
    /// Displacement of the outputs by loads on the arm.
    Loads,
    /// The base, then the columns of the correction.
    Nominal,
    /// The same at every sample of the record.
    Unfiltered,
}

/// Key of a column: trial, effects with their signals and values, and further values that it depends on.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct Key {
    kind: Kind,
    trial: usize,
    of: String,
    values: Vec<u64>,
}

impl Key {
    /// Returns the key of one group of linear parameters of an effect; their own values do not matter.
    pub fn group(trial: usize, placed: &Placed, group: usize, clock: f64) -> Self {
        let linear = placed.linear();
        let nonlinear = placed.theta.iter().enumerate().filter(|(j, _)| !linear.contains(j));
        let mut values: Vec<u64> = nonlinear.map(|(_, value)| value.to_bits()).collect();
        values.extend([clock.to_bits(), group as u64]);
        Self { kind: Kind::Additive, trial, of: named(placed), values }
    }

    /// Returns the key of columns that several effects share, with further values that they depend on.
    pub fn together(kind: Kind, trial: usize, effects: &[&Placed], more: &[f64]) -> Self {
        let of = effects.iter().map(|placed| named(placed)).collect();
        let values = effects.iter().flat_map(|placed| &placed.theta).chain(more).map(|value| value.to_bits()).collect();
        Self { kind, trial, of, values }
    }
}

fn named(placed: &Placed) -> String {
    let instance = &placed.instance;
    format!("{} {:?} {:?};", instance.effect().name(), instance.carrier(), instance.context())
}

/// Cached columns by their keys; shared by all clones.
#[derive(Debug, Clone, Default)]
pub struct Columns([Arc<Mutex<Kept>>; 6]);

#[derive(Debug, Default)]
struct Kept {
    columns: HashMap<Key, Arc<Vec<f64>>>,
    numbers: usize,
}

impl Columns {
    /// Returns the column of a key, computed where it is not known.
    pub fn get(&self, key: Key, compute: impl FnOnce() -> Vec<f64>) -> Arc<Vec<f64>> {
        if let Some(known) = self.known(&key) {
            return known;
        }
        self.put(key, compute())
    }

    /// Returns the column of a key where it is known.
    pub fn known(&self, key: &Key) -> Option<Arc<Vec<f64>>> {
        self.0[key.kind as usize].lock().unwrap_or_else(PoisonError::into_inner).columns.get(key).cloned()
    }

    /// Stores a column.
    pub fn put(&self, key: Key, column: Vec<f64>) -> Arc<Vec<f64>> {
        let column = Arc::new(column);
        let mut kept = self.0[key.kind as usize].lock().unwrap_or_else(PoisonError::into_inner);
        if kept.numbers > MOST {
            *kept = Kept::default();
        }
        kept.numbers += column.len();
        kept.columns.insert(key, column.clone());
        column
    }
}
