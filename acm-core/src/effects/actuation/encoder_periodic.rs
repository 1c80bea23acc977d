//! Periodic error of one actuator's encoder, pulley or gear: eccentricity, cogging, interpolation, kinematic error.
//!
//! ```text
//! q̃_j = q_j + a sin(2πN q_j) + b cos(2πN q_j)
//! ```
//!
//! | symbol   | meaning                                    | unit              |
//! | `a`, `b` | the error, in phase and out of it          | of the actuator   |
//! | `N`      | periods per unit of the actuator           | 1 / of the actuator |
//!
//! Three to twenty periods over the travel; slower errors are left to the calibration. The misfit has a local minimum for each
//! `N`, so guesses are close together. An angle that turns many times, such as that of a motor on a harmonic drive, has errors at
//! whole or half numbers of periods per turn; guesses lie there exactly, and the bounds include them.
//! Heydemann (1981), Applied Optics 20(19); Tuttle (1992), Understanding and modeling the behavior of a harmonic drive gear
//! transmission, MIT Artificial Intelligence Laboratory.

use std::f64::consts::TAU;

use crate::effects::{Carrier, Effect, Memory, ParameterSpec, Record, Rig, Site, Traits, Values, guesses};
use crate::rig::Signal;

/// See the head of this file.
pub struct EncoderPeriodic;

/// Periods over the travel.
const FEWEST: f64 = 3.0;
const MOST: f64 = 20.0;
const GUESSES: usize = 25;

/// Periods per turn of an angle to start from; the most that a fit may reach.
const PER_TURN: [f64; 5] = [1.0, 2.0, 0.5, 3.0, 4.0];
const MOST_PER_TURN: f64 = 4.5;

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
        Traits { is_static: true, is_periodic: true, is_generic: true, repeats: true, ..Traits::default() }
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
        let most = if is_angle(q) { (MOST / travel).max(MOST_PER_TURN / TAU) } else { MOST / travel };
        vec![size("sine"), size("cosine"), periods.within(FEWEST / travel, most)]
    }

    fn initial_guesses(&self, rig: &Rig, carrier: Carrier) -> Vec<Vec<f64>> {
        let Carrier::Actuator(j) = carrier else { return vec![] };
        let (specs, q) = (self.parameters(rig, carrier), &rig.actuators[j]);
        let travel = q.span();
        let at = |k: usize| FEWEST + (MOST - FEWEST) * (k as f64 + 0.5) / GUESSES as f64;
        let even = (0..GUESSES).map(|k| at(k) / MOST * (MOST / travel));
        let turning = PER_TURN.map(|periods| periods / TAU);
        let turning = turning.into_iter().filter(|periods| is_angle(q) && periods * travel >= FEWEST);
        even.chain(turning).map(|periods| guesses::guess_with(&specs, 0.3, 2, periods)).collect()
    }

    fn proceed(&self, carrier: Carrier, values: Values, _: &Record, _: &mut Memory, columns: &mut [Vec<f64>]) {
        let Carrier::Actuator(j) = carrier else { return };
        for (t, q) in columns[j].iter_mut().enumerate() {
            let (sine, cosine) = (TAU * values.at(2, t) * *q).sin_cos();
            *q += values.at(0, t) * sine + values.at(1, t) * cosine;
        }
    }
}

/// Whether it is an angle, whose errors repeat in every turn.
fn is_angle(q: &Signal) -> bool {
    q.unit == "rad"
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Bounds of the periods per unit, and guesses of them beyond those that are even over the travel.
    fn of(unit: &str, low: f64, high: f64) -> ([f64; 2], Vec<f64>) {
        let rig = Rig {
            actuators: vec![Signal { name: "q".into(), unit: unit.into(), low, high }],
            contexts: vec![],
            outputs: vec![],
            throttle: None,
            altitude: None,
            payload: None,
            carried: false,
            arm: None,
            step: 0.01,
            duration: 10.0,
        };
        let carrier = Carrier::Actuator(0);
        let guesses = EncoderPeriodic.initial_guesses(&rig, carrier);
        let periods = &EncoderPeriodic.parameters(&rig, carrier)[2];
        ([periods.lower, periods.upper], guesses[GUESSES..].iter().map(|guess| guess[2]).collect())
    }

    /// Oracle: by hand, 1/(2π) = 0.15915494309189535: over 60 rad one period in two turns is 4.8 periods and four in one are 38.2;
    /// over 30 rad one in two turns is 2.4, and over 4 rad four in one are 2.5. A way of 60 m has no turns.
    #[test]
    fn an_angle_errs_at_periods_of_its_turns() {
        let [half, one, two] = [0.079_577_471_545_947_67, 0.159_154_943_091_895_35, 0.318_309_886_183_790_7];
        let [three, four] = [0.477_464_829_275_686, 0.636_619_772_367_581_4];
        let near = |found: &[f64], expected: &[f64]| {
            found.len() == expected.len() && found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-15)
        };
        let ([lower, upper], guesses) = of("rad", -20.0, 40.0);
        assert!(near(&guesses, &[one, two, half, three, four]), "{guesses:?}");
        assert!(near(&[lower, upper], &[0.05, 4.5 * one]), "{lower} to {upper}");
        let ([_, upper], guesses) = of("rad", -20.0, 10.0);
        assert!(near(&guesses, &[one, two, three, four]) && near(&[upper], &[4.5 * one]), "{guesses:?}, {upper}");
        let ([lower, upper], guesses) = of("rad", -1.0, 3.0);
        assert!(guesses.is_empty() && [lower, upper] == [0.75, 5.0], "{guesses:?}");
        let ([lower, upper], guesses) = of("m", 0.0, 60.0);
        assert!(guesses.is_empty() && [lower, upper] == [0.05, 20.0 / 60.0], "{guesses:?}");
    }
}
