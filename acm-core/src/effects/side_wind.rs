//! Side wind: a steady load from one side, evenly along the arm.
//!
//! ```text
//! w_first = f_1,   w_second = f_2
//! ```
//!
//! | symbol       | meaning                                                                          | unit |
//! | `f_1`, `f_2` | load per length over stiffness along the axes of [`crate::fields::horizontal`]   | 1/m³ |
//!
//! Hoerner (1965), Fluid-Dynamic Drag, ch. III.

use super::{Carrier, Effect, ParameterSpec, Record, Rig, Site, Values, actuators, arms};
use crate::fields::Field;

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

    fn carriers(&self, rig: &Rig) -> Vec<Carrier> {
        arms::any(rig)
    }

    fn parameters(&self, rig: &Rig, _: Carrier) -> Vec<ParameterSpec> {
        vec![arms::spread(rig, "first"), arms::spread(rig, "second")]
    }

    fn starts(&self, rig: &Rig, carrier: Carrier) -> Vec<Vec<f64>> {
        vec![actuators::start(&self.parameters(rig, carrier), 0.5)]
    }

    fn act(&self, _: Carrier, values: Values, _: &Record, columns: &mut [Vec<f64>]) {
        arms::add(columns, Field::SideFirst, |t| values.at(0, t));
        arms::add(columns, Field::SideSecond, |t| values.at(1, t));
    }
}
