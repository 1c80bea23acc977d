//! Every constant of the search.

/// When an effect counts.
#[derive(Debug, Clone, PartialEq)]
pub struct Criteria {
    /// Effects at most.
    pub max_effects: usize,
    /// ln of the cross-validated mean square that an effect has to take away: 5 % of the error.
    pub price: f64,
    /// Price of a form that fits almost anything, in prices.
    pub generic: f64,
    /// Price of a dependence on a signal, in prices.
    pub context: f64,
    /// Price of what is rare where a common effect does as well, in prices.
    pub rare: f64,
    /// Price of each parameter after the first, in prices.
    pub parameter: f64,
    /// ε: an error below a hundredth of the first one hardly counts.
    pub negligible: f64,
    /// Probability of so large a mean gain over blocks where there is none.
    pub level: f64,
    /// Probability that any candidate is accepted where none acts.
    pub family_wise: f64,
    /// Surrogates that the quantile of the largest gain is taken from.
    pub surrogates: usize,
    /// Sets that the search goes on from at each step.
    pub beam: usize,
    /// How much larger than the best J may be for the search to go on from a set.
    pub behind: f64,
    /// Times the error without effects that one of them may move the outputs by.
    pub cancelled: f64,
    /// Candidates that are refined at each step.
    pub refined: usize,
    /// Share by which a larger degree has to predict better.
    pub degree_share: f64,
    /// Resamples of the blocks for the confidence.
    pub resamples: usize,
    /// Share of resamples in which a sure effect is chosen again.
    pub sure: f64,
    /// The same of a likely effect.
    pub likely: f64,
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
            negligible: 1e-4,
            level: 0.01,
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
        }
    }
}
