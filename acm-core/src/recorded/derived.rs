//! Cache of a record's derivatives: a search requests the same ones many times.
//!
//! Keys are the window and a hash of time stamps and signal, so that a changed signal has other ones.

use std::hash::{BuildHasher, Hasher};
use std::sync::Arc;

use foldhash::fast::FixedState;
use quick_cache::Weighter;
use quick_cache::sync::Cache;

use crate::effects::memory::{Derivative, Derivatives};

/// Limit of kept derivatives of one record, 24 bytes each. Those of a longer record are not kept.
const MOST: u64 = 400_000;

/// Expected entries: so few that the cache is kept in one piece, which has room for long ones.
const EXPECTED: usize = 16;

/// See the head of this file. A copy of a record starts empty.
#[derive(Debug)]
pub struct Derived(Cache<(u64, u64), Arc<Vec<Derivative>>, Length>);

/// Weight of a signal: its length.
#[derive(Debug, Clone)]
struct Length;

impl Weighter<(u64, u64), Arc<Vec<Derivative>>> for Length {
    fn weight(&self, _: &(u64, u64), found: &Arc<Vec<Derivative>>) -> u64 {
        found.len() as u64
    }
}

impl Derived {
    /// Returns the derivatives of a signal, by a quartic through a window of half a width of `window`, s.
    pub fn of(&self, time: &[f64], signal: &[f64], window: f64) -> Arc<Vec<Derivative>> {
        let key = (hash(time, signal), window.to_bits());
        if let Some(known) = self.0.get(&key) {
            return known;
        }
        let found = Arc::new(Derivatives::quartic().of(time, signal, window).to_vec());
        self.0.insert(key, found.clone());
        found
    }
}

impl Default for Derived {
    fn default() -> Self {
        Self(Cache::with_weighter(EXPECTED, MOST, Length))
    }
}

impl Clone for Derived {
    fn clone(&self) -> Self {
        Self::default()
    }
}

/// Cache content is ignored.
impl PartialEq for Derived {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

fn hash(time: &[f64], signal: &[f64]) -> u64 {
    let mut hasher = FixedState::default().build_hasher();
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
        assert_eq!(derived.0.len(), 4);
    }
}
