//! Cached columns at the compared samples: a search uses the same effects with the same values many times.

use std::sync::Arc;

use quick_cache::Weighter;
use quick_cache::sync::Cache;

use super::state::Placed;

/// Most cached numbers of each kind. Longer columns are not cached.
const MOST: u64 = 10_000_000;

/// Expected number of columns of a kind: so few that the cache is in one piece, which has room for long ones.
const EXPECTED: usize = 32;

/// Number of kinds.
const KINDS: usize = Kind::Filtered as usize + 1;

/// Kinds of cached columns.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Kind {
    /// A column of an additive effect.
    Additive,
    /// Such a column at every sample of the record.
    AdditiveCourse,
    /// Inputs after a chain of effects.
    Inputs,
    /// Such inputs at every sample of the record.
    Courses,
    /// Displacement of the outputs by loads on the arm.
    Loads,
    /// The base, then the columns of the correction.
    Nominal,
    /// Both at every sample of the record.
    Unfiltered,
    /// The base and the columns of the correction, or a column of an additive effect, behind filters.
    Filtered,
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
    /// Returns the key of one group of an effect's linear parameters, whose own values do not matter.
    pub fn group(trial: usize, placed: &Placed, group: usize, clock: f64) -> Self {
        let linear = placed.linear();
        let nonlinear = placed.theta.iter().enumerate().filter(|(j, _)| !linear.contains(j));
        let mut values: Vec<u64> = nonlinear.map(|(_, value)| value.to_bits()).collect();
        values.extend([clock.to_bits(), group as u64]);
        Self { kind: Kind::Additive, trial, of: named(placed), values }
    }

    /// Returns the key of these columns behind filters.
    pub fn behind(mut self, filters: &[&Placed]) -> Self {
        for placed in filters {
            self.of.push_str(&named(placed));
            self.values.extend(placed.theta.iter().map(|value| value.to_bits()));
        }
        Self { kind: Kind::Filtered, ..self }
    }

    /// Returns the key of the same column at every sample of the record.
    pub fn throughout(self) -> Self {
        Self { kind: Kind::AdditiveCourse, ..self }
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
#[derive(Debug, Clone)]
pub struct Columns(Arc<[Cache<Key, Arc<Vec<f64>>, Length>; KINDS]>);

/// Weight of a column: its length.
#[derive(Debug, Clone)]
struct Length;

impl Weighter<Key, Arc<Vec<f64>>> for Length {
    fn weight(&self, _: &Key, column: &Arc<Vec<f64>>) -> u64 {
        column.len() as u64
    }
}

impl Default for Columns {
    fn default() -> Self {
        Self(Arc::new(std::array::from_fn(|_| Cache::with_weighter(EXPECTED, MOST, Length))))
    }
}

impl Columns {
    /// Returns the column of a key, computed where it is not cached. Concurrent threads each compute it: none waits for another, which may
    /// itself wait for this one.
    pub fn get(&self, key: Key, compute: impl FnOnce() -> Vec<f64>) -> Arc<Vec<f64>> {
        if let Some(known) = self.known(&key) {
            return known;
        }
        self.put(key, Arc::new(compute()))
    }

    /// Returns the column of a key if it is cached.
    pub fn known(&self, key: &Key) -> Option<Arc<Vec<f64>>> {
        self.0[key.kind as usize].get(key)
    }

    /// Stores a column.
    pub fn put(&self, key: Key, column: Arc<Vec<f64>>) -> Arc<Vec<f64>> {
        self.0[key.kind as usize].insert(key, column.clone());
        column
    }
}
