//! Dry friction of the drive, the same at every angle: each actuator loses a fixed displacement against its motion.
//!
//! ```text
//! q̃_j = q_j − f_j d_j,   δ dd = (sgn q̇ − d) |dq|,   d(t_0) = 0
//! ```
//!
//! | symbol | meaning                                           | unit            |
//! | `f_j`  | way lost in steady motion                         | of the actuator |
//! | `δ`    | presliding way after a turn, all actuators        | of the actuator |
//!
//! Where actuators have different units, δ is a share of each one's own travel. Dahl (1976), AIAA Journal 14(12).

use super::length::{self, Length};
use crate::effects::actuation::actuators;
use crate::effects::memory::BoucWen;
use crate::effects::{Carrier, Effect, Memory, ParameterSpec, Record, Rig, Site, Traits, Values, guesses};

/// See the head of this file.
pub struct DryFriction;

impl Effect for DryFriction {
    fn name(&self) -> &'static str {
        "dry_friction"
    }

    fn meaning(&self) -> &'static str {
        "dry friction in the drive shifts each actuator by a fixed amount against its motion"
    }

    fn site(&self) -> Site {
        Site::Actuation
    }

    fn source(&self) -> &'static str {
        "Dahl (1976), AIAA Journal 14(12)"
    }

    fn traits(&self) -> Traits {
        Traits { is_rare: true, ..Traits::default() }
    }

    fn carriers(&self, rig: &Rig) -> Vec<Carrier> {
        actuators::moving(rig)
    }

    fn parameters(&self, rig: &Rig, _: Carrier) -> Vec<ParameterSpec> {
        let lengths = Length::of(rig);
        let mut specs: Vec<ParameterSpec> = actuators::sizes(rig, "friction", [0.05, 0.0, 1.0]).collect();
        specs.push(lengths.shape("presliding", 0.04, 0.001, 1.0));
        specs.extend(lengths.known());
        specs
    }

    fn initial_guesses(&self, rig: &Rig, carrier: Carrier) -> Vec<Vec<f64>> {
        let (specs, sizes) = (self.parameters(rig, carrier), rig.actuators.len());
        guesses::alike_then_alone(rig, &Length::of(rig).grid(), |who, presliding| {
            let mut guess = guesses::sizes_of(&specs, sizes, who, 1.0);
            guess[sizes] = specs[sizes].inside(presliding);
            guess
        })
    }

    fn proceed(&self, _: Carrier, values: Values, _: &Record, memory: &mut Memory, columns: &mut [Vec<f64>]) {
        let sizes = columns.len();
        for (j, (q, d)) in columns.iter_mut().zip(memory.states::<BoucWen>(sizes)).enumerate() {
            let unit = length::unit_of_length(values, sizes + 1, j);
            for (t, q) in q.iter_mut().enumerate() {
                *q -= values.at(j, t) * d.dahl(*q, unit * values.at(sizes, t));
            }
        }
    }
}
