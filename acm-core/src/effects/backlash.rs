//! Backlash: each actuator moves within its play before anything follows.
//!
//! ```text
//! q̃_k = min( max( q̃_{k−1}, q_k − w ), q_k + w ),   q̃_0 = q_0
//! ```
//!
//! | symbol | meaning                             | unit         |
//! | `w`    | half the play, one for each actuator | of the actuator |
//!
//! Nordin & Gutman (2002), Automatica 38(10).

use super::{Carrier, Effect, ParameterSpec, Record, Rig, Site, Values, memory};
use crate::rig::Signal;

/// See the head of this file.
pub struct Backlash;

impl Effect for Backlash {
    fn name(&self) -> &'static str {
        "backlash"
    }

    fn meaning(&self) -> &'static str {
        "an actuator moves within a play before the arm follows"
    }

    fn site(&self) -> Site {
        Site::Actuation
    }

    fn source(&self) -> &'static str {
        "Nordin & Gutman (2002), Automatica 38(10)"
    }

    fn carriers(&self, rig: &Rig) -> Vec<Carrier> {
        if rig.actuators.iter().any(|q| q.varies()) { vec![Carrier::Rig] } else { vec![] }
    }

    fn parameters(&self, rig: &Rig, _: Carrier) -> Vec<ParameterSpec> {
        let of = |q: &Signal| {
            ParameterSpec::size(format!("width_{}", q.name), &q.unit, 0.05 * q.span()).within(0.0, 0.3 * q.span())
        };
        rig.actuators.iter().map(of).collect()
    }

    fn starts(&self, rig: &Rig, carrier: Carrier) -> Vec<Vec<f64>> {
        let scales: Vec<f64> = self.parameters(rig, carrier).iter().map(|p| p.scale).collect();
        [0.4, 1.5].iter().map(|share| scales.iter().map(|scale| share * scale).collect()).collect()
    }

    fn act(&self, _: Carrier, values: Values, _: &Record, columns: &mut [Vec<f64>]) {
        for (j, q) in columns.iter_mut().enumerate() {
            memory::play(q, |t| values.at(j, t));
        }
    }
}
