//! Agreement of the saved model with the regression it comes from.
//!
//! ```text
//! d² = Σ_s ‖r_saved − r_fit‖² / (n + Σ_s ‖r_fit‖²)
//! ```
//!
//! | symbol    | meaning                                                                                     | shape |
//! | `r_fit`   | residual of the regression at the compared samples of development trial s                    | N × M |
//! | `r_saved` | residual of the model, without the initial state and the offset that the regression takes out | N × M |
//! | `n`       | negligible sum of squares                                                                    |       |
//!
//! The regression is linear in the nominal map and in the sizes of effects. In the model, frame and output effects also act on that map.
//! The two differ where a large map cancels a large effect.

use crate::assemble::Assembled;
use crate::fit::problem::Problem;
use crate::fit::projected::project;
use crate::fit::state::State;
use crate::fit::unrecorded::Unrecorded;

/// Largest d where model and regression agree: the model's error is at most 5 % above that of the regression, √(1 + d²). It is the
/// smallest change that counts ([`Criteria::price`](crate::search::criteria::Criteria::price)).
const MOST: f64 = 0.32;

/// Returns whether the model of a state predicts the development trials as the regression does.
pub fn agrees(problem: &Problem, state: &State, negligible: f64) -> bool {
    difference(problem, state, negligible).is_some_and(|difference| difference <= MOST)
}

/// Returns ln(1 + d²), by which the logarithm of the model's mean square exceeds that of the regression; infinite where the regression
/// is singular.
pub fn excess(problem: &Problem, state: &State, negligible: f64) -> f64 {
    difference(problem, state, negligible).map_or(f64::INFINITY, |difference| difference.powi(2).ln_1p())
}

/// Returns d; none where the regression is singular.
fn difference(problem: &Problem, state: &State, negligible: f64) -> Option<f64> {
    let fitted = project(problem, state)?.residual;
    let model = Assembled::new(problem, state)?.model();
    let (mut first, mut apart, mut left) = (0, 0.0, 0.0);
    for (s, series) in problem.series.iter().enumerate() {
        let kept = &problem.kept[s];
        let rows = fitted.rows(first, kept.len());
        first += kept.len();
        if series.calibrates {
            continue;
        }
        let residual = problem.residual_of(&model, s);
        apart += (Unrecorded::new(problem, state, s).taken_out(residual) - rows).norm_squared();
        left += rows.norm_squared();
    }
    Some((apart / (left + negligible).max(f64::MIN_POSITIVE)).sqrt())
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use acm_core::effects::Carrier;
    use acm_core::polynomial::Polynomial;
    use acm_core::record::Record;
    use nalgebra::DMatrix;

    use super::*;
    use crate::fit::bench;
    use crate::fit::form::Form;
    use crate::fit::problem::Base;
    use crate::search::criteria::Criteria;
    use crate::search::select::Search;

    /// The prediction q of three coordinates came with the data, and 3 q was measured. The regression corrects (1 + s) q by (2 − s) q
    /// and leaves nothing; the model scales the corrected prediction, (1 + s)(3 − s) q, and leaves (s² − 2 s) q.
    fn with_scaled(test: impl Fn(&Problem, &dyn Fn(f64) -> State, f64)) {
        let rig = bench::rig(&["q"], &[], &["x", "y", "z"]);
        let q: Vec<f64> = bench::time().iter().map(|t| (1.3 * t).cos()).collect();
        let angle = DMatrix::from_column_slice(q.len(), 1, &q);
        let given = DMatrix::from_fn(q.len(), 3, |t, _| q[t]);
        let y: Vec<f64> = q.iter().flat_map(|q| [3.0 * q; 3]).collect();
        let mut series = [bench::series(Record::new(bench::time(), vec![q], vec![], vec![]), y)];
        series[0].predicted = Some(given.clone());
        let identity = Polynomial::fit(&angle, &given, 1).polynomial;
        let base = Base { stands_for: &identity, strain: None };
        let problem = Problem::new(&rig, &series, &[1.0; 3], Some(base));
        let of = |scale: f64| {
            let effect = bench::placed("scale", Carrier::Rig, &rig, &[scale]);
            let form = Form { ridge: 0.0, ..Form::LINEAR };
            State { effects: vec![Arc::new(effect)], ..State::bare(form) }
        };
        test(&problem, &of, given.norm_squared());
    }

    /// Oracle: by hand.
    #[test]
    fn a_scale_that_the_map_cancels_does_not_agree() {
        with_scaled(|problem, scaled, squares| {
            for scale in [-0.4_f64, 0.01] {
                let expected = (scale * scale - 2.0 * scale).abs();
                let difference = difference(problem, &scaled(scale), squares).unwrap();
                assert!((difference - expected).abs() < 1e-6, "{scale}: {difference} {expected}");
            }
        });
    }

    /// Oracle: by hand. With s = −0.4 d is 0.96, and J rises by ln(1 + 0.96²) = 0.653.
    #[test]
    fn a_gain_that_the_saved_model_loses_is_none() {
        with_scaled(|problem, scaled, squares| {
            let criteria = Criteria { negligible: 1.0, ..Criteria::default() };
            let mut search = Search::plain(problem, &[], &criteria);
            search.first = squares;
            let (scaled, bare) = (scaled(-0.4), State::bare(Form { ridge: 0.0, ..Form::LINEAR }));
            let is_better = |fall: f64| search.is_better_as_saved((-fall, &scaled), (0.0, &bare));
            assert_eq!([is_better(0.66), is_better(0.64)], [true, false]);
        });
    }
}
