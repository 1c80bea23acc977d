//! LuGre friction: dry friction that builds up over a presliding length, and is larger at low speed, shifts the outputs.
//!
//! ```text
//! ỹ_m = y_m + f_m d(v),   δ ḋ = v − |v| d/g(v),   g = 1 + r e^{−(v/w)²},   d(t_0) = 0
//! ```
//!
//! | symbol | meaning                                                                     | unit                |
//! | `f_m`  | friction of fast sliding, one for each output                               | of the output       |
//! | `v`    | speed of the signal that carries the friction, by quartics through windows | of the signal per s |
//! | `d`    | deflection of the bristles, in units of that of fast sliding                | 1                   |
//! | `δ`    | presliding length                                                           | of the signal       |
//! | `r`    | what breaking away takes beyond sliding, 0 to 3                             | 1                   |
//! | `w`    | Stribeck's speed, over which that falls off                                 | of the signal per s |
//! | `h`    | window: half its width; the nearest five samples at 0                       | s                   |
//!
//! At r = 0 it is Dahl's friction for a speed that is linear between samples. Steady sliding has f g(v), so that with a short δ it is
//! Coulomb's and Stribeck's friction. Damping of the bristles is left out, and `viscous_friction` is a separate effect.
//! Canudas de Wit, Olsson, Åström & Lischinsky (1995), A new model for control of systems with friction, IEEE Trans. Automatic
//! Control 40(3).

use super::carrying;
use super::dahl_friction::SHORTEST;
use crate::effects::memory::{Derivative, LuGre};
use crate::effects::{Carrier, Effect, Memory, ParameterSpec, Record, Rig, Site, Traits, Values, guesses, times};

/// See the head of this file.
pub struct LugreFriction;

/// Presliding lengths to start from, surpluses, and Stribeck's speeds as shares of a typical one.
const LENGTHS: usize = 4;
const SURPLUSES: [f64; 2] = [0.3, 1.0];
const SPEEDS: [f64; 3] = [0.01, 0.05, 0.25];

/// Largest surplus.
const LARGEST: f64 = 3.0;

impl Effect for LugreFriction {
    fn name(&self) -> &'static str {
        "lugre_friction"
    }

    fn meaning(&self) -> &'static str {
        "dry friction that builds up over a presliding length and drops with speed shifts the outputs"
    }

    fn site(&self) -> Site {
        Site::Output
    }

    fn source(&self) -> &'static str {
        "Canudas de Wit, Olsson, Åström & Lischinsky (1995), IEEE Trans. Automatic Control 40(3)"
    }

    fn traits(&self) -> Traits {
        Traits { is_rare: true, follows_pressure: true, refines: Some("dahl_friction"), ..Traits::default() }
    }

    fn carriers(&self, rig: &Rig) -> Vec<Carrier> {
        carrying::motions(rig)
    }

    fn parameters(&self, rig: &Rig, carrier: Carrier) -> Vec<ParameterSpec> {
        let ((unit, width), typical) = (carrying::range(rig, carrier), carrying::typical_speed(rig, carrier));
        let mut specs = carrying::sizes(rig, "friction", "1", 1.0, 20.0);
        let speed = ParameterSpec::shape("speed", carrying::per(&unit, "s"), 0.05 * typical, 0.05 * typical);
        let presliding = ParameterSpec::shape("presliding", unit, width / 200.0, width / 200.0);
        specs.push(presliding.within(SHORTEST * width, width));
        specs.push(ParameterSpec::shape("surplus", "1", 0.0, 0.3).within(0.0, LARGEST));
        specs.push(speed.within(1e-3 * typical, typical));
        specs.push(times::window(rig));
        specs
    }

    fn initial_guesses(&self, rig: &Rig, carrier: Carrier) -> Vec<Vec<f64>> {
        let (specs, width) = (self.parameters(rig, carrier), carrying::range(rig, carrier).1);
        let (typical, outputs) = (carrying::typical_speed(rig, carrier), specs.len() - 4);
        let at = |length: f64, surplus: f64, share: f64| {
            let mut guess = guesses::guess_with(&specs, 1.0, outputs, length * width);
            (guess[outputs + 1], guess[outputs + 2]) = (surplus, share * typical);
            guess
        };
        let lengths = guesses::thinned(&guesses::presliding(), LENGTHS).into_iter();
        let shapes = SURPLUSES.iter().flat_map(|surplus| SPEEDS.map(|share| (*surplus, share)));
        lengths.flat_map(|length| shapes.clone().map(move |(surplus, share)| at(length, surplus, share))).collect()
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
        let step = |bristles: &mut LuGre, t: usize, motion: &Derivative| {
            let [presliding, surplus, speed] = [0, 1, 2].map(|k| values.at(first + k, t));
            bristles.step(record.time[t], motion.rate, presliding, surplus, speed)
        };
        let window = values.at(first + 3, 0);
        let Some(deflection) = carrying::following(record, carrier, window, memory, step) else { return };
        carrying::add(columns, |m, t| values.at(m, t), deflection);
    }
}

