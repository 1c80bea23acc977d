//! Share of an effect, beyond a correction, that another effect explains.
//!
//! Every value to begin with is tried, with parameters that have a sign taken to first order around it; the best are refined.

use acm_core::effects::instance::Instance;
use acm_trace::fit::blocks::Blocks;
use acm_trace::fit::design::{carried, design, tangents};
use acm_trace::fit::gram::Grams;
use acm_trace::fit::problem::Problem;
use acm_trace::fit::refine::{project, refine};
use acm_trace::fit::state::{Placed, State};
use nalgebra::DMatrix;

/// Largest number of initial guesses.
const GUESSES: usize = 8;

/// Share explained to first order below which an effect is not refined.
const WORTH_REFINING: f64 = 0.3;

/// Number of initial guesses that are refined, and of steps of a refinement.
const REFINED: (usize, usize) = (2, 15);

/// Share of explanation that counts as complete.
const ENOUGH: f64 = 0.9995;

/// Share of the planted change below which the correction has absorbed it, and nothing is left to explain.
const TAKEN_UP: f64 = 1e-3;

/// A planted effect: trials, and the best fit by the correction alone.
pub struct Planted<'a> {
    problem: Problem<'a>,
    bare: State,
    beta: DMatrix<f64>,
    left: f64,
}

impl<'a> Planted<'a> {
    /// Prepares a case. `change` is the sum of squares of the effect's change of the weighted outputs. None where the
    /// correction absorbs it.
    pub fn new(problem: Problem<'a>, bare: State, change: f64) -> Option<Self> {
        let fitted = project(&problem, &bare)?;
        let (beta, left) = (fitted.beta, fitted.residual.norm_squared());
        (left > TAKEN_UP * change).then_some(Self { problem, bare, beta, left })
    }

    /// Returns the share that an effect explains with its values free and the correction fitted again.
    pub fn explained_by(&self, instance: &Instance) -> f64 {
        let guesses = instance.initial_guesses(self.problem.rig);
        let stride = guesses.len().div_ceil(GUESSES).max(1);
        let mut tried: Vec<(f64, State)> = guesses
            .into_iter()
            .step_by(stride)
            .map(|theta| self.bare.with(Placed { instance: instance.clone(), theta, in_calibration: true }))
            .filter_map(|state| Some((self.first_order(&state)?, state)))
            .collect();
        tried.sort_by(|one, other| one.0.total_cmp(&other.0));
        let Some((least, _)) = tried.first() else { return 0.0 };
        if self.share(*least) < WORTH_REFINING {
            return self.share(*least);
        }
        let mut best = 0.0_f64;
        for (_, state) in tried.iter().take(REFINED.0) {
            let refined = refine(&self.problem, state, REFINED.1);
            let left = project(&self.problem, &refined).map_or(self.left, |fitted| fitted.residual.norm_squared());
            best = best.max(self.share(left));
            if best > ENOUGH {
                break;
            }
        }
        best
    }

    fn share(&self, left: f64) -> f64 {
        (1.0 - left / self.left).clamp(0.0, 1.0)
    }

