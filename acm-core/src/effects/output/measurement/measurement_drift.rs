//! Drift of the measurement: the outputs drift from the start of every trial at a constant rate.
//!
//! ```text
//! ỹ_m = y_m + v_m (t − t_0)
//! ```
//!
//! | symbol | meaning                       | unit                |
//! | `v_m`  | rate, one for each output     | of the output per s |
//!
//! Fraden (2016), Handbook of Modern Sensors, ch. 3.

use crate::effects::output::carrying;
use crate::effects::{Carrier, Effect, Memory, ParameterSpec, Record, Rig, Site, Traits, Values, guesses};

/// See the head of this file.
pub struct MeasurementDrift;

impl Effect for MeasurementDrift {
    fn name(&self) -> &'static str {
        "measurement_drift"
    }

    fn meaning(&self) -> &'static str {
        "the measured outputs drift during a trial"
    }

    fn site(&self) -> Site {
        Site::Output
    }

    fn source(&self) -> &'static str {
        "Fraden (2016), Handbook of Modern Sensors, ch. 3"
    }

    fn traits(&self) -> Traits {
        Traits { is_drift: true, is_generic: true, ..Traits::default() }
    }

    fn carriers(&self, rig: &Rig) -> Vec<Carrier> {
        if rig.duration > 0.0 { carrying::any(rig) } else { vec![] }
    }

    fn parameters(&self, rig: &Rig, _: Carrier) -> Vec<ParameterSpec> {
        carrying::sizes(rig, "rate", "s", rig.duration, 40.0)
    }

    fn initial_guesses(&self, rig: &Rig, carrier: Carrier) -> Vec<Vec<f64>> {
        vec![guesses::guess(&self.parameters(rig, carrier), 0.5)]
    }

    fn proceed(&self, _: Carrier, values: Values, record: &Record, memory: &mut Memory, columns: &mut [Vec<f64>]) {
        let start = memory.start(&record.time);
        carrying::add(columns, |m, t| values.at(m, t), memory.column(record.time.iter().map(|time| time - start)));
    }
}
