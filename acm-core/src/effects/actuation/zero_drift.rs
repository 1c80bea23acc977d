//! Drift of the zero: each actuator's origin moves steadily as a trial goes on.
//!
//! ```text
//! q̃_j = q_j + k_j (t − t_0)
//! ```
//!
//! | symbol | meaning                                | unit                       |
//! | `k_j`  | rate at which the zero moves           | of the actuator, per second |
//! | `t_0`  | time of the first sample of the trial  | s                          |
//!
//! JCGM 200:2012, International vocabulary of metrology, 4.21 (instrumental drift).

use super::actuators;
use crate::effects::{Carrier, Effect, Memory, ParameterSpec, Record, Rig, Site, Traits, Values, guesses, times};

/// See the head of this file.
pub struct ZeroDrift;

impl Effect for ZeroDrift {
    fn name(&self) -> &'static str {
        "zero_drift"
    }

    fn meaning(&self) -> &'static str {
        "the zero of an actuator moves steadily during a trial"
    }

    fn site(&self) -> Site {
        Site::Actuation
    }

    fn source(&self) -> &'static str {
        "JCGM 200:2012, International vocabulary of metrology, 4.21"
    }

    fn traits(&self) -> Traits {
        Traits { is_drift: true, is_generic: true, ..Traits::default() }
    }

    fn carriers(&self, rig: &Rig) -> Vec<Carrier> {
        actuators::moving(rig)
    }

    fn parameters(&self, rig: &Rig, _: Carrier) -> Vec<ParameterSpec> {
        let once = 1.0 / times::trial(rig);
        let rate = |mut spec: ParameterSpec| {
            spec.unit = format!("{}/s", spec.unit);
            spec
        };
        actuators::sizes(rig, "rate", [0.05 * once, -0.5 * once, 0.5 * once]).map(rate).collect()
    }

    fn initial_guesses(&self, rig: &Rig, carrier: Carrier) -> Vec<Vec<f64>> {
        let specs = self.parameters(rig, carrier);
        vec![guesses::guess(&specs, 1.0), guesses::guess(&specs, -1.0)]
    }

    fn proceed(&self, _: Carrier, values: Values, record: &Record, memory: &mut Memory, columns: &mut [Vec<f64>]) {
        let start = memory.start(&record.time);
        for (j, q) in columns.iter_mut().enumerate() {
            for (t, (q, time)) in q.iter_mut().zip(&record.time).enumerate() {
                *q += values.at(j, t) * (time - start);
            }
        }
    }
}