    /// Returns the sum of squares that is left with the effect at these values, its signed ones to first order.
    fn first_order(&self, state: &State) -> Option<f64> {
        let mut regression = design(&self.problem, state);
        let (beta, _) = carried(&self.problem, &self.bare, state, &regression, &self.beta);
        regression.coupled = tangents(&self.problem, state, 0, &regression, &beta);
        let rows = regression.x.nrows();
        let whole = Blocks::whole(rows);
        let solved = Grams::new(&regression, &whole).solve(self.bare.form.ridge)?;
        let mut left = regression.y.clone();
        if !solved.beta.is_empty() {
            left -= &regression.x * &solved.beta;
        }
        regression.coupled.iter().zip(solved.alpha.iter()).for_each(|(z, alpha)| left -= z * *alpha);
        let sum = left.norm_squared();
        sum.is_finite().then_some(sum)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use acm_core::effects::{Carrier, find};
    use acm_core::record::Record;
    use acm_core::rig::{Rig, Signal};
    use acm_trace::case::Trial;
    use acm_trace::fit::form::Form;
    use acm_trace::series::{Series, number_blocks};

    /// Time by which the output is late, s.
    const LATE: f64 = 0.5;

    /// Returns one actuator that moves with these angular frequencies, and an output that follows it late, without
    /// noise.
    fn late(frequencies: &[f64]) -> (Rig, Vec<Series>) {
        let time: Vec<f64> = (0..6000).map(|k| 0.02 * f64::from(k)).collect();
        let course = |late: f64| -> Vec<f64> {
            time.iter().map(|t| frequencies.iter().map(|w| (w * (t - late)).sin()).sum()).collect()
        };
        let signal = |name: &str| Signal { name: name.into(), unit: "m".into(), low: -1.0, high: 1.0 };
        let rig = Rig {
            actuators: vec![signal("q")],
            contexts: vec![],
            outputs: vec![signal("y")],
            throttle: None,
            altitude: None,
            payload: None,
            carried: false,
            arm: None,
            step: 0.02,
            duration: 120.0,
        };
        let measured = DMatrix::from_column_slice(time.len(), 1, &course(LATE));
        let record = Record::new(time.clone(), vec![course(0.0)], vec![], vec![]);
        let trial = Trial { name: "1".into(), record, lead: None, measured, predicted: None, offset: None };
        let mut series = vec![Series::new(&trial, 3)];
        number_blocks(&mut series);
        (rig, series)
    }

    /// Returns the share of the delay that a first-order lag explains behind a free slope.
    fn by_lag(frequencies: &[f64]) -> f64 {
        let (rig, series) = late(frequencies);
        let problem = Problem::new(&rig, &series, &[1.0], None);
        let lag = Instance::new(find("actuator_lag").expect("in the library"), Carrier::Rig, &rig);
        let planted = Planted::new(problem, State::bare(Form::LINEAR), 1.0).expect("a slope does not take it up");
        planted.explained_by(&lag)
    }

    /// Computes that share by phasors: e^{−iωd} is the target, g/(1 + iωτ) what a lag can do, g what a slope can.
    fn by_hand(frequencies: &[f64]) -> f64 {
        let left = |tau: f64| {
            let phasor = |w: &f64| {
                let size = 1.0 / (1.0 + (w * tau).powi(2));
                ((w * LATE).cos(), -(w * LATE).sin(), size, -w * tau * size)
            };
            let all: Vec<(f64, f64, f64, f64)> = frequencies.iter().map(phasor).collect();
            let along: f64 = all.iter().map(|(a, b, c, d)| a * c + b * d).sum();
            let own: f64 = all.iter().map(|(_, _, c, d)| c * c + d * d).sum();
            frequencies.len() as f64 - along * along / own
        };
        let best = (0..4000).map(|k| left(1e-3 * f64::from(k))).fold(f64::INFINITY, f64::min);
        1.0 - best / left(0.0)
    }

    /// Oracle: a sine has one phase and one amplitude, so that a lag behind a free slope is any delay; two have not, and the share
    /// follows from their phasors.
    #[test]
    fn a_lag_explains_a_delay_of_one_frequency_and_not_of_two() {
        assert!(by_lag(&[1.0]) > 0.998, "{}", by_lag(&[1.0]));
        for frequencies in [[1.0, 2.0], [1.0, 4.0]] {
            let (found, wanted) = (by_lag(&frequencies), by_hand(&frequencies));
            assert!((found - wanted).abs() < 0.015 && wanted < 0.98, "{frequencies:?}: {found} and {wanted}");
        }
    }

    /// Oracle: what a slope takes up leaves nothing to be explained.
    #[test]
    fn what_the_correction_takes_up_is_not_asked() {
        let (rig, mut series) = late(&[1.0]);
        for series in &mut series {
            series.measured = series.thin.actuators[0].iter().map(|q| 3.0 * q).collect();
        }
        let problem = Problem::new(&rig, &series, &[1.0], None);
        assert!(Planted::new(problem, State::bare(Form::LINEAR), 1.0).is_none());
    }
}
