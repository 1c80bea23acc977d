//! Actuator history of a trial, estimated from the trial.
//!
//! The history is one value of each actuator. It is accepted where n ln(S₀/S) exceeds ln n for each value, with n samples and residual
//! sums of squares S₀ without it and S with it. Schwarz (1978), Annals of Statistics 6(2).

use std::ops::Range;

use acm_core::augmented::AugmentedModel;
use acm_core::least_squares::Residuals;
use acm_core::levenberg_marquardt::{Bounds, Options, minimiser};
use acm_core::record::Record;
use nalgebra::DMatrix;
use rayon::prelude::*;

use super::{Unrecorded, fading, projection};
use crate::fit::problem::Problem;
use crate::fit::state::State;
use crate::series::before::Before;

/// Form of a history with a value of each actuator.
pub type Form = fn(Vec<f64>) -> Before;

/// Samples of one trial for estimating its history.
pub struct Past<'a> {
    /// Model with effects.
    pub model: &'a AugmentedModel,
    /// Signals from the first sample on.
    pub record: &'a Record,
    /// Whether the record has inter-sample values of actuators.
    pub is_held: bool,
    /// Rows of the record in use.
    pub rows: Vec<usize>,
    /// What was measured at these rows, [N×M].
    pub measured: DMatrix<f64>,
    /// Weight of each output.
    pub weight: &'a [f64],
    /// Projection L⁻¹Hᵀ that removes decaying modes ([`projection`]).
    pub forgotten: Option<DMatrix<f64>>,
}

/// Finite-difference step, as a share of an actuator's range.
const STEP: f64 = 1e-3;

/// Most iterations.
const ITERATIONS: usize = 20;

/// Initial values, in ranges from the middle of the recorded one.
const PLACES: [f64; 6] = [-1.5, -0.5, -0.25, 0.25, 0.5, 1.5];

impl Past<'_> {
    /// Returns the best history, with values within a range beyond the recorded one.
    pub fn best(&self, form: Form) -> Before {
        let actuators = &self.model.rig().actuators;
        let (lower, upper) = actuators.iter().map(|q| (q.low - q.span(), q.high + q.span())).unzip();
        let mut start: Vec<f64> = self.record.actuators.iter().map(|q| q[0]).collect();
        let mut least = self.left_behind(&form(start.clone()));
        for (a, q) in actuators.iter().enumerate() {
            for place in PLACES {
                let mut other = start.clone();
                other[a] = 0.5 * (q.low + q.high) + place * q.span();
                let left = self.left_behind(&form(other.clone()));
                if left < least {
                    (start, least) = (other, left);
                }
            }
        }
        let options = Options { iterations: ITERATIONS, ..Options::default() };
        form(minimiser(&Sought { past: self, form }, &start, &Bounds { lower, upper }, &options))
    }

    /// Returns the sum of squares with a history.
    pub fn left_behind(&self, before: &Before) -> f64 {
        self.residual_behind(before).norm_squared()
    }

    /// Returns the sum of squares without a history.
    pub fn left(&self) -> f64 {
        self.residual(&self.predicted(self.record), 0).norm_squared()
    }

    fn residual_behind(&self, before: &Before) -> DMatrix<f64> {
        self.residual(&self.predicted(&before.ahead_of(self.record)), before.samples())
    }

    fn predicted(&self, record: &Record) -> DMatrix<f64> {
        if self.is_held { self.model.predict_between(record, None) } else { self.model.predict(record, None) }
    }

    /// Returns the residual of a prediction, weighted [N×M]; `more` is the offset of its rows.
    fn residual(&self, predicted: &DMatrix<f64>, more: usize) -> DMatrix<f64> {
        let left = DMatrix::from_fn(self.rows.len(), self.weight.len(), |k, o| {
            let left = self.weight[o] * (self.measured[(k, o)] - predicted[(self.rows[k] + more, o)]);
            if left.is_finite() { left } else { 0.0 }
        });
        match &self.forgotten {
            Some(w) => &left - w.tr_mul(&(w * &left)),
            None => left,
        }
    }
}

/// Fit of a history.
struct Sought<'a> {
    past: &'a Past<'a>,
    form: Form,
}

