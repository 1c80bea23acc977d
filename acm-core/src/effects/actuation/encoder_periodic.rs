//! Periodic error of one actuator's encoder or pulley: eccentricity, cogging, interpolation.
//!
//! ```text
//! q̃_j = q_j + a sin(2πN q_j) + b cos(2πN q_j)
//! ```
//!
//! | symbol   | meaning                                    | unit              |
//! | `a`, `b` | the error, in phase and out of it          | of the actuator   |
//! | `N`      | periods per unit of the actuator           | 1 / of the actuator |
//!
//! From three periods to twenty over the travel: what bends more slowly is a matter of the calibration. The misfit has a
//! valley for each `N`, so guesses are close together there.
//! Heydemann (1981), Applied Optics 20(19).

use std::f64::consts::TAU;

use crate::effects::{Carrier, Effect, Memory, ParameterSpec, Record, Rig, Site, Traits, Values, guesses};

/// See the head of this file.
pub struct EncoderPeriodic;

/// Periods over the travel.
const FEWEST: f64 = 3.0;
const MOST: f64 = 20.0;
const GUESSES: usize = 25;

impl Effect for EncoderPeriodic {
    fn name(&self) -> &'static str {
        "encoder_periodic"
    }

    fn meaning(&self) -> &'static str {
        "an actuator's reading errs periodically with its position"
    }

    fn site(&self) -> Site {
        Site::Actuation
    }

    fn source(&self) -> &'static str {
        "Heydemann (1981), Applied Optics 20(19)"
    }

    fn traits(&self) -> Traits {
        Traits { is_static: true, is_periodic: true, is_generic: true, ..Traits::default() }
    }

    fn carriers(&self, rig: &Rig) -> Vec<Carrier> {
        let moves = |&j: &usize| rig.actuators[j].varies();
        (0..rig.actuators.len()).filter(moves).map(Carrier::Actuator).collect()
    }

    fn parameters(&self, rig: &Rig, carrier: Carrier) -> Vec<ParameterSpec> {
        let Carrier::Actuator(j) = carrier else { return vec![] };
        let q = &rig.actuators[j];
        let travel = q.span();
        let size = |name: &str| {
            let spec = ParameterSpec::size(format!("{name}_{}", q.name), &q.unit, 0.03 * travel);
            spec.within(-0.3 * travel, 0.3 * travel)
        };
        let periods =
            ParameterSpec::shape(format!("periods_{}", q.name), format!("1/{}", q.unit), FEWEST / travel, 1.0 / travel);
        vec![size("sine"), size("cosine"), periods.within(FEWEST / travel, MOST / travel)]
    }

    fn initial_guesses(&self, rig: &Rig, carrier: Carrier) -> Vec<Vec<f64>> {
        let specs = self.parameters(rig, carrier);
        let [.., periods] = &specs[..] else { return vec![] };
        let at = |k: usize| FEWEST + (MOST - FEWEST) * (k as f64 + 0.5) / GUESSES as f64;
        (0..GUESSES).map(|k| guesses::guess_with(&specs, 0.3, 2, at(k) / MOST * periods.upper)).collect()
    }

    fn proceed(&self, carrier: Carrier, values: Values, _: &Record, _: &mut Memory, columns: &mut [Vec<f64>]) {
        let Carrier::Actuator(j) = carrier else { return };
        for (t, q) in columns[j].iter_mut().enumerate() {
            let (sine, cosine) = (TAU * values.at(2, t) * *q).sin_cos();
            *q += values.at(0, t) * sine + values.at(1, t) * cosine;
        }
    }
}
