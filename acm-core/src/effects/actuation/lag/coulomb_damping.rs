//! Coulomb damping: the outputs follow the actuators as a mass on a spring with dry friction, such as a pendulum in a dry bearing.
//!
//! ```text
//! z'' + 2ζω z' + ω² (s(z) + f z'/√(z'² + ν²ω²)) = ω² x,   x = (q − m)/h,   q̃ = m + h z,   ω = 2π/P,   at rest at t_0
//! ```
//!
//! | symbol       | meaning                                                                      | unit            |
//! | `P`          | natural period of the linear spring, all actuators; at 0 there is no effect  | s               |
//! | `ζ`          | viscous damping, 0.01 to 0.5                                                 | 1               |
//! | `s`          | spring of the hardness `k` that rests at `c` ([`nonlinear_stiffness`])       | 1               |
//! | `f`          | deflection at which the spring overcomes the friction, in half ranges        | 1               |
//! | `ν`          | speed at which 1/√2 of the friction acts, in half ranges times ω             | 1               |
//! | `m_j`, `h_j` | middle of the recorded range of each actuator, half its width                | of the actuator |
//!
//! For rigs without an arm: an arm has `tendon_friction`.
//!
//! Second order in the sampling interval ([`StiffLag`](crate::effects::memory::StiffLag)). Den Hartog (1931), Forced vibrations
//! with combined Coulomb and viscous friction, Transactions of the ASME 53.

use std::f64::consts::TAU;

use super::nonlinear_stiffness;
use crate::effects::actuation::actuators;
use crate::effects::memory::{Friction, Spring};
use crate::effects::{
    Carrier, Effect, Memory, ParameterSpec, Record, Rig, Site, Traits, Values, guesses, oscillators, times,
};

/// See the head of this file.
pub struct CoulombDamping;

/// Parameters before the ends of the ranges.
const OWN: usize = 6;

/// Largest viscous damping: with more, the mass hardly rings, and the friction is that of a play after a lag. Before there was a
/// bound, and before refinements were split, the effect replaced play or hysteresis in two of 28 small rigs of the development
/// seeds 14001 to 14004 (an axis, a sheath); since then in none. Its sensitivity was not measured.
const SWINGS: f64 = 0.5;

/// Periods, each with two frictions, and a transition that all have, to start from.
const PERIODS: usize = 10;
const FRICTIONS: [f64; 2] = [0.02, 0.1];
const TRANSITION: f64 = 0.01;

impl Effect for CoulombDamping {
    fn name(&self) -> &'static str {
        "coulomb_damping"
    }

    fn meaning(&self) -> &'static str {
        "the outputs follow the actuators as a mass on a spring with dry friction"
    }

    fn site(&self) -> Site {
        Site::Actuation
    }

    fn source(&self) -> &'static str {
        "Den Hartog (1931), Forced vibrations with combined Coulomb and viscous friction, Transactions of the ASME 53"
    }

    fn traits(&self) -> Traits {
        Traits {
            is_rare: true,
            is_resonance: true,
            is_generic: true,
            refines: Some("second_order_lag"),
            ..Traits::default()
        }
    }

    fn carriers(&self, rig: &Rig) -> Vec<Carrier> {
        if rig.arm.is_none() { actuators::moving(rig) } else { vec![] }
    }

    fn parameters(&self, rig: &Rig, _: Carrier) -> Vec<ParameterSpec> {
        let mut specs = oscillators::parameters(rig);
        specs[1] = ParameterSpec::shape("damping", "1", 0.1, 0.1).within(0.01, SWINGS);
        specs.extend(nonlinear_stiffness::parameters());
        specs.push(ParameterSpec::size("friction", "1", 0.02).within(0.0, 1.0));
        specs.push(ParameterSpec::shape("transition", "1", 0.02, 0.01).within(1e-4, 1.0));
        specs.extend(actuators::ends(rig));
        specs
    }

    fn initial_guesses(&self, rig: &Rig, carrier: Carrier) -> Vec<Vec<f64>> {
        let specs = self.parameters(rig, carrier);
        let at = |period: f64, friction: f64| {
            let mut guess = guesses::guess_with(&specs, 0.0, 0, period);
            (guess[4], guess[5]) = (friction, TRANSITION);
            guess
        };
        let periods = guesses::thinned(&times::periods(rig), PERIODS);
        periods.into_iter().flat_map(|period| FRICTIONS.map(|friction| at(period, friction))).collect()
    }

    fn proceed(&self, _: Carrier, values: Values, record: &Record, memory: &mut Memory, columns: &mut [Vec<f64>]) {
        nonlinear_stiffness::spring(values, OWN, record, memory, columns, |t| {
            let period = values.at(0, t);
            let omega = if period > 0.0 { TAU / period } else { 0.0 };
            let friction = Friction { force: values.at(4, t), transition: values.at(5, t) * omega };
            Spring { hardness: values.at(2, t), rest: values.at(3, t), friction }
        });
    }

    fn memory(&self, values: Values) -> Option<f64> {
        Some(oscillators::fading(values.at(0, 0), values.at(1, 0)))
    }

    fn second_memory(&self, values: Values) -> Option<f64> {
        oscillators::fading_faster(values.at(0, 0), values.at(1, 0))
    }

    fn swinging(&self, values: Values) -> f64 {
        oscillators::swinging(values.at(0, 0), values.at(1, 0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: without viscous damping dry friction takes 4 f off the swing of a linear spring in every period, Den Hartog (1931): a
    /// mass that swings by a about its rest swings by a − 4 f a period later.
    #[test]
    fn every_period_takes_as_much_off_the_swing() {
        let (period, friction) = (1.6, 0.03);
        let time: Vec<f64> = (0..4000).map(|k| 0.002 * f64::from(k)).collect();
        // Down by 1.6 within 2 ms: z starts at 0.8 and swings about −0.8.
        let mut columns = vec![time.iter().map(|t| if *t > 0.0 { -0.8 } else { 0.8 }).collect::<Vec<f64>>()];
        let record = Record::new(time.clone(), columns.clone(), vec![], vec![]);
        let values = [period, 0.0, 0.0, 0.0, friction, 1e-4, 1.0, -1.0];
        CoulombDamping.act(Carrier::Rig, Values::constant(&[], &values), &record, &mut columns);
        let swing = |turn: f64| {
            let near = time.iter().zip(&columns[0]).filter(|(t, _)| (*t - turn * period).abs() < 0.3 * period);
            near.fold(f64::MIN, |most, (_, z)| most.max(z + 0.8))
        };
        for turn in 1..=4 {
            let left = 1.6 - 4.0 * friction * f64::from(turn);
            let found = swing(f64::from(turn));
            assert!((found - left).abs() < 3e-3, "{turn}: {found} for {left}");
        }
    }
}
