//! Gain of the actuators that depends on a context signal, ahead of their dynamics: a motor on a supply that sags, a valve under a
//! pressure that drops.
//!
//! ```text
//! q̃_j = q_j (1 + k (c − c_0))
//! ```
//!
//! | symbol | meaning                                                                         | unit                  |
//! | `k`    | relative change of every actuator for a unit of the signal                      | 1 per unit of `c`     |
//! | `c`    | context signal                                                                  | its own               |
//! | `c_0`  | middle of its range: what the gain is there, the nominal model has already      | of the signal         |
//!
//! Lags, friction and hysteresis of the actuators act on the product; `context_gain` multiplies after them. Mohan, Undeland &
//! Robbins (2003), Power Electronics, ch. 7: the mean voltage of a switched bridge is the duty times the voltage of its supply.

use crate::effects::output::carrying;
use crate::effects::output::context::context_gain::{self, ContextGain};
use crate::effects::{Carrier, Effect, Memory, ParameterSpec, Record, Rig, Site, Traits, Values};
use crate::rig::Signal;

/// See the head of this file.
pub struct InputGain;

impl Effect for InputGain {
    fn name(&self) -> &'static str {
        "input_gain"
    }

    fn meaning(&self) -> &'static str {
        "the actuators act by a gain that follows a context signal, ahead of their dynamics"
    }

    fn site(&self) -> Site {
        Site::Actuation
    }

    fn source(&self) -> &'static str {
        "Mohan, Undeland & Robbins (2003), Power Electronics, ch. 7"
    }

    fn traits(&self) -> Traits {
        Traits { is_rare: true, refines: Some("context_gain"), ..Traits::default() }
    }

    fn carriers(&self, rig: &Rig) -> Vec<Carrier> {
        let is_driven = rig.arm.is_none() && rig.actuators.iter().any(Signal::varies);
        if is_driven { carrying::moving_contexts(rig) } else { vec![] }
    }

    fn parameters(&self, rig: &Rig, carrier: Carrier) -> Vec<ParameterSpec> {
        ContextGain.parameters(rig, carrier)
    }

    fn initial_guesses(&self, rig: &Rig, carrier: Carrier) -> Vec<Vec<f64>> {
        ContextGain.initial_guesses(rig, carrier)
    }

    fn proceed(&self, carrier: Carrier, values: Values, record: &Record, _: &mut Memory, columns: &mut [Vec<f64>]) {
        context_gain::multiply(carrier, values, record, columns);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: by hand. Half the duty on 24 V is 12 V, and 10 V where the supply has sagged to 20 V.
    #[test]
    fn a_bridge_follows_its_supply() {
        let record = Record::new(vec![0.0, 1.0], vec![], vec![vec![24.0, 20.0]], vec![]);
        let mut columns = vec![vec![12.0, 12.0]];
        InputGain.act(Carrier::Context(0), Values::constant(&[], &[1.0 / 24.0, 24.0]), &record, &mut columns);
        assert_eq!(columns[0][0], 12.0);
        assert!((columns[0][1] - 10.0).abs() < 1e-12);
    }
}
