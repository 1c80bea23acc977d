//! Nonlinear parameters by variable projection: each evaluation solves for all linear parameters.
//!
//! ```text
//! min over u of ‖r(u)‖²
//! ```
//!
//! Coordinates u have no unit ([`coordinates`]), and r is the projected residual ([`residual`]). [`acm_core::levenberg_marquardt`] takes
//! no step that raises the sum of squares. Kaufman (1975), BIT 15.

use std::sync::Arc;

use acm_core::levenberg_marquardt::{Bounds, Options, minimiser};
use nalgebra::DMatrix;
use rayon::prelude::*;

use super::design::left;
use super::problem::Problem;
use super::state::{Placed, State};

mod coordinates;
mod residual;

use residual::ProjectedResidual;

pub use super::projected::{Projected, project};
pub(crate) use coordinates::{Coordinate, Place, places, put};

/// Factor on the steps with a resonance: its valley is narrow and curved.
const RINGING: usize = 4;

/// Initial radius of the trust region, in u.
const RADIUS: f64 = 0.7;

/// Relative fall of the sum of squares below which a fit ends.
const LEAST_FALL: f64 = 1e-4;

/// Returns the slopes of the outputs by the nonlinear parameters of a state, around coefficients β (p × M) of its
/// regression.
pub fn slopes(problem: &Problem, state: &State, beta: &DMatrix<f64>) -> Vec<DMatrix<f64>> {
    let coordinates: Vec<Coordinate> =
        places(state).into_iter().map(|place| Coordinate::new(problem, state, place)).collect();
    let here = left(problem, state, beta);
    let slope = |j: usize| {
        let coordinate = &coordinates[j];
        let mut u = vec![1.0; coordinates.len()];
        let step = coordinate.step_from(u[j]);
        u[j] += step;
        (&here - left(problem, &put(state, &coordinates, &u), beta)) / step
    };
    let all: Vec<DMatrix<f64>> = (0..coordinates.len()).into_par_iter().map(slope).collect();
    all.into_iter().filter(|z| z.iter().all(|z| z.is_finite()) && z.amax() > 0.0).collect()
}

/// Returns the largest number of steps of effects: [`RINGING`] times as many with a resonance.
pub fn steps(effects: &[Arc<Placed>], iterations: usize) -> usize {
    let rings = |placed: &Arc<Placed>| placed.instance.effect().traits().is_resonance;
    if effects.iter().any(rings) { RINGING * iterations } else { iterations }
}

/// Returns the state with its nonlinear parameters refined, `iterations` steps at most.
pub fn refine(problem: &Problem, state: &State, iterations: usize) -> State {
    let coordinates: Vec<Coordinate> =
        places(state).into_iter().map(|place| Coordinate::new(problem, state, place)).collect();
    if coordinates.is_empty() || iterations == 0 {
        return state.clone();
    }
    let Some(residual) = ProjectedResidual::new(problem, state, &coordinates) else { return state.clone() };
    let bounds = Bounds {
        lower: coordinates.iter().map(|c| c.bounds()[0]).collect(),
        upper: coordinates.iter().map(|c| c.bounds()[1]).collect(),
    };
    let options = Options { iterations, cost: LEAST_FALL, step: 1e-4, gradient: 1e-6, radius: RADIUS };
    let start = vec![1.0; coordinates.len()];
    put(state, &coordinates, &minimiser(&residual, &start, &bounds, &options))
}

#[cfg(test)]
mod tests {
    use acm_core::effects::Carrier;
    use acm_core::record::Record;
    use acm_core::rig::Rig;

    use super::*;
    use crate::fit::bench;
    use crate::fit::design::{design, keep};
    use crate::fit::form::Form;
    use crate::fit::state::Placed;
    use crate::series::Series;

    const OMEGA: f64 = 1.3;

    fn rig() -> Rig {
        bench::rig(&["q"], &[], &["y"])
    }

    /// Returns a calibration and a development trial of sin ωt, which count after 2 s.
    fn series() -> Vec<Series> {
        let q: Vec<f64> = bench::time().iter().map(|t| (OMEGA * t).sin()).collect();
        let late = bench::series(Record::new(bench::time(), vec![q.clone()], vec![], vec![]), q);
        let late = Series { counts: (0..2000).map(|k| k >= 200).collect(), ..late };
        vec![Series { calibrates: true, ..late.clone() }, late]
    }

    fn late(rig: &Rig, delay: f64, in_calibration: bool) -> State {
        let placed = bench::placed("dead_time", Carrier::Rig, rig, &[delay]);
        State::bare(Form::LINEAR).with(Placed { in_calibration, ..placed })
    }

    /// Oracle: d sin ω(t − Δ) / d ln Δ = −ωΔ cos ω(t − Δ); zero in the trial in which the delay does not act.
    #[test]
    fn slopes_are_those_of_the_formula() {
        let (rig, series) = (rig(), series());
        let problem = Problem::new(&rig, &series, &[1.0], None);
        let delay = 0.4;
        let beta = DMatrix::from_column_slice(2, 1, &[0.0, 1.0]);
        let slopes = slopes(&problem, &late(&rig, delay, false), &beta);
        assert_eq!(slopes.len(), 1);
        let (calibration, development) = slopes[0].as_slice().split_at(1800);
        assert!(calibration.iter().all(|slope| *slope == 0.0));
        for (k, slope) in development.iter().enumerate() {
            let t = 2.0 + 0.01 * k as f64;
            let truth = -OMEGA * delay * (OMEGA * (t - delay)).cos();
            assert!((slope - truth).abs() < 0.02, "{t}: {slope} and {truth}");
        }
    }

    /// Oracle: the same regression computed without a cache, bit for bit.
    #[test]
    fn what_is_kept_changes_nothing() {
        let (rig, series) = (rig(), series());
        for state in [late(&rig, 0.4, false), late(&rig, 0.4, true).rescoped(0), State::bare(Form::LINEAR)] {
            let afresh = design(&Problem::new(&rig, &series, &[1.0], None).with_offsets(0.3), &state);
            let problem = Problem::new(&rig, &series, &[1.0], None).with_offsets(0.3);
            keep(&problem, &state);
            let kept = design(&problem, &state);
            assert_eq!((kept.x, kept.y), (afresh.x, afresh.y));
        }
    }
}
