//! Corrections of the actuators, mapped to the tip by the Jacobian of the arm.
//!
//! ```text
//! r_o += Σ_a (∂y_o/∂q_a) d_a n_{O+a}
//! ```
//!
//! | symbol  | meaning                                              | shape | unit         |
//! | ------- | ---------------------------------------------------- | ----- | ------------ |
//! | `n`     | the network's output behind its O outputs           | [A]   | standardised |
//! | `d`     | scale of each actuator                               | [A]   | SI           |
//! | `∂y/∂q` | slopes of the arm at the sample's actuators          | [O,A] | SI           |

use std::ops::Range;

use acm_core::tip_model::{Scratch, StrainModel};

use crate::nominal::Nominal;

/// An arm with a buffer for its Jacobian.
#[derive(Debug)]
pub(crate) struct Moved {
    model: StrainModel,
    scales: Vec<f64>,
    tip: Range<usize>,
    scratch: Scratch,
    out: Vec<f64>,
    by_parameter: Vec<f64>,
    slopes: Vec<f64>,
}

impl Moved {
    /// Returns the correction of an arm's actuators, or none where the nominal model has no arm.
    pub fn new(nominal: &Nominal, scales: &[f64], tip: Range<usize>) -> Option<Self> {
        let model = nominal.arm()?;
        let outputs = model.outputs();
        Some(Self {
            scratch: model.scratch(),
            out: vec![0.0; outputs],
            by_parameter: vec![0.0; outputs * model.parameters().len()],
            slopes: vec![0.0; outputs * model.actuators()],
            model: model.clone(),
            scales: scales.to_vec(),
            tip,
        })
    }

    /// Computes the Jacobian at a sample's actuators.
    pub fn look(&mut self, actuators: &[f64]) {
        let Self { model, scratch, out, by_parameter, slopes, .. } = self;
        model.jacobians_with(model.parameters(), actuators, scratch, out, by_parameter, slopes);
    }

    /// Returns the displacement of output `o` of the tip by the actuator corrections `said` [A], SI.
    pub fn of(&self, o: usize, said: &[f32]) -> f64 {
        let row = (self.tip.start + o) * self.scales.len();
        let slopes = &self.slopes[row..row + self.scales.len()];
        slopes.iter().zip(&self.scales).zip(said).map(|((slope, scale), said)| slope * scale * f64::from(*said)).sum()
    }
}
