//! First-order lag of the actuation: the outputs follow the actuators as a low-pass filter does.
//!
//! ```text
//! τ dq̃/dt = q − q̃,   q̃(t_0) = q(t_0)
//! ```
//!
//! | symbol | meaning                        | unit |
//! | `τ`    | time constant                  | s    |
//!
//! All actuators lag alike, or one of a few by itself, as a heater does beside a fan.
//!
//! Exact for actuators that are linear between samples. Franklin, Powell & Emami-Naeini (2019), Feedback Control of
//! Dynamic Systems, ch. 3.

use crate::effects::actuation::actuators;
use crate::effects::memory::{Lag, pass};
use crate::effects::{Carrier, Commutes, Effect, Memory, ParameterSpec, Record, Rig, Site, Traits, Values, times};

/// See the head of this file.
pub struct ActuatorLag;

impl Effect for ActuatorLag {
    fn name(&self) -> &'static str {
        "actuator_lag"
    }

    fn meaning(&self) -> &'static str {
        "the outputs follow the actuators as a first-order lag"
    }

    fn site(&self) -> Site {
        Site::Actuation
    }

    fn source(&self) -> &'static str {
        "Franklin, Powell & Emami-Naeini (2019), Feedback Control of Dynamic Systems, ch. 3"
    }

    fn traits(&self) -> Traits {
        Traits { shows_against_rate: true, commutes: Commutes::WithFilters, ..Traits::default() }
    }

    fn carriers(&self, rig: &Rig) -> Vec<Carrier> {
        actuators::together_or_alone(rig)
    }

    fn parameters(&self, rig: &Rig, _: Carrier) -> Vec<ParameterSpec> {
        vec![times::size(rig, "tau")]
    }

    fn initial_guesses(&self, rig: &Rig, _: Carrier) -> Vec<Vec<f64>> {
        times::grid(rig).into_iter().map(|time| vec![time]).collect()
    }

    fn proceed(
        &self,
        carrier: Carrier,
        values: Values,
        record: &Record,
        memory: &mut Memory,
        columns: &mut [Vec<f64>],
    ) {
        let lags = memory.states::<Lag>(columns.len());
        let lagging = actuators::acting(carrier, columns.len());
        pass(lags, &record.time, |t| values.at(0, t), &mut columns[lagging]);
    }

    fn memory(&self, values: Values) -> Option<f64> {
        Some(values.at(0, 0))
    }
}
