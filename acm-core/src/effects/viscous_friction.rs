//! Viscous friction: the outputs are shifted in proportion to the speed of a signal.
//!
//! ```text
//! ỹ_m = y_m + c_m ṡ
//! ```
//!
//! | symbol | meaning                                             | unit                              |
//! | `c_m`  | damping, one for each output                        | of the output per unit and second |
//! | `ṡ`    | rate of the signal ([`crate::record::slope`])       | per s                             |
//!
//! Armstrong-Hélouvry, Dupont & Canudas de Wit (1994), Automatica 30(7).

use super::{Carrier, Effect, Memory, ParameterSpec, Record, Rig, Site, Traits, Values, carrying, guesses};

/// See the head of this file.
pub struct ViscousFriction;

impl Effect for ViscousFriction {
    fn name(&self) -> &'static str {
        "viscous_friction"
    }

    fn meaning(&self) -> &'static str {
        "friction in proportion to a speed shifts the outputs"
    }

    fn site(&self) -> Site {
        Site::Output
    }

    fn source(&self) -> &'static str {
        "Armstrong-Hélouvry, Dupont & Canudas de Wit (1994), Automatica 30(7)"
    }

    fn traits(&self) -> Traits {
        Traits { follows_pressure: true, shows_against_rate: true, ..Traits::default() }
    }

    fn carriers(&self, rig: &Rig) -> Vec<Carrier> {
        carrying::moving(rig)
    }

    fn parameters(&self, rig: &Rig, carrier: Carrier) -> Vec<ParameterSpec> {
        let (unit, width) = carrying::range(rig, carrier);
        carrying::sizes(rig, "damping", &carrying::per(&unit, "s"), width / carrying::typical_time(rig), 1e3)
    }

    fn initial_guesses(&self, rig: &Rig, carrier: Carrier) -> Vec<Vec<f64>> {
        vec![guesses::guess(&self.parameters(rig, carrier), 1.0)]
    }

    fn proceed(&self, carrier: Carrier, values: Values, record: &Record, _: &mut Memory, columns: &mut [Vec<f64>]) {
        let Some(rate) = carrying::rate(record, carrier) else { return };
        carrying::add(columns, |m, t| values.at(m, t), rate);
    }
}
