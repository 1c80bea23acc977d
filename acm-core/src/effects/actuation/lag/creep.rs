//! Creep: part of each actuator motion is delayed.
//!
//! ```text
//! q̃ = q + c (L_τ[q] − q),   τ dL/dt = q − L,   L(t_0) = q(t_0)
//! ```
//!
//! | symbol | meaning                                                              | unit |
//! | `c`    | share that comes late; negative where the arm relaxes after a motion | 1    |
//! | `τ`    | its time constant, all actuators                                     | s    |
//!
//! The standard linear solid; two time constants are two creeps in series. Exact for actuators that are linear between samples.
//! Findley, Lai & Onaran (1976), Creep and Relaxation of Nonlinear Viscoelastic Materials, ch. 5.

use crate::effects::actuation::actuators;
use crate::effects::memory::creep;
use crate::effects::{
    Carrier, Commutes, Effect, Memory, ParameterSpec, Record, Rig, Site, Traits, Values, guesses, times,
};

/// See the head of this file.
pub struct Creep;

impl Effect for Creep {
    fn name(&self) -> &'static str {
        "creep"
    }

    fn meaning(&self) -> &'static str {
        "part of each motion comes late"
    }

    fn site(&self) -> Site {
        Site::Actuation
    }

    fn source(&self) -> &'static str {
        "Findley, Lai & Onaran (1976), Creep and Relaxation of Nonlinear Viscoelastic Materials, ch. 5"
    }

    fn traits(&self) -> Traits {
        Traits { is_generic: true, repeats: true, commutes: Commutes::WithFilters, ..Traits::default() }
    }

    fn carriers(&self, rig: &Rig) -> Vec<Carrier> {
        actuators::moving(rig)
    }

    fn parameters(&self, rig: &Rig, _: Carrier) -> Vec<ParameterSpec> {
        vec![ParameterSpec::size("share", "1", 0.1).within(-0.9, 0.9), times::slow(rig, "tau")]
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
