//! Asymmetric lag of the actuation: the outputs follow the actuators as a low-pass filter that is slower one way, as in
//! filling and venting, heating and cooling, extending and retracting.
//!
//! ```text
//! τ_u dq̃/dt = q − q̃ where q > q̃,   τ_d dq̃/dt = q − q̃ where q < q̃,   τ_u = τ e^a,   τ_d = τ e^{−a},   q̃(t_0) = q(t_0)
//! ```
//!
//! | symbol | meaning                                                              | unit |
//! | `τ`    | geometric mean of both time constants                                | s    |
//! | `a`    | asymmetry, −2 to 2: above 0 it rises more slowly than it falls       | 1    |
//!
//! All actuators lag alike, or one of a few by itself. At a = 0 it is `actuator_lag`. Exact for actuators that are linear between
//! samples ([`crate::effects::memory::AsymmetricLag`]). Joshi & Paik (2021), Pneumatic supply system parameter optimization for soft
//! actuators, Soft Robotics 8(2), for rise and fall times of pressures.

use crate::effects::actuation::actuators;
use crate::effects::memory::{AsymmetricLag as Follower, Decays, Last};
use crate::effects::{Carrier, Effect, Memory, ParameterSpec, Record, Rig, Site, Traits, Values, guesses, times};

/// See the head of this file.
pub struct AsymmetricLag;

/// Time constants to start from, and asymmetries.
const TAUS: usize = 12;
const ASYMMETRIES: [f64; 4] = [-0.9, -0.3, 0.3, 0.9];

/// Largest asymmetry: one time constant is e^4 = 55 times the other.
const LARGEST: f64 = 2.0;

impl Effect for AsymmetricLag {
    fn name(&self) -> &'static str {
        "asymmetric_lag"
    }

    fn meaning(&self) -> &'static str {
        "the outputs follow the actuators as a lag that is slower one way than the other"
    }

    fn site(&self) -> Site {
        Site::Actuation
    }

    fn source(&self) -> &'static str {
        "Joshi & Paik (2021), Soft Robotics 8(2)"
    }

    fn traits(&self) -> Traits {
        Traits { is_rare: true, refines: Some("actuator_lag"), shows_against_rate: true, ..Traits::default() }
    }

    fn carriers(&self, rig: &Rig) -> Vec<Carrier> {
        actuators::together_or_alone(rig)
    }

    fn parameters(&self, rig: &Rig, _: Carrier) -> Vec<ParameterSpec> {
        let asymmetry = ParameterSpec::shape("asymmetry", "1", 0.0, 0.3).within(-LARGEST, LARGEST);
        vec![times::size(rig, "tau"), asymmetry]
    }

    fn initial_guesses(&self, rig: &Rig, _: Carrier) -> Vec<Vec<f64>> {
        let taus = guesses::thinned(&times::grid(rig), TAUS);
        taus.into_iter().flat_map(|tau| ASYMMETRIES.map(|asymmetry| vec![tau, asymmetry])).collect()
    }

    fn proceed(
        &self,
        carrier: Carrier,
        values: Values,
        record: &Record,
        memory: &mut Memory,
        columns: &mut [Vec<f64>],
    ) {
        let lagging = actuators::acting(carrier, columns.len());
        let lags = memory.states::<Follower>(columns.len());
        let (mut decays, mut times) = (Decays::default(), Last::default());
        for (t, time) in record.time.iter().enumerate() {
            let taus = times.of([0, 1].map(|k| values.at(k, t)), || up_and_down(values, t));
            for (q, lag) in columns[lagging.clone()].iter_mut().zip(lags.iter_mut()) {
                if let Some(q) = q.get_mut(t) {
                    *q = lag.step(*time, *q, taus, &mut decays);
                }
            }
        }
    }

    fn memory(&self, values: Values) -> Option<f64> {
        let [up, down] = up_and_down(values, 0);
        Some(up.max(down))
    }

    fn second_memory(&self, values: Values) -> Option<f64> {
        let [up, down] = up_and_down(values, 0);
        (up != down).then_some(up.min(down))
    }
}

/// τ_u and τ_d, s.
fn up_and_down(values: Values, t: usize) -> [f64; 2] {
    let (tau, asymmetry) = (values.at(0, t), values.at(1, t));
    [tau * asymmetry.exp(), tau * (-asymmetry).exp()]
}

#[cfg(test)]
mod tests {
    use super::super::actuator_lag::ActuatorLag;
    use super::*;

    fn acted(
        effect: &dyn Effect,
        carrier: Carrier,
        values: &[f64],
        columns: &[Vec<f64>],
        time: &[f64],
    ) -> Vec<Vec<f64>> {
        let mut columns = columns.to_vec();
        let record = Record::new(time.to_vec(), columns.clone(), vec![], vec![]);
        effect.act(carrier, Values::constant(&[], values), &record, &mut columns);
        columns
    }

    /// Oracle: the closed form of a step, (1 − e^{−t/τ_u}) up and e^{−t/τ_d} down: with τ = 0.6 s and a = ln 2 the times are 1.2 and 0.3 s.
    #[test]
    fn it_fills_and_vents_with_two_times() {
        let time: Vec<f64> = [0.0, 1e-9].into_iter().chain((1..80).map(|k| 0.03 * f64::from(k))).collect();
        let up: Vec<f64> = time.iter().map(|t| if *t > 0.0 { 1.0 } else { 0.0 }).collect();
        let down: Vec<f64> = up.iter().map(|x| 1.0 - x).collect();
        let found = acted(&AsymmetricLag, Carrier::Rig, &[0.6, 2.0f64.ln()], &[up.clone(), down.clone()], &time);
        for (k, t) in time.iter().enumerate() {
            let (filled, vented) = (1.0 - (-t / 1.2).exp(), (-t / 0.3).exp());
            assert!((found[0][k] - filled).abs() < 1e-8 && (found[1][k] - vented).abs() < 1e-8, "{t}");
        }
        let alone = acted(&AsymmetricLag, Carrier::Actuator(1), &[0.6, 2.0f64.ln()], &[up.clone(), down], &time);
        assert_eq!(alone, [up, found[1].clone()]);
        let values = [0.6, 2.0f64.ln()];
        let values = Values::constant(&[], &values);
        let times = [AsymmetricLag.memory(values), AsymmetricLag.second_memory(values)].map(Option::unwrap);
        assert!((times[0] - 1.2).abs() < 1e-12 && (times[1] - 0.3).abs() < 1e-12, "{times:?}");
    }

    /// Oracle: the lag of the actuators, to the last bit.
    #[test]
    fn without_asymmetry_it_is_the_actuators_lag() {
        let time: Vec<f64> = (0..200).map(|k| 0.1 * f64::from(k) + 0.004 * f64::from(k % 5)).collect();
        let columns: Vec<Vec<f64>> =
            [0.7, 1.9, 3.1, 0.2, 5.3].map(|w| time.iter().map(|t| (w * t).sin()).collect()).into();
        let found = acted(&AsymmetricLag, Carrier::Rig, &[0.35, 0.0], &columns, &time);
        assert_eq!(found, acted(&ActuatorLag, Carrier::Rig, &[0.35], &columns, &time));
        assert_eq!(AsymmetricLag.second_memory(Values::constant(&[], &[0.35, 0.0])), None);
    }
}
