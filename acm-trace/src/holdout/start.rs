//! Unknown state of a held-out trial at its start, told by its warm-up.
//!
//! | form | states at the start |
//! | --- | --- |
//! | past | those behind actuators that rested at a constant before the first sample: one number for each actuator |
//! | fading | e^{−t/τ} of each memory τ in each output: what any lag forgets, whatever it is |
//!
//! The form with the lower n ln(S/n) + 2k is taken, of n numbers of the warm-up that leave the sum of squares S behind k states (Akaike
//! (1974), IEEE Trans. Automatic Control 19(6)). A baseline has no memory, and fades as the model with effects does.

use std::ops::Range;

use acm_core::AHEAD;
use acm_core::augmented::AugmentedModel;
use acm_core::least_squares::Residuals;
use acm_core::levenberg_marquardt::{Bounds, Options, fit};
use acm_core::record::Record;
use nalgebra::{DMatrix, DVector};

use crate::case::Trial;
use crate::fit::unrecorded::{fading, states};
use crate::series::warm_up;

/// Duration of a memory, as a share of the warm-up, from which the state at the start matters.
const LASTS: f64 = 0.3;

/// Returns measured − predicted without what an unknown state at the start explains, unless it has faded in what leads up to the trial;
/// `memories` are those of the effects, s, and `weight` those of the outputs.
pub fn residual(trial: &Trial, model: &AugmentedModel, memories: &[f64], weight: &[f64]) -> DMatrix<f64> {
    let (led, lead) = trial.led(1);
    let predicted = |record: &Record, first: usize| {
        let all = model.predict(record, trial.predicted.as_ref());
        &trial.measured - all.rows(first, trial.measured.nrows())
    };
    let plain = predicted(&led, lead);
    let time = &trial.record.time;
    let warm = warm_up(time) - time[0];
    let fades_in = warm.max(time[0] - led.time[0]);
    let lasting: Vec<f64> = memories.iter().copied().filter(|tau| *tau > LASTS * fades_in).collect();
    if lasting.is_empty() {
        return plain;
    }
    let told = time.iter().take_while(|t| **t - time[0] < warm).count();
    let faded = faded(&plain, time, &lasting, told);
    let rested = (trial.predicted.is_none() && !model.effects().is_empty()).then(|| {
        let past = Past { model, record: &begun(&led, lead + told), measured: &trial.measured, weight, lead, told };
        let rest = past.best();
        predicted(&resting(&led, &rest), lead + 1)
    });
    let cost = |residual: &DMatrix<f64>, states: usize| information(residual, weight, told, states);
    match rested {
        Some(rested) if cost(&rested, led.actuators.len()) < cost(&faded, lasting.len() * weight.len()) => rested,
        _ => faded,
    }
}

/// Returns the residual without what fades.
fn faded(residual: &DMatrix<f64>, time: &[f64], lasting: &[f64], told: usize) -> DMatrix<f64> {
    let since: Vec<f64> = time.iter().map(|t| t - time[0]).collect();
    let (h, mut residual) = (fading(&since, lasting), residual.clone());
    for mut column in residual.column_iter_mut() {
        let told: Vec<usize> = (0..told).filter(|&t| column[t].is_finite()).collect();
        let seen = DVector::from_fn(told.len(), |k, _| column[told[k]]);
        if let Some(states) = states(&h.select_rows(&told), &seen) {
            column -= &h * states;
        }
    }
    residual
}

/// Returns n ln(S/n) + 2k of the warm-up.
fn information(residual: &DMatrix<f64>, weight: &[f64], told: usize, states: usize) -> f64 {
    let all = (0..told).flat_map(|t| weight.iter().enumerate().map(move |(o, weight)| weight * residual[(t, o)]));
    let (sum, count) = all.filter(|r| r.is_finite()).fold((0.0, 0usize), |(sum, count), r| (sum + r * r, count + 1));
    count as f64 * (sum / count.max(1) as f64).ln() + 2.0 * states as f64
}

/// Returns the first samples of a record.
fn begun(record: &Record, samples: usize) -> Record {
    record.select(&(0..samples).collect::<Vec<usize>>())
}

/// Returns the record with its actuators at rest ahead of the first sample: states begin there.
fn resting(record: &Record, rest: &[f64]) -> Record {
    let ahead = if record.samples() > 1 { AHEAD * (record.time[1] - record.time[0]) } else { AHEAD };
    let mut before = begun(record, 1);
    before.time[0] -= ahead;
    before.actuators.iter_mut().zip(rest).for_each(|(q, rest)| q[0] = *rest);
    before.followed_by(record)
}

