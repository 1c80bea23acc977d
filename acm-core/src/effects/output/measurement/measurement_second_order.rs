//! Second-order response of the measurement: a sensor on a spring, or a filter that may overshoot.
//!
//! ```text
//! ỹ'' + 2ζω ỹ' + ω² ỹ = ω² y,   ω = 2π/P,   ỹ(t_0) = y(t_0),   ỹ'(t_0) = 0
//! ```
//!
//! | symbol | meaning                     | unit |
//! | `P`    | natural period, all outputs | s    |
//! | `ζ`    | damping, all outputs        | 1    |
//!
//! Exact for outputs that are linear between samples. Franklin, Powell & Emami-Naeini (2019), Feedback Control of Dynamic
//! Systems, ch. 3.

use std::f64::consts::TAU;

use crate::effects::memory::{SecondOrderLag, pass};
use crate::effects::output::carrying;
use crate::effects::{Carrier, Effect, Memory, ParameterSpec, Record, Rig, Site, Traits, Values, oscillators};

/// See the head of this file.
pub struct MeasurementSecondOrder;

impl Effect for MeasurementSecondOrder {
    fn name(&self) -> &'static str {
        "measurement_second_order"
    }

    fn meaning(&self) -> &'static str {
        "the outputs are measured through a sprung mass, and may overshoot"
    }

    fn site(&self) -> Site {
        Site::Output
    }

    fn source(&self) -> &'static str {
        "Franklin, Powell & Emami-Naeini (2019), Feedback Control of Dynamic Systems, ch. 3"
    }

    fn traits(&self) -> Traits {
        Traits { is_rare: true, is_resonance: true, is_output_filter: true, ..Traits::default() }
    }

    fn carriers(&self, rig: &Rig) -> Vec<Carrier> {
        if rig.duration > 0.0 { carrying::any(rig) } else { vec![] }
    }

    fn parameters(&self, rig: &Rig, _: Carrier) -> Vec<ParameterSpec> {
        oscillators::parameters(rig)
    }

    fn initial_guesses(&self, rig: &Rig, _: Carrier) -> Vec<Vec<f64>> {
        oscillators::grid(rig)
    }

    fn proceed(&self, _: Carrier, values: Values, record: &Record, memory: &mut Memory, columns: &mut [Vec<f64>]) {
        let lags = memory.states::<SecondOrderLag>(columns.len());
        pass(lags, &record.time, |t| (values.at(0, t) / TAU, values.at(1, t)), columns);
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

    /// Oracle: the closed form of a critically damped sensor behind a ramp of 2/s.
    #[test]
    fn a_ramp_at_critical_damping() {
        let time: Vec<f64> = [0.0, 0.5, 0.7, 1.6, 2.0].into();
        let mut columns = vec![time.iter().map(|t| 2.0 * t).collect::<Vec<f64>>()];
        let record = Record::new(time.clone(), vec![], vec![], vec![]);
        MeasurementSecondOrder.act(Carrier::Rig, Values::constant(&[], &[3.0, 1.0]), &record, &mut columns);
        let w = TAU / 3.0;
        for (t, y) in time.iter().zip(&columns[0]) {
            let sprung = 2.0 * (t - 2.0 / w + (-w * t).exp() * (2.0 / w + t));
            assert!((y - sprung).abs() < 1e-9, "{t}: {y} {sprung}");
        }
    }
}