#[cfg(test)]
mod tests {
    use super::super::dahl_friction::DahlFriction;
    use super::*;

    /// Oracle: by hand, far from turns at w and at −w: 1 + r/e = 1 + 0.5 · 0.36787…, with the sign of the speed. The first output has its
    /// own size, and the shapes follow the sizes.
    #[test]
    fn it_slides_along_the_stribeck_curve() {
        let time: Vec<f64> = (0..100).map(|k| 0.1 * f64::from(k)).collect();
        let position = time.iter().map(|t| 1.0 - 0.2 * (t - 5.0).abs()).collect();
        let record = Record::new(time, vec![position], vec![], vec![]);
        let mut columns = vec![vec![5.0; 100], vec![0.0; 100]];
        let values = [3.0, -2.0, 0.01, 0.5, 0.2, 0.25];
        LugreFriction.act(Carrier::Actuator(0), Values::constant(&[], &values), &record, &mut columns);
        let slow = 1.0 + 0.5 * 0.367_879_441_171_442_33;
        for (t, d) in [(40, slow), (90, -slow)] {
            assert!((columns[0][t] - 5.0 - 3.0 * d).abs() < 1e-9, "{t}: {columns:?}");
            assert!((columns[1][t] + 2.0 * d).abs() < 1e-9, "{t}: {columns:?}");
        }
    }

    /// Oracle: Dahl's friction on many samples, whose parameters it has, under the same names and with the same bounds.
    #[test]
    fn without_a_surplus_it_is_dahls() {
        let time: Vec<f64> = (0..8000).map(|k| 1e-3 * f64::from(k)).collect();
        let signal: Vec<f64> = time.iter().map(|t| (1.3 * t).sin() + 0.2 * (7.0 * t).cos()).collect();
        let y = |low: f64| crate::rig::Signal { name: "y".into(), unit: "m".into(), low, high: 1.0 };
        let rig = Rig {
            actuators: vec![y(-2.0)],
            contexts: vec![],
            outputs: vec![y(0.0)],
            throttle: None,
            altitude: None,
            payload: None,
            carried: false,
            arm: None,
            step: 1e-3,
            duration: 8.0,
        };
        let carrier = Carrier::Actuator(0);
        assert_eq!(LugreFriction.parameters(&rig, carrier)[..2], DahlFriction.parameters(&rig, carrier));
        let record = Record::new(time, vec![signal], vec![], vec![]);
        let (mut found, mut truth) = (vec![vec![1.0; 8000]], vec![vec![1.0; 8000]]);
        LugreFriction.act(carrier, Values::constant(&[], &[0.7, 0.15, 0.0, 0.4, 0.0]), &record, &mut found);
        DahlFriction.act(carrier, Values::constant(&[], &[0.7, 0.15]), &record, &mut truth);
        let apart = found[0].iter().zip(&truth[0]).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(apart < 1e-3, "{apart}");
    }
}
