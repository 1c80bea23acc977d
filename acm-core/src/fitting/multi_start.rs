//! Multi-start: fits from several points, of which the best is kept.
//!
//! ```text
//! θ* = argmin_k ‖r(fit(θ_k))‖²,     θ_0 = centre,     θ_k ~ U(centre − spread, centre + spread)
//! ```

use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use rayon::prelude::*;

use crate::fitting::least_squares::Residuals;
use crate::fitting::levenberg_marquardt::{Bounds, Fit, Options, fit};

/// Returns the fit with the smallest sum of squares; the first of equals. `None` without a start.
pub fn multi_start(problem: &impl Residuals, starts: &[Vec<f64>], bounds: &Bounds, options: &Options) -> Option<Fit> {
    let fits: Vec<Fit> = starts.par_iter().map(|start| fit(problem, start, bounds, options)).collect();
    fits.into_iter().reduce(|best, next| if next.cost < best.cost { next } else { best })
}

/// Returns `centre` and `count − 1` points drawn uniformly from `centre ± spread`.
pub fn scattered_starts(centre: &[f64], spread: &[f64], count: usize, seed: u64) -> Vec<Vec<f64>> {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut starts = vec![centre.to_vec()];
    while starts.len() < count {
        let drawn = centre.iter().zip(spread).map(|(c, s)| c + s * random.random_range(-1.0..=1.0));
        starts.push(drawn.collect());
    }
    starts
}
