//! Unknown initial state of a held-out trial, estimated from its warm-up.
//!
//! | form | what is estimated |
//! | --- | --- |
//! | fading | each mode of memory τ in each output, e^{−t/τ} or oscillating: the decay of any lag |
//! | rest | a constant at which each actuator rested before the first sample |
//! | turn | a value of each actuator at which it turned before the first sample, and fading modes |
//! | common | fading modes only, after the history that development trials share |
//!
//! The form with the lowest n ln(S/n) + k ln n is used, with n numbers in the warm-up, the residual sum of squares S, and k values of the
//! trial's own (Schwarz (1978), Annals of Statistics 6(2)). A baseline has no memory; the modes of the model with effects are used.

use acm_core::augmented::AugmentedModel;
use acm_core::effects::Mode;
use acm_core::record::Record;
use nalgebra::{DMatrix, DVector};

use crate::case::Trial;
use crate::fit::unrecorded::past::{Form, Past};
use crate::fit::unrecorded::{fading, states};
use crate::series::before::Before;
use crate::series::warm_up;

/// Duration of a memory, as a share of the warm-up, above which the initial state matters.
const LASTS: f64 = 0.3;

/// Returns measured − predicted without the part that an unknown initial state explains, unless it has decayed during the lead; `modes`
/// are those of the effects, and `weight` those of the outputs. `common` is the history of other trials.
pub fn residual(
    trial: &Trial,
    model: &AugmentedModel,
    modes: &[Mode],
    common: Option<&Before>,
    weight: &[f64],
) -> DMatrix<f64> {
    let (led, lead) = trial.led(1);
    let predicted = |record: &Record, first: usize| {
        let all = model.predict(record, trial.predicted.as_ref());
        &trial.measured - all.rows(first, trial.measured.nrows())
    };
    let time = &trial.record.time;
    let warm = warm_up(time) - time[0];
    let mut told = time.iter().take_while(|t| **t - time[0] < warm).count();
    if trial.measured_rows().first().is_none_or(|first| *first >= told) {
        told = 0;
    }
    let fades_in = warm.max(time[0] - led.time[0]);
    let lasting: Vec<Mode> = modes.iter().copied().filter(|mode| mode.memory > LASTS * fades_in).collect();
    let faded =
        |residual: DMatrix<f64>| if lasting.is_empty() { residual } else { faded(&residual, time, &lasting, told) };
    let plain = faded(predicted(&led, lead));
    if trial.predicted.is_some() || model.effects().is_empty() || lead > 0 || told == 0 {
        return plain;
    }
    let states = fading(&[0.0], &lasting).ncols() * weight.len();
    let behind = |before: &Before| predicted(&before.ahead_of(&led), before.samples());
    let rows: Vec<usize> = (0..told).collect();
    let begun = led.select(&rows);
    let best = |form: Form| {
        let (rows, measured) = (rows.clone(), trial.measured.rows(0, told).into_owned());
        Past { model, record: &begun, is_held: false, rows, measured, weight, forgotten: None }.best(form)
    };
    let own = led.actuators.len();
    let rest = (!lasting.is_empty()).then(|| (behind(&best(Before::Rest)), own));
    let turn = (faded(behind(&best(Before::Turn))), states + own);
    let common = common.map(|before| (faded(behind(before)), states));
    let all = common.into_iter().chain([(plain, states)]).chain(rest).chain([turn]);
    let of = |(residual, states): &(DMatrix<f64>, usize)| information(residual, weight, told, *states);
    all.min_by(|a, b| of(a).total_cmp(&of(b))).map_or_else(|| trial.measured.clone(), |best| best.0)
}

/// Returns the residual without fading modes.
fn faded(residual: &DMatrix<f64>, time: &[f64], lasting: &[Mode], told: usize) -> DMatrix<f64> {
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

/// Returns n ln(S/n) + k ln n of the warm-up.
fn information(residual: &DMatrix<f64>, weight: &[f64], told: usize, states: usize) -> f64 {
    let all = (0..told).flat_map(|t| weight.iter().enumerate().map(move |(o, weight)| weight * residual[(t, o)]));
    let (sum, count) = all.filter(|r| r.is_finite()).fold((0.0, 0usize), |(sum, count), r| (sum + r * r, count + 1));
    let n = count.max(1) as f64;
    n * (sum / n).ln() + states as f64 * n.ln()
}

#[cfg(test)]
mod tests {
    use acm_core::nominal::NominalModel;
    use acm_core::polynomial::Polynomial;

    use super::*;
    use crate::fit::bench;
    use acm_core::effects::Carrier;

    /// Oracle: τ (1 + κz) dz/dt = x − z in small steps, from a rest at 0.8 while the input is at −0.6 throughout. Two fading modes,
    /// estimated from a warm-up that is shorter than they are, leave more than the noise.
    #[test]
    fn a_lag_that_depends_on_its_state_begins_behind_a_rest() {
        let rig = bench::rig(&["q"], &[], &["y"]);
        let [tau, bend, width] = [8.0, 0.9, 0.004];
        let time = bench::time();
        let (mut z, mut noise, mut measured) = (0.8, bench::noise(width), vec![]);
        for _ in &time {
            measured.push(3.0 * z + noise());
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
        let modes: Vec<Mode> = lag.instance.modes(&lag.theta).collect();
        let left = residual(&trial, &model.unwrap(), &modes, None, &[1.0]);
        let rms = (left.norm_squared() / time.len() as f64).sqrt();
        assert!((rms / (width / 12f64.sqrt()) - 1.0).abs() < 0.1, "{rms}");
    }
}
