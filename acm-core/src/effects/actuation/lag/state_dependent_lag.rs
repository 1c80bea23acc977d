//! State-dependent lag: the outputs follow the actuators with a time constant that depends on the state.
//!
//! ```text
//! τ(q̃) dq̃/dt = q − q̃,   τ = τ0 (ρ + (1 − ρ) (1 + κ z) (1 + |λ| z²)^{sgn λ}),   z = (q̃ − m)/h within −1 … 1,   q̃(t_0) = q(t_0)
//! ```
//!
//! | symbol       | meaning                                                            | unit            |
//! | `τ0`         | time constant at the middle of the range, all actuators            | s               |
//! | `κ`          | how it grows towards the upper end, −0.999 to 0.999, all actuators | 1               |
//! | `λ`          | how it grows towards both ends, or below 0 falls, all actuators    | 1               |
//! | `ρ`          | share of it that depends on nothing, 0 to 0.9, all actuators       | 1               |
//! | `m_j`, `h_j` | middle of the recorded range of each actuator, half its width      | of the actuator |
//!
//! Examples: a tank that empties by Torricelli's law, whose τ, linearised at a level, grows with the level; a coil whose iron
//! saturates, whose inductance falls with the current as 1/(1 + (i/i_s)²) to that of the air, ρ. At κ = λ = 0 it is
//! `actuator_lag`. Second order in the sampling interval ([`memory::VaryingLag`]). Seborg, Edgar, Mellichamp & Doyle (2016),
//! Process Dynamics and Control, 4th ed., ch. 4; Fitzgerald, Kingsley & Umans (2003), Electric Machinery, 6th ed., 1.3 (saturation).

use crate::effects::actuation::actuators;
use crate::effects::{
    Carrier, Effect, Memory, ParameterSpec, Record, Rig, Site, Traits, Values, guesses, memory, times,
};

/// See the head of this file.
pub struct StateDependentLag;

/// Parameters before the ends of the ranges.
const OWN: usize = 4;

/// Time constants to start from, and how they grow: κ, λ and ρ.
const TAUS: usize = 12;
const BENDS: [[f64; 3]; 6] =
    [[0.5, 0.0, 0.0], [-0.5, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, -1.0, 0.0], [0.0, -5.0, 0.0], [0.0, -10.0, 0.2]];

impl Effect for StateDependentLag {
    fn name(&self) -> &'static str {
        "state_dependent_lag"
    }

    fn meaning(&self) -> &'static str {
        "the outputs follow the actuators as a lag whose time constant depends on the state"
    }

    fn site(&self) -> Site {
        Site::Actuation
    }

    fn source(&self) -> &'static str {
        "Seborg, Edgar, Mellichamp & Doyle (2016), Process Dynamics and Control, 4th ed., ch. 4"
    }

    fn traits(&self) -> Traits {
        Traits {
            is_rare: true,
            is_generic: true,
            refines: Some("actuator_lag"),
            shows_against_rate: true,
            ..Traits::default()
        }
    }

    fn carriers(&self, rig: &Rig) -> Vec<Carrier> {
        actuators::moving(rig)
    }

    fn parameters(&self, rig: &Rig, _: Carrier) -> Vec<ParameterSpec> {
        let bend = ParameterSpec::shape("bend", "1", 0.0, 0.3).within(-0.999, 0.999);
        let curve = ParameterSpec::shape("curve", "1", 0.0, 0.3).within(-20.0, 20.0);
        let floor = ParameterSpec::shape("floor", "1", 0.0, 0.1).within(0.0, 0.9);
        [times::size(rig, "tau"), bend, curve, floor].into_iter().chain(actuators::ends(rig)).collect()
    }

    fn initial_guesses(&self, rig: &Rig, carrier: Carrier) -> Vec<Vec<f64>> {
        let specs = self.parameters(rig, carrier);
        let at = |tau: f64, [bend, curve, floor]: [f64; 3]| {
            let mut guess = guesses::guess_with(&specs, 1.0, 0, tau);
            (guess[1], guess[2], guess[3]) = (bend, curve, floor);
            guess
        };
        guesses::thinned(&times::grid(rig), TAUS).iter().flat_map(|tau| BENDS.map(|bend| at(*tau, bend))).collect()
    }

    fn proceed(&self, _: Carrier, values: Values, record: &Record, memory: &mut Memory, columns: &mut [Vec<f64>]) {
        let lags = memory.states::<memory::VaryingLag>(columns.len());
        actuators::pass_in_range(values, OWN, columns, lags, |lag, t, x| {
            let bends = [1, 2, 3].map(|k| values.at(k, t));
            lag.step(record.time[t], x, values.at(0, t), |_| move |z| pace(z.clamp(-1.0, 1.0), bends))
        });
    }

    fn memory(&self, values: Values) -> Option<f64> {
        let [slowest, _] = slowest_and_fastest(values);
        Some(slowest)
    }

    fn second_memory(&self, values: Values) -> Option<f64> {
        let [slowest, fastest] = slowest_and_fastest(values);
        (fastest < slowest).then_some(fastest)
    }
}

