//! Unknown state at the start of a trial, for an effect with a long memory: e^{−t/τ} of an offset of each actuator,
//! with a prior of a tenth of its range.
//!
//! ```text
//! Z_a = W ∂y/∂q_a e^{−t/τ},   x ← x − Z (ZᵀZ + R)⁻¹ Zᵀ x
//! ```
//!
//! | symbol | meaning                                                       | unit         |
//! | `τ`    | memory of the effect                                          | s            |
//! | `R`    | variance of the noise over that of the prior, of each actuator | as ZᵀZ      |

use acm_core::effects::Site;
use acm_core::effects::instance::Instance;
use nalgebra::{DMatrix, DVector};

use super::trials::{Trial, Trials};
use crate::series::warm_up;

/// Prior of the unknown state at the start of a trial, as a share of each actuator's range.
const STATE: f64 = 0.1;

/// Removes from each column (NM rows) what an unknown initial state of each trial explains, where the effect's memory is longer than the
/// warm-up.
pub fn forget_start(trials: &Trials, instance: &Instance, theta: &[f64], columns: &mut DMatrix<f64>) {
    let acts = instance.site() == Site::Actuation;
    let Some(tau) = instance.memory(theta).filter(|_| acts) else { return };
    for trial in &trials.all {
        let time = &trial.series.thin.time;
        if time.first().is_none_or(|first| tau <= warm_up(time) - first) {
            continue;
        }
        let z = states(trials, trial, tau);
        let Some(factor) = (z.tr_mul(&z) + prior(trials)).cholesky() else { continue };
        let mut rows = columns.rows_mut(trial.rows.start, trial.rows.len());
        let explained = &z * factor.solve(&z.tr_mul(&rows));
        rows -= explained;
    }
}

/// Returns Z of one trial.
fn states(trials: &Trials, trial: &Trial, tau: f64) -> DMatrix<f64> {
    let (width, actuators) = (trials.prepared.weight.len(), trial.series.record.actuators.len());
    let (time, mut z) = (&trial.series.thin.time, DMatrix::zeros(trial.rows.len(), actuators));
    let weights = trials.weight[trial.rows.clone()].chunks_exact(width);
    for (k, (weights, time_k)) in weights.zip(time).enumerate() {
        let faded = (-(time_k - time[0]) / tau).exp();
        for (row, weight) in (k * width..).zip(weights) {
            (0..actuators).for_each(|a| z[(row, a)] = weight * faded * trial.linear.by_actuator[row * actuators + a]);
        }
    }
    z
}

/// Returns the matrix R.
fn prior(trials: &Trials) -> DMatrix<f64> {
    let of = |span: f64| trials.noise / (STATE * span).max(1e-12).powi(2);
    let actuators = &trials.prepared.case.rig.actuators;
    DMatrix::from_diagonal(&DVector::from_iterator(actuators.len(), actuators.iter().map(|q| of(q.span()))))
}
