//! Vessel filled by the actuators and emptied by Torricelli's law: the outflow follows the inflow, more slowly at higher levels.
//!
//! ```text
//! τ (1 + κ z) dz/dt = x − z,   x = (q − m)/h,   q̃ = m + h z,   q̃(t_0) = q(t_0)
//! ```
//!
//! | symbol       | meaning                                                                      | unit            |
//! | `τ`          | time constant at the middle of the range, all actuators                      | s               |
//! | `κ`          | 0 to 1: how near to none the least flow of the range is, all actuators       | 1               |
//! | `m_j`, `h_j` | middle of the recorded range of each actuator, half its width                | of the actuator |
//!
//! With A dy/dt = w − o and o = c √y, the outflow o follows the inflow w by (2A/c²) o do/dt = w − o; zero flow is z = −1/κ. The
//! level is (o/c)², a static map. Vessels in series are a chain of it. At κ = 0 it is `actuator_lag`. Second order in the
//! sampling interval ([`memory::VaryingLag`]). Seborg, Edgar, Mellichamp & Doyle (2016), Process Dynamics and Control, 4th ed.,
//! ch. 2.4.5 (liquid storage systems).

use crate::effects::actuation::actuators;
use crate::effects::{
    Carrier, Effect, Memory, ParameterSpec, Record, Rig, Site, Traits, Values, guesses, memory, times,
};

/// See the head of this file.
pub struct Outflow;

/// Parameters before the ends of the ranges.
const OWN: usize = 2;

/// Time constants to start from, and values of κ.
const TAUS: usize = 12;
const BENDS: [f64; 3] = [0.5, 0.9, 0.98];

impl Effect for Outflow {
    fn name(&self) -> &'static str {
        "outflow"
    }

    fn meaning(&self) -> &'static str {
        "the actuators fill a vessel that empties through an orifice"
    }

    fn site(&self) -> Site {
        Site::Actuation
    }

    fn source(&self) -> &'static str {
        "Seborg, Edgar, Mellichamp & Doyle (2016), Process Dynamics and Control, 4th ed., ch. 2"
    }

    fn traits(&self) -> Traits {
        Traits {
            is_rare: true,
            repeats: true,
            refines: Some("actuator_lag"),
            shows_against_rate: true,
            ..Traits::default()
        }
    }

    fn carriers(&self, rig: &Rig) -> Vec<Carrier> {
        // Nothing empties that way in an arm.
        if rig.arm.is_some() { vec![] } else { actuators::moving(rig) }
    }

    fn parameters(&self, rig: &Rig, _: Carrier) -> Vec<ParameterSpec> {
        let bend = ParameterSpec::shape("bend", "1", 0.0, 0.3).within(0.0, 1.0);
        [times::size(rig, "tau"), bend].into_iter().chain(actuators::ends(rig)).collect()
    }

    fn initial_guesses(&self, rig: &Rig, carrier: Carrier) -> Vec<Vec<f64>> {
        let specs = self.parameters(rig, carrier);
        let at = |tau: f64, bend: f64| {
            let mut guess = guesses::guess_with(&specs, 1.0, 0, tau);
            guess[1] = bend;
            guess
        };
        guesses::thinned(&times::grid(rig), TAUS).iter().flat_map(|tau| BENDS.map(|bend| at(*tau, bend))).collect()
    }

    fn proceed(&self, _: Carrier, values: Values, record: &Record, memory: &mut Memory, columns: &mut [Vec<f64>]) {
        let lags = memory.states::<memory::VaryingLag>(columns.len());
        actuators::pass_in_range(values, OWN, columns, lags, |lag, t, x| {
            let bend = values.at(1, t);
            lag.step(record.time[t], x, values.at(0, t), |_| move |z| pace(z, bend))
        });
    }

    fn memory(&self, values: Values) -> Option<f64> {
        Some(values.at(0, 0) * (1.0 + values.at(1, 0)))
    }

    fn second_memory(&self, values: Values) -> Option<f64> {
        (values.at(1, 0) > 0.0).then(|| values.at(0, 0) * (1.0 - values.at(1, 0)).max(LEAST))
    }
}

/// Smallest 1 + κz: near the bottom a vessel empties in no time.
const LEAST: f64 = 1e-3;

/// τ at z over that at the middle.
pub(super) fn pace(z: f64, bend: f64) -> f64 {
    (1.0 + bend * z).max(LEAST)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: Torricelli's √y = √y_0 − c t/(2A) of a vessel that nothing flows into, from 4 m to its bottom; A/c = 3 s √m and c = 1 m^2.5/s.
    /// What flows out is √y: 0 to 2 m³/s, so that τ = 2 A/c √1 m at the middle.
    #[test]
    fn a_vessel_empties() {
        let time: Vec<f64> = [0.0, 1e-9].into_iter().chain((1..350).map(|k| 0.02 * f64::from(k))).collect();
        let mut columns = vec![vec![0.0; time.len()]];
        columns[0][0] = 2.0;
        let record = Record::new(time.clone(), columns.clone(), vec![], vec![]);
        let values = [6.0, 1.0, 2.0, 0.0];
        Outflow.act(Carrier::Rig, Values::constant(&[], &values), &record, &mut columns);
        for (t, flow) in time.iter().zip(&columns[0]).skip(1) {
            let truth = 2.0 - t / 6.0;
            assert!((flow - truth).abs() < 1e-3, "{t}: {flow} and {truth}");
        }
    }

    /// Steps of a thousand time constants land on what flows in, less what a ramp leaves behind; below the bottom it stays finite.
    #[test]
    fn long_steps_below_the_bottom_are_finite() {
        let time: Vec<f64> = (0..100).map(f64::from).collect();
        let inflow: Vec<f64> = (0..100).map(|n| if n % 2 == 0 { 1.0 } else { -3.0 }).collect();
        let mut columns = vec![inflow.clone()];
        let record = Record::new(time, columns.clone(), vec![], vec![]);
        Outflow.act(Carrier::Rig, Values::constant(&[], &[1e-3, 0.98, 1.0, -1.0]), &record, &mut columns);
        assert!(columns[0].iter().zip(&inflow).all(|(z, x)| (z - x).abs() < 0.01), "{:?}", columns[0]);
    }
}
