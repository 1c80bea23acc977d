//! Vibration mode: a flexible mode excited by an actuator adds to the outputs, in parallel with others and with the direct path.
//!
//! ```text
//! ỹ_m = y_m + a_m z + b_m z'/ω,   z'' + 2ζω z' + ω² z = ω² q_j,   ω = 2π/P,   z(t_0) = q_j(t_0),   z'(t_0) = 0
//! ```
//!
//! | symbol | meaning                                                              | unit                       |
//! | `a_m`  | share of the displacement, one for each output                       | of the output per actuator |
//! | `b_m`  | share of the velocity, one for each output                           | of the output per actuator |
//! | `P`    | natural period                                                       | s                          |
//! | `ζ`    | damping                                                              | 1                          |
//!
//! A sum of modes is a structure with sensor and drive anywhere on it: both shares are the real and imaginary part of its residue. An
//! oscillator in series with the motion is `second_order_lag`. Exact for actuators that are linear between samples. Ewins (2000),
//! Modal Testing, ch. 2.

use std::f64::consts::TAU;

use super::carrying;
use crate::effects::memory::{SecondOrderLag, Swing};
use crate::effects::{
    Carrier, Effect, Memory, ParameterSpec, Record, Rig, Site, Traits, Values, guesses, oscillators, times,
};

/// See the head of this file.
pub struct VibrationMode;

/// Smallest and largest damping: with more, a mode is a lag.
const DAMPING: [f64; 2] = [5e-4, 0.3];

/// Damping ratio to start from.
const START: f64 = 0.04;

impl Effect for VibrationMode {
    fn name(&self) -> &'static str {
        "vibration_mode"
    }

    fn meaning(&self) -> &'static str {
        "a vibration that an actuator excites adds to the outputs"
    }

    fn site(&self) -> Site {
        Site::Output
    }

    fn source(&self) -> &'static str {
        "Ewins (2000), Modal Testing, ch. 2"
    }

    fn traits(&self) -> Traits {
        Traits { is_rare: true, is_resonance: true, repeats: true, ..Traits::default() }
    }

    fn carriers(&self, rig: &Rig) -> Vec<Carrier> {
        let is_driven = |carrier: &Carrier| rig.duration > 0.0 && matches!(carrier, Carrier::Actuator(_));
        carrying::moving_of_no_arm(rig).into_iter().filter(is_driven).collect()
    }

    fn parameters(&self, rig: &Rig, carrier: Carrier) -> Vec<ParameterSpec> {
        let (unit, width) = carrying::range(rig, carrier);
        let sizes = |name: &str| carrying::sizes(rig, name, &unit, width, 400.0);
        let mut specs: Vec<ParameterSpec> = ["displacement", "velocity"].into_iter().flat_map(sizes).collect();
        // Anything faster than that is an inertia.
        let period = times::shape(rig, "period");
        let fastest = times::vibrations(rig).first().map_or(period.lower, |fastest| *fastest);
        specs.push(period.clone().within(fastest, period.upper));
        specs.push(ParameterSpec::shape("damping", "1", 0.1, 0.1).within(DAMPING[0], DAMPING[1]));
        specs
    }

    fn initial_guesses(&self, rig: &Rig, carrier: Carrier) -> Vec<Vec<f64>> {
        let specs = self.parameters(rig, carrier);
        let last = specs.len() - 1;
        let at = |period: f64| {
            let mut guess = guesses::guess_with(&specs, 1.0, last - 1, period);
            guess[last] = START;
            guess
        };
        times::vibrations(rig).into_iter().map(at).collect()
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
        let (outputs, mut swing) = (columns.len(), Swing::default());
        let modes = memory.states::<SecondOrderLag>(1);
        let Some(mode) = modes.first_mut() else { return };
        for (t, (q, time)) in signal.iter().zip(&record.time).enumerate() {
            let [period, damping] = [0, 1].map(|k| values.at(2 * outputs + k, t));
            let unit = period / TAU;
            let displacement = mode.step(*time, *q, (unit, damping), &mut swing);
            let velocity = mode.speed() * unit;
            for (m, y) in columns.iter_mut().enumerate() {
                y[t] += values.at(m, t) * displacement;
                y[t] += values.at(outputs + m, t) * velocity;
            }
        }
    }

    fn memory(&self, values: Values) -> Option<f64> {
        let [period, damping] = self::shape(values);
        Some(oscillators::fading(period, damping))
    }

    fn swinging(&self, values: Values) -> f64 {
        let [period, damping] = self::shape(values);
        oscillators::swinging(period, damping)
    }
}

/// Period and damping, the last values.
fn shape(values: Values) -> [f64; 2] {
    [2, 1].map(|back| values.at(values.count() - back, 0))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: the step response 1 − e^{−ζωt} (cos st + ζω sin(st)/s) and its derivative, e^{−ζωt} ω² sin(st)/s, s = ω √(1 − ζ²); the actuator
    /// rises by 1 within 1 µs.
    #[test]
    fn a_step_rings() {
        let time: Vec<f64> = [0.0, 1e-6, 0.2, 0.5, 0.9, 2.0].into();
        let record = Record::new(time.clone(), vec![vec![0.0, 1.0, 1.0, 1.0, 1.0, 1.0]], vec![], vec![]);
        let (period, damping) = (0.8, 0.1);
        let mut columns = vec![vec![1.0; 6], vec![0.0; 6]];
        let values = [3.0, -1.0, 0.5, 2.0, period, damping];
        VibrationMode.act(Carrier::Actuator(0), Values::constant(&[], &values), &record, &mut columns);
        let w = TAU / period;
        let s = w * (1.0f64 - damping * damping).sqrt();
        for (k, t) in time.iter().enumerate().filter(|(k, _)| *k != 1) {
            let fade = (-damping * w * t).exp();
            let z = 1.0 - fade * ((s * t).cos() + damping * w * (s * t).sin() / s);
            let speed = fade * w * (s * t).sin() / s;
            assert!((columns[0][k] - 1.0 - 3.0 * z - 0.5 * speed).abs() < 1e-4, "{k}: {columns:?}");
            assert!((columns[1][k] + z - 2.0 * speed).abs() < 1e-4, "{k}: {columns:?}");
        }
    }
}
