//! Choice among models from simple to flexible, by the errors on blocks of samples that each was fitted without.
//!
//! ```text
//! m* = min { m : mean_b(e_m,b − e_best,b) ≤ SE_b(e_m,b − e_best,b) }
//! ```
//!
//! | symbol | meaning                                                        | shape | unit |
//! | ------ | -------------------------------------------------------------- | ----- | ---- |
//! | `e`    | error of model m on block b; best is the model with the smallest mean | –     | any  |
//! | `SE`   | standard error of the mean over blocks                         | –     | of e |
//!
//! Source: Breiman et al. (1984), Classification and Regression Trees, 3.4.3.

/// Number of blocks.
pub const BLOCKS: usize = 5;

/// Returns the first model whose errors are larger than those of the best by no more than one standard error.
pub fn simplest(errors: &[Vec<f64>]) -> usize {
    let total = |model: &usize| errors[*model].iter().sum::<f64>();
    let best = (0..errors.len()).min_by(|a, b| total(a).total_cmp(&total(b))).unwrap_or(0);
    (0..best).find(|&model| is_as_good(&errors[model], &errors[best])).unwrap_or(best)
}

fn is_as_good(errors: &[f64], best: &[f64]) -> bool {
    let differences: Vec<f64> = errors.iter().zip(best).map(|(e, b)| e - b).collect();
    let count = differences.len() as f64;
    let mean = differences.iter().sum::<f64>() / count;
    let variance = differences.iter().map(|d| (d - mean).powi(2)).sum::<f64>() / (count - 1.0);
    mean <= (variance / count).sqrt()
}

#[cfg(test)]
mod tests {
    use super::simplest;

    /// Oracle: by hand. Differences of 1, 3, 2 have mean 2 and standard error 0.577; those of −1, 3, 1 mean 1 and 1.155.
    #[test]
    fn a_simpler_model_within_one_standard_error_is_taken() {
        assert_eq!(simplest(&[vec![2.0, 4.0, 3.0], vec![1.0, 1.0, 1.0]]), 1);
        assert_eq!(simplest(&[vec![0.0, 4.0, 2.0], vec![1.0, 1.0, 1.0]]), 0);
        assert_eq!(simplest(&[vec![1.0, 1.0], vec![1.0, 1.0]]), 0);
    }
}
