//! Standard deviations of the oracle's estimates over redraws of the noise, the basis of the ideal interval width.
//!
//! ```text
//! s_j² = Σ_r (θ̂_jr − mean)² / (R − 1),   ideal 95 % width = 3.92 s_j
//! ```
//!
//! | symbol | meaning |
//! | `θ̂_r` | values of the true structure, fitted to the development trials with noise of encoders and output of draw r |
//! | `R`    | redraws |

use super::kind::Kind;
use super::oracle::{Oracle, fitted};
use super::record::Made;
use rayon::prelude::*;

/// Returns the standard deviation of each fitted value over `redraws` redraws, in the order of the plant's values.
pub fn deviations(kind: Kind, seed: u64, oracle: &Oracle, redraws: u64) -> Vec<f64> {
    let made = Made::new(kind, seed);
    let estimates: Vec<Vec<f64>> =
        (1..=redraws).into_par_iter().map(|redraw| fitted(&made.record(redraw), oracle.smoothing)).collect();
    (0..oracle.values.len()).map(|j| deviation(estimates.iter().map(|values| values[j]))).collect()
}

fn deviation(values: impl ExactSizeIterator<Item = f64> + Clone) -> f64 {
    let many = values.len() as f64;
    let mean = values.clone().sum::<f64>() / many;
    (values.map(|value| (value - mean).powi(2)).sum::<f64>() / (many - 1.0)).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: hand arithmetic, 1, 2 and 6 scatter by √7 about 3.
    #[test]
    fn scatter_by_hand() {
        assert!((deviation([1.0, 2.0, 6.0].into_iter()) - 7f64.sqrt()).abs() < 1e-12);
    }
}
