//! Bars: share of the residual's variance that is explained, by coordinate.

use acm_train::run::record::Score;

use super::{Drawing, rmse::bars};
use crate::section::Section;
use crate::section::estimator::Estimator;

/// Caption title.
pub const QUESTION: &str = "How much of what the nominal model misses is explained?";

/// Draws one group of bars per coordinate, one bar per network.
pub fn draw(section: &Section) -> Option<Drawing> {
    let shown: Vec<&Estimator> = section.networks().filter(|e| section.held_out(e).next().is_some()).collect();
    let bar = |estimator: &Estimator, output: usize| {
        estimator.spread(&section.held_out(estimator).map(|score: &Score| score.r2[output]).collect::<Vec<_>>())
    };
    let explanation = "R² = 1 − Σe² / Σ(r − r̄)² on the held-out trials, with r = measured − nominal. 1: all of the \
                       residual is explained; 0: no better than adding its mean; below 0: worse than that. Whiskers: ± \
                       one sample standard deviation over seeds."
        .to_string();
    bars(section, &shown, &section.outputs, bar, "R² of the residual", explanation)
}
