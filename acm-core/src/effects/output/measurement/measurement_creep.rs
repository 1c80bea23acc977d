//! Creep of the measurement: part of each change of the outputs is measured late, as by a load cell, or behind a part that yields slowly.
//!
//! ```text
//! ỹ = y + c (L_τ[y] − y),   τ dL/dt = y − L,   L(t_0) = y(t_0)
//! ```
//!
//! | symbol | meaning                                                               | unit |
//! | `c`    | share that is measured late; negative where readings sink back         | 1    |
//! | `τ`    | its time constant, all outputs                                        | s    |
//!
//! The standard linear solid behind the model; `creep` is the same before it. Findley, Lai & Onaran (1976), Creep and Relaxation of
//! Nonlinear Viscoelastic Materials, ch. 5.

use crate::effects::memory::creep;
use crate::effects::output::carrying;
use crate::effects::{Carrier, Effect, Memory, ParameterSpec, Record, Rig, Site, Traits, Values, guesses, times};

/// See the head of this file.
pub struct MeasurementCreep;

/// Largest share. A larger one is a lag.
const LARGEST: f64 = 0.3;

impl Effect for MeasurementCreep {
    fn name(&self) -> &'static str {
        "measurement_creep"
    }

    fn meaning(&self) -> &'static str {
        "part of each change of the outputs is measured late"
    }

    fn site(&self) -> Site {
        Site::Output
    }

    fn source(&self) -> &'static str {
        "Findley, Lai & Onaran (1976), Creep and Relaxation of Nonlinear Viscoelastic Materials, ch. 5"
    }

    fn traits(&self) -> Traits {
        Traits { is_rare: true, is_output_filter: true, repeats: true, ..Traits::default() }
    }

    fn carriers(&self, rig: &Rig) -> Vec<Carrier> {
        if rig.duration > 0.0 && rig.arm.is_none() { carrying::any(rig) } else { vec![] }
    }

    fn parameters(&self, rig: &Rig, _: Carrier) -> Vec<ParameterSpec> {
        vec![ParameterSpec::size("share", "1", 0.1).within(-LARGEST, LARGEST), times::slow(rig, "tau")]
    }

    fn initial_guesses(&self, rig: &Rig, carrier: Carrier) -> Vec<Vec<f64>> {
        let specs = self.parameters(rig, carrier);
        times::grid(rig).into_iter().map(|tau| guesses::guess_with(&specs, 1.0, 1, tau)).collect()
    }

    fn proceed(&self, _: Carrier, values: Values, record: &Record, memory: &mut Memory, columns: &mut [Vec<f64>]) {
        creep(memory, &record.time, |t| [0, 1].map(|j| values.at(j, t)), columns);
    }

    fn memory(&self, values: Values) -> Option<f64> {
        Some(values.at(1, 0))
    }
}
