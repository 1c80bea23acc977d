//! Agreement of the model that is saved with the regression that it comes from.
//!
//! ```text
//! d² = Σ_s ‖r_saved − r_fit‖² / (n + Σ_s ‖r_fit‖²)
//! ```
//!
//! | symbol    | meaning                                                                                     | shape |
//! | `r_fit`   | residual of the regression at the compared samples of development trial s                    | N × M |
//! | `r_saved` | residual of the model, without the initial state and the offset that the regression takes out | N × M |
//! | `n`       | sum of squares that hardly counts                                                            |       |
//!
//! The regression is linear in the nominal map and in the sizes of effects. In the model, frame and output effects act on that map too:
//! the two part where a large map cancels a large effect.

use crate::assemble::Assembled;
use crate::fit::problem::Problem;
use crate::fit::projected::project;
use crate::fit::state::State;
use crate::fit::unrecorded::Unrecorded;

/// Largest d. The model's error is then at most 5 % above that of the regression, √(1 + d²): the smallest change that counts
/// ([`Criteria::price`](crate::search::criteria::Criteria::price)).
const MOST: f64 = 0.32;

/// Returns whether the model of a state predicts the development trials as the regression does.
pub fn agrees(problem: &Problem, state: &State, negligible: f64) -> bool {
    difference(problem, state, negligible).is_some_and(|difference| difference <= MOST)
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

    /// Oracle: by hand. The prediction q of three coordinates came with the data, and 3 q was measured. The regression corrects
    /// (1 + s) q by (2 − s) q and leaves nothing; the model scales the corrected prediction, (1 + s)(3 − s) q, and leaves (s² − 2 s) q.
    #[test]
    fn a_scale_that_the_map_cancels_does_not_agree() {
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
        let squares = given.norm_squared();
        let of = |scale: f64| {
            let effect = bench::placed("scale", Carrier::Rig, &rig, &[scale]);
            let form = Form { degree: Some(1), ridge: 0.0 };
            difference(&problem, &State { effects: vec![Arc::new(effect)], ..State::bare(form) }, squares).unwrap()
        };
        for scale in [-0.4_f64, 0.01] {
            let expected = (scale * scale - 2.0 * scale).abs();
            assert!((of(scale) - expected).abs() < 1e-6, "{scale}: {} {expected}", of(scale));
        }
    }
}
