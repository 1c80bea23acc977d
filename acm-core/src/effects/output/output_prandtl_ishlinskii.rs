//! Hysteresis of the outputs over a signal as a sum of elastic-plastic elements: a Prandtl–Ishlinskii stop operator.
//!
//! ```text
//! ỹ_m = y_m + Σ_i h_{i,m} (s − P_{r_i}(s)),   P_r: play of radius r,   |s − P_r(s)| ≤ r,   s − P_r(s) = z_0 r at t_0
//! ```
//!
//! | symbol    | meaning                                                          | unit                   |
//! | `h_{i,m}` | stiffness of each element, one for each output                   | of the output per unit |
//! | `s`       | the signal whose motion carries the hysteresis                   | its own                |
//! | `r_i`     | travel at which it yields: 6, 14, 24, 36, 50, 65, 82 and 100 % of r | of the signal       |
//! | `r`       | the largest travel                                               | of the signal          |
//! | `z_0`     | strain at the first sample over each travel: what was done before, 1 where the signal had come from far below | 1 |
//!
//! Parallel elements make minor loops whose shape depends on the reversal points: piezo stacks, shape-memory alloys, soft actuators. One
//! element alone is `output_hysteresis`, which it is tried as a replacement of: from the start, eight stiffnesses would also explain a
//! simpler hysteresis that depends on another signal. The outputs are linear in all stiffnesses. Kuhnen (2003), European Journal of
//! Control 9(4); Brokate & Sprekels (1996), Hysteresis and Phase Transitions, sec. 2.4.

use super::carrying;
use crate::effects::memory::Play;
use crate::effects::{Carrier, Effect, Memory, ParameterSpec, Record, Rig, Site, Traits, Values, guesses};

/// See the head of this file.
pub struct OutputPrandtlIshlinskii;

/// Travels as shares of the largest: closer together where they are small, since small motions only reach those.
const SHARES: [f64; ELEMENTS] = [0.06, 0.14, 0.24, 0.36, 0.5, 0.65, 0.82, 1.0];
const ELEMENTS: usize = 8;

/// Smallest and largest travel as shares of the signal's range. At half of it an element hardly yields both ways.
const RADII: [f64; 2] = [0.005, 0.4];

/// Largest travels as shares of the signal's range, and strains at the first sample, to start from.
const SPREAD: [f64; 4] = [0.05, 0.12, 0.25, 0.4];
const BEFORE: [f64; 3] = [0.0, -0.9, 0.9];

impl Effect for OutputPrandtlIshlinskii {
    fn name(&self) -> &'static str {
        "output_prandtl_ishlinskii"
    }

    fn meaning(&self) -> &'static str {
        "the outputs lag behind a signal by loops within loops, whatever its speed"
    }

    fn site(&self) -> Site {
        Site::Output
    }

    fn source(&self) -> &'static str {
        "Kuhnen (2003), European Journal of Control 9(4); Brokate & Sprekels (1996), Hysteresis and Phase Transitions, sec. 2.4"
    }

    fn traits(&self) -> Traits {
        Traits {
            is_rare: true,
            is_generic: true,
            refines: Some("output_hysteresis"),
            replaces: Some("output_bouc_wen"),
            ..Traits::default()
        }
    }

    fn carriers(&self, rig: &Rig) -> Vec<Carrier> {
        if rig.arm.is_none() { carrying::motions(rig) } else { vec![] }
    }

    fn parameters(&self, rig: &Rig, carrier: Carrier) -> Vec<ParameterSpec> {
        let (unit, range) = carrying::range(rig, carrier);
        let [smallest, largest] = RADII.map(|share| share * range);
        let of = |i: usize| carrying::sizes(rig, &format!("stiffness_{}", i + 1), &unit, SHARES[i] * largest, 100.0);
        let mut specs: Vec<ParameterSpec> = (0..ELEMENTS).flat_map(of).collect();
        specs.push(ParameterSpec::shape("radius", unit, largest, 0.5 * largest).within(smallest, largest));
        specs.push(ParameterSpec::shape("start", "1", 0.0, 0.3).within(-1.0, 1.0));
        specs
    }

    fn initial_guesses(&self, rig: &Rig, carrier: Carrier) -> Vec<Vec<f64>> {
        let (specs, range) = (self.parameters(rig, carrier), carrying::range(rig, carrier).1);
        let of = |share: f64| {
            let guess = guesses::guess_with(&specs, 1.0, specs.len() - 2, share * range);
            BEFORE.map(|start| [&guess[..guess.len() - 1], &[start]].concat())
        };
        SPREAD.into_iter().flat_map(of).collect()
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
        let outputs = columns.len();
        let plays = memory.states::<[Play; ELEMENTS]>(1);
        let Some(plays) = plays.first_mut() else { return };
        // A regression asks for one element after the other.
        let acts = |i: usize| (0..outputs).any(|m| !values.is_zero(i * outputs + m));
        for (i, play) in plays.iter_mut().enumerate().filter(|(i, _)| acts(*i)) {
            for (t, s) in signal.iter().enumerate() {
                let radius = values.at(ELEMENTS * outputs, t);
                let start = values.at(ELEMENTS * outputs + 1, t);
                let travel = SHARES[i] * radius;
                play.begin(s - start * travel);
                let strain = s - play.step(*s, travel);
                columns.iter_mut().enumerate().for_each(|(m, y)| y[t] += values.at(i * outputs + m, t) * strain);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: by hand. With travels up to 1, a signal that goes from 0 to 2 and back to 1.9 strains every element by its travel, then each by
    /// 0.1 less.
    #[test]
    fn each_element_yields_at_its_own_travel() {
        let record = Record::new(vec![0.0, 1.0, 2.0], vec![vec![0.0, 2.0, 1.9]], vec![], vec![]);
        for ((i, share), start) in SHARES.iter().enumerate().flat_map(|one| [0.0, -1.0, 0.5].map(|start| (one, start)))
        {
            let mut values = vec![0.0; 2 * ELEMENTS];
            values[2 * i] = 3.0;
            values[2 * i + 1] = -1.0;
            values.extend([1.0, start]);
            let mut columns = vec![vec![1.0; 3], vec![0.0; 3]];
            OutputPrandtlIshlinskii.act(Carrier::Actuator(0), Values::constant(&[], &values), &record, &mut columns);
            for (t, strain) in [start * share, *share, share - 0.1].into_iter().enumerate() {
                assert!((columns[0][t] - 1.0 - 3.0 * strain).abs() < 1e-12, "{i} {t}: {columns:?}");
                assert!((columns[1][t] + strain).abs() < 1e-12, "{i} {t}: {columns:?}");
            }
        }
    }
}
