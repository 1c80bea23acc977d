//! Viscous slip: a soft drive yields in proportion to the speed at which it is moved.
//!
//! ```text
//! q̃_j = q_j − c_j dq_j/dt
//! ```
//!
//! | symbol | meaning                                                              | unit |
//! | `c_j`  | time by which the arm trails; negative where it runs ahead           | s    |
//!
//! The speed is the slope of a line through the samples around each ([`Slopes`]), so it sees two samples of the future
//! where there are any. First order of a lag, for one actuator at a time; Olsson et al. (1998), European Journal of
//! Control 4(3).

use super::{Carrier, Effect, Memory, ParameterSpec, Record, Rig, Site, Traits, Values, actuators, memory::Slopes};
use crate::rig::Signal;

/// See the head of this file.
pub struct ViscousSlip;

impl Effect for ViscousSlip {
    fn name(&self) -> &'static str {
        "viscous_slip"
    }

    fn meaning(&self) -> &'static str {
        "an actuator trails in proportion to its speed"
    }

    fn site(&self) -> Site {
        Site::Actuation
    }

    fn source(&self) -> &'static str {
        "Olsson et al. (1998), European Journal of Control 4(3)"
    }

    fn traits(&self) -> Traits {
        Traits { is_rare: true, shows_against_rate: true, ..Traits::default() }
    }

    fn carriers(&self, rig: &Rig) -> Vec<Carrier> {
        actuators::moving(rig)
    }

    fn parameters(&self, rig: &Rig, _: Carrier) -> Vec<ParameterSpec> {
        let longest = (0.1 * actuators::trial(rig)).min(2.0);
        let time = |q: &Signal| {
            let longest = if q.varies() { longest } else { 0.0 };
            ParameterSpec::size(format!("trail_{}", q.name), "s", longest.min(0.1)).within(-longest, longest)
        };
        rig.actuators.iter().map(time).collect()
    }

    fn starts(&self, rig: &Rig, carrier: Carrier) -> Vec<Vec<f64>> {
        let specs = self.parameters(rig, carrier);
        vec![actuators::start(&specs, 0.5), actuators::start(&specs, -0.5)]
    }

    fn proceed(&self, _: Carrier, values: Values, record: &Record, memory: &mut Memory, columns: &mut [Vec<f64>]) {
        let slopes = memory.states::<Slopes>(columns.len());
        for (j, (q, slopes)) in columns.iter_mut().zip(slopes).enumerate() {
            let speed = slopes.of(&record.time, q);
            for (t, (q, speed)) in q.iter_mut().zip(speed).enumerate() {
                *q -= values.at(j, t) * speed;
            }
        }
    }
}
