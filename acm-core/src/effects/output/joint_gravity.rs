//! Gravity at a joint: a weight that turns with a joint shifts the outputs by its lever arm.
//!
//! ```text
//! ỹ_m = y_m + a_m sin s + b_m cos s
//! ```
//!
//! | symbol     | meaning                                                   | unit          |
//! | `a_m, b_m` | weight times lever arm, in phase with the joint and out of it, one each for each output | of the output |
//! | `s`        | angle of the joint: a signal in rad                       | rad           |
//!
//! Bending angles of an arm are not joint angles. Siciliano, Sciavicco, Villani & Oriolo (2009), Robotics: Modelling, Planning
//! and Control, 7.2.

use super::carrying;
use crate::effects::{Carrier, Effect, Memory, ParameterSpec, Record, Rig, Site, Traits, Values, guesses};

/// See the head of this file.
pub struct JointGravity;

impl Effect for JointGravity {
    fn name(&self) -> &'static str {
        "joint_gravity"
    }

    fn meaning(&self) -> &'static str {
        "a weight that turns with a joint shifts the outputs"
    }

    fn site(&self) -> Site {
        Site::Output
    }

    fn source(&self) -> &'static str {
        "Siciliano, Sciavicco, Villani & Oriolo (2009), Robotics: Modelling, Planning and Control, 7.2"
    }

    fn traits(&self) -> Traits {
        Traits { is_static: true, ..Traits::default() }
    }

    fn carriers(&self, rig: &Rig) -> Vec<Carrier> {
        if rig.arm.is_some() {
            return vec![];
        }
        let turns = |carrier: &Carrier| carrying::range(rig, *carrier).0 == "rad";
        carrying::moving(rig).into_iter().filter(turns).collect()
    }

    fn parameters(&self, rig: &Rig, _: Carrier) -> Vec<ParameterSpec> {
        let sizes = |name| carrying::sizes(rig, name, "1", 1.0, 40.0);
        [sizes("sine"), sizes("cosine")].concat()
    }

    fn initial_guesses(&self, rig: &Rig, carrier: Carrier) -> Vec<Vec<f64>> {
        vec![guesses::guess(&self.parameters(rig, carrier), 1.0)]
    }

    fn proceed(&self, carrier: Carrier, values: Values, record: &Record, _: &mut Memory, columns: &mut [Vec<f64>]) {
        let Some(angle) = carrying::signal(record, carrier) else { return };
        let sizes = columns.len();
        for (m, y) in columns.iter_mut().enumerate() {
            for (t, (y, angle)) in y.iter_mut().zip(angle).enumerate() {
                let (sine, cosine) = angle.sin_cos();
                *y += values.at(m, t) * sine + values.at(sizes + m, t) * cosine;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    /// Oracle: by hand, at 0°, 30°, 90° and −180°.
    #[test]
    fn a_lever_arm_turns() {
        let record = Record::new(vec![0.0, 1.0, 2.0, 3.0], vec![vec![0.0, PI / 6.0, PI / 2.0, -PI]], vec![], vec![]);
        let mut columns = vec![vec![0.0; 4], vec![10.0; 4]];
        let values = Values::constant(&[], &[2.0, 0.0, 0.0, 3.0]);
        JointGravity.act(Carrier::Actuator(0), values, &record, &mut columns);
        for (found, expected) in columns[0].iter().zip([0.0, 1.0, 2.0, 0.0]) {
            assert!((found - expected).abs() < 1e-12);
        }
        for (found, expected) in columns[1].iter().zip([13.0, 10.0 + 1.5 * 3f64.sqrt(), 10.0, 7.0]) {
            assert!((found - expected).abs() < 1e-12);
        }
    }
}
