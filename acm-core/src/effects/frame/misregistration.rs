//! Misregistration: the measurement frame is not where the nominal model has it.
//!
//! ```text
//! p̃ = exp(r) p + d
//! ```
//!
//! | symbol | meaning                                            | unit |
//! | `r`    | rotation vector about the origin of the frame      | rad  |
//! | `d`    | translation                                        | m    |
//!
//! Sola, Deray & Atchuthan (2018), A micro Lie theory for state estimation in robotics.

use nalgebra::Vector3;

use super::frames;
use crate::effects::{Carrier, Effect, Memory, ParameterSpec, Record, Rig, Site, Traits, Values, guesses};
use crate::se3;

/// See the head of this file.
pub struct Misregistration;

impl Effect for Misregistration {
    fn name(&self) -> &'static str {
        "misregistration"
    }

    fn meaning(&self) -> &'static str {
        "the measurement frame is turned and shifted"
    }

    fn site(&self) -> Site {
        Site::Frame
    }

    fn source(&self) -> &'static str {
        "Sola, Deray & Atchuthan (2018), A micro Lie theory for state estimation in robotics"
    }

    fn traits(&self) -> Traits {
        Traits { is_static: true, ..Traits::default() }
    }

    fn carriers(&self, rig: &Rig) -> Vec<Carrier> {
        frames::any(rig)
    }

    fn parameters(&self, rig: &Rig, _: Carrier) -> Vec<ParameterSpec> {
        let reach = frames::reach(rig);
        let turn = |name: &str| ParameterSpec::size(name, "rad", 0.02).within(-0.5, 0.5);
        let shift = |name: &str| ParameterSpec::size(name, "m", 0.02 * reach).within(-0.5 * reach, 0.5 * reach);
        ["rx", "ry", "rz"].into_iter().map(turn).chain(["tx", "ty", "tz"].into_iter().map(shift)).collect()
    }

    fn initial_guesses(&self, rig: &Rig, carrier: Carrier) -> Vec<Vec<f64>> {
        vec![guesses::guess(&self.parameters(rig, carrier), 0.3)]
    }

    fn proceed(&self, _: Carrier, values: Values, _: &Record, _: &mut Memory, columns: &mut [Vec<f64>]) {
        let vector = |first: usize, t: usize| Vector3::from_fn(|x, _| values.at(first + x, t));
        frames::each(columns, |t, place| se3::rotation(&vector(0, t)) * place + vector(3, t));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: a quarter turn about z takes x to y, by hand; the shift comes after it. Every marker moves.
    #[test]
    fn turns_first_and_shifts_then() {
        let mut columns = vec![vec![2.0], vec![0.0], vec![1.0], vec![0.0], vec![1.0], vec![0.0]];
        let values = [0.0, 0.0, std::f64::consts::FRAC_PI_2, 10.0, 20.0, 30.0];
        Misregistration.act(Carrier::Rig, Values::constant(&[], &values), &Record::default(), &mut columns);
        for (column, expected) in columns.iter().zip([10.0, 22.0, 31.0, 9.0, 20.0, 30.0]) {
            assert!((column[0] - expected).abs() < 1e-14, "{columns:?}");
        }
    }
}
