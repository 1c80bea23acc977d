//! Dahl friction: dry friction that builds up over a presliding length shifts the outputs.
//!
//! ```text
//! ỹ_m = y_m + f_m d(s),   δ dd = (sgn ṡ − d) |ds|,   d(t_0) = 0
//! ```
//!
//! | symbol | meaning                                                                        | unit          |
//! | `f_m`  | friction, one for each output                                                  | of the output |
//! | `s`    | the signal whose motion carries the friction                                   | its own       |
//! | `d`    | direction of its motion in [−1, 1] (Dahl): noise smaller than δ does not turn it | 1           |
//! | `δ`    | presliding length                                                              | of the signal |
//!
//! Dahl (1968), Aerospace Corp. TOR-0158.

use super::carrying;
use crate::effects::memory::BoucWen;
use crate::effects::{Carrier, Effect, Memory, ParameterSpec, Record, Rig, Site, Traits, Values, guesses};

/// See the head of this file.
pub struct DahlFriction;

/// Shortest presliding length as a share of the signal's range, below a step of an encoder of 16 bits.
pub(super) const SHORTEST: f64 = 1e-5;

impl Effect for DahlFriction {
    fn name(&self) -> &'static str {
        "dahl_friction"
    }

    fn meaning(&self) -> &'static str {
        "dry friction that builds up over a presliding length shifts the outputs"
    }

    fn site(&self) -> Site {
        Site::Output
    }

    fn source(&self) -> &'static str {
        "Dahl (1968), Aerospace Corp. TOR-0158"
    }

    fn traits(&self) -> Traits {
        Traits { is_rare: true, follows_pressure: true, ..Traits::default() }
    }

    fn carriers(&self, rig: &Rig) -> Vec<Carrier> {
        carrying::motions(rig)
    }

    fn parameters(&self, rig: &Rig, carrier: Carrier) -> Vec<ParameterSpec> {
        let (unit, width) = carrying::range(rig, carrier);
        let mut specs = carrying::sizes(rig, "friction", "1", 1.0, 20.0);
        let presliding = ParameterSpec::shape("presliding", unit, width / 200.0, width / 200.0);
        specs.push(presliding.within(SHORTEST * width, width));
        specs
    }

    fn initial_guesses(&self, rig: &Rig, carrier: Carrier) -> Vec<Vec<f64>> {
        let (specs, width) = (self.parameters(rig, carrier), carrying::range(rig, carrier).1);
        let presliding = |share: f64| guesses::guess_with(&specs, 1.0, specs.len() - 1, share * width);
        guesses::presliding().into_iter().map(presliding).collect()
    }

    fn proceed(
        &self,
        carrier: Carrier,
        values: Values,
        record: &Record,
        memory: &mut Memory,
        columns: &mut [Vec<f64>],
    ) {
        let Some(signal) = carrying::signal(record, carrier) else { return };
        let presliding = columns.len();
        let (states, direction) = memory.states_and_column::<BoucWen>(1);
        let Some(d) = states.first_mut() else { return };
        direction.clear();
        direction.extend(signal.iter().enumerate().map(|(t, s)| d.dahl(*s, values.at(presliding, t))));
        carrying::add(columns, |m, t| values.at(m, t), direction);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: far from a turning point dry friction is ±f, whatever the speed; a pause keeps it. The first output has its
    /// own size, and the presliding follows the sizes.
    #[test]
    fn far_from_a_turn_it_is_the_sign_of_the_speed() {
        let position = vec![0.0, 1.0, 10.0, 10.0, 9.0, 0.0];
        let record = Record::new((0..6).map(f64::from).collect(), vec![position], vec![], vec![]);
        let mut columns = vec![vec![5.0; 6], vec![0.0; 6]];
        let values = [3.0, -2.0, 0.01];
        DahlFriction.act(Carrier::Actuator(0), Values::constant(&[], &values), &record, &mut columns);
        for (t, sign) in [0.0, 1.0, 1.0, 1.0, -1.0, -1.0].into_iter().enumerate() {
            assert!((columns[0][t] - 5.0 - 3.0 * sign).abs() < 1e-12);
            assert!((columns[1][t] + 2.0 * sign).abs() < 1e-12);
        }
    }
}
