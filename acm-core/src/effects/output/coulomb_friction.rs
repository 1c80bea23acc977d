//! Coulomb friction: a friction of constant magnitude, smooth through zero speed, shifts the outputs.
//!
//! ```text
//! ỹ_m = y_m + f_m tanh(ṡ/v)
//! ```
//!
//! | symbol | meaning                                                                  | unit                |
//! | `f_m`  | friction, one for each output                                            | of the output       |
//! | `ṡ`    | rate of the signal, by a quartic through a window ([`crate::effects::memory::Derivatives`]) | of the signal per s |
//! | `v`    | speed over which it turns round                                          | of the signal per s |
//! | `h`    | half the window                                                          | s                   |
//!
//! Armstrong-Hélouvry, Dupont & Canudas de Wit (1994), Automatica 30(7); Andersson, Söderberg & Björklund (2007), Tribology
//! International 40(4), for tanh.

use super::carrying;
use crate::effects::{Carrier, Effect, Memory, ParameterSpec, Record, Rig, Site, Traits, Values, times};

/// See the head of this file.
pub struct CoulombFriction;

/// Speeds to start from, as shares of a range in a typical time, which is fast.
const SPEEDS: [f64; 3] = [0.002, 0.01, 0.05];

/// The largest, as such a share. Friction with a slower transition is viscous.
const LARGEST: f64 = 0.1;

impl Effect for CoulombFriction {
    fn name(&self) -> &'static str {
        "coulomb_friction"
    }

    fn meaning(&self) -> &'static str {
        "dry friction of a moving part shifts the outputs"
    }

    fn site(&self) -> Site {
        Site::Output
    }

    fn source(&self) -> &'static str {
        "Armstrong-Hélouvry, Dupont & Canudas de Wit (1994), Automatica 30(7); Andersson, Söderberg & Björklund (2007), Tribology International 40(4)"
    }

    fn traits(&self) -> Traits {
        Traits { follows_pressure: true, shows_against_rate: true, ..Traits::default() }
    }

    fn carriers(&self, rig: &Rig) -> Vec<Carrier> {
        carrying::motions(rig)
    }

    fn parameters(&self, rig: &Rig, carrier: Carrier) -> Vec<ParameterSpec> {
        let (unit, typical) = (carrying::range(rig, carrier).0, carrying::typical_speed(rig, carrier));
        let mut specs = carrying::sizes(rig, "friction", "1", 1.0, 20.0);
        let speed = ParameterSpec::shape("speed", carrying::per(&unit, "s"), 0.01 * typical, 0.01 * typical);
        specs.push(speed.within(1e-4 * typical, LARGEST * typical));
        specs.push(times::window(rig));
        specs
    }

    fn initial_guesses(&self, rig: &Rig, carrier: Carrier) -> Vec<Vec<f64>> {
        carrying::by_window_and_speed(rig, carrier, &self.parameters(rig, carrier), &SPEEDS)
    }

    fn proceed(
        &self,
        carrier: Carrier,
        values: Values,
        record: &Record,
        memory: &mut Memory,
        columns: &mut [Vec<f64>],
    ) {
        let (speed, window) = (values.at(columns.len(), 0), values.at(columns.len() + 1, 0));
        let direction = carrying::derivative(record, carrier, window, memory, |d| (d.rate / speed).tanh());
        let Some(direction) = direction else { return };
        carrying::add(columns, |m, t| values.at(m, t), direction);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: by hand, at speeds of 0, v, −v and 100 v: tanh 1 = 0.76159….
    #[test]
    fn it_turns_with_the_direction() {
        for (speed, expected) in [(0.0, 0.0), (0.2, 3.0 * 0.761_594_156), (-0.2, -3.0 * 0.761_594_156), (20.0, 3.0)] {
            let time: Vec<f64> = (0..20).map(|k| 0.1 * f64::from(k)).collect();
            let signal = time.iter().map(|t| 7.0 + speed * t).collect();
            let record = Record::new(time, vec![signal], vec![], vec![]);
            let mut columns = vec![vec![1.0; 20], vec![0.0; 20]];
            let values = [3.0, -6.0, 0.2, 0.35];
            CoulombFriction.act(Carrier::Actuator(0), Values::constant(&[], &values), &record, &mut columns);
            assert!(columns[0].iter().all(|y| (y - 1.0 - expected).abs() < 1e-6), "{speed}: {columns:?}");
            assert!(columns[1].iter().all(|y| (y + 2.0 * expected).abs() < 1e-6), "{speed}: {columns:?}");
        }
    }
}
