//! Vessel that fills by the actuators, empties by Torricelli's law, and overflows at its brim.
//!
//! ```text
//! τ (1 + κ z) dz/dt = x − z   below the brim, z ≤ 1/β − 1
//! q̃ = m + h (z + c w),   w = x − z at the brim, 0 below it
//! ```
//!
//! | symbol             | meaning                                                                           | unit |
//! | `τ`, `κ`, `m`, `h` | those of [`outflow`](super::outflow), all actuators                               | s, 1 |
//! | `β`                | brim: what flows out of the full vessel is 1/β of h above the least inflow, 0 to 5 | 1    |
//! | `c`                | share of what overflows that goes on with the outflow, 0 to 1                     | 1    |
//!
//! At β = 0 it has no brim, and is `outflow`; up to 1/2 nothing overflows within the range. A tank whose level is measured has c = 0;
//! the lower of two stacked tanks catches a part of what the upper one spills. The brim is reached at a sample: first order in the
//! sampling interval where it overflows, second order elsewhere ([`memory::VaryingLag`]). Schoukens & Noël (2017), Three benchmarks
//! addressing open challenges in nonlinear system identification, IFAC-PapersOnLine 50(1), sec. 3 (cascaded tanks).

use crate::effects::actuation::actuators;
use crate::effects::actuation::lag::outflow::{Outflow, pace};
use crate::effects::{
    Carrier, Effect, Memory, ParameterSpec, Record, Rig, Site, Traits, Values, guesses, memory, times,
};

/// See the head of this file.
pub struct Overflow;

/// Parameters before the ends of the ranges.
const OWN: usize = 4;

/// Time constants to start from, values of κ, and values of β and c.
const TAUS: usize = 6;
const BENDS: [f64; 2] = [0.5, 0.9];
const BRIMS: [[f64; 2]; 2] = [[1.0, 0.5], [0.7, 0.5]];

impl Effect for Overflow {
    fn name(&self) -> &'static str {
        "overflow"
    }

    fn meaning(&self) -> &'static str {
        "the actuators fill a vessel that empties through an orifice and overflows"
    }

    fn site(&self) -> Site {
        Site::Actuation
    }

    fn source(&self) -> &'static str {
        "Schoukens & Noël (2017), IFAC-PapersOnLine 50(1), sec. 3"
    }

    fn traits(&self) -> Traits {
        Traits {
            is_rare: true,
            repeats: true,
            refines: Some("actuator_lag"),
            replaces: Some("outflow"),
            shows_against_rate: true,
            ..Traits::default()
        }
    }

    fn carriers(&self, rig: &Rig) -> Vec<Carrier> {
        Outflow.carriers(rig)
    }

    fn parameters(&self, rig: &Rig, _: Carrier) -> Vec<ParameterSpec> {
        let bend = ParameterSpec::shape("bend", "1", 0.0, 0.3).within(0.0, 1.0);
        let brim = ParameterSpec::shape("brim", "1", 0.0, 0.3).within(0.0, 5.0);
        let caught = ParameterSpec::shape("caught", "1", 0.0, 0.3).within(0.0, 1.0);
        [times::size(rig, "tau"), bend, brim, caught].into_iter().chain(actuators::ends(rig)).collect()
    }

    fn initial_guesses(&self, rig: &Rig, carrier: Carrier) -> Vec<Vec<f64>> {
        let specs = self.parameters(rig, carrier);
        let at = |tau: f64, bend: f64, [brim, caught]: [f64; 2]| {
            let mut guess = guesses::guess_with(&specs, 1.0, 0, tau);
            guess[1..OWN].copy_from_slice(&[bend, brim, caught]);
            guess
        };
        let taus = guesses::thinned(&times::grid(rig), TAUS);
        let shapes = BENDS.into_iter().flat_map(|bend| BRIMS.map(|brim| (bend, brim)));
        taus.iter().flat_map(|&tau| shapes.clone().map(move |(bend, brim)| at(tau, bend, brim))).collect()
    }

    fn proceed(&self, _: Carrier, values: Values, record: &Record, memory: &mut Memory, columns: &mut [Vec<f64>]) {
        let lags = memory.states::<memory::VaryingLag>(columns.len());
        actuators::pass_in_range(values, OWN, columns, lags, |lag, t, x| {
            let [tau, bend, brim, caught] = [0, 1, 2, 3].map(|j| values.at(j, t));
            let z = lag.step(record.time[t], x, tau, |_| move |z| pace(z, bend));
            let full = 1.0 / brim - 1.0;
            if z < full || tau <= memory::VaryingLag::NONE {
                return z;
            }
            lag.hold(full);
            full + caught * (x - full).max(0.0)
        });
    }

    fn memory(&self, values: Values) -> Option<f64> {
        Outflow.memory(values)
    }

    fn second_memory(&self, values: Values) -> Option<f64> {
        Outflow.second_memory(values)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const RANGE: [f64; 2] = [2.0, 0.0];

    fn acted(effect: &dyn Effect, own: &[f64], time: &[f64], inflow: &[f64]) -> Vec<f64> {
        let mut columns = vec![inflow.to_vec()];
        let record = Record::new(time.to_vec(), columns.clone(), vec![], vec![]);
        effect.act(Carrier::Rig, Values::constant(&[], &[own, &RANGE].concat()), &record, &mut columns);
        columns.remove(0)
    }

    /// Oracle: ẏ = w − c √y of a vessel of 1 m², by steps of a tenth of a millisecond, whose level cannot rise beyond 1.69 m; it spills the
    /// rest of w. With c = 1 m^2.5/s what flows out is √y, at most 1.3 m³/s, that is 1/β in
    /// half ranges of 1 from the least at 0.
    #[test]
    fn a_vessel_spills_what_it_cannot_hold() {
        let time: Vec<f64> = (0..3000).map(|k| 0.01 * f64::from(k)).collect();
        let inflow = |t: f64| 1.0 + (0.5 * t).sin();
        let (fine, mut level, mut truth) = (100, 1.0f64, vec![]);
        for &t in &time {
            let spilt = if level >= 1.69 { (inflow(t) - level.sqrt()).max(0.0) } else { 0.0 };
            truth.push(level.sqrt() + 0.6 * spilt);
            for k in 0..fine {
                let h = 0.01 / f64::from(fine);
                level = (level + h * (inflow(t + h * f64::from(k)) - level.sqrt())).min(1.69);
            }
        }
        let filled: Vec<f64> = time.iter().map(|t| inflow(*t)).collect();
        let flow = acted(&Overflow, &[2.0, 1.0, 1.0 / 1.3, 0.6], &time, &filled);
        let worst = flow.iter().zip(&truth).map(|(flow, truth)| (flow - truth).abs()).fold(0.0, f64::max);
        assert!(worst < 5e-3, "{worst}");
        assert!(truth.iter().any(|flow| *flow > 1.5) && truth.iter().any(|flow| *flow < 0.8));
    }

    /// Oracle: `outflow`, another implementation of the vessel without a brim.
    #[test]
    fn a_high_brim_is_none() {
        let time: Vec<f64> = (0..400).map(|k| 0.05 * f64::from(k)).collect();
        let inflow: Vec<f64> = time.iter().map(|t| 1.0 + (1.7 * t).sin()).collect();
        let flow = acted(&Overflow, &[0.7, 0.6, 0.49, 0.4], &time, &inflow);
        assert_eq!(flow, acted(&Outflow, &[0.7, 0.6], &time, &inflow));
    }
}
