//! Derivatives of a record's signals, as far as they were asked for: a search asks for the same ones many times.
//!
//! They are kept by a hash of time stamps and signal, so that a record whose signals are changed has others.

use std::collections::HashMap;
use std::hash::{DefaultHasher, Hasher};
use std::sync::{Arc, Mutex, PoisonError};

use crate::effects::memory::{Derivative, Derivatives};

/// Approximate limit of kept numbers of one record. Beyond it all are deleted.
const MOST: usize = 1_000_000;

/// See the head of this file. A copy of a record begins without.
#[derive(Debug, Default)]
pub struct Derived(Mutex<Kept>);

#[derive(Debug, Default)]
struct Kept {
    of: HashMap<(u64, u64), Arc<Vec<Derivative>>>,
    numbers: usize,
}

impl Derived {
    /// Returns the derivatives of a signal, by a quartic through a window of half a width of `window`, s.
    pub fn of(&self, time: &[f64], signal: &[f64], window: f64) -> Arc<Vec<Derivative>> {
        let key = (hash(time, signal), window.to_bits());
        if let Some(known) = self.lock().of.get(&key) {
            return known.clone();
        }
        let found = Arc::new(Derivatives::quartic().of(time, signal, window).to_vec());
        let mut kept = self.lock();
        if kept.numbers > MOST {
            *kept = Kept::default();
        }
        kept.numbers += 3 * found.len();
        kept.of.insert(key, found.clone());
        found
    }

    fn lock(&self) -> std::sync::MutexGuard<'_, Kept> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Clone for Derived {
    fn clone(&self) -> Self {
        Self::default()
    }
}

/// What is kept makes no difference.
impl PartialEq for Derived {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

fn hash(time: &[f64], signal: &[f64]) -> u64 {
    let mut hasher = DefaultHasher::new();
    time.iter().chain(signal).for_each(|value| hasher.write_u64(value.to_bits()));
    hasher.finish()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: without anything kept; also once the signal is another.
    #[test]
    fn what_is_kept_is_what_would_be_computed() {
        let time: Vec<f64> = (0..50).map(|k| 0.1 * f64::from(k)).collect();
        let mut signal: Vec<f64> = time.iter().map(|t| t.sin()).collect();
        let derived = Derived::default();
        for change in [0.0, 1.0] {
            signal[20] += change;
            for window in [0.3, 0.8, 0.3] {
                let fresh = Derivatives::quartic().of(&time, &signal, window).to_vec();
                assert_eq!(*derived.of(&time, &signal, window), fresh);
            }
        }
        assert_eq!(derived.lock().of.len(), 4);
    }
}
