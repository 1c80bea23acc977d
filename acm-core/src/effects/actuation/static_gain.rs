//! Gain and offset of each actuator: what is commanded or read back is not what reaches the arm.
//!
//! ```text
//! q̃_j = (1 + g_j) q_j + o_j
//! ```
//!
//! | symbol | meaning           | unit            |
//! | `g_j`  | error of the gain | 1               |
//! | `o_j`  | offset            | of the actuator |
//!
//! JCGM 200:2012, International vocabulary of metrology, 4.12 and 4.28 (sensitivity and zero error).

use super::actuators;
use crate::effects::{Carrier, Effect, Memory, ParameterSpec, Record, Rig, Site, Traits, Values, guesses};

/// See the head of this file.
pub struct StaticGain;

impl Effect for StaticGain {
    fn name(&self) -> &'static str {
        "static_gain"
    }

    fn meaning(&self) -> &'static str {
        "an actuator moves the outputs by a different gain, and from a different zero, than assumed"
    }

    fn site(&self) -> Site {
        Site::Actuation
    }

    fn source(&self) -> &'static str {
        "JCGM 200:2012, International vocabulary of metrology"
    }

    fn traits(&self) -> Traits {
        Traits { is_static: true, is_calibrated_away: true, ..Traits::default() }
    }

    fn carriers(&self, rig: &Rig) -> Vec<Carrier> {
        actuators::moving(rig)
    }

    fn parameters(&self, rig: &Rig, _: Carrier) -> Vec<ParameterSpec> {
        let gains = actuators::shares(rig, "gain", [0.05, -0.5, 0.5]);
        gains.chain(actuators::sizes(rig, "offset", [0.05, -0.3, 0.3])).collect()
    }

    fn initial_guesses(&self, rig: &Rig, carrier: Carrier) -> Vec<Vec<f64>> {
        let specs = self.parameters(rig, carrier);
        vec![guesses::guess(&specs, 0.5)]
    }

    fn proceed(&self, _: Carrier, values: Values, _: &Record, _: &mut Memory, columns: &mut [Vec<f64>]) {
        let offsets = columns.len();
        for (j, q) in columns.iter_mut().enumerate() {
            for (t, q) in q.iter_mut().enumerate() {
                *q += values.at(j, t) * *q + values.at(offsets + j, t);
            }
        }
    }
}