impl Residuals for Sought<'_> {
    fn parameters(&self) -> usize {
        self.past.record.actuators.len()
    }

    fn samples(&self) -> usize {
        self.past.rows.len()
    }

    fn outputs(&self) -> usize {
        self.past.weight.len()
    }

    fn residuals(&self, theta: &[f64], range: Range<usize>, out: &mut [f64]) {
        let left = self.past.residual_behind(&(self.form)(theta.to_vec()));
        let row = |k: usize| left.row(k).iter().copied().collect::<Vec<f64>>();
        out.iter_mut().zip(range.flat_map(row)).for_each(|(out, left)| *out = left);
    }

    fn slopes(&self, theta: &[f64], range: Range<usize>, out: &mut [f64], slopes: &mut DMatrix<f64>) {
        self.residuals(theta, range.clone(), out);
        let mut moved = vec![0.0; out.len()];
        for (j, q) in self.past.model.rig().actuators.iter().enumerate() {
            let step = STEP * q.span().max(f64::MIN_POSITIVE);
            let mut beside = theta.to_vec();
            beside[j] += step;
            self.residuals(&beside, range.clone(), &mut moved);
            out.iter().zip(&moved).enumerate().for_each(|(row, (r, moved))| slopes[(row, j)] = (moved - r) / step);
        }
    }
}

/// Largest number of samples of a trial that are used.
const TOLD: usize = 400;

/// Returns the samples of trial `s` of `plain` for estimating its history; none where a lead was recorded, or a prediction came with the
/// data.
fn past<'a>(plain: &'a Problem, state: &State, model: &'a AugmentedModel, s: usize) -> Option<Past<'a>> {
    let (series, kept, width) = (&plain.series[s], &plain.kept[s], plain.outputs());
    if series.is_led || series.predicted.is_some() || kept.is_empty() {
        return None;
    }
    let tells: Vec<usize> = kept.iter().copied().step_by(kept.len().div_ceil(TOLD)).collect();
    let since: Vec<f64> = tells.iter().map(|&k| series.thin.time[k] - series.thin.time[tells[0]]).collect();
    Some(Past {
        model,
        record: &series.record,
        is_held: true,
        rows: tells.iter().map(|&k| series.rows[k]).collect(),
        measured: DMatrix::from_fn(tells.len(), width, |k, o| series.measured[tells[k] * width + o]),
        weight: plain.weight,
        forgotten: projection(&fading(&since, Unrecorded::new(plain, state, s).modes())),
    })
}

/// Returns the history of each trial of `plain` where a model fitted to these trials prefers one to a start at the first sample; none
/// where no trial has one.
pub fn histories(plain: &Problem, state: &State, model: &AugmentedModel) -> Option<Vec<Option<Before>>> {
    let of = |s: usize| -> Option<Before> {
        let past = past(plain, state, model, s)?;
        let forms: [Form; 2] = [Before::Turn, Before::Rest];
        let [turn, rest] = forms.map(|form| past.best(form)).map(|before| (past.left_behind(&before), before));
        let samples = past.rows.len() as f64;
        let prefers = |from: f64, to: f64, values: usize| samples * (from / to).ln() > values as f64 * samples.ln();
        // A rest also moves the start of lags: it must show.
        let (least, before) = if prefers(turn.0, rest.0, 1) { rest } else { turn };
        prefers(past.left(), least, before.values().len()).then_some(before)
    };
    let histories: Vec<Option<Before>> = (0..plain.series.len()).into_par_iter().map(of).collect();
    histories.iter().any(Option::is_some).then_some(histories)
}

/// Returns the history that all trials together prefer, of those that were found; none where most trials start at their first sample.
pub fn common(plain: &Problem, state: &State, model: &AugmentedModel, histories: &[Option<Before>]) -> Option<Before> {
    let known: Vec<&Before> = histories.iter().flatten().collect();
    if 2 * known.len() <= histories.len() {
        return None;
    }
    let left = |before: &Before| -> f64 {
        let of = |s: usize| past(plain, state, model, s).map_or(0.0, |past| past.left_behind(before).ln());
        (0..plain.series.len()).into_par_iter().map(of).collect::<Vec<f64>>().iter().sum()
    };
    let best = known.into_iter().map(|before| (left(before), before)).min_by(|a, b| a.0.total_cmp(&b.0));
    best.map(|(_, before)| before.clone())
}
