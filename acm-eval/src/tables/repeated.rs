//! A value from repeated runs, and the test whether one is better than another.
//!
//! ```text
//! d_i = b_i − a_i over runs i of the same fold and seed          clear: 0 ∉ d̄ ± t₀.₉₇₅(n − 1) · sd(d) / √n
//! ```

use acm_train::schedule::study::paired::Difference;

use crate::spread::Spread;

/// Values of repeated runs; at least one.
#[derive(Debug, Clone, PartialEq)]
pub struct Repeated {
    /// Name of the run's record, which contains fold and seed, and its value.
    runs: Vec<(String, f64)>,
}

impl Repeated {
    /// Returns the value with its spread over runs; `None` where there are no runs.
    pub fn of(runs: Vec<(String, f64)>) -> Option<Self> {
        (!runs.is_empty()).then_some(Self { runs })
    }

    /// Returns the mean ± sd; equal values are one value without a spread, as those of a model that no seed changes.
    pub fn spread(&self) -> Spread {
        let values: Vec<f64> = self.runs.iter().map(|(_, value)| *value).collect();
        Spread::of_constant(&values).unwrap_or(Spread { mean: f64::NAN, sd: None })
    }

    /// Returns whether the 95 % interval of the differences to `other`, in pairs of runs, excludes zero. One run has no
    /// interval.
    pub fn is_clear_of(&self, other: &Self) -> bool {
        Difference::of(&self.pairs(other)).is_some_and(|difference| difference.is_clear())
    }

    /// Returns the values of runs of the same name; a model with one value for all runs is paired with each run of the
    /// other.
    fn pairs(&self, other: &Self) -> Vec<(f64, f64)> {
        let constant = |of: &Self| of.spread().sd.is_none().then_some(of.runs[0].1);
        match (constant(self), constant(other)) {
            // No seed changes either, so there is no interval.
            (Some(_), Some(_)) => vec![],
            (_, Some(theirs)) => self.runs.iter().map(|(_, own)| (*own, theirs)).collect(),
            (Some(own), None) => other.runs.iter().map(|(_, theirs)| (own, *theirs)).collect(),
            (None, None) => {
                let of = |name: &str| other.runs.iter().find(|(known, _)| known == name).map(|(_, value)| *value);
                self.runs.iter().filter_map(|(name, own)| Some((*own, of(name)?))).collect()
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(values: &[f64]) -> Repeated {
        Repeated::of(values.iter().enumerate().map(|(k, value)| (format!("final-seed{k}"), *value)).collect()).unwrap()
    }

    /// Oracle: by hand. Differences 1, 1.2, 0.8 have mean 1 and sd 0.2; t₀.₉₇₅(2) = 4.303, so the interval is 1 ± 0.497.
    /// Differences 1, 3, −1 have mean 1 and sd 2: 1 ± 4.97.
    #[test]
    fn pairs_decide_and_not_the_spread_over_seeds() {
        let own = of(&[10.0, 20.0, 30.0]);
        assert!(own.is_clear_of(&of(&[11.0, 21.2, 30.8])));
        assert!(!own.is_clear_of(&of(&[11.0, 23.0, 29.0])));
    }

    #[test]
    fn one_run_decides_nothing_and_a_constant_is_paired_with_each_seed() {
        assert!(!of(&[1.0]).is_clear_of(&of(&[2.0])));
        assert!(of(&[1.0, 1.1, 0.9]).is_clear_of(&of(&[2.0, 2.0, 2.0])));
        assert!(of(&[2.0, 2.0, 2.0]).is_clear_of(&of(&[1.0, 1.1, 0.9])));
        assert!(of(&[1.0, 1.1, 0.9]).is_clear_of(&of(&[2.0])));
        assert!(!of(&[1.0, 5.0, 0.9]).is_clear_of(&of(&[2.0])));
        assert!(!of(&[1.0, 1.0, 1.0]).is_clear_of(&of(&[2.0, 2.0, 2.0])), "no seed changes either");
    }
}
