//! Slopes of the tip model with respect to its actuators.
//!
//! ```text
//! ∂p_k/∂q_a = Σ_i (∂p_k/∂A_i) Σ_j Φ_ij ∂m_j/∂q_a
//! ```

use super::Scratch;
use super::StrainModel;
use super::evaluate::Rows;

impl StrainModel {
    /// As [`StrainModel::jacobian_with`], and the slopes with respect to the actuators: output o, actuator a in
    /// `by_actuator[o·A + a]`.
    pub fn jacobians_with(
        &self,
        theta: &[f64],
        q: &[f64],
        scratch: &mut Scratch,
        out: &mut [f64],
        slopes: &mut [f64],
        by_actuator: &mut [f64],
    ) {
        self.differentiate(theta, q, &mut scratch.work, out, slopes);
        let width = self.actuators;
        self.actuator_slopes(theta, &scratch.work, &mut Rows { table: by_actuator, width });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::arm::ArmSpec;
    use crate::kinematics::strain::StrainBasis;

    /// Oracle: central differences, for both bases, two markers.
    #[test]
    fn actuator_slopes_are_the_derivative() {
        for strain in [StrainBasis::Legendre { order: 2 }, StrainBasis::Piecewise { segments: 2 }] {
            let arm = ArmSpec { strain, degree: 2, ..ArmSpec::default() };
            let model = StrainModel::new(&arm, 2, &[0.5, 1.0]).unwrap();
            let theta: Vec<f64> = (0..model.parameters().len()).map(|j| 0.3 * (1.0 + j as f64).sin()).collect();
            let (mut scratch, mut out) = (model.scratch(), [0.0; 6]);
            let (mut slopes, mut by_actuator) = (vec![0.0; 6 * theta.len()], [0.0; 12]);
            let q = [0.7, -0.4];
            model.jacobians_with(&theta, &q, &mut scratch, &mut out, &mut slopes, &mut by_actuator);
            for a in 0..2 {
                let mut at = |shift: f64| {
                    let (mut moved, mut out) = (q, [0.0; 6]);
                    moved[a] += shift;
                    model.predict_with(&theta, &moved, &mut scratch, &mut out);
                    out
                };
                let (after, before) = (at(1e-5), at(-1e-5));
                for o in 0..6 {
                    let slope = (after[o] - before[o]) / 2e-5;
                    assert!((by_actuator[2 * o + a] - slope).abs() < 1e-8, "{} {slope}", by_actuator[2 * o + a]);
                }
            }
        }
    }
}
