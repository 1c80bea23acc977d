//! Criteria of the search.

/// Criteria for accepting an effect.
#[derive(Debug, Clone, PartialEq)]
pub struct Criteria {
    /// Largest number of effects.
    pub max_effects: usize,
    /// Smallest fall of the logarithm of the cross-validated mean square that an effect has to reach: 5 % of the error.
    pub price: f64,
    /// Price of a form that fits almost anything, in prices.
    pub generic: f64,
    /// Price of a dependence on a signal, in prices.
    pub context: f64,
    /// Price of a rare effect where a common one does as well, in prices.
    pub rare: f64,
    /// Price of each parameter after the first, in prices.
    pub parameter: f64,
    /// Price of a minor effect, which is in the model and not named, in prices.
    pub minor: f64,
    /// Constant ε: an error below a hundredth of the first one is negligible.
    pub negligible: f64,
    /// Probability of so large a mean gain over blocks where there is none.
    pub level: f64,
    /// The same for a gain that is far above chance.
    pub few: f64,
    /// Number of largest chance gains, one after another, that a gain far above chance exceeds.
    pub clear: f64,
    /// Probability that any candidate is accepted where none acts.
    pub family_wise: f64,
    /// Number of surrogates that the quantile of the largest gain is taken from.
    pub surrogates: usize,
    /// Number of sets that the search continues from at each step.
    pub beam: usize,
    /// Largest excess of J over the best J for the search to continue from a set.
    pub behind: f64,
    /// Largest multiple of the error without effects by which one of them may move the outputs.
    pub cancelled: f64,
    /// Number of candidates that are refined at each step.
    pub refined: usize,
    /// Relative improvement that a larger degree needs.
    pub degree_share: f64,
    /// Number of resamples of the blocks for the confidence.
    pub resamples: usize,
    /// Share of resamples in which a sure effect is chosen again.
    pub sure: f64,
    /// Share of resamples in which a likely effect is chosen again.
    pub likely: f64,
    /// Largest multiple of the error without effects by which one of several may move the outputs and be sure.
    pub taken_back: f64,
    /// Largest ratio of what a sure effect may still predict in the residual to what it removes (root mean squares), for each effect of
    /// the model and once more.
    pub followed: f64,
}

impl Default for Criteria {
    fn default() -> Self {
        Self {
            max_effects: 8,
            price: 0.10,
            generic: 1.5,
            context: 0.5,
            rare: 0.5,
            parameter: 0.1,
            minor: 0.3,
            negligible: 1e-4,
            level: 0.01,
            few: 0.05,
            clear: 3.0,
            family_wise: 0.01,
            surrogates: 24,
            beam: 3,
            behind: 2.5,
            cancelled: 5.0,
            refined: 5,
            degree_share: 0.005,
            resamples: 200,
            sure: 0.95,
            likely: 0.5,
            taken_back: 3.16,
            followed: 0.03,
        }
    }
}
