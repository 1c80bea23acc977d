//! Dead zone: an actuator has no effect near its rest, until slack or a threshold is overcome.
//!
//! ```text
//! q̃_j = z_j + c(q_j − z_j − w_j) − c(z_j − q_j − w_j),   c(d) = max(0, d) with a corner of the radius r w_j ([`super::corner`])
//! ```
//!
//! | symbol | meaning                                     | unit            |
//! | `w_j`  | half the zone                               | of the actuator |
//! | `r`    | roundness of both ends; 0 for sharp ones    | 1               |
//! | `z_j`  | rest; 0 for actuators that come to zero     | of the actuator |
//!
//! Commands of 0 to 10 V, or of 1 to 2 ms, rest within their range; without an arm these have a dead zone too.
//!
//! No memory: unlike backlash it is fixed in place. Khalil (2002), Nonlinear Systems, 3rd ed., 1.2.

use super::actuators::crosses_zero;
use super::{actuators, corner};
use crate::effects::{Carrier, Effect, Memory, ParameterSpec, Record, Rig, Site, Traits, Values, guesses};
use crate::rig::Signal;

/// See the head of this file.
pub struct DeadZone;

/// Whether an actuator can rest: at zero, or without an arm anywhere in its range.
fn rests(rig: &Rig, q: &Signal) -> bool {
    crosses_zero(q) || q.varies() && rig.arm.is_none()
}

/// Zones to start from, as shares of the half range.
const ZONES: [f64; 5] = [0.01, 0.03, 0.1, 0.2, 0.4];

impl Effect for DeadZone {
    fn name(&self) -> &'static str {
        "dead_zone"
    }

    fn meaning(&self) -> &'static str {
        "nothing follows an actuator near its rest"
    }

    fn site(&self) -> Site {
        Site::Actuation
    }

    fn source(&self) -> &'static str {
        "Khalil (2002), Nonlinear Systems, 3rd ed., 1.2"
    }

    fn traits(&self) -> Traits {
        Traits { is_static: true, is_rare: true, is_generic: true, ..Traits::default() }
    }

    fn carriers(&self, rig: &Rig) -> Vec<Carrier> {
        if rig.actuators.iter().any(|q| rests(rig, q)) { vec![Carrier::Rig] } else { vec![] }
    }

    fn parameters(&self, rig: &Rig, _: Carrier) -> Vec<ParameterSpec> {
        let half = |(q, spec): (&Signal, ParameterSpec)| if rests(rig, q) { spec } else { spec.within(0.0, 0.0) };
        let halves = rig.actuators.iter().zip(actuators::sizes(rig, "half_width", [0.05, 0.0, 1.0])).map(half);
        let rest = |q: &Signal| {
            let name = format!("rest_{}", q.name);
            match rests(rig, q) && !crosses_zero(q) {
                true => {
                    ParameterSpec::shape(name, &q.unit, 0.5 * (q.low + q.high), 0.1 * q.span()).within(q.low, q.high)
                }
                false => ParameterSpec::known(name, &q.unit, 0.0),
            }
        };
        halves.chain([corner::roundness()]).chain(rig.actuators.iter().map(rest)).collect()
    }

    fn initial_guesses(&self, rig: &Rig, carrier: Carrier) -> Vec<Vec<f64>> {
        let half = |j: usize, zone: &f64| 0.5 * zone * actuators::travel(&rig.actuators[j]);
        let guesses = guesses::of_each(rig, &self.parameters(rig, carrier), &ZONES, half);
        let halves = |guess: &Vec<f64>| guess[..rig.actuators.len()].iter().any(|half| *half > 0.0);
        guesses.into_iter().filter(halves).collect()
    }

    fn proceed(&self, _: Carrier, values: Values, _: &Record, _: &mut Memory, columns: &mut [Vec<f64>]) {
        let count = columns.len();
        let roundness = values.at(count, 0);
        for (j, q) in columns.iter_mut().enumerate() {
            let rest = values.at(count + 1 + j, 0);
            for (t, q) in q.iter_mut().enumerate() {
                let half = values.at(j, t);
                if half > 0.0 {
                    let end = |d: f64| corner::rounded(d - half, roundness * half);
                    *q = rest + (end(*q - rest) - end(rest - *q));
                }
            }
        }
    }
}
