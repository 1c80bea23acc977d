//! Rate limit: what moves the arm follows each actuator at no more than a certain speed.
//!
//! ```text
//! dq̃_j/dt = dq_j/dt where q̃_j = q_j and |dq_j/dt| ≤ 1/s_j,   else sgn(q_j − q̃_j)/s_j
//! ```
//!
//! | symbol | meaning                                              | unit                        |
//! | `s_j`  | slowness, one over the highest speed; 0 is no limit  | seconds per unit of the actuator |
//!
//! Exact for actuators that move straight between samples. Franklin, Powell & Emami-Naeini (2019), Feedback Control of
//! Dynamic Systems, ch. 9.

use super::{Carrier, Effect, Memory, ParameterSpec, Record, Rig, Site, Traits, Values, actuators, memory};
use crate::rig::Signal;

/// See the head of this file.
pub struct RateLimit;

/// Shortest and longest time that an actuator may need for its travel, s.
fn crossing(rig: &Rig) -> (f64, f64) {
    let longest = (0.5 * actuators::trial(rig)).min(60.0);
    ((5.0 * rig.step).clamp(1e-3 * longest, 0.1 * longest), longest)
}

impl Effect for RateLimit {
    fn name(&self) -> &'static str {
        "rate_limit"
    }

    fn meaning(&self) -> &'static str {
        "the arm follows an actuator at no more than a certain speed"
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
        let longest = crossing(rig).1;
        let slowness = |q: &Signal| {
            let whole = if q.varies() { longest / q.span() } else { 0.0 };
            ParameterSpec::size(format!("slowness_{}", q.name), format!("s/({})", q.unit), 0.1 * whole)
                .within(0.0, whole)
        };
        rig.actuators.iter().map(slowness).collect()
    }

    fn starts(&self, rig: &Rig, carrier: Carrier) -> Vec<Vec<f64>> {
        let specs = self.parameters(rig, carrier);
        let (shortest, longest) = crossing(rig);
        let share = |time: f64| time / (0.1 * longest);
        actuators::spread(shortest, 0.8 * longest, 5)
            .into_iter()
            .map(|time| actuators::start(&specs, share(time)))
            .collect()
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
