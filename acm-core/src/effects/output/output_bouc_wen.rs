//! Bouc–Wen hysteresis of the outputs over a signal: a bounded force or shift driven by the signal's motion, which yields
//! smoothly or suddenly, as in a magneto-rheological damper, a pneumatic muscle or a piezo stack.
//!
//! ```text
//! ỹ_m = y_m + f_m z(s̃),   δ dz = ds̃ − ½(1 + a) |ds̃| |z|^{n−1} z − ½(1 − a) ds̃ |z|^n,   z(t_0) = z_0
//! ```
//!
//! | symbol | meaning                                                                  | unit          |
//! | `f_m`  | half the height of the loop, one for each output                         | of the output |
//! | `s`    | the signal whose motion carries the hysteresis                           | its own       |
//! | `δ`    | width of the transition                                                  | of the signal |
//! | `a`    | asymmetry (β − γ)/(β + γ) of loading and unloading                       | 1             |
//! | `n`    | exponent, 1 to 3: the larger, the more suddenly it yields                | 1             |
//! | `z_0`  | state at the first sample, −1 to 1: what was done to the rig before it   | 1             |
//! | `s̃`    | the signal by a quartic through a window around each sample             | its own       |
//! | `h`    | window: half its width; the signal as it is at 0                         | s             |
//!
//! In units of saturation, so that |z| ≤ 1. At a = 1, n = 1, z_0 = 0 and h = 0 it is `dahl_friction`, and with a larger n it would come to
//! `output_hysteresis`. Ismail, Ikhouane & Rodellar (2009), Archives of Computational Methods in Engineering 16(2).

use super::carrying;
use crate::effects::memory::{BoucWen, Derivative};
use crate::effects::{Carrier, Effect, Memory, ParameterSpec, Record, Rig, Site, Traits, Values, guesses, times};

/// See the head of this file.
pub struct OutputBoucWen;

/// Smallest, typical and largest width as shares of the signal's range.
const WIDTHS: [f64; 3] = [0.0005, 0.05, 1.0];

/// Asymmetry and exponent to start from, between friction and an element that yields suddenly.
const SHAPE: [f64; 2] = [0.3, 1.5];

impl Effect for OutputBoucWen {
    fn name(&self) -> &'static str {
        "output_bouc_wen"
    }

    fn meaning(&self) -> &'static str {
        "the outputs lag behind a signal by a smooth loop, whatever its speed"
    }

    fn site(&self) -> Site {
        Site::Output
    }

    fn source(&self) -> &'static str {
        "Ismail, Ikhouane & Rodellar (2009), Archives of Computational Methods in Engineering 16(2)"
    }

    fn traits(&self) -> Traits {
        Traits { is_rare: true, follows_pressure: true, ..Traits::default() }
    }

    fn carriers(&self, rig: &Rig) -> Vec<Carrier> {
        carrying::moving(rig)
    }

    fn parameters(&self, rig: &Rig, carrier: Carrier) -> Vec<ParameterSpec> {
        let (unit, width) = carrying::range(rig, carrier);
        let [smallest, typical, largest] = WIDTHS.map(|share| share * width);
        let mut specs = carrying::sizes(rig, "height", "1", 1.0, 20.0);
        specs.push(ParameterSpec::shape("width", unit, typical, typical).within(smallest, largest));
        specs.push(ParameterSpec::shape("asymmetry", "1", 1.0, 0.3).within(-0.9, 4.0));
        specs.push(ParameterSpec::shape("exponent", "1", 1.0, 0.5).within(1.0, 3.0));
        specs.push(ParameterSpec::shape("start", "1", 0.0, 0.3).within(-1.0, 1.0));
        specs.push(times::window(rig));
        specs
    }

    fn initial_guesses(&self, rig: &Rig, carrier: Carrier) -> Vec<Vec<f64>> {
        let (specs, range) = (self.parameters(rig, carrier), carrying::range(rig, carrier).1);
        let first = specs.len() - 5;
        let of = |width: f64| {
            let mut guess = guesses::guess_with(&specs, 1.0, first, width * range);
            guess[first + 1..first + 3].copy_from_slice(&SHAPE);
            guess[first + 3] = 0.0;
            guess
        };
        guesses::lengths().into_iter().map(of).collect()
    }

    fn proceed(
        &self,
        carrier: Carrier,
        values: Values,
        record: &Record,
        memory: &mut Memory,
        columns: &mut [Vec<f64>],
    ) {
        let first = columns.len();
        let step = |state: &mut BoucWen, t: usize, signal: &Derivative| {
            let [width, asymmetry, exponent, start] = [0, 1, 2, 3].map(|k| values.at(first + k, t));
            state.begin(start);
            state.step_of_power(signal.value, width, asymmetry, exponent)
        };
        let Some(loops) = carrying::following(record, carrier, values.at(first + 4, 0), memory, step) else { return };
        carrying::add(columns, |m, t| values.at(m, t), loops);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: by hand with exponent 2, where dz/dw is 1 − z² away from rest and 1 + a z² back to it: from −½ with a = ¼ through 0 at
    /// w = 2 atan ¼ and on as tanh; then back by ½. The second output has its own size.
    #[test]
    fn with_exponent_2_it_is_a_tangent_and_a_hyperbolic_tangent() {
        let record = Record::new(vec![0.0, 1.0, 2.0], vec![vec![0.0, 0.4, 0.3]], vec![], vec![]);
        let mut columns = vec![vec![1.0; 3], vec![0.0; 3]];
        let values = [3.0, -2.0, 0.2, 0.25, 2.0, -0.5, 0.0];
        OutputBoucWen.act(Carrier::Actuator(0), Values::constant(&[], &values), &record, &mut columns);
        let there = (2.0 - 2.0 * 0.25f64.atan()).tanh();
        let back = 2.0 * ((0.5 * there).atan() - 0.25).tan();
        for (t, z) in [-0.5, there, back].into_iter().enumerate() {
            assert!((columns[0][t] - 1.0 - 3.0 * z).abs() < 3e-4, "{t}: {columns:?} and {z}");
            assert!((columns[1][t] + 2.0 * z).abs() < 2e-4, "{t}: {columns:?} and {z}");
        }
    }
}
