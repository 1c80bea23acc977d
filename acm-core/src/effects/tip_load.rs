//! Weight at the tip: a payload or a tool that the nominal model does not know.
//!
//! ```text
//! w_tip = f,   f = m g / EI
//! ```
//!
//! | symbol | meaning                                  | unit |
//! | `f`    | weight over bending stiffness, downwards | 1/m² |
//!
//! Where the mass is recorded, f grows with it as with any context. Gere & Timoshenko (1997), Mechanics of Materials, ch. 9.

use super::{Carrier, Effect, ParameterSpec, Record, Rig, Site, Values, actuators, arms};
use crate::fields::Field;

/// See the head of this file.
pub struct TipLoad;

impl Effect for TipLoad {
    fn name(&self) -> &'static str {
        "tip_load"
    }

    fn meaning(&self) -> &'static str {
        "a weight hangs at the tip"
    }

    fn site(&self) -> Site {
        Site::Load
    }

    fn source(&self) -> &'static str {
        "Gere & Timoshenko (1997), Mechanics of Materials, ch. 9"
    }

    fn carriers(&self, rig: &Rig) -> Vec<Carrier> {
        arms::any(rig)
    }

    fn parameters(&self, rig: &Rig, _: Carrier) -> Vec<ParameterSpec> {
        vec![arms::positive(arms::force(rig, "force"))]
    }

    fn starts(&self, rig: &Rig, carrier: Carrier) -> Vec<Vec<f64>> {
        vec![actuators::start(&self.parameters(rig, carrier), 0.5)]
    }

    fn act(&self, _: Carrier, values: Values, _: &Record, columns: &mut [Vec<f64>]) {
        arms::add(columns, Field::TipWeight, |t| values.at(0, t));
    }
}
