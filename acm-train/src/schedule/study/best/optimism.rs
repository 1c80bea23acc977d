//! By how much a score flatters a model whose epoch was chosen on the trials that it is scored on.
//!
//! ```text
//! e* = argmin_e Σ_{g ≠ f} L_g(e)          ρ_f = L_f(e*) / min_e L_f(e) ≥ 1
//! ```
//!
//! | symbol | meaning                                                                                    |
//! | ------ | ------------------------------------------------------------------------------------------ |
//! | f, g   | folds                                                                                      |
//! | L_f(e) | mean square of what is left on fold f after epoch e, round e or with penalty e             |
//! | ρ_f    | the mean squared error on fold f is multiplied by it                                       |
//!
//! Networks that start from the nominal model have a factor too: epoch and factor are then chosen on the other folds
//! together, from the projections ([`crate::learn::Projection`]), as [`crate::run::verdict`] does. A nominal model chooses
//! nothing: ρ = 1. Of a single fold nothing can be said: ρ = 1.

use crate::{learn::Projection, run::record::RunRecord};

/// ρ of a run in cross-validation; `others` are the runs of its seed on the other folds.
pub fn ratio(own: &RunRecord, others: &[&RunRecord]) -> f64 {
    if others.is_empty() {
        return 1.0;
    }
    let blind = |record: &RunRecord| record.projections.is_empty();
    let (chosen, least) = match blind(own) || others.iter().any(|other| blind(other)) {
        true => by_losses(own, others),
        false => by_projections(own, others),
    };
    let ratio = chosen / least;
    if ratio.is_finite() { ratio.max(1.0) } else { 1.0 }
}

/// Loss on the fold at the row that the others choose, and the smallest.
fn by_losses(own: &RunRecord, others: &[&RunRecord]) -> (f64, f64) {
    let at = |record: &RunRecord, row: usize| {
        let rows = &record.epochs;
        rows.get(row.min(rows.len().saturating_sub(1))).map_or(f64::INFINITY, |epoch| epoch.validation_loss)
    };
    let pooled = |row: usize| others.iter().map(|other| at(other, row)).sum::<f64>();
    let chosen = least(others.iter().map(|other| other.epochs.len()).max().unwrap_or(0), pooled);
    (at(own, chosen), own.epochs.iter().map(|epoch| epoch.validation_loss).fold(f64::INFINITY, f64::min))
}

/// The same of epochs and factors.
fn by_projections(own: &RunRecord, others: &[&RunRecord]) -> (f64, f64) {
    let at = |record: &RunRecord, row: usize| record.projections[row.min(record.projections.len() - 1)];
    let pooled = |row: usize| {
        let mut sum = Projection::default();
        others.iter().for_each(|other| sum += at(other, row));
        sum
    };
    let left = |projection: Projection| projection.error(projection.factor());
    let rows = others.iter().map(|other| other.projections.len()).max().unwrap_or(0);
    let chosen = least(rows, |row| left(pooled(row)));
    let own_least = own.projections.iter().map(|projection| left(*projection)).fold(f64::INFINITY, f64::min);
    (at(own, chosen).error(pooled(chosen).factor()), own_least)
}

/// The row with the smallest value, the first of equals.
fn least(rows: usize, value: impl Fn(usize) -> f64) -> usize {
    (0..rows).min_by(|a, b| value(*a).total_cmp(&value(*b))).unwrap_or(0)
}
