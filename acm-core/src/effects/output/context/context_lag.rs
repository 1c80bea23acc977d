//! A term that lags behind a context signal, such as the drift of a sensor whose body warms up after a recorded temperature.
//!
//! ```text
//! ỹ_m = y_m + k_m (c̃ − c_0),   τ dc̃/dt = c − c̃,   c̃(t_0) = c(t_0)
//! ```
//!
//! | symbol | meaning                                                                              | unit                   |
//! | `k_m`  | sensitivity, one for each output                                                     | of the output per unit |
//! | `c`    | context signal                                                                       | its own                |
//! | `τ`    | time in which its action follows                                                     | s                      |
//! | `c_0`  | middle of its range: what the term means there, the nominal model has already        | of the signal          |
//!
//! Incropera et al. (2007), Fundamentals of Heat and Mass Transfer, ch. 5.1: lumped capacitance.

use super::super::carrying;
use crate::effects::memory::{Decay, Lag};
use crate::effects::{Carrier, Effect, Memory, ParameterSpec, Record, Rig, Site, Traits, Values, guesses, times};

/// See the head of this file.
pub struct ContextLag;

impl Effect for ContextLag {
    fn name(&self) -> &'static str {
        "context_lag"
    }

    fn meaning(&self) -> &'static str {
        "the outputs follow a context signal late"
    }

    fn site(&self) -> Site {
        Site::Output
    }

    fn source(&self) -> &'static str {
        "Incropera et al. (2007), Fundamentals of Heat and Mass Transfer, ch. 5.1"
    }

    fn traits(&self) -> Traits {
        Traits { is_rare: true, refines: Some("context_term"), ..Traits::default() }
    }

    fn carriers(&self, rig: &Rig) -> Vec<Carrier> {
        carrying::moving_contexts(rig)
    }

    fn parameters(&self, rig: &Rig, carrier: Carrier) -> Vec<ParameterSpec> {
        let (unit, width) = carrying::range(rig, carrier);
        let mut specs = carrying::sizes(rig, "sensitivity", &unit, width, 40.0);
        specs.push(ParameterSpec::known("centre", unit, carrying::middle(rig, carrier)));
        specs.push(times::shape(rig, "tau"));
        specs
    }

    fn initial_guesses(&self, rig: &Rig, carrier: Carrier) -> Vec<Vec<f64>> {
        let specs = self.parameters(rig, carrier);
        times::grid(rig).iter().map(|tau| guesses::guess_with(&specs, 1.0, specs.len() - 1, *tau)).collect()
    }

    fn proceed(
        &self,
        carrier: Carrier,
        values: Values,
        record: &Record,
        memory: &mut Memory,
        columns: &mut [Vec<f64>],
    ) {
        let Some(signal) = carrying::signal(record, carrier) else { return };
        let centre = values.at(columns.len(), 0);
        let tau = columns.len() + 1;
        let (lags, late) = memory.states_and_column::<Lag>(1);
        let Some(lag) = lags.first_mut() else { return };
        late.clear();
        let mut decay = Decay::default();
        let samples = signal.iter().zip(&record.time).enumerate();
        late.extend(samples.map(|(t, (c, time))| lag.step(*time, *c, values.at(tau, t), &mut decay) - centre));
        carrying::add(columns, |m, t| values.at(m, t), late);
    }

    fn memory(&self, values: Values) -> Option<f64> {
        Some(values.at(values.count() - 1, 0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: behind a step of the signal at its first sample the term is late by e^{−t/τ}: the signal rises by 10 within 1 µs.
    #[test]
    fn it_follows_a_step_as_a_first_order_lag() {
        let time = vec![0.0, 1e-6, 1.0, 3.0, 10.0];
        let record = Record::new(time.clone(), vec![], vec![vec![300.0, 310.0, 310.0, 310.0, 310.0]], vec![]);
        let mut columns = vec![vec![1.0; 5], vec![0.0; 5]];
        ContextLag.act(Carrier::Context(0), Values::constant(&[], &[0.2, -1.0, 300.0, 2.0]), &record, &mut columns);
        for (t, time) in time.iter().enumerate() {
            let rise = 10.0 * (1.0 - (-time / 2.0).exp());
            assert!((columns[0][t] - 1.0 - 0.2 * rise).abs() < 1e-5, "{t}");
            assert!((columns[1][t] + rise).abs() < 1e-5, "{t}");
        }
    }
}
