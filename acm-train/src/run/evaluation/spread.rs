//! Mean and standard deviation over repeated runs (seeds or folds).
//!
//! ```text
//! mean = Σ v / n          sd = √( Σ (v − mean)² / (n − 1) )
//! ```
//!
//! The divisor is n − 1: the seeds are a sample of the seeds that could have been drawn. One value has no spread.

use acm_core::display::with_spread;

/// Mean ± sample standard deviation, in the unit of the values.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spread {
    /// Arithmetic mean.
    pub mean: f64,
    /// Sample standard deviation; `None` for a single value.
    pub sd: Option<f64>,
}

impl Spread {
    /// Returns the mean and sample standard deviation of `values`; `None` where there are none.
    pub fn of(values: &[f64]) -> Option<Self> {
        let n = values.len() as f64;
        let mean = values.iter().sum::<f64>() / n;
        match values {
            [] => None,
            [one] => Some(Self { mean: *one, sd: None }),
            _ => {
                let squares: f64 = values.iter().map(|v| (v - mean).powi(2)).sum();
                Some(Self { mean, sd: Some((squares / (n - 1.0)).sqrt()) })
            }
        }
    }

    /// Computes the spread as [`Spread::of`] does, for values that do not depend on the seed: equal values are one
    /// value without a spread.
    pub fn of_constant(values: &[f64]) -> Option<Self> {
        match values {
            [first, rest @ ..] if rest.iter().all(|v| v == first) => Self::of(&[*first]),
            _ => Self::of(values),
        }
    }

    /// Writes `29.5 ± 1.9`: as many digits as the spread supports, or three, in `factor` times the unit of the values.
    pub fn text(&self, factor: f64) -> String {
        with_spread(factor * self.mean, self.sd.map(|sd| factor.abs() * sd))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: hand arithmetic; 2, 4, 4, 4, 5, 5, 7, 9 has mean 5 and Σ(v − 5)² = 32, so sd = √(32/7).
    #[test]
    fn divides_by_one_less_than_the_count() {
        let spread = Spread::of(&[2.0, 4.0, 4.0, 4.0, 5.0, 5.0, 7.0, 9.0]).unwrap();
        assert_eq!(spread.mean, 5.0);
        assert!((spread.sd.unwrap() - (32.0_f64 / 7.0).sqrt()).abs() < 1e-15);
    }

    #[test]
    fn one_value_has_no_spread_and_none_has_no_mean() {
        assert_eq!(Spread::of(&[3.5]), Some(Spread { mean: 3.5, sd: None }));
        assert_eq!(Spread::of(&[]), None);
        assert_eq!(Spread::of_constant(&[0.1, 0.1, 0.1]), Some(Spread { mean: 0.1, sd: None }));
        assert_eq!(Spread::of_constant(&[1.0, 3.0]).unwrap().sd, Some(2.0_f64.sqrt()));
    }

    #[test]
    fn a_spread_is_written_where_there_is_one() {
        let text = |values: &[f64], factor: f64| Spread::of(values).unwrap().text(factor);
        assert_eq!(text(&[1.0, 2.0, 3.0], 1.0), "2.0 ± 1.0");
        assert_eq!(text(&[2.1e-4, 2.2e-4, 2.3e-4], 1e6), "220 ± 10");
        assert_eq!(text(&[2.5], 1.0), "2.50");
        assert_eq!(text(&[28.459999999999997, 28.46, 28.46], 1.0), "28.5");
    }
}
