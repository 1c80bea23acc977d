//! Stribeck friction: the breakaway part of dry friction, which falls off with speed, shifts the outputs.
//!
//! ```text
//! ỹ_m = y_m + s_m e^{−(ṡ/v)²} tanh(10 ṡ/v)
//! ```
//!
//! | symbol | meaning                                                                  | unit                |
//! | `s_m`  | what breaking away adds, one for each output                             | of the output       |
//! | `ṡ`    | rate of the signal, by a quartic through a window ([`crate::effects::memory::Derivatives`]) | of the signal per s |
//! | `v`    | Stribeck's speed, over which it falls off                                | of the signal per s |
//! | `h`    | half the window                                                          | s                   |
//!
//! Armstrong-Hélouvry, Dupont & Canudas de Wit (1994), Automatica 30(7); Makkar et al. (2005), IEEE/ASME AIM, for tanh.

use super::carrying;
use crate::effects::memory::Derivative;
use crate::effects::{Carrier, Effect, Memory, ParameterSpec, Record, Rig, Site, Traits, Values, times};

/// See the head of this file.
pub struct StribeckFriction;

/// Ratio of Stribeck's speed to that over which the friction reverses.
const SHARP: f64 = 10.0;

/// Stribeck's speeds to start from, as shares of a typical one.
const SPEEDS: [f64; 3] = [0.01, 0.05, 0.25];

impl Effect for StribeckFriction {
    fn name(&self) -> &'static str {
        "stribeck_friction"
    }

    fn meaning(&self) -> &'static str {
        "what breaking away adds to dry friction at low speed shifts the outputs"
    }

    fn site(&self) -> Site {
        Site::Output
    }

    fn source(&self) -> &'static str {
        "Armstrong-Hélouvry, Dupont & Canudas de Wit (1994), Automatica 30(7); Makkar et al. (2005), IEEE/ASME AIM"
    }

    fn traits(&self) -> Traits {
        Traits { is_rare: true, follows_pressure: true, shows_against_rate: true, ..Traits::default() }
    }

    fn carriers(&self, rig: &Rig) -> Vec<Carrier> {
        carrying::motions(rig)
    }

    fn parameters(&self, rig: &Rig, carrier: Carrier) -> Vec<ParameterSpec> {
        let (unit, typical) = (carrying::range(rig, carrier).0, carrying::typical_speed(rig, carrier));
        let mut specs = carrying::sizes(rig, "breakaway", "1", 1.0, 20.0);
        let speed = ParameterSpec::shape("speed", carrying::per(&unit, "s"), 0.05 * typical, 0.05 * typical);
        specs.push(speed.within(1e-3 * typical, typical));
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
        let shape = |d: &Derivative| {
            let u = d.rate / speed;
            (-u * u).exp() * (SHARP * u).tanh()
        };
        let Some(shape) = carrying::derivative(record, carrier, window, memory, shape) else { return };
        carrying::add(columns, |m, t| values.at(m, t), shape);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: by hand, at speeds of 0, v, −v and 100 v: e^{−1} = 0.36787…, and tanh 10 is 1.
    #[test]
    fn it_breaks_away_and_falls_off() {
        for (speed, expected) in [(0.0, 0.0), (0.2, 5.0 * 0.367_879_441), (-0.2, -1.839_397_2), (20.0, 0.0)] {
            let time: Vec<f64> = (0..20).map(|k| 0.1 * f64::from(k)).collect();
            let signal = time.iter().map(|t| 7.0 + speed * t).collect();
            let record = Record::new(time, vec![signal], vec![], vec![]);
            let mut columns = vec![vec![1.0; 20]];
            let values = [5.0, 0.2, 0.35];
            StribeckFriction.act(Carrier::Actuator(0), Values::constant(&[], &values), &record, &mut columns);
            assert!(columns[0].iter().all(|y| (y - 1.0 - expected).abs() < 1e-6), "{speed}: {columns:?}");
        }
    }
}
