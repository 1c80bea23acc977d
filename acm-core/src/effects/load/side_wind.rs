//! Side wind: a steady load from one side, evenly along the arm.
//!
//! ```text
//! free_i = f_i,   held_i = −c f_i,   i = first, second
//! ```
//!
//! | symbol       | meaning                                                                          | unit |
//! | `f_1`, `f_2` | load per length over stiffness along the axes of [`crate::fields::horizontal`]   | 1/m³ |
//! | `c`          | share of the mean bending that the tendons hold                                  | 1    |
//!
//! Hoerner (1965), Fluid-Dynamic Drag, ch. III.

use super::arms;
use crate::effects::{Carrier, Effect, Memory, ParameterSpec, Record, Rig, Site, Traits, Values};
use crate::fields::Load;

/// See the head of this file.
pub struct SideWind;

impl Effect for SideWind {
    fn name(&self) -> &'static str {
        "side_wind"
    }

    fn meaning(&self) -> &'static str {
        "a wind from one side pushes the arm"
    }

    fn site(&self) -> Site {
        Site::Load
    }

    fn source(&self) -> &'static str {
        "Hoerner (1965), Fluid-Dynamic Drag, ch. III"
    }

    fn traits(&self) -> Traits {
        Traits { is_static: true, ..Traits::default() }
    }

    fn carriers(&self, rig: &Rig) -> Vec<Carrier> {
        arms::any(rig)
    }

    fn parameters(&self, rig: &Rig, _: Carrier) -> Vec<ParameterSpec> {
        vec![arms::spread(rig, "first"), arms::spread(rig, "second"), arms::held()]
    }

    fn initial_guesses(&self, rig: &Rig, carrier: Carrier) -> Vec<Vec<f64>> {
        let specs = self.parameters(rig, carrier);
        [0.0, 0.8].iter().map(|&held| arms::guess(&specs, &[(2, held)])).collect()
    }

    fn proceed(&self, _: Carrier, values: Values, _: &Record, _: &mut Memory, columns: &mut [Vec<f64>]) {
        arms::load(columns, Load::SideFirst, |t| values.at(2, t), |t| values.at(0, t));
        arms::load(columns, Load::SideSecond, |t| values.at(2, t), |t| values.at(1, t));
    }
}
