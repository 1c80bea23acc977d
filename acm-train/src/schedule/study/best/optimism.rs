//! Optimism of a score on trials on which the epoch was chosen.
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
//! together, from the projections ([`crate::learn::Projection`]), as [`crate::run::evaluation::verdict`] does. A nominal model chooses
//! nothing: ρ = 1. Of a single fold nothing can be said: ρ = 1.

use crate::{learn::Projection, run::record::RunRecord};

/// Computes ρ of a run in cross-validation; `others` are the runs of its seed on the other folds.
pub fn ratio(own: &RunRecord, others: &[&RunRecord]) -> f64 {
    if others.is_empty() {
        return 1.0;
    }
    let blind = |record: &RunRecord| record.projections.is_empty();
    let (chosen, least) = match blind(own) || others.iter().any(|other| blind(other)) {
        true => by_losses(&losses(own), &others.iter().map(|other| losses(other)).collect::<Vec<_>>()),
        false => {
            let others: Vec<&[Projection]> = others.iter().map(|other| other.projections.as_slice()).collect();
            by_projections(&own.projections, &others)
        }
    };
    let ratio = chosen / least;
    if ratio.is_finite() { ratio.max(1.0) } else { 1.0 }
}

fn losses(record: &RunRecord) -> Vec<f64> {
    record.epochs.iter().map(|epoch| epoch.validation_loss).collect()
}

/// Returns the loss on the fold at the row that the others choose together, and the smallest. After its last row a run
/// stays as it was.
fn by_losses(own: &[f64], others: &[Vec<f64>]) -> (f64, f64) {
    let pooled = |row: usize| others.iter().map(|other| at(other, row, f64::INFINITY)).sum::<f64>();
    let chosen = least(others.iter().map(Vec::len).max().unwrap_or(0), pooled);
    (at(own, chosen, f64::INFINITY), own.iter().copied().fold(f64::INFINITY, f64::min))
}

/// Computes the optimism from epochs and factors.
fn by_projections(own: &[Projection], others: &[&[Projection]]) -> (f64, f64) {
    let pooled = |row: usize| {
        let mut sum = Projection::default();
        others.iter().for_each(|other| sum += at(other, row, Projection::default()));
        sum
    };
    let left = |projection: Projection| projection.error(projection.factor());
    let chosen = least(others.iter().map(|other| other.len()).max().unwrap_or(0), |row| left(pooled(row)));
    let smallest = own.iter().map(|projection| left(*projection)).fold(f64::INFINITY, f64::min);
    (at(own, chosen, Projection::default()).error(pooled(chosen).factor()), smallest)
}

fn at<T: Copy>(rows: &[T], row: usize, none: T) -> T {
    rows.get(row).or(rows.last()).copied().unwrap_or(none)
}

/// Returns the row with the smallest value, the first of equals.
fn least(rows: usize, value: impl Fn(usize) -> f64) -> usize {
    (0..rows).min_by(|a, b| value(*a).total_cmp(&value(*b))).unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: by hand. The others together are least in their second row, 1 + 3; the fold itself in its third. One of the others
    /// ended after two rows.
    #[test]
    fn the_other_folds_choose_the_row() {
        let others = [vec![2.0, 1.0], vec![3.0, 3.0, 4.0]];
        assert_eq!(by_losses(&[5.0, 4.0, 2.0], &others), (4.0, 2.0));
        assert_eq!(by_losses(&[5.0], &others), (5.0, 5.0));
    }

    /// Oracle: by hand. The other's only epoch points along the residual and takes all of it, λ = 1; here it points away, so that
    /// nothing should be added, and 1 + 2 + 1 are left in the place of 1.
    #[test]
    fn the_other_folds_choose_the_factor() {
        let away = Projection { residual: 1.0, along: -1.0, square: 1.0 };
        let along = Projection { residual: 1.0, along: 1.0, square: 1.0 };
        assert_eq!(by_projections(&[away], &[&[along]]), (4.0, 1.0));
        assert_eq!(by_projections(&[away], &[&[away]]), (1.0, 1.0));
    }
}
