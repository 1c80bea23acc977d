//! Nominal models: predictions of the outputs from the actuators, without a network.

use nalgebra::DMatrix;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use crate::arm::ArmSpec;
use crate::polynomial::Polynomial;
use crate::tip_model::{STRIDE, StrainModel};

/// Which nominal model to calibrate.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(tag = "model", rename_all = "snake_case", deny_unknown_fields)]
pub enum NominalSpec {
    /// Strain model of a continuum arm.
    Strain(ArmSpec),
    /// Polynomial from actuators to outputs.
    Polynomial {
        /// Degree, with constant term.
        #[serde(default = "cubic")]
        degree: usize,
    },
    /// None: the prediction is zero, and the residual is the measurement itself.
    None,
}

fn cubic() -> usize {
    3
}

/// A calibrated nominal model.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum NominalModel {
    /// Strain model of a continuum arm.
    Strain(StrainModel),
    /// Polynomial from actuators to outputs.
    Polynomial(Polynomial),
    /// No model: zeros.
    None {
        /// Number of outputs.
        outputs: usize,
    },
}

impl NominalModel {
    /// Predicted outputs [T×M] at `actuators` [T×A].
    pub fn predict(&self, actuators: &DMatrix<f64>) -> DMatrix<f64> {
        match self {
            Self::Strain(model) => predict_markers(model, actuators),
            Self::Polynomial(polynomial) => polynomial.predict(actuators),
            Self::None { outputs } => DMatrix::zeros(actuators.nrows(), *outputs),
        }
    }

    /// Whether it is a strain model of a continuum arm.
    pub fn is_arm(&self) -> bool {
        matches!(self, Self::Strain(_))
    }

    /// Slopes of the outputs with respect to the actuators at `actuators` [T×A], [T×(M·A)]: ∂p_m/∂q_a in column m·A + a.
    /// None where the model is no arm.
    pub fn actuator_slopes(&self, actuators: &DMatrix<f64>) -> Option<DMatrix<f64>> {
        let Self::Strain(model) = self else { return None };
        let (mut scratch, mut out) = (model.scratch(), vec![0.0; model.outputs()]);
        let mut by_parameter = vec![0.0; model.outputs() * model.parameters().len()];
        let mut slopes = vec![0.0; model.outputs() * model.actuators()];
        let mut all = Vec::with_capacity(actuators.nrows() * slopes.len());
        for row in actuators.row_iter() {
            let q: Vec<f64> = row.iter().copied().collect();
            model.jacobians_with(model.parameters(), &q, &mut scratch, &mut out, &mut by_parameter, &mut slopes);
            all.extend_from_slice(&slopes);
        }
        Some(DMatrix::from_row_slice(actuators.nrows(), slopes.len(), &all))
    }

    /// Number of outputs M: three per marker, or as many as the polynomial has.
    pub fn outputs(&self) -> usize {
        match self {
            Self::Strain(model) => model.outputs(),
            Self::Polynomial(polynomial) => polynomial.outputs(),
            Self::None { outputs } => *outputs,
        }
    }
}

/// Block by block in parallel; samples do not see each other, so no order matters.
fn predict_markers(model: &StrainModel, actuators: &DMatrix<f64>) -> DMatrix<f64> {
    assert_eq!(actuators.ncols(), model.actuators(), "one column per actuator");
    let (samples, outputs) = (actuators.nrows(), model.outputs());
    let mut predicted = vec![0.0; samples * outputs];
    predicted.par_chunks_mut(STRIDE * outputs).enumerate().for_each_init(
        || model.block(),
        |block, (k, rows)| {
            let here = k * STRIDE..(k * STRIDE + rows.len() / outputs);
            for a in 0..model.actuators() {
                let column = &actuators.as_slice()[a * samples..][here.clone()];
                block.actuator_mut(a)[..column.len()].copy_from_slice(column);
            }
            model.fill(model.parameters(), here.len(), block);
            for (t, row) in rows.chunks_exact_mut(outputs).enumerate() {
                row.iter_mut().enumerate().for_each(|(o, out)| *out = block.output(o)[t]);
            }
        },
    );
    DMatrix::from_row_slice(samples, outputs, &predicted)
}
