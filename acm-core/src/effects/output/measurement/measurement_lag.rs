//! Lag of the measurement: a filter in the instrument, or in what was done with its readings.
//!
//! ```text
//! τ dỹ/dt = y − ỹ,   ỹ(t_0) = y(t_0)
//! ```
//!
//! | symbol | meaning                    | unit |
//! | `τ`    | time constant, all outputs | s    |
//!
//! Franklin, Powell & Emami-Naeini (2019), Feedback Control of Dynamic Systems, ch. 3.

use crate::effects::memory::{Lag, pass};
use crate::effects::output::carrying;
use crate::effects::{Carrier, Effect, Memory, ParameterSpec, Record, Rig, Site, Traits, Values, times};

/// See the head of this file.
pub struct MeasurementLag;

impl Effect for MeasurementLag {
    fn name(&self) -> &'static str {
        "measurement_lag"
    }

    fn meaning(&self) -> &'static str {
        "the outputs are measured through a first-order lag"
    }

    fn site(&self) -> Site {
        Site::Output
    }

    fn source(&self) -> &'static str {
        "Franklin, Powell & Emami-Naeini (2019), Feedback Control of Dynamic Systems, ch. 3"
    }

    fn traits(&self) -> Traits {
        Traits { is_rare: true, is_output_filter: true, repeats: true, ..Traits::default() }
    }

    fn carriers(&self, rig: &Rig) -> Vec<Carrier> {
        if rig.duration > 0.0 { carrying::any(rig) } else { vec![] }
    }

    fn parameters(&self, rig: &Rig, _: Carrier) -> Vec<ParameterSpec> {
        vec![times::size(rig, "tau")]
    }

    fn initial_guesses(&self, rig: &Rig, _: Carrier) -> Vec<Vec<f64>> {
        times::grid(rig).into_iter().map(|time| vec![time]).collect()
    }

    fn proceed(&self, _: Carrier, values: Values, record: &Record, memory: &mut Memory, columns: &mut [Vec<f64>]) {
        pass(memory.states::<Lag>(columns.len()), &record.time, |t| values.at(0, t), columns);
    }

    fn memory(&self, values: Values) -> Option<f64> {
        Some(values.at(0, 0))
    }
}
