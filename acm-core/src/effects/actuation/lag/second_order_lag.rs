//! Second-order response of the actuation: the outputs follow the actuators as a sprung mass does, and may overshoot.
//!
//! ```text
//! q̃'' + 2ζω q̃' + ω² q̃ = ω² q,   ω = 2π/P,   q̃(t_0) = q(t_0),   q̃'(t_0) = 0
//! ```
//!
//! | symbol | meaning                           | unit |
//! | `P`    | natural period, all actuators     | s    |
//! | `ζ`    | damping, all actuators            | 1    |
//!
//! Exact for actuators that are linear between samples. Franklin, Powell & Emami-Naeini (2019), Feedback Control of
//! Dynamic Systems, ch. 3.

use std::f64::consts::TAU;

use crate::effects::actuation::actuators;
use crate::effects::{
    Carrier, Commutes, Effect, Memory, ParameterSpec, Record, Rig, Site, Traits, Values, memory, oscillators,
};

/// See the head of this file.
pub struct SecondOrderLag;

impl Effect for SecondOrderLag {
    fn name(&self) -> &'static str {
        "second_order_lag"
    }

    fn meaning(&self) -> &'static str {
        "the outputs follow the actuators as a sprung mass, and may overshoot"
    }

    fn site(&self) -> Site {
        Site::Actuation
    }

    fn source(&self) -> &'static str {
        "Franklin, Powell & Emami-Naeini (2019), Feedback Control of Dynamic Systems, ch. 3"
    }

    fn traits(&self) -> Traits {
        Traits { is_rare: true, is_resonance: true, commutes: Commutes::WithFilters, ..Traits::default() }
    }

    fn carriers(&self, rig: &Rig) -> Vec<Carrier> {
        actuators::moving(rig)
    }

    fn parameters(&self, rig: &Rig, _: Carrier) -> Vec<ParameterSpec> {
        oscillators::parameters(rig)
    }

    fn initial_guesses(&self, rig: &Rig, _: Carrier) -> Vec<Vec<f64>> {
        oscillators::grid(rig)
    }

    fn proceed(&self, _: Carrier, values: Values, record: &Record, memory: &mut Memory, columns: &mut [Vec<f64>]) {
        let lags = memory.states::<memory::SecondOrderLag>(columns.len());
        memory::pass(lags, &record.time, |t| (values.at(0, t) / TAU, values.at(1, t)), columns);
    }

    fn memory(&self, values: Values) -> Option<f64> {
        Some(oscillators::fading(values.at(0, 0), values.at(1, 0)))
    }

    fn second_memory(&self, values: Values) -> Option<f64> {
        oscillators::fading_faster(values.at(0, 0), values.at(1, 0))
    }

    fn swinging(&self, values: Values) -> f64 {
        oscillators::swinging(values.at(0, 0), values.at(1, 0))
    }
}
