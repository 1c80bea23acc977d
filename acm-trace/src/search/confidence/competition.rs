//! Competition of candidates for one place by their losses on blocks: how often each wins where blocks are resampled, and which are equal.

use acm_core::effects::find;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use crate::search::accept::paired_t;
use crate::search::scan::Losses;
use crate::search::scored::LEAST_FALL;
use crate::search::select::Search;
use crate::search::tried::effect_of;

/// A candidate: its label, its losses on blocks left out, and the price of its set.
pub type Competing<'l> = (String, &'l Losses, f64);

/// Smallest share that is reported.
const LEAST: f64 = 0.05;

/// Returns the share of the resamples of blocks in which each candidate has the smallest J, the largest first.
pub fn resampled(search: &Search, competing: &[Competing]) -> Vec<(String, f64)> {
    let blocks = competing[0].1.len();
    let mut random = ChaCha8Rng::seed_from_u64(search.seed);
    let mut wins = vec![0usize; competing.len()];
    for _ in 0..search.criteria.resamples {
        let drawn: Vec<usize> = (0..blocks).map(|_| random.random_range(0..blocks)).collect();
        let score =
            |(_, losses, price): &Competing| search.log_error(drawn.iter().map(|&b| losses[b]).sum::<f64>()) + price;
        let scores: Vec<f64> = competing.iter().map(score).collect();
        let best = (0..scores.len()).min_by(|&a, &b| scores[a].total_cmp(&scores[b])).unwrap_or(0);
        wins[best] += 1;
    }
    let share = |wins: usize| wins as f64 / search.criteria.resamples as f64;
    let mut all: Vec<(String, f64)> = Vec::new();
    for (one, wins) in competing.iter().zip(wins) {
        match all.iter_mut().find(|(label, _)| *label == one.0) {
            Some(same) => same.1 += share(wins),
            None => all.push((one.0.clone(), share(wins))),
        }
    }
    all.retain(|(_, share)| *share >= LEAST);
    all.sort_by(|a, b| b.1.total_cmp(&a.1));
    all
}

/// Returns the candidates whose mean loss is within one paired standard error of the best, or so little above it that the search would not
/// exchange one for the other. A refinement is an equal only where the simpler effect is, too: else only its further parameters make it
/// one.
pub fn equal(competing: &[Competing]) -> Vec<usize> {
    let total = |losses: &Losses| losses.iter().sum::<f64>();
    let Some(best) = competing.iter().min_by(|a, b| total(a.1).total_cmp(&total(b.1))) else { return vec![] };
    let alike = |losses: &Losses| paired_t(losses, best.1) <= 1.0 || (total(losses) / total(best.1)).ln() < LEAST_FALL;
    let close: Vec<usize> =
        (0..competing.len()).filter(|&i| !competing[i].0.is_empty() && alike(competing[i].1)).collect();
    let name = |i: usize| effect_of(&competing[i].0);
    let simple = |i: usize| find(name(i)).and_then(|effect| effect.traits().refines);
    let own = competing.iter().rposition(|(label, ..)| !label.is_empty());
    let is_equal =
        |&i: &usize| Some(i) == own || simple(i).is_none_or(|simple| close.iter().any(|&other| name(other) == simple));
    close.iter().copied().filter(is_equal).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: by hand. A candidate that is worse by the same 0.4 % in every block is so by many standard errors, and by less than
    /// an exchange needs; 0.6 % is more. One that is worse in some blocks and better in others is within one standard error.
    #[test]
    fn what_the_search_would_not_exchange_is_equally_good() {
        let blocks = |of: fn(usize) -> f64| (0..12).map(of).collect::<Vec<f64>>();
        let best = blocks(|b| 100.0 + b as f64);
        let alike = blocks(|b| 1.004 * (100.0 + b as f64));
        let worse = blocks(|b| 1.006 * (100.0 + b as f64));
        let uncertain = blocks(|b| (100.0 + b as f64) * if b % 2 == 0 { 1.2 } else { 0.82 });
        let competing =
            [("best", &best), ("alike", &alike), ("worse", &worse), ("uncertain", &uncertain), ("", &alike)];
        let competing = competing.map(|(label, losses)| (label.to_string(), losses, 0.1));
        assert_eq!(equal(&competing), [0, 1, 3]);
    }

    /// Oracle: by hand. A hardening spring equals a delay by its further parameters where an oscillator without them does not.
    #[test]
    fn a_refinement_is_an_equal_where_what_it_refines_is_one() {
        let blocks = |size: f64| (0..12).map(|b| size + f64::from(b)).collect::<Vec<f64>>();
        let (best, worse) = (blocks(100.0), blocks(110.0));
        let of = |oscillator| {
            let all = [("nonlinear_stiffness", &best), ("second_order_lag", oscillator), ("dead_time", &best)];
            equal(&all.map(|(label, losses)| (label.to_string(), losses, 0.1)))
        };
        assert_eq!((of(&worse), of(&best)), (vec![2], vec![0, 1, 2]));
    }
}
