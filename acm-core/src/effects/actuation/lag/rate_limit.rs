//! Rate limit: the outputs follow each actuator at a limited speed.
//!
//! ```text
//! dq̃_j/dt = dq_j/dt where q̃_j = q_j and |dq_j/dt| ≤ 1/s_j,   else sgn(q_j − q̃_j)/s_j
//! ```
//!
//! | symbol | meaning                                              | unit                        |
//! | `s_j`  | slowness, one over the highest speed; 0 is no limit  | seconds per unit of the actuator |
//!
//! Exact for actuators that are linear between samples. Franklin, Powell & Emami-Naeini (2019), Feedback Control of
//! Dynamic Systems, ch. 9.

use crate::effects::actuation::actuators;
use crate::effects::{
    Carrier, Effect, Memory, ParameterSpec, Record, Rig, Site, Traits, Values, guesses, memory, times,
};
use crate::rig::Signal;

/// See the head of this file.
pub struct RateLimit;

impl Effect for RateLimit {
    fn name(&self) -> &'static str {
        "rate_limit"
    }

    fn meaning(&self) -> &'static str {
        "the outputs follow an actuator at a limited speed"
    }

    fn site(&self) -> Site {
        Site::Actuation
    }

    fn source(&self) -> &'static str {
        "Franklin, Powell & Emami-Naeini (2019), Feedback Control of Dynamic Systems, ch. 9"
    }

    fn traits(&self) -> Traits {
        Traits { is_rare: true, ..Traits::default() }
    }

    fn carriers(&self, rig: &Rig) -> Vec<Carrier> {
        actuators::moving(rig)
    }

    fn parameters(&self, rig: &Rig, _: Carrier) -> Vec<ParameterSpec> {
        let (typical, longest) = (times::typical(rig), times::longest(rig));
        let slowness = |q: &Signal| {
            let inverse = if q.varies() { 1.0 / q.span() } else { 0.0 };
            ParameterSpec::size(format!("slowness_{}", q.name), format!("s/({})", q.unit), typical * inverse)
                .within(0.0, longest * inverse)
        };
        rig.actuators.iter().map(slowness).collect()
    }

    /// Times that an actuator needs for its travel.
    fn initial_guesses(&self, rig: &Rig, carrier: Carrier) -> Vec<Vec<f64>> {
        let slowness = |j: usize, time: &f64| time / rig.actuators[j].span();
        guesses::of_each(rig, &self.parameters(rig, carrier), &times::grid(rig), slowness)
    }

    fn proceed(&self, _: Carrier, values: Values, record: &Record, memory: &mut Memory, columns: &mut [Vec<f64>]) {
        let limits = memory.states::<memory::RateLimit>(columns.len());
        for (j, (q, limit)) in columns.iter_mut().zip(limits).enumerate() {
            for (t, (q, time)) in q.iter_mut().zip(&record.time).enumerate() {
                *q = limit.step(*time, *q, values.at(j, t));
            }
        }
    }
}
