//! Bouc–Wen hysteresis: a bounded state driven by each actuator's motion, which unloads after a reversal.
//!
//! ```text
//! q̃_j = q_j − c_j z_j,   δ dz = dq − ½(1 + a) |dq| z − ½(1 − a) dq |z|,   z(t_0) = 0
//! ```
//!
//! | symbol | meaning                                                           | unit            |
//! | `c_j`  | half the opening of the loop                                      | of the actuator |
//! | `δ`    | width of the transition, all actuators                            | of the actuator |
//! | `a`    | asymmetry (β − γ)/(β + γ) of loading and unloading, all actuators | 1               |
//!
//! Exponent 1, in units of saturation, so that |z| ≤ 1. At a = 1 the state is Dahl's; below, unloading is closer to linear;
//! above, it is faster; thermodynamics requires a ≥ 0. Where actuators have different units, δ is a share of each one's own
//! travel. Ismail, Ikhouane & Rodellar (2009), Archives of Computational Methods in Engineering 16(2).

use super::length::{self, Length};
use crate::effects::actuation::actuators;
use crate::effects::{Carrier, Effect, Memory, ParameterSpec, Record, Rig, Site, Traits, Values, guesses, memory};

/// See the head of this file.
pub struct BoucWen;

impl Effect for BoucWen {
    fn name(&self) -> &'static str {
        "bouc_wen"
    }

    fn meaning(&self) -> &'static str {
        "an actuator follows a smooth hysteresis loop that loads and unloads differently"
    }

    fn site(&self) -> Site {
        Site::Actuation
    }

    fn source(&self) -> &'static str {
        "Ismail, Ikhouane & Rodellar (2009), Archives of Computational Methods in Engineering 16(2)"
    }

    fn traits(&self) -> Traits {
        Traits { is_rare: true, ..Traits::default() }
    }

    fn carriers(&self, rig: &Rig) -> Vec<Carrier> {
        actuators::moving(rig)
    }

    fn parameters(&self, rig: &Rig, _: Carrier) -> Vec<ParameterSpec> {
        let lengths = Length::of(rig);
        let mut specs: Vec<ParameterSpec> = actuators::sizes(rig, "opening", [0.05, 0.0, 1.0]).collect();
        specs.push(lengths.shape("width", 0.05, 0.001, 1.0));
        specs.push(ParameterSpec::shape("asymmetry", "1", 0.0, 0.3).within(0.0, 4.0));
        specs.extend(lengths.known());
        specs
    }

    fn initial_guesses(&self, rig: &Rig, carrier: Carrier) -> Vec<Vec<f64>> {
        let (specs, sizes) = (self.parameters(rig, carrier), rig.actuators.len());
        let widths = Length::of(rig).grid();
        let grid: Vec<[f64; 2]> = [0.2, 2.0].iter().flat_map(|a| widths.iter().map(|w| [*w, *a])).collect();
        guesses::alike_then_alone(rig, &grid, |who, [width, asymmetry]| {
            let mut guess = guesses::sizes_of(&specs, sizes, who, 1.0);
            guess[sizes] = specs[sizes].inside(width);
            guess[sizes + 1] = asymmetry;
            guess
        })
    }

    fn proceed(&self, _: Carrier, values: Values, _: &Record, memory: &mut Memory, columns: &mut [Vec<f64>]) {
        let sizes = columns.len();
        for (j, (q, z)) in columns.iter_mut().zip(memory.states::<memory::BoucWen>(sizes)).enumerate() {
            let unit = length::unit_of_length(values, sizes + 2, j);
            for (t, q) in q.iter_mut().enumerate() {
                *q -= values.at(j, t) * z.step(*q, unit * values.at(sizes, t), values.at(sizes + 1, t));
            }
        }
    }
}
