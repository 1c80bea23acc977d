//! What is not known at the start of a trial whose effects forget slowly: e^{−t/τ} of an offset of each actuator, with a prior
//! of a tenth of its range.
//!
//! ```text
//! Z_a = −W ∂y/∂q_a e^{−t/τ},   r ← r − Z (ZᵀZ + R)⁻¹ Zᵀ r
//! ```
//!
//! | symbol | meaning                                                       | unit         |
//! | `τ`    | longest memory of the actuation's effects                     | s            |
//! | `R`    | variance of the noise over that of the prior, of each actuator | as ZᵀZ      |

use acm_core::effects::Site;
use acm_core::effects::instance::Instance;
use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

use super::{Point, Trial};
use crate::series::warm_up;
use crate::tall::product;

/// Prior of the unknown state at the start of a trial, as a share of each actuator's range.
const STATE: f64 = 0.1;

/// Which samples tell the unknown state at the start of a trial.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StateFrom {
    /// All: for fits.
    Trial,
    /// The warm-up, which does not count: for scores, so that a trial is predicted from nothing that is scored.
    WarmUp,
}

/// Unknown states at the start.
pub(super) struct States {
    /// Z.
    columns: DMatrix<f64>,
    /// Z, zero at samples that do not tell.
    telling: DMatrix<f64>,
    /// Of ZᵀZ + R.
    factor: Cholesky<f64, Dyn>,
}

impl States {
    /// A column without what states explain of it.
    pub fn without(&self, column: &DVector<f64>) -> DVector<f64> {
        column - &self.columns * self.factor.solve(&self.telling.tr_mul(column))
    }

    /// The same of every column of a matrix, in place.
    pub fn remove(&self, matrix: &mut DMatrix<f64>) {
        let along = product(&self.telling, matrix, 0..matrix.nrows());
        matrix.gemm(-1.0, &self.columns, &self.factor.solve(&along), 1.0);
    }
}

impl Trial<'_> {
    /// None where nothing lasts longer than the warm-up.
    pub(super) fn states(
        &self,
        point: Point,
        theta: &[&[f64]],
        by_actuator: Option<&[f64]>,
        state: StateFrom,
    ) -> Option<States> {
        let acts = |i: &Instance| i.site() == Site::Actuation;
        let memories = point.instances.iter().zip(theta).filter(|(i, _)| acts(i)).filter_map(|(i, th)| i.memory(th));
        let tau = memories.fold(0.0, f64::max);
        let time = &self.series.thin.time;
        let first = *time.first()?;
        if tau <= warm_up(time) - first {
            return None;
        }
        let by_actuator = by_actuator.unwrap_or(&self.reference.linear.by_actuator);
        let (width, actuators) = (self.width(), self.reference.q.len());
        let faded: Vec<f64> = time.iter().map(|time| (-(time - first) / tau).exp()).collect();
        let columns = DMatrix::from_fn(time.len() * width, actuators, |row, a| {
            -self.setup.weight[row % width] * (by_actuator[row * actuators + a] * faded[row / width])
        });
        let prior = DVector::from_iterator(
            actuators,
            self.setup.rig.actuators.iter().map(|q| self.setup.noise / (STATE * q.span()).max(1e-12).powi(2)),
        );
        let mut telling = columns.clone();
        if state == StateFrom::WarmUp {
            for k in (0..time.len()).filter(|&k| self.series.counts[k]) {
                telling.rows_mut(k * width, width).fill(0.0);
            }
        }
        let rows = 0..telling.nrows();
        let factor = (product(&telling, &telling, rows) + DMatrix::from_diagonal(&prior)).cholesky()?;
        Some(States { columns, telling, factor })
    }
}
