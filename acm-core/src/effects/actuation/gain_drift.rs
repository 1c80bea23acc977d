//! Drift of the gain: the same actuation moves the arm more, or less, as a trial goes on.
//!
//! ```text
//! q̃ = q (1 + k (t − t_0))
//! ```
//!
//! | symbol | meaning                                | unit |
//! | `k`    | rate at which the gain changes         | 1/s  |
//! | `t_0`  | time of the first sample of the trial  | s    |
//!
//! JCGM 200:2012, International vocabulary of metrology, 4.21 (instrumental drift).

use super::actuators;
use crate::effects::{Carrier, Effect, Memory, ParameterSpec, Record, Rig, Site, Traits, Values, guesses, times};

/// See the head of this file.
pub struct GainDrift;

impl Effect for GainDrift {
    fn name(&self) -> &'static str {
        "gain_drift"
    }

    fn meaning(&self) -> &'static str {
        "the gain of the actuators changes steadily during a trial"
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
        vec![ParameterSpec::size("rate", "1/s", 0.05 * once).within(-0.5 * once, 0.5 * once)]
    }

    fn initial_guesses(&self, rig: &Rig, carrier: Carrier) -> Vec<Vec<f64>> {
        let specs = self.parameters(rig, carrier);
        vec![guesses::guess(&specs, 1.0), guesses::guess(&specs, -1.0)]
    }

    fn proceed(&self, _: Carrier, values: Values, record: &Record, memory: &mut Memory, columns: &mut [Vec<f64>]) {
        let start = memory.start(&record.time);
        for q in columns {
            for (t, (q, time)) in q.iter_mut().zip(&record.time).enumerate() {
                *q += *q * values.at(0, t) * (time - start);
            }
        }
    }
}
