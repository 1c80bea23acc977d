//! Stribeck friction: a friction that is larger at rest than in motion, and smooth through zero speed, shifts the outputs.
//!
//! ```text
//! ỹ_m = y_m + f_m tanh(ṡ/v) + s_m e^{−(ṡ/v)²} tanh(ṡ/v)
//! ```
//!
//! | symbol | meaning                                                                  | unit                |
//! | `f_m`  | friction in fast motion, one for each output                             | of the output       |
//! | `s_m`  | what breaking away adds to it, one for each output                       | of the output       |
//! | `ṡ`    | rate of the signal, by a parabola through a window ([`super::memory::Derivatives`]) | of the signal per s |
//! | `v`    | Stribeck's speed, over which it falls off                                | of the signal per s |
//! | `h`    | half the window                                                          | s                   |
//!
//! Armstrong-Hélouvry, Dupont & Canudas de Wit (1994), Automatica 30(7); Makkar et al. (2005), IEEE/ASME AIM, for tanh.

use super::{Carrier, Effect, Memory, ParameterSpec, Record, Rig, Site, Traits, Values, carrying, guesses, times};

/// See the head of this file.
pub struct StribeckFriction;

/// Stribeck's speeds to start from, as shares of a typical one.
const SPEEDS: [f64; 3] = [0.01, 0.05, 0.25];

impl Effect for StribeckFriction {
    fn name(&self) -> &'static str {
        "stribeck_friction"
    }

    fn meaning(&self) -> &'static str {
        "friction that is larger at rest than in motion shifts the outputs"
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
        carrying::moving(rig)
    }

    fn parameters(&self, rig: &Rig, carrier: Carrier) -> Vec<ParameterSpec> {
        let (unit, typical) = (carrying::range(rig, carrier).0, carrying::typical_speed(rig, carrier));
        let mut specs = carrying::sizes(rig, "friction", "1", 1.0, 20.0);
        specs.extend(carrying::sizes(rig, "breakaway", "1", 1.0, 20.0));
        let speed = ParameterSpec::shape("speed", carrying::per(&unit, "s"), 0.05 * typical, 0.05 * typical);
        specs.push(speed.within(1e-3 * typical, 10.0 * typical));
        specs.push(times::window(rig));
        specs
    }

    fn initial_guesses(&self, rig: &Rig, carrier: Carrier) -> Vec<Vec<f64>> {
        let (specs, typical) = (self.parameters(rig, carrier), carrying::typical_speed(rig, carrier));
        let last = specs.len() - 1;
        let at = |window: f64, share: f64| {
            let mut guess = guesses::guess_with(&specs, 1.0, last, window);
            guess[last - 1] = share * typical;
            guess
        };
        times::windows(rig).iter().flat_map(|window| SPEEDS.map(|share| at(*window, share))).collect()
    }

    fn proceed(
        &self,
        carrier: Carrier,
        values: Values,
        record: &Record,
        memory: &mut Memory,
        columns: &mut [Vec<f64>],
    ) {
        let sizes = columns.len();
        let (speed, window) = (values.at(2 * sizes, 0), values.at(2 * sizes + 1, 0));
        let Some(share) = carrying::derivative(record, carrier, window, memory, |d| d.rate / speed) else { return };
        for (m, y) in columns.iter_mut().enumerate() {
            for (t, (y, u)) in y.iter_mut().zip(share).enumerate() {
                *y += (values.at(m, t) + values.at(sizes + m, t) * (-u * u).exp()) * u.tanh();
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: by hand, at speeds of 0, v, −v and 100 v: tanh 1 = 0.76159…, e^{−1} = 0.36787….
    #[test]
    fn it_breaks_away_and_falls_off() {
        for (speed, expected) in
            [(0.0, 0.0), (0.2, (3.0 + 5.0 * 0.367_879_441) * 0.761_594_156), (-0.2, -3.685_656_6), (20.0, 3.0)]
        {
            let time: Vec<f64> = (0..20).map(|k| 0.1 * f64::from(k)).collect();
            let signal = time.iter().map(|t| 7.0 + speed * t).collect();
            let record = Record::new(time, vec![signal], vec![], vec![]);
            let mut columns = vec![vec![1.0; 20]];
            let values = [3.0, 5.0, 0.2, 0.35];
            StribeckFriction.act(Carrier::Actuator(0), Values::constant(&[], &values), &record, &mut columns);
            assert!(columns[0].iter().all(|y| (y - 1.0 - expected).abs() < 1e-6), "{speed}: {columns:?}");
        }
    }
}
