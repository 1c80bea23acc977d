//! Wake lag: a confined flow takes a while to establish after the throttle has changed.
//!
//! ```text
//! w_wash = b ũ (1 − d),   w_near = b ũ d,   free = w,   held = −c w,   τ dũ/dt = u − ũ,   ũ(t_0) = u(t_0)
//! ```
//!
//! | symbol | meaning                                                          | unit              |
//! | `b`    | drag per length over bending stiffness, for a unit of throttle   | 1/m³ per throttle |
//! | `u`    | throttle                                                         | of the signal     |
//! | `τ`    | time in which the flow establishes                               | s                 |
//! | `d`    | share that the jet loses over one arm length, linearly           | 1                 |
//! | `c`    | share of the mean bending that the tendons hold                  | 1                 |
//!
//! Dynamic inflow: Pitt & Peters (1981), Vertica 5(1).

use super::arms;
use crate::effects::memory::{Decay, Lag};
use crate::effects::output::carrying;
use crate::effects::{Carrier, Effect, Memory, ParameterSpec, Record, Rig, Site, Values, guesses, times};

/// See the head of this file.
pub struct WakeLag;

impl Effect for WakeLag {
    fn name(&self) -> &'static str {
        "wake_lag"
    }

    fn meaning(&self) -> &'static str {
        "a downwash that establishes late pushes the arm"
    }

    fn site(&self) -> Site {
        Site::Load
    }

    fn source(&self) -> &'static str {
        "Pitt & Peters (1981), Vertica 5(1)"
    }

    fn carriers(&self, rig: &Rig) -> Vec<Carrier> {
        arms::carried_by(rig, rig.throttle)
    }

    fn parameters(&self, rig: &Rig, _: Carrier) -> Vec<ParameterSpec> {
        vec![
            arms::positive(arms::spread_by_throttle(rig, "drag")),
            times::shape(rig, "tau"),
            arms::decay(),
            arms::held(),
        ]
    }

    fn initial_guesses(&self, rig: &Rig, carrier: Carrier) -> Vec<Vec<f64>> {
        let (specs, taus) = (self.parameters(rig, carrier), times::grid(rig));
        let held = taus.iter().map(|tau| (*tau, 0.8));
        let free = guesses::thinned(&taus, 4).into_iter().map(|tau| (tau, 0.0));
        held.chain(free).map(|(tau, held)| arms::guess(&specs, &[(1, tau), (3, held)])).collect()
    }

    fn proceed(
        &self,
        carrier: Carrier,
        values: Values,
        record: &Record,
        memory: &mut Memory,
        columns: &mut [Vec<f64>],
    ) {
        let Some(throttle) = carrying::signal(record, carrier) else { return };
        let (lags, late) = memory.states_and_column::<Lag>(1);
        let Some(lag) = lags.first_mut() else { return };
        late.clear();
        let mut decay = Decay::default();
        let samples = throttle.iter().zip(&record.time).enumerate();
        late.extend(samples.map(|(t, (throttle, time))| lag.step(*time, *throttle, values.at(1, t), &mut decay)));
        arms::jet(columns, |t| values.at(2, t), |t| values.at(3, t), |t| values.at(0, t) * late[t]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fields::{Field, Load};

    /// Oracle: behind a throttle that rises with slope 1, the flow is late by τ (1 − e^{−t/τ}).
    #[test]
    fn the_flow_is_late_behind_a_ramp() {
        let time: Vec<f64> = [0.0, 0.3, 0.4, 1.1, 2.0, 9.0].into();
        let ramp = time.iter().map(|t| 5.0 + t).collect();
        let record = Record::new(time, vec![], vec![ramp], vec![]);
        let mut columns = vec![vec![0.0; 6]; Field::ALL.len()];
        WakeLag.act(Carrier::Context(0), Values::constant(&[], &[2.0, 0.8, 0.0, 0.0]), &record, &mut columns);
        for (t, load) in record.time.iter().zip(&columns[Field::Free(Load::Wash).column()]) {
            let late = 0.8 * (1.0 - (-t / 0.8).exp());
            assert!((load - 2.0 * (5.0 + t - late)).abs() < 1e-9);
        }
    }
}
