//! Form of an effect: part of the residual on blocks left out that the effect's change of the outputs predicts.
//!
//! | columns | of | number |
//! | --- | --- | --- |
//! | d | change of each output by the effect | M |
//! | ḋ | its rate | M |
//! | d − lag_τ(d) | τ of 4 steps, and of the geometric mean of that and a sixth of a trial | 2M |
//! | products | of all of these with each actuator and each context | 4M (A + E) |
//!
//! An effect of the right form leaves nothing that its change predicts. One that imitates a related effect does: a resonance behind the
//! nonlinear map instead of before it leaves products of its motion and the actuators. Ridge, folds and significance are those of
//! [`crate::diagnose::readout`].

use acm_core::effects::memory::lag;
use nalgebra::DMatrix;

use crate::diagnose::readout::{Columns, readout};
use crate::diagnose::remainder::{Remainder, TrialRemainder};
use crate::diagnose::samples::{Sample, gather, median, median_step, standardised};
use crate::finding::Probe;

type Column = Vec<f64>;

/// Tests whether the change of the outputs by an effect predicts the residual; `changes` is N×M for each trial.
pub fn followed(remainder: &Remainder, changes: &[DMatrix<f64>], seed: u64) -> Probe {
    readout(remainder, seed, |samples, most| {
        let own = own(remainder, changes, samples);
        let plain = own.len().min(most);
        let signals = signals(remainder, samples);
        let with = |d: &Column, z: &Column| standardised(&d.iter().zip(z).map(|(d, z)| d * z).collect::<Column>());
        let products = own.iter().flat_map(|d| signals.iter().filter_map(move |z| with(d, z)));
        let columns: Vec<Column> = own.iter().cloned().chain(products).take(most).collect();
        Columns { x: DMatrix::from_fn(samples.len(), columns.len(), |row, column| columns[column][row]), plain }
    })
}

/// Returns the change d of each output, its rate, and d − lag_τ(d).
fn own(remainder: &Remainder, changes: &[DMatrix<f64>], samples: &[Sample]) -> Vec<Column> {
    let times = || remainder.trials.iter().map(|trial| trial.record.time.as_slice());
    let mut lengths: Vec<f64> = times().filter_map(|time| Some(time.last()? - time.first()?)).collect();
    let (shortest, longest) = (4.0 * median_step(times()), median(&mut lengths) / 6.0);
    let taus = [shortest, (shortest * longest).sqrt()];
    let trials = || remainder.trials.iter().zip(changes);
    let of = |o: usize| {
        let all: Vec<(&TrialRemainder, Column)> =
            trials().map(|(trial, change)| (trial, change.column(o).iter().copied().collect())).collect();
        let rates = all.iter().map(|(trial, d)| rate(&trial.record.time, d)).collect();
        let missed = |tau: f64| all.iter().map(|(trial, d)| missed(&trial.record.time, d, tau)).collect();
        let lags: Vec<Vec<Column>> = taus.map(missed).into();
        let own = all.iter().map(|(_, d)| d.clone()).collect();
        [vec![own, rates], lags].concat()
    };
    let columns = (0..remainder.outputs()).flat_map(of);
    columns.filter_map(|column| standardised(&picked(&column, samples))).collect()
}

/// Returns dx/dt by differences of neighbours.
fn rate(time: &[f64], x: &[f64]) -> Column {
    let of = |t: usize| {
        let (before, after) = (t.saturating_sub(1), (t + 1).min(x.len() - 1));
        (x[after] - x[before]) / (time[after] - time[before]).max(f64::MIN_POSITIVE)
    };
    (0..x.len()).map(of).collect()
}

/// Returns x − lag_τ(x).
fn missed(time: &[f64], x: &[f64], tau: f64) -> Column {
    let mut behind = x.to_vec();
    lag(time, &mut behind, |_| tau);
    x.iter().zip(behind).map(|(x, behind)| x - behind).collect()
}

/// Returns the values at the samples; those that are not finite become 0.
fn picked(trials: &[Column], samples: &[Sample]) -> Column {
    samples.iter().map(|s| Some(trials[s.trial][s.t]).filter(|x| x.is_finite()).unwrap_or(0.0)).collect()
}

/// Returns actuators and contexts that vary, standardised.
fn signals(remainder: &Remainder, samples: &[Sample]) -> Vec<Column> {
    let actuators = (0..remainder.rig.actuators.len())
        .map(|a| gather(remainder, samples, |trial| trial.record.actuators[a].clone()));
    let contexts =
        (0..remainder.rig.contexts.len()).map(|e| gather(remainder, samples, |trial| trial.record.contexts[e].clone()));
    actuators.chain(contexts).filter_map(|signal| standardised(&signal)).collect()
}
