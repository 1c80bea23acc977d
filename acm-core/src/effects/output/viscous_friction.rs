//! Viscous friction: the outputs are shifted in proportion to the speed of a signal.
//!
//! ```text
//! ỹ_m = y_m + c_m ṡ
//! ```
//!
//! | symbol | meaning                                             | unit                              |
//! | `c_m`  | damping, one for each output                        | of the output per unit and second |
//! | `ṡ`    | rate of the signal, by a quartic through a window ([`crate::effects::memory::Derivatives`]) | per s |
//! | `h`    | half that window                                    | s                                 |
//!
//! Armstrong-Hélouvry, Dupont & Canudas de Wit (1994), Automatica 30(7).

use super::carrying;
use crate::effects::{Carrier, Effect, Memory, ParameterSpec, Record, Rig, Site, Traits, Values, guesses, times};

/// See the head of this file.
pub struct ViscousFriction;

impl Effect for ViscousFriction {
    fn name(&self) -> &'static str {
        "viscous_friction"
    }

    fn meaning(&self) -> &'static str {
        "friction in proportion to a speed shifts the outputs"
    }

    fn site(&self) -> Site {
        Site::Output
    }

    fn source(&self) -> &'static str {
        "Armstrong-Hélouvry, Dupont & Canudas de Wit (1994), Automatica 30(7)"
    }

    fn traits(&self) -> Traits {
        Traits { follows_pressure: true, shows_against_rate: true, ..Traits::default() }
    }

    fn carriers(&self, rig: &Rig) -> Vec<Carrier> {
        carrying::motions(rig)
    }

    fn parameters(&self, rig: &Rig, carrier: Carrier) -> Vec<ParameterSpec> {
        let unit = carrying::per(&carrying::range(rig, carrier).0, "s");
        let mut specs = carrying::sizes(rig, "damping", &unit, carrying::typical_speed(rig, carrier), 1e3);
        specs.push(times::window(rig));
        specs
    }

    fn initial_guesses(&self, rig: &Rig, carrier: Carrier) -> Vec<Vec<f64>> {
        let specs = self.parameters(rig, carrier);
        let window = |window| guesses::guess_with(&specs, 1.0, specs.len() - 1, window);
        times::windows(rig).into_iter().map(window).collect()
    }

    fn proceed(
        &self,
        carrier: Carrier,
        values: Values,
        record: &Record,
        memory: &mut Memory,
        columns: &mut [Vec<f64>],
    ) {
        let window = values.at(columns.len(), 0);
        let Some(rate) = carrying::derivative(record, carrier, window, memory, |d| d.rate) else { return };
        carrying::add(columns, |m, t| values.at(m, t), rate);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: s = 3 t² has the rate 6 t, whatever the window.
    #[test]
    fn a_parabola_has_its_rate() {
        let time: Vec<f64> = (0..60).map(|k| 0.1 * f64::from(k)).collect();
        let signal = time.iter().map(|t| 3.0 * t * t).collect();
        let record = Record::new(time, vec![signal], vec![], vec![]);
        for window in [0.0, 0.35, 1.2] {
            let mut columns = vec![vec![1.0; 60], vec![0.0; 60]];
            let values = [0.5, -2.0, window];
            ViscousFriction.act(Carrier::Actuator(0), Values::constant(&[], &values), &record, &mut columns);
            for t in 2..58 {
                let rate = 6.0 * record.time[t];
                assert!((columns[0][t] - 1.0 - 0.5 * rate).abs() < 1e-9, "{window}: {columns:?}");
                assert!((columns[1][t] + 2.0 * rate).abs() < 1e-9);
            }
        }
    }
}
