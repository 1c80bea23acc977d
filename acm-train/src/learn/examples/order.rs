//! Order of the training windows in an epoch.
//!
//! Fisher and Yates, driven by ChaCha8 under the run's seed. Epoch e has stream 2³² + e, so the order of one epoch does
//! not depend on those before it and a resumed run needs no state; initial weights draw from streams below 2³².

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

/// Returns a permutation of 0 .. `count`.
pub fn order(count: usize, seed: u64, epoch: usize) -> Vec<usize> {
    draw(count, count, seed, epoch)
}

/// Returns the first `wanted` numbers of permutations of 0 .. `count`, one after the other.
pub fn draw(count: usize, wanted: usize, seed: u64, epoch: usize) -> Vec<usize> {
    let mut generator = ChaCha8Rng::seed_from_u64(seed);
    generator.set_stream((1 << 32) + epoch as u64);
    let mut drawn = Vec::with_capacity(wanted);
    while drawn.len() < wanted && count > 0 {
        let mut order: Vec<usize> = (0..count).collect();
        for last in (1..count).rev() {
            order.swap(last, below(last as u64 + 1, &mut generator) as usize);
        }
        order.truncate(wanted - drawn.len());
        drawn.append(&mut order);
    }
    drawn
}

/// Draws uniformly from 0 .. `end`: draws that would favour small numbers are drawn again.
fn below(end: u64, generator: &mut ChaCha8Rng) -> u64 {
    let fair = u64::MAX - u64::MAX % end;
    loop {
        let draw = generator.next_u64();
        if draw < fair {
            return draw % end;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_window_is_met_once_and_epochs_differ() {
        let first = order(1000, 7, 1);
        let mut sorted = first.clone();
        sorted.sort_unstable();
        assert_eq!(sorted, (0..1000).collect::<Vec<_>>());
        assert_eq!(first, order(1000, 7, 1));
        assert_ne!(first, order(1000, 7, 2));
        assert_ne!(first, order(1000, 8, 1));
        assert_eq!(order(0, 7, 1), Vec::<usize>::new());
        assert_eq!(order(1, 7, 1), [0]);
    }

    /// Oracle: three permutations of 4 hold each number three times; two more are different numbers.
    #[test]
    fn a_draw_uses_all_before_any_again() {
        let drawn = draw(4, 14, 7, 1);
        let times = |n: usize| drawn[..12].iter().filter(|one| **one == n).count();
        assert_eq!((0..4).map(times).collect::<Vec<_>>(), [3; 4]);
        assert!(drawn.len() == 14 && drawn[12] != drawn[13]);
        assert_eq!((draw(1000, 10, 7, 1), draw(0, 5, 7, 1)), (order(1000, 7, 1)[..10].to_vec(), vec![]));
    }

    /// Oracle: each of the 6 orders of 3 is due a sixth of the time; 6000 draws stray by less than 5 σ = 144.
    #[test]
    fn all_orders_are_equally_likely() {
        let mut counts = std::collections::BTreeMap::new();
        for epoch in 0..6000 {
            *counts.entry(order(3, 1, epoch)).or_insert(0i32) += 1;
        }
        assert_eq!(counts.len(), 6);
        assert!(counts.values().all(|count| (count - 1000).abs() < 144), "{counts:?}");
    }
}