/// Residuals of the warm-up behind a rest of the actuators.
struct Past<'a> {
    model: &'a AugmentedModel,
    /// Until the warm-up ends.
    record: &'a Record,
    measured: &'a DMatrix<f64>,
    weight: &'a [f64],
    lead: usize,
    told: usize,
}

/// Steps of the rest by which slopes are found, as a share of an actuator's range.
const STEP: f64 = 1e-3;

/// Most iterations.
const ITERATIONS: usize = 20;

impl Past<'_> {
    /// Returns the rest of each actuator that leaves least, within a range beyond the recorded one.
    fn best(&self) -> Vec<f64> {
        let start: Vec<f64> = self.record.actuators.iter().map(|q| q[0]).collect();
        let ends = self.model.rig().actuators.iter().map(|q| (q.low - q.span(), q.high + q.span()));
        let (lower, upper) = ends.unzip();
        fit(self, &start, &Bounds { lower, upper }, &Options { iterations: ITERATIONS, ..Options::default() }).theta
    }
}

impl Residuals for Past<'_> {
    fn parameters(&self) -> usize {
        self.record.actuators.len()
    }

    fn samples(&self) -> usize {
        self.told
    }

    fn outputs(&self) -> usize {
        self.weight.len()
    }

    fn residuals(&self, theta: &[f64], range: Range<usize>, out: &mut [f64]) {
        let predicted = self.model.predict(&resting(self.record, theta), None);
        let width = self.weight.len();
        for (k, t) in range.enumerate() {
            for (o, weight) in self.weight.iter().enumerate() {
                let left = weight * (self.measured[(t, o)] - predicted[(1 + self.lead + t, o)]);
                out[k * width + o] = if left.is_finite() { left } else { 0.0 };
            }
        }
    }

    fn slopes(&self, theta: &[f64], range: Range<usize>, out: &mut [f64], slopes: &mut DMatrix<f64>) {
        self.residuals(theta, range.clone(), out);
        let mut moved = vec![0.0; out.len()];
        for (j, q) in self.model.rig().actuators.iter().enumerate() {
            let step = STEP * q.span().max(f64::MIN_POSITIVE);
            let mut beside = theta.to_vec();
            beside[j] += step;
            self.residuals(&beside, range.clone(), &mut moved);
            out.iter().zip(&moved).enumerate().for_each(|(row, (r, moved))| slopes[(row, j)] = (moved - r) / step);
        }
    }
}

#[cfg(test)]
mod tests {
    use acm_core::nominal::NominalModel;
    use acm_core::polynomial::Polynomial;

    use super::*;
    use crate::fit::bench;
    use acm_core::effects::Carrier;

    /// Oracle: τ (1 + κz) dz/dt = x − z in small steps, from a rest at 0.8 while the input is at −0.6 throughout. Two fading memories,
    /// told by a warm-up that is short beside them, leave more than the noise.
    #[test]
    fn a_lag_that_depends_on_its_state_begins_behind_a_rest() {
        let rig = bench::rig(&["q"], &[], &["y"]);
        let [tau, bend, noise] = [8.0, 0.9, 0.004];
        let time = bench::time();
        let (mut z, mut random, mut measured) = (0.8, 1u64, vec![]);
        for _ in &time {
            random = random.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            measured.push(3.0 * z + noise * ((random >> 11) as f64 / (1u64 << 53) as f64 - 0.5));
            z = (0..100).fold(z, |z, _| z + 1e-4 * (-0.6 - z) / (tau * (1.0 + bend * z)));
        }
        let q = DMatrix::from_fn(3, 1, |k, _| k as f64 - 1.0);
        let line = Polynomial::fit(&q, &(3.0 * &q), 1).polynomial;
        let lag = bench::placed("state_dependent_lag", Carrier::Rig, &rig, &[tau, bend, 0.0, 0.0]);
        let model =
            AugmentedModel::new(rig, NominalModel::Polynomial(line), None, None, vec![lag.instance.term(&lag.theta)]);
        let record = Record::new(time.clone(), vec![vec![-0.6; time.len()]], vec![], vec![]);
        let measured = DMatrix::from_vec(time.len(), 1, measured);
        let trial = Trial { name: String::new(), record, lead: None, measured, predicted: None, offset: None };
        let memories: Vec<f64> = lag.instance.memories(&lag.theta).collect();
        let left = residual(&trial, &model.unwrap(), &memories, &[1.0]);
        let rms = (left.norm_squared() / time.len() as f64).sqrt();
        assert!((rms / (noise / 12f64.sqrt()) - 1.0).abs() < 0.1, "{rms}");
    }
}