/// Smallest 1 + κ z.
const LEAST: f64 = 0.001;

/// τ/τ0 at z.
fn pace(z: f64, [bend, curve, floor]: [f64; 3]) -> f64 {
    let even = 1.0 + curve.abs() * z * z;
    floor + (1.0 - floor) * (1.0 + bend * z).max(LEAST) * if curve < 0.0 { 1.0 / even } else { even }
}

/// Largest and smallest τ of those at the ends and in the middle of the range.
fn slowest_and_fastest(values: Values) -> [f64; 2] {
    let [tau, bend, curve, floor] = [0, 1, 2, 3].map(|k| values.at(k, 0));
    let even = if curve < 0.0 { 1.0 / (1.0 - curve) } else { 1.0 + curve };
    let at = |factor: f64| tau * (floor + (1.0 - floor) * factor);
    let taus = [tau, at((1.0 + bend) * even), at((1.0 - bend) * even)];
    [taus.into_iter().fold(0.0, f64::max), taus.into_iter().fold(f64::INFINITY, f64::min)]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: the time after which a step from z_0 to x has come to z, τ0 ∫ (1 + κu) g(u)/(x − u) du from z_0 to z with g = 1 + λu²,
    /// or 1/(1 − λu²) below 0, by the midpoint rule; the range is 10 to 14.
    #[test]
    fn a_step_fills_and_empties_at_different_speed() {
        let tau = 0.8;
        let steps = [(-0.9, 0.9), (0.9, -0.9)];
        let bends = [[0.6, 0.0, 0.0], [0.0, 1.5, 0.0], [0.2, -0.5, 0.0], [0.0, -6.0, 0.0], [0.0, -9.0, 0.2]];
        for ([bend, curve, floor], (from, to)) in bends.into_iter().flat_map(|bends| steps.map(|step| (bends, step))) {
            let time: Vec<f64> = [0.0, 1e-9].into_iter().chain((1..300).map(|k| 0.01 * f64::from(k))).collect();
            let mut columns = vec![vec![12.0 + 2.0 * to; time.len()]];
            columns[0][0] = 12.0 + 2.0 * from;
            let record = Record::new(time.clone(), columns.clone(), vec![], vec![]);
            let values = [tau, bend, curve, floor, 14.0, 10.0];
            StateDependentLag.act(Carrier::Rig, Values::constant(&[], &values), &record, &mut columns);
            for (t, q) in time.iter().zip(&columns[0]).skip(2) {
                let z = (q - 12.0) / 2.0;
                if (to - z).abs() < 1e-3 {
                    break;
                }
                let pace = |u: f64| {
                    let even = if curve > 0.0 { 1.0 + curve * u * u } else { 1.0 / (1.0 - curve * u * u) };
                    (floor + (1.0 - floor) * (1.0 + bend * u) * even) / (to - u)
                };
                let du = (z - from) / 20_000.0;
                let passed = tau * du * (0..20_000).map(|k| pace(from + (f64::from(k) + 0.5) * du)).sum::<f64>();
                assert!((passed - t).abs() < 1e-3, "{bend} {curve} {from} to {to}: at {z} after {passed} s, not {t} s");
            }
        }
    }
}
