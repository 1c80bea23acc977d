//! Difference between two experiments, from paired runs.
//!
//! ```text
//! d_i = b_i − a_i           mean ± t₀.₉₇₅(n − 1) · sd(d) / √n
//! ```
//!
//! | symbol  | meaning                                                        |
//! | ------- | -------------------------------------------------------------- |
//! | a, b    | errors of both in runs of one fold and one seed                |
//! | t₀.₉₇₅  | 97.5 % quantile of Student's distribution (crate statrs)       |
//!
//! Pairs share trials and initial weights, so what these do to both errors falls out of the difference. The interval is for
//! further folds and seeds drawn as these were; folds of one campaign overlap in what they learn from, so that it is rather
//! too narrow than too wide.

use statrs::distribution::{ContinuousCDF, StudentsT};

use crate::run::evaluation::spread::Spread;

/// A mean difference with its 95 % interval, in the unit of the errors.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Difference {
    /// Mean of b − a.
    pub mean: f64,
    /// Half the width of the interval; `None` for a single pair.
    pub reach: Option<f64>,
    /// Number of pairs.
    pub pairs: usize,
}

impl Difference {
    /// Returns the paired difference over pairs (a, b); `None` without pairs.
    pub fn of(pairs: &[(f64, f64)]) -> Option<Self> {
        let differences: Vec<f64> = pairs.iter().map(|(a, b)| b - a).collect();
        let spread = Spread::of(&differences)?;
        let n = pairs.len() as f64;
        let reach = spread.sd.and_then(|sd| {
            let student = StudentsT::new(0.0, 1.0, n - 1.0).ok()?;
            Some(student.inverse_cdf(0.975) * sd / n.sqrt())
        });
        Some(Self { mean: spread.mean, reach, pairs: pairs.len() })
    }

    /// Returns whether the interval excludes zero.
    pub fn is_clear(&self) -> bool {
        self.reach.is_some_and(|reach| self.mean.abs() > reach)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: differences 1, 2, 3, 4, 5 have mean 3 and sd √2.5; t₀.₉₇₅ with 4 degrees of freedom is 2.776445 in tables.
    #[test]
    fn five_pairs_by_hand() {
        let pairs = [(1.0, 2.0), (1.0, 3.0), (1.0, 4.0), (1.0, 5.0), (1.0, 6.0)];
        let difference = Difference::of(&pairs).unwrap();
        assert_eq!((difference.mean, difference.pairs), (3.0, 5));
        assert!((difference.reach.unwrap() - 2.776_445 * 0.5_f64.sqrt()).abs() < 1e-5);
        assert!(difference.is_clear());
    }

    #[test]
    fn one_pair_has_no_interval() {
        assert_eq!(Difference::of(&[(2.0, 3.0)]), Some(Difference { mean: 1.0, reach: None, pairs: 1 }));
        assert_eq!(Difference::of(&[]), None);
        assert!(!Difference::of(&[(2.0, 3.0)]).unwrap().is_clear());
    }
}
