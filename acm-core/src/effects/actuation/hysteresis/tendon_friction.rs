//! Friction of a tendon around the arm that it bends: the share that is lost grows with the angle, as at a capstan.
//!
//! ```text
//! q̃_j = q_j − μ_j |q_j| d_j,   δ dd = (sgn q̇ − d) |dq|,   d(t_0) = 0
//! ```
//!
//! | symbol | meaning                                           | unit            |
//! | `μ_j`  | share of the actuator lost in steady motion       | 1               |
//! | `δ`    | presliding way after a turn, all actuators        | of the actuator |
//!
//! First order of e^{−μ|q|}, the capstan's loss of tension, with Dahl's state in place of the sign of motion. Where
//! actuators have different units, δ is a share of each one's own travel. Kaneko, Yamashita & Tanie (1991), ICAR;
//! Dahl (1976), AIAA Journal 14(12).

use super::length::{self, Length};
use crate::effects::actuation::actuators;
use crate::effects::memory::BoucWen;
use crate::effects::{Carrier, Effect, Memory, ParameterSpec, Record, Rig, Site, Values, guesses};

/// See the head of this file.
pub struct TendonFriction;

impl Effect for TendonFriction {
    fn name(&self) -> &'static str {
        "tendon_friction"
    }

    fn meaning(&self) -> &'static str {
        "friction of the tendons takes a share of each actuator that grows with its angle"
    }

    fn site(&self) -> Site {
        Site::Actuation
    }

    fn source(&self) -> &'static str {
        "Kaneko, Yamashita & Tanie (1991), ICAR; Dahl (1976), AIAA Journal 14(12)"
    }

    fn carriers(&self, rig: &Rig) -> Vec<Carrier> {
        actuators::moving(rig)
    }

    fn parameters(&self, rig: &Rig, _: Carrier) -> Vec<ParameterSpec> {
        let lengths = Length::of(rig);
        let mut specs: Vec<ParameterSpec> = actuators::shares(rig, "friction", [0.1, 0.0, 1.0]).collect();
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
                *q -= values.at(j, t) * q.abs() * d.dahl(*q, unit * values.at(sizes, t));
            }
        }
    }
}
