//! Coupling: an actuator is moved along by the others.
//!
//! ```text
//! q̃_i = q_i + Σ_{j≠i} c_ij q_j
//! ```
//!
//! | symbol | meaning                                     | unit                           |
//! | `c_ij` | what actuator `i` takes of actuator `j`     | of actuator i per unit of j    |
//!
//! For the rig as a whole; with more than three actuators also for one of them at a time, as all pairs are many. Camarillo
//! et al. (2008), IEEE Transactions on Robotics 24(6).

use crate::effects::{Carrier, Effect, Memory, ParameterSpec, Record, Rig, Site, Traits, Values, guesses};
use crate::rig::Signal;

/// See the head of this file.
pub struct Coupling;

/// Coupled pairs, in the order of the parameters.
fn pairs(count: usize, carrier: Carrier) -> impl Iterator<Item = (usize, usize)> {
    let takes = move |i: &usize| carrier == Carrier::Rig || carrier == Carrier::Actuator(*i);
    (0..count).filter(takes).flat_map(move |i| (0..count).filter(move |&j| j != i).map(move |j| (i, j)))
}

/// Share of `from` in `to`, scaled by their travels.
fn share(to: &Signal, from: &Signal) -> ParameterSpec {
    let unit = if to.unit == from.unit { "1".into() } else { format!("{}/({})", to.unit, from.unit) };
    let whole = if to.varies() && from.varies() { to.span() / from.span() } else { 0.0 };
    ParameterSpec::size(format!("{}_of_{}", to.name, from.name), unit, 0.1 * whole).within(-whole, whole)
}

impl Effect for Coupling {
    fn name(&self) -> &'static str {
        "coupling"
    }

    fn meaning(&self) -> &'static str {
        "an actuator is moved along by the others"
    }

    fn site(&self) -> Site {
        Site::Actuation
    }

    fn source(&self) -> &'static str {
        "Camarillo et al. (2008), IEEE Transactions on Robotics 24(6)"
    }

    fn traits(&self) -> Traits {
        Traits { is_static: true, is_calibrated_away: true, is_generic: true, ..Traits::default() }
    }

    fn carriers(&self, rig: &Rig) -> Vec<Carrier> {
        let moving: Vec<usize> = (0..rig.actuators.len()).filter(|&j| rig.actuators[j].varies()).collect();
        match moving.len() {
            0 | 1 => vec![],
            2 | 3 => vec![Carrier::Rig],
            _ => std::iter::once(Carrier::Rig).chain(moving.into_iter().map(Carrier::Actuator)).collect(),
        }
    }

    fn parameters(&self, rig: &Rig, carrier: Carrier) -> Vec<ParameterSpec> {
        pairs(rig.actuators.len(), carrier).map(|(i, j)| share(&rig.actuators[i], &rig.actuators[j])).collect()
    }

    fn initial_guesses(&self, rig: &Rig, carrier: Carrier) -> Vec<Vec<f64>> {
        let specs = self.parameters(rig, carrier);
        vec![guesses::guess(&specs, 0.5), guesses::guess(&specs, -0.5)]
    }

    fn proceed(&self, carrier: Carrier, values: Values, _: &Record, memory: &mut Memory, columns: &mut [Vec<f64>]) {
        let before = memory.states::<Vec<f64>>(columns.len());
        before.iter_mut().zip(&*columns).for_each(|(before, q)| before.clone_from(q));
        for (k, (i, j)) in pairs(before.len(), carrier).enumerate() {
            for (t, (q, other)) in columns[i].iter_mut().zip(&before[j]).enumerate() {
                *q += values.at(k, t) * other;
            }
        }
    }
}
