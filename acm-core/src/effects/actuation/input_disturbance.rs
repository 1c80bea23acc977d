//! Input disturbance: a context signal adds to an actuator ahead of its dynamics, such as the back EMF of a coil that moves, a load
//! torque, or the temperature of the room that a heater starts from.
//!
//! ```text
//! q̃_j = q_j + a_j (c − c_0)
//! ```
//!
//! | symbol | meaning                                                                         | unit                     |
//! | `a_j`  | what a unit of the signal is worth at each actuator                             | of the actuator per unit |
//! | `c`    | context signal                                                                  | its own                  |
//! | `c_0`  | middle of its range: what it does there, the nominal model has already          | of the signal            |
//!
//! Lags, creep and hysteresis of the actuators act on the sum; `context_term` adds after them. Åström & Hägglund (2006),
//! Advanced PID Control, ch. 4: load disturbances enter at the process input.

use super::actuators;
use crate::effects::output::carrying;
use crate::effects::{Carrier, Effect, Memory, ParameterSpec, Record, Rig, Site, Traits, Values, guesses};
use crate::rig::Signal;

/// See the head of this file.
pub struct InputDisturbance;

/// Most moving actuators of a rig with it.
const FEW: usize = 3;

/// Typical and largest effect of the signal's range, in ranges of the actuator.
const SHARES: (f64, f64) = (0.1, 10.0);

impl Effect for InputDisturbance {
    fn name(&self) -> &'static str {
        "input_disturbance"
    }

    fn meaning(&self) -> &'static str {
        "a context signal adds to the actuators ahead of their dynamics"
    }

    fn site(&self) -> Site {
        Site::Actuation
    }

    fn source(&self) -> &'static str {
        "Åström & Hägglund (2006), Advanced PID Control, ch. 4"
    }

    fn traits(&self) -> Traits {
        Traits { is_rare: true, refines: Some("context_term"), ..Traits::default() }
    }

    fn carriers(&self, rig: &Rig) -> Vec<Carrier> {
        let moving = rig.actuators.iter().filter(|q| q.varies()).count();
        let is_small = (1..=FEW).contains(&moving) && rig.arm.is_none();
        if is_small { carrying::moving_contexts(rig) } else { vec![] }
    }

    fn parameters(&self, rig: &Rig, carrier: Carrier) -> Vec<ParameterSpec> {
        let (unit, width) = carrying::range(rig, carrier);
        let of = |q: &Signal| {
            let whole = actuators::travel(q) / width;
            let spec =
                ParameterSpec::size(format!("worth_{}", q.name), carrying::per(&q.unit, &unit), SHARES.0 * whole);
            spec.within(-SHARES.1 * whole, SHARES.1 * whole)
        };
        let mut specs: Vec<ParameterSpec> = rig.actuators.iter().map(of).collect();
        specs.push(ParameterSpec::known("centre", unit, carrying::middle(rig, carrier)));
        specs
    }

    fn initial_guesses(&self, rig: &Rig, carrier: Carrier) -> Vec<Vec<f64>> {
        let specs = self.parameters(rig, carrier);
        [-3.0, -0.5, 0.5, 3.0].map(|share| guesses::guess(&specs, share)).into()
    }

    fn proceed(
        &self,
        carrier: Carrier,
        values: Values,
        record: &Record,
        memory: &mut Memory,
        columns: &mut [Vec<f64>],
    ) {
        carrying::add_about_centre(carrier, values, record, memory, columns);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: by hand.
    #[test]
    fn it_is_silent_at_the_middle_of_the_range() {
        let record = Record::new(vec![0.0, 1.0], vec![], vec![vec![300.0, 310.0]], vec![]);
        let mut columns = vec![vec![1.0, 1.0], vec![0.0, 0.0]];
        InputDisturbance.act(Carrier::Context(0), Values::constant(&[], &[0.2, -1.0, 300.0]), &record, &mut columns);
        assert_eq!(columns, [[1.0, 3.0], [0.0, -10.0]]);
    }
}
