//! Input nonlinearity (Hammerstein): the dynamics are driven by a nonlinear function of each actuator.
//!
//! ```text
//! q̃_j = q_j + h_j (a_j (z² − 1) + b_j (z³ − z)),   z = (q_j − m_j)/h_j
//! ```
//!
//! | symbol       | meaning                                        | unit            |
//! | `a_j, b_j`   | even and odd bend, −0.6 to 0.6 and −0.15 to 0.6 | 1               |
//! | `m_j`, `h_j` | middle of the recorded range, half its width   | of the actuator |
//!
//! The ends of the range are fixed. A square from 0 on, such as heater power over voltage or rotor thrust over speed, has a = 1/2: its
//! slope 1 + 2a z + b (3z² − 1) is 0 at one end. Between −0.3 and 0.3 the map is increasing; within the bounds it decreases in the
//! outer part of one half of the range at most. Beyond the range it is linear. It acts before all lags, so that no map after them
//! replaces it. Narendra & Gallman (1966), IEEE Trans. Automatic Control 11(3).

use super::actuators;
use crate::effects::guesses::{self, Who};
use crate::effects::{Carrier, Effect, Memory, ParameterSpec, Record, Rig, Site, Traits, Values};

/// See the head of this file.
pub struct InputNonlinearity;

/// Initial values of a and b.
const BENDS: [[f64; 2]; 6] = [[0.15, 0.0], [-0.15, 0.0], [0.45, 0.0], [-0.45, 0.0], [0.0, 0.2], [0.0, -0.1]];

impl Effect for InputNonlinearity {
    fn name(&self) -> &'static str {
        "input_nonlinearity"
    }

    fn meaning(&self) -> &'static str {
        "the drive is a nonlinear function of an actuator"
    }

    fn site(&self) -> Site {
        Site::Actuation
    }

    fn source(&self) -> &'static str {
        "Narendra & Gallman (1966), IEEE Trans. Automatic Control 11(3)"
    }

    fn traits(&self) -> Traits {
        Traits { is_static: true, is_rare: true, is_generic: true, ..Traits::default() }
    }

    fn carriers(&self, rig: &Rig) -> Vec<Carrier> {
        actuators::moving(rig)
    }

    fn parameters(&self, rig: &Rig, _: Carrier) -> Vec<ParameterSpec> {
        let even = actuators::shares(rig, "even", [0.1, -0.6, 0.6]);
        let odd = actuators::shares(rig, "odd", [0.1, -0.15, 0.6]);
        even.chain(odd).chain(actuators::ends(rig)).collect()
    }

    fn initial_guesses(&self, rig: &Rig, carrier: Carrier) -> Vec<Vec<f64>> {
        let (specs, count) = (self.parameters(rig, carrier), rig.actuators.len());
        let make = |who: Who, bend: [f64; 2]| -> Vec<f64> {
            let of = |(k, spec): (usize, &ParameterSpec)| match k / count {
                order @ (0 | 1) if who.has(k % count) => spec.inside(bend[order]),
                _ => spec.neutral,
            };
            specs.iter().enumerate().map(of).collect()
        };
        guesses::alike_then_alone(rig, &BENDS, make)
    }

    fn proceed(&self, _: Carrier, values: Values, _: &Record, _: &mut Memory, columns: &mut [Vec<f64>]) {
        let count = columns.len();
        for (j, q) in columns.iter_mut().enumerate() {
            let (middle, half) = actuators::middle_and_half(values, 2 * count, count, j);
            if !actuators::is_range(middle, half) {
                continue;
            }
            for (t, q) in q.iter_mut().enumerate() {
                *q += half * bend((*q - middle) / half, values.at(j, t), values.at(count + j, t));
            }
        }
    }
}

/// a (z² − 1) + b (z³ − z), beyond −1 and 1 its tangent there.
fn bend(z: f64, even: f64, odd: f64) -> f64 {
    let end = z.clamp(-1.0, 1.0);
    let within = (end * end - 1.0) * (even + odd * end);
    within + (z - end) * (2.0 * even * end + 2.0 * odd)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: by hand, on a range of −1 to 3: z = 1/2 at 2, where the even bend is −3/4 and the odd −3/8 of half the range.
    #[test]
    fn the_middle_bends_and_the_ends_stay() {
        let record = Record::new(vec![0.0; 5], vec![], vec![], vec![]);
        let mut columns = vec![vec![-1.0, 1.0, 2.0, 3.0, 5.0]];
        let values = [0.2, 0.4, 3.0, -1.0];
        InputNonlinearity.act(Carrier::Rig, Values::constant(&[], &values), &record, &mut columns);
        let expected = [-1.0, 1.0 - 0.4, 2.0 + 2.0 * (-0.15 - 0.15), 3.0, 5.0 + 2.0 * (0.4 + 0.8)];
        for (found, expected) in columns[0].iter().zip(expected) {
            assert!((found - expected).abs() < 1e-12, "{columns:?}");
        }
    }

    /// Oracle: a square. Of 0 to 4, z = x/2 − 1, and 4 (1 + z)²/4 = 2 + 2 (z + (z² − 1)/2).
    #[test]
    fn a_square_from_zero_is_within_the_bounds() {
        for x in [0.0, 0.5, 1.7, 4.0] {
            let z = x / 2.0 - 1.0;
            assert!((2.0 + 2.0 * (z + bend(z, 0.5, 0.0)) - x * x / 4.0).abs() < 1e-12, "{x}");
        }
    }

    /// The map rises from end to end and beyond, in every corner of these bends.
    #[test]
    fn it_rises_where_it_bends_a_little() {
        for even in [-0.3, 0.0, 0.3] {
            for odd in [-0.15, 0.0, 0.1, 0.3, 0.6] {
                let at = |k: i32| f64::from(k) / 100.0 + bend(f64::from(k) / 100.0, even, odd);
                assert!((-200..200).all(|k| at(k + 1) - at(k) > 0.05 / 100.0), "{even} {odd}");
            }
        }
    }
}
