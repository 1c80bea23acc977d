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

use crate::effects::actuation::actuators;
use crate::effects::memory::Play;
use crate::effects::{Carrier, Effect, Memory, ParameterSpec, Record, Rig, Site, Values, guesses};

/// See the head of this file.
pub struct Backlash;

impl Effect for Backlash {
    fn name(&self) -> &'static str {
        "backlash"
    }

    fn meaning(&self) -> &'static str {
        "an actuator moves within a play before the outputs follow"
    }

    fn site(&self) -> Site {
        Site::Actuation
    }

    fn source(&self) -> &'static str {
        "Nordin & Gutman (2002), Automatica 38(10)"
    }

    fn carriers(&self, rig: &Rig) -> Vec<Carrier> {
        actuators::moving(rig)
    }

    fn parameters(&self, rig: &Rig, _: Carrier) -> Vec<ParameterSpec> {
        actuators::sizes(rig, "width", [0.05, 0.0, 0.5]).collect()
    }

    fn initial_guesses(&self, rig: &Rig, carrier: Carrier) -> Vec<Vec<f64>> {
        let half = |j: usize, play: &f64| 0.5 * play * actuators::travel(&rig.actuators[j]);
        guesses::of_each(rig, &self.parameters(rig, carrier), &guesses::lengths(), half)
    }

    fn proceed(&self, _: Carrier, values: Values, _: &Record, memory: &mut Memory, columns: &mut [Vec<f64>]) {
        let plays = memory.states::<Play>(columns.len());
        for (j, (q, play)) in columns.iter_mut().zip(plays).enumerate() {
            q.iter_mut().enumerate().for_each(|(t, q)| *q = play.step(*q, values.at(j, t)));
        }
    }
}
