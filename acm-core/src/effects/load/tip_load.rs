//! Weight at the tip: a payload or a tool that the nominal model does not know.
//!
//! ```text
//! free_tip = f,   held_tip = −c f,   f = m g / EI
//! ```
//!
//! | symbol | meaning                                         | unit |
//! | `f`    | weight over bending stiffness, downwards        | 1/m² |
//! | `c`    | share of the mean bending that the tendons hold | 1    |
//!
//! Where the mass is recorded, f grows with it as with any context. Gere & Timoshenko (1997), Mechanics of Materials, ch. 9.

use super::arms;
use crate::effects::{Carrier, Effect, Memory, ParameterSpec, Record, Rig, Site, Traits, Values};
use crate::fields::Load;

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

    fn traits(&self) -> Traits {
        Traits { is_static: true, is_carried: true, ..Traits::default() }
    }

    fn carriers(&self, rig: &Rig) -> Vec<Carrier> {
        arms::any(rig)
    }

    fn parameters(&self, rig: &Rig, _: Carrier) -> Vec<ParameterSpec> {
        vec![arms::positive(arms::force(rig, "force")), arms::held()]
    }

    fn initial_guesses(&self, rig: &Rig, carrier: Carrier) -> Vec<Vec<f64>> {
        let specs = self.parameters(rig, carrier);
        [0.0, 0.8].iter().map(|&held| arms::guess(&specs, &[(1, held)])).collect()
    }

    fn proceed(&self, _: Carrier, values: Values, _: &Record, _: &mut Memory, columns: &mut [Vec<f64>]) {
        arms::load(columns, Load::TipWeight, |t| values.at(1, t), |t| values.at(0, t));
    }
}
