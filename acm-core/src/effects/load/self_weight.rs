//! Weight of the arm itself, as far as the nominal model has not taken it up.
//!
//! ```text
//! free_self = f,   held_self = −c f,   f = ρ A g / EI
//! ```
//!
//! | symbol | meaning                                                            | unit |
//! | `f`    | weight per length over bending stiffness; negative where a calibration took up too much | 1/m³ |
//! | `c`    | share of the mean bending that the tendons hold                    | 1    |
//!
//! Gere & Timoshenko (1997), Mechanics of Materials, ch. 9.

use super::arms;
use crate::effects::{Carrier, Effect, Memory, ParameterSpec, Record, Rig, Site, Traits, Values};
use crate::fields::Load;

/// See the head of this file.
pub struct SelfWeight;

impl Effect for SelfWeight {
    fn name(&self) -> &'static str {
        "self_weight"
    }

    fn meaning(&self) -> &'static str {
        "the arm sags under its own weight"
    }

    fn site(&self) -> Site {
        Site::Load
    }

    fn source(&self) -> &'static str {
        "Gere & Timoshenko (1997), Mechanics of Materials, ch. 9"
    }

    fn traits(&self) -> Traits {
        Traits { is_static: true, is_constant: true, ..Traits::default() }
    }

    fn carriers(&self, rig: &Rig) -> Vec<Carrier> {
        arms::any(rig)
    }

    fn parameters(&self, rig: &Rig, _: Carrier) -> Vec<ParameterSpec> {
        vec![arms::spread(rig, "weight"), arms::held()]
    }

    fn initial_guesses(&self, rig: &Rig, carrier: Carrier) -> Vec<Vec<f64>> {
        let specs = self.parameters(rig, carrier);
        [0.0, 0.8].iter().map(|&held| arms::guess(&specs, &[(1, held)])).collect()
    }

    fn proceed(&self, _: Carrier, values: Values, _: &Record, _: &mut Memory, columns: &mut [Vec<f64>]) {
        arms::load(columns, Load::SelfWeight, |t| values.at(1, t), |t| values.at(0, t));
    }
}
