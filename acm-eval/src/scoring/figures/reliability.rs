//! Calibration of the shares: claims binned by share, against the fraction that is right.
//!
//! ```text
//! Wilson, 95 %:   (p + z²/2n ± z √(p(1 − p)/n + z²/4n²)) / (1 + z²/n),   z = 1.96
//! ```
//!
//! DeGroot & Fienberg (1983), The Statistician 32; Wilson (1927), JASA 22(158).

use std::collections::BTreeMap;

use acm_trace::finding::Doubt;
use serde::Serialize;

use crate::scoring::answer::{Answer, rights};
use crate::scoring::share::{Share, mean};

/// Edges of the bins of shares.
const BINS: [f64; 6] = [0.0, 0.5, 0.7, 0.85, 0.95, 1.0];

/// Claims whose share lies in a bin.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Bin {
    /// Lower end of the bin; the last bin holds its upper end.
    pub from: f64,
    /// Number of claims that are right, of all.
    pub right: Share,
    /// Mean share of the claims.
    pub mean: Option<f64>,
    /// Interval of 95 % of the fraction that is right.
    pub interval: Option<[f64; 2]>,
}

/// Sorts the claims of all answers, sure or not, into bins.
pub fn reliability(answers: &[Answer]) -> Vec<Bin> {
    let of = |answer: &Answer| answer.claims.iter().map(|claim| claim.share).zip(rights(answer)).collect::<Vec<_>>();
    let claims: Vec<(f64, bool)> = answers.iter().flat_map(of).collect();
    let last = BINS[BINS.len() - 1];
    let bin = |edges: &[f64]| {
        let inside = |share: f64| edges[0] <= share && (share < edges[1] || (edges[1] == last && share <= last));
        let held: Vec<(f64, bool)> = claims.iter().copied().filter(|(share, _)| inside(*share)).collect();
        let right = Share::of(&held, |(_, right)| *right);
        let mean = mean(&held.iter().map(|(share, _)| *share).collect::<Vec<f64>>());
        Bin { from: edges[0], right, mean, interval: wilson(right) }
    };
    BINS.windows(2).map(bin).collect()
}

/// Returns what the doubts cost: of the claims in the last bin that are not sure, those that are right, by each reason.
pub fn doubted(answers: &[Answer]) -> BTreeMap<Doubt, Share> {
    let mut by_doubt = BTreeMap::<Doubt, Share>::new();
    for answer in answers {
        for (claim, right) in answer.claims.iter().zip(rights(answer)) {
            let is_chosen = claim.share >= BINS[BINS.len() - 2];
            for doubt in claim.doubts.iter().filter(|_| is_chosen && !claim.sure) {
                let share = by_doubt.entry(*doubt).or_default();
                share.of += 1;
                share.count += usize::from(right);
            }
        }
    }
    by_doubt
}

/// Standard normal quantile of 97.5 %.
const Z: f64 = 1.959_964;

/// Computes the 95 % interval of a fraction; none without claims.
pub fn wilson(share: Share) -> Option<[f64; 2]> {
    let n = share.of as f64;
    let p = share.count as f64 / n;
    let middle = p + Z * Z / (2.0 * n);
    let reach = Z * (p * (1.0 - p) / n + Z * Z / (4.0 * n * n)).sqrt();
    (share.of > 0).then(|| [middle - reach, middle + reach].map(|end| (end / (1.0 + Z * Z / n)).clamp(0.0, 1.0)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scoring::answer::{answer, cause, claim};

    /// Oracle: by hand. A claim in two doubts counts for each, one that is rarely chosen for none.
    #[test]
    fn doubts_are_held_against_the_truth() {
        let doubted_claim = |name: &str, share: f64, doubts: &[Doubt]| {
            let mut claim = claim(name, None, false, share);
            claim.doubts = doubts.to_vec();
            claim
        };
        let claims = vec![
            doubted_claim("creep", 0.97, &[Doubt::Equivalent, Doubt::AtBound]),
            doubted_claim("dead_time", 1.0, &[Doubt::Equivalent]),
            doubted_claim("scale", 0.6, &[Doubt::Equivalent]),
        ];
        let found = doubted(&[answer("several2", vec![cause("creep", None, &[], true)], claims)]);
        let expected = [(Doubt::Equivalent, Share { count: 1, of: 2 }), (Doubt::AtBound, Share { count: 1, of: 1 })];
        assert_eq!(found, BTreeMap::from(expected));
    }

    /// Oracle: Agresti & Coull (1998), The American Statistician 52(2): no success in ten gives (0, 0.278); and the interval of 8 in
    /// 10 as statsmodels gives it.
    #[test]
    fn wilson_intervals() {
        let near = |share: Share, wanted: [f64; 2]| {
            let found = wilson(share).expect("there are some");
            assert!(found.iter().zip(wanted).all(|(a, b)| (a - b).abs() < 1e-3), "{found:?}");
        };
        near(Share { count: 0, of: 10 }, [0.0, 0.2775]);
        near(Share { count: 8, of: 10 }, [0.4902, 0.9433]);
        assert_eq!(wilson(Share::default()), None);
    }
}
