//! Saturation: each actuator stops short of the range that it reports.
//!
//! ```text
//! q̃_j = q_j + c(l_j + b_j − q_j) − c(q_j − h_j + a_j),   c(d) = max(0, d) with a corner of the radius r b_j, r a_j ([`super::corner`])
//! ```
//!
//! | symbol       | meaning                                                   | unit            |
//! | `a_j`, `b_j` | what is cut off the upper and the lower end; 0 cuts nothing | of the actuator |
//! | `r`          | roundness of both ends; 0 for sharp ones                  | 1               |
//! | `h_j`, `l_j` | upper and lower end of the recorded range                 | of the actuator |
//!
//! Two cuts, so that a signal of one sign can stop at one end alone. Each is at most 0.45 of the range, so that the cuts do
//! not meet. Khalil (2002), Nonlinear Systems, 3rd ed., 1.2.

use super::{actuators, corner};
use crate::effects::guesses::{self, Who};
use crate::effects::{Carrier, Effect, Memory, ParameterSpec, Record, Rig, Site, Traits, Values};

/// See the head of this file.
pub struct Saturation;

/// Where the ends may lie to start from, as shares of the half range.
const ENDS: [f64; 5] = [0.3, 0.5, 0.7, 0.85, 0.95];

/// Which ends are cut in a guess: both, the upper, the lower.
const CUTS: [[bool; 2]; 3] = [[true, true], [true, false], [false, true]];

impl Effect for Saturation {
    fn name(&self) -> &'static str {
        "saturation"
    }

    fn meaning(&self) -> &'static str {
        "an actuator stops short of the range that it reports"
    }

    fn site(&self) -> Site {
        Site::Actuation
    }

    fn source(&self) -> &'static str {
        "Khalil (2002), Nonlinear Systems, 3rd ed., 1.2"
    }

    fn traits(&self) -> Traits {
        Traits { is_static: true, is_generic: true, ..Traits::default() }
    }

    fn carriers(&self, rig: &Rig) -> Vec<Carrier> {
        actuators::moving(rig)
    }

    fn parameters(&self, rig: &Rig, _: Carrier) -> Vec<ParameterSpec> {
        let cut = |end: &'static str| actuators::sizes(rig, end, [0.1, 0.0, 0.45]);
        cut("upper_cut").chain(cut("lower_cut")).chain(actuators::ends(rig)).chain([corner::roundness()]).collect()
    }

    fn initial_guesses(&self, rig: &Rig, carrier: Carrier) -> Vec<Vec<f64>> {
        let (specs, count) = (self.parameters(rig, carrier), rig.actuators.len());
        let make = |cut: [bool; 2], who: Who, end: f64| -> Vec<f64> {
            let of = |(k, spec): (usize, &ParameterSpec)| match k / count {
                side @ (0 | 1) if cut[side] && who.has(k % count) => {
                    spec.inside(0.5 * (1.0 - end) * actuators::travel(&rig.actuators[k % count]))
                }
                _ => spec.neutral,
            };
            specs.iter().enumerate().map(of).collect()
        };
        CUTS.iter().flat_map(|cut| guesses::alike_then_alone(rig, &ENDS, |who, end| make(*cut, who, end))).collect()
    }

    fn proceed(&self, _: Carrier, values: Values, _: &Record, _: &mut Memory, columns: &mut [Vec<f64>]) {
        let count = columns.len();
        let roundness = values.at(4 * count, 0);
        for (j, q) in columns.iter_mut().enumerate() {
            for (t, q) in q.iter_mut().enumerate() {
                let (upper, lower) = (values.at(j, t), values.at(count + j, t));
                if lower > 0.0 {
                    *q += corner::rounded(values.at(3 * count + j, t) + lower - *q, roundness * lower);
                }
                if upper > 0.0 {
                    *q -= corner::rounded(*q - (values.at(2 * count + j, t) - upper), roundness * upper);
                }
            }
        }
    }
}
