//! Held-out trials: predicted once, by the final models.

mod start;

use acm_core::augmented::AugmentedModel;
use acm_core::effects::Mode;
use acm_core::rig::Rig;
use nalgebra::DMatrix;
use std::ops::Range;

use crate::case::Trial;
use crate::finding::intervals::{Part, bootstrap, bootstrap_change};
use crate::finding::{Baselines, Confirmation, Errors, Estimate};
use crate::series::before::Before;
use crate::series::warm_up;
use start::residual;

/// Trials that no search can see: only the functions that report the result take this type.
#[derive(Debug, Clone, Default)]
pub struct Holdout {
    trials: Vec<Trial>,
}

/// Number of parts of a held-out trial that the bootstrap draws from.
const PARTS: usize = 12;

/// Units and weights of the errors.
#[derive(Debug, Clone)]
pub struct Measure<'m> {
    /// Signals of the rig.
    pub rig: &'m Rig,
    /// Weight of each output.
    pub weight: &'m [f64],
    /// Outputs whose errors are reported.
    pub reported: Range<usize>,
    /// SI unit of the errors.
    pub unit: String,
    /// White noise of all outputs together, weighted.
    pub noise: f64,
    /// Seed of all random draws.
    pub seed: u64,
    /// Whether the trials have offsets that no signal predicts.
    pub offsets: bool,
}

/// Errors and residuals of held-out trials.
#[derive(Debug, Clone)]
pub struct Judged {
    /// Errors of the baselines, and with the effects.
    pub errors: Errors,
    /// Share of the removable error that was removed.
    pub removed: Option<f64>,
    /// Confirmation by the trials.
    pub confirmation: Confirmation,
    /// Residuals measured − predicted by the nominal model, the best baseline, and with the effects, one matrix [T×M] a
    /// trial.
    pub residuals: [Vec<DMatrix<f64>>; 3],
    /// Whether a sample counts, for each trial.
    pub counts: Vec<Vec<bool>>,
}

impl Holdout {
    /// Returns the trials as a held-out set.
    pub fn new(trials: Vec<Trial>) -> Self {
        Self { trials }
    }

    /// Returns whether there is no held-out trial.
    pub fn is_empty(&self) -> bool {
        self.trials.is_empty()
    }

    /// Returns the names of the trials.
    pub fn names(&self) -> Vec<String> {
        self.trials.iter().map(|trial| trial.name.clone()).collect()
    }

    /// Returns the trials, for figures.
    pub(crate) fn trials(&self) -> &[Trial] {
        &self.trials
    }

    /// Predicts every trial with the baselines and with the effects; `modes` are those of the effects, and `common` is the history that
    /// the development trials share, if any.
    pub fn judge(
        &self,
        baselines: [&AugmentedModel; 3],
        after: &AugmentedModel,
        modes: &[Mode],
        common: Option<&Before>,
        measure: &Measure,
    ) -> Judged {
        let of = |model: &AugmentedModel| -> Vec<DMatrix<f64>> {
            self.trials.iter().map(|trial| residual(trial, model, modes, common, measure.weight)).collect()
        };
        // An unknown initial state is taken out for all alike.
        let before = baselines.map(of);
        let with = of(after);
        let parts = |residuals: &[DMatrix<f64>]| self.parts(residuals, measure);
        let estimates = before.each_ref().map(|residuals| bootstrap(&parts(residuals), measure.seed));
        let best = (0..3).min_by(|&a, &b| estimates[a].value.total_cmp(&estimates[b].value)).unwrap_or(0);
        let after_parts = parts(&with);
        let change = bootstrap_change(&parts(&before[best]), &after_parts, measure.seed);
        let [nominal, static_map, recalibrated] = estimates;
        let share = measure.reported.len() as f64 / measure.weight.len().max(1) as f64;
        let errors = Errors {
            unit: measure.unit.clone(),
            noise: measure.noise * share.sqrt(),
            baselines: Baselines { nominal, static_map, recalibrated },
            after: bootstrap(&after_parts, measure.seed),
            after_without_offsets: measure.offsets.then(|| {
                let centred: Vec<DMatrix<f64>> = self.trials.iter().zip(&with).map(centred).collect();
                bootstrap(&parts(&centred), measure.seed)
            }),
            change,
        };
        let [first, ..] = before.clone();
        let counts = self.trials.iter().map(counts).collect();
        Judged {
            removed: removed(&errors),
            confirmation: self.confirmation(&errors, after),
            residuals: [first, before[best].clone(), with],
            counts,
            errors,
        }
    }

    fn confirmation(&self, errors: &Errors, after: &AugmentedModel) -> Confirmation {
        let unchanged = after.effects().is_empty() && after.clock_correction() == 0.0;
        match errors.change.interval {
            _ if unchanged || self.is_empty() => Confirmation::NotTested,
            [low, _] if low > 0.0 => Confirmation::Refuted,
            [_, high] if high < 0.0 => Confirmation::Confirmed,
            _ => Confirmation::Open,
        }
    }

    fn parts(&self, residuals: &[DMatrix<f64>], measure: &Measure) -> Vec<Part> {
        self.trials.iter().zip(residuals).flat_map(|(trial, residual)| parts_of(trial, residual, measure)).collect()
    }
}

/// Returns the sums of squares of the reported outputs in parts of one trial.
pub(crate) fn parts_of(trial: &Trial, residual: &DMatrix<f64>, measure: &Measure) -> Vec<Part> {
    let rows: Vec<usize> =
        (0..residual.nrows()).zip(counts(trial)).filter(|(_, counts)| *counts).map(|(t, _)| t).collect();
    let count = PARTS.min(rows.len());
    let square =
        |t: &usize| -> f64 { measure.reported.clone().map(|o| (measure.weight[o] * residual[(*t, o)]).powi(2)).sum() };
    (0..count)
        .map(|k| &rows[k * rows.len() / count..(k + 1) * rows.len() / count])
        .map(|rows| Part { squares: rows.iter().map(square).sum(), samples: rows.len() })
        .collect()
}

/// Returns the residuals of a trial without their means over the samples that count.
fn centred((trial, residual): (&Trial, &DMatrix<f64>)) -> DMatrix<f64> {
    let rows: Vec<usize> = counts(trial).iter().enumerate().filter(|(_, counts)| **counts).map(|(t, _)| t).collect();
    let mut rest = residual.clone();
    for mut column in rest.column_iter_mut() {
        let mean = rows.iter().map(|&t| column[t]).sum::<f64>() / rows.len().max(1) as f64;
        column.add_scalar_mut(-mean);
    }
    rest
}

/// Returns whether each sample is measured, and after the warm-up, which a long enough lead covers.
fn counts(trial: &Trial) -> Vec<bool> {
    let begin = warm_up(&trial.led(1).0.time);
    let mut counts = vec![false; trial.record.samples()];
    trial.measured_rows().into_iter().for_each(|t| counts[t] = trial.record.time[t] >= begin);
    counts
}

/// Share of the noise's mean square below which there is nothing to remove.
const NOTHING: f64 = 0.09;

/// Computes F = (b² − a²)/(b² − noise²).
fn removed(errors: &Errors) -> Option<f64> {
    let (best, after, noise): (Estimate, Estimate, f64) = (errors.baselines.best(), errors.after, errors.noise);
    let removable = best.value.powi(2) - noise.powi(2);
    (removable > NOTHING * noise.powi(2)).then(|| (best.value.powi(2) - after.value.powi(2)) / removable)
}
