//! First-order lag with dry friction: a motor's speed follows its voltage late, and rests where the voltage does not overcome friction.
//!
//! ```text
//! τ dq̃_j/dt = q_j − q̃_j − w_j sgn q̃_j;   q̃_j rests at 0 while |q_j| ≤ w_j;   q̃(t_0) at rest behind q(t_0)
//! ```
//!
//! | symbol | meaning                                                    | unit            |
//! | `τ`    | time constant, all actuators                               | s               |
//! | `w_j`  | what friction takes; 0 for actuators far from zero | of the actuator |
//!
//! At rest it is a dead zone of half width w; unlike a dead zone before a lag, q̃ comes to zero in a finite time. At w = 0 it is
//! `actuator_lag`. Exact for actuators that are linear between samples. Armstrong-Hélouvry, Dupont & Canudas de Wit (1994),
//! A survey of models, analysis tools and compensation methods for the control of machines with friction, Automatica 30(7).

use crate::effects::actuation::actuators;
use crate::effects::{
    Carrier, Effect, Memory, ParameterSpec, Record, Rig, Site, Traits, Values, guesses, memory, times,
};
use crate::rig::Signal;

/// See the head of this file.
pub struct FrictionLag;

/// Time constants to start from, and frictions as shares of the largest magnitude.
const TAUS: usize = 12;
const FRICTIONS: [f64; 3] = [0.03, 0.1, 0.3];

/// Largest friction as a share of the largest magnitude.
const LARGEST: f64 = 0.9;

impl Effect for FrictionLag {
    fn name(&self) -> &'static str {
        "friction_lag"
    }

    fn meaning(&self) -> &'static str {
        "the outputs follow the actuators as a lag with dry friction, and rest near zero"
    }

    fn site(&self) -> Site {
        Site::Actuation
    }

    fn source(&self) -> &'static str {
        "Armstrong-Hélouvry, Dupont & Canudas de Wit (1994), Automatica 30(7)"
    }

    fn traits(&self) -> Traits {
        Traits { is_rare: true, refines: Some("actuator_lag"), shows_against_rate: true, ..Traits::default() }
    }

    fn carriers(&self, rig: &Rig) -> Vec<Carrier> {
        if rig.actuators.iter().any(actuators::crosses_zero) { vec![Carrier::Rig] } else { vec![] }
    }

    fn parameters(&self, rig: &Rig, _: Carrier) -> Vec<ParameterSpec> {
        let friction = |q: &Signal| {
            let most = if actuators::crosses_zero(q) { q.magnitude() } else { 0.0 };
            let name = format!("friction_{}", q.name);
            ParameterSpec::shape(name, &q.unit, 0.0, 0.05 * most).within(0.0, LARGEST * most)
        };
        [times::size(rig, "tau")].into_iter().chain(rig.actuators.iter().map(friction)).collect()
    }

    fn initial_guesses(&self, rig: &Rig, carrier: Carrier) -> Vec<Vec<f64>> {
        let specs = self.parameters(rig, carrier);
        let at = |tau: f64, share: f64| -> Vec<f64> {
            let frictions = specs[1..].iter().map(|spec| share / LARGEST * spec.upper);
            [tau].into_iter().chain(frictions).collect()
        };
        guesses::thinned(&times::grid(rig), TAUS)
            .iter()
            .flat_map(|tau| FRICTIONS.map(|share| at(*tau, share)))
            .collect()
    }

    fn proceed(&self, _: Carrier, values: Values, record: &Record, memory: &mut Memory, columns: &mut [Vec<f64>]) {
        let lags = memory.states::<memory::StickLag>(columns.len());
        for (j, (q, lag)) in columns.iter_mut().zip(lags).enumerate() {
            for (t, (q, time)) in q.iter_mut().zip(&record.time).enumerate() {
                *q = lag.step(*time, *q, values.at(0, t), values.at(1 + j, t));
            }
        }
    }

    fn memory(&self, values: Values) -> Option<f64> {
        Some(values.at(0, 0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: the closed form of coasting to rest, τ v' = −v − w from v_0: v = (v_0 + w) e^(−t/τ) − w until
    /// t = τ ln(1 + v_0/w), then 0.
    #[test]
    fn a_motor_coasts_to_rest_in_a_finite_time() {
        let (tau, w, v): (f64, f64, f64) = (0.8, 2.0, 10.0);
        let time: Vec<f64> = [0.0, 1e-9].into_iter().chain((1..300).map(|k| 0.01 * f64::from(k))).collect();
        let mut columns = vec![time.iter().map(|t| if *t == 0.0 { v + w } else { 0.0 }).collect::<Vec<f64>>()];
        let record = Record::new(time.clone(), columns.clone(), vec![], vec![]);
        FrictionLag.act(Carrier::Rig, Values::constant(&[], &[tau, w]), &record, &mut columns);
        for (t, found) in time.iter().zip(&columns[0]) {
            let truth = ((v + w) * (-t / tau).exp() - w).max(0.0);
            assert!((found - truth).abs() < 1e-6, "{t}: {found} and {truth}");
        }
    }
}
